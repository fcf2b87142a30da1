//! The plane that heights are measured in, shared by all maps computed from heights.
//!
//! Lengths are in units of the plane; a raster covers a given extent of it.

use crate::{ColorError, ColorErrorKind};
use dapple_raster::glam::DVec2;
use dapple_raster::{Raster, Window, Wrap, parallel};

/// Maximum radius in pixels.
const MAX_RADIUS: u32 = 1 << 14;

/// The extent, strength and wrapping of a raster of heights, for computing normals, occlusion and curvature.
///
/// The options of each map contain a plane and can be created from it with [`From`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct HeightPlane {
    /// Height that the value 1 stands for, in units of the plane; negative turns hills into dents. [default: 1]
    pub strength: f64,
    /// Width and height of the raster in the plane, above 0. The default is 1 × 1, as in [`Window::unit`]. For a
    /// raster that is not square but has square pixels, set the true proportions here.
    pub extent: DVec2,
    /// How heights wrap beyond the edges, along x and y. [default: both repeat] Beyond a side that does not repeat,
    /// heights continue as in [`continue_heights`], whichever of the other two modes is set.
    pub wrap: [Wrap; 2],
}

impl Default for HeightPlane {
    fn default() -> Self {
        Self {
            strength: 1.0,
            extent: DVec2::ONE,
            wrap: [Wrap::Repeat; 2],
        }
    }
}

impl HeightPlane {
    /// Returns the plane of heights that were rendered in a window, with the given wrap of its sides. Both axes
    /// repeat in a raster that tiles. In a part of a larger plane, neither axis repeats; in that case, use
    /// [`normal_map_of_field`](crate::normal_map_of_field) and its siblings, which read the heights beyond the sides.
    #[must_use]
    pub fn for_window(window: &Window, wrap: [Wrap; 2]) -> Self {
        let side = |axis: usize| {
            let pixel = window.pixel[axis] * window.scale[axis];
            (pixel * f64::from(window.size[axis])).abs()
        };
        Self {
            extent: DVec2::new(side(0), side(1)),
            wrap,
            ..Self::default()
        }
    }

    /// Checks that the strength is finite and the extent is above zero and finite. `what` is the name of the strength.
    pub(crate) fn check(&self, what: &'static str) -> Result<(), ColorError> {
        let Self {
            strength, extent, ..
        } = *self;
        if !strength.is_finite() {
            let value = strength;
            return Err(ColorError::new(ColorErrorKind::NotFinite { what, value }));
        }
        if !(extent.is_finite() && extent.x > 0.0 && extent.y > 0.0) {
            return Err(ColorError::new(ColorErrorKind::Extent { extent }));
        }
        Ok(())
    }

    /// Returns the margins beyond sides that do not repeat, for a map that depends on `halo` pixels around each
    /// pixel.
    pub(crate) fn open_margin(&self, halo: [u32; 2]) -> [u32; 2] {
        [0, 1].map(|axis| match self.wrap[axis] {
            Wrap::Repeat => 0,
            Wrap::Clamp | Wrap::Mirror => halo[axis],
        })
    }

    /// Returns the width and height of a pixel, in units of the plane, for a raster of `size` pixels.
    pub(crate) fn pixel(&self, size: [u32; 2]) -> DVec2 {
        self.extent / DVec2::new(size[0].max(1).into(), size[1].max(1).into())
    }
}

/// Continues heights beyond the sides of an image that does not repeat: `h(-k) = 2 h(0) - h(k)`.
///
/// The raster contains the image and margins around it. For an axis along which the image does not repeat, `sides` is
/// the range of its pixels in the raster: the first one, and the one after the last. Heights outside this range are
/// replaced. Where a margin is longer than the image, heights are reflected again at the other side.
///
/// The point reflection at the outermost pixel keeps slopes. A plane stays a plane, so it has one normal, no occlusion
/// and no curvature up to its last row. Repeated pixels would halve its slope there, and mirrored pixels would make a
/// crease. Heights whose reflection is not in the raster stay unchanged.
pub fn continue_heights(heights: &mut Raster<f32>, sides: [Option<[i64; 2]>; 2]) {
    let [width, height] = heights.size();
    if let Some(sides) = sides[0] {
        let outside = terms_outside(sides, width);
        parallel::for_each_chunk(heights.pixels_mut(), width as usize, |_, row| {
            for (column, term) in &outside {
                row[*column] = term.sum(|at| row[at]);
            }
        });
    }
    if let Some(sides) = sides[1] {
        let width = width as usize;
        for (row, term) in terms_outside(sides, height) {
            let pixels = heights.pixels_mut();
            for column in 0..width {
                pixels[row * width + column] = term.sum(|at| pixels[at * width + column]);
            }
        }
    }
}

/// Returns the indices of a line of `length` heights that are outside `sides`, each with the formula that continues
/// the heights there. Indices whose formula needs a height outside the line are omitted.
fn terms_outside([from, end]: [i64; 2], length: u32) -> Vec<(usize, Term)> {
    let is_outside = |at: &i64| !(from..end).contains(at);
    let term = |at: i64| Some((at as usize, Term::new(at, [from, end], length)?));
    (0..i64::from(length))
        .filter(is_outside)
        .filter_map(term)
        .collect()
}

/// Formula for a height beyond the end of a line: the height at `at` times `sign`, plus the heights at both ends times
/// their factors.
struct Term {
    at: usize,
    sign: f64,
    /// Indices of the heights at both ends, and their factors.
    ends: [(usize, f64); 2],
}

impl Term {
    /// Returns the formula for an index; `None` if it needs a height outside the line.
    fn new(index: i64, [from, end]: [i64; 2], length: u32) -> Option<Self> {
        let last = end
            .checked_sub(from)?
            .checked_sub(1)
            .filter(|&last| last >= 0)?;
        let period = last.checked_mul(2)?.max(1);
        let index = index.checked_sub(from)?;
        let [turns, rest] = [index.div_euclid(period), index.rem_euclid(period)];
        let is_reflected = rest > last;
        let at = if is_reflected { period - rest } else { rest };
        let turns = 2.0 * turns as f64;
        let (sign, ends) = match is_reflected {
            true => (-1.0, [-turns, turns + 2.0]),
            false => (1.0, [-turns, turns]),
        };
        // A height with factor 0 may be outside the line.
        let within = |inside: i64, factor: f64| {
            let inside = from + inside;
            let is_within = (0..i64::from(length)).contains(&inside);
            (is_within || factor == 0.0).then_some((inside.max(0) as usize, factor))
        };
        Some(Self {
            at: within(at, sign)?.0,
            sign,
            ends: [within(0, ends[0])?, within(last, ends[1])?],
        })
    }

    fn sum(&self, height: impl Fn(usize) -> f32) -> f32 {
        let ends = self.ends.iter().filter(|(_, factor)| *factor != 0.0);
        let ends: f64 = ends
            .map(|&(at, factor)| factor * f64::from(height(at)))
            .sum();
        (ends + self.sign * f64::from(height(self.at))) as f32
    }
}

/// Checks that a radius is from 0 to [`MAX_RADIUS`] pixels.
pub(crate) fn check_radius(
    what: &'static str,
    radius: f64,
    pixel: DVec2,
) -> Result<(), ColorError> {
    if !radius.is_finite() {
        let value = radius;
        return Err(ColorError::new(ColorErrorKind::NotFinite { what, value }));
    }
    let pixels = radius / pixel.min_element();
    // In this form a pixel of size 0, whose quotient is NaN, is an error too.
    if !(pixels >= 0.0 && pixels <= f64::from(MAX_RADIUS)) {
        return Err(ColorError::new(ColorErrorKind::Radius {
            radius,
            pixels,
            limit: MAX_RADIUS,
        }));
    }
    Ok(())
}

/// Maps an index into the line, like [`Wrap::index`] but faster for indices that are already inside.
#[inline(always)]
pub(crate) fn index(wrap: Wrap, index: i64, length: u32) -> usize {
    if (0..i64::from(length)).contains(&index) {
        index as usize
    } else {
        wrap.index(index, length) as usize
    }
}

/// Adds margins to heights and [continues](continue_heights) the heights into them.
///
/// # Errors
///
/// [`Raster`](ColorErrorKind::Raster) if the raster would become too large with its margins.
pub(crate) fn with_margin(
    height: &Raster<f32>,
    margin: [u32; 2],
) -> Result<Raster<f32>, ColorError> {
    let size = height.size();
    let whole = [0, 1].map(|axis| size[axis].saturating_add(margin[axis].saturating_mul(2)));
    let mut extended = Raster::filled(whole, 0.0)?;
    let [left, above] = margin;
    fill_rows(&mut extended, |row, values| {
        if let Some(row) = row.checked_sub(above).filter(|&row| row < size[1]) {
            values[left as usize..][..size[0] as usize].copy_from_slice(height.row(row));
        }
    });
    let sides = [0, 1].map(|axis| {
        let first = i64::from(margin[axis]);
        (first > 0).then_some([first, first + i64::from(size[axis])])
    });
    continue_heights(&mut extended, sides);
    Ok(extended)
}

/// Calls `fill` for every row. Uses all cores if the feature `rayon` is enabled.
pub(crate) fn fill_rows(raster: &mut Raster<f32>, fill: impl Fn(u32, &mut [f32]) + Sync) {
    let width = raster.width() as usize;
    parallel::for_each_chunk(raster.pixels_mut(), width, |row, values| {
        fill(row as u32, values);
    });
}

#[cfg(test)]
pub(crate) mod checks;
