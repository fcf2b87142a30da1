//! Rows of documentation images about control points and their weights.

use super::{labels, values};
use crate::Panel;
use crate::docs::Strip;
use crate::docs::picture::{GRAYS, SIDE, shaded, square};
use crate::draw::{Canvas, label_gray};
use dapple_points::{Domain, PointIdx, poisson_disk};
use dapple_pups::{
    AxialWeight, CellsOptions, NetOptions, NoiseOptions, Orientations, Pups, Spacing, cells,
    hash::Seed, noise, random_values,
};
use dapple_raster::Raster;
use glam::{DVec2, DVec3};

/// Side of an image in units of the domain, large enough for a few control points.
const UNITS: f64 = 1.4;

/// Distance between control points, in units of the domain.
const DISTANCE: f64 = 0.3;

pub(super) const PUPS: Strip = Strip {
    name: "pups",
    caption: "",
    render: || {
        let points = poisson_disk(Domain::paper_torus(), DISTANCE, Seed(4))?;
        let pups = Pups::delaunay(&points)?;
        let window = square(UNITS, SIDE)?;
        let lengths = points.iter().map(|(point, at)| (at.length(), point));
        let nearest = lengths.min_by(|a, b| a.0.total_cmp(&b.0));
        let center = nearest.map_or(PointIdx(0), |(_, point)| point);
        let weight = Raster::from_window(&window, |at| pups.weight(center, at))?;
        let shades: Vec<f32> = (0..).take(points.len()).map(label_gray).collect();
        let cells = pups.label_raster(&window, &shades)?;
        let texture = pups.texture(random_values(points.len(), Seed(4)))?;
        let dotted = |label: &str, raster: Raster<f32>, ink: f32| -> anyhow::Result<Panel> {
            let mut canvas = Canvas::over(&window, raster)?;
            canvas.points(&points, 1.5, ink);
            Ok(shaded(label, &canvas.into_raster(), GRAYS))
        };
        Ok(vec![
            dotted("the weight of one control point", weight, 0.6)?,
            dotted("which weight is the largest", cells, 0.0)?,
            values("values, interpolated", UNITS, &texture)?,
        ])
    },
};

pub(super) const AXIS_SCALE: Strip = Strip {
    name: "axis-scale",
    caption: "Axis scale",
    render: || {
        [("0.6", 0.6), ("1", 1.0), ("2", 2.0)]
            .into_iter()
            .map(|(label, axis_scale)| {
                let net = NetOptions {
                    axis_scale,
                    ..NetOptions::default()
                };
                interpolated(label, net)
            })
            .collect()
    },
};

pub(super) const AXIAL_WEIGHT: Strip = Strip {
    name: "axial-weight",
    caption: "",
    render: || {
        let oscillating = AxialWeight::Oscillating {
            dips: 3,
            depth: 0.9,
        };
        [
            ("cubic", AxialWeight::Cubic),
            ("quintic", AxialWeight::Quintic),
            ("oscillating, with 3 dips of depth 0.9", oscillating),
        ]
        .into_iter()
        .map(|(label, weight)| {
            let net = NetOptions {
                weight,
                ..NetOptions::default()
            };
            interpolated(label, net)
        })
        .collect()
    },
};

pub(super) const ORIENTATIONS: Strip = Strip {
    name: "orientations",
    caption: "Cells, one for each control point",
    render: || {
        [
            ("none", Orientations::None),
            ("random", Orientations::Random),
            ("the same, to the right", Orientations::Same(DVec3::X)),
            ("away from the middle", Orientations::AwayFrom(DVec2::ZERO)),
        ]
        .into_iter()
        .map(|(label, orientations)| oriented(label, orientations, 0.5))
        .collect()
    },
};

pub(super) const STRENGTH: Strip = Strip {
    name: "strength",
    caption: "Random orientations, strength",
    render: || {
        [("0", 0.0), ("0.5", 0.5), ("0.9", 0.9)]
            .into_iter()
            .map(|(label, strength)| oriented(label, Orientations::Random, strength))
            .collect()
    },
};

pub(super) const SPACING: Strip = Strip {
    name: "spacing",
    caption: "Noise in the square [-1, 1]², distance",
    render: || {
        [("0.4", 0.4), ("0.2", 0.2), ("0.1", 0.1)]
            .into_iter()
            .map(|(label, distance)| {
                let options = NoiseOptions {
                    spacing: Spacing::from(distance),
                    ..NoiseOptions::default()
                };
                values(label, 2.0, &noise(&options, Seed(4))?)
            })
            .collect()
    },
};

fn interpolated(label: &str, net: NetOptions) -> anyhow::Result<Panel> {
    let options = NoiseOptions {
        spacing: Spacing::from(DISTANCE),
        net,
        ..NoiseOptions::default()
    };
    values(label, UNITS, &noise(&options, Seed(4))?)
}

fn oriented(label: &str, orientations: Orientations, strength: f64) -> anyhow::Result<Panel> {
    let net = NetOptions {
        orientations,
        strength,
        ..NetOptions::default()
    };
    let options = CellsOptions {
        spacing: Spacing::from(DISTANCE),
        net,
        ..CellsOptions::default()
    };
    let texture = cells(&options, Seed(9))?;
    let shades = (0..).take(texture.values().len()).map(label_gray);
    labels(label, UNITS, &texture.with_values(shades.collect())?)
}
