//! Renders a mesh and an exemplar provided by the user, in the style of figure 5.

use super::stage::{View, lit};
use super::textured::{Job, Textured};
use crate::Panel;
use anyhow::{Result, ensure};
use dapple_color::LinearRgb;
use dapple_image::{Transfer, encode_png};
use dapple_raster::Raster;
use dapple_synth::mesh::{CREASE, EncodedImage, Mesh, Model};
use dapple_synth::{Coherence, Direction, Edges, HierarchyOptions, Sources, textured_model};
use glam::DVec3;

/// A mesh, an exemplar image, and the synthesis options.
#[derive(Clone, Debug)]
pub struct Own {
    /// The mesh, which is repaired where possible.
    pub mesh: Mesh,
    /// The exemplar image.
    pub image: Raster<LinearRgb>,
    /// Whether the exemplar tiles.
    pub edges: Edges,
    /// Directions in which the exemplar's downward axis points. If empty, the direction is -y of the mesh.
    pub directions: Vec<Direction>,
    /// Number of points and levels.
    pub sites: HierarchyOptions,
    /// Tolerance for worse matches that continue their neighbors.
    pub coherence: Coherence,
    /// Width and height of the texture map in texels.
    pub map_side: u32,
}

/// Images of a textured mesh, and the mesh with its texture map.
#[derive(Clone, Debug)]
pub struct OwnTextured {
    /// Images of the mesh from four sides.
    pub panels: Vec<Panel>,
    /// The mesh with its texture map, ready to be written to a file.
    pub model: Model,
    /// Descriptions of the repairs as text; empty if there were none.
    pub mended: String,
}

impl Own {
    /// Synthesizes the texture, then renders images of `size` pixels.
    ///
    /// # Errors
    ///
    /// If an input is rejected, such as a mesh whose faces all have no area, or an exemplar that is too small.
    pub fn render(self, size: u32) -> Result<OwnTextured> {
        let (mesh, repair) = self.mesh.repair();
        let mended = if repair.before == repair.after {
            String::new()
        } else {
            format!("before: {:?}\nafter:  {:?}", repair.before, repair.after)
        };
        ensure!(!mesh.faces().is_empty(), "no face of the mesh has an area");
        let views = views(&mesh);
        let job = Job {
            mesh,
            image: self.image,
            edges: self.edges,
            directions: self.directions,
            sites: self.sites,
            coherence: self.coherence,
            sources: Sources::SubPixel,
            sizes: None,
            detail: None,
            map_side: self.map_side,
            mask: None,
            guides: Vec::new(),
        };
        let textured = job.run()?;
        let panel = |(label, view): &(&str, View)| {
            let mesh = textured.synthesizer.surface().mesh();
            let picture = lit(mesh, view, [size; 2], |surface| textured.color(surface))?;
            Ok(Panel::color(*label, picture))
        };
        Ok(OwnTextured {
            panels: views.iter().map(panel).collect::<Result<_>>()?,
            model: model(&textured)?,
            mended,
        })
    }
}

/// Returns views from four sides, slightly from above, far enough away to show the whole mesh.
pub(super) fn views(mesh: &Mesh) -> [(&'static str, View); 4] {
    let positions = mesh.positions().iter().copied();
    let low = positions.clone().fold(DVec3::INFINITY, DVec3::min);
    let high = positions.clone().fold(DVec3::NEG_INFINITY, DVec3::max);
    let target = low * 0.5 + high * 0.5;
    let radius = positions.map(|at| at.distance(target)).fold(0.0, f64::max);
    let view = |toward: DVec3| View {
        eye: target + toward.normalize() * (3.6 * radius),
        target,
        fov: 0.6,
    };
    [
        ("front", view(DVec3::new(0.5, 0.4, 1.0))),
        ("right", view(DVec3::new(1.0, 0.4, -0.5))),
        ("back", view(DVec3::new(-0.5, 0.4, -1.0))),
        ("left", view(DVec3::new(-1.0, 0.4, 0.5))),
    ]
}

/// Returns the mesh with its texture map as an embedded PNG.
fn model(textured: &Textured) -> Result<Model> {
    let codes = textured.map.map(|color| color.to_srgb::<u8>());
    let png = encode_png(codes.view(), Transfer::Srgb)?;
    let surface = textured.synthesizer.surface();
    Ok(textured_model(
        surface,
        &textured.atlas,
        surface.mesh().corner_normals(CREASE),
        EncodedImage::new(png)?,
    )?)
}
