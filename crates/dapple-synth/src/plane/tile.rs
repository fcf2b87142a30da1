//! Makes tiles from an exemplar that does not repeat: its largest part that nearly repeats, with a synthesized seam.
//!
//! No cut hides the seam of bricks whose courses do not line up. This method chooses the side of the tile as the shift
//! at which the image is most similar to itself, so that courses line up where possible. Then it re-synthesizes a strip
//! along the seam, which bends the remaining mismatch to fit.

use super::PlaneTexture;
use crate::engine::Progress;
use crate::{Edges, Exemplar, Options, SynthError};
use core::ops::ControlFlow;
use dapple_raster::{Raster, parallel};

/// Makes a tile from an exemplar; the tile repeats seamlessly along the given axes. Only a strip along the seams is
/// synthesized.
///
/// `width` is the width of the strip in pixels. Along each repeating axis, the side of the tile is a multiple of
/// 2^(number of levels - 1), from half the exemplar's side to the exemplar's side minus half of `width`. Along other
/// axes the tile has the exemplar's side.
///
/// # Errors
///
/// Same as [`PlaneTexture::repair`], or [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if a side of the
/// exemplar is below 4 · 2^(number of levels - 1), or if the width of the strip is not from 2 pixels to half of the
/// side.
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
    // Outside the strips the tile remains a copy of the exemplar.
    let mask = Raster::from_fn(size, |x, y| columns.is_made(x) || rows.is_made(y))?;
    texture.repair(exemplar, &mask, options, callback)
}

/// Extent of a tile along one axis of the exemplar, and its seam.
struct Strip {
    /// Side of the tile, in pixels.
    side: u32,
    /// Position of the seam, in pixels. Pixels before the seam come from one tile side further along the exemplar; all
    /// others come from their own position.
    seam: u32,
    /// Half the width of the strip around the seam that is synthesized, in pixels.
    half: u32,
}

impl Strip {
    /// Returns a strip for an axis along which the tile does not repeat: the whole side of the exemplar, without a
    /// seam.
    fn none(side: u32) -> Self {
        Self {
            side,
            seam: 0,
            half: 0,
        }
    }

    /// Chooses the tile's side as the shift at which the exemplar is most similar to itself. The seam is in the middle
    /// of the overlap.
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
            // Prefer larger sides: without a period, all are equally similar.
            let lost = f64::from(whole - side) / f64::from(whole);
            difference(exemplar, axis, side) * (1.0 + lost)
        });
        // Take the side with the lowest cost; of equal ones, the largest.
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

    /// Returns the column or row of the exemplar that a column or row of the tile is taken from.
    fn source(&self, at: u32) -> u32 {
        // The image continues across the borders of the tile; its two ends meet inside, at the seam.
        if at < self.seam { at + self.side } else { at }
    }

    /// Returns whether a column or row is in the strip that is synthesized.
    fn is_made(&self, at: u32) -> bool {
        let past = (at + self.side - self.seam) % self.side;
        past < self.half || past >= self.side - self.half
    }
}

/// Returns the mean squared difference between an exemplar and its copy shifted by `by` pixels along an axis, over
/// their overlap.
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
