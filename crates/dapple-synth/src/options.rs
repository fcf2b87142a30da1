//! What a synthesis can be told.

use crate::{CoarserCenter, Schedule, SynthError, SynthErrorKind};
use dapple_hash::Seed;

/// How a texture is made from an exemplar.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default)
)]
pub struct Options {
    /// What the first colors are drawn from; by default `Seed(0)`.
    pub seed: Seed,
    /// The levels of the pyramid and of the sites; by default 3.
    pub n_levels: usize,
    /// The passes; by default those of the paper for `n_levels` levels.
    pub schedule: Option<Schedule>,
    /// Where neighborhoods on the coarser level are centered; by default exactly.
    pub center: CoarserCenter,
    /// Which way neighborhoods on surfaces go on away from their site; by default as the field does.
    pub axes: Axes,
    /// How much worse a match may be that continues the source of a neighboring site: it wins if its squared distance is
    /// at most `1 + coherence` times the least. At 0 the least always wins, as in the paper.
    pub coherence: f32,
}

/// Which way the rows and columns of a neighborhood on a surface go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Axes {
    /// They turn as the field around the site does, so that features along the field are straight in a neighborhood.
    #[default]
    Followed,
    /// Straight on in the directions P and O of the site, carried along, as the paper has it.
    Carried,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: Seed(0),
            n_levels: 3,
            schedule: None,
            center: CoarserCenter::Exact,
            axes: Axes::Followed,
            coherence: 1.0,
        }
    }
}

impl Options {
    /// Every literal choice of the paper.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            center: CoarserCenter::Floor,
            axes: Axes::Carried,
            coherence: 0.0,
            ..Self::default()
        }
    }

    /// The passes: the given ones, or those of the paper.
    ///
    /// # Errors
    ///
    /// Typed errors for no level, more than 16, a coherence that is below zero or not finite, and as [`Schedule::check`].
    pub(crate) fn passes(&self) -> Result<Schedule, SynthError> {
        if !(1..=16).contains(&self.n_levels) {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "levels",
                count: self.n_levels,
                needed: "1 to 16",
            }));
        }
        SynthError::check(
            self.coherence.is_finite() && self.coherence >= 0.0,
            "coherence",
            self.coherence.into(),
            "finite and at least 0",
        )?;
        let schedule = self.schedule.clone();
        let schedule = schedule.unwrap_or_else(|| Schedule::paper(self.n_levels));
        schedule.check(self.n_levels)?;
        Ok(schedule)
    }
}
