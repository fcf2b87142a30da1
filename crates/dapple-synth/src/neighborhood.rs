//! Neighborhood shapes, and schedules: the sequence of passes that use them.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, DOI 10.1145/383259.383297, figure 4 and
//! section 5; the causal shape is from Li-Yi Wei and Marc Levoy, "Fast Texture Synthesis using Tree-structured Vector
//! Quantization", SIGGRAPH 2000, DOI 10.1145/344779.345009.
//!
//! | paper | here | pixels for n = 7 |
//! |---|---|---|
//! | F(n, 0) | `Part::new(Shape::Full, n, Reads::Same)` | 48: all except the center, which is unknown |
//! | H(n, 0) | `Part::new(Shape::Half, n, Reads::Same)` | 21: the three rows above |
//! | F(n, 1) | `Part::new(Shape::Full, n, Reads::Coarser)` | 49: all, since the center is known on the coarser level |
//!
//! Two choices that the paper does not state: H has no pixel of the center's own row, because half of that row is not
//! colored yet ([`Shape::HalfWithRow`] is the other reading). Half of the side is rounded to an odd number; the paper
//! rounds half of 7 to 3.
//!
//! Offsets are in pixels of the level that is read; x points right and y down.

use crate::error::{SynthError, SynthErrorKind};

/// Maximum weight of a part. It ensures that sums of squares do not overflow.
const MAX_WEIGHT: f32 = 1e6;

/// Pixels of a square that belong to a neighborhood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Shape {
    /// All pixels of the square (F). The center is excluded on the same level, and included on the coarser one.
    Full,
    /// The rows above the center (H).
    Half,
    /// The rows above the center, and the row of the center except the center.
    HalfWithRow,
    /// The rows above the center, and the pixels to the left of it (Wei and Levoy).
    Causal,
}

/// Level that a part of a neighborhood reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Reads {
    /// The level of the pixel itself; 0 in the paper's notation.
    Same,
    /// The next coarser level; 1 in the paper's notation.
    Coarser,
}

/// A part of a neighborhood: `F(7, 1)` is `Part::new(Shape::Full, 7, Reads::Coarser)`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Part {
    /// Pixels of the square that are compared.
    pub shape: Shape,
    /// Side of the square in pixels: odd, from 3 to 15.
    pub side: u32,
    /// Level that is read.
    pub reads: Reads,
    /// Factor on the squared differences, above 0 and at most 10^6; by default 1.
    pub weight: f32,
}

impl Part {
    /// Creates a part with weight 1.
    #[must_use]
    pub const fn new(shape: Shape, side: u32, reads: Reads) -> Self {
        Self {
            shape,
            side,
            reads,
            weight: 1.0,
        }
    }

    /// Returns this part with the given weight.
    #[must_use]
    pub const fn with_weight(self, weight: f32) -> Self {
        Self { weight, ..self }
    }

    /// Returns the offsets of the pixels from the center, x to the right and y down, row by row from the top.
    ///
    /// Empty for a side of 0.
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
                // Figure 4 of the paper: (a) is `Full`, (b) is `Causal`, and (c) is `Half`. On the level itself the
                // center is left out, since its color is not known yet.
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

/// One pass over all sites of a level, in the order of the sweep.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pass {
    /// Level to visit; 0 is the finest.
    pub level: usize,
    /// Parts of the neighborhood, compared together.
    pub parts: Vec<Part>,
}

impl Pass {
    /// Returns the pass that initializes a level from the coarser one: F(7, 1).
    fn extrapolate(level: usize) -> Self {
        let parts = vec![Part::new(Shape::Full, 7, Reads::Coarser)];
        Self { level, parts }
    }

    /// Returns the pass that corrects a level: F(side, 0) + F(3, 1).
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
    /// Passes, in order. Before its first pass, a level is filled with random pixels of the exemplar. The last pass
    /// over level 0 yields the result.
    pub passes: Vec<Pass>,
}

impl Schedule {
    /// Returns the schedule of section 5.2: H(7, 0) on the coarsest level; F(7, 1), then F(7, 0) + F(3, 1), on each
    /// finer level.
    ///
    /// The paper uses three or four levels. With one level, only the first pass remains.
    #[must_use]
    pub fn paper(n_levels: usize) -> Self {
        let coarsest = n_levels.saturating_sub(1);
        // H(7, 0) is the only pass that reads no coarser level. It compares the rows that the sweep has filled before.
        let mut passes = vec![Pass {
            level: coarsest,
            parts: vec![Part::new(Shape::Half, 7, Reads::Same)],
        }];
        for level in (0..coarsest).rev() {
            passes.extend([Pass::extrapolate(level), Pass::correct(level, 7)]);
        }
        Self { passes }
    }

    /// Returns the schedule of a [repair](crate::PlaneTexture::repair): F(7, 0) eight times on the coarsest level,
    /// F(7, 0) + F(3, 1) four times on each finer level except the finest, and F(5, 0) + F(3, 1) twice on the finest.
    ///
    /// Measured on 33 photographs of 128 × 128 pixels with three holes of 39 × 39 each: windows of 7 × 7 pixels in and
    /// near a hole are 3 % nearer to windows of the photograph than with the schedule for a
    /// [mesh](Self::repair_on_mesh), in 40 % of the time.
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

    /// Returns the schedule of a [mesh repair](crate::MeshExemplar::repair): F(7, 0) eight times on the coarsest level;
    /// F(7, 1), then F(7, 0) + F(3, 1) twice, on each finer level.
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

    /// Returns the passes of a repair on the coarsest level.
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

    /// Returns a schedule without multiple levels, as in the pseudocode of section 5.1: one pass with one neighborhood.
    #[must_use]
    pub fn single_level(shape: Shape, side: u32) -> Self {
        let parts = vec![Part::new(shape, side, Reads::Same)];
        Self {
            passes: vec![Pass { level: 0, parts }],
        }
    }

    /// Checks that the passes can run with `n_levels` levels.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] if there is no pass, if a pass has no parts, or if no pass visits level 0;
    /// [`SynthErrorKind::Range`] if a level does not exist, if a side is even or not from 3 to 15, or if a weight is
    /// not above 0 and at most 10^6; [`SynthErrorKind::Unfilled`] if a pass reads a coarser level that no earlier pass
    /// visited.
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
    /// Checks that the parts and the levels are in range.
    pub(crate) fn check(&self, n_levels: usize) -> Result<(), SynthError> {
        check_any(self.parts.len(), "parts of a pass")?;
        for part in &self.parts {
            // Check the side, the weight and the level.
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
    /// Returns the number of levels from the pass's own level to the one that is read: 0 or 1.
    pub(crate) const fn step(self) -> usize {
        match self {
            Self::Same => 0,
            Self::Coarser => 1,
        }
    }
}

/// Fails if a count is 0.
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
