//! Renders the rows of images for the documentation of `dapple-wavelet`.

use super::picture::{BANNER, GRAYS, SIDE, SMOOTH_GRAYS, banner_of, shaded};
use super::{Documented, Strip};
use crate::Panel;
use crate::draw::enlarged;
use dapple_raster::{Field, Raster, Window};
use dapple_wavelet::{Border, Degree, SplineFilter, WaveletNoise2, wavelet_tile};
use dapple_worley::{Combination, Worley2, hash::Seed};
use glam::DVec2;

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-wavelet",
    strips: &[SPLINE_FILTER, DEGREE, ANALYZE, NOISE, WEIGHTS, TILE],
    banner: || {
        let picture = picture(BANNER)?;
        let [detail, finer] = details(&picture, BANNER)?;
        let fractal = noise(&[1.0, 0.5, 0.25])?;
        banner_of(&[
            shaded("", &picture, GRAYS),
            detail,
            finer,
            signed("", &noise(&[1.0])?, BANNER)?,
            signed("", &fractal, BANNER)?,
        ])
    },
};

const BORDERS: [Border; 2] = [Border::Periodic; 2];

/// Number of noise cells along each side of an image.
const CELLS: f64 = 24.0;

const SPLINE_FILTER: Strip = Strip {
    name: "spline-filter",
    caption: "",
    render: || {
        let picture = picture(SIDE)?;
        let filter = SplineFilter::default();
        let half = filter.down(&picture, BORDERS)?;
        let again = filter.up(&half, picture.size(), BORDERS)?;
        let lost = picture.zip_map(&again, |before, after| 0.5 + 2.0 * (before - after))?;
        Ok(vec![
            shaded("a picture", &picture, GRAYS),
            shaded("halved", &enlarged(&half, SIDE)?, GRAYS),
            shaded("doubled again", &again, GRAYS),
            shaded("what is lost, twice as strong", &lost, GRAYS),
        ])
    },
};

const DEGREE: Strip = Strip {
    name: "degree",
    caption: "Six pixels, doubled four times",
    render: || {
        let pixels = Raster::from_fn([6; 2], |column, row| {
            f32::from((column * 5 + row * row * 3) % 7 < 3)
        })?;
        let degrees = [
            ("constant", Degree::Constant),
            ("linear", Degree::Linear),
            ("quadratic", Degree::Quadratic),
            ("cubic", Degree::Cubic),
        ];
        let doubled = |(label, degree)| -> anyhow::Result<Panel> {
            let filter = SplineFilter {
                degree,
                ..SplineFilter::default()
            };
            let mut picture = pixels.clone();
            for _ in 0..4 {
                let size = picture.size().map(|side| 2 * side);
                picture = filter.up(&picture, size, BORDERS)?;
            }
            Ok(shaded(label, &picture, SMOOTH_GRAYS))
        };
        degrees.into_iter().map(doubled).collect()
    },
};

const ANALYZE: Strip = Strip {
    name: "analyze",
    caption: "",
    render: || {
        let picture = picture(SIDE)?;
        let [finest, second] = details(&picture, SIDE)?;
        let coarse = SplineFilter::default()
            .analyze(&picture, 2, BORDERS)?
            .coarse;
        Ok(vec![
            shaded("a picture", &picture, GRAYS),
            finest.with_label("the finest band"),
            second.with_label("the second band"),
            shaded("the coarse rest", &enlarged(&coarse, SIDE)?, GRAYS),
        ])
    },
};

const NOISE: Strip = Strip {
    name: "wavelet-noise",
    caption: "",
    render: || Ok(vec![signed("24 cells of one band", &noise(&[1.0])?, SIDE)?]),
};

const WEIGHTS: Strip = Strip {
    name: "with-weights",
    caption: "Weights",
    render: || {
        let kinds: [(&str, &[f32]); 3] = [
            ("1", &[1.0]),
            ("0, 1", &[0.0, 1.0]),
            ("1, ½, ¼", &[1.0, 0.5, 0.25]),
        ];
        let panels = kinds.map(|(label, weights)| signed(label, &noise(weights)?, SIDE));
        panels.into_iter().collect()
    },
};

const TILE: Strip = Strip {
    name: "wavelet-tile",
    caption: "",
    render: || {
        let tile = wavelet_tile([48; 2], &[0.3, 0.5, 1.0], Seed(2))?;
        let twice = tile.tile([2, 2])?.map(|value| half_gray(*value));
        Ok(vec![shaded("two by two copies", &twice, GRAYS)])
    },
};

/// Returns an image that repeats and contains edges.
fn picture(side: u32) -> anyhow::Result<Raster<f32>> {
    let cells = Worley2::new(Seed(6)).with_period([Some(4); 2])?;
    let cracks = cells.combine(Combination::F2_MINUS_F1).normalized()?;
    let window = Window::new(DVec2::ZERO, DVec2::splat(4.0), [side; 2])?;
    let crack = |value: &f32| (4.0 * value).min(1.0) * (1.0 - 0.5 * value);
    Ok(cracks.to_raster(&window)?.map(crack))
}

/// Renders the two finest bands of an image, amplified by 2 and centered on middle gray.
fn details(picture: &Raster<f32>, side: u32) -> anyhow::Result<[Panel; 2]> {
    let bands = SplineFilter::default().analyze(picture, 2, BORDERS)?;
    let panel = |band: usize| -> anyhow::Result<Panel> {
        let band = bands.details[band].map(|value| 0.5 + 2.0 * value);
        Ok(shaded("", &enlarged(&band, side)?, GRAYS))
    };
    Ok([panel(0)?, panel(1)?])
}

fn noise(weights: &[f32]) -> anyhow::Result<WaveletNoise2> {
    Ok(WaveletNoise2::new(64, Seed(1))?.with_weights(weights)?)
}

/// Renders noise, with the value 0 as middle gray.
fn signed(label: &str, noise: &WaveletNoise2, side: u32) -> anyhow::Result<Panel> {
    let window = Window::new(DVec2::ZERO, DVec2::splat(CELLS), [side; 2])?;
    let gray = noise.to_raster(&window)?.map(|value| half_gray(*value));
    Ok(shaded(label, &gray, GRAYS))
}

/// Maps a value with an approximately normal distribution and variance 1 to a shade from 0 to 1.
fn half_gray(value: f32) -> f32 {
    0.5 + 0.18 * value
}
