//! What a synthesis can be told.

use crate::{CoarserCenter, Schedule, SynthError, SynthErrorKind};
use dapple_hash::Seed;

/// The most that may be asked of [`Options::evenness`]: no factor can make a distance infinite.
const MAX_EVENNESS: f32 = 1000.0;

/// How a texture is made from an exemplar.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
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
    /// How much worse a match may be that continues the source of a neighboring site: it wins if its squared distance is at
    /// most `1 + coherence` times the least; in passes that read no coarser level, where no later one can mend what does
    /// not fit together, `1 + coherence / 2` times. By default 2; at 0 the least always wins, as in the paper.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/coherence.md"))]
    pub coherence: f32,
    /// How evenly the pixels of the exemplar are used, from 0 to 1000, by default 1.
    ///
    /// In passes that read no coarser level, of which the paper's schedule has one, the squared distance of a pixel is
    /// multiplied by `1 + evenness` if it and those around it were already used as often as all are in the end on the
    /// average; such a pass runs on one thread. And pixels near an edge of the exemplar are used, too, as if it were
    /// mirrored there. At 0 only the least distance counts, as in the paper: many pixels are then never used, and colors
    /// that are rare vanish.
    pub evenness: f32,
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
            coherence: 2.0,
            evenness: 1.0,
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
            evenness: 0.0,
            ..Self::default()
        }
    }

    /// The passes: the given ones, or those of the paper.
    ///
    /// # Errors
    ///
    /// Typed errors for no level, more than 16, a coherence that is below zero or not finite, an evenness that is not
    /// from 0 to 1000, and as [`Schedule::check`].
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
        SynthError::check(
            (0.0..=MAX_EVENNESS).contains(&self.evenness),
            "evenness",
            self.evenness.into(),
            "from 0 to 1000",
        )?;
        let schedule = self.schedule.clone();
        let schedule = schedule.unwrap_or_else(|| Schedule::paper(self.n_levels));
        schedule.check(self.n_levels)?;
        Ok(schedule)
    }
}
