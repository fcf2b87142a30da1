//! Options of a synthesis.

use crate::{CoarserCenter, Exemplar, Schedule, SynthError, SynthErrorKind};
use core::num::ParseFloatError;
use core::str::FromStr;
use dapple_hash::Seed;

/// The most that may be asked of [`Options::evenness`]: no factor can make a distance infinite.
const MAX_EVENNESS: f32 = 1000.0;

/// The regularity from which on the least distance wins: between those of the exemplars that look better so, from 0.93,
/// and of those that look better with a coherence of 2, up to 0.86.
pub(crate) const REGULAR: f64 = 0.9;

/// Options of a synthesis from an exemplar.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Options {
    /// The seed of the first colors; by default `Seed(0)`.
    pub seed: Seed,
    /// The levels of the pyramid and of the sites; by default 3.
    pub n_levels: usize,
    /// The passes; by default those of the paper for `n_levels` levels.
    pub schedule: Option<Schedule>,
    /// Where neighborhoods on the coarser level are centered; by default exactly.
    pub center: CoarserCenter,
    /// The values that are compared on surfaces; by default what windows look like.
    pub matching: Matching,
    /// Which way neighborhoods on surfaces go on away from their site; by default as the field does.
    pub axes: Axes,
    /// Which sources the finest sites on surfaces have; by default between pixels.
    pub sources: Sources,
    /// How much worse a match may be that continues the source of a neighboring site; by default as the exemplar asks
    /// for.
    pub coherence: Coherence,
    /// How evenly the pixels of the exemplar are used, from 0 to 1000, by default 1.
    ///
    /// In passes that read no coarser level, of which the paper's schedule has one, the squared distance of a pixel is
    /// multiplied by `1 + evenness` if it and those around it were already used as often as all are in the end on the
    /// average; such a pass runs on one thread. And pixels near an edge of the exemplar are used, too, as if it were
    /// mirrored there. Where appearance is compared, parts of the exemplar cost more from one correction to the next that the
    /// texture has too often. At 0 only the least distance counts, as in the paper: many pixels are then never used, and colors
    /// that are rare vanish.
    pub evenness: f32,
}

/// How much worse a match may be that continues the source of a neighboring site.
///
/// In text it is `auto` or a number.
///
#[cfg_attr(doc, doc = include_str!("../docs/coherence.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Coherence {
    /// A factor of 2; but for a regular exemplar, one whose [`Exemplar::regularity`] is above 0.9, the least distance
    /// wins in passes that read a coarser level.
    ///
    /// Where the exemplar has what fits, as hooks that interlock and courses of bricks, the least distance finds it, and
    /// with 2 the texture tears instead. In photographs no detail occurs twice, and the least distance blurs it away:
    /// leaves keep 0.65 of their standard deviation with 0, and 0.87 with 2.
    ///
    /// In passes that read no coarser level the factor is 1 for any exemplar, as with a coherence of 2. There the sweep
    /// begins among random colors, and their averages resemble only a few pixels of the exemplar. With 0 those are taken
    /// again and again: the squares of a checker run together where the sweep begins.
    ///
    /// Measuring the regularity takes a few milliseconds.
    #[default]
    Auto,
    /// It wins if its squared distance is at most 1 + this times the least; in passes that read no coarser level, where
    /// no later one can mend what does not fit together, 1 + half of this times. Finite and at least 0; at 0 the least
    /// always wins, as in the paper.
    Factor(f32),
}

/// How much worse a match may be that continues the source of a neighboring site, at least 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoherenceFactors {
    /// In passes that read no coarser level.
    pub(crate) initial: f32,
    /// In passes that read one.
    pub(crate) finer: f32,
}

impl Coherence {
    /// The factors for an exemplar.
    pub(crate) fn factors(self, exemplar: &Exemplar) -> CoherenceFactors {
        let (factor, is_least) = match self {
            Self::Auto => (2.0, exemplar.regularity() > REGULAR),
            Self::Factor(factor) => (factor, false),
        };
        CoherenceFactors {
            initial: 0.5 * factor,
            finer: if is_least { 0.0 } else { factor },
        }
    }
}

impl FromStr for Coherence {
    type Err = ParseFloatError;

    fn from_str(text: &str) -> Result<Self, ParseFloatError> {
        match text {
            "auto" => Ok(Self::Auto),
            number => number.parse().map(Self::Factor),
        }
    }
}

dapple_raster::named! {
    /// The values that are compared to find the pixels of the sites on a surface.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Matching {
        /// Colors of squares, site after site in the order of the sweep, as in the paper.
        Colors = "colors",
        /// What the exemplar looks like in windows around pixels, after Lefebvre and Hoppe (2006), but in the first pass: all
        /// sites of a level are corrected a few times by what is around them. It takes a quarter of the time, strands break
        /// off a quarter less often, and letters are more often whole. Where [`Options::schedule`] is given, colors are
        /// compared all the same.
        ///
        /// Measured on flat textures of 65,536 sites: windows of 11 × 11 pixels are nearer to those of the exemplar by 25 %
        /// for hooks (4 levels), 15 % for text (4), 10 % for leaves, 9 % for grass and 8 % for puzzle pieces.
        #[default]
        Appearance = "appearance",
    }
}

dapple_raster::named! {
    /// What the finest sites on a surface have of the exemplar, and what texture maps show between them.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Sources {
        /// Places between pixels, moved to where the neighbors that go on with the same piece of the exemplar predict
        /// them. Texture maps read the exemplar there, as sharp as it is, or a larger version of it.
        #[default]
        SubPixel = "sub-pixel",
        /// Pixels, whose values are mixed between sites, as in the paper.
        Pixel = "pixel",
    }
}

dapple_raster::named! {
    /// Which way the rows and columns of a neighborhood on a surface go.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Axes {
        /// They turn as the field around the site does, so that features along the field are straight in a neighborhood.
        #[default]
        Followed = "followed",
        /// Straight on in the directions P and O of the site, carried along, as the paper has it.
        Carried = "carried",
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: Seed(0),
            n_levels: 3,
            schedule: None,
            center: CoarserCenter::Exact,
            matching: Matching::Appearance,
            axes: Axes::Followed,
            sources: Sources::SubPixel,
            coherence: Coherence::default(),
            evenness: 1.0,
        }
    }
}

impl Options {
    /// The paper at its word: neighborhoods on the coarser level are centered at rounded coordinates and laid out
    /// straight on, the least difference always wins, and texture maps mix the colors of sites.
    ///
    /// Differences from its text remain, on every surface and with any options:
    ///
    /// * Where fewer than 400 neighborhoods of a level lie within an exemplar that does not wrap, those that reach past its
    ///   edges are compared as well, as if it were mirrored there. The paper compares none of them; of 8 × 8 pixels, which
    ///   64 × 64 have on the fourth level, ten would be left.
    /// * In the sweep distance neighbors count less that disagree by about a spacing or more (Cauchy's weights), so that a
    ///   distance that cannot grow everywhere jumps along few lines. In the paper all count by their edge lengths alone.
    /// * Directions and the sweep distance are solved for on the coarsest level by conjugate gradients, where the paper
    ///   repeats equations 4 and 5: the averages that those would settle at, but for the weights.
    /// * A level of sites begins with the middles of the edges between the sites before it, where the paper scatters random
    ///   points, and sites push each other with another force than in Turk's paper of 1991 (see
    ///   [`nested_points`](crate::nested_points)).
    ///
    /// The documentation of [this crate](crate) lists how it reads what the paper leaves open.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            center: CoarserCenter::Floor,
            matching: Matching::Colors,
            axes: Axes::Carried,
            sources: Sources::Pixel,
            coherence: Coherence::Factor(0.0),
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
        if let Coherence::Factor(factor) = self.coherence {
            let holds = factor.is_finite() && factor >= 0.0;
            SynthError::check(holds, "coherence", factor.into(), "finite and at least 0")?;
        }
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

#[cfg(test)]
mod tests {
    use super::{Coherence, CoherenceFactors, Options};
    use crate::{Edges, Exemplar, synthesize_plane};
    use dapple_hash::{Seed, hash2, unit_f32};
    use dapple_raster::Raster;

    #[test]
    fn coherence_follows_from_the_regularity_of_the_exemplar() {
        let noise =
            |x: u32, y: u32| unit_f32((hash2(Seed(3), [x.into(), y.into()], 0) >> 32) as u32);
        for (period, finer) in [(16, 0.0), (48, 2.0)] {
            let plane = Raster::from_fn([48, 48], |x, y| noise(x % period, y % period)).unwrap();
            let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Wrap).unwrap();
            let expected = CoherenceFactors {
                initial: 1.0,
                finer,
            };
            let found = Coherence::Auto.factors(&exemplar);
            assert_eq!(found, expected, "period {period}");
            let [auto, coherent, least] = [
                Coherence::Auto,
                Coherence::Factor(2.0),
                Coherence::Factor(0.0),
            ]
            .map(|coherence| {
                let options = Options {
                    coherence,
                    ..Options::default()
                };
                synthesize_plane(&exemplar, [32; 2], [Edges::Cut; 2], &options).unwrap()
            });
            assert_eq!(auto == coherent, finer == 2.0, "period {period}: as 2");
            assert!(auto != least, "period {period}: not as 0 on all levels");
        }
    }

    #[test]
    fn coherence_is_auto_or_a_number_in_text() {
        assert_eq!("auto".parse(), Ok(Coherence::Auto), "auto");
        assert_eq!("0.5".parse(), Ok(Coherence::Factor(0.5)), "a number");
        assert!("Auto?".parse::<Coherence>().is_err(), "neither");
    }
}
