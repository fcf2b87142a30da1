//! Manages the output files of a run. They are claimed before the work starts, written under temporary names, and
//! renamed together at the end.
//!
//! Each file is written under a temporary name in its directory. When all files are complete, they are flushed to disk
//! and renamed in immediate succession. Then their directories are flushed. A reader finds the old file or the complete
//! new one, even if the command or the machine crashes. A document that names other files is renamed after them.
//!
//! Without `--force`, no existing file is replaced. This is checked when a file is claimed, before hours of work, and
//! again when it is renamed.
//!
//! Standard output, devices and pipes cannot be renamed to; their bytes are copied at the end.

#![expect(
    clippy::disallowed_methods,
    reason = "this module is where the command writes files"
)]

mod registry;
mod temporary;

pub(crate) use registry::exit_without_rubbish;
pub(crate) use temporary::Sink;
use temporary::{Spool, Temporary};

use crate::error::{Hint, usage};
use anyhow::{Context, Error, Result, anyhow, bail};
use dapple::image::{remove_left_behind, sync_folder};
use dapple::mesh_io::tile_name;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Maximum number of missing directories that are created for an output.
const FOLDERS_MAX: usize = 64;

/// The target of an output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// Standard output, `-` on the command line.
    Stdout,
    /// A file.
    Path(PathBuf),
}

/// The index of a claimed file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct OutputIdx(usize);

/// The size and checksum of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Content {
    /// The number of bytes.
    pub(crate) bytes: u64,
    /// The SHA-256 of the bytes, in hexadecimal, as `sha256sum` prints it.
    pub(crate) sha256: String,
}

/// The output files of a run. Files that were not committed are removed on drop.
#[derive(Debug)]
pub(crate) struct Outputs {
    force: bool,
    files: Vec<Pending>,
    /// The directories that were created, outermost first.
    folders: Vec<PathBuf>,
}

/// A claimed file that is not committed yet.
#[derive(Debug)]
struct Pending {
    target: Target,
    place: Place,
    content: Bytes,
}

/// The bytes of an output before they reach their destination.
#[derive(Debug)]
enum Bytes {
    File(Temporary),
    Stream(Spool),
}

/// The final destination of the bytes.
#[derive(Debug, PartialEq, Eq)]
enum Place {
    Stdout,
    /// A device or a named pipe, which is written to instead of being replaced.
    Device(PathBuf),
    /// A file. If it exists, symbolic links are resolved.
    File(PathBuf),
}

impl Target {
    /// Returns the path, or `None` for standard output.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::Stdout => None,
            Self::Path(path) => Some(path),
        }
    }

    /// Returns the file name without its directory; empty for standard output.
    pub(crate) fn name(&self) -> String {
        let name = self.path().and_then(Path::file_name);
        name.unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Returns the file extension in lower case, without its dot; empty if there is no extension.
    pub(crate) fn ending(&self) -> String {
        let ending = self.path().and_then(Path::extension);
        ending
            .unwrap_or_default()
            .to_string_lossy()
            .to_ascii_lowercase()
    }

    /// Replaces the file extension.
    pub(crate) fn with_ending(self, ending: &str) -> Self {
        match self {
            Self::Stdout => Self::Stdout,
            Self::Path(path) => Self::Path(path.with_extension(ending)),
        }
    }

    /// Returns the rank of the file in the order of renaming: images and other files, then material libraries, then
    /// documents that reference them, and last the sidecar with the checksums.
    fn turn(&self) -> u8 {
        match self.ending().as_str() {
            "mtl" => 1,
            "mtlx" | "obj" | "gltf" | "tres" => 2,
            "json" => 3,
            _ => 0,
        }
    }

    /// Returns the file for a part of the output, which is `NAME_PART.EXTENSION`, or this file if `part` is empty.
    ///
    /// # Errors
    ///
    /// If this is standard output, which takes a single file.
    pub(crate) fn part(&self, part: &str) -> Result<Self> {
        match self {
            _ if part.is_empty() => Ok(self.clone()),
            Self::Stdout => Err(usage(
                "there are several files, but standard output takes only one",
            )
            .hint("give a file or a folder with -o")),
            Self::Path(path) => {
                let mut name = path.file_stem().unwrap_or_default().to_owned();
                name.push(format!("_{part}"));
                if let Some(ending) = path.extension() {
                    name.push(".");
                    name.push(ending);
                }
                Ok(Self::Path(path.with_file_name(name)))
            }
        }
    }
}

impl Target {
    /// Returns the file for a UDIM tile. Its number replaces `<UDIM>` in the name, or else precedes the extension, as
    /// in `NAME.1001.EXTENSION`.
    ///
    /// # Errors
    ///
    /// If this is standard output, which takes one file.
    pub(crate) fn tile(&self, number: u32) -> Result<Self> {
        let Self::Path(path) = self else {
            return self.part(&number.to_string());
        };
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let name = tile_name(&name, number).unwrap_or_else(|| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            format!("{stem}.{number}.{}", self.ending())
        });
        Ok(Self::Path(path.with_file_name(name)))
    }
}

impl From<&Path> for Target {
    fn from(path: &Path) -> Self {
        if path == Path::new("-") {
            Self::Stdout
        } else {
            Self::Path(path.to_owned())
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stdout => f.write_str("standard output"),
            Self::Path(path) => path.display().fmt(f),
        }
    }
}

impl Outputs {
    /// Creates an empty set of files. With `force`, existing files are replaced.
    pub(crate) fn new(force: bool) -> Self {
        Self {
            force,
            files: Vec::new(),
            folders: Vec::new(),
        }
    }

    /// Creates a directory and its missing parents. They are removed again if the run fails.
    ///
    /// # Errors
    ///
    /// If the directory cannot be created, for example because a file has its name, or if more than [`FOLDERS_MAX`]
    /// directories are missing.
    pub(crate) fn make_folder(&mut self, folder: &Path) -> Result<()> {
        for folder in missing_folders(folder)?.into_iter().rev() {
            registry::make_folder(folder)
                .with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
            self.folders.push(folder.to_owned());
        }
        if folder.is_dir() {
            return Ok(());
        }
        Err(anyhow!("{} is a file, and not a folder", folder.display()))
    }

    /// Creates a directory that remains even if this run fails, since other runs may write to it at the same time.
    ///
    /// # Errors
    ///
    /// Same as [`make_folder`](Self::make_folder).
    pub(crate) fn make_lasting_folder(folder: &Path) -> Result<()> {
        let failed = || format!("{}: the folder cannot be made", folder.display());
        let missing = missing_folders(folder)?;
        fs::create_dir_all(folder).with_context(failed)?;
        for parent in missing.into_iter().filter_map(Path::parent) {
            sync_folder(parent).with_context(failed)?;
        }
        Ok(())
    }

    /// Claims an output by checking its path and creating its temporary file.
    ///
    /// # Errors
    ///
    /// If the file exists and may not be replaced, is a directory, was claimed before, or cannot be written.
    pub(crate) fn claim(&mut self, target: &Target) -> Result<OutputIdx> {
        let place = place(target)?;
        if self.files.iter().any(|file| file.place == place) {
            bail!("{target} would be written twice");
        }
        let content = match &place {
            Place::File(path) => {
                remove_left_behind(path);
                if !self.force && path.symlink_metadata().is_ok() {
                    return Err(exists(target));
                }
                Bytes::File(Temporary::beside(path).map_err(|error| no_room(path, error))?)
            }
            // Spool the bytes of a stream, which has no directory for a temporary file.
            Place::Stdout | Place::Device(_) => Bytes::Stream(Spool::new()),
        };
        self.files.push(Pending {
            target: target.clone(),
            place,
            content,
        });
        Ok(OutputIdx(self.files.len() - 1))
    }

    /// Returns a writer for a claimed file, from its start. Flush it before [`commit`](Self::commit).
    ///
    /// # Errors
    ///
    /// If the operating system has no file handles left.
    pub(crate) fn writer(&self, output: OutputIdx) -> Result<BufWriter<Sink>> {
        let sink = self.files[output.0].sink()?;
        Ok(BufWriter::with_capacity(1 << 18, sink))
    }

    /// Writes the whole content of a claimed file.
    ///
    /// # Errors
    ///
    /// If the operating system fails, for example because the disk is full.
    pub(crate) fn write(&self, output: OutputIdx, bytes: &[u8]) -> Result<()> {
        let mut writer = self.writer(output)?;
        let written = writer.write_all(bytes).and_then(|()| writer.flush());
        written.with_context(|| cannot_be_written(self.target(output)))
    }

    /// Returns the target of a claimed file.
    pub(crate) fn target(&self, output: OutputIdx) -> &Target {
        &self.files[output.0].target
    }

    /// Returns the size and checksum of a file that was written and flushed.
    ///
    /// # Errors
    ///
    /// If the file cannot be read back.
    pub(crate) fn content(&self, output: OutputIdx) -> Result<Content> {
        let file = &self.files[output.0];
        let content = read_back(file.sink()?);
        content.with_context(|| format!("{} cannot be read back", file.target))
    }

    /// Renames all files to their final paths. They are flushed to disk when this returns.
    ///
    /// # Errors
    ///
    /// If a file has appeared that may not be replaced, or the operating system fails. The message lists the files that
    /// have been renamed already.
    pub(crate) fn commit(mut self) -> Result<()> {
        // Flush all files to disk, and write the streams.
        for file in &self.files {
            file.complete()
                .with_context(|| cannot_be_written(&file.target))?;
        }
        self.files.sort_by_key(|file| file.target.turn());
        let mut held = registry::hold();
        let mut placed: Vec<Target> = Vec::new();
        let mut changed = BTreeSet::new();
        changed.extend(self.folders.iter().filter_map(|folder| parent(folder)));
        // Rename the files in order. After an error, the files that are left in the list are removed with `self`.
        while !self.files.is_empty() {
            let file = self.files.remove(0);
            let (Place::File(path), Bytes::File(temporary)) = (&file.place, file.content) else {
                continue;
            };
            if let Err(error) = temporary.put(&mut held, path, self.force) {
                return Err(not_placed(&file.target, error, &placed));
            }
            changed.extend(parent(path));
            let next = self.files.first().map(|file| file.target.turn());
            // Flush the directories before a document of the next turn names these files.
            if next != Some(file.target.turn())
                && let Err(error) = changed.iter().try_for_each(|folder| sync_folder(folder))
            {
                return Err(not_placed(&file.target, error, &placed));
            }
            placed.push(file.target);
        }
        // Keep the created directories.
        for folder in core::mem::take(&mut self.folders) {
            registry::forget(&mut held, &folder);
        }
        Ok(())
    }
}

impl Drop for Outputs {
    fn drop(&mut self) {
        let mut held = registry::hold();
        for file in self.files.drain(..) {
            if let Bytes::File(temporary) = file.content {
                temporary.remove(&mut held);
            }
        }
        for folder in self.folders.drain(..).rev() {
            // A directory that is not empty remains.
            let _ = fs::remove_dir(&folder);
            registry::forget(&mut held, &folder);
        }
    }
}

impl Pending {
    /// Returns the sink that the bytes are written to and read back from.
    fn sink(&self) -> Result<Sink> {
        match &self.content {
            Bytes::File(temporary) => {
                let file = temporary.file().try_clone();
                Ok(Sink::File(
                    file.with_context(|| cannot_be_written(&self.target))?,
                ))
            }
            Bytes::Stream(spool) => Ok(Sink::from(spool)),
        }
    }

    /// Flushes a file to disk, or copies the spooled bytes to a stream.
    fn complete(&self) -> io::Result<()> {
        match (&self.place, &self.content) {
            (Place::File(path), Bytes::File(temporary)) => temporary.sync(path),
            (Place::Device(path), Bytes::Stream(spool)) => {
                spool.copy_to(&mut File::options().write(true).open(path)?)
            }
            (_, Bytes::Stream(spool)) => {
                let mut to = io::stdout().lock();
                spool.copy_to(&mut to)?;
                to.flush()
            }
            (_, Bytes::File(_)) => Ok(()),
        }
    }
}

/// Returns the parent directory of a path; an empty path means the current directory.
fn parent(path: &Path) -> Option<PathBuf> {
    path.parent().map(Path::to_owned)
}

/// Returns the directory and its parents that do not exist, innermost first.
fn missing_folders(folder: &Path) -> Result<Vec<&Path>> {
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let missing = folder.ancestors().take_while(is_missing);
    let missing: Vec<_> = missing.take(FOLDERS_MAX + 1).collect();
    if missing.len() > FOLDERS_MAX {
        let message = format!("the output is in more than {FOLDERS_MAX} folders that do not exist");
        return Err(usage(message).hint("make its folder first, or give a shorter path"));
    }
    Ok(missing)
}

/// Returns the final destination of a target. It is determined once, when the target is claimed.
fn place(target: &Target) -> Result<Place> {
    let Target::Path(path) = target else {
        return Ok(Place::Stdout);
    };
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => {
            let error = anyhow!("{} is a folder, and not a file", path.display());
            Err(error.hint("name a file in it"))
        }
        Ok(found) if !found.is_file() => Ok(Place::Device(path.clone())),
        Ok(_) => {
            // Replace the target of a symbolic link, and keep the link.
            let path = fs::canonicalize(path);
            Ok(Place::File(
                path.with_context(|| cannot_be_written(target))?,
            ))
        }
        // Refuse a name that is too long. The temporary name is shorter, so that the rename would be the first to fail.
        Err(error) if error.kind() == io::ErrorKind::InvalidFilename => {
            Err(error).with_context(|| cannot_be_written(target))
        }
        Err(_) if path.file_name().is_none() => {
            Err(anyhow!("{:?} is not the name of a file", path.display()))
        }
        Err(_) => Ok(Place::File(path.clone())),
    }
}

/// Returns the error message for a target that cannot be written.
pub(crate) fn cannot_be_written(target: &Target) -> String {
    format!("{target} cannot be written")
}

fn exists(target: &Target) -> Error {
    let error = anyhow!("{target} exists already");
    error.hint("give another name, or --force to replace it")
}

fn no_room(path: &Path, error: io::Error) -> Error {
    let folder = path.parent().unwrap_or(Path::new(""));
    let is_missing = error.kind() == io::ErrorKind::NotFound;
    let error = Error::new(error).context(format!("{} cannot be written", path.display()));
    if is_missing && !folder.as_os_str().is_empty() {
        return error.hint(format!("make the folder {} first", folder.display()));
    }
    error
}

fn not_placed(target: &Target, error: io::Error, placed: &[Target]) -> Error {
    let error = if error.kind() == io::ErrorKind::AlreadyExists {
        exists(target)
    } else {
        Error::new(error).context(cannot_be_written(target))
    };
    if placed.is_empty() {
        return error;
    }
    let placed: Vec<_> = placed.iter().map(Target::to_string).collect();
    error.context(format!(
        "only a part of the files was written: {}",
        placed.join(", ")
    ))
}

/// Reads a file from its start, and returns its size and checksum.
///
/// # Errors
///
/// If the operating system fails.
pub(crate) fn read_back(mut file: impl Read + Seek) -> io::Result<Content> {
    file.seek(SeekFrom::Start(0))?;
    let mut hash = Sha256::new();
    let mut block = vec![0; 1 << 18];
    let mut bytes = 0;
    loop {
        let n_read = file.read(&mut block)?;
        if n_read == 0 {
            break;
        }
        hash.update(&block[..n_read]);
        bytes += n_read as u64;
    }
    let sha256 = hexadecimal(hash);
    Ok(Content { bytes, sha256 })
}

/// Computes the SHA-256 of `bytes`, in hexadecimal.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    hexadecimal(Sha256::new_with_prefix(bytes))
}

fn hexadecimal(hash: Sha256) -> String {
    let digits = hash.finalize();
    digits.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests;
