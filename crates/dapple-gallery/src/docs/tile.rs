//! Renders the rows of images for the documentation of `dapple-tile`.

mod blending;
mod methods;
mod unlike;

use super::Documented;
use super::picture::{BANNER, banner_of, of_figures};
use dapple_raster::{Field, Raster, Window};
use dapple_worley::{Combination, Worley2, hash::Seed};
use glam::DVec2;

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-tile",
    strips: &[
        methods::PERIODIC,
        methods::POISSON,
        methods::SOFT_CUT,
        methods::SPLINE_PROJECT,
        methods::PERIODIC_THEN_PROJECT,
        methods::FEATHER,
        methods::MIRROR,
        methods::CROSSFADE,
        unlike::DISTURBANCE,
        unlike::MATCH_BORDERS,
        unlike::CORNER_TILES,
        blending::BLEND_MAP,
        blending::RANK_EQUALIZE,
        blending::WEIGHTING,
        blending::MIXING,
    ],
    banner: || {
        let mut panels = of_figures(&[("wavelet-fig-extra-terrain", 1)], BANNER)?;
        for strip in [
            &methods::SOFT_CUT,
            &unlike::DISTURBANCE,
            &unlike::CORNER_TILES,
            &blending::WEIGHTING,
        ] {
            panels.extend((strip.render)()?.into_iter().next_back());
        }
        banner_of(&panels)
    },
};

/// Returns a height map of pebbles with dark borders, `cells` cells and `side` pixels wide. It either repeats or is a
/// crop that does not repeat.
fn pebbles(cells: u32, side: u32, repeats: bool, seed: Seed) -> anyhow::Result<Raster<f32>> {
    let period = repeats.then_some(cells);
    let worley = Worley2::new(seed).with_period([period; 2])?;
    let height = worley.combine(Combination::F2_MINUS_F1).normalized()?;
    let window = Window::new(DVec2::ZERO, DVec2::splat(cells.into()), [side; 2])?;
    Ok(height.to_raster(&window)?)
}
