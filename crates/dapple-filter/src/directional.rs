//! Gaussian blur along a direction.

use crate::Part;
use crate::gaussian::weights;
use crate::part::pixels_within;
use dapple_raster::parallel;
use glam::DVec2;

/// Gaussian blur along a direction.
///
/// Samples are at whole pixels along the axis that the line crosses fastest, and are
/// interpolated between two pixels along the other.
#[derive(Clone, Debug)]
pub struct DirectionalBlur {
    samples: Vec<Sample>,
}

/// A sample on the line, interpolated between two pixels. `near` and `far` are their offsets in columns and rows.
/// `part` is the interpolation weight of `far`, and `weight` is the weight of the sample in the blur.
#[derive(Clone, Debug)]
struct Sample {
    near: [i64; 2],
    far: [i64; 2],
    part: f32,
    weight: f32,
}

impl DirectionalBlur {
    /// Creates a blur along `direction`, a unit vector, with the standard deviation `radius` in units of the plane. A
    /// one-sided blur smears values forward only.
    #[must_use]
    pub fn new(direction: DVec2, radius: f64, is_one_sided: bool, pixel: DVec2) -> Self {
        // One step crosses one pixel along the fast axis.
        let crossed = direction / pixel;
        let fast = usize::from(crossed.y.abs() > crossed.x.abs());
        let per_unit = crossed[fast].abs();
        let step = crossed / per_unit;
        let reach = pixels_within(3.0 * radius, per_unit.recip());
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

    /// Returns the halo of the blur: the maximum offset from a pixel to a sample, in columns and rows.
    #[must_use]
    pub fn halo(&self) -> [u32; 2] {
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

    /// Blurs a part of a raster.
    ///
    /// # Panics
    ///
    /// If `values` has fewer pixels than the part and its halo, which must equal [`halo`](Self::halo).
    #[must_use]
    pub fn apply(&self, values: &[f32], part: &Part) -> Vec<f32> {
        let [width, height] = part.size.map(|side| side as usize);
        let [left, above] = part.halo.map(i64::from);
        let wide = part.input_size()[0] as usize;
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
