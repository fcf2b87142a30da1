//! The shapes of neighborhoods, and in which order they are used.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, DOI 10.1145/383259.383297, figure 4 and section
//! 5; the causal shape is from Li-Yi Wei and Marc Levoy, "Fast Texture Synthesis using Tree-structured Vector
//! Quantization", SIGGRAPH 2000, DOI 10.1145/344779.345009.
//!
//! | the paper's | is | with side 7 |
//! |---|---|---|
//! | F(n, 0) | `Part::new(Shape::Full, n, Reads::Same)` | 48 pixels: all but the center, which is what is looked for |
//! | H(n, 0) | `Part::new(Shape::Half, n, Reads::Same)` | 21 pixels: the three rows above |
//! | F(n, 1) | `Part::new(Shape::Full, n, Reads::Coarser)` | 49 pixels: on the coarser level the center is known, too |
//!
//! Where the text is silent: H has no pixel of the center's own row, because half of that row is not colored yet
//! ([`Shape::HalfWithRow`] is the other reading); half of 7, which the paper rounds to 3, is rounded to an odd number.
//!
//! Offsets are in pixels of the level that is read, to the right and down.

use crate::error::{SynthError, SynthErrorKind};

/// The largest weight of a part: no sum of squares can overflow.
const MAX_WEIGHT: f32 = 1e6;

/// Which part of a square of pixels belongs to a neighborhood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Shape {
    /// All of the square; without its center on the same level, with it on the coarser one (F).
    Full,
    /// The rows above the center (H).
    Half,
    /// The rows above the center, and the row of the center without it.
    HalfWithRow,
    /// The rows above the center and what is left of it, after Wei and Levoy.
    Causal,
}

/// Which level a part of a neighborhood reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Reads {
    /// The level of the pixel itself: the paper's 0.
    Same,
    /// The next coarser level: the paper's 1.
    Coarser,
}

/// A part of a neighborhood: `F(7, 1)` is `Part::new(Shape::Full, 7, Reads::Coarser)`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Part {
    /// Which pixels of the square.
    pub shape: Shape,
    /// The side of the square in pixels: odd, from 3 to 15.
    pub side: u32,
    /// Which level is read.
    pub reads: Reads,
    /// The factor of its squared differences, above 0 and at most 10^6; by default 1.
    pub weight: f32,
}

impl Part {
    /// A part with the weight 1.
    #[must_use]
    pub const fn new(shape: Shape, side: u32, reads: Reads) -> Self {
        Self {
            shape,
            side,
            reads,
            weight: 1.0,
        }
    }

    /// This part with another weight.
    #[must_use]
    pub const fn with_weight(self, weight: f32) -> Self {
        Self { weight, ..self }
    }

    /// The offsets of its pixels from the center, to the right and down, row by row from the top.
    ///
    /// There are none for a side of 0.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_synth::{Part, Reads, Shape};
    ///
    /// let offsets = Part::new(Shape::Half, 3, Reads::Same).offsets();
    /// assert_eq!(offsets, [[-1, -1], [0, -1], [1, -1]]);
    /// ```
    #[must_use]
    pub fn offsets(&self) -> Vec<[i32; 2]> {
        let half = self.side as i32 / 2;
        let mut offsets = Vec::new();
        for j in -half..=half {
            for i in -half..=half {
                let center = [i, j] == [0, 0];
                let within = match self.shape {
                    Shape::Full => !center || self.reads == Reads::Coarser,
                    Shape::Half => j < 0,
                    Shape::HalfWithRow => j < 0 || (j == 0 && !center),
                    Shape::Causal => j < 0 || (j == 0 && i < 0),
                };
                if within {
                    offsets.push([i, j]);
                }
            }
        }
        offsets
    }
}

/// One visit of all sites of a level, in the order of the sweep.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pass {
    /// The level, 0 the finest.
    pub level: usize,
    /// The parts that are compared, all together.
    pub parts: Vec<Part>,
}

impl Pass {
    /// F(7, 1).
    fn extrapolate(level: usize) -> Self {
        let parts = vec![Part::new(Shape::Full, 7, Reads::Coarser)];
        Self { level, parts }
    }

    /// F(side, 0) + F(3, 1).
    fn correct(level: usize, side: u32) -> Self {
        let parts = vec![
            Part::new(Shape::Full, side, Reads::Same),
            Part::new(Shape::Full, 3, Reads::Coarser),
        ];
        Self { level, parts }
    }
}

/// The passes of a synthesis, in order.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Schedule {
    /// The passes. Before the first visit of a level it is filled with random pixels of the exemplar. The last visit of
    /// level 0 gives the result.
    pub passes: Vec<Pass>,
}

impl Schedule {
    /// The passes of section 5.2: H(7, 0) on the coarsest level, and F(7, 1), then F(7, 0) + F(3, 1) on each finer one.
    ///
    /// The paper has three or four levels; with one there is only the first pass.
    #[must_use]
    pub fn paper(n_levels: usize) -> Self {
        let coarsest = n_levels.saturating_sub(1);
        let mut passes = vec![Pass {
            level: coarsest,
            parts: vec![Part::new(Shape::Half, 7, Reads::Same)],
        }];
        for level in (0..coarsest).rev() {
            passes.extend([Pass::extrapolate(level), Pass::correct(level, 7)]);
        }
        Self { passes }
    }

    /// The passes of a [repair](crate::PlaneTexture::repair): F(7, 0), eight times on the coarsest level, then
    /// F(7, 0) + F(3, 1) four times on each finer one, but on the finest F(5, 0) + F(3, 1) twice.
    ///
    /// Measured on 33 photographs of 128 × 128 pixels with three holes of 39 × 39 each: windows of 7 × 7 pixels in and beside a
    /// hole are nearer to those of the photograph by 3 % than with the passes of a [mesh](Self::repair_on_mesh), in 40 % of
    /// the time.
    #[must_use]
    pub fn repair(n_levels: usize) -> Self {
        let coarsest = n_levels.saturating_sub(1);
        let mut passes = Self::of_a_hole(coarsest);
        for level in (0..coarsest).rev() {
            let (side, n_passes) = if level > 0 { (7, 4) } else { (5, 2) };
            passes.extend(vec![Pass::correct(level, side); n_passes]);
        }
        Self { passes }
    }

    /// The passes of a [repair of a mesh](crate::MeshExemplar::repair): F(7, 0), eight times on the coarsest level, and
    /// F(7, 1), then F(7, 0) + F(3, 1) twice on each finer one.
    #[must_use]
    pub fn repair_on_mesh(n_levels: usize) -> Self {
        let coarsest = n_levels.saturating_sub(1);
        let mut passes = Self::of_a_hole(coarsest);
        for level in (0..coarsest).rev() {
            passes.push(Pass::extrapolate(level));
            passes.extend(vec![Pass::correct(level, 7); 2]);
        }
        Self { passes }
    }

    /// The passes of a repair on the coarsest level.
    fn of_a_hole(coarsest: usize) -> Vec<Pass> {
        let parts = vec![Part::new(Shape::Full, 7, Reads::Same)];
        vec![
            Pass {
                level: coarsest,
                parts
            };
            8
        ]
    }

    /// The method without levels, whose pseudo-code is in section 5.1: one pass with one neighborhood.
    #[must_use]
    pub fn single_level(shape: Shape, side: u32) -> Self {
        let parts = vec![Part::new(shape, side, Reads::Same)];
        Self {
            passes: vec![Pass { level: 0, parts }],
        }
    }

    /// Refuses passes that cannot be run with `n_levels` levels.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] for no pass, a pass without parts and no visit of level 0; [`SynthErrorKind::Range`] for
    /// a level that is not there, a side that is not odd and from 3 to 15, and a weight that is not above 0 and at most
    /// 10^6; [`SynthErrorKind::Unfilled`] for a pass that reads a coarser level that no pass before it visited.
    pub fn check(&self, n_levels: usize) -> Result<(), SynthError> {
        check_any(self.passes.len(), "passes")?;
        let mut filled = vec![false; n_levels];
        for (index, pass) in self.passes.iter().enumerate() {
            pass.check(n_levels)?;
            let reads_coarser = pass.parts.iter().any(|part| part.reads == Reads::Coarser);
            let level = pass.level + 1;
            if reads_coarser && !filled[level] {
                return Err(SynthError::new(SynthErrorKind::Unfilled {
                    pass: index,
                    level,
                }));
            }
            filled[pass.level] = true;
        }
        check_any(usize::from(filled[0]), "visits of level 0")
    }
}

impl Pass {
    /// Refuses parts and levels out of their ranges.
    pub(crate) fn check(&self, n_levels: usize) -> Result<(), SynthError> {
        check_any(self.parts.len(), "parts of a pass")?;
        for part in &self.parts {
            let side = part.side;
            let holds = side % 2 == 1 && (3..=15).contains(&side);
            SynthError::check(
                holds,
                "side of a neighborhood",
                side.into(),
                "odd and from 3 to 15",
            )?;
            let weight = part.weight;
            let holds = weight > 0.0 && weight <= MAX_WEIGHT;
            SynthError::check(
                holds,
                "weight of a part",
                weight.into(),
                "above 0 and at most 1e6",
            )?;
            let level = self.level.saturating_add(part.reads.step());
            let what = "level that a pass reads";
            SynthError::check(
                level < n_levels,
                what,
                level as f64,
                "below the number of levels",
            )?;
        }
        Ok(())
    }
}

impl Reads {
    /// How much coarser the level is that is read.
    pub(crate) const fn step(self) -> usize {
        match self {
            Self::Same => 0,
            Self::Coarser => 1,
        }
    }
}

/// Refuses none of something.
fn check_any(count: usize, what: &'static str) -> Result<(), SynthError> {
    if count > 0 {
        return Ok(());
    }
    let needed = "at least 1";
    Err(SynthError::new(SynthErrorKind::Count {
        what,
        count,
        needed,
    }))
}

#[cfg(test)]
mod tests;
