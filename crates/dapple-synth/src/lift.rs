//! Lifting: synthesis with another textured surface as the exemplar.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, DOI 10.1145/383259.383297. Section 8 ends with
//! future work: "to extend this method to taking patterns directly from other surfaces. Imagine being able to "lift"
//! the color, bumps and ridges from one model and place them onto another surface." The paper does not say how.
//!
//! Here the source surface has its own sites, on as many levels as the target, with an orientation field and a sweep
//! order. These sites serve as the pixels of the exemplar:
//!
//! * The color of a finest site is the mean of the source's texture over a square with a side of one site spacing. The
//!   square's points are found by walking over the faces, so that seams of the texture's charts do not show. Coarser
//!   levels are low-pass filtered columns (section 3.2).
//! * The neighborhood of a site is read on the source as on the target: by walking along the field, with interpolation
//!   between sites by equation 1. Both are blurred equally, so the additional blur for image exemplars is not needed.
//!   All neighborhoods are compared, and the match is exact. Neighborhoods that meet a border or a sharp fold of the
//!   source are excluded, as are those that reach past the edge of an image.
//! * In an image, columns and rows define which pixel is adjacent to another. Here it is the site nearest to the end of
//!   a step along the surface.
//! * A sub-pixel source is a site of the source plus an offset in the site's frame. A texel walks along the offset
//!   and samples the texture at the texture coordinates where the walk ends. The result is as sharp as the source, and
//!   every map of the source can be transferred.
//!
//! An alternative would be to flatten patches of the source to an image, in which neighborhoods cannot cross from patch
//! to patch. On the coarsest of three levels a neighborhood spans 24 pixels. Patches would therefore either overlap
//! many times, or lose most of a source as small as a typical model.
//!
//! Units: a pixel is the spacing of the finest sites, on the source and on the target.

mod origin;
mod reading;
mod repair;
mod rows;
#[cfg(test)]
mod tests;

pub(crate) use origin::{LiftedDetail, LiftedPlaces, Origin};
pub(crate) use repair::order as order_of_repair;

use crate::domain::Sources;
use crate::engine::{self, Callback, Progress};
use crate::guides::Targets;
use crate::mesh_domain::MeshDomain;
use crate::places::Frames;
use crate::{
    Candidates, Edges, Exemplar, Hierarchy, Options, Pass, Pyramid, SurfaceTexture, SynthError,
    SynthErrorKind, Synthesizer,
};
use core::ops::ControlFlow;
use glam::DVec2;
use std::sync::Arc;

/// A textured surface as an exemplar.
#[derive(Clone, Debug)]
pub struct MeshExemplar {
    origin: Arc<Origin>,
    /// Sites of every level, each level stored as an image with one row.
    pyramid: Pyramid,
}

impl MeshExemplar {
    /// Creates an exemplar from `source`, a surface with sites and directions. `uvs` has the texture coordinates of the
    /// corners of each face, with v down; integer offsets are removed per face. `texture` is the source's texture in
    /// these coordinates: an exemplar of colors or other planes, with optional weights, mask and guides.
    ///
    /// The sites are matched like the pixels of an image. Features have the same size on the target as on the source if
    /// both have the same site spacing. More sites on the source make features larger. Sites next to texels that a
    /// [mask](Exemplar::with_mask) excludes are not used. [Scales](Synthesizer::with_scales) of the source have no
    /// effect.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] unless `uvs` has an entry for each face, and [`SynthErrorKind::Range`] if a coordinate
    /// is outside -10^6 to 10^6.
    ///
    /// # Examples
    ///
    /// Lift a checker from one tetrahedron to another.
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
        // The finest level samples the texture; each coarser one is low-pass filtered, as in a Gaussian pyramid.
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

    /// Returns the number of values per site.
    #[must_use]
    pub fn n_channels(&self) -> usize {
        self.pyramid.levels[0].n_channels
    }

    /// Returns the source surface with its sites and directions.
    #[must_use]
    pub fn source(&self) -> &Synthesizer {
        &self.origin.synthesizer
    }

    /// Returns the candidate neighborhoods of a pass.
    fn candidates(&self, pass: &Pass, options: &Options) -> Result<Candidates, SynthError> {
        rows::candidates(&self.origin.synthesizer, &self.pyramid, pass, options)
    }

    /// Returns the finest `n_levels` levels of sites, or an error if the source has fewer.
    fn levels(&self, n_levels: usize) -> Result<&[Exemplar], SynthError> {
        self.pyramid.levels.get(..n_levels).ok_or_else(|| {
            SynthError::new(SynthErrorKind::Count {
                what: "levels",
                count: n_levels,
                needed: "at most those of the example's sites",
            })
        })
    }

    /// Runs the passes of `options` on the target's sites, whose neighborhoods `domain` samples.
    fn grow(
        &self,
        target: &Synthesizer,
        domain: &MeshDomain<'_>,
        options: &Options,
        callback: Callback<'_>,
    ) -> Result<SurfaceTexture, SynthError> {
        let levels = self.levels(options.n_levels)?.to_vec();
        let pyramid = Pyramid { levels };
        let candidates = |pass: &Pass| self.candidates(pass, options);
        let passes = options.passes()?.passes;
        let levels = engine::run_with(domain, &pyramid, &passes, &candidates, options, callback)?;
        let (sources, quarters) = Sources::pixels_and_quarters(levels);
        let finest = sources.first().map_or(&[][..], Vec::as_slice);
        // Find positions between the source's sites, from which texels are sampled.
        let frames = Frames::new(target, &quarters);
        let places = LiftedPlaces::new(target.hierarchy(), &frames, &self.origin, finest, options);
        let mut texture = SurfaceTexture::new(&pyramid, sources, None);
        texture.lifted = Some(places);
        texture.quarters = quarters;
        Ok(texture)
    }
}

impl Synthesizer {
    /// Synthesizes a texture from another surface: every site takes the color of a source site. `guides` are as in
    /// [`synthesize_guided`](Self::synthesize_guided); their number must equal the number of guides of the exemplar's
    /// texture.
    ///
    /// Bake the result like any other texture, for example with [`bake_colors`](crate::bake_colors), from maps of any
    /// size in the exemplar's texture coordinates. The [sources](SurfaceTexture::sources) are indices of the exemplar's
    /// sites, in row 0. [`Coherence::Auto`](crate::Coherence::Auto) means a factor of 2.
    ///
    /// # Errors
    ///
    /// Same as [`synthesize_guided`](Self::synthesize_guided), and [`SynthErrorKind::Count`] if `options` has more
    /// levels than the exemplar's sites.
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
        let domain = MeshDomain {
            targets: Some(&targets),
            ..self.domain(options.axes, false)
        };
        exemplar.grow(self, &domain, options, &mut callback)
    }
}

/// Downsamples the values of `finer`, the sites of `level`, to the next coarser level.
fn coarser(hierarchy: &Hierarchy, level: usize, finer: &Exemplar) -> Result<Exemplar, SynthError> {
    let n_sites = hierarchy.levels()[level + 1].n_sites();
    let halved = |values: &[f32], n: usize| {
        let mut pixels = vec![0.0; n_sites * n];
        for channel in 0..n {
            let column: Vec<f32> = values.iter().skip(channel).step_by(n).copied().collect();
            // Section 3.2: blur the channel, and drop the sites of the finer level.
            let column = hierarchy.downsample(level, &column)?;
            for (pixel, value) in pixels.chunks_exact_mut(n).zip(column) {
                pixel[channel] = value;
            }
        }
        Ok::<_, SynthError>(pixels)
    };
    // The low-pass filter reaches sites up to two edges away.
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
