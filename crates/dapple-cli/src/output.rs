//! The files of a run: claimed before the work starts, written under temporary names, and all moved to their places at
//! the end.
//!
//! Each file is written under a temporary name in its folder. When all of them are complete they are renamed, one right
//! after the other: a reader finds the old file or the whole new one, however the command ends. Without `--force` no
//! existing file is replaced: this is checked when a file is claimed, before hours of work, and again when it is renamed.
//!
//! Standard output, devices and pipes get their bytes at the end.

#![expect(
    clippy::disallowed_methods,
    reason = "this module is where the command writes files"
)]

mod registry;
mod temporary;

pub(crate) use registry::exit_without_rubbish;
use temporary::Temporary;

use crate::error::{Hint, usage};
use anyhow::{Context, Error, Result, anyhow, bail};
use sha2::{Digest, Sha256};
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

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

/// The files of a run. Those that were not committed are removed on drop.
#[derive(Debug)]
pub(crate) struct Outputs {
    force: bool,
    files: Vec<Pending>,
    /// The folders that were made, the outermost first.
    folders: Vec<PathBuf>,
}

#[derive(Debug)]
struct Pending {
    target: Target,
    place: Place,
    temporary: Temporary,
}

/// The final destination of the bytes.
#[derive(Debug, PartialEq, Eq)]
enum Place {
    Stdout,
    /// A device or a named pipe, which is written to and not replaced.
    Device(PathBuf),
    /// A file, with links resolved if it exists.
    File(PathBuf),
}

impl Target {
    /// The path, or `None` for standard output.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::Stdout => None,
            Self::Path(path) => Some(path),
        }
    }

    /// The name without its folder; empty for standard output.
    pub(crate) fn name(&self) -> String {
        let name = self.path().and_then(Path::file_name);
        name.unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The ending in lower case, without its dot; empty if there is none.
    pub(crate) fn ending(&self) -> String {
        let ending = self.path().and_then(Path::extension);
        ending
            .unwrap_or_default()
            .to_string_lossy()
            .to_ascii_lowercase()
    }

    /// This file with another ending.
    pub(crate) fn with_ending(self, ending: &str) -> Self {
        match self {
            Self::Stdout => Self::Stdout,
            Self::Path(path) => Self::Path(path.with_extension(ending)),
        }
    }

    /// The file beside this one for a part of the output: `NAME_PART.ENDING`; this file for a part without a name.
    ///
    /// # Errors
    ///
    /// If this is standard output, which has no file beside it.
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
    /// A run without files. With `force`, existing files are replaced.
    pub(crate) fn new(force: bool) -> Self {
        Self {
            force,
            files: Vec::new(),
            folders: Vec::new(),
        }
    }

    /// Makes a folder, and its missing parents, if it does not exist.
    ///
    /// # Errors
    ///
    /// If it cannot be made, for example because a file has its name.
    pub(crate) fn make_folder(&mut self, folder: &Path) -> Result<()> {
        let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let missing: Vec<_> = folder.ancestors().take_while(missing).collect();
        for folder in missing.into_iter().rev() {
            registry::make_folder(folder)
                .with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
            self.folders.push(folder.to_owned());
        }
        if folder.is_dir() {
            return Ok(());
        }
        Err(anyhow!("{} is a file, and not a folder", folder.display()))
    }

    /// Makes a folder that stays, even if this run fails: other runs may write into it at the same time.
    ///
    /// # Errors
    ///
    /// If it cannot be made, for example because a file has its name.
    pub(crate) fn make_lasting_folder(folder: &Path) -> Result<()> {
        let made = fs::create_dir_all(folder);
        made.with_context(|| format!("{}: the folder cannot be made", folder.display()))
    }

    /// Creates the temporary file of an output.
    ///
    /// # Errors
    ///
    /// If the file exists and may not be replaced, is a folder, was claimed before, or cannot be written.
    pub(crate) fn claim(&mut self, target: &Target) -> Result<OutputIdx> {
        let place = place(target)?;
        if self.files.iter().any(|file| file.place == place) {
            bail!("{target} would be written twice");
        }
        let temporary = match &place {
            Place::File(path) => {
                temporary::remove_left_behind(path);
                if !self.force && path.symlink_metadata().is_ok() {
                    return Err(exists(target));
                }
                Temporary::beside(path).map_err(|error| no_room(path, error))?
            }
            // There is no folder beside it, and its bytes are copied anyway.
            Place::Stdout | Place::Device(_) => {
                let path = std::env::temp_dir().join("dapple");
                temporary::remove_left_behind(&path);
                Temporary::beside(&path).map_err(|error| no_room(&path, error))?
            }
        };
        self.files.push(Pending {
            target: target.clone(),
            place,
            temporary,
        });
        Ok(OutputIdx(self.files.len() - 1))
    }

    /// A writer for a claimed file, from its start. It has to be flushed before [`commit`](Self::commit).
    ///
    /// # Errors
    ///
    /// If the operating system has no further handle.
    pub(crate) fn writer(&self, output: OutputIdx) -> Result<BufWriter<File>> {
        let Pending {
            target, temporary, ..
        } = &self.files[output.0];
        let file = temporary.file().try_clone();
        let file = file.with_context(|| cannot_be_written(target))?;
        Ok(BufWriter::with_capacity(1 << 18, file))
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

    /// The target of a claimed file.
    pub(crate) fn target(&self, output: OutputIdx) -> &Target {
        &self.files[output.0].target
    }

    /// The size and checksum of a file that was written and flushed.
    ///
    /// # Errors
    ///
    /// If it cannot be read back.
    pub(crate) fn content(&self, output: OutputIdx) -> Result<Content> {
        let Pending {
            target, temporary, ..
        } = &self.files[output.0];
        read_back(temporary.file()).with_context(|| format!("{target} cannot be read back"))
    }

    /// Moves all files to their places.
    ///
    /// # Errors
    ///
    /// If a file has appeared that may not be replaced, or the operating system fails; the message lists the files that
    /// are in their places already.
    pub(crate) fn commit(mut self) -> Result<()> {
        for file in &self.files {
            file.copy_if_stream()
                .with_context(|| cannot_be_written(&file.target))?;
        }
        let mut held = registry::hold();
        let mut placed: Vec<Target> = Vec::new();
        // After an error, the files that are still in the list are removed with `self`.
        while !self.files.is_empty() {
            let file = self.files.remove(0);
            let Place::File(path) = &file.place else {
                file.temporary.remove(&mut held);
                continue;
            };
            if let Err(error) = file.temporary.put(&mut held, path, self.force) {
                return Err(not_placed(&file.target, error, &placed));
            }
            placed.push(file.target);
        }
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
            file.temporary.remove(&mut held);
        }
        for folder in self.folders.drain(..).rev() {
            // A folder that is not empty stays.
            let _ = fs::remove_dir(&folder);
            registry::forget(&mut held, &folder);
        }
    }
}

impl Pending {
    /// Copies the bytes to a stream, where a rename is not possible.
    fn copy_if_stream(&self) -> io::Result<()> {
        let mut from = self.temporary.file();
        from.seek(SeekFrom::Start(0))?;
        match &self.place {
            Place::File(_) => Ok(()),
            Place::Stdout => {
                let mut to = io::stdout().lock();
                io::copy(&mut from, &mut to)?;
                to.flush()
            }
            Place::Device(path) => {
                io::copy(&mut from, &mut File::options().write(true).open(path)?)?;
                Ok(())
            }
        }
    }
}

/// The final destination of a target, as far as it is known now.
fn place(target: &Target) -> Result<Place> {
    let Target::Path(path) = target else {
        if is_stdout_closed() {
            return Err(anyhow!("standard output is closed").hint("give a file with -o"));
        }
        return Ok(Place::Stdout);
    };
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => {
            let error = anyhow!("{} is a folder, and not a file", path.display());
            Err(error.hint("name a file in it"))
        }
        Ok(found) if !found.is_file() => Ok(Place::Device(path.clone())),
        Ok(_) => {
            // The target of a link is replaced, and the link remains.
            let path = fs::canonicalize(path);
            Ok(Place::File(
                path.with_context(|| cannot_be_written(target))?,
            ))
        }
        // The temporary name is shorter, so that only this would be noticed at the end.
        Err(error) if error.kind() == io::ErrorKind::InvalidFilename => {
            Err(error).with_context(|| cannot_be_written(target))
        }
        Err(_) if path.file_name().is_none() => {
            Err(anyhow!("{:?} is not the name of a file", path.display()))
        }
        Err(_) => Ok(Place::File(path.clone())),
    }
}

/// Whether standard output was closed when the process began. Then the null device is open in its place, also for
/// reading; it is not readable if the user redirects the output to it.
#[cfg(unix)]
fn is_stdout_closed() -> bool {
    use std::os::{fd::AsFd, unix::fs::MetadataExt};
    let is_readable_null = || -> io::Result<bool> {
        let mut file = File::from(io::stdout().as_fd().try_clone_to_owned()?);
        let is_null = file.metadata()?.rdev() == fs::metadata("/dev/null")?.rdev();
        Ok(is_null && file.read(&mut [0]).is_ok())
    };
    is_readable_null().unwrap_or(false)
}

#[cfg(not(unix))]
fn is_stdout_closed() -> bool {
    false
}

/// The error message for a target to which nothing can be written.
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

/// The size and checksum of a file, from its start.
///
/// # Errors
///
/// If the operating system fails.
pub(crate) fn read_back(mut file: &File) -> io::Result<Content> {
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

/// The SHA-256 of some bytes, in hexadecimal.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    hexadecimal(Sha256::new_with_prefix(bytes))
}

fn hexadecimal(hash: Sha256) -> String {
    let digits = hash.finalize();
    digits.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests;
