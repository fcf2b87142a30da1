//! Values of nodes at many positions.

use crate::{RecipeError, RecipeErrorKind};
use dapple_color::LinearRgb;
use dapple_raster::{Raster, RasterError};
use dapple_tile::Map;
use std::borrow::Cow;
use std::ops::Range;

/// The values of a node: one number or one color for each position.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers, one per position.
    Numbers(Vec<f32>),
    /// Linear colors.
    Colors(Vec<LinearRgb>),
}

impl Values {
    /// Returns the number of positions.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Colors(colors) => colors.len(),
        }
    }

    /// Returns whether there are no positions.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the numbers, or an empty slice for colors. Plans check beforehand that inputs which must be numbers are
    /// not colors.
    pub(crate) fn numbers(&self) -> &[f32] {
        match self {
            Self::Numbers(numbers) => numbers,
            Self::Colors(_) => &[],
        }
    }

    /// Converts the values to numbers. Colors are converted to their luminance.
    pub(crate) fn into_grays(self) -> Vec<f32> {
        match self {
            Self::Numbers(numbers) => numbers,
            Self::Colors(colors) => colors.into_iter().map(LinearRgb::luminance).collect(),
        }
    }

    /// Converts the values to colors. Numbers are converted to grays.
    pub(crate) fn into_colors(self) -> Vec<LinearRgb> {
        match self {
            Self::Numbers(numbers) => numbers.into_iter().map(LinearRgb::gray).collect(),
            Self::Colors(colors) => colors,
        }
    }

    /// Returns the values as colors, borrowed if possible. Numbers are converted to grays.
    pub(crate) fn colors(&self) -> Cow<'_, [LinearRgb]> {
        match self {
            Self::Numbers(_) => Cow::Owned(self.clone().into_colors()),
            Self::Colors(colors) => Cow::Borrowed(colors),
        }
    }

    /// Returns the values at a range of positions, given as indices.
    pub(crate) fn part(&self, range: Range<usize>) -> Self {
        match self {
            Self::Numbers(numbers) => Self::Numbers(numbers[range].to_vec()),
            Self::Colors(colors) => Self::Colors(colors[range].to_vec()),
        }
    }

    /// Returns the values at several ranges of positions, concatenated.
    pub(crate) fn parts(&self, ranges: impl Iterator<Item = Range<usize>>) -> Self {
        fn join<T: Copy>(values: &[T], ranges: impl Iterator<Item = Range<usize>>) -> Vec<T> {
            let mut joined = Vec::new();
            for range in ranges {
                joined.extend_from_slice(&values[range]);
            }
            joined
        }
        match self {
            Self::Numbers(numbers) => Self::Numbers(join(numbers, ranges)),
            Self::Colors(colors) => Self::Colors(join(colors, ranges)),
        }
    }

    /// Applies a filter to the numbers, or to the colors as arrays of red, green and blue.
    pub(crate) fn filtered(
        &self,
        numbers: impl FnOnce(&[f32]) -> Vec<f32>,
        colors: impl FnOnce(&[[f32; 3]]) -> Vec<[f32; 3]>,
    ) -> Self {
        match self {
            Self::Numbers(values) => Self::Numbers(numbers(values)),
            Self::Colors(values) => {
                let arrays: Vec<_> = values.iter().map(|color| color.to_array()).collect();
                Self::Colors(colors(&arrays).into_iter().map(LinearRgb::from).collect())
            }
        }
    }

    /// Applies a function to the numbers, or separately to each of the three color channels.
    pub(crate) fn each_channel(&self, change: impl Fn(&[f32]) -> Vec<f32>) -> Self {
        let colors = match self {
            Self::Numbers(numbers) => return Self::Numbers(change(numbers)),
            Self::Colors(colors) => colors,
        };
        let channel = |channel: usize| -> Vec<f32> {
            colors
                .iter()
                .map(|color| color.to_array()[channel])
                .collect()
        };
        let [red, green, blue] = [0, 1, 2].map(|index| change(&channel(index)));
        let rest = green.into_iter().zip(blue);
        let colors = red.into_iter().zip(rest);
        Self::Colors(colors.map(|(r, (g, b))| LinearRgb::new(r, g, b)).collect())
    }

    /// Concatenates `parts`, which must be all numbers or all colors.
    pub(crate) fn joined(parts: &[&Self]) -> Self {
        let n_values = parts.iter().map(|part| part.len()).sum();
        let mut all = match parts.first() {
            Some(Self::Colors(_)) => Self::Colors(Vec::with_capacity(n_values)),
            _ => Self::Numbers(Vec::with_capacity(n_values)),
        };
        for part in parts {
            all.append(part);
        }
        all
    }

    /// Appends the values at more positions. Both lists must be numbers, or both colors.
    pub(crate) fn append(&mut self, more: &Self) {
        match self {
            Self::Numbers(numbers) => numbers.extend_from_slice(more.numbers()),
            Self::Colors(colors) => match more {
                Self::Colors(more) => colors.extend_from_slice(more),
                Self::Numbers(more) => colors.extend(more.iter().copied().map(LinearRgb::gray)),
            },
        }
    }

    /// Combines inputs pairwise, from the first to the last. The result is in color if any input is.
    pub(crate) fn fold(
        inputs: &[&Self],
        combine: impl Fn(f32, f32) -> f32,
        combine_colors: impl Fn(LinearRgb, LinearRgb) -> LinearRgb,
    ) -> Self {
        if Self::has_colors(inputs) {
            let mut result = inputs[0].colors().into_owned();
            for input in &inputs[1..] {
                let others = input.colors();
                let pairs = result.iter_mut().zip(&*others);
                pairs.for_each(|(a, &b)| *a = combine_colors(*a, b));
            }
            return Self::Colors(result);
        }
        let mut result = inputs[0].numbers().to_vec();
        for &input in &inputs[1..] {
            let pairs = result.iter_mut().zip(input.numbers());
            pairs.for_each(|(a, &b)| *a = combine(*a, b));
        }
        Self::Numbers(result)
    }

    fn has_colors(inputs: &[&Self]) -> bool {
        inputs.iter().any(|input| matches!(input, Self::Colors(_)))
    }

    /// Converts the values to a raster of `size` columns and rows. Colors are converted to their luminance.
    pub(crate) fn raster(&self, size: [u32; 2]) -> Result<Raster<f32>, RasterError> {
        Raster::from_vec(size, self.clone().into_grays())
    }

    /// Converts the inputs to images of `size` columns and rows. All images are in color if any input is.
    pub(crate) fn maps(inputs: &[&Self], size: [u32; 2]) -> Result<Vec<Map>, RasterError> {
        let as_colors = Self::has_colors(inputs);
        let map = |values: &&Self| {
            Ok(match values {
                Self::Numbers(numbers) if !as_colors => {
                    Map::Value(Raster::from_vec(size, numbers.clone())?)
                }
                values => Map::Color(Raster::from_vec(size, Self::clone(values).into_colors())?),
            })
        };
        inputs.iter().map(map).collect()
    }

    /// Returns the first image of a result as values. Fails if the list is empty or the image has normals.
    pub(crate) fn of_map(maps: Vec<Map>) -> Result<Self, RecipeError> {
        match maps.into_iter().next() {
            Some(Map::Value(raster)) => Ok(Self::Numbers(raster.into_pixels())),
            Some(Map::Color(raster)) => Ok(Self::Colors(raster.into_pixels())),
            Some(Map::Normal(_)) | None => {
                let rule = "a blend gives back the kind of map that it was given";
                Err(RecipeError::new(RecipeErrorKind::Conflict { rule }))
            }
        }
    }
}
