//! Charts: where the pieces of a model are in its texture map, and how little they are stretched.
//!
//! The color shows the normal, and all squares are the same size in the map. In the right half, areas that are larger
//! on the model than their texels indicate are red, and smaller ones are blue, from -10 % to 10 %.

use super::stage::{View, lit};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_models::bunny;
use dapple_raster::Raster;
use dapple_synth::Atlas;
use dapple_synth::mesh::{FaceIdx, Surface};
use glam::{DVec2, DVec3};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[("map", "1024²"), ("triangles", "14,000")],
    source: source!(),
    render,
};

const VIEW: View = View {
    eye: DVec3::new(2.3, 1.1, 2.9),
    target: DVec3::new(0.0, 0.05, 0.0),
    fov: 0.62,
};
/// Side of the drawn squares, in the unit square of the texture map.
const SQUARE: f64 = 1.0 / 64.0;

/// A model with its atlas.
struct Charts {
    surface: Surface,
    atlas: Atlas,
    uvs: Vec<[DVec2; 3]>,
    stretches: Vec<f64>,
}

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let surface = Surface::new(bunny((14_000 * size / 512).clamp(2000, 14_000) as usize)?)?;
    let atlas = Atlas::charts(&surface, (2 * size).min(1024))?;
    let charts = Charts {
        uvs: atlas.uvs(),
        stretches: atlas.stretches(&surface),
        surface,
        atlas,
    };
    let report = charts.atlas.report(&charts.surface);
    let used = format!(
        "{} charts, {:.0} % of the map",
        report.pieces,
        100.0 * report.used
    );
    let stretch = format!("L2 stretch {:.4}", report.stretch);
    let squares = |face, weights| charts.squares(face, weights);
    let stretched = |face, _| charts.stretched(face);
    Ok(vec![
        Panel::color("charts", charts.model(size, squares)?),
        Panel::color(used, charts.map(size, squares)?),
        Panel::color("stretch", charts.model(size, stretched)?),
        Panel::color(stretch, charts.map(size, stretched)?),
    ])
}

impl Charts {
    /// Returns a color that shows the normal, alternating between light and dark squares of the map.
    fn squares(&self, face: FaceIdx, [of_a, of_b, of_c]: [f64; 3]) -> LinearRgb {
        let [a, b, c] = self.uvs[face.index()];
        let [column, row] = ((a * of_a + b * of_b + c * of_c) / SQUARE)
            .floor()
            .to_array();
        let light = if (column + row) % 2.0 == 0.0 {
            0.45
        } else {
            0.3
        };
        let color = (self.surface.face_normal(face) * 0.8 + 1.0) * light;
        let [r, g, b] = color.as_vec3().to_array();
        LinearRgb { r, g, b }
    }

    /// Returns white for a face without stretch, and a more saturated red or blue the more the face is stretched or
    /// shrunk.
    fn stretched(&self, face: FaceIdx) -> LinearRgb {
        let off = ((self.stretches[face.index()] - 1.0) * 10.0).clamp(-1.0, 1.0) as f32;
        let [r, g, b] = [1.0 + off.min(0.0), 1.0 - off.abs(), 1.0 - off.max(0.0)];
        LinearRgb { r, g, b } * 0.8
    }

    /// Renders the model, with `color` applied to its faces.
    fn model(
        &self,
        size: u32,
        color: impl Fn(FaceIdx, [f64; 3]) -> LinearRgb + Send + Sync,
    ) -> anyhow::Result<Raster<LinearRgb>> {
        lit(self.surface.mesh(), &VIEW, [size; 2], |hit| {
            let triangle = hit.triangle();
            triangle.map_or(LinearRgb::BLACK, |hit| {
                color(FaceIdx(hit.index), hit.weights)
            })
        })
    }

    /// Renders the texture map without padding, with `color` applied to its faces.
    fn map(
        &self,
        size: u32,
        color: impl Fn(FaceIdx, [f64; 3]) -> LinearRgb,
    ) -> anyhow::Result<Raster<LinearRgb>> {
        let side = self.atlas.size()[0];
        Ok(Raster::from_fn([size; 2], |column, row| {
            let texel = [column, row].map(|at| at * side / size);
            let at = DVec2::from(texel.map(|at| f64::from(at) + 0.5)) / f64::from(side);
            let Some(face) = self.atlas.face(texel) else {
                return LinearRgb::gray(0.05);
            };
            let [a, b, c] = self.uvs[face.index()];
            let area = (b - a).perp_dot(c - a);
            let of_b = (at - a).perp_dot(c - a) / area;
            let of_c = (b - a).perp_dot(at - a) / area;
            let weights = [1.0 - of_b - of_c, of_b, of_c];
            if weights.iter().any(|&weight| weight < 0.0) {
                return LinearRgb::gray(0.05);
            }
            color(face, weights)
        })?)
    }
}
