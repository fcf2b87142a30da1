//! Tables of stamps for shaders.

use super::{Stamp, StampValue, Stamps};
use crate::PatternError;
use crate::lattice::{period_words, shader_words, wrapped};

/// Number of words per stamp.
const STAMP: usize = 24;

/// Maximum number of words of a table. Every device supports a data texture of this size.
const MOST_WORDS: f64 = (1 << 25) as f64;

/// A table of the stamps of one period, for shaders.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct StampTable {
    /// First, for each cell, the index of the word of its first entry, followed by the index after the last entry of
    /// the last cell. Then the entries: one word per stamp that may cover a position in the cell. Then the stamps.
    pub words: Vec<u32>,
    /// Index of the first word of the stamps, a multiple of 4.
    pub first_stamp: usize,
    /// Period in cells.
    pub period: [u32; 2],
}

#[doc(hidden)]
impl Stamps {
    /// Returns the table of the stamps that may cover a position in each cell of the period, for the shaders of
    /// `dapple-wgsl`.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PatternErrorKind::Range) if the stamps do not repeat along both axes, or are too many for a
    /// texture.
    pub fn shader_table(&self) -> Result<StampTable, PatternError> {
        let [columns, rows] = period_words(self.options.period);
        let cells = f64::from(columns) * f64::from(rows);
        let (what, range) = ("period of stamps", "above 0 along both axes for a shader");
        PatternError::check(cells > 0.0, what, 0.0, range)?;
        let field = self.field(StampValue::Height);
        let [x, y] = field.reach;
        let near = self.options.density * (2.0 * x + 1.0) * (2.0 * y + 1.0);
        check_words(cells * (1.0 + near + STAMP as f64 * self.options.density))?;
        // Draw the stamps of all cells.
        let cells = (0..i64::from(rows)).flat_map(|y| (0..i64::from(columns)).map(move |x| [x, y]));
        let (mut stamps, mut firsts) = (Vec::new(), Vec::new());
        for cell in cells.clone() {
            firsts.push(stamps.len() / STAMP);
            for point in self.points(cell) {
                stamps.extend(self.stamp(&point).words());
            }
        }
        let mut words = vec![0; firsts.len() + 1];
        // List the stamps near each cell.
        for (number, cell) in cells.enumerate() {
            let mut near = Vec::new();
            field.visit(cell, [0.5; 2], [0.5; 2], |stamp, offset, index| {
                near.push((stamp, offset, index));
            });
            self.arrange(&mut near, |(stamp, _, _)| stamp);
            words[number] = words.len() as u32;
            for (_, offset, index) in near {
                let [x, y] = [0, 1].map(|axis| {
                    wrapped(cell[axis] + offset[axis], self.options.period[axis]) as usize
                });
                let stamp = firsts[y * columns as usize + x] + index;
                // Offsets are from -10 to 10.
                let [x, y] = offset.map(|cells| (cells + 16) as u32);
                words.push((stamp as u32) << 10 | x << 5 | y);
            }
        }
        words[firsts.len()] = words.len() as u32;
        words.resize(words.len().next_multiple_of(4), 0);
        let first_stamp = words.len();
        words.extend(stamps);
        check_words(words.len() as f64)?;
        Ok(StampTable {
            words,
            first_stamp,
            period: [columns, rows],
        })
    }
}

/// Checks that a table of `count` words fits into a texture.
fn check_words(count: f64) -> Result<(), PatternError> {
    let (what, range) = ("number of words of the stamps in a shader", "at most 2^25");
    PatternError::check(count <= MOST_WORDS, what, count, range)
}

impl Stamp {
    /// Returns a stamp as words for a shader: 64-bit numbers as high and low words, then 32-bit numbers.
    fn words(&self) -> [u32; STAMP] {
        let [a, b, c, d] = self.outline.random.map(f32::to_bits);
        let [random, random2, random3] = self.randoms.map(f32::to_bits);
        let doubles = [self.center, self.u_axis, self.v_axis];
        let mut words = [0; STAMP];
        for (word, number) in words.chunks_exact_mut(2).zip(doubles.as_flattened()) {
            word.copy_from_slice(&shader_words(*number));
        }
        let singles = [self.height, self.highest, self.order, self.angle];
        words[12..16].copy_from_slice(&singles.map(f32::to_bits));
        words[16..20].copy_from_slice(&[a, b, c, d]);
        let aspect = self.outline.aspect.to_bits();
        words[20..24].copy_from_slice(&[random, random2, random3, aspect]);
        words
    }
}
