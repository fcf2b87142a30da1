//! Renders the rows of images for the documentation of `dapple-noise`.

use super::picture::{BANNER, SIDE, SMOOTH_GRAYS, banner_of, shaded};
use super::{Documented, Strip};
use crate::Panel;
use dapple_noise::{GradientNoise2, hash::Seed};
use dapple_raster::{Field, FieldExt, FractalShape};

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-noise",
    strips: &[GRADIENT_NOISE],
    banner: || banner_of(&panels(BANNER, ["", "", "", "", ""])?),
};

/// Number of noise cells along each side of an image.
const CELLS: u32 = 6;

const GRADIENT_NOISE: Strip = Strip {
    name: "gradient-noise",
    caption: "",
    render: || {
        let labels = ["6 cells", "five octaves", "ridged", "billow", "warped"];
        Ok(panels(SIDE, labels)?.into())
    },
};

/// Renders five panels, each one period wide: the noise, three fractal sums, and noise displaced by noise.
fn panels(side: u32, labels: [&str; 5]) -> anyhow::Result<[Panel; 5]> {
    let noise = |seed| GradientNoise2::new(Seed(seed)).with_period([Some(CELLS); 2]);
    let [noise, right, down] = [noise(1)?, noise(2)?, noise(3)?];
    let fractal = |shape| noise.fractal(5, 0.5, 2.0, shape);
    let panel = |label: &str, field: &dyn Field, [darkest, lightest]: [f32; 2]| {
        let field = field.remap([darkest, lightest], [0.0, 1.0])?;
        anyhow::Ok(shaded(label, &field.tile_raster([side; 2])?, SMOOTH_GRAYS))
    };
    Ok([
        panel(labels[0], &noise, [-0.8, 0.8])?,
        panel(labels[1], &fractal(FractalShape::Sum)?, [-0.9, 0.9])?,
        panel(labels[2], &fractal(FractalShape::Ridged)?, [0.9, 1.9])?,
        panel(labels[3], &fractal(FractalShape::Billow)?, [0.0, 1.0])?,
        panel(labels[4], &noise.warp([right, down], 1.5), [-0.8, 0.8])?,
    ])
}
