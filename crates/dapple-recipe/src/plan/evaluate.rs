//! Evaluates steps at many positions.

use super::neighborhood::{cropped, pixel};
use super::step::{LinearMap, Moved, Positions, Step, StretchedImage, needed};
use super::{Picture, Values, Whole};
use crate::{RecipeError, RecipeErrorKind};
use dapple_color::LinearRgb;
use dapple_raster::FieldExt;
use dapple_raster::{Raster, RasterViewMut, Texel, Window, parallel};
use glam::DVec2;
use std::sync::Arc;

/// Positions at which steps are evaluated, and the area that each position represents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places<'a> {
    pub(super) at: At<'a>,
    /// Width and height of the area around each position over which images are averaged, in units of the plane; zero
    /// for points.
    pub(super) area: DVec2,
}

/// The positions, in order of evaluation.
#[derive(Clone, Copy, Debug)]
pub(super) enum At<'a> {
    Window(&'a Window),
    Positions(&'a [DVec2]),
}

impl<'a> Places<'a> {
    /// Creates the positions of a window's pixel centers, each with the area of its pixel.
    fn pixels(window: &'a Window) -> Self {
        Self {
            at: At::Window(window),
            area: pixel(window),
        }
    }

    /// Creates the positions of a window's pixel centers, without an area.
    fn centers(window: &'a Window) -> Self {
        Self {
            at: At::Window(window),
            area: DVec2::ZERO,
        }
    }

    /// Creates a list of positions without an area.
    pub(super) fn points(positions: &'a [DVec2]) -> Self {
        Self {
            at: At::Positions(positions),
            area: DVec2::ZERO,
        }
    }

    fn count(&self) -> usize {
        match self.at {
            At::Window(window) => window.n_pixels(),
            At::Positions(positions) => positions.len(),
        }
    }

    /// Returns all positions, row by row.
    pub(super) fn positions(&self) -> Vec<DVec2> {
        match self.at {
            At::Positions(positions) => positions.to_vec(),
            At::Window(window) => {
                let rows = (0..window.size[1]).map(|row| window.row_y(row));
                let row = |y| {
                    (0..window.size[0]).map(move |column| DVec2::new(window.column_x(column), y))
                };
                rows.flat_map(row).collect()
            }
        }
    }
}

/// Values that are already computed, each with its step's index and the window that they cover. The window contains the
/// evaluated one.
pub(crate) type Known = [(usize, (Window, Arc<Values>))];

/// Computes the values of the steps `wanted` at `places`, in the order of `wanted`.
pub(super) fn evaluate(
    steps: &[Step],
    whole: Option<&Whole>,
    places: Places<'_>,
    wanted: &[usize],
    known: &[(usize, Arc<Values>)],
) -> Result<Vec<Arc<Values>>, RecipeError> {
    let mut values: Vec<Option<Arc<Values>>> = vec![None; steps.len()];
    for (index, known) in known {
        values[*index] = Some(known.clone());
    }
    let order = needed(steps, wanted, |index| values[index].is_some());
    let last_use = last_uses(steps, &order, wanted);
    for index in order {
        if values[index].is_none() {
            if let Some(whole) = whole {
                whole.watch.check()?;
            }
            values[index] = Some(Arc::new(step(steps, whole, places, index, &values)?));
        }
        // Free inputs after their last use. The next steps then reuse the memory while it is in the processor's cache.
        for input in steps[index].inputs() {
            if last_use[input] == index {
                values[input] = None;
            }
        }
    }
    let value = |&index: &usize| values[index].clone().expect("what is wanted is needed");
    Ok(wanted.iter().map(value).collect())
}

/// Returns, for each step, the index of the last step of `order` that reads its values; `usize::MAX` for the steps
/// `wanted`, whose values are kept.
fn last_uses(steps: &[Step], order: &[usize], wanted: &[usize]) -> Vec<usize> {
    let mut last_use = vec![usize::MAX; steps.len()];
    for &index in order {
        for input in steps[index].inputs() {
            last_use[input] = index;
        }
    }
    for &index in wanted {
        last_use[index] = usize::MAX;
    }
    last_use
}

/// Maximum and minimum number of pixels in a chunk, which one thread evaluates at a time.
const CHUNK_PIXELS: [u32; 2] = [1 << 16, 1 << 11];

/// Number of positions that are evaluated at a time. Their values fit in the processor's cache.
const CHUNK_POSITIONS: usize = 1 << 12;

/// The pixels at which steps are evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid<'a> {
    pub(super) window: &'a Window,
    /// Whether images are averaged over the area of each pixel, instead of sampled at its center.
    pub(super) averages: bool,
}

impl<'a> Grid<'a> {
    fn places(self) -> Places<'a> {
        match self.averages {
            true => Places::pixels(self.window),
            false => Places::centers(self.window),
        }
    }
}

/// Computes the values of the steps `wanted` at the pixels of a window, a chunk of rows at a time, on all cores if the
/// feature `rayon` is on. `known` holds values in windows that contain the window.
pub(super) fn chunks(
    steps: &[Step],
    whole: Option<&Whole>,
    grid: Grid<'_>,
    wanted: &[usize],
    known: &Known,
) -> Result<Vec<Values>, RecipeError> {
    if wanted.is_empty() {
        return Ok(Vec::new());
    }
    let window = grid.window;
    let [width, height] = window.size;
    // Choose the number of rows of a chunk, so that small windows have work for all threads, too.
    let share = window.n_pixels() / (2 * parallel::n_threads());
    let [most, fewest] = CHUNK_PIXELS;
    let pixels = u32::try_from(share).map_or(most, |share| share.clamp(fewest, most));
    let rows = (pixels / width.max(1)).max(1);
    let chunks = parallel::map(height.div_ceil(rows) as usize, |chunk| {
        let first = chunk as u32 * rows;
        let part = Window {
            first: [
                window.first[0],
                window.first[1].saturating_add(first.into()),
            ],
            size: [width, rows.min(height - first)],
            ..*window
        };
        let known = known
            .iter()
            .map(|(index, (made_in, values))| (*index, cropped(values, made_in, &part)));
        let grid = Grid {
            window: &part,
            ..grid
        };
        evaluate(
            steps,
            whole,
            grid.places(),
            wanted,
            &known.collect::<Vec<_>>(),
        )
    });
    // Return the error of the topmost chunk that failed, regardless of the order of the threads.
    Ok(join(chunks.into_iter().collect::<Result<_, _>>()?))
}

/// Minimum number of values per parallel task when chunks are joined; shorter lists are joined on the current thread.
const JOINED_VALUES: usize = 1 << 14;

/// Concatenates the values of all chunks, separately for each step.
fn join(mut chunks: Vec<Vec<Arc<Values>>>) -> Vec<Values> {
    if chunks.len() == 1 {
        let only = chunks.swap_remove(0);
        return only.into_iter().map(Arc::unwrap_or_clone).collect();
    }
    let n_steps = chunks.first().map_or(0, Vec::len);
    let n_values: usize = chunks.iter().flatten().map(|values| values.len()).sum();
    let least = JOINED_VALUES.div_ceil((n_values / n_steps.max(1)).max(1));
    parallel::map_at_least(least, n_steps, |step| {
        let parts: Vec<&Values> = chunks.iter().map(|chunk| &*chunk[step]).collect();
        Values::joined(&parts)
    })
}

fn step(
    steps: &[Step],
    whole: Option<&Whole>,
    places: Places<'_>,
    index: usize,
    values: &[Option<Arc<Values>>],
) -> Result<Values, RecipeError> {
    let count = places.count();
    let made = |input: &usize| values[*input].as_deref().expect("inputs come before");
    match &steps[index] {
        Step::Number(number) => Ok(Values::Numbers(vec![*number; count])),
        Step::Color(color) => Ok(Values::Colors(vec![*color; count])),
        Step::Field(field) => {
            let mut numbers = vec![0.0; count];
            match places.at {
                At::Window(window) => {
                    let view =
                        RasterViewMut::new(&mut numbers, window.size[0] as usize, window.size)?;
                    field.render(window, view)?;
                }
                At::Positions(positions) => field.sample_many(positions, &mut numbers)?,
            }
            Ok(Values::Numbers(numbers))
        }
        Step::Image(laid) => Ok(laid.at(places)),
        Step::Colors(texture) => {
            let colors = match places.at {
                At::Window(window) => texture.to_raster(window)?.into_pixels(),
                At::Positions(positions) => {
                    positions.iter().map(|&at| texture.sample(at)).collect()
                }
            };
            Ok(Values::Colors(
                colors.into_iter().map(LinearRgb::from).collect(),
            ))
        }
        Step::Local(local) => {
            let inputs: Vec<_> = local.inputs.iter().map(made).collect();
            (local.apply)(&inputs)
        }
        Step::Moved(moved) => self::moved(steps, whole, places, moved, values),
        // Neighborhoods of the pixels of a window are known; at other positions they are read from an image.
        Step::Neighborhood(_) | Step::Global(_) => match whole {
            Some(whole) => whole.at(index, places),
            None => Err(RecipeError::new(RecipeErrorKind::Global {
                during: "at single positions",
            })),
        },
    }
}

/// Computes the values of a step that evaluates its input at transformed positions.
fn moved(
    steps: &[Step],
    whole: Option<&Whole>,
    places: Places<'_>,
    moved: &Moved,
    values: &[Option<Arc<Values>>],
) -> Result<Values, RecipeError> {
    let input = moved.input;
    match &moved.positions {
        Positions::Displaced { by, amount } => {
            let [x, y] = by.map(|by| values[by].as_deref().expect("inputs come before"));
            let shifted = shifted(places.positions(), x, y, *amount);
            at_positions(steps, whole, input, &shifted, places.area)
        }
        Positions::Given { by, scale } => {
            let [x, y] = by.map(|by| values[by].as_deref().expect("inputs come before"));
            let given = x.numbers().iter().zip(y.numbers());
            let given = given.map(|(&x, &y)| DVec2::new(x.into(), y.into()) * DVec2::from(*scale));
            let given: Vec<_> = given.collect();
            at_positions(steps, whole, input, &given, places.area)
        }
        Positions::Folded(map) => {
            let mut positions = places.positions();
            for position in &mut positions {
                *position = map((*position).into()).into();
            }
            at_positions(steps, whole, input, &positions, places.area)
        }
        Positions::Linear(map) => mapped(steps, whole, places, input, map),
        Positions::Octaves { octaves, shape } => {
            let mut sum = vec![0.0; places.count()];
            for &(frequency, weight) in octaves {
                let map = LinearMap::scale([frequency; 2]);
                let octave = mapped(steps, whole, places, input, &map)?;
                for (sum, &value) in sum.iter_mut().zip(octave.numbers()) {
                    *sum += weight * shape.of(value);
                }
            }
            Ok(Values::Numbers(sum))
        }
    }
}

/// Evaluates a step at positions transformed by a linear map.
fn mapped(
    steps: &[Step],
    whole: Option<&Whole>,
    places: Places<'_>,
    input: usize,
    map: &LinearMap,
) -> Result<Values, RecipeError> {
    let area = DVec2::from(map.area(places.area.into()));
    // A scaled window is a window, in which fields render faster than at single positions.
    if let At::Window(window) = places.at
        && map.is_scale()
        && let Some(scaled) = window.scaled(map.frequency)
    {
        let at = At::Window(&scaled);
        let values = evaluate(steps, whole, Places { at, area }, &[input], &[])?;
        let values = values.into_iter().next().expect("one step is wanted");
        return Ok(Arc::unwrap_or_clone(values));
    }
    let mut positions = places.positions();
    for position in &mut positions {
        *position = map.position((*position).into()).into();
    }
    at_positions(steps, whole, input, &positions, area)
}

/// Evaluates a step at a list of positions, a chunk at a time.
fn at_positions(
    steps: &[Step],
    whole: Option<&Whole>,
    input: usize,
    positions: &[DVec2],
    area: DVec2,
) -> Result<Values, RecipeError> {
    let values = |positions| {
        let at = At::Positions(positions);
        evaluate(steps, whole, Places { at, area }, &[input], &[])
    };
    // The first chunk may be empty, so that the result has a value kind even without positions.
    let (first, rest) = positions.split_at(CHUNK_POSITIONS.min(positions.len()));
    let rest = rest.chunks(CHUNK_POSITIONS).map(values);
    let chunks: Result<Vec<_>, _> = core::iter::once(values(first)).chain(rest).collect();
    Ok(join(chunks?).swap_remove(0))
}

/// Returns `positions` displaced by `amount` times the vectors (x, y).
fn shifted(mut positions: Vec<DVec2>, x: &Values, y: &Values, amount: f64) -> Vec<DVec2> {
    let shifts = x.numbers().iter().zip(y.numbers());
    for (position, (&x, &y)) in positions.iter_mut().zip(shifts) {
        *position += amount * DVec2::new(x.into(), y.into());
    }
    positions
}

impl StretchedImage {
    /// Samples the image at positions of the plane. Each sample is the mean of the pixels over the position's area.
    pub(super) fn at(&self, places: Places<'_>) -> Values {
        match &self.picture {
            Picture::Numbers(raster) => Values::Numbers(self.read(raster, places)),
            Picture::Colors(raster) => Values::Colors(self.read(raster, places)),
        }
    }

    fn read<T: Texel>(&self, raster: &Raster<T>, places: Places<'_>) -> Vec<T> {
        let positions = places.positions().into_iter();
        let uv = positions.map(|position| (position - self.origin) / self.extent);
        let area = places.area / self.extent;
        uv.map(|uv| raster.sample_area(uv, area, self.wrap))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Places, evaluate, last_uses, needed};
    use crate::Values;
    use crate::plan::step::{Local, Step, shared};
    use dapple_raster::glam::DVec2;

    /// Builds a step that sums the absolute values of some inputs. The tests use no plan, which would compile all nodes
    /// again.
    fn sum(inputs: &[usize]) -> Step {
        Step::Local(Local {
            inputs: inputs.to_vec(),
            color: false,
            apply: Box::new(|inputs| {
                let sum = inputs.iter().map(|values| values.numbers()[0].abs()).sum();
                Ok(Values::Numbers(vec![sum]))
            }),
        })
    }

    #[test]
    fn values_are_kept_until_their_last_use_or_as_long_as_they_are_wanted() {
        let [a, b, c, d] = [0, 1, 2, 3];
        let steps = [Step::Number(0.25), sum(&[a]), sum(&[a, b, b]), sum(&[c])];
        let kept_until = |wanted: &[usize]| {
            let order = needed(&steps, wanted, |_| false);
            let last_uses = last_uses(&steps, &order, wanted);
            [a, b, c, d].map(|index| last_uses[index])
        };
        assert_eq!(kept_until(&[d]), [c, c, d, usize::MAX]);
        assert_eq!(kept_until(&[b, d]), [c, usize::MAX, d, usize::MAX]);
        let positions = [DVec2::new(0.25, 0.5)];
        let places = Places::points(&positions);
        let values = evaluate(&steps, None, places, &[b, d, a], &[]).unwrap();
        let values: Vec<_> = values.iter().map(|values| values.numbers()[0]).collect();
        assert_eq!(values, [0.25, 0.75, 0.25]);
    }
    #[test]
    fn steps_on_the_way_to_the_height_are_shared_but_for_constants() {
        let [a, b, c, d, e] = [0, 1, 2, 3, 4];
        let steps = [
            Step::Number(0.25),
            sum(&[a]),
            sum(&[b]),
            sum(&[b, c]),
            sum(&[a, d]),
        ];
        assert_eq!(shared(&steps, &[c], &[d, e]), [b, c]);
        assert_eq!(shared(&steps, &[b], &[c]), [b]);
        assert_eq!(shared(&steps, &[e], &[c]), [c]);
        assert_eq!(shared(&steps, &[a], &[e]), [0; 0]);
    }
}
