//! Builds atlases of square tiles, each with two right triangles.

use super::{Atlas, NONE, check_padding, check_side};
use crate::{SynthError, SynthErrorKind};
use dapple_mesh::{FaceIdx, Surface};
use dapple_raster::Raster;
use glam::DVec2;

/// Padding around the triangles of a tile, in texels.
#[derive(Clone, Copy)]
struct Frame {
    padding: u32,
}

impl Frame {
    fn new(padding: u32) -> Result<Self, SynthError> {
        check_padding(padding)?;
        Ok(Self { padding })
    }

    /// Returns the difference between the side of a tile and the legs of its triangles, in texels. It consists of the
    /// padding at both ends of a leg, twice the padding between the hypotenuses (measured along an axis), and half a
    /// texel at both ends.
    fn width(self) -> u32 {
        4 * self.padding + 1
    }

    /// Returns the minimum side of a tile, in texels, for which the legs of its triangles are one texel long.
    fn tile_min(self) -> u32 {
        self.width() + 1
    }

    /// Returns the grid spacing of tile positions: the largest power of two up to the padding.
    fn step(self) -> u32 {
        1 << self.padding.ilog2()
    }
}

/// Returns the default padding, in texels, in a map of the given side. It is used both for tiles of the same size and
/// for tiles by area.
///
/// The padding shortens the legs of the triangles by about four times its width. With the default, three quarters of a
/// tile's side remain.
pub(super) fn padding(surface: &Surface, side: u32) -> u32 {
    let part = side / tiles_across(surface) / 16;
    part.checked_ilog2().map_or(1, |log| 1 << log.min(10))
}

/// Returns the number of tiles per row if all have the same size.
fn tiles_across(surface: &Surface) -> u32 {
    let n_tiles = (surface.mesh().faces().len() as u32).div_ceil(2);
    let root = n_tiles.isqrt();
    root + u32::from(root * root < n_tiles)
}

/// A tile with one or two faces. Positions and sides are in texels.
struct Tile {
    first: [u32; 2],
    side: u32,
    faces: [Option<u32>; 2],
}

pub(super) fn uniform(surface: &Surface, side: u32, padding: u32) -> Result<Atlas, SynthError> {
    check_side(side)?;
    let frame = Frame::new(padding)?;
    let n_faces = surface.mesh().faces().len() as u32;
    let (n_tiles, across) = (n_faces.div_ceil(2), tiles_across(surface));
    let tile = side / across / frame.step() * frame.step();
    if tile < frame.tile_min() {
        return Err(too_small(side));
    }
    let tiles = (0..n_tiles).map(|number| Tile {
        first: [number % across * tile, number / across * tile],
        side: tile,
        faces: [2 * number, 2 * number + 1].map(|face| (face < n_faces).then_some(face)),
    });
    fill(surface, side, frame, tiles)
}

pub(super) fn by_area(surface: &Surface, side: u32, padding: u32) -> Result<Atlas, SynthError> {
    check_side(side)?;
    let frame = Frame::new(padding)?;
    // Sort the faces by the legs of a right triangle of the same area, largest first.
    let n_faces = surface.mesh().faces().len() as u32;
    let leg = |face: u32| (2.0 * surface.face_area(FaceIdx(face))).sqrt();
    let mut faces: Vec<(f64, u32)> = (0..n_faces).map(|face| (leg(face), face)).collect();
    faces.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    // Find the largest scale whose tiles fit, by bisection. At scale 0 all tiles have the minimum size.
    let (mut low, mut high) = (0.0, f64::from(side) / faces[0].0);
    pack(&faces, low, side, frame).ok_or_else(|| too_small(side))?;
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if pack(&faces, middle, side, frame).is_some() {
            low = middle;
        } else {
            high = middle;
        }
    }
    let tiles = pack(&faces, low, side, frame).ok_or_else(|| too_small(side))?;
    fill(surface, side, frame, tiles.into_iter())
}

/// Packs the tiles of `faces`, which are sorted by the lengths of their legs, longest first, in shelves. `None` if they
/// do not fit.
fn pack(faces: &[(f64, u32)], scale: f64, side: u32, frame: Frame) -> Option<Vec<Tile>> {
    let mut tiles = Vec::with_capacity(faces.len().div_ceil(2));
    let (mut at, mut shelf) = ([0, 0], 0);
    for pair in faces.chunks(2) {
        let wanted = pair[0].0 * scale + f64::from(frame.width());
        // Round the side up to a power of two.
        let mut tile = frame.tile_min().next_power_of_two();
        while f64::from(tile) < wanted {
            tile *= 2;
        }
        // Start a new shelf at the end of a row.
        if at[0] + tile > side {
            at = [0, at[1] + shelf];
        }
        if at[0] == 0 {
            shelf = tile;
        }
        if tile > side || at[1] + tile > side {
            return None;
        }
        tiles.push(Tile {
            first: at,
            side: tile,
            faces: [Some(pair[0].1), pair.get(1).map(|face| face.1)],
        });
        at[0] += tile;
    }
    Some(tiles)
}

/// Writes the tiles into an atlas.
fn fill(
    surface: &Surface,
    side: u32,
    frame: Frame,
    tiles: impl Iterator<Item = Tile>,
) -> Result<Atlas, SynthError> {
    let mut faces = Raster::filled([side; 2], NONE)?;
    let mut corners = vec![[DVec2::NAN; 3]; surface.mesh().faces().len()];
    for tile in tiles {
        let legs = f64::from(tile.side - frame.width());
        let padding = f64::from(frame.padding) + 0.5;
        let origin = DVec2::new(f64::from(tile.first[0]), f64::from(tile.first[1]));
        for (half, face) in tile.faces.into_iter().enumerate() {
            let Some(face) = face else { continue };
            // The right angle of the first triangle is at the tile's first corner; the second triangle has it at the
            // last corner.
            let (corner, way) = match half {
                0 => (origin + padding, 1.0),
                _ => (origin + f64::from(tile.side) - padding, -1.0),
            };
            // Rows go down: this order of the ends does not mirror the face.
            let ends = [DVec2::ZERO, DVec2::Y * legs, DVec2::X * legs];
            let first = opposite_longest(surface, FaceIdx(face));
            for (at, end) in ends.into_iter().enumerate() {
                corners[face as usize][(first + at) % 3] = corner + end * way;
            }
        }
        // Split the texels along the diagonal.
        let side = tile.side;
        for y in 0..side {
            let row = faces.width() as usize * (tile.first[1] + y) as usize;
            let row = &mut faces.pixels_mut()[row + tile.first[0] as usize..][..side as usize];
            for (x, face) in (0..).zip(row) {
                let half = usize::from(x + y + 1 >= side);
                *face = tile.faces[half].unwrap_or(NONE);
            }
        }
    }
    Ok(Atlas {
        faces,
        corners,
        mipmaps: false,
    })
}

/// Returns the corner opposite the longest edge, where a right angle causes the least distortion. Among equally long
/// edges the first wins.
fn opposite_longest(surface: &Surface, face: FaceIdx) -> usize {
    let [a, b, c] = surface.mesh().corners(face);
    let lengths = [
        b.distance_squared(c),
        c.distance_squared(a),
        a.distance_squared(b),
    ];
    let mut longest = 0;
    for corner in 1..3 {
        if lengths[corner] > lengths[longest] {
            longest = corner;
        }
    }
    longest
}

fn too_small(side: u32) -> SynthError {
    SynthError::new(SynthErrorKind::Range {
        what: "side of the texture map",
        value: side.into(),
        range: "large enough for a tile of 2 + 4 paddings in texels for every two faces",
    })
}
