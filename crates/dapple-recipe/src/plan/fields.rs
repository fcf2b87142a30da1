//! Nodes as fields: what previews, seam tests and warps of one's own can ask.

use super::Values;
use super::evaluate::{Places, evaluate};
use super::step::Step;
use dapple_color::LinearRgb;
use dapple_raster::{Field, Raster, RasterError, RasterViewMut, Window};
use glam::DVec2;
use std::sync::Arc;

/// The number that a node makes at every position of the plane.
///
/// Where the node, or what it is made of, sees the whole tile, there is no value at a single position, and it is NaN; a
/// bake knows such nodes.
#[derive(Clone, Debug)]
pub struct NodeField {
    steps: Arc<[Step]>,
    step: usize,
}

/// The color that a node makes at every position of the plane; without one, as for [`NodeField`], it is black.
#[derive(Clone, Debug)]
pub struct NodeColors {
    steps: Arc<[Step]>,
    step: usize,
}

impl NodeField {
    pub(super) fn new(steps: Arc<[Step]>, step: usize) -> Self {
        Self { steps, step }
    }

    fn values(&self, places: Places<'_>) -> Option<Arc<Values>> {
        evaluate(&self.steps, None, places, &[self.step], &[])
            .ok()?
            .pop()
    }

    fn fill(&self, places: Places<'_>, out: &mut [f32]) {
        match self.values(places).as_deref() {
            Some(Values::Numbers(numbers)) if numbers.len() == out.len() => {
                out.copy_from_slice(numbers);
            }
            _ => out.fill(f32::NAN),
        }
    }
}

impl Field for NodeField {
    fn sample(&self, position: DVec2) -> f32 {
        let mut value = [0.0];
        self.fill(Places::Positions(&[position]), &mut value);
        value[0]
    }

    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        RasterError::check_length(values.len(), positions.len())?;
        self.fill(Places::Positions(positions), values);
        Ok(())
    }

    fn render(&self, window: &Window, mut out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let mut values = Raster::filled(window.size, 0.0)?;
        self.fill(Places::Window(window), values.pixels_mut());
        for (row, line) in (0..).zip(out.rows_mut()) {
            line.copy_from_slice(values.row(row));
        }
        Ok(())
    }
}

impl NodeColors {
    pub(super) fn new(steps: Arc<[Step]>, step: usize) -> Self {
        Self { steps, step }
    }

    /// The color at a position.
    #[must_use]
    pub fn sample(&self, position: DVec2) -> LinearRgb {
        self.colors(Places::Positions(&[position]))
            .first()
            .copied()
            .unwrap_or(LinearRgb::BLACK)
    }

    /// The colors at the pixel centers of a window.
    ///
    /// # Errors
    ///
    /// [`Empty`](dapple_raster::RasterErrorKind::Empty) or [`TooLarge`](dapple_raster::RasterErrorKind::TooLarge) if the
    /// window has a bad size.
    pub fn to_raster(&self, window: &Window) -> Result<Raster<LinearRgb>, RasterError> {
        let mut raster = Raster::filled(window.size, LinearRgb::BLACK)?;
        let colors = self.colors(Places::Window(window));
        if colors.len() == raster.pixels().len() {
            raster.pixels_mut().copy_from_slice(&colors);
        }
        Ok(raster)
    }

    fn colors(&self, places: Places<'_>) -> Vec<LinearRgb> {
        let values = evaluate(&self.steps, None, places, &[self.step], &[])
            .ok()
            .and_then(|mut values| values.pop());
        match values.as_deref() {
            Some(Values::Colors(colors)) => colors.clone(),
            _ => Vec::new(),
        }
    }
}
