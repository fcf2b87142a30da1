//! Synthesizes a texture on a mesh from an exemplar and bakes it to a texture map.

use anyhow::Result;
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_preview::Surface;
use dapple_raster::{Raster, Wrap};
use dapple_synth::mesh::{self, Mesh};
use dapple_synth::{
    Atlas, Coherence, Direction, Edges, Exemplar, Hierarchy, HierarchyOptions, Options,
    Orientation, Sources, Symmetry, Synthesizer, bake_colors,
};
use glam::{DVec2, DVec3};

/// Inputs and options for synthesizing and baking a texture map.
#[derive(Clone, Debug)]
pub(super) struct Job {
    pub(super) mesh: Mesh,
    pub(super) image: Raster<LinearRgb>,
    pub(super) edges: Edges,
    pub(super) directions: Vec<Direction>,
    pub(super) sites: HierarchyOptions,
    pub(super) coherence: Coherence,
    pub(super) sources: Sources,
    /// Bounds of feature sizes that follow the directions; `None` for a uniform size.
    pub(super) sizes: Option<[f32; 2]>,
    /// Larger version of the exemplar that the texture map samples instead, if any.
    pub(super) detail: Option<Raster<LinearRgb>>,
    /// Width and height of the texture map in texels.
    pub(super) map_side: u32,
    /// Mask of the exemplar pixels that may be used; `None` for all.
    pub(super) mask: Option<Raster<bool>>,
    pub(super) guides: Vec<SiteGuide>,
}

/// A guide that determines which exemplar pixels are used where on the mesh.
#[derive(Clone, Debug)]
pub(super) struct SiteGuide {
    pub(super) example: Raster<f32>,
    /// Returns the guide value at a position on the mesh.
    pub(super) at: fn(DVec3) -> f32,
    pub(super) weight: f32,
}

/// A mesh with its texture.
#[derive(Clone, Debug)]
pub(super) struct Textured {
    pub(super) synthesizer: Synthesizer,
    pub(super) map: Raster<LinearRgb>,
    uvs: Vec<[DVec2; 3]>,
}

impl Job {
    /// Synthesizes the texture and bakes it to a map of right triangles of equal size, as in the paper.
    pub(super) fn run(self) -> Result<Textured> {
        self.run_symmetric(Symmetry::One)
    }

    /// Same as [`run`](Self::run), along a field with the given symmetry.
    pub(super) fn run_symmetric(self, symmetry: Symmetry) -> Result<Textured> {
        let surface = mesh::Surface::new(self.mesh)?;
        let options = Options {
            n_levels: self.sites.n_levels,
            coherence: self.coherence,
            sources: self.sources,
            ..Options::default()
        };
        let hierarchy = Hierarchy::new(&surface, &self.sites)?;
        let axis = Orientation::AXIS;
        let orientation = Orientation::symmetric(&hierarchy, &self.directions, axis, symmetry)?;
        let mut synthesizer = Synthesizer::from_parts(surface, hierarchy, orientation, None)?;
        if let Some(bounds) = self.sizes {
            synthesizer = synthesizer.with_conformal_scales(bounds)?;
        }
        let mut exemplar = Exemplar::new(&self.image, self.edges)?;
        if let Some(mask) = &self.mask {
            exemplar = exemplar.with_mask(mask)?;
        }
        let guides = self.guides.iter();
        let guides = guides.map(|guide| (&guide.example, guide.weight));
        let exemplar = exemplar.with_guides(&guides.collect::<Vec<_>>())?;
        let positions = synthesizer.hierarchy().sites().positions();
        let column = |guide: &SiteGuide| positions.iter().map(|&at| (guide.at)(at)).collect();
        let columns: Vec<Vec<f32>> = self.guides.iter().map(column).collect();
        let columns: Vec<_> = columns.iter().map(Vec::as_slice).collect();
        let texture = synthesizer
            .synthesize_guided(&exemplar, &columns, &options, |_| ControlFlow::Continue(()))?;
        let surface = synthesizer.surface();
        let atlas = Atlas::uniform(surface, self.map_side)?;
        let shown = self.detail.as_ref().unwrap_or(&self.image);
        let map = bake_colors(&synthesizer, &texture, shown, &atlas)?;
        Ok(Textured::new(synthesizer, atlas, &map))
    }
}

impl Textured {
    fn new(synthesizer: Synthesizer, atlas: Atlas, map: &Raster<LinearRgb>) -> Self {
        Self {
            map: map.map(|color| LinearRgb::from_srgb(color.to_srgb::<u8>())),
            uvs: atlas.uvs(),
            synthesizer,
        }
    }

    /// Returns the color of the texture map where a ray hits the model.
    pub(super) fn color(&self, surface: &Surface) -> LinearRgb {
        let Some(triangle) = surface.triangle() else {
            return LinearRgb::BLACK;
        };
        let [a, b, c] = self.uvs[triangle.index as usize];
        let [of_a, of_b, of_c] = triangle.weights;
        let uv = a * of_a + b * of_b + c * of_c;
        self.map.sample_bilinear(uv, [Wrap::Mirror; 2])
    }
}

/// Returns the color for sRGB codes from 0 to 1, rounded to 8 bits as in a file.
pub(super) fn srgb(codes: [f32; 3]) -> LinearRgb {
    LinearRgb::from_srgb(codes.map(|code| (code.clamp(0.0, 1.0) * 255.0 + 0.5) as u8))
}
