//! The six models of figure 5 and their textures.

use super::exemplar::{EXEMPLARS, Edges};
use super::stage::{View, lit};
use super::textured::{Job, Textured};
use anyhow::{Context, Result};
use dapple_color::LinearRgb;
use dapple_models::{self as models, ModelError};
use dapple_raster::Raster;
use dapple_synth::mesh::Mesh;
use dapple_synth::{Coherence, Direction, HierarchyOptions, Sources};
use glam::DVec3;

/// Minimum figure size, in pixels, at which a subject has as many sites as in the paper. Figures on the page are this
/// size.
const FULL_SIZE: u32 = 512;
/// Number of triangles of a model at full size (the paper has 10,000 to 20,000), and the minimum number.
const TRIANGLES: [f64; 2] = [14_000.0, 2000.0];
/// Minimum number of sites.
const SITES_MIN: f64 = 1024.0;
/// Texture map width in texels per pixel of the figure.
const TEXELS: u32 = 2;

/// A model and its texture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Subject {
    pub(crate) name: &'static str,
    pub(crate) model: fn(n_triangles: usize) -> Result<Mesh, ModelError>,
    /// Name of the exemplar.
    exemplar: &'static str,
    /// Number of sites on the finest level at full size, and number of levels, from table 1.
    pub(crate) n_sites: usize,
    n_levels: usize,
    /// Directions of the texture: pairs of a position and the direction of the exemplar's downward axis there.
    directions: &'static [[DVec3; 2]],
    /// Bounds of feature sizes that follow the directions; `None` for a uniform size.
    pub(crate) sizes: Option<[f32; 2]>,
    pub(crate) view: View,
}

/// The six models, in the order of table 1.
pub(crate) const SUBJECTS: [Subject; 6] = [RAY, OCTOPUS, BUNNY, TORI, ZEBRA, ELEPHANT];

/// The stingray: its texture spreads from the snout.
pub(crate) const RAY: Subject = Subject {
    name: "ray",
    model: models::ray,
    exemplar: "wiggly checker",
    n_sites: 64_000,
    n_levels: 3,
    directions: &[
        [DVec3::new(0.15, 0.1, 0.75), DVec3::new(0.9, 0.0, -0.6)],
        [DVec3::new(-0.15, 0.1, 0.75), DVec3::new(-0.9, 0.0, -0.6)],
        [DVec3::new(0.0, 0.15, 0.6), DVec3::NEG_Z],
        [DVec3::new(0.0, -0.15, 0.6), DVec3::NEG_Z],
        [DVec3::new(0.6, 0.1, 0.1), DVec3::new(1.0, 0.0, -0.45)],
        [DVec3::new(-0.6, 0.1, 0.1), DVec3::new(-1.0, 0.0, -0.45)],
        [DVec3::new(0.0, 0.1, -0.3), DVec3::NEG_Z],
        [DVec3::new(0.05, 0.0, -1.0), DVec3::NEG_Z],
    ],
    sizes: None,
    view: View {
        eye: DVec3::new(1.1, 2.7, 1.9),
        target: DVec3::new(0.0, 0.0, -0.15),
        fov: 0.62,
    },
};

const OCTOPUS: Subject = Subject {
    name: "octopus",
    model: models::octopus,
    exemplar: "suckers",
    n_sites: 256_000,
    n_levels: 3,
    directions: &[
        [DVec3::new(0.0, 0.5, 0.4), DVec3::NEG_Y],
        [DVec3::new(0.0, 0.5, -0.6), DVec3::NEG_Y],
        [DVec3::new(0.75, -0.2, 0.3), DVec3::new(0.9, 0.0, 0.4)],
        [DVec3::new(0.3, -0.2, 0.75), DVec3::new(0.4, 0.0, 0.9)],
        [DVec3::new(-0.75, -0.2, 0.3), DVec3::new(-0.9, 0.0, 0.4)],
        [DVec3::new(-0.3, -0.2, 0.75), DVec3::new(-0.4, 0.0, 0.9)],
        [DVec3::new(0.75, -0.2, -0.3), DVec3::new(0.9, 0.0, -0.4)],
        [DVec3::new(0.3, -0.2, -0.75), DVec3::new(0.4, 0.0, -0.9)],
        [DVec3::new(-0.75, -0.2, -0.3), DVec3::new(-0.9, 0.0, -0.4)],
        [DVec3::new(-0.3, -0.2, -0.75), DVec3::new(-0.4, 0.0, -0.9)],
    ],
    sizes: None,
    view: View {
        eye: DVec3::new(1.0, 1.6, 3.6),
        target: DVec3::new(0.0, 0.1, 0.0),
        fov: 0.6,
    },
};

/// The rounded animal: rows of scales go from its ears down to its tail.
pub(crate) const BUNNY: Subject = Subject {
    name: "bunny",
    model: models::bunny,
    exemplar: "scales",
    n_sites: 256_000,
    n_levels: 3,
    directions: &[
        [models::bunny::LEFT_EAR, DVec3::NEG_Y],
        [DVec3::new(-0.25, 1.05, -0.05), DVec3::NEG_Y],
        [DVec3::new(0.0, 0.5, 0.2), DVec3::new(0.0, -0.3, 1.0)],
        [DVec3::new(0.0, 0.5, -0.2), DVec3::NEG_Y],
        [DVec3::new(0.5, -0.4, 0.0), DVec3::NEG_Y],
        [DVec3::new(-0.5, -0.4, 0.0), DVec3::NEG_Y],
        [DVec3::new(0.0, -0.4, 0.5), DVec3::NEG_Y],
        [models::bunny::TAIL, DVec3::NEG_Y],
    ],
    sizes: None,
    view: View {
        eye: DVec3::new(2.3, 1.1, 2.9),
        target: DVec3::new(0.0, 0.05, 0.0),
        fov: 0.62,
    },
};

/// Three blended tori: strands of hooks go around their tubes, which are wider outside than inside.
pub(crate) const TORI: Subject = Subject {
    name: "tori",
    model: models::blended_tori,
    exemplar: "woven hooks",
    n_sites: 256_000,
    n_levels: 4,
    directions: &[
        [DVec3::new(0.55, 0.55, 0.2), DVec3::new(-1.0, 1.0, 0.0)],
        [DVec3::new(-0.55, -0.55, 0.2), DVec3::new(1.0, -1.0, 0.0)],
        [DVec3::new(0.2, 0.55, 0.55), DVec3::new(0.0, -1.0, 1.0)],
        [DVec3::new(0.2, -0.55, -0.55), DVec3::new(0.0, 1.0, -1.0)],
        [DVec3::new(0.55, 0.2, 0.55), DVec3::new(1.0, 0.0, -1.0)],
        [DVec3::new(-0.55, 0.2, -0.55), DVec3::new(-1.0, 0.0, 1.0)],
    ],
    sizes: Some([0.4, 1.2]),
    view: View {
        eye: DVec3::new(1.7, 1.5, 2.5),
        target: DVec3::ZERO,
        fov: 0.62,
    },
};

/// The zebra: lines of text run along its body.
pub(crate) const ZEBRA: Subject = Subject {
    name: "zebra",
    model: models::zebra,
    exemplar: "text",
    n_sites: 256_000,
    n_levels: 4,
    directions: &[
        [models::zebra::BACK, DVec3::X],
        [DVec3::new(0.4, 0.0, 0.0), DVec3::NEG_Y],
        [DVec3::new(-0.4, 0.0, 0.0), DVec3::Y],
        [DVec3::new(0.2, 0.5, 0.9), DVec3::NEG_Y],
        [DVec3::new(-0.2, 0.5, 0.9), DVec3::Y],
    ],
    sizes: None,
    view: View {
        eye: DVec3::new(3.6, 0.9, 1.6),
        target: DVec3::new(0.0, 0.0, 0.05),
        fov: 0.62,
    },
};

pub(crate) const ELEPHANT: Subject = Subject {
    name: "elephant",
    model: models::elephant,
    exemplar: "puzzle pieces",
    n_sites: 256_000,
    n_levels: 4,
    directions: &[
        [models::elephant::BACK, DVec3::NEG_Z],
        [models::elephant::FOREHEAD, DVec3::new(0.0, -1.0, 0.5)],
        [models::elephant::TRUNK, DVec3::NEG_Y],
        [DVec3::new(0.6, 0.0, -0.2), DVec3::NEG_Y],
        [DVec3::new(-0.6, 0.0, -0.2), DVec3::NEG_Y],
    ],
    sizes: None,
    view: View {
        eye: DVec3::new(2.6, 1.2, 3.0),
        target: DVec3::new(0.0, 0.0, 0.2),
        fov: 0.62,
    },
};

impl Subject {
    /// Returns the options for placing sites in a figure of `size` pixels. At full size, there are as many sites as in
    /// the paper. Smaller figures have fewer, in proportion to their number of pixels.
    pub(crate) fn sites(&self, size: u32) -> HierarchyOptions {
        HierarchyOptions {
            n_sites: (self.n_sites as f64 * part(size)).max(SITES_MIN) as usize,
            n_levels: self.n_levels,
            ..HierarchyOptions::default()
        }
    }

    /// Returns the directions of the texture.
    pub(crate) fn directions(&self) -> Vec<Direction> {
        let directions = self.directions.iter();
        directions
            .map(|&[at, vector]| Direction { at, vector })
            .collect()
    }

    /// Draws the exemplar at its size in table 1.
    pub(crate) fn image(&self) -> Result<(Raster<LinearRgb>, dapple_synth::Edges)> {
        let exemplar = EXEMPLARS
            .iter()
            .find(|exemplar| exemplar.name == self.exemplar);
        let exemplar =
            exemplar.with_context(|| format!("there is no exemplar {}", self.exemplar))?;
        let edges = match exemplar.edges {
            Edges::Repeating => dapple_synth::Edges::Wrap,
            Edges::Cropped => dapple_synth::Edges::Cut,
        };
        Ok(((exemplar.draw)(exemplar.side)?, edges))
    }

    /// Builds the textured model for a figure of `size` pixels.
    pub(super) fn textured(&self, size: u32) -> Result<Textured> {
        let n_triangles = (TRIANGLES[0] * part(size)).max(TRIANGLES[1]);
        let (image, edges) = self.image()?;
        let job = Job {
            mesh: (self.model)(n_triangles as usize)?,
            image,
            edges,
            directions: self.directions(),
            sites: self.sites(size),
            coherence: Coherence::Auto,
            sources: Sources::SubPixel,
            sizes: self.sizes,
            detail: None,
            map_side: (TEXELS * size).max(512),
            mask: None,
            guides: Vec::new(),
        };
        job.run()
    }

    /// Renders the textured model. Returns the image and the number of sites.
    pub(super) fn picture(&self, size: u32) -> Result<(Raster<LinearRgb>, usize)> {
        let textured = self.textured(size)?;
        let mesh = textured.synthesizer.surface().mesh();
        let picture = lit(mesh, &self.view, [size; 2], |surface| {
            textured.color(surface)
        })?;
        Ok((picture, textured.synthesizer.hierarchy().sites().len()))
    }
}

/// Returns the figure's number of pixels relative to that at full size.
fn part(size: u32) -> f64 {
    let side = f64::from(size) / f64::from(FULL_SIZE);
    (side * side).min(1.0)
}

#[cfg(test)]
mod tests;
