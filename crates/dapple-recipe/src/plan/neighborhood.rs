//! Steps whose values depend on the neighborhood of a pixel, such as blurs, and the order in which a window evaluates
//! them.
//!
//! The value at a pixel depends on the values of the inputs at the pixels within a halo. Pixels are those of an
//! unbounded grid, whose first pixel is the first one of the tile. A window therefore needs its inputs in a larger
//! window, and a value has the same bits in every window that contains its pixel.
//!
//! Nested neighborhoods add up their halos. A backward pass over the steps computes the margin around the window in
//! which each step is needed. A forward pass then evaluates each step once, in the window with this margin.

use super::evaluate::{Grid, Known, chunks};
use super::step::{Step, needed};
use super::{PlanLimits, Watch, Whole};
use crate::{RecipeError, RecipeErrorKind, Values};
use core::cmp::Reverse;
use dapple_color::continue_heights;
use dapple_filter::Part;
use dapple_raster::{Raster, Window};
use glam::DVec2;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Maximum sum of the halos of all neighborhoods that a window needs, in pixels. It bounds the time for a pixel and the
/// margin around a window.
const MAX_HALO: u64 = 1 << 15;

/// A step that computes each value from the values of the inputs in a neighborhood of the pixel.
pub(crate) struct Neighborhood {
    pub(crate) inputs: Vec<usize>,
    pub(crate) color: bool,
    /// The name of the node, for error messages.
    pub(crate) node: String,
    /// For each axis, the length of the tile in units of the plane if the inputs are heights that must be extrapolated
    /// past the tile's sides; `None` if the inputs' values past the sides are used unchanged.
    pub(crate) ends: [Option<f64>; 2],
    pub(crate) limits: PlanLimits,
    pub(crate) halo: Box<HaloFunction>,
    pub(crate) apply: Box<NeighborhoodFunction>,
}

/// Returns the halo in columns and rows, given the width and height of a pixel in units of the plane.
type HaloFunction = dyn Fn(DVec2) -> [u32; 2] + Send + Sync;
type NeighborhoodFunction = dyn Fn(&Surroundings<'_>) -> Result<Values, RecipeError> + Send + Sync;

/// Arguments of a neighborhood step's function.
pub(crate) struct Surroundings<'a> {
    /// The values of the inputs in the window and its halo, row by row.
    pub(crate) inputs: &'a [Arc<Values>],
    /// The pixels to compute, and the halo around them that the inputs cover.
    pub(crate) part: Part,
    /// Reports progress to the caller's callback.
    pub(crate) watch: &'a Watch,
}

impl Surroundings<'_> {
    /// Applies `change` to each channel of an input: to its numbers, or separately to red, green and blue.
    pub(crate) fn each_channel(&self, input: usize, change: impl Fn(&[f32]) -> Vec<f32>) -> Values {
        self.inputs[input].each_channel(change)
    }

    /// Returns the numbers of an input as a raster. Colors are converted to their luminance.
    pub(crate) fn raster(&self, input: usize) -> Result<Raster<f32>, RecipeError> {
        Ok(self.inputs[input].raster(self.part.input_size())?)
    }
}

impl Neighborhood {
    /// Computes the values in `window`. The inputs' windows contain `window` and its halo.
    fn at(
        &self,
        window: &Window,
        inputs: &[&(Window, Arc<Values>)],
        watch: &Watch,
    ) -> Result<Values, RecipeError> {
        let (pixel, size) = (pixel(window), window.size);
        let halo = (self.halo)(pixel);
        let around = with_margin(window, halo);
        let mut cut = Vec::with_capacity(inputs.len());
        for (made_in, values) in inputs {
            let continued = self.continued(made_in, values, &around)?;
            cut.push(continued.unwrap_or_else(|| cropped(values, made_in, &around)));
        }
        (self.apply)(&Surroundings {
            inputs: &cut,
            part: Part { size, halo, pixel },
            watch,
        })
    }

    /// Returns the range of the tile's pixels along an axis on which heights are extrapolated: the first pixel, and the
    /// pixel after the last one. `None` for other axes.
    fn sides(&self, window: &Window, axis: usize) -> Option<[i64; 2]> {
        let length = self.ends[axis]?;
        let (origin, pixel) = (window.origin[axis], window.pixel[axis]);
        let [a, b] = [0.0, length].map(|side| (side / window.scale[axis] - origin) / pixel - 0.5);
        // The centers of the outermost pixels may be on the sides. The small term absorbs the rounding error of the
        // pixel size.
        let [first, last] = [(a.min(b) - 1e-6).ceil(), (a.max(b) + 1e-6).floor()];
        (first.is_finite() && last.is_finite())
            .then(|| [first as i64, (last as i64).saturating_add(1)])
    }

    /// Returns the inputs in `around`, with heights extrapolated past the sides of the tile; `None` if `around` is
    /// inside the tile.
    fn continued(
        &self,
        made_in: &Window,
        values: &Arc<Values>,
        around: &Window,
    ) -> Result<Option<Arc<Values>>, RecipeError> {
        let sides = [0, 1].map(|axis| self.sides(around, axis));
        let is_past = |axis: usize| {
            sides[axis].is_some_and(|[from, end]| {
                let first = around.first[axis];
                first < from || first.saturating_add(around.size[axis].into()) > end
            })
        };
        if !is_past(0) && !is_past(1) {
            return Ok(None);
        }
        let mut raster = values.raster(made_in.size)?;
        let in_raster =
            |axis: usize| Some(sides[axis]?.map(|side| side.saturating_sub(made_in.first[axis])));
        continue_heights(&mut raster, [0, 1].map(in_raster));
        let continued = Arc::new(Values::Numbers(raster.into_pixels()));
        Ok(Some(cropped(&continued, made_in, around)))
    }

    /// Returns the margin around `window` in which the inputs are needed if the step's values are needed in `margin`.
    fn margin_of_inputs(&self, window: &Window, margin: [u32; 2]) -> [u32; 2] {
        let halo = (self.halo)(pixel(window));
        [0, 1].map(|axis| {
            let margin = margin[axis].saturating_add(halo[axis]);
            let Some([from, end]) = self.sides(window, axis) else {
                return margin;
            };
            // Past a side, a height is extrapolated from the heights at the side and at the mirrored pixel.
            let [first, last] = [
                window.first[axis],
                window.first[axis].saturating_add(i64::from(window.size[axis]) - 1),
            ];
            let [low, high] = [
                first.saturating_sub(margin.into()),
                last.saturating_add(margin.into()),
            ];
            let length = end.saturating_sub(from).max(1);
            let mirrored = |past: i64| past.clamp(0, length - 1);
            let lowest = match high >= end {
                true => (end - 1).saturating_sub(mirrored(high.saturating_sub(end - 1))),
                false => low,
            };
            let highest = match low < from {
                true => from.saturating_add(mirrored(from.saturating_sub(low))),
                false => high,
            };
            let [below, above] = [
                first.saturating_sub(lowest.min(low)),
                highest.max(high).saturating_sub(last),
            ];
            let wanted = below.max(above);
            u32::try_from(wanted).unwrap_or(u32::MAX)
        })
    }
}

/// Returns the width and height of a window's pixels, in units of the plane.
pub(super) fn pixel(window: &Window) -> DVec2 {
    (DVec2::from(window.pixel) * DVec2::from(window.scale)).abs()
}

/// Returns `window` with a margin at each side, in columns and rows.
pub(crate) fn with_margin(window: &Window, margin: [u32; 2]) -> Window {
    Window {
        first: [0, 1].map(|axis| window.first[axis].saturating_sub(margin[axis].into())),
        size: [0, 1].map(|axis| {
            window.size[axis]
                .saturating_add(margin[axis])
                .saturating_add(margin[axis])
        }),
        ..*window
    }
}

/// Crops values from `window` to `part`, which it contains.
pub(super) fn cropped(values: &Arc<Values>, window: &Window, part: &Window) -> Arc<Values> {
    if (window.first, window.size) == (part.first, part.size) {
        return values.clone();
    }
    let skipped = [0, 1].map(|axis| (part.first[axis] - window.first[axis]) as usize);
    let width = window.size[0] as usize;
    let rows = (0..part.size[1] as usize).map(|row| {
        let first = (skipped[1] + row) * width + skipped[0];
        first..first + part.size[0] as usize
    });
    Arc::new(values.parts(rows))
}

/// A step's position in the order of evaluation, as a sort key. Its last element is the margin around the window in
/// which the step is computed.
///
/// The first element is the step's level: the maximum number of neighborhoods on a path of inputs to it. At each level,
/// neighborhoods come first, and then the other steps, largest margin first.
type Stage = (u32, bool, Reverse<[u32; 2]>);

/// Returns whether `window` contains `part`. Both windows have the same pixel grid.
fn contains(window: &Window, part: &Window) -> bool {
    (0..2).all(|axis| {
        let end = |window: &Window| window.first[axis].saturating_add(i64::from(window.size[axis]));
        window.first[axis] <= part.first[axis] && end(part) <= end(window)
    })
}

/// For each step, returns its stage if `wanted` need it in `window`; otherwise `None`. The inputs of a step whose
/// values are known in all of the needed window are not needed.
fn stages(
    steps: &[Step],
    window: &Window,
    wanted: &[usize],
    known: &Known,
) -> Result<Vec<Option<Stage>>, RecipeError> {
    let is_known = |index: usize, margin: [u32; 2]| {
        let part = with_margin(window, margin);
        let is_it = |(known, (made_in, _)): &(usize, (Window, _))| {
            *known == index && contains(made_in, &part)
        };
        known.iter().any(is_it)
    };
    let mut margins: Vec<Option<[u32; 2]>> = vec![None; steps.len()];
    for &index in wanted {
        margins[index] = Some([0; 2]);
    }
    // Go backward from the wanted steps to their inputs.
    let mut sum = 0;
    for index in (0..steps.len()).rev() {
        let Some(margin) = margins[index] else {
            continue;
        };
        if is_known(index, margin) {
            continue;
        }
        let mut of_inputs = margin;
        if let Step::Neighborhood(step) = &steps[index] {
            let halo = (step.halo)(pixel(window));
            sum += u64::from(halo[0].max(halo[1]));
            of_inputs = step.margin_of_inputs(window, margin);
            step.check(sum, &with_margin(window, of_inputs))
                .map_err(|error| error.within(&step.node))?;
        }
        for input in steps[index].inputs_at_pixels() {
            let before = margins[input].unwrap_or([0; 2]);
            margins[input] = Some([0, 1].map(|axis| before[axis].max(of_inputs[axis])));
        }
    }
    // Go forward to find the levels.
    let mut stages: Vec<Option<Stage>> = vec![None; steps.len()];
    for index in 0..steps.len() {
        let Some(margin) = margins[index] else {
            continue;
        };
        let inputs = steps[index].inputs_at_pixels().into_iter();
        let before = inputs.filter_map(|input| Some(stages[input]?.0)).max();
        let before = before.unwrap_or(0);
        let is_neighborhood = matches!(steps[index], Step::Neighborhood(_));
        let stage = (before + u32::from(is_neighborhood), !is_neighborhood);
        stages[index] = Some((stage.0, stage.1, Reverse(margin)));
    }
    Ok(stages)
}

impl Neighborhood {
    /// Checks limits: `halos`, the sum of the halos of nested neighborhoods, and the number of pixels of `inputs`.
    fn check(&self, halos: u64, inputs: &Window) -> Result<(), RecipeError> {
        let [width, height] = inputs.size.map(u64::from);
        for (what, value, limit) in [
            ("pixels in the halos of neighborhoods", halos, MAX_HALO),
            (
                "pixels of a window with the halos of neighborhoods",
                width * height,
                self.limits.pixels.min(1 << 31),
            ),
        ] {
            if value > limit {
                return Err(RecipeError::new(RecipeErrorKind::TooMuch {
                    what,
                    value: value as f64,
                    limit,
                }));
            }
        }
        Ok(())
    }
}

/// Returns the margin that the neighborhoods of `wanted` need around a window with pixels of this size: the largest one
/// of all steps. Fails if the sum of halos exceeds the limit.
pub(super) fn margin(
    steps: &[Step],
    window: &Window,
    wanted: &[usize],
) -> Result<[u32; 2], RecipeError> {
    let one = Window {
        size: [1; 2],
        ..*window
    };
    let stages = stages(steps, &one, wanted, &[])?;
    let margins = stages.into_iter().flatten();
    Ok(margins.fold([0; 2], |most, (_, _, Reverse(margin))| {
        [0, 1].map(|axis| most[axis].max(margin[axis]))
    }))
}

/// Returns the indices of the steps that neighborhoods read and that do not depend on a neighborhood themselves. Also
/// returns the largest margin around the window in which these steps are needed.
pub(super) fn sources(
    steps: &[Step],
    window: &Window,
    wanted: &[usize],
) -> Result<(Vec<usize>, [u32; 2]), RecipeError> {
    let one = Window {
        size: [1; 2],
        ..*window
    };
    let stages = stages(steps, &one, wanted, &[])?;
    let is_kept = kept(steps, &stages, wanted);
    let (mut sources, mut most) = (Vec::new(), [0; 2]);
    for (index, stage) in stages.iter().enumerate() {
        match stage {
            Some((0, true, Reverse(margin)))
                if *margin != [0; 2] && is_kept[index] && !steps[index].is_ready() =>
            {
                sources.push(index);
                most = [0, 1].map(|axis| most[axis].max(margin[axis]));
            }
            _ => {}
        }
    }
    Ok((sources, most))
}

/// Computes the values of the steps `wanted` at the pixels of a window, in the order of `wanted`. Each step that a
/// neighborhood needs is computed once, in the window with its margin. Runs on all cores if the feature `rayon` is on.
pub(super) fn window(
    steps: &[Step],
    whole: Option<&Whole>,
    grid: Grid<'_>,
    wanted: &[usize],
    known: &Known,
) -> Result<Vec<Values>, RecipeError> {
    let window = grid.window;
    let is_known = |index: usize| known.iter().any(|(known, _)| *known == index);
    let read = needed(steps, wanted, is_known);
    let sees_neighborhood =
        |&index: &usize| !is_known(index) && matches!(steps[index], Step::Neighborhood(_));
    if !read.iter().any(sees_neighborhood) {
        let mut known = known.to_vec();
        known.retain(|(index, _)| read.contains(index));
        return chunks(steps, whole, grid, wanted, &known);
    }
    let stages = stages(steps, window, wanted, known)?;
    let is_kept = kept(steps, &stages, wanted);
    let mut order: BTreeMap<Stage, Vec<usize>> = BTreeMap::new();
    for (index, stage) in stages.iter().enumerate() {
        if let (Some(stage), true) = (stage, is_kept[index]) {
            order.entry(*stage).or_default().push(index);
        }
    }
    // A step that is known in too small a window is computed again.
    let mut made = BTreeMap::from_iter(known.iter().cloned());
    made.retain(|&index, (made_in, _)| {
        let part = |(_, _, Reverse(margin))| with_margin(window, margin);
        stages[index].is_some_and(|stage| contains(made_in, &part(stage)))
    });
    let silent = Watch::default();
    let watch = whole.map_or(&silent, |whole| &whole.watch);
    for ((_, _, Reverse(margin)), mut members) in order {
        members.retain(|index| !made.contains_key(index));
        let part = with_margin(window, margin);
        watch.check()?;
        let values = match members.first().map(|&index| &steps[index]) {
            None => continue,
            Some(Step::Neighborhood(_)) => {
                let value = |&index: &usize| match &steps[index] {
                    Step::Neighborhood(step) => {
                        let inputs: Vec<_> = step.inputs.iter().map(|input| &made[input]).collect();
                        step.at(&part, &inputs, watch)
                            .map_err(|error| watch.reason(error.within(&step.node)))
                    }
                    _ => Ok(Values::Numbers(Vec::new())),
                };
                members.iter().map(value).collect::<Result<Vec<_>, _>>()?
            }
            Some(_) => {
                // Pass on only what these steps read, which is made with a margin at least as large.
                let read = needed(steps, &members, |index| made.contains_key(&index)).into_iter();
                let known = read.filter_map(|index| Some((index, made.get(&index)?.clone())));
                let known: Vec<_> = known.collect();
                let grid = Grid {
                    window: &part,
                    ..grid
                };
                chunks(steps, whole, grid, &members, &known)?
            }
        };
        made.extend(
            members
                .into_iter()
                .zip(values)
                .map(|(index, values)| (index, (part, Arc::new(values)))),
        );
    }
    let value = |index: &usize| {
        let (made_in, values) = &made[index];
        cropped(values, made_in, window)
    };
    let values: Vec<_> = wanted.iter().map(value).collect();
    drop(made);
    Ok(values.into_iter().map(Arc::unwrap_or_clone).collect())
}

/// For each step, returns whether its values in the whole window must be stored: wanted steps, neighborhoods and their
/// inputs, and steps that a later stage reads.
fn kept(steps: &[Step], stages: &[Option<Stage>], wanted: &[usize]) -> Vec<bool> {
    let mut is_kept = vec![false; steps.len()];
    for &index in wanted {
        is_kept[index] = true;
    }
    for (index, step) in steps.iter().enumerate() {
        if stages[index].is_none() {
            continue;
        }
        let is_neighborhood = matches!(step, Step::Neighborhood(_));
        is_kept[index] |= is_neighborhood;
        for input in step.inputs_at_pixels() {
            let is_read_later = !steps[input].is_ready() && stages[input] != stages[index];
            is_kept[input] |= is_neighborhood || is_read_later;
        }
    }
    is_kept
}
