//! Gaussian blur, in all directions or along one.
//!
//! The blur in all directions is separable: rows first, then columns. Weights are samples of the Gaussian at the pixel
//! centers, up to three standard deviations, divided by their sum. Each pass adds weighted differences from the center
//! in a fixed order, from the nearest pixels to the farthest. A constant therefore stays the same, bit for bit.

use super::{NodeKind, transform};
use crate::plan::{Builder, Step, Surroundings};
use crate::{Input, RecipeError, RecipeErrorKind};
use dapple_raster::{Range, parallel, range};
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Gaussian blur of a number or a color, in all directions or along one.
///
/// The value of a pixel is the weighted mean of the pixels within three radii. If the radius is below a third of a
/// pixel, the blur changes nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Blur {
    /// Number or color to blur.
    pub input: Input,
    /// Standard deviation of the Gaussian, in units of the plane.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: f64,
    /// Direction of a directional blur in degrees, clockwise: 0 is to the right, 90 is down [default: all directions].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<f64>,
    /// Whether a directional blur smears values forward only, as rust runs down a wall.
    #[serde(default)]
    pub one_sided: bool,
}

const DIRECTION: Range = range!(finite);

impl NodeKind for Blur {
    fn inputs(&self) -> Vec<&Input> {
        vec![&self.input]
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (radius, is_one_sided) = (plan.radius(Some(self.radius), 0.0)?, self.one_sided);
        let input = plan.any(&self.input)?;
        let Some(degrees) = self.along else {
            if is_one_sided {
                let rule = "a `one_sided` blur needs a direction `along`";
                return Err(RecipeError::new(RecipeErrorKind::Conflict { rule }));
            }
            let halo = move |pixel| gaussian_halo(radius, pixel);
            return Ok(plan.neighborhood(vec![input], halo, move |around| {
                Ok(around.each_channel(0, |values| gaussian(values, around, radius)))
            }));
        };
        RecipeError::check_in(DIRECTION, "direction", degrees)?;
        let direction = DVec2::from(transform::direction(degrees));
        let line = move |pixel| Line::new(direction, radius, is_one_sided, pixel);
        let halo = move |pixel| line(pixel).halo();
        Ok(plan.neighborhood(vec![input], halo, move |around| {
            let line = line(around.pixel);
            Ok(around.each_channel(0, |values| line.blur(values, around)))
        }))
    }
}

/// Returns the number of pixels of size `pixel` within three standard deviations.
fn reach(radius: f64, pixel: f64) -> u32 {
    // The small factor keeps a whole number of pixels whole, whatever the rounding error of the pixel size.
    (3.0 * radius / pixel * (1.0 + 1e-9)).floor() as u32
}

/// Returns the halo of a Gaussian blur.
pub(super) fn gaussian_halo(radius: f64, pixel: DVec2) -> [u32; 2] {
    [pixel.x, pixel.y].map(|pixel| reach(radius, pixel))
}

/// Returns the weights of the pixels at distances of 1 to `reach` pixels on one side; those on `sides` sides and the
/// center sum to 1.
pub(super) fn weights(radius: f64, pixel: f64, reach: u32, sides: f64) -> Vec<f32> {
    let weight = |distance: u32| {
        let part = f64::from(distance) * pixel / radius;
        libm::exp(-0.5 * part * part)
    };
    let weights: Vec<f64> = (1..=reach).map(weight).collect();
    let sum = 1.0 + sides * weights.iter().sum::<f64>();
    weights.iter().map(|weight| (weight / sum) as f32).collect()
}

/// Blurs the numbers of a window and its halo, which is that of [`gaussian_halo`]; returns those of the window.
pub(super) fn gaussian(values: &[f32], around: &Surroundings<'_>, radius: f64) -> Vec<f32> {
    let ([width, height], halo) = (around.size.map(|side| side as usize), around.halo);
    let [across, down] = [0, 1].map(|axis| weights(radius, around.pixel[axis], halo[axis], 2.0));
    let [left, above] = halo.map(|side| side as usize);
    // Blur along the rows of the window and its halo.
    let mut rows = vec![0.0; width * (height + 2 * above)];
    parallel::for_each_chunk(&mut rows, width, |row, out| {
        let line = &values[row * (width + 2 * left)..][..width + 2 * left];
        let part = |first: usize| &line[first..first + width];
        out.copy_from_slice(part(left));
        for (tap, &weight) in (1..).zip(&across) {
            add_pair(
                out,
                part(left),
                [part(left - tap), part(left + tap)],
                weight,
            );
        }
    });
    // Blur along the columns.
    let mut blurred = vec![0.0; width * height];
    parallel::for_each_chunk(&mut blurred, width, |row, out| {
        let line = |row: usize| &rows[row * width..][..width];
        let here = row + above;
        out.copy_from_slice(line(here));
        for (tap, &weight) in (1..).zip(&down) {
            add_pair(
                out,
                line(here),
                [line(here - tap), line(here + tap)],
                weight,
            );
        }
    });
    blurred
}

/// Adds the weighted differences of two lines from the center line.
fn add_pair(out: &mut [f32], here: &[f32], [before, after]: [&[f32]; 2], weight: f32) {
    let pairs = before.iter().zip(after);
    for ((out, &here), (&before, &after)) in out.iter_mut().zip(here).zip(pairs) {
        *out += weight * (before + after - (here + here));
    }
}

/// The samples of a directional blur. They are at whole pixels along the axis that the line crosses fastest, and are
/// interpolated between two pixels along the other.
struct Line {
    samples: Vec<Sample>,
}

/// A sample on the line: two pixels at offsets in columns and rows, and the part of the second one.
struct Sample {
    near: [i64; 2],
    far: [i64; 2],
    part: f32,
    weight: f32,
}

impl Line {
    fn new(direction: DVec2, radius: f64, is_one_sided: bool, pixel: DVec2) -> Self {
        // One step crosses one pixel along the fast axis.
        let crossed = direction / pixel;
        let fast = usize::from(crossed.y.abs() > crossed.x.abs());
        let per_unit = crossed[fast].abs();
        let step = crossed / per_unit;
        let reach = reach(radius, per_unit.recip());
        // Values are smeared forward, so that a pixel reads those behind it.
        let sides: &[f64] = if is_one_sided { &[-1.0] } else { &[-1.0, 1.0] };
        let weights = weights(radius, per_unit.recip(), reach, sides.len() as f64);
        let sample = |distance: f64, weight: f32, side: f64| {
            let offset = side * distance * step;
            let mut near = [offset.x.floor() as i64, offset.y.floor() as i64];
            near[fast] = (side * distance * step[fast]) as i64;
            let slow = 1 - fast;
            let part = offset[slow] - offset[slow].floor();
            let mut far = near;
            far[slow] += i64::from(part > 0.0);
            Sample {
                near,
                far,
                part: part as f32,
                weight,
            }
        };
        let samples = (1..).zip(weights).flat_map(|(distance, weight)| {
            sides
                .iter()
                .map(move |&side| sample(f64::from(distance), weight, side))
        });
        Self {
            samples: samples.collect(),
        }
    }

    /// Returns the number of columns and rows that the samples are away from the pixel.
    fn halo(&self) -> [u32; 2] {
        let offsets = self
            .samples
            .iter()
            .flat_map(|sample| [sample.near, sample.far]);
        offsets.fold([0; 2], |halo, offset| {
            [0, 1].map(|axis| {
                let distance = u32::try_from(offset[axis].unsigned_abs()).unwrap_or(u32::MAX);
                halo[axis].max(distance)
            })
        })
    }

    /// Blurs the numbers of a window and its halo; returns those of the window.
    fn blur(&self, values: &[f32], around: &Surroundings<'_>) -> Vec<f32> {
        let [width, height] = around.size.map(|side| side as usize);
        let [left, above] = around.halo.map(i64::from);
        let wide = around.input_size()[0] as usize;
        let mut blurred = vec![0.0; width * height];
        parallel::for_each_chunk(&mut blurred, width, |row, out| {
            let line = |[x, y]: [i64; 2]| {
                let first = (row as i64 + above + y) as usize * wide + (left + x) as usize;
                &values[first..first + width]
            };
            let here = line([0, 0]);
            out.copy_from_slice(here);
            for sample in &self.samples {
                let (near, far) = (line(sample.near), line(sample.far));
                let pairs = near.iter().zip(far);
                for ((out, &here), (&near, &far)) in out.iter_mut().zip(here).zip(pairs) {
                    *out += sample.weight * (near + sample.part * (far - near) - here);
                }
            }
        });
        blurred
    }
}
