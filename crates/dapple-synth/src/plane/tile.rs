//! Tiles of an exemplar that does not repeat: its largest part that nearly does, with a new seam.
//!
//! No cut closes the seam of bricks whose courses do not meet. Here the side of the tile is one after which the image is
//! most like itself, so that courses do meet where it can be had; then a strip along the seam is synthesized again, which
//! bends what is left to fit.

use super::PlaneTexture;
use crate::engine::Progress;
use crate::{Edges, Exemplar, Options, SynthError};
use core::ops::ControlFlow;
use dapple_raster::{Raster, parallel};

/// Makes a tile of an exemplar: it repeats along the axes, and only a strip along their seams is synthesized.
///
/// The tile is at least half as large as the exemplar along each axis, and smaller by at least half of `width`, that of the
/// strip in pixels. Its side is a multiple of 2 to the number of levels less one. Along other axes it is as large.
///
/// # Errors
///
/// Those of [`PlaneTexture::repair`], and [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) for a strip that is not
/// at least 2 pixels wide, and wider than an eighth of a side.
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

/// How a tile lies in the exemplar along an axis.
struct Strip {
    /// The side of the tile.
    side: u32,
    /// The seam: before it pixels are from past the side, from it on they are from where they are.
    seam: u32,
    /// Half of the width around the seam that is made.
    half: u32,
}

impl Strip {
    /// All of a side, without a seam.
    fn none(side: u32) -> Self {
        Self {
            side,
            seam: 0,
            half: 0,
        }
    }

    /// The side after which an exemplar is most like itself, and a seam in the middle of what overlaps.
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
        let sides = (whole / 2).div_ceil(step)..(whole - half) / step + 1;
        let costs = parallel::map(sides.len(), |at| {
            let side = (sides.start + at as u32) * step;
            // Of sides that are equally good, as in a texture without a period, the largest.
            let lost = f64::from(whole - side) / f64::from(whole);
            difference(exemplar, axis, side) * (1.0 + lost)
        });
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

    /// The column or row of the exemplar at one of the tile.
    fn source(&self, at: u32) -> u32 {
        if at < self.seam { at + self.side } else { at }
    }

    /// Whether a column or row is in the strip.
    fn is_made(&self, at: u32) -> bool {
        let past = (at + self.side - self.seam) % self.side;
        past < self.half || past >= self.side - self.half
    }
}

/// The mean squared difference of an exemplar and itself moved along an axis.
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
