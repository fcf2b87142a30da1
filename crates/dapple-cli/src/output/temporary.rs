//! Stores the bytes of an output until its run is done: in a temporary file next to the final file or, for streams, in
//! memory.

use super::registry::{self, Held};
use dapple::image::AtomicFile;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tempfile::SpooledTempFile;

/// Maximum number of bytes of a stream that are kept in memory. Longer streams are moved to an unnamed file in the
/// directory for temporary files.
const MEMORY: usize = 1 << 26;

/// A temporary file that is removed on an interrupt.
#[derive(Debug)]
pub(super) struct Temporary(AtomicFile);

impl Temporary {
    /// Creates a temporary file in the directory of `path`.
    pub(super) fn beside(path: &Path) -> io::Result<Self> {
        let mut held = registry::hold();
        let file = AtomicFile::beside(path)?;
        held.push(file.temporary_path().to_owned());
        Ok(Self(file))
    }

    /// Returns the open temporary file.
    pub(super) fn file(&self) -> &File {
        self.0.file()
    }

    /// Flushes the file to disk, before it is renamed to `path`.
    pub(super) fn sync(&self, path: &Path) -> io::Result<()> {
        self.0.sync(path)
    }

    /// Renames the file to `path`. An existing file is replaced only with `force`.
    pub(super) fn put(self, held: &mut Held, path: &Path, force: bool) -> io::Result<()> {
        registry::forget(held, self.0.temporary_path());
        self.0.rename(path, force)
    }

    /// Deletes the temporary file.
    pub(super) fn remove(self, held: &mut Held) {
        registry::forget(held, self.0.temporary_path());
    }
}

/// In-memory buffer for the bytes of a stream, such as standard output, until the run is done.
#[derive(Clone, Debug)]
pub(super) struct Spool(Arc<Mutex<SpooledTempFile>>);

impl Spool {
    /// Creates an empty spool.
    pub(super) fn new() -> Self {
        Self(Arc::new(Mutex::new(SpooledTempFile::new(MEMORY))))
    }

    /// Copies all bytes to a writer.
    pub(super) fn copy_to(&self, to: &mut dyn Write) -> io::Result<()> {
        let mut bytes = self.lock();
        bytes.seek(SeekFrom::Start(0))?;
        io::copy(&mut *bytes, to)?;
        Ok(())
    }

    fn lock(&self) -> MutexGuard<'_, SpooledTempFile> {
        // If a thread panicked while it wrote, that thread reports the error.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Where the bytes of an output are written during the run.
#[derive(Debug)]
pub(crate) enum Sink {
    /// A temporary file.
    File(File),
    /// A spool.
    Stream(StreamSink),
}

/// A handle to a spool.
#[derive(Debug)]
pub(crate) struct StreamSink(Spool);

impl From<&Spool> for Sink {
    fn from(spool: &Spool) -> Self {
        Self::Stream(StreamSink(spool.clone()))
    }
}

impl Read for Sink {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.read(bytes),
            Self::Stream(stream) => stream.0.lock().read(bytes),
        }
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.write(bytes),
            Self::Stream(stream) => stream.0.lock().write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File(file) => file.flush(),
            Self::Stream(stream) => stream.0.lock().flush(),
        }
    }
}

impl Seek for Sink {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Self::File(file) => file.seek(to),
            Self::Stream(stream) => stream.0.lock().seek(to),
        }
    }
}
