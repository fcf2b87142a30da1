//! Renders the rows of images for the documentation of `dapple-pups`.

mod labels;
mod net;
mod noises;

use super::Documented;
use super::picture::{LARGE, SIDE, banner, edged, smooth, square};
use crate::Panel;
use dapple_raster::Field;

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-pups",
    strips: &[
        net::PUPS,
        net::AXIS_SCALE,
        net::AXIAL_WEIGHT,
        net::ORIENTATIONS,
        net::STRENGTH,
        net::SPACING,
        noises::NOISE,
        noises::OCTAVES,
        noises::TURBULENCE,
        noises::FOLDING,
        noises::OCTAVE_SOURCE,
        noises::CELLULAR_NOISE,
        noises::COLOR_NOISE,
        labels::CELLS,
        labels::COW,
        labels::SPACE_GIRAFFE,
        labels::SPOTS,
        labels::REFERENCE,
        labels::ITERATED,
        labels::ITERATION_POINTS,
        labels::COW_PROGRESSION,
        labels::GIRAFFE_PROGRESSION,
        labels::LABEL_RAMP,
    ],
    banner: || {
        let figures = [
            ("pups-fig-08", 0),
            ("pups-fig-10", 0),
            ("pups-fig-11", 0),
            ("pups-fig-12", 0),
            ("pups-fig-14", 3),
            ("pups-fig-16", 0),
        ];
        banner(&figures)
    },
};

/// Renders a square of smooth values, `units` wide.
fn values(label: &str, units: f64, texture: &dyn Field) -> anyhow::Result<Panel> {
    smooth(label, texture, &square(units, SIDE)?)
}

/// Renders a square of labels, `units` wide.
fn labels(label: &str, units: f64, texture: &dyn Field) -> anyhow::Result<Panel> {
    edged(label, texture, &square(units, LARGE)?)
}
