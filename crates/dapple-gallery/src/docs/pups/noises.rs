//! Rows of documentation images about recipes whose values change smoothly, and about their sums.

use super::{labels, values};
use crate::docs::Strip;
use crate::docs::picture::{COLORS, SIDE, colored, square};
use dapple_color::LinearRgb;
use dapple_pups::{
    CellularNoiseOptions, ColorNoiseOptions, NoiseOptions, OctaveSource, OctavesOptions, Spacing,
    cellular_noise, color_noise, hash::Seed, noise, octaves, turbulence,
};

/// Side of an image in units of the domain: half of the paper's square.
const UNITS: f64 = 1.0;

pub(super) const NOISE: Strip = Strip {
    name: "noise",
    caption: "",
    render: || {
        let noise = noise(&NoiseOptions::default(), Seed(4))?;
        Ok(vec![values("half of a tile", UNITS, &noise)?])
    },
};

pub(super) const OCTAVES: Strip = Strip {
    name: "octaves",
    caption: "Octaves",
    render: || {
        [("1", 1), ("2", 2), ("4", 4)]
            .into_iter()
            .map(|(label, octaves)| values(label, UNITS, &sum(octaves)?))
            .collect()
    },
};

pub(super) const TURBULENCE: Strip = Strip {
    name: "turbulence",
    caption: "",
    render: || {
        let sum = turbulence(&OctavesOptions::default(), Seed(7))?;
        Ok(vec![values("half of a tile", UNITS, &sum.normalized())?])
    },
};

pub(super) const FOLDING: Strip = Strip {
    name: "folding",
    caption: "One octave",
    render: || {
        let plain = octaves(&of(1), Seed(7))?;
        let folded = plain.clone().folded();
        Ok(vec![
            values("plain", UNITS, &plain.normalized())?,
            values("folded", UNITS, &folded.normalized())?,
        ])
    },
};

pub(super) const OCTAVE_SOURCE: Strip = Strip {
    name: "octave-source",
    caption: "Four octaves about the origin, which is the middle",
    render: || {
        [
            ("separate", OctaveSource::Separate),
            ("rescaled", OctaveSource::Rescaled),
        ]
        .into_iter()
        .map(|(label, source)| {
            let options = OctavesOptions {
                source,
                ..OctavesOptions::default()
            };
            values(label, UNITS, &octaves(&options, Seed(7))?.normalized())
        })
        .collect()
    },
};

pub(super) const CELLULAR_NOISE: Strip = Strip {
    name: "cellular-noise",
    caption: "",
    render: || {
        let single = CellularNoiseOptions::default();
        let grouped = CellularNoiseOptions {
            spacing: Spacing::from(0.2),
            points_per_cell: [3, 4],
            ..CellularNoiseOptions::default()
        };
        let noise = |options| cellular_noise(options, Seed(10));
        Ok(vec![
            labels("cells of one point", 1.4, &noise(&single)?.normalized())?,
            labels(
                "cells of three or four points",
                1.4,
                &noise(&grouped)?.normalized(),
            )?,
        ])
    },
};

pub(super) const COLOR_NOISE: Strip = Strip {
    name: "color-noise",
    caption: "",
    render: || {
        let texture = color_noise(&ColorNoiseOptions::default(), Seed(18))?;
        let colors = texture.to_raster(&square(UNITS, SIDE)?)?;
        let colors = colors.map(|&[red, green, blue]| LinearRgb::new(red, green, blue));
        Ok(vec![colored("half of a tile", &colors, COLORS)])
    },
};

fn of(octaves: u32) -> OctavesOptions {
    OctavesOptions {
        octaves,
        ..OctavesOptions::default()
    }
}

fn sum(n_octaves: u32) -> anyhow::Result<impl dapple_raster::Field> {
    Ok(octaves(&of(n_octaves), Seed(7))?.normalized())
}
