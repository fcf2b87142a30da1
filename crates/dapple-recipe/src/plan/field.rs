//! Exposes nodes as fields, for previews, seam tests and other programs.

use super::evaluate::{Grid, Places, evaluate};
use super::neighborhood;
use super::step::Step;
use crate::{RecipeError, RecipeErrorKind, Values};
use dapple_color::LinearRgb;
use dapple_raster::{Field, Raster, RasterError, RasterViewMut, Window};
use dapple_tile::TileErrorKind;
use glam::DVec2;
use std::sync::Arc;

/// A node's numbers as a field: one number for every position of the plane.
///
/// Samples are taken at points. Unlike in a [`Bake`](crate::Bake), images are not averaged over the pixels of a window.
///
/// A node that depends on the neighborhood of a pixel, such as a blur, has values in windows, whose pixels are its
/// neighbors, and none at single positions.
///
/// A node may fail for some inputs, such as a blend with weights below 0. Sampling many positions or a window then
/// returns an error, and [`value`](Field::value), which cannot fail, returns NaN.
#[derive(Clone, Debug)]
pub struct NodeField {
    steps: Arc<[Step]>,
    step: usize,
}

/// The colors of a node, as a function of the position in the plane.
///
/// Samples are taken at points. Unlike in a [`Bake`](crate::Bake), images are not averaged over the pixels of a window.
///
/// A node that depends on the neighborhood of a pixel, such as a blur, has values in windows, whose pixels are its
/// neighbors, and none at single positions.
#[derive(Clone, Debug)]
pub struct NodeColors {
    steps: Arc<[Step]>,
    step: usize,
}

impl NodeField {
    pub(super) fn new(steps: Arc<[Step]>, step: usize) -> Self {
        Self { steps, step }
    }

    fn at(&self, positions: &[DVec2]) -> Result<Arc<Values>, RasterError> {
        at_positions(&self.steps, positions, self.step).map_err(|error| refused(&error))
    }
}

impl Field for NodeField {
    fn value(&self, position: [f64; 2]) -> f32 {
        match self.at(&[position.into()]) {
            Ok(values) => values.numbers().first().copied().unwrap_or(f32::NAN),
            Err(_) => f32::NAN,
        }
    }

    fn values(&self, positions: &[[f64; 2]], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        let positions: Vec<_> = positions.iter().map(|&at| at.into()).collect();
        let made = self.at(&positions)?;
        RasterError::check_length(made.numbers().len(), values.len())?;
        values.copy_from_slice(made.numbers());
        Ok(())
    }

    fn render(&self, window: &Window, mut out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let made = in_window(&self.steps, window, self.step).map_err(|error| refused(&error))?;
        RasterError::check_length(made.numbers().len(), window.n_pixels())?;
        let rows = made.numbers().chunks(window.size[0] as usize);
        for (line, row) in out.rows_mut().zip(rows) {
            line.copy_from_slice(row);
        }
        Ok(())
    }
}

impl NodeColors {
    pub(super) fn new(steps: Arc<[Step]>, step: usize) -> Self {
        Self { steps, step }
    }

    /// Returns the color at a position.
    ///
    /// # Errors
    ///
    /// If the node or one of its inputs fails, such as a blend with weights below 0.
    pub fn sample(&self, position: impl Into<[f64; 2]>) -> Result<LinearRgb, RecipeError> {
        let position = position.into().into();
        let values = at_positions(&self.steps, &[position], self.step)?;
        // One position has exactly one value.
        Ok(Arc::unwrap_or_clone(values).into_colors()[0])
    }

    /// Returns the colors at the pixel centers of a window.
    ///
    /// # Errors
    ///
    /// [`Raster`](RecipeErrorKind::Raster) if the window has no pixels or too many, or the same errors as
    /// [`sample`](Self::sample).
    pub fn to_raster(&self, window: &Window) -> Result<Raster<LinearRgb>, RecipeError> {
        // Check the size before any values are computed.
        let mut raster = Raster::filled(window.size, LinearRgb::BLACK)?;
        let colors = in_window(&self.steps, window, self.step)?.into_colors();
        raster.pixels_mut().copy_from_slice(&colors);
        Ok(raster)
    }
}

/// Computes the values of one step at positions.
fn at_positions(
    steps: &[Step],
    positions: &[DVec2],
    step: usize,
) -> Result<Arc<Values>, RecipeError> {
    let mut values = evaluate(steps, None, Places::points(positions), &[step], &[])?;
    Ok(values.swap_remove(0))
}

/// Computes the values of one step at the pixel centers of a window.
fn in_window(steps: &[Step], window: &Window, step: usize) -> Result<Values, RecipeError> {
    let grid = Grid {
        window,
        averages: false,
    };
    let values = neighborhood::window(steps, None, grid, &[step], &[])?;
    Ok(values
        .into_iter()
        .next()
        .unwrap_or(Values::Numbers(Vec::new())))
}

/// Converts the error of a node to a [`RasterError`], the error type of fields.
fn refused(error: &RecipeError) -> RasterError {
    let (what, value, range) = match error.kind() {
        RecipeErrorKind::Raster(error) => return error.clone(),
        RecipeErrorKind::Range { what, value, range } => (*what, *value, *range),
        RecipeErrorKind::Tile(error) => match error.kind() {
            TileErrorKind::Range { what, value, range } => (*what, *value, *range),
            _ => ("value of a node", f64::NAN, "one that its inputs allow"),
        },
        RecipeErrorKind::Global { .. } => (
            "value of a node that depends on its neighborhood or the whole tile",
            f64::NAN,
            "read in a window or a bake, since it has none at a single position",
        ),
        _ => ("value of a node", f64::NAN, "one that its inputs allow"),
    };
    let refused = RasterError::check_range(false, what, value, range);
    refused.expect_err("it does not hold")
}
