//! Tiles from an exemplar that does not repeat: its largest part that nearly repeats, with a synthesized seam.
//!
//! No cut closes the seam of bricks whose courses do not meet. This method chooses the side of the tile as the shift at
//! which the image is most similar to itself, so that courses meet where possible. Then it synthesizes a strip along
//! the seam again, which bends the remaining mismatch to fit.

use super::PlaneTexture;
use crate::engine::Progress;
use crate::{Edges, Exemplar, Options, SynthError};
use core::ops::ControlFlow;
use dapple_raster::{Raster, parallel};

/// Makes a tile of an exemplar that repeats along the given axes. Only a strip along the seams is synthesized.
///
/// `width` is the width of the strip in pixels. Along each repeating axis the side of the tile is at least half that of
/// the exemplar, at most the exemplar's side minus half of `width`, and a multiple of 2^(number of levels - 1). Along
/// other axes the tile has the size of the exemplar.
///
/// # Errors
///
/// The errors of [`PlaneTexture::repair`], and [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) for an exemplar
/// with a side below 4 · 2^(number of levels - 1), and for a strip that is not from 2 pixels to half of the side wide.
pub fn tile_plane(
    exemplar: &Exemplar,
    axes: [bool; 2],
    width: u32,
    options: &Options,
    callback: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<PlaneTexture, SynthError> {
    let mut strips = [Strip::none(exemplar.size[0]), Strip::none(exemplar.size[1])];
    for (axis, strip) in strips.iter_mut().enumerate() {
        if axes[axis] {
            *strip = Strip::new(exemplar, axis, width, options.n_levels)?;
        }
    }
    let size = strips.each_ref().map(|strip| strip.side);
    let [columns, rows] = &strips;
    let texture = PlaneTexture {
        sources: Raster::from_fn(size, |x, y| [columns.source(x), rows.source(y)])?,
        edges: axes.map(|repeats| if repeats { Edges::Wrap } else { Edges::Cut }),
        exemplar_size: exemplar.size,
        exemplar_edges: exemplar.edges,
    };
    let mask = Raster::from_fn(size, |x, y| columns.is_made(x) || rows.is_made(y))?;
    texture.repair(exemplar, &mask, options, callback)
}

/// The part of the exemplar that a tile covers along one axis, and its seam.
struct Strip {
    /// The side of the tile.
    side: u32,
    /// Position of the seam. Pixels before it are taken from one side length further on, all others from their own
    /// position.
    seam: u32,
    /// Half the width of the strip around the seam that is synthesized.
    half: u32,
}

impl Strip {
    /// The whole side of the exemplar, without a seam.
    fn none(side: u32) -> Self {
        Self {
            side,
            seam: 0,
            half: 0,
        }
    }

    /// Chooses the side as the shift at which the exemplar is most similar to itself. The seam is in the middle of the
    /// overlap.
    fn new(
        exemplar: &Exemplar,
        axis: usize,
        width: u32,
        n_levels: usize,
    ) -> Result<Self, SynthError> {
        let whole = exemplar.size[axis];
        let step = 1 << n_levels.saturating_sub(1).min(31);
        let half = width / 2;
        let holds = whole / 4 >= step;
        let range = "at least 4 times 2 to the number of levels less one";
        SynthError::check(holds, "side of the exemplar", whole.into(), range)?;
        let holds = half > 0 && width <= whole / 2;
        let range = "from 2 to half of the side";
        SynthError::check(holds, "width of a strip", width.into(), range)?;
        // Compare the exemplar with itself at every allowed shift.
        let sides = (whole / 2).div_ceil(step)..(whole - half) / step + 1;
        let costs = parallel::map(sides.len(), |at| {
            let side = (sides.start + at as u32) * step;
            // Prefer the largest of equally good sides, as in a texture without a period.
            let lost = f64::from(whole - side) / f64::from(whole);
            difference(exemplar, axis, side) * (1.0 + lost)
        });
        // Take the lowest cost; of equal ones, the largest side.
        let mut best = (f64::INFINITY, sides.end - 1);
        for (side, cost) in sides.zip(costs).rev() {
            if cost < best.0 {
                best = (cost, side);
            }
        }
        let side = best.1 * step;
        Ok(Self {
            side,
            seam: (whole - side) / 2,
            half,
        })
    }

    /// The column or row of the exemplar for one of the tile.
    fn source(&self, at: u32) -> u32 {
        if at < self.seam { at + self.side } else { at }
    }

    /// Whether a column or row is in the strip that is synthesized.
    fn is_made(&self, at: u32) -> bool {
        let past = (at + self.side - self.seam) % self.side;
        past < self.half || past >= self.side - self.half
    }
}

/// The mean squared difference between an exemplar and its copy shifted by `by` pixels along an axis, over their
/// overlap.
fn difference(exemplar: &Exemplar, axis: usize, by: u32) -> f64 {
    let [width, height] = exemplar.size.map(|side| side as usize);
    let n = exemplar.n_channels;
    let pixels = &exemplar.pixels;
    let shift = by as usize * n * if axis == 0 { 1 } else { width };
    let len = match axis {
        0 => (width - by as usize) * n,
        _ => width * n,
    };
    let rows = if axis == 0 {
        height
    } else {
        height - by as usize
    };
    let mut sum = 0.0;
    for row in 0..rows {
        let first = row * width * n;
        let [here, there] = [first, first + shift].map(|first| &pixels[first..first + len]);
        for (a, b) in here.iter().zip(there) {
            let step = f64::from(a - b);
            sum += step * step;
        }
    }
    sum / (rows * len) as f64
}
