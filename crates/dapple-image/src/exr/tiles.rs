//! Tiled OpenEXR files, written row by row with one band of tiles in memory.
//!
//! A file consists of a header, a table with the offset of every tile, and the tiles. The codec encodes the header and
//! the tiles; this module arranges them. Tiles are written band by band, and the table is written last, into the gap
//! reserved for it.
//!
//! The compression is run-length encoding. Compared with it on a fractal height of 2048 × 2048 pixels, and on colors
//! and normals derived from this height, ZIP makes files 0.6 to 2.5 % smaller and takes eleven times as long. The gain
//! is small because the lower bits of `f32` are noise. PIZ gains less and takes longer still. Masks, cells and flat
//! areas consist of runs.

use crate::limits::check_side;
use crate::rows::Sink;
use crate::{ImageError, ImageErrorKind};
use dapple_raster::{RasterView, parallel};
use exr::block::chunk::Chunk;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::compression::Compression;
use exr::math::{RoundingMode, Vec2};
use exr::meta::attribute::{
    ChannelDescription, LevelMode, LineOrder, SampleType, Text, TileDescription,
};
use exr::meta::header::{Header, LayerAttributes};
use exr::meta::{BlockDescription, MetaData, magic_number};
use std::io::SeekFrom;

/// Width and height of a tile, in pixels.
const TILE: usize = 64;

/// Number of tiles that are compressed before they are written.
const GROUP: usize = 64;

/// Maximum side that can be written, in pixels. Coordinates are signed 32-bit integers, and programs reject values
/// above half of their range.
const SIDE_LIMIT: u32 = i32::MAX as u32 / 2 - 1;

/// An OpenEXR file that is written to a sink. It does not own the sink, so that the codec is compiled only once.
pub(crate) struct TileStream {
    band: Band,
    /// Offset of the tile table in the file.
    table: u64,
    /// Offset of the next tile in the file.
    position: u64,
    /// Offsets of the tiles written so far.
    places: Vec<u64>,
}

/// Rows that are buffered until they fill a row of tiles.
struct Band {
    /// The only header of the file.
    headers: [Header; 1],
    /// Values of each row, plane by plane.
    values: Vec<f32>,
    /// Index of the image row at which the band starts.
    first_row: usize,
}

impl TileStream {
    /// Starts a file in an empty sink and writes its header. The names of `planes` are sorted.
    pub(crate) fn new(
        sink: &mut dyn Sink,
        size: [u32; 2],
        planes: &[&str],
    ) -> Result<Self, ImageError> {
        check_side(size, SIDE_LIMIT, "OpenEXR")?;
        let headers = [header(size, planes)];
        let feature = "an OpenEXR image of this size";
        let unsupported = || ImageError::new(ImageErrorKind::Unsupported { feature });
        // The format counts tiles in a signed 32-bit integer, and the codec relies on it.
        i32::try_from(headers[0].chunk_count).map_err(|error| unsupported().because(error))?;
        let bytes = header_bytes(&headers).map_err(|error| unsupported().because(error))?;
        let table = bytes.len() as u64;
        let position = table + 8 * headers[0].chunk_count as u64;
        sink.write_all(&bytes).map_err(failure)?;
        sink.seek(SeekFrom::Start(position)).map_err(failure)?;
        Ok(Self {
            band: Band {
                headers,
                values: Vec::new(),
                first_row: 0,
            },
            table,
            position,
            places: Vec::new(),
        })
    }

    /// Writes complete rows, at most the number of missing rows. `part` returns a pixel's sample in a plane.
    pub(crate) fn write_rows<T>(
        &mut self,
        sink: &mut dyn Sink,
        rows: RasterView<'_, T>,
        part: impl Fn(&T, usize) -> f32,
    ) -> Result<(), ImageError> {
        for row in rows.rows() {
            for plane in 0..self.band.planes() {
                let parts = row.iter().map(|value| part(value, plane));
                self.band.values.extend(parts);
            }
            if self.band.is_full() {
                self.write_band(sink)?;
            }
        }
        Ok(())
    }

    /// Completes the file after all rows were written.
    pub(crate) fn finish(self, sink: &mut dyn Sink) -> Result<(), ImageError> {
        let table: Vec<u8> = self.places.iter().flat_map(|at| at.to_le_bytes()).collect();
        let mut write = || {
            sink.seek(SeekFrom::Start(self.table))?;
            sink.write_all(&table)?;
            sink.seek(SeekFrom::Start(self.position))?;
            sink.flush()
        };
        write().map_err(failure)
    }

    /// Compresses and writes the tiles of the buffered rows, from left to right.
    fn write_band(&mut self, sink: &mut dyn Sink) -> Result<(), ImageError> {
        let columns: Vec<usize> = (0..self.band.size().x()).step_by(TILE).collect();
        let mut bytes = Vec::new();
        for group in columns.chunks(GROUP) {
            let chunks = parallel::map(group.len(), |index| self.band.chunk(group[index]));
            bytes.clear();
            for chunk in chunks {
                self.places.push(self.position + bytes.len() as u64);
                chunk
                    .and_then(|chunk| chunk.write(&mut bytes, 1))
                    .map_err(failure)?;
            }
            sink.write_all(&bytes).map_err(failure)?;
            self.position += bytes.len() as u64;
        }
        self.band.first_row += self.band.height();
        self.band.values.clear();
        Ok(())
    }
}

impl Band {
    fn size(&self) -> Vec2<usize> {
        self.headers[0].layer_size
    }

    fn planes(&self) -> usize {
        self.headers[0].channels.list.len()
    }

    fn height(&self) -> usize {
        self.values.len() / (self.size().x() * self.planes())
    }

    fn is_full(&self) -> bool {
        self.height() == TILE || self.first_row + self.height() == self.size().y()
    }

    /// Compresses the tile that starts at `column`.
    fn chunk(&self, column: usize) -> exr::error::Result<Chunk> {
        let columns = self.size().x();
        let width = TILE.min(columns - column);
        let mut data = Vec::with_capacity(4 * width * self.planes() * self.height());
        for line in self.values.chunks_exact(columns) {
            for value in &line[column..column + width] {
                data.extend_from_slice(&value.to_ne_bytes());
            }
        }
        let index = BlockIndex {
            layer: 0,
            pixel_position: Vec2(column, self.first_row),
            pixel_size: Vec2(width, self.height()),
            level: Vec2(0, 0),
        };
        UncompressedBlock { index, data }.compress_to_chunk(&self.headers)
    }
}

fn header(size: [u32; 2], planes: &[&str]) -> Header {
    let channel = |name: &&str| {
        let name = Text::from_slice_unchecked(name.as_bytes());
        ChannelDescription::new(name, SampleType::F32, false)
    };
    let blocks = BlockDescription::Tiles(TileDescription {
        tile_size: Vec2(TILE, TILE),
        level_mode: LevelMode::Singular,
        rounding_mode: RoundingMode::Down,
    });
    let size = (size[0] as usize, size[1] as usize);
    // The name belongs to the part, and the only part of a file needs no name.
    Header::new(Text::default(), size, planes.iter().map(channel).collect())
        .with_encoding(Compression::RLE, blocks, LineOrder::Increasing)
        .with_attributes(LayerAttributes::default())
}

fn header_bytes(headers: &[Header]) -> exr::error::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let requirements = MetaData::validate(headers, true)?;
    magic_number::write(&mut bytes)?;
    requirements.write(&mut bytes)?;
    Header::write_all(headers, &mut bytes, false)?;
    Ok(bytes)
}

fn failure(error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> ImageError {
    ImageError::new(ImageErrorKind::Io).because(error)
}
