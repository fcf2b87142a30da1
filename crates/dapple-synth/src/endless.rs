//! Endless textures: any window of a texture without ends, made on its own.
//!
//! References: Sylvain Lefebvre and Hugues Hoppe, "Parallel Controllable Texture Synthesis", SIGGRAPH 2005, DOI
//! 10.1145/1186822.1073261; the same, "Appearance-Space Texture Synthesis", SIGGRAPH 2006, DOI 10.1145/1141911.1141921.
//!
//! From level to level each pixel becomes four, which go on where it is in the exemplar. Then every pixel is corrected a few
//! times: of the pixels that its neighbors go on to, and of the one most like each of these, it takes the one around which
//! the exemplar looks most like the texture around it. What is compared are not colors but the principal components of
//! windows. A quarter of the pixels, such as those whose columns and rows are even, is corrected at a time; they do not
//! read each other. So a pixel depends on what is near it on each level, and in the end on random pixels of the coarsest
//! one, which hashes of their columns and rows choose: a window is made with a margin on every level, and nothing else.
//!
//! Departures from the papers: the coarsest level begins with random pixels of the exemplar and not with copies of it. Only
//! where it is a tile of something that repeats in it, such as bricks, it begins with copies, of whose pixels each is
//! replaced by one that is like it, or like that, and so on: random ones would settle to courses that do not go on. There
//! is no jitter on finer levels; where nothing repeats, what only is like what goes on is at a disadvantage; levels are corrected three times, the coarsest six times, and not twice; the pixel most
//! like another is searched on the grid of its level, of which each pixel takes the place beside its own; features near an
//! edge that is cut are left out where enough others remain ([`stage`]), and those of averages of the texture are not
//! projected a second time. Parts of the exemplar that textures would have too often cost more ([`evenness`]).

pub(crate) mod evenness;
pub(crate) mod stage;
mod window;

use crate::engine::{Progress, Wanted};
use crate::guides::Guides;
use crate::options::REGULAR;
use crate::{Edges, Exemplar, PlaneTexture, Symmetry, SynthError, SynthErrorKind};
use core::ops::ControlFlow;
use dapple_hash::Seed;
use evenness::REPETITION;
use stage::Stage;

/// By how much more than once the distance counts of a pixel that only is like one that a neighbor goes on to, where the
/// exemplar is not regular: what goes on keeps its detail.
///
/// Measured on photographs, four textures of each: colors and patches are nearer to those of the exemplar
/// ([`Likeness`](crate::Likeness)) by half for grass, rock, sand and gravel, by a tenth for leaves, and a seventh farther
/// for a meadow and for wood. With 2 leaves lose what they gained; and weave, which is regular, is torn already with 1.
const COHERENCE: f32 = 1.0;

/// The most levels.
const MAX_LEVELS: u32 = 16;

/// The pixels of the coarsest level along the shorter side of an exemplar, at least, where the number of levels follows from it.
const COARSEST: u32 = 4;

/// Columns and rows of windows are at most this far from the first.
const MAX_PLACE: i64 = 1 << 52;

/// Options of an [`Endless`] texture.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct EndlessOptions {
    /// The seed of the coarsest level; by default `Seed(0)`.
    pub seed: Seed,
    /// The levels, from 1 to 16. The more there are, the larger are the things that the texture has as the exemplar has
    /// them; by default as many as the exemplar has room for: the coarsest has from 4 to 7 pixels along its shorter side.
    pub n_levels: Option<u32>,
    /// The columns and rows after which the texture repeats, multiples of 2 to the number of levels; by default it does
    /// not.
    pub period: [Option<u32>; 2],
}

/// A texture without ends that looks like an exemplar, of which any window can be made.
///
/// A window has the same pixels as any larger one has there.
///
/// # Examples
///
/// ```
/// use core::ops::ControlFlow;
/// use dapple_raster::Raster;
/// use dapple_synth::{Edges, Endless, EndlessOptions, Exemplar};
///
/// let checker = Raster::from_fn([32, 32], |x, y| f32::from((x / 4 + y / 4) % 2 == 0))?;
/// let exemplar = Exemplar::from_planes(&[(&checker, 1.0)], Edges::Wrap)?;
/// let texture = Endless::new(&exemplar, &EndlessOptions::default())?;
/// let window = |first, size| texture.window(first, size, |_| ControlFlow::Continue(()));
/// let whole = window([0, 0], [48, 40])?;
/// let part = window([20, 10], [8, 5])?;
/// assert_eq!(part.sources().row(4)[7], whole.sources().row(14)[27]);
/// assert_eq!(whole.transfer(&checker)?.size(), [48, 40]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Endless {
    size: [u32; 2],
    edges: Edges,
    seed: Seed,
    period: [Option<u32>; 2],
    /// The levels, the finest first.
    stages: Vec<Stage>,
    /// The pixels that textures may have on the coarsest level.
    coarsest: Vec<u32>,
    /// Whether the exemplar is a tile of something that repeats within it.
    is_lattice: bool,
}

impl Endless {
    /// Prepares a texture: most of the time of small windows, about a microsecond per pixel of the exemplar and
    /// level, and half a second of one core for trials that show which parts of the exemplar textures would have too often.
    ///
    /// A [mask](Exemplar::with_mask) of the exemplar is heeded; its [guides](Exemplar::with_guides) are not.
    ///
    /// # Errors
    ///
    /// Typed errors for another number of levels than 1 to 16, for more than there are pixels along a side of the exemplar,
    /// for a period that is no multiple of 2 to their number, and for a mask that leaves nothing.
    pub fn new(exemplar: &Exemplar, options: &EndlessOptions) -> Result<Self, SynthError> {
        Self::new_cancellable(exemplar, options, &|| false)
    }

    /// What [`new`](Self::new) prepares, unless `is_cancelled` returns true. It is called on any thread, and once for some
    /// milliseconds of work.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new), and [`SynthErrorKind::Cancelled`](crate::SynthErrorKind::Cancelled).
    pub fn new_cancellable(
        exemplar: &Exemplar,
        options: &EndlessOptions,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Result<Self, SynthError> {
        let wanted = Wanted::new(is_cancelled);
        let side = exemplar.size[0].min(exemplar.size[1]);
        let most = side
            .checked_ilog2()
            .map_or(0, |levels| (levels + 1).min(MAX_LEVELS));
        let n_levels = options.n_levels.unwrap_or_else(|| {
            let levels = (side / COARSEST).checked_ilog2();
            levels.map_or(1, |levels| (levels + 1).min(MAX_LEVELS))
        });
        let range = "from 1 to 16, and none wider than the exemplar";
        let holds = (1..=most).contains(&n_levels);
        SynthError::check(holds, "number of levels", n_levels.into(), range)?;
        for period in options.period.into_iter().flatten() {
            if period == 0 || period % (1 << n_levels) != 0 {
                return Err(SynthError::new(SynthErrorKind::Period { period, n_levels }));
            }
        }
        let mut stages = stage::stages(
            exemplar,
            &Guides::default(),
            Symmetry::One,
            n_levels as usize,
            &wanted,
        )?;
        let is_tile = exemplar.edges == Edges::Wrap && exemplar.usable.is_none();
        let is_regular = exemplar.regularity() > REGULAR;
        for stage in &mut stages {
            stage.coherence = if is_regular { 0.0 } else { COHERENCE };
        }
        let mut texture = Self {
            is_lattice: is_tile && is_regular,
            size: exemplar.size,
            edges: exemplar.edges,
            seed: options.seed,
            period: options.period,
            coarsest: stages.last().map_or(Vec::new(), Stage::usable_pixels),
            stages,
        };
        // Copies of what repeats are even, and moving it would break it.
        if !texture.is_lattice {
            let repetition = if is_regular { 0.0 } else { REPETITION };
            texture.even_out(repetition, &wanted)?;
        }
        Ok(texture)
    }

    /// The number of levels.
    #[must_use]
    pub fn n_levels(&self) -> usize {
        self.stages.len()
    }

    /// The window of `size` pixels whose first pixel is in the given column and row, at most 2^26 pixels.
    ///
    /// Along an axis on which it has the length of the period it wraps.
    ///
    /// # Errors
    ///
    /// Typed errors for no pixels and too many, and for columns and rows beyond 2^52; and
    /// [`SynthErrorKind::Cancelled`](crate::SynthErrorKind::Cancelled) if the callback breaks.
    pub fn window(
        &self,
        first: [i64; 2],
        size: [u32; 2],
        mut callback: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<PlaneTexture, SynthError> {
        crate::plane::check_pixels(size)?;
        for at in first {
            let holds = (-MAX_PLACE..=MAX_PLACE).contains(&at);
            let range = "from -2^52 to 2^52";
            SynthError::check(holds, "first column or row", at as f64, range)?;
        }
        let sources = self.sources(first, size, &mut callback)?;
        let edges = [0, 1].map(|axis| match self.period[axis] == Some(size[axis]) {
            true => Edges::Wrap,
            false => Edges::Cut,
        });
        PlaneTexture::from_sources(sources, edges, self.size, self.edges)
    }
}

#[cfg(test)]
mod tests;
