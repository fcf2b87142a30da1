//! Synthesis options.

use crate::{CoarserCenter, Exemplar, Schedule, SynthError, SynthErrorKind};
use core::num::ParseFloatError;
use core::str::FromStr;
use dapple_hash::Seed;

/// Maximum of [`Options::evenness`]; no factor up to this value can make a distance infinite.
const MAX_EVENNESS: f32 = 1000.0;

/// Regularity of an exemplar above which [`Coherence::Auto`] always picks the smallest distance in passes that read a
/// coarser level. Exemplars with a regularity of 0.93 or more look better with the smallest distance, exemplars of 0.86
/// or less with a coherence of 2.
pub(crate) const REGULAR: f64 = 0.9;

/// Options for a synthesis from an exemplar.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Options {
    /// Seed for the initial random colors [default: `Seed(0)`].
    pub seed: Seed,
    /// Number of pyramid and site levels, from 1 to 16 [default: 3].
    pub n_levels: usize,
    /// The passes [default: the paper's passes for `n_levels` levels].
    pub schedule: Option<Schedule>,
    /// Placement of neighborhood centers on the coarser level [default: exact].
    pub center: CoarserCenter,
    /// Values that are compared on surfaces [default: appearance].
    pub matching: Matching,
    /// Axes of neighborhoods on surfaces, away from the central site [default: they follow the field].
    pub axes: Axes,
    /// Kind of sources of the finest sites on surfaces [default: positions between pixels].
    pub sources: Sources,
    /// Permitted excess distance of a match that continues the source of a neighboring site, relative to the best match
    /// [default: depends on the exemplar].
    pub coherence: Coherence,
    /// Preference for even use of the exemplar's pixels, from 0 to 1000 [default: 1].
    ///
    /// In passes that read no coarser level (the paper's schedule has one), the squared distance of a pixel is
    /// multiplied by `1 + evenness` if the pixel and its neighbors have already been used as often as the average pixel
    /// at the end of the pass. Such a pass runs on one thread. Pixels near an edge of the exemplar are candidates too,
    /// as if the exemplar were mirrored there. With [`Matching::Appearance`], parts of the exemplar that the texture
    /// uses too often cost more from one correction to the next. At 0, only the smallest distance counts, as in the
    /// paper; many pixels are then never used, and rare colors vanish.
    pub evenness: f32,
}

/// Permitted excess distance of a coherent match, that is, one that continues the source of a neighboring site.
///
/// Its text form is `auto` or a number.
///
#[cfg_attr(doc, doc = include_str!("../docs/coherence.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Coherence {
    /// A factor of 2. For a regular exemplar (one whose [`Exemplar::regularity`] is above 0.9), the smallest distance
    /// wins instead in passes that read a coarser level.
    ///
    /// Where the exemplar has pieces that fit together, such as interlocking hooks and courses of bricks, the smallest
    /// distance finds them, and a factor of 2 tears the texture. In photographs no detail occurs twice, and the
    /// smallest distance blurs it: leaves keep 0.65 of their standard deviation with 0, and 0.87 with 2.
    ///
    /// In passes that read no coarser level, the factor is 1 for any exemplar, as with `Factor(2.0)`. There the sweep
    /// begins among random colors, and their averages resemble only a few pixels of the exemplar. With 0, those pixels
    /// would be used again and again; for example, the squares of a checker merge where the sweep begins.
    ///
    /// Measuring the regularity takes a few milliseconds.
    #[default]
    Auto,
    /// The coherent match wins if its squared distance is at most 1 + this factor times the smallest. In passes that
    /// read no coarser level, where no later pass can repair mismatches, the limit is 1 + half of this factor. The
    /// factor must be finite and at least 0; at 0 the smallest distance always wins, as in the paper.
    Factor(f32),
}

/// Permitted excess squared distance of coherent matches, relative to the smallest; at least 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoherenceFactors {
    /// Permitted excess in passes that read no coarser level.
    pub(crate) initial: f32,
    /// Permitted excess in passes that read a coarser level.
    pub(crate) finer: f32,
}

impl Coherence {
    /// Returns the excess permitted for an exemplar, in passes without and with a coarser level.
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
    /// Values that are compared to find the pixels of the sites on a surface.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Matching {
        /// Colors of square neighborhoods, site after site in the order of the sweep, as in the paper.
        Colors = "colors",
        /// Appearance of windows around pixels, after Lefebvre and Hoppe (2006), except in the first pass. All sites of
        /// a level are corrected a few times by their surroundings. Compared with colors, this takes a quarter of the
        /// time, strands break off a quarter less often, and letters are more often whole. If [`Options::schedule`] is
        /// set, colors are compared regardless.
        ///
        /// Measured on flat textures of 65,536 sites: windows of 11 × 11 pixels are nearer to those of the exemplar by 25 %
        /// for hooks (4 levels), 15 % for text (4), 10 % for leaves, 9 % for grass and 8 % for puzzle pieces.
        #[default]
        Appearance = "appearance",
    }
}

dapple_raster::named! {
    /// Kind of exemplar positions that the finest sites on a surface have, which also decides what texture maps show
    /// between sites.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Sources {
        /// Positions between pixels, as predicted by neighbors that continue the same piece of the exemplar. Texture
        /// maps read the exemplar, or a larger version of it, at these positions, as sharp as it is.
        #[default]
        SubPixel = "sub-pixel",
        /// Pixels, whose values are interpolated between sites, as in the paper.
        Pixel = "pixel",
    }
}

dapple_raster::named! {
    /// Directions of the rows and columns of a neighborhood on a surface.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Axes {
        /// Directions that rotate with the field around the site, so that features along the field are straight in a
        /// neighborhood.
        #[default]
        Followed = "followed",
        /// Directions P and O of the site, transported straight across the neighborhood, as in the paper.
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
    /// Returns the options of the paper: neighborhoods on the coarser level are centered at rounded coordinates and
    /// follow straight axes, the smallest distance always wins, and texture maps interpolate the colors of sites.
    ///
    /// Some differences from the paper's text remain, on every surface and with any options:
    ///
    /// * On levels where fewer than 400 neighborhoods lie within an exemplar that does not wrap, neighborhoods that
    ///   reach past its edges are candidates as well, as if it were mirrored there. The paper compares none of them. A
    ///   64 × 64 exemplar has 8 × 8 pixels on the fourth level, and only ten neighborhoods would remain.
    /// * In the sweep distance, neighbors that disagree by about a spacing or more have lower weights (Cauchy's), so
    ///   that a distance that cannot grow everywhere jumps along few lines. In the paper all weights depend on edge
    ///   lengths alone.
    /// * Directions and the sweep distance are solved on the coarsest level by conjugate gradients. The paper
    ///   iterates equations 4 and 5. Both have the same solution, except for the weights.
    /// * A level of sites starts with the midpoints of the edges between the previous level's sites, where the paper
    ///   scatters random points. Sites repel each other with a different force than in Turk's paper of 1991 (see
    ///   [`nested_points`](crate::nested_points)).
    ///
    /// The documentation of [this crate](crate) lists its interpretations where the paper leaves details open.
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

    /// Returns the given passes, or else the paper's.
    ///
    /// # Errors
    ///
    /// If the number of levels is not from 1 to 16, if the coherence is negative or not finite, or if the evenness is
    /// not from 0 to 1000. Otherwise same as [`Schedule::check`].
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
