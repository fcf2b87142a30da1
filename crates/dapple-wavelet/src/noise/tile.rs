//! A periodic tile of B-spline coefficients and its values.

use super::place::Place;
use crate::doubling::BLOCK;
use crate::error::check;
use crate::{IsCancelled, WaveletError};

/// Periodic coefficients with a margin of one cell on each side along each axis. Evaluating a position reads three
/// cells per axis, so with the margin no index needs wrapping.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tile<const N: usize> {
    /// Number of cells along each axis, including the margins.
    sides: [usize; N],
    coefficients: Vec<f32>,
}

/// Total number of margin cells along each axis.
const MORE: usize = 2;

impl<const N: usize> Tile<N> {
    /// Creates a tile of `size` cells from its coefficients, in which the first axis varies fastest.
    pub(super) fn new(
        size: [usize; N],
        coefficients: &[f32],
        is_cancelled: &IsCancelled,
    ) -> Result<Self, WaveletError> {
        let sides = size.map(|cells| cells + MORE);
        let n_rows: usize = sides[1..].iter().product();
        let mut padded = Vec::with_capacity(n_rows * sides[0]);
        for row in 0..n_rows {
            if row % (BLOCK / sides[0]).max(1) == 0 {
                check(is_cancelled)?;
            }
            let source = (1..N).rev().fold(0, |source, axis| {
                let below: usize = sides[1..axis].iter().product();
                let at = row / below % sides[axis];
                source * size[axis] + (at + size[axis] - 1) % size[axis]
            });
            let cells = &coefficients[source * size[0]..][..size[0]];
            padded.push(cells[size[0] - 1]);
            padded.extend_from_slice(cells);
            padded.push(cells[0]);
        }
        Ok(Self {
            sides,
            coefficients: padded,
        })
    }

    /// Returns all coefficients, with the margins.
    pub(super) fn coefficients(&self) -> &[f32] {
        &self.coefficients
    }

    /// Returns the maximum absolute coefficient.
    pub(super) fn largest(&self) -> f32 {
        let magnitudes = self.coefficients.iter().map(|value| value.abs());
        magnitudes.fold(0.0, f32::max)
    }

    /// Returns the coefficient of `cell`.
    #[cfg(test)]
    pub(super) fn coefficient(&self, cell: [usize; N]) -> f32 {
        let axes = cell.iter().zip(&self.sides).rev();
        self.coefficients[axes.fold(0, |at, (cell, side)| at * side + cell + 1)]
    }

    /// Returns three consecutive coefficients of a row, starting at index `at`.
    #[inline(always)]
    fn three(&self, at: usize) -> [f32; 3] {
        let row = &self.coefficients[at..at + 3];
        [row[0], row[1], row[2]]
    }
}

impl Tile<2> {
    /// Returns the value at a position.
    #[inline(always)]
    pub(super) fn value(&self, [x, y]: [Place; 2]) -> f32 {
        across(x.weights(), down(y.weights(), self.rows([x, y])))
    }

    /// Returns the value at a position, and its gradient in value per cell.
    #[inline(always)]
    pub(super) fn value_with_gradient(&self, [x, y]: [Place; 2]) -> (f32, [f32; 2]) {
        let rows = self.rows([x, y]);
        let row = down(y.weights(), rows);
        let slopes = down(y.slopes(), rows);
        let gradient = [across(x.slopes(), row), across(x.weights(), slopes)];
        (across(x.weights(), row), gradient)
    }

    /// Computes the weighted sum of the three rows of coefficients around `y` into `row`, which has the length of a
    /// stored row.
    pub(super) fn blend_row(&self, y: Place, row: &mut [f32]) {
        let rows = &self.coefficients[y.index() * self.sides[0]..][..3 * self.sides[0]];
        blend(y.weights(), rows, row);
    }

    /// Returns the length of a row in memory, in cells, including the margins.
    pub(super) fn row_len(&self) -> usize {
        self.sides[0]
    }

    #[inline(always)]
    fn rows(&self, [x, y]: [Place; 2]) -> [[f32; 3]; 3] {
        let at = y.index() * self.sides[0] + x.index();
        [
            self.three(at),
            self.three(at + self.sides[0]),
            self.three(at + 2 * self.sides[0]),
        ]
    }
}

impl Tile<3> {
    /// Returns the value at a position.
    #[inline(always)]
    pub(super) fn value(&self, [x, y, z]: [Place; 3]) -> f32 {
        let rows = self.rows(z.weights(), [x, y, z]);
        across(x.weights(), down(y.weights(), rows))
    }

    /// Returns the value at a position, and its gradient in value per cell.
    #[inline(always)]
    pub(super) fn value_with_gradient(&self, [x, y, z]: [Place; 3]) -> (f32, [f32; 3]) {
        let rows = self.rows(z.weights(), [x, y, z]);
        let row = down(y.weights(), rows);
        let slopes = [
            row,
            down(y.slopes(), rows),
            down(y.weights(), self.rows(z.slopes(), [x, y, z])),
        ];
        let gradient = [
            across(x.slopes(), slopes[0]),
            across(x.weights(), slopes[1]),
            across(x.weights(), slopes[2]),
        ];
        (across(x.weights(), row), gradient)
    }

    /// Returns the two-dimensional tile at depth `z`. Its values equal those of this tile, bit for bit.
    pub(super) fn slice(&self, z: Place) -> Tile<2> {
        let [width, height, _] = self.sides;
        let area = width * height;
        let slices = &self.coefficients[z.index() * area..][..3 * area];
        let mut coefficients = vec![0.0; area];
        blend(z.weights(), slices, &mut coefficients);
        Tile {
            sides: [width, height],
            coefficients,
        }
    }

    /// Returns three rows of three coefficients around a position, each the weighted sum of three slices.
    #[inline(always)]
    fn rows(&self, weights: [f32; 3], [x, y, z]: [Place; 3]) -> [[f32; 3]; 3] {
        let [width, height, _] = self.sides;
        let at = (z.index() * height + y.index()) * width + x.index();
        [
            self.pillar(weights, at),
            self.pillar(weights, at + width),
            self.pillar(weights, at + 2 * width),
        ]
    }

    /// Returns three coefficients of a row, starting at index `at`, as the weighted sum of three slices.
    #[inline(always)]
    fn pillar(&self, weights: [f32; 3], at: usize) -> [f32; 3] {
        let area = self.sides[0] * self.sides[1];
        let slices = [
            self.three(at),
            self.three(at + area),
            self.three(at + 2 * area),
        ];
        down(weights, slices)
    }
}

/// Computes the weighted sum of three consecutive rows or slices.
fn blend(weights: [f32; 3], three: &[f32], sum: &mut [f32]) {
    let (first, others) = three.split_at(sum.len());
    let (second, third) = others.split_at(sum.len());
    let third = &third[..sum.len()];
    for (i, sum) in sum.iter_mut().enumerate() {
        *sum = (weights[0] * first[i] + weights[1] * second[i]) + weights[2] * third[i];
    }
}

/// Returns the weighted sum of three rows of three coefficients.
#[inline(always)]
fn down(weights: [f32; 3], [first, second, third]: [[f32; 3]; 3]) -> [f32; 3] {
    [
        across(weights, [first[0], second[0], third[0]]),
        across(weights, [first[1], second[1], third[1]]),
        across(weights, [first[2], second[2], third[2]]),
    ]
}

/// Returns the weighted sum of a row of three coefficients.
#[inline(always)]
pub(super) fn across(weights: [f32; 3], row: [f32; 3]) -> f32 {
    (weights[0] * row[0] + weights[1] * row[1]) + weights[2] * row[2]
}
