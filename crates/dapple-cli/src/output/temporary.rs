//! The bytes of an output until its run is done: a file under a temporary name in the folder of its final name, or, for
//! streams, memory.

use super::registry::{self, Held};
use dapple::image::AtomicFile;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tempfile::SpooledTempFile;

/// The most bytes of a stream that are kept in memory. More are moved to a file without a name in the folder for
/// temporary files.
const MEMORY: usize = 1 << 26;

/// A temporary file that an interrupt removes.
#[derive(Debug)]
pub(super) struct Temporary(AtomicFile);

impl Temporary {
    /// A new file in the folder of `path`.
    pub(super) fn beside(path: &Path) -> io::Result<Self> {
        let mut held = registry::hold();
        let file = AtomicFile::beside(path)?;
        held.push(file.temporary_path().to_owned());
        Ok(Self(file))
    }

    /// The file.
    pub(super) fn file(&self) -> &File {
        self.0.file()
    }

    /// Flushes the file to the disk, before it becomes the one at `path`.
    pub(super) fn sync(&self, path: &Path) -> io::Result<()> {
        self.0.sync(path)
    }

    /// Renames it to `path`; an existing file is replaced only with `force`.
    pub(super) fn put(self, held: &mut Held, path: &Path, force: bool) -> io::Result<()> {
        registry::forget(held, self.0.temporary_path());
        self.0.rename(path, force)
    }

    /// Removes the file.
    pub(super) fn remove(self, held: &mut Held) {
        registry::forget(held, self.0.temporary_path());
    }
}

/// The bytes of a stream, such as standard output, until the run is done.
#[derive(Clone, Debug)]
pub(super) struct Spool(Arc<Mutex<SpooledTempFile>>);

impl Spool {
    /// A stream without bytes.
    pub(super) fn new() -> Self {
        Self(Arc::new(Mutex::new(SpooledTempFile::new(MEMORY))))
    }

    /// Passes all bytes on, from the first.
    pub(super) fn copy_to(&self, to: &mut dyn Write) -> io::Result<()> {
        let mut bytes = self.lock();
        bytes.seek(SeekFrom::Start(0))?;
        io::copy(&mut *bytes, to)?;
        Ok(())
    }

    fn lock(&self) -> MutexGuard<'_, SpooledTempFile> {
        // Bytes that were written half are an error of the thread that wrote them.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What an output is written to.
#[derive(Debug)]
pub(crate) enum Sink {
    /// A temporary file.
    File(File),
    /// A stream.
    Stream(StreamSink),
}

/// The bytes of a stream.
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
