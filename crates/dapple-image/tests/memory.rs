//! Tests that rows are written to a file in little memory, however many there are. It is a separate binary, since it
//! measures its peak memory.

use dapple_image::{Content, Depth, Encoding, RowWriter};
use dapple_raster::Raster;
use std::io::{self, Seek, SeekFrom, Write};

/// The numbers of columns and rows. As one raster of `f32` the image takes 256 MiB.
const SIZE: [u32; 2] = [16384, 4096];

/// The number of rows that are written at a time.
const BAND: u32 = 100;

/// The memory limit in bytes: a band of rows and the band of tiles take 11 MB; the rest is for the program itself.
const LIMIT: u64 = 64 << 20;

/// A sink that only keeps the length of its file.
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

/// Returns the peak memory of this process so far, if the system reports it.
#[expect(clippy::disallowed_methods, reason = "the test asks the system")]
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let number: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(number << 10)
}

/// Returns the length of a file whose rows come in bands.
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
