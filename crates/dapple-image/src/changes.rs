//! Detection of changed files by polling their metadata.
//!
//! File-system events are not used. They miss writes through a link and on network mounts, and they report every other
//! file of the folder. Polling a few files costs microseconds.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// A file's size, modification time and identity. If a file's stamp changes, its content may have changed.
///
/// Links are followed: the stamp describes the file that would be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileStamp {
    bytes: u64,
    modified: Option<SystemTime>,
    /// Device and inode numbers, on Unix. They differ after the file was replaced by another one.
    identity: Option<[u64; 2]>,
}

impl FileStamp {
    /// Returns the stamp of the file at `path`; `None` if it cannot be found.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let found = fs::metadata(path).ok()?;
        Some(Self {
            bytes: found.len(),
            modified: found.modified().ok(),
            identity: identity(&found),
        })
    }
}

#[cfg(unix)]
fn identity(found: &fs::Metadata) -> Option<[u64; 2]> {
    use std::os::unix::fs::MetadataExt as _;
    Some([found.dev(), found.ino()])
}

#[cfg(not(unix))]
fn identity(_: &fs::Metadata) -> Option<[u64; 2]> {
    None
}

/// Debounced detection of file changes.
///
/// Programs write files in several steps, so a change is reported once two successive checks find the same stamps,
/// and after [`LONGEST`](Self::LONGEST) checks at the latest.
#[derive(Clone, Debug, Default)]
pub struct FileChanges {
    seen: BTreeMap<PathBuf, Option<FileStamp>>,
    /// Number of checks since the first unreported change; 0 if there is none.
    n_looks: u32,
}

impl FileChanges {
    /// Number of checks after which a change is reported even if the files keep changing.
    pub const LONGEST: u32 = 12;

    /// Creates a detector whose initial state is the current stamps of `files`.
    #[must_use]
    pub fn new(files: &[PathBuf]) -> Self {
        let mut changes = Self::default();
        changes.look(files);
        changes
    }

    /// Records the current stamp of a file that is not known yet. Call this before reading the file, so that the next
    /// check detects every later write.
    pub fn remember(&mut self, file: PathBuf) {
        let entry = self.seen.entry(file);
        entry.or_insert_with_key(|file| FileStamp::of(file));
    }

    /// Returns whether any file differs from the stamp taken at the last check.
    #[must_use]
    pub fn has_changed(&self) -> bool {
        let mut seen = self.seen.iter();
        seen.any(|(path, stamp)| FileStamp::of(path) != *stamp)
    }

    /// Checks `files` for changes, and returns whether they should be read again now.
    ///
    /// A file that was neither part of the last check nor [remembered](Self::remember) is only recorded, and does not
    /// count as changed.
    pub fn look(&mut self, files: &[PathBuf]) -> bool {
        let stamps = files.iter().map(|file| (file.clone(), FileStamp::of(file)));
        let now: BTreeMap<_, _> = stamps.collect();
        let has_changed = now.iter().any(|(file, stamp)| {
            let before = self.seen.get(file);
            before.is_some_and(|before| before != stamp)
        });
        self.seen = now;
        if has_changed || self.n_looks > 0 {
            self.n_looks += 1;
        }
        let is_over = self.n_looks > 0 && (!has_changed || self.n_looks >= Self::LONGEST);
        if is_over {
            self.n_looks = 0;
        }
        is_over
    }
}

#[cfg(test)]
mod tests {
    #![expect(
        clippy::disallowed_methods,
        reason = "files are changed to be looked at"
    )]

    use super::FileChanges;
    use std::fs;

    #[test]
    fn changes_are_reported_when_files_are_quiet_and_at_the_latest_after_some_looks() {
        let folder = tempfile::tempdir().unwrap();
        let files = [folder.path().join("a"), folder.path().join("b")];
        fs::write(&files[0], "1").unwrap();
        let mut changes = FileChanges::new(&files);
        assert!(!changes.has_changed());
        assert!(!changes.look(&files));
        // A new file, and a file that got longer.
        for (file, text) in [(&files[1], "1"), (&files[0], "12")] {
            fs::write(file, text).unwrap();
            assert!(changes.has_changed());
            assert!(!changes.look(&files), "it may be written still");
            assert!(changes.look(&files));
            assert!(!changes.look(&files), "it is reported once");
        }
        // A change of another file in the folder is ignored.
        fs::write(folder.path().join("c"), "1").unwrap();
        assert!(!changes.look(&files) && !changes.look(&files));
        // A file that changes at every check.
        let n_looks = (1..).find(|&count| {
            fs::write(&files[0], "x".repeat(count)).unwrap();
            changes.look(&files)
        });
        assert_eq!(n_looks, Some(FileChanges::LONGEST as usize));
        fs::remove_file(&files[0]).unwrap();
        assert!(!changes.look(&files));
        assert!(changes.look(&files));
    }

    #[test]
    fn what_is_written_between_reading_a_file_and_the_first_look_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let files = [folder.path().join("a")];
        fs::write(&files[0], "1").unwrap();
        let mut changes = FileChanges::default();
        changes.remember(files[0].clone());
        assert_eq!(fs::read_to_string(&files[0]).unwrap(), "1");
        fs::write(&files[0], "12").unwrap();
        changes.remember(files[0].clone());
        assert!(!changes.look(&files));
        assert!(changes.look(&files));
    }

    #[test]
    #[cfg(unix)]
    fn changes_through_a_link_and_of_the_link_are_seen() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("real")).unwrap();
        fs::write(path("real/a"), "1").unwrap();
        fs::write(path("real/b"), "1").unwrap();
        std::os::unix::fs::symlink("real/a", path("link")).unwrap();
        let files = [path("link")];
        let mut changes = FileChanges::new(&files);
        let mut is_seen = |what: &str| {
            assert!(changes.has_changed(), "{what}");
            assert!(!changes.look(&files) && changes.look(&files), "{what}");
        };
        fs::write(path("real/a"), "12").unwrap();
        is_seen("written in place");
        fs::write(path("real/aside"), "21").unwrap();
        fs::rename(path("real/aside"), path("real/a")).unwrap();
        is_seen("replaced by another file of the same size");
        fs::remove_file(path("link")).unwrap();
        std::os::unix::fs::symlink("real/b", path("link")).unwrap();
        is_seen("the link leads elsewhere");
        fs::write(path("real/b"), "123").unwrap();
        is_seen("written where it leads now");
    }
}
