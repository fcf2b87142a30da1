//! Rays of ambient occlusion, in steps of whole pixels.
//!
//! Rays leave a pixel at 16 equally spaced azimuths of the plane. A ray advances in whole steps along the axis on
//! which it crosses more pixels. On the other axis the height is interpolated linearly between the two adjacent
//! pixels, so samples are exactly on the ray. Steps are one pixel at first and later an eighth of the distance, so
//! their number grows with the logarithm of the radius.

use super::OcclusionOptions;
use dapple_raster::glam::DVec2;

/// Number of azimuths.
const AZIMUTHS: usize = 16;

/// Ray directions over the first half turn, a sixteenth of a turn apart. The opposite directions complete the circle.
const DIRECTIONS: [[f64; 2]; AZIMUTHS / 2] = {
    // Cosines of 1/16, 2/16 and 3/16 of a turn.
    const C: [f64; 3] = [
        0.923_879_532_511_286_7,
        core::f64::consts::FRAC_1_SQRT_2,
        0.382_683_432_365_089_8,
    ];
    [
        [1.0, 0.0],
        [C[0], C[2]],
        [C[1], C[1]],
        [C[2], C[0]],
        [0.0, 1.0],
        [-C[2], C[0]],
        [-C[1], C[1]],
        [-C[0], C[2]],
    ]
};

/// Approximate number of steps in which the distance doubles, once steps are longer than a pixel.
const STEPS_TO_DOUBLE: u32 = 8;

/// Resolution of positions across a ray, in fractions of a pixel. Rounding to it makes positions equal in all windows,
/// despite the rounding error of their extents.
const PARTS: f64 = (1 << 20) as f64;

/// A ray: the samples in one azimuth.
#[derive(Clone, Debug)]
pub(super) struct Ray {
    /// Direction of the ray: a unit vector in the plane.
    pub(super) direction: DVec2,
    /// Samples in order of distance.
    pub(super) samples: Vec<Sample>,
}

/// A point on a ray between two pixels, which are identical or adjacent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// Offset of the first pixel in columns and rows from the start of the ray.
    pub(super) near: [i32; 2],
    /// Offset of the second pixel in columns and rows from the start of the ray.
    pub(super) far: [i32; 2],
    /// Position between `near` and `far`, from 0 to below 1.
    pub(super) part: f32,
    /// Distance from the start of the ray, in units of the plane.
    pub(super) distance: f64,
    /// Weight of heights above the tangent plane at this distance, from 0 to 1.
    pub(super) weight: f32,
}

/// Returns all rays, each followed by the opposite one. The radius is at most a few thousand pixels.
pub(super) fn rays(options: &OcclusionOptions, pixel: DVec2) -> Vec<Ray> {
    let halves = DIRECTIONS.iter().flat_map(|&direction| {
        let direction = DVec2::from(direction);
        [direction, -direction]
    });
    let ray = |direction| Ray {
        direction,
        samples: samples(options, direction, pixel),
    };
    halves.map(ray).collect()
}

/// Returns how far rays reach to each side, in columns and rows.
pub(super) fn reach(rays: &[Ray]) -> [u32; 2] {
    let samples = rays.iter().flat_map(|ray| &ray.samples);
    samples.fold([0; 2], |reach, sample| {
        [0, 1].map(|axis| {
            let ends = [sample.near, sample.far].map(|end| end[axis].unsigned_abs());
            reach[axis].max(ends[0]).max(ends[1])
        })
    })
}

/// Returns the samples of the ray in `direction`.
fn samples(options: &OcclusionOptions, direction: DVec2, pixel: DVec2) -> Vec<Sample> {
    // Pixels crossed per unit of distance.
    let speed = direction / pixel;
    let [along, across] = if speed.x.abs() >= speed.y.abs() {
        [0, 1]
    } else {
        [1, 0]
    };
    let crossed = speed[along].abs();
    let sample = |step: u32| {
        let place = f64::from(step) * (speed[across] / crossed);
        let place = (place * PARTS + 0.5).floor() / PARTS;
        let offset = |place: f64| {
            let mut offset = [0; 2];
            offset[along] = if speed[along] < 0.0 { -1 } else { 1 } * step as i32;
            offset[across] = place as i32;
            offset
        };
        let distance = f64::from(step) / crossed;
        Sample {
            near: offset(place.floor()),
            far: offset(place.ceil()),
            part: (place - place.floor()) as f32,
            distance,
            weight: weight(distance / options.radius, options.fade),
        }
    };
    // The small factor keeps a radius of a whole number of pixels whole, whatever the rounding error of the extent.
    let last = (options.radius * crossed * (1.0 + 1e-9)).floor() as u32;
    steps(last).into_iter().map(sample).collect()
}

/// Returns the fading weight of a height at a distance of `part` · radius: 1 up to the fade, then falling to 0 at the
/// radius.
fn weight(part: f64, fade: f64) -> f32 {
    if part <= 1.0 - fade {
        1.0
    } else {
        ((1.0 - part) / fade).clamp(0.0, 1.0) as f32
    }
}

/// Returns the distances of a ray's samples, in pixels, increasing up to and including `last`. They are one pixel
/// apart at first, and the gaps then grow.
fn steps(last: u32) -> Vec<u32> {
    let mut steps = Vec::new();
    let mut step = 0;
    while step < last {
        step = last.min(step + (step / STEPS_TO_DOUBLE).max(1));
        steps.push(step);
    }
    steps
}
