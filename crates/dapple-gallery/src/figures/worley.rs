//! The figures of "A Cellular Texture Basis Function".

mod creature;
mod fig_01;
mod fig_02;
mod fig_03;
mod fig_04;
mod fig_05;
mod fig_06;
mod fig_07;
mod fig_extra_ids;
mod fig_extra_metrics;
mod fig_extra_radial;
mod hull;
mod polygonize;

use super::fractal::FractalNoise;
use crate::{Panel, Paper};
use dapple_color::{ColorRamp, HeightPlane, LinearRgb, NormalOptions, NormalY, normal_map};
use dapple_preview::{Scene, Supersampling};
use dapple_pups::hash::Seed;
use dapple_raster::{Raster, Window, Wrap};
use dapple_worley::{Cellular, Plane};
use glam::{DVec2, DVec3};

/// The paper, with its figures in order.
pub(super) const PAPER: Paper = Paper {
    key: "worley",
    title: "A Cellular Texture Basis Function",
    reference: "Steven Worley, SIGGRAPH 1996",
    figures: &[
        fig_01::FIGURE,
        fig_02::FIGURE,
        fig_03::FIGURE,
        fig_04::FIGURE,
        fig_05::FIGURE,
        fig_06::FIGURE,
        fig_07::FIGURE,
        fig_extra_radial::FIGURE,
        fig_extra_metrics::FIGURE,
        fig_extra_ids::FIGURE,
    ],
};

/// Number of positions at which a texture's range is measured. The paper uses "several thousand".
const N_POSITIONS: u32 = 8000;

/// Renders the slice `z = 0.5` of a 3-D texture, `cells` cells wide, with the texture's range scaled to 0 to 1.
fn slice(texture: Cellular<3>, cells: f64, size: [u32; 2]) -> anyhow::Result<Raster<f32>> {
    let range = texture.measure_range(Seed(1), N_POSITIONS)?;
    let height = cells * f64::from(size[1]) / f64::from(size[0]);
    let window = Window::new(DVec2::ZERO, DVec2::new(cells, height), size)?;
    let mut raster = Raster::filled(size, 0.0)?;
    let plane = Plane::slice(DVec3::new(0.0, 0.0, 0.5));
    let texture = texture.with_range(range)?;
    texture.render_plane(&plane, &window, raster.view_mut())?;
    Ok(raster)
}

/// Renders a height map as a colored surface, lit from the upper left. The height selects the color and bends the
/// normals.
///
/// `depth` is the height difference between the values 0 and 1, in multiples of the image width.
fn relief(height: &Raster<f32>, ramp: &ColorRamp, depth: f64) -> anyhow::Result<Raster<LinearRgb>> {
    let [width, rows] = height.size().map(f64::from);
    let options = NormalOptions {
        y: NormalY::OpenGl,
        plane: HeightPlane {
            strength: depth,
            extent: DVec2::new(1.0, rows / width),
            wrap: [Wrap::Mirror; 2],
        },
    };
    let normals = normal_map(height, &options)?;
    let toward = DVec3::new(-0.5, 0.6, 0.75).normalize();
    Ok(height.zip_map(&normals, |&height, normal| {
        let normal = DVec3::from_array(normal.to_array().map(f64::from));
        let light = 0.25 + 0.95 * normal.dot(toward).max(0.0);
        ramp.at(height) * light as f32
    })?)
}

/// Renders a scene with three samples along each side of a pixel.
fn photo(scene: &Scene<'_>, size: [u32; 2]) -> anyhow::Result<Panel> {
    Ok(Panel::color("", scene.render(size, Supersampling(3))?))
}
