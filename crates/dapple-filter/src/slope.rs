//! Blur and warp along the paths on which water runs down a height.
//!
//! The path of a pixel follows the gradient of the height uphill, in steps of equal length. The blur averages values
//! along it, so that they smear downhill, as in line integral convolution (Brian Cabral and Leith Leedom, "Imaging
//! vector fields using line integral convolution", SIGGRAPH 1993). The warp takes the value at the end of the path.
//! Gradients and values are interpolated between pixels. A position on a path is an offset in pixels from the path's
//! first pixel, so that it has the same bits in every window.

use crate::Part;
use crate::gaussian::weights;
use crate::part::pixels_within;
use dapple_raster::parallel;
use glam::DVec2;

/// Maximum number of steps of a path of the blur. Longer paths have longer steps.
const MAX_STEPS: u32 = 32;

/// Blur along the paths on which water runs down heights.
#[derive(Clone, Debug)]
pub struct SlopeBlur {
    /// Length of a step, in units of the plane.
    length: f64,
    /// Weight of the value after each step.
    weights: Vec<f32>,
}

impl SlopeBlur {
    /// Creates a blur whose weights along a path are a Gaussian of the standard deviation `radius`, in units of the plane.
    #[must_use]
    pub fn new(radius: f64, pixel: DVec2) -> Self {
        let reach = 3.0 * radius;
        let length = pixel.min_element().max(reach / f64::from(MAX_STEPS));
        let count = pixels_within(reach, length);
        Self {
            length,
            weights: weights(radius, length, count, 1.0),
        }
    }

    /// Returns the halo of the blur: the columns and rows that a path can reach, plus the pixels for interpolation and
    /// gradients.
    #[must_use]
    pub fn halo(&self, pixel: DVec2) -> [u32; 2] {
        halo(self.length * self.weights.len() as f64, pixel)
    }

    /// Blurs the values of a part. Each pixel becomes the average along the path that leads uphill from it.
    ///
    /// # Panics
    ///
    /// If `heights` or `values` has fewer pixels than the part and its halo, which must equal [`halo`](Self::halo).
    #[must_use]
    pub fn apply(&self, values: &[f32], heights: &[f32], part: &Part) -> Vec<f32> {
        let numbers = self.apply_colors(values.as_chunks::<1>().0, heights, part);
        numbers.into_flattened()
    }

    /// Blurs the colors of a part along the paths that lead uphill; see [`apply`](Self::apply).
    ///
    /// # Panics
    ///
    /// Same as [`apply`](Self::apply).
    #[must_use]
    pub fn apply_colors<const N: usize>(
        &self,
        colors: &[[f32; N]],
        heights: &[f32],
        part: &Part,
    ) -> Vec<[f32; N]> {
        let paths = Paths::new(
            heights,
            part,
            self.length,
            FlowDirection::Downhill,
            self.weights.is_empty(),
        );
        paths.follow(part, colors, |lanes| {
            let here = lanes.values(colors);
            let mut sums = here;
            for &weight in &self.weights {
                lanes.step();
                let there = lanes.values(colors);
                for (lane, sum) in sums.iter_mut().enumerate() {
                    for ((sum, there), here) in sum.iter_mut().zip(there[lane]).zip(here[lane]) {
                        *sum += weight * (there - here);
                    }
                }
            }
            sums
        })
    }
}

dapple_raster::named! {
    /// Direction in which a flow moves values.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum FlowDirection {
        /// Down the slope.
        #[default]
        Downhill = "downhill",
        /// Up the slope.
        Uphill = "uphill",
        /// Along the contour lines, with the higher ground on the left: the curl of the height.
        Contour = "contour",
    }
}

/// Warp that moves values along the slope or the contour lines of a height, in steps of equal length.
#[derive(Clone, Debug)]
pub struct FlowWarp {
    /// Length of a step, in units of the plane.
    length: f64,
    steps: u32,
    direction: FlowDirection,
}

impl FlowWarp {
    /// Creates a warp by `amount` units of the plane in `steps` steps. More steps follow curved slopes closer.
    #[must_use]
    pub fn new(amount: f64, steps: u32, direction: FlowDirection) -> Self {
        Self {
            length: amount / f64::from(steps.max(1)),
            steps: if amount > 0.0 { steps } else { 0 },
            direction,
        }
    }

    /// Returns the halo of the warp: the columns and rows that a path can reach, plus the pixels for interpolation and
    /// gradients.
    #[must_use]
    pub fn halo(&self, pixel: DVec2) -> [u32; 2] {
        halo(self.length * f64::from(self.steps), pixel)
    }

    /// Warps the values of a part. Each pixel takes the value at the end of its path.
    ///
    /// # Panics
    ///
    /// If `heights` or `values` has fewer pixels than the part and its halo, which must equal [`halo`](Self::halo).
    #[must_use]
    pub fn apply(&self, values: &[f32], heights: &[f32], part: &Part) -> Vec<f32> {
        let numbers = self.apply_colors(values.as_chunks::<1>().0, heights, part);
        numbers.into_flattened()
    }

    /// Warps the colors of a part; see [`apply`](Self::apply).
    ///
    /// # Panics
    ///
    /// Same as [`apply`](Self::apply).
    #[must_use]
    pub fn apply_colors<const N: usize>(
        &self,
        colors: &[[f32; N]],
        heights: &[f32],
        part: &Part,
    ) -> Vec<[f32; N]> {
        let is_still = self.steps == 0;
        let paths = Paths::new(heights, part, self.length, self.direction, is_still);
        paths.follow(part, colors, |lanes| {
            for _ in 0..self.steps {
                lanes.step();
            }
            lanes.values(colors)
        })
    }
}

/// Returns the halo for paths of length `reach`, in units of the plane: columns and rows, plus the pixels for
/// interpolation and gradients. It is 0 if `reach` is 0.
fn halo(reach: f64, pixel: DVec2) -> [u32; 2] {
    if reach == 0.0 {
        return [0; 2];
    }
    // The small term covers the rounding of the steps.
    [pixel.x, pixel.y].map(|pixel| (reach / pixel + 1e-6).ceil() as u32 + 2)
}

/// Number of paths that are followed at the same time. A step depends on the previous step of its path, so a single
/// path would leave the processor idle.
const LANES: usize = 4;

/// The data that the paths of all pixels share. Paths run against the direction in which values flow.
struct Paths {
    /// Gradients of the heights at all pixels with neighbors on all sides; empty if no path has a step.
    gradients: Vec<[f32; 2]>,
    /// Number of columns of the part with its halo.
    wide: usize,
    /// Pixels per unit of the plane.
    per_pixel: [f64; 2],
    /// Length of a step, in units of the plane.
    length: f64,
    direction: FlowDirection,
}

/// The paths of several adjacent pixels of a row, and their current positions.
struct Lanes<'a> {
    paths: &'a Paths,
    first: [usize; LANES],
    /// Current position of each path: columns and rows from its first pixel.
    offsets: [[f64; 2]; LANES],
    places: [Place; LANES],
}

/// A position between four pixels: index of the upper left pixel, and offset from it in pixels, from 0 to 1.
#[derive(Clone, Copy)]
struct Place {
    index: usize,
    part: [f32; 2],
}

impl Paths {
    fn new(
        heights: &[f32],
        part: &Part,
        length: f64,
        direction: FlowDirection,
        is_still: bool,
    ) -> Self {
        let wide = part.input_size()[0] as usize;
        let per_pixel = [part.pixel.x, part.pixel.y].map(f64::recip);
        let count = if is_still { 0 } else { heights.len() };
        let mut gradients = vec![[0.0; 2]; count];
        parallel::for_each_chunk(&mut gradients, wide, |row, out| {
            let is_inside = row > 0 && (row + 2) * wide <= heights.len();
            for (column, out) in out.iter_mut().enumerate().filter(|_| is_inside) {
                if (1..wide - 1).contains(&column) {
                    let index = row * wide + column;
                    let [x, y] =
                        [1, wide].map(|step| heights[index + step] - heights[index - step]);
                    *out = [x * per_pixel[0] as f32, y * per_pixel[1] as f32];
                }
            }
        });
        Self {
            gradients,
            wide,
            per_pixel,
            length,
            direction,
        }
    }

    /// Computes a value for each pixel of a part. `follow` receives the paths of [`LANES`] adjacent pixels at a time,
    /// and returns their values.
    fn follow<const N: usize>(
        &self,
        part: &Part,
        values: &[[f32; N]],
        follow: impl Fn(&mut Lanes<'_>) -> [[f32; N]; LANES] + Sync,
    ) -> Vec<[f32; N]> {
        let width = part.size[0] as usize;
        let [left, above] = part.halo.map(|side| side as usize);
        let mut followed = vec![[0.0; N]; width * part.size[1] as usize];
        parallel::for_each_chunk(&mut followed, width, |row, out| {
            let start = (row + above) * self.wide + left;
            for (group, out) in out.chunks_mut(LANES).enumerate() {
                let start = start + group * LANES;
                if self.gradients.is_empty() {
                    out.copy_from_slice(&values[start..start + out.len()]);
                    continue;
                }
                // Lanes past the end of the row repeat its last pixel.
                let last = out.len() - 1;
                let mut lanes =
                    Lanes::new(self, core::array::from_fn(|lane| start + lane.min(last)));
                out.copy_from_slice(&follow(&mut lanes)[..=last]);
            }
        });
        followed
    }
}

impl<'a> Lanes<'a> {
    fn new(paths: &'a Paths, first: [usize; LANES]) -> Self {
        Self {
            paths,
            first,
            offsets: [[0.0; 2]; LANES],
            places: first.map(|first| Place::new(first, paths.wide, [0.0; 2])),
        }
    }

    /// Advances each path by a step. On level ground, a path stays in place.
    #[inline(always)]
    fn step(&mut self) {
        let paths = self.paths;
        for lane in 0..LANES {
            let uphill = self.places[lane].mix(paths.wide, &paths.gradients);
            let [x, y] = uphill.map(f64::from);
            let length = (x * x + y * y).sqrt();
            if length > 0.0 && length.is_finite() {
                let step = paths.length / length;
                // A path leads against the flow.
                let [x, y] = match paths.direction {
                    FlowDirection::Downhill => [x, y],
                    FlowDirection::Uphill => [-x, -y],
                    FlowDirection::Contour => [y, -x],
                };
                let offset = &mut self.offsets[lane];
                offset[0] += step * x * paths.per_pixel[0];
                offset[1] += step * y * paths.per_pixel[1];
                self.places[lane] = Place::new(self.first[lane], paths.wide, *offset);
            }
        }
    }

    /// Returns the interpolated values at the current positions of the paths.
    #[inline(always)]
    fn values<const N: usize>(&self, values: &[[f32; N]]) -> [[f32; N]; LANES] {
        self.places.map(|place| place.mix(self.paths.wide, values))
    }
}

impl Place {
    #[inline(always)]
    fn new(first: usize, wide: usize, offset: [f64; 2]) -> Self {
        // A truncation and a comparison are faster than `floor` without SSE4.1.
        let [x, y] = offset.map(|offset| offset as i64 - i64::from(offset < offset as i64 as f64));
        Self {
            index: (first as i64 + y * wide as i64 + x) as usize,
            part: [offset[0] - x as f64, offset[1] - y as f64].map(|part| part as f32),
        }
    }

    /// Interpolates bilinearly between the four pixels.
    #[inline(always)]
    fn mix<const N: usize>(self, wide: usize, values: &[[f32; N]]) -> [f32; N] {
        let mix = |a: [f32; N], b: [f32; N], part: f32| {
            core::array::from_fn(|channel| a[channel] + part * (b[channel] - a[channel]))
        };
        let index = self.index;
        let upper = mix(values[index], values[index + 1], self.part[0]);
        let lower = mix(values[index + wide], values[index + wide + 1], self.part[0]);
        mix(upper, lower, self.part[1])
    }
}
