//! Rows of documentation images about radial cells, and about feature points placed by the caller.

use super::{SAMPLES, fine, gray_with_edges, shaded};
use crate::Panel;
use crate::docs::Strip;
use crate::draw::shrink;
use dapple_raster::Raster;
use dapple_worley::{Combination, FeatureSet, Metric, Radial, RadialCells, Worley3, hash::Seed};
use glam::{DVec2, DVec3};

/// Value of pixels outside the sphere.
const OUTSIDE: f32 = 1.0;

/// Number of shades in a globe. It is higher than in other images with edges, since shading changes slowly.
const SHADES: f32 = 22.0;

fn radial(metric: Metric, around: u32, polar: f64, radial: f64) -> anyhow::Result<Radial> {
    let texture = Worley3::new(Seed(3)).with_metric(metric)?;
    let texture = texture.combine(Combination::F1).normalized()?;
    let cells = RadialCells {
        around,
        polar,
        radial,
    };
    Ok(Radial::new(texture, cells)?)
}

/// Renders a smooth image of a disk.
fn disk(label: &str, value: impl Fn(DVec2) -> f32 + Sync) -> anyhow::Result<Panel> {
    let samples = Raster::from_window(&fine(2.0)?, value)?;
    Ok(shaded(label, &shrink(&samples, SAMPLES)?, SHADES))
}

/// Renders the unit sphere, seen from slightly above its equator.
fn globe(label: &str, radial: &Radial) -> anyhow::Result<Panel> {
    disk(label, |at| {
        let [right, up] = [at.x - 1.0, 1.0 - at.y];
        let depth_sq = 1.0 - right * right - up * up;
        if depth_sq < 0.0 {
            return OUTSIDE;
        }
        // The view is rotated by 37 degrees; the sine of this angle is 0.6.
        let toward = depth_sq.sqrt();
        let on_sphere = DVec3::new(right, 0.6 * up - 0.8 * toward, 0.8 * up + 0.6 * toward);
        let light = 0.35 + 0.65 * toward as f32;
        radial.value(on_sphere).clamp(0.0, 1.0) * light
    })
}

/// Renders the cross-section of the unit ball at its equator.
fn cut(label: &str, radial: &Radial) -> anyhow::Result<Panel> {
    disk(label, |at| {
        let at = at - DVec2::ONE;
        if at.length_squared() > 1.0 {
            return OUTSIDE;
        }
        radial.value(DVec3::new(at.x, at.y, 0.0))
    })
}

pub(super) const RADIAL: Strip = Strip {
    name: "radial",
    caption: "F1 by the Chebyshev metric, 12 cells around and 6 from pole to pole",
    render: || {
        let plates = radial(Metric::Chebyshev, 12, 6.0, 0.0)?;
        Ok(vec![globe("a sphere with plates", &plates)?])
    },
};

pub(super) const RADIAL_CELLS: Strip = Strip {
    name: "radial-cells",
    caption: "F1 on spheres, and on cuts through them along the equator",
    render: || {
        let cells =
            |around, polar, per_radius| radial(Metric::Euclidean, around, polar, per_radius);
        Ok(vec![
            globe(
                "12 cells around and 6 from pole to pole",
                &cells(12, 6.0, 0.0)?,
            )?,
            globe("24 around", &cells(24, 6.0, 0.0)?)?,
            globe("12 from pole to pole", &cells(12, 12.0, 0.0)?)?,
            cut("a cut with 0 cells per radius", &cells(12, 6.0, 0.0)?)?,
            cut("a cut with 3 cells per radius", &cells(12, 6.0, 3.0)?)?,
        ])
    },
};

/// Cosine and sine of the golden angle, 137.5 degrees.
const GOLDEN: DVec2 = DVec2::new(-0.737_368_878_078_319_7, 0.675_490_294_261_523_8);

/// Returns `n` points on a spiral around the center of the unit square, arranged like the seeds of a sunflower.
fn sunflower(n: u32) -> Vec<DVec2> {
    let turns = core::iter::successors(Some(DVec2::X), |turn| Some(turn.rotate(GOLDEN)));
    let radii = (0..n).map(|index| 0.4 * ((f64::from(index) + 0.5) / f64::from(n)).sqrt());
    turns
        .zip(radii)
        .map(|(turn, radius)| DVec2::splat(0.5) + turn * radius)
        .collect()
}

pub(super) const FEATURE_SET: Strip = Strip {
    name: "feature-set",
    caption: "F1 over 60 points on a spiral",
    render: || {
        let points = sunflower(60);
        let kinds = [
            ("without a period", [None, None], Metric::Euclidean),
            (
                "with a period along x",
                [Some(0.75), None],
                Metric::Euclidean,
            ),
            ("by the Manhattan metric", [None, None], Metric::Manhattan),
        ];
        let panels = kinds.into_iter().map(|(label, period, metric)| {
            let set = FeatureSet::new(&points, period)?.with_metric(metric)?;
            gray_with_edges(label, 1.0, |at| set.sample::<1>(at)[0].distance / 0.12)
        });
        panels.collect()
    },
};
