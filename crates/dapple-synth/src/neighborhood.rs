//! The shapes of neighborhoods: which pixels around a pixel are compared (figure 4).

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
    /// The factor of its squared differences; by default 1.
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

    /// The offsets of its pixels from the center, to the right and down, row by row from the top.
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
    /// What is compared: all parts together.
    pub parts: Vec<Part>,
}

/// The passes of a synthesis, in order.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Schedule {
    /// The passes. Before the first one, its level is filled with random pixels of the exemplar.
    pub passes: Vec<Pass>,
}

impl Schedule {
    /// The passes of section 5.2: H(7,0) on the coarsest level, and F(7,1), then F(7,0) + F(3,1) on each finer one.
    #[must_use]
    pub fn paper(n_levels: usize) -> Self {
        let part = |shape, side, reads| Part::new(shape, side, reads);
        let mut passes = vec![Pass {
            level: n_levels.saturating_sub(1),
            parts: vec![part(Shape::Half, 7, Reads::Same)],
        }];
        for level in (0..n_levels.saturating_sub(1)).rev() {
            passes.push(Pass {
                level,
                parts: vec![part(Shape::Full, 7, Reads::Coarser)],
            });
            passes.push(Pass {
                level,
                parts: vec![
                    part(Shape::Full, 7, Reads::Same),
                    part(Shape::Full, 3, Reads::Coarser),
                ],
            });
        }
        Self { passes }
    }
}
