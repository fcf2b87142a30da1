//! Tests that writing rows to a file takes little memory, regardless of their number. This is a separate binary because
//! it measures its peak memory.

use dapple_image::{Content, Depth, Encoding, RowWriter};
use dapple_raster::Raster;
use std::io::{self, Seek, SeekFrom, Write};

/// Columns and rows of the image. A single raster of `f32` would take 256 MiB.
const SIZE: [u32; 2] = [16384, 4096];

/// Number of rows written at a time.
const BAND: u32 = 100;

/// Memory limit in bytes. A band of rows and the band of tiles take 11 MB; the rest is for the program itself.
const LIMIT: u64 = 64 << 20;

/// A sink that stores only the length of its file.
#[derive(Debug, Default)]
struct Length {
    position: u64,
    end: u64,
}

impl Write for Length {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.position += bytes.len() as u64;
        self.end = self.end.max(self.position);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Length {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        if let SeekFrom::Start(position) = to {
            self.position = position;
            return Ok(position);
        }
        Err(io::Error::from(io::ErrorKind::Unsupported))
    }
}

/// Returns the peak memory of this process so far, in bytes; `None` if the system does not report it.
#[expect(clippy::disallowed_methods, reason = "the test asks the system")]
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let number: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(number << 10)
}

/// Writes an image in bands, and returns the length of the file.
fn write(encoding: Encoding) -> u64 {
    let band = Raster::from_fn([SIZE[0], BAND], |x, y| (x * y % 97) as f32 / 96.0).unwrap();
    let mut writer = RowWriter::new(Length::default(), SIZE, Content::Gray, encoding).unwrap();
    let mut row = 0;
    while row < SIZE[1] {
        let height = BAND.min(SIZE[1] - row);
        let rows = band.view().crop([0, 0], [SIZE[0], height]).unwrap();
        writer.write_gray(rows).unwrap();
        row += height;
    }
    writer.finish().unwrap().end
}

#[test]
fn a_large_image_is_written_in_little_memory() {
    for encoding in [Encoding::Png(Depth::Eight), Encoding::Exr] {
        let length = write(encoding);
        assert!(length > 1 << 16, "{encoding:?} has {length} bytes");
        match peak() {
            Some(peak) => assert!(peak < LIMIT, "{encoding:?} took {peak} bytes"),
            None => println!("skipped: this system does not say how much memory was taken"),
        }
    }
}
