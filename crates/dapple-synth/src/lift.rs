//! Lifting: textures whose example is another textured surface.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, DOI 10.1145/383259.383297. Section 8 ends with what
//! is left to do: "to extend this method to taking patterns directly from other surfaces. Imagine being able to "lift" the
//! color, bumps and ridges from one model and place them onto another surface." No more is said of how.
//!
//! Here the example is a surface with sites of its own, on as many levels, with directions and an order, as the surface that
//! gets the texture has. They are its pixels:
//!
//! * The color of a finest site is the mean of the source's texture over a square of one spacing, to which is walked over the
//!   faces, so that borders of the texture's pieces do not show. Coarser levels are low-pass filtered columns (section 3.2).
//! * The neighborhood of a site is read on the source as it is on the target: by walking along the field, between sites, by
//!   equation 1. So both are blurred alike, and need no blur as those of an image do. All neighborhoods are compared, and
//!   the match is exact; those that meet a border or a sharp fold of the source are left out as those that reach past the
//!   edge of an image are.
//! * What an image knows by columns and rows, which pixel continues another, is here the site nearest to a step from it.
//! * A sub-pixel source is a site of the source and a way from it in its frame. A texel walks it, and reads the texture at the
//!   uv where it ends: it is as sharp as the source, and every map of the source follows.
//!
//! Patches of the source could be flattened to an image instead, whose neighborhoods do not cross from patch to patch. On the
//! coarsest of three levels a neighborhood reaches over 24 pixels: patches would either overlap many times, or lose most of a
//! source as small as a model is.
//!
//! Units: a pixel is one spacing of finest sites, on the source and on the target.

mod origin;
mod reading;
mod repair;
mod rows;
#[cfg(test)]
mod tests;

pub(crate) use origin::{LiftedDetail, LiftedPlaces, Origin};
pub(crate) use repair::order as order_of_repair;

use crate::engine::{self, Callback, Progress};
use crate::ground::Sources;
use crate::guides::Targets;
use crate::mesh_ground::MeshGround;
use crate::places::Frames;
use crate::{
    Candidates, Edges, Exemplar, Hierarchy, Options, Pass, Pyramid, SurfaceTexture, SynthError,
    SynthErrorKind, Synthesizer,
};
use core::ops::ControlFlow;
use glam::DVec2;
use std::sync::Arc;

/// A textured surface as an example.
#[derive(Clone, Debug)]
pub struct MeshExemplar {
    origin: Arc<Origin>,
    /// The sites of every level as images of one row.
    pyramid: Pyramid,
}

impl MeshExemplar {
    /// A surface with sites and directions, the texture coordinates of the corners of its faces (v down; whole turns are taken
    /// off a face), and the texture that lies at these: colors, or any planes with weights, masks and guides, as an exemplar
    /// has them.
    ///
    /// The sites are what is matched, as the pixels of an image are: features are as large on the target as on the source where
    /// both have sites equally far apart, and more sites of the source make them larger. Sites beside texels that a
    /// [mask](Exemplar::with_mask) leaves out are not used. [Scales](Synthesizer::with_scales) of the source have no effect.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] unless there are coordinates for each face, and [`SynthErrorKind::Range`] for one that is
    /// not from -10^6 to 10^6.
    ///
    /// # Examples
    ///
    /// The checker of one tetrahedron, for another one.
    ///
    /// ```
    /// use core::ops::ControlFlow;
    /// use dapple_color::LinearRgb;
    /// use dapple_raster::Raster;
    /// use dapple_synth::mesh::{Mesh, Surface, glam::DVec3};
    /// use dapple_synth::{Atlas, Edges, Exemplar, HierarchyOptions, MeshExemplar, Options, Synthesizer, bake_colors};
    ///
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let mesh = Mesh::new(corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// let sites = HierarchyOptions { n_sites: 1000, ..HierarchyOptions::default() };
    /// let source = Synthesizer::new(Surface::new(mesh.clone())?, &[], &sites)?;
    /// let uvs = Atlas::uniform(source.surface(), 128)?.uvs();
    /// let checker = Raster::from_fn([128; 2], |x, y| LinearRgb::gray(((x / 8 + y / 8) % 2) as f32))?;
    /// let texture = Exemplar::new(&checker, Edges::Cut)?;
    /// let exemplar = MeshExemplar::new(source, &uvs, &texture)?;
    ///
    /// let target = Synthesizer::new(Surface::new(mesh)?, &[], &sites)?;
    /// let lifted = target.lift(&exemplar, &[], &Options::default(), |_| ControlFlow::Continue(()))?;
    /// let atlas = Atlas::charts(target.surface(), 256)?;
    /// let map = bake_colors(&target, &lifted, &checker, &atlas)?;
    /// assert_eq!(map.size(), [256; 2]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(
        source: Synthesizer,
        uvs: &[[DVec2; 3]],
        texture: &Exemplar,
    ) -> Result<Self, SynthError> {
        let origin = Origin::new(source, uvs, texture.edges)?;
        let n_levels = origin.hierarchy().levels().len();
        let mut levels = vec![reading::at_sites(&origin, texture)];
        for level in 1..n_levels {
            let coarser = coarser(origin.hierarchy(), level - 1, &levels[level - 1])?;
            levels.push(coarser);
        }
        Ok(Self {
            origin: Arc::new(origin),
            pyramid: Pyramid { levels },
        })
    }

    /// The number of values of a site.
    #[must_use]
    pub fn n_channels(&self) -> usize {
        self.pyramid.levels[0].n_channels
    }

    /// The surface, its sites and their directions.
    #[must_use]
    pub fn source(&self) -> &Synthesizer {
        &self.origin.synthesizer
    }

    /// The neighborhoods of the sites that a pass compares with.
    fn candidates(&self, pass: &Pass, options: &Options) -> Result<Candidates, SynthError> {
        rows::candidates(&self.origin.synthesizer, &self.pyramid, pass, options)
    }

    /// The sites of the finest levels.
    fn levels(&self, n_levels: usize) -> Result<&[Exemplar], SynthError> {
        self.pyramid.levels.get(..n_levels).ok_or_else(|| {
            SynthError::new(SynthErrorKind::Count {
                what: "levels",
                count: n_levels,
                needed: "at most those of the example's sites",
            })
        })
    }

    /// Runs the passes on a ground, which is that of a target.
    fn grow(
        &self,
        target: &Synthesizer,
        ground: &MeshGround<'_>,
        options: &Options,
        callback: Callback<'_>,
    ) -> Result<SurfaceTexture, SynthError> {
        let levels = self.levels(options.n_levels)?.to_vec();
        let pyramid = Pyramid { levels };
        let candidates = |pass: &Pass| self.candidates(pass, options);
        let passes = options.passes()?.passes;
        let levels = engine::run_with(ground, &pyramid, &passes, &candidates, options, callback)?;
        let (sources, quarters) = Sources::pixels_and_quarters(levels);
        let finest = sources.first().map_or(&[][..], Vec::as_slice);
        let frames = Frames::new(target, &quarters);
        let places = LiftedPlaces::new(target.hierarchy(), &frames, &self.origin, finest, options);
        let mut texture = SurfaceTexture::new(&pyramid, sources, None);
        texture.lifted = Some(places);
        texture.quarters = quarters;
        Ok(texture)
    }
}

impl Synthesizer {
    /// Gives every site the color of a site of another surface. `guides` are those of
    /// [`synthesize_guided`](Self::synthesize_guided), as many as the example's texture has.
    ///
    /// The texture is baked as others are, with the maps of the example's own texture coordinates, of any size:
    /// [`bake_colors`](crate::bake_colors) and beside it. The [sources](SurfaceTexture::sources) of sites are the numbers of
    /// the example's sites, in row 0. [`Coherence::Auto`](crate::Coherence::Auto) is a factor of 2.
    ///
    /// # Errors
    ///
    /// Those of [`synthesize_guided`](Self::synthesize_guided), and [`SynthErrorKind::Count`] for more levels than the sites
    /// of the example have.
    pub fn lift(
        &self,
        exemplar: &MeshExemplar,
        guides: &[&[f32]],
        options: &Options,
        mut callback: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<SurfaceTexture, SynthError> {
        self.check_levels(options)?;
        let finest = &exemplar.pyramid.levels[0];
        let targets = Targets::of_surface(finest, guides, self.hierarchy(), options.n_levels)?;
        let ground = MeshGround {
            targets: Some(&targets),
            ..self.ground(options.axes, false)
        };
        exemplar.grow(self, &ground, options, &mut callback)
    }
}

/// The sites of the next coarser level.
fn coarser(hierarchy: &Hierarchy, level: usize, finer: &Exemplar) -> Result<Exemplar, SynthError> {
    let n_sites = hierarchy.levels()[level + 1].n_sites();
    let halved = |values: &[f32], n: usize| {
        let mut pixels = vec![0.0; n_sites * n];
        for channel in 0..n {
            let column: Vec<f32> = values.iter().skip(channel).step_by(n).copied().collect();
            let column = hierarchy.downsample(level, &column)?;
            for (pixel, value) in pixels.chunks_exact_mut(n).zip(column) {
                pixel[channel] = value;
            }
        }
        Ok::<_, SynthError>(pixels)
    };
    // A site is mixed with those up to two edges away.
    let usable = finer.usable.as_ref().map(|usable| {
        let graph = hierarchy.levels()[level].graph();
        let mut usable = reading::eroded(&reading::eroded(usable, graph), graph);
        usable.truncate(n_sites);
        usable
    });
    let mut guides = finer.guides.clone();
    guides.values = halved(&guides.values, guides.roots.len())?;
    Ok(Exemplar {
        size: [n_sites as u32, 1],
        n_channels: finer.n_channels,
        edges: Edges::Cut,
        pixels: halved(&finer.pixels, finer.n_channels)?,
        usable,
        areas: Vec::new(),
        guides,
    })
}
