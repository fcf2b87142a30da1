//! Estimates the work for a recipe, and checks it against limits before any work is done.
//!
//! A few lines of a recipe can demand any number of control points, wavelet noise of any size, and nested warps and
//! fractal sums. Each nested warp or octave evaluates all of its inputs once more.

use super::step::{Global, Step, needed};
use crate::{RecipeError, RecipeErrorKind};

/// Limits on the work for a recipe.
///
/// The defaults are far above what textures need, and the work that they allow fits in a small machine's memory.
///
/// # Examples
///
/// ```
/// use dapple_recipe::{Images, Plan, PlanLimits, Recipe};
///
/// let limits = PlanLimits { control_points: 10_000, ..PlanLimits::default() };
/// let recipe = Recipe::from_toml("dapple = 1\nnodes.a.noise.frequency = 1000\n[material]\n")?;
/// let error = Plan::new_within(&recipe, &Images::new(), 0.0, &limits).unwrap_err();
/// assert_eq!(error.node(), Some("a"));
/// # Ok::<(), dapple_recipe::RecipeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanLimits {
    /// Maximum total number of control points in all nodes; 2^22 by default, which take about 2 GiB. The number is an
    /// estimate, usually above the actual number.
    pub control_points: u64,
    /// Maximum total number of cells in the tiles of wavelet noise; 2^24 by default, such as one tile of 4096 × 4096
    /// cells.
    pub wavelet_cells: u64,
    /// Maximum total number of pixels in textures synthesized from examples; 2^24 by default, such as one texture of
    /// 4096 × 4096 pixels.
    pub synthesized_pixels: u64,
    /// Maximum number of values computed for each pixel; 4096 by default. Each node counts as one value, and so does
    /// each number or color that is an input. Inputs of a node that evaluates them at other positions, or that depends
    /// on the whole tile, count once more for each such node and octave, together with all that they depend on.
    pub values: u64,
    /// Maximum depth of nested nodes that evaluate their input at other positions, such as `warp`, `transform` and
    /// `fractal`; 32 by default.
    pub warps: u64,
    /// Maximum total number of pixels in the images stored for nodes that depend on the whole tile, at the size of a
    /// bake; 2^29 by default. It also bounds the pixels of a band together with the halos of its neighborhoods, such as
    /// the radii of nested blurs.
    pub pixels: u64,
}

impl Default for PlanLimits {
    fn default() -> Self {
        Self {
            control_points: 1 << 22,
            wavelet_cells: 1 << 24,
            synthesized_pixels: 1 << 24,
            values: 4096,
            warps: 32,
            pixels: 1 << 29,
        }
    }
}

impl PlanLimits {
    /// Returns an error if `pictures` images of `size` columns and rows have more pixels than the limit.
    pub(super) fn check_pixels(&self, pictures: usize, size: [u32; 2]) -> Result<(), RecipeError> {
        let pixels = pictures as f64 * f64::from(size[0]) * f64::from(size[1]);
        check("pixels that are seen as a whole", pixels, self.pixels)
    }
}

/// Returns an error if `value` is above its limit.
fn check(what: &'static str, value: f64, limit: u64) -> Result<(), RecipeError> {
    if value > limit as f64 {
        return Err(RecipeError::new(RecipeErrorKind::TooMuch {
            what,
            value,
            limit,
        }));
    }
    Ok(())
}

/// The work of building the step of a node.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Number of control points to place and connect.
    pub(crate) control_points: f64,
    /// Number of cells in the tiles of wavelet noise.
    pub(crate) wavelet_cells: f64,
    /// Number of pixels synthesized from examples.
    pub(crate) synthesized_pixels: f64,
}

/// The work of all nodes so far, with its limits.
pub(super) struct WorkSum<'a> {
    pub(super) limits: &'a PlanLimits,
    sum: Work,
}

impl<'a> WorkSum<'a> {
    pub(super) fn new(limits: &'a PlanLimits) -> Self {
        Self {
            limits,
            sum: Work::default(),
        }
    }

    /// Adds the work of building a node. Fails if the sum is above a limit.
    pub(super) fn add(&mut self, work: &Work) -> Result<(), RecipeError> {
        let Self { limits, sum } = self;
        sum.control_points += work.control_points;
        sum.wavelet_cells += work.wavelet_cells;
        sum.synthesized_pixels += work.synthesized_pixels;
        check("control points", sum.control_points, limits.control_points)?;
        check(
            "cells of wavelet noise",
            sum.wavelet_cells,
            limits.wavelet_cells,
        )?;
        check(
            "pixels grown from examples",
            sum.synthesized_pixels,
            limits.synthesized_pixels,
        )
    }
}

/// Number of values computed per pixel, for each step.
struct Values {
    /// For each step, the number of values of other steps that are recomputed for it.
    under: Vec<f64>,
    /// For each step, the number of nested moved steps, including the step itself; 0 if it is not a moved step.
    warps: Vec<u64>,
}

/// Checks the number of values per pixel and the nesting depth of warps against the limits. An error comes with the
/// index of the step that exceeds the limit.
pub(super) fn check_steps(steps: &[Step], limits: &PlanLimits) -> Result<(), (usize, RecipeError)> {
    let what = "values for each pixel";
    let last = steps.len().saturating_sub(1);
    check(what, steps.len() as f64, limits.values).map_err(|error| (last, error))?;
    let mut values = Values {
        under: Vec::with_capacity(steps.len()),
        warps: Vec::with_capacity(steps.len()),
    };
    let mut sum = 0.0;
    for (index, step) in steps.iter().enumerate() {
        values.add(&steps[..index], step);
        sum += 1.0 + values.under[index];
        check(what, sum, limits.values).map_err(|error| (index, error))?;
        let warps = values.warps[index] as f64;
        check(
            "nested warps, transforms and fractal sums",
            warps,
            limits.warps,
        )
        .map_err(|error| (index, error))?;
    }
    Ok(())
}

impl Values {
    /// Adds the counts of a step. Its inputs must have been added before.
    fn add(&mut self, before: &[Step], step: &Step) {
        // Find the steps that are evaluated separately for this one.
        let apart = match step {
            Step::Moved(moved) => vec![moved.input],
            Step::Global(Global { inputs, .. }) => inputs.clone(),
            _ => Vec::new(),
        };
        let under = needed(before, &apart, |_| false);
        let times = match step {
            Step::Moved(moved) => moved.times() as f64,
            _ => 1.0,
        };
        let values: f64 = under.iter().map(|&index| 1.0 + self.under[index]).sum();
        self.under.push(times * values);
        let warps = under
            .iter()
            .map(|&index| self.warps[index])
            .max()
            .unwrap_or(0);
        let is_moved = u64::from(matches!(step, Step::Moved(_)));
        self.warps.push(is_moved * (warps + 1));
    }
}
