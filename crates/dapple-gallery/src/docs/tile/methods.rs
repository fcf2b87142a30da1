//! Rows of documentation images that show each method of `Seamless` next to its source.

use super::pebbles;
use crate::Panel;
use crate::docs::Strip;
use crate::docs::picture::{GRAYS, shaded};
use dapple_raster::{Raster, Window};
use dapple_tile::{
    Crossfade, Feather, Method, Seamless, SoftCut, SplineProject, WrapGradient, repeat,
};
use dapple_wavelet::{WaveletNoise2, hash::Seed};
use glam::DVec2;

/// Width and height of a tile, in pixels; an image shows two by two copies.
const TILE: u32 = 48;

/// Margin that some methods cut off, in pixels.
const MARGIN: u32 = 12;

/// Caption of all strips about a method.
const CAPTION: &str = "Two by two copies";

pub(super) const PERIODIC: Strip = Strip {
    name: "method-periodic",
    caption: CAPTION,
    render: || beside(&noise(TILE)?, &[("periodic", Method::Periodic)]),
};

pub(super) const POISSON: Strip = Strip {
    name: "method-poisson",
    caption: CAPTION,
    render: || {
        let methods = [
            ("zero", Method::Poisson(WrapGradient::Zero)),
            ("extrapolated", Method::Poisson(WrapGradient::Extrapolate)),
        ];
        beside(&noise(TILE)?, &methods)
    },
};

pub(super) const SOFT_CUT: Strip = Strip {
    name: "method-soft-cut",
    caption: CAPTION,
    render: || {
        let cut = SoftCut {
            margin: Some(MARGIN),
            half_width: Some(2.0),
            ..SoftCut::default()
        };
        let crop = pebbles(5, TILE + MARGIN, false, Seed(8))?;
        beside(&crop, &[("soft cut", Method::SoftCut(cut))])
    },
};

pub(super) const SPLINE_PROJECT: Strip = Strip {
    name: "method-spline-project",
    caption: CAPTION,
    render: || {
        let levels = |levels| {
            Method::SplineProject(SplineProject {
                levels,
                ..SplineProject::default()
            })
        };
        let methods = [("one level", levels(1)), ("two levels", levels(2))];
        beside(&noise(TILE)?, &methods)
    },
};

pub(super) const PERIODIC_THEN_PROJECT: Strip = Strip {
    name: "method-periodic-then-project",
    caption: CAPTION,
    render: || {
        let method = Method::PeriodicThenProject(SplineProject::default());
        beside(&noise(TILE)?, &[("periodic, then projected", method)])
    },
};

pub(super) const FEATHER: Strip = Strip {
    name: "method-feather",
    caption: CAPTION,
    render: || {
        let margin = Feather::Margin {
            margin: MARGIN,
            crossfade: Crossfade::Linear,
        };
        let methods = [
            ("over a margin", Method::Feather(margin)),
            ("moved by half", Method::Feather(Feather::HalfShift)),
        ];
        beside(&pebbles(5, TILE + MARGIN, false, Seed(8))?, &methods)
    },
};

pub(super) const MIRROR: Strip = Strip {
    name: "method-mirror",
    caption: CAPTION,
    render: || {
        let crop = pebbles(4, TILE, false, Seed(8))?;
        beside(&crop, &[("mirrored", Method::Mirror)])
    },
};

pub(super) const CROSSFADE: Strip = Strip {
    name: "crossfade",
    caption: CAPTION,
    render: || {
        let feather = |crossfade| {
            Method::Feather(Feather::Margin {
                margin: MARGIN,
                crossfade,
            })
        };
        let methods = [
            ("linear", feather(Crossfade::Linear)),
            ("variance kept", feather(Crossfade::KeepVariance)),
        ];
        beside(&noise(TILE + MARGIN)?, &methods)
    },
};

/// Renders two by two copies of a crop, and then two by two copies of the tile that each method makes of it.
fn beside(crop: &Raster<f32>, methods: &[(&str, Method)]) -> anyhow::Result<Vec<Panel>> {
    let copies = |label: &str, tile: &Raster<f32>| -> anyhow::Result<Panel> {
        let map = repeat(tile, [2 * TILE; 2])?;
        Ok(shaded(label, &map, GRAYS))
    };
    let mut panels = vec![copies("the crop", crop)?];
    for (label, method) in methods {
        panels.push(copies(label, &Seamless::new(*method).apply(crop)?)?);
    }
    Ok(panels)
}

/// Returns a crop of noise that does not repeat.
fn noise(side: u32) -> anyhow::Result<Raster<f32>> {
    let noise = WaveletNoise2::new(64, Seed(3))?.with_weights(&[1.0, 0.6, 0.35])?;
    let window = Window::new(DVec2::ZERO, DVec2::splat(3.7), [side; 2])?;
    Ok(Raster::from_window(&window, |at| {
        0.5 + 0.14 * noise.sample(at)
    })?)
}
