//! Entry points for synthesis on surfaces: a one-call function, and a reusable solver.

use crate::appearance::Appearance;
use crate::domain;
use crate::engine::{self, Callback, Progress};
use crate::guides::Targets;
use crate::mesh_domain::MeshDomain;
use crate::places::{Frames, Places};
use crate::{
    Axes, Direction, Exemplar, Hierarchy, HierarchyOptions, Matching, Options, Orientation,
    Pyramid, SiteIdx, Sources, SurfaceTexture, Sweep, SynthError, SynthErrorKind,
};
use core::ops::ControlFlow;
use dapple_mesh::{Mesh, Surface};

/// A surface with its sites, orientation field and sweep distances, that is, everything that does not depend on the
/// exemplar.
#[derive(Clone, Debug)]
pub struct Synthesizer {
    surface: Surface,
    hierarchy: Hierarchy,
    orientation: Orientation,
    sweep: Sweep,
    /// Size of an exemplar pixel at each site, in multiples of the spacing; empty if all are 1.
    scales: Vec<f32>,
}

/// Covers a mesh with a texture that looks like an exemplar. `directions` specify the exemplar's "down" on the surface.
///
/// # Errors
///
/// Same as [`Synthesizer::new`] and [`Synthesizer::synthesize`].
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
    /// Scatters sites over a surface, interpolates the directions and computes the sweep distances.
    ///
    /// # Errors
    ///
    /// Same as [`Hierarchy::new`], [`Orientation::new`] and [`Sweep::new`].
    pub fn new(
        surface: Surface,
        directions: &[Direction],
        sites: &HierarchyOptions,
    ) -> Result<Self, SynthError> {
        let hierarchy = Hierarchy::new(&surface, sites)?;
        let orientation = Orientation::new(&hierarchy, directions)?;
        Self::from_parts(surface, hierarchy, orientation, None)
    }

    /// Creates a synthesizer from sites and an orientation field that the caller computed for this surface. `anchor` is
    /// the start of the sweep; see [`Sweep::new`].
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] if the orientation does not have one vector per site. Otherwise same as
    /// [`Sweep::new`].
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

    /// Sets the size of an exemplar pixel at each site, in multiples of the spacing, from 1/8 to 8. By default, all
    /// are 1.
    ///
    /// Above 1, the texture is smoother than the sites could represent. Below 1, it loses detail that more sites could
    /// represent.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] unless there is one scale for every site of [`hierarchy`](Self::hierarchy), and
    /// [`SynthErrorKind::Range`] if a scale is out of range.
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

    /// Scales the exemplar's pixels to fit the orientation field: larger where directions diverge, and smaller where
    /// they converge. Rows of features then continue instead of starting and ending there (Ray et al. 2006). `bounds`
    /// are the minimum and maximum size of a pixel, in multiples of the spacing.
    ///
    /// In each connected component of the surface, as many sites as possible are within the bounds. Around
    /// singularities of the field, where the size would be unbounded, it is clamped to a bound, and rows of features
    /// still merge.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if a bound is outside 1/8 to 8, or if the lower bound is above the upper one.
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
    /// // Rays from a point outside of the square: the size of features is proportional to the distance from it.
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

    /// Synthesizes a texture by assigning every site a color.
    ///
    /// # Errors
    ///
    /// If the exemplar is too small, if options are out of range, or if the options have more levels than the hierarchy
    /// of sites.
    pub fn synthesize(
        &self,
        exemplar: &Exemplar,
        options: &Options,
    ) -> Result<SurfaceTexture, SynthError> {
        self.synthesize_with(exemplar, options, |_| ControlFlow::Continue(()))
    }

    /// Synthesizes a texture like [`synthesize`](Self::synthesize), with a callback that receives the progress and can
    /// cancel.
    ///
    /// # Errors
    ///
    /// Same as [`synthesize`](Self::synthesize), or [`SynthErrorKind::Cancelled`] if the callback breaks.
    pub fn synthesize_with(
        &self,
        exemplar: &Exemplar,
        options: &Options,
        callback: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<SurfaceTexture, SynthError> {
        self.synthesize_guided(exemplar, &[], options, callback)
    }

    /// Synthesizes a texture like [`synthesize_with`](Self::synthesize_with), with guides that control which part of
    /// the exemplar appears where on the surface. There must be as many columns as the exemplar has
    /// [guides](Exemplar::with_guides), each with one value for every site of [`hierarchy`](Self::hierarchy).
    ///
    /// With guides, [`Options::evenness`] has no effect.
    ///
    /// # Errors
    ///
    /// Same as [`synthesize_with`](Self::synthesize_with); [`SynthErrorKind::Count`] if the number of guides differs
    /// from the exemplar's or a column does not have one value for each site; and [`SynthErrorKind::Range`] if a value
    /// is not finite.
    pub fn synthesize_guided(
        &self,
        exemplar: &Exemplar,
        guides: &[&[f32]],
        options: &Options,
        mut callback: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<SurfaceTexture, SynthError> {
        self.grow(exemplar, guides, options, &mut callback)
    }

    /// Implements [`synthesize_guided`](Self::synthesize_guided); compiled once for all callbacks.
    fn grow(
        &self,
        exemplar: &Exemplar,
        guides: &[&[f32]],
        options: &Options,
        callback: Callback<'_>,
    ) -> Result<SurfaceTexture, SynthError> {
        self.check_levels(options)?;
        // Build the exemplar pyramid, and the guides of the surface.
        let pyramid = exemplar.pyramid(options.n_levels)?;
        let targets = Targets::of_surface(exemplar, guides, &self.hierarchy, options.n_levels)?;
        let domain = MeshDomain {
            targets: Some(&targets),
            ..self.domain(options.axes, options.sources == Sources::SubPixel)
        };
        // Assign a pixel of the exemplar to every site.
        let (sources, quarters) = match options.matching {
            Matching::Appearance if options.schedule.is_none() => {
                self.by_appearance(&domain, &targets, &pyramid, options, callback)?
            }
            _ => {
                let levels = engine::run_turned(&domain, &pyramid, options, callback)?;
                domain::Sources::pixels_and_quarters(levels)
            }
        };
        // Refine the pixels of the finest sites to positions between pixels.
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

    /// Fails if the options have more levels than the hierarchy of sites.
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

    /// Synthesizes by appearance: the first pass runs on the coarsest level, then all levels are corrected. Returns the
    /// pixels of the sites of each level, finest first, and the rotation of the exemplar at the finest sites, in
    /// quarter turns.
    fn by_appearance(
        &self,
        domain: &MeshDomain<'_>,
        targets: &Targets,
        pyramid: &Pyramid,
        options: &Options,
        callback: Callback<'_>,
    ) -> Result<(Vec<Vec<u32>>, Vec<u8>), SynthError> {
        // Synthesize the coarsest level from colors.
        let exemplar = &pyramid.levels()[0];
        let passes = options.passes()?.passes;
        let mut first = |progress: Progress| {
            callback(Progress {
                n_passes: options.n_levels + 1,
                ..progress
            })
        };
        let mut levels = engine::run_passes(domain, pyramid, &passes[..1], options, &mut first)?;
        let coarsest = levels.split_off(options.n_levels - 1);
        let (sources, quarters) = domain::Sources::pixels_and_quarters(coarsest);
        // Correct all levels by appearance.
        let mut appearance = Appearance::new(self, exemplar, targets, &quarters, options)?;
        let places = appearance.run(&sources.concat(), callback)?;
        // Convert positions in the exemplar to pixels of each level.
        let pixels = |(level, places): (usize, Vec<[u32; 2]>)| {
            let width = pyramid.levels()[level].size[0];
            // Positions are in pixels of the finest level; each coarser level halves them.
            let pixel = |[column, row]: [u32; 2]| (row >> level) * width + (column >> level);
            places.into_iter().map(pixel).collect()
        };
        let pixels = places.into_iter().enumerate().map(pixels).collect();
        Ok((pixels, appearance.quarters))
    }

    /// Combines the surface, its sites and their orientation into a domain for the engine.
    pub(crate) fn domain(&self, axes: Axes, is_blurred: bool) -> MeshDomain<'_> {
        MeshDomain {
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

    /// Resets all scales to 1.
    pub(crate) fn without_scales(self) -> Self {
        Self {
            scales: Vec::new(),
            ..self
        }
    }

    /// Returns the size of an exemplar pixel at a site, in multiples of the spacing.
    pub(crate) fn scale(&self, site: usize) -> f32 {
        self.scales.get(site).copied().unwrap_or(1.0)
    }

    /// Returns the surface that the texture covers.
    #[must_use]
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Returns the sites and their levels.
    #[must_use]
    pub fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    /// Returns the orientation field: the direction of the texture's "down" at every site.
    #[must_use]
    pub fn orientation(&self) -> &Orientation {
        &self.orientation
    }

    /// Returns the sweep distances of the sites.
    #[must_use]
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }
}

/// Fails if a pixel size is outside 1/8 to 8.
fn check_scale(what: &'static str, scale: f32) -> Result<(), SynthError> {
    let holds = (0.125..=8.0).contains(&scale);
    SynthError::check(holds, what, scale.into(), "from 1/8 to 8")
}
