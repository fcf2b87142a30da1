//! Synthesizes a texture on a mesh from an exemplar and bakes it to a texture map.

use anyhow::Result;
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_preview::Surface;
use dapple_raster::{Raster, Wrap};
use dapple_synth::mesh::{self, Mesh};
use dapple_synth::{
    Atlas, Coherence, Direction, Edges, Exemplar, Hierarchy, HierarchyOptions, MeshExemplar,
    Options, Orientation, Sources, Symmetry, Synthesizer, bake_colors,
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
    pub(super) atlas: Atlas,
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
            atlas,
            synthesizer,
        }
    }

    /// Returns two textured meshes: one with a stain where `is_stain` is true, and one with the stain replaced from
    /// the rest of the texture.
    pub(super) fn stained(self, is_stain: fn(DVec3) -> bool) -> Result<[Self; 2]> {
        let surface = self.synthesizer.surface();
        let is_clean = Raster::from_fn(self.map.size(), |column, row| {
            let point = self.atlas.point(surface, [column, row]);
            !point.is_some_and(|point| is_stain(surface.position(point)))
        })?;
        let choose = |clean: &Raster<LinearRgb>, other: &Raster<LinearRgb>| {
            let texel = |x: u32, y: u32| {
                let from = if is_clean.row(y)[x as usize] {
                    clean
                } else {
                    other
                };
                from.row(y)[x as usize]
            };
            Raster::from_fn(self.map.size(), texel)
        };
        let gray = Raster::filled(self.map.size(), LinearRgb::gray(0.25))?;
        let stained = choose(&self.map, &gray)?;
        let texture = Exemplar::new(&stained, Edges::Cut)?.with_mask(&is_clean)?;
        let exemplar = MeshExemplar::new(self.synthesizer.clone(), &self.uvs, &texture)?;
        let options = Options {
            n_levels: self.synthesizer.hierarchy().levels().len(),
            ..Options::default()
        };
        let repaired = exemplar.repair(&options, |_| ControlFlow::Continue(()))?;
        let new = bake_colors(&self.synthesizer, &repaired, &stained, &self.atlas)?;
        let repaired = choose(&stained, &new)?;
        let with_map = |map| Self {
            map,
            ..self.clone()
        };
        Ok([with_map(stained), with_map(repaired)])
    }

    /// Lifts the texture, which must be a regular one, onto another model, with a texture map of the same size.
    pub(super) fn lifted(
        &self,
        mesh: Mesh,
        directions: &[Direction],
        sites: &HierarchyOptions,
    ) -> Result<Self> {
        let texture = Exemplar::new(&self.map, Edges::Cut)?;
        let exemplar = MeshExemplar::new(self.synthesizer.clone(), &self.uvs, &texture)?;
        let synthesizer = Synthesizer::new(mesh::Surface::new(mesh)?, directions, sites)?;
        let options = Options {
            n_levels: sites.n_levels,
            // The texture is regular; regularity is not measured on surfaces.
            coherence: Coherence::Factor(0.0),
            ..Options::default()
        };
        let lifted = synthesizer.lift(&exemplar, &[], &options, |_| ControlFlow::Continue(()))?;
        let atlas = Atlas::uniform(synthesizer.surface(), self.map.width())?;
        let map = bake_colors(&synthesizer, &lifted, &self.map, &atlas)?;
        Ok(Self::new(synthesizer, atlas, &map))
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
