//! The steps from a mesh and an exemplar to a texture map.

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

/// The inputs and options of a texture map.
#[derive(Clone, Debug)]
pub(super) struct Job {
    pub(super) mesh: Mesh,
    pub(super) image: Raster<LinearRgb>,
    pub(super) edges: Edges,
    pub(super) directions: Vec<Direction>,
    pub(super) sites: HierarchyOptions,
    pub(super) coherence: Coherence,
    pub(super) sources: Sources,
    /// A larger version of the image that is shown instead.
    pub(super) detail: Option<Raster<LinearRgb>>,
    /// The side of the texture map in texels.
    pub(super) map_side: u32,
    /// Which pixels of the image are used; all if there is none.
    pub(super) mask: Option<Raster<bool>>,
    pub(super) guides: Vec<SiteGuide>,
}

/// What says where on the mesh which pixels of the image go.
#[derive(Clone, Debug)]
pub(super) struct SiteGuide {
    pub(super) example: Raster<f32>,
    /// Its value at a position.
    pub(super) at: fn(DVec3) -> f32,
    pub(super) weight: f32,
}

/// A mesh with its texture.
#[derive(Debug)]
pub(super) struct Textured {
    pub(super) synthesizer: Synthesizer,
    pub(super) map: Raster<LinearRgb>,
    pub(super) atlas: Atlas,
    uvs: Vec<[DVec2; 3]>,
}

impl Job {
    /// Synthesizes the texture and bakes it to a map of right triangles of one size, as in the paper.
    pub(super) fn run(self) -> Result<Textured> {
        self.run_symmetric(Symmetry::One)
    }

    /// Runs like [`run`](Self::run), along a field of a symmetry.
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
        let synthesizer = Synthesizer::from_parts(surface, hierarchy, orientation, None)?;
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
        Ok(Textured {
            map: map.map(|color| LinearRgb::from_srgb(color.to_srgb::<u8>())),
            uvs: atlas.uvs(),
            atlas,
            synthesizer,
        })
    }
}

impl Textured {
    /// Returns the color of the texture map where a ray met the model.
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
