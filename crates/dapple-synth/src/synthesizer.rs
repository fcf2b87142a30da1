//! The doors for surfaces: one call for all of it, and what can be used again.

use crate::appearance::Appearance;
use crate::engine::{self, Callback, Progress};
use crate::ground;
use crate::guides::Targets;
use crate::mesh_ground::MeshGround;
use crate::places::{Frames, Places};
use crate::{
    Axes, Direction, Exemplar, Hierarchy, HierarchyOptions, Matching, Options, Orientation,
    Pyramid, SiteIdx, Sources, SurfaceTexture, Sweep, SynthError, SynthErrorKind,
};
use core::ops::ControlFlow;
use dapple_mesh::{Mesh, Surface};

/// A surface with its sites, their directions and their order: all that does not depend on the exemplar.
#[derive(Clone, Debug)]
pub struct Synthesizer {
    surface: Surface,
    hierarchy: Hierarchy,
    orientation: Orientation,
    sweep: Sweep,
    /// How large a pixel of the exemplar is at each site, in spacings; nothing where all are 1.
    scales: Vec<f32>,
}

/// Covers a mesh with a texture that looks like an exemplar: `directions` say which way its "down" runs.
///
/// # Errors
///
/// Those of [`Synthesizer::new`] and [`Synthesizer::synthesize`].
pub fn synthesize(
    mesh: Mesh,
    exemplar: &Exemplar,
    directions: &[Direction],
    sites: &HierarchyOptions,
    options: &Options,
) -> Result<(Synthesizer, SurfaceTexture), SynthError> {
    let synthesizer = Synthesizer::new(Surface::new(mesh)?, directions, sites)?;
    let texture = synthesizer.synthesize(exemplar, options)?;
    Ok((synthesizer, texture))
}

impl Synthesizer {
    /// Scatters sites over a surface, interpolates the directions and measures the sweep distance.
    ///
    /// # Errors
    ///
    /// Those of [`Hierarchy::new`], [`Orientation::new`] and [`Sweep::new`].
    pub fn new(
        surface: Surface,
        directions: &[Direction],
        sites: &HierarchyOptions,
    ) -> Result<Self, SynthError> {
        let hierarchy = Hierarchy::new(&surface, sites)?;
        let orientation = Orientation::new(&hierarchy, directions)?;
        Self::from_parts(surface, hierarchy, orientation, None)
    }

    /// Uses sites and orientations that the caller made for this surface, and an anchor of the sweep if that is given.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] if the columns do not belong together, and as [`Sweep::new`].
    pub fn from_parts(
        surface: Surface,
        hierarchy: Hierarchy,
        orientation: Orientation,
        anchor: Option<SiteIdx>,
    ) -> Result<Self, SynthError> {
        let (count, n_sites) = (orientation.vectors().len(), hierarchy.sites().len());
        if count != n_sites {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "orientations",
                count,
                needed: "as many as sites",
            }));
        }
        let sweep = Sweep::new(&hierarchy, &orientation, anchor)?;
        Ok(Self {
            surface,
            hierarchy,
            orientation,
            sweep,
            scales: Vec::new(),
        })
    }

    /// These sites with pixels of the exemplar of different sizes: for each site how large a pixel is there, in spacings, from
    /// 1/8 to 8. Without scales all are 1.
    ///
    /// What is larger than 1 is smoother than the sites could be; what is smaller loses detail that more sites would show.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] unless there is a scale for every site of [`hierarchy`](Self::hierarchy), and
    /// [`SynthErrorKind::Range`] for a scale out of its range.
    pub fn with_scales(self, scales: Vec<f32>) -> Result<Self, SynthError> {
        if scales.len() != self.hierarchy.sites().len() {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "scales",
                count: scales.len(),
                needed: "as many as sites",
            }));
        }
        for &scale in &scales {
            check_scale("scale", scale)?;
        }
        Ok(Self { scales, ..self })
    }

    /// These sites with pixels as large as the directions ask for, within bounds, in spacings: larger where rows of features
    /// spread, and smaller where they meet, so that they go on in place of beginning and ending there (Ray et al. 2006).
    ///
    /// As large a part as can be of each connected part of the surface lies between the bounds. Around the singularities of the
    /// field, where sizes would have no end, they are at one of them, and features still meet.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] for a bound outside of 1/8 to 8, and for a lower bound above the upper one.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_mesh::{Mesh, Surface, glam::DVec3};
    /// use dapple_synth::{Hierarchy, HierarchyOptions, Orientation, Synthesizer};
    ///
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::ONE - DVec3::Z, DVec3::Y];
    /// let surface = Surface::new(Mesh::new(corners, &[[0, 1, 2], [0, 2, 3]])?)?;
    /// let hierarchy = Hierarchy::new(&surface, &HierarchyOptions { n_sites: 500, ..Default::default() })?;
    /// // Rays from a point beside the square: features are as large as they are far from it.
    /// let rays = Orientation::from_fn(&hierarchy, |at, _| at + DVec3::X);
    /// let synthesizer = Synthesizer::from_parts(surface, hierarchy, rays, None)?;
    /// let synthesizer = synthesizer.with_conformal_scales([0.5, 2.0])?;
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn with_conformal_scales(self, bounds: [f32; 2]) -> Result<Self, SynthError> {
        let [least, most] = bounds;
        check_scale("upper scale", most)?;
        let (holds, range) = ((0.125..=most).contains(&least), "from 1/8 to the upper one");
        SynthError::check(holds, "lower scale", least.into(), range)?;
        let scales = self.orientation.conformal_scales(&self.hierarchy, bounds)?;
        self.with_scales(scales)
    }

    /// Gives every site a color.
    ///
    /// # Errors
    ///
    /// Typed errors for an exemplar that is too small, for options out of their ranges, and for more levels than the
    /// sites have.
    pub fn synthesize(
        &self,
        exemplar: &Exemplar,
        options: &Options,
    ) -> Result<SurfaceTexture, SynthError> {
        self.synthesize_with(exemplar, options, |_| ControlFlow::Continue(()))
    }

    /// Synthesizes a texture like [`synthesize`](Self::synthesize), with a callback that hears of the progress and can
    /// stop it.
    ///
    /// # Errors
    ///
    /// Those of [`synthesize`](Self::synthesize), and [`SynthErrorKind::Cancelled`] if the callback breaks.
    pub fn synthesize_with(
        &self,
        exemplar: &Exemplar,
        options: &Options,
        callback: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<SurfaceTexture, SynthError> {
        self.synthesize_guided(exemplar, &[], options, callback)
    }

    /// Synthesizes a texture like [`synthesize_with`](Self::synthesize_with), whose guides say where on the surface which
    /// part of the exemplar goes: as many columns as the exemplar has [guides](Exemplar::with_guides), each with a value for
    /// every site of [`hierarchy`](Self::hierarchy).
    ///
    /// With guides, [`Options::evenness`] has no effect.
    ///
    /// # Errors
    ///
    /// Those of [`synthesize_with`](Self::synthesize_with), [`SynthErrorKind::Count`] for another number of guides than the
    /// exemplar has and a column that has not as many values as there are sites, and [`SynthErrorKind::Range`] for a value
    /// that is not finite.
    pub fn synthesize_guided(
        &self,
        exemplar: &Exemplar,
        guides: &[&[f32]],
        options: &Options,
        mut callback: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<SurfaceTexture, SynthError> {
        self.grow(exemplar, guides, options, &mut callback)
    }

    /// What [`synthesize_guided`](Self::synthesize_guided) does, compiled for all callbacks.
    fn grow(
        &self,
        exemplar: &Exemplar,
        guides: &[&[f32]],
        options: &Options,
        callback: Callback<'_>,
    ) -> Result<SurfaceTexture, SynthError> {
        self.check_levels(options)?;
        let pyramid = exemplar.pyramid(options.n_levels)?;
        let targets = Targets::of_surface(exemplar, guides, &self.hierarchy, options.n_levels)?;
        let ground = MeshGround {
            targets: Some(&targets),
            ..self.ground(options.axes, options.sources == Sources::SubPixel)
        };
        let (sources, quarters) = match options.matching {
            Matching::Appearance if options.schedule.is_none() => {
                self.by_appearance(&ground, &targets, &pyramid, options, callback)?
            }
            _ => {
                let levels = engine::run_turned(&ground, &pyramid, options, callback)?;
                ground::Sources::pixels_and_quarters(levels)
            }
        };
        let places = match options.sources {
            Sources::Pixel => None,
            Sources::SubPixel => sources.first().map(|sources| {
                let frames = Frames::new(self, &quarters);
                Places::new(&self.hierarchy, &frames, &pyramid.levels()[0], sources)
            }),
        };
        let mut texture = SurfaceTexture::new(&pyramid, sources, places);
        texture.quarters = quarters;
        Ok(texture)
    }

    /// Refuses more levels than the sites have.
    pub(crate) fn check_levels(&self, options: &Options) -> Result<(), SynthError> {
        if options.n_levels <= self.hierarchy.levels().len() {
            return Ok(());
        }
        Err(SynthError::new(SynthErrorKind::Count {
            what: "levels",
            count: options.n_levels,
            needed: "at most those of the sites",
        }))
    }

    /// The pixels of the sites of each level, the finest first: of the first pass on the coarsest, and then corrected. And by
    /// how many quarter turns the exemplar lies turned at the finest ones.
    fn by_appearance(
        &self,
        ground: &MeshGround<'_>,
        targets: &Targets,
        pyramid: &Pyramid,
        options: &Options,
        callback: Callback<'_>,
    ) -> Result<(Vec<Vec<u32>>, Vec<u8>), SynthError> {
        let exemplar = &pyramid.levels()[0];
        let passes = options.passes()?.passes;
        let mut first = |progress: Progress| {
            callback(Progress {
                n_passes: options.n_levels + 1,
                ..progress
            })
        };
        let mut levels = engine::run_passes(ground, pyramid, &passes[..1], options, &mut first)?;
        let coarsest = levels.split_off(options.n_levels - 1);
        let (sources, quarters) = ground::Sources::pixels_and_quarters(coarsest);
        let mut appearance = Appearance::new(self, exemplar, targets, &quarters, options)?;
        let places = appearance.run(&sources.concat(), callback)?;
        let pixels = |(level, places): (usize, Vec<[u32; 2]>)| {
            let width = pyramid.levels()[level].size[0];
            let pixel = |[column, row]: [u32; 2]| (row >> level) * width + (column >> level);
            places.into_iter().map(pixel).collect()
        };
        let pixels = places.into_iter().enumerate().map(pixels).collect();
        Ok((pixels, appearance.quarters))
    }

    /// The surface, its sites and their orientation, on which the texture grows.
    pub(crate) fn ground(&self, axes: Axes, is_blurred: bool) -> MeshGround<'_> {
        MeshGround {
            surface: &self.surface,
            hierarchy: &self.hierarchy,
            orientation: &self.orientation,
            sweep: &self.sweep,
            axes,
            scales: &self.scales,
            is_blurred,
            targets: None,
            starts: &[],
        }
    }

    /// These sites, at which all pixels of the exemplar have the same size.
    pub(crate) fn without_scales(self) -> Self {
        Self {
            scales: Vec::new(),
            ..self
        }
    }

    /// How large a pixel of the exemplar is at a site, in spacings.
    pub(crate) fn scale(&self, site: usize) -> f32 {
        self.scales.get(site).copied().unwrap_or(1.0)
    }

    /// The surface.
    #[must_use]
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The sites and their levels.
    #[must_use]
    pub fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    /// Which way the texture runs at every site.
    #[must_use]
    pub fn orientation(&self) -> &Orientation {
        &self.orientation
    }

    /// How far downstream every site is.
    #[must_use]
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }
}

/// Refuses a size of a pixel out of the range of sizes.
fn check_scale(what: &'static str, scale: f32) -> Result<(), SynthError> {
    let holds = (0.125..=8.0).contains(&scale);
    SynthError::check(holds, what, scale.into(), "from 1/8 to 8")
}
