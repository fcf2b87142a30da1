//! Draws round suckers on the skin of an octopus: pale cups of several sizes, each with a dark hollow and a rim.
//!
//! The image tiles.

use crate::draw::{sampled, smooth_step};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_points::hash::{CellHash, Seed, unit_f64};
use dapple_points::{Domain, poisson_disk};
use dapple_raster::Raster;
use dapple_worley::{Feature, FeatureSet};
use glam::DVec2;

/// Minimum distance between suckers, in multiples of the image width.
const SPACING: f64 = 0.21;

/// Maximum radius of a sucker, so that suckers do not touch.
const RADIUS: f64 = 0.5 * SPACING;

/// Number of samples along each side of a pixel.
const N_SAMPLES: u32 = 5;

/// Draws suckers, `size` pixels wide and high.
pub(super) fn suckers(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let centers = poisson_disk(Domain::torus(DVec2::ZERO, DVec2::ONE), SPACING, Seed(8))?;
    let centers = FeatureSet::new(centers.positions(), [Some(1.0); 2])?;
    let cup = ColorRamp::from_hex(&[
        "#4a1508", "#8a3a1c", "#e0a070", "#f6dcae", "#f3cf98", "#d98a58", "#5c1a0c",
    ])?;
    let skin = ColorRamp::from_hex(&["#8c2f14", "#c1562a"])?;
    Ok(sampled([size; 2], N_SAMPLES, |at| {
        let [nearest, second] = centers.sample::<2>(at);
        let part = f64::from(nearest.distance) / radius(nearest.id);
        let gap = f64::from(second.distance - nearest.distance);
        let skin = skin.at(smooth_step(0.0, 0.1, gap) as f32) * shade(&nearest, 1.6 - part);
        let cup = cup.at(part as f32) * shade(&nearest, slope(part));
        cup.lerp(skin, smooth_step(0.94, 1.06, part) as f32)
    })?)
}

/// Returns the radius of the sucker with this feature id, in multiples of the image width.
fn radius(id: u64) -> f64 {
    let part = unit_f64(CellHash::new(Seed(5), [id as i64]).at(0));
    RADIUS * (0.62 + 0.38 * part)
}

/// Returns the outward slope of a sucker at `part`, a fraction of its radius. The sucker rises to the rim and falls
/// beyond it.
fn slope(part: f64) -> f64 {
    if part < 0.62 {
        4.0 * part * (0.62 - part) / 0.62
    } else {
        -1.6 * (part - 0.62) / 0.38
    }
}

/// Returns the shade of a surface that rises away from `center` by `slope`, lit from the upper left.
fn shade(center: &Feature<DVec2>, slope: f64) -> f32 {
    let light = DVec2::new(0.6, 0.8).dot(center.vector.normalize_or_zero());
    (1.0 + 0.35 * slope * light).max(0.0) as f32
}
