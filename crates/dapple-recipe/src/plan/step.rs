//! The steps of a plan. A step computes the values of a node or of a constant.

use super::{Neighborhood, Picture, Watch};
use crate::{RecipeError, Values};
use dapple_color::LinearRgb;
use dapple_pups::VectorTexture;
use dapple_raster::{Field, FractalShape, Window, Wrap};
use dapple_tile::Map;
use glam::DVec2;
use std::fmt;
use std::sync::Arc;

/// A plan step: a source of values. Its inputs are indices of earlier steps.
pub(crate) enum Step {
    Number(f32),
    Color(LinearRgb),
    Field(Arc<dyn Field>),
    Colors(Arc<VectorTexture<3>>),
    Image(StretchedImage),
    Local(Local),
    Moved(Moved),
    Neighborhood(Neighborhood),
    Global(Global),
}

/// A step that evaluates its input at transformed positions.
pub(crate) struct Moved {
    pub(crate) input: usize,
    pub(crate) color: bool,
    pub(crate) positions: Positions,
}

/// The positions at which a [`Moved`] step evaluates its input.
pub(crate) enum Positions {
    /// Positions displaced by `amount` times the numbers of two steps.
    Displaced { by: [usize; 2], amount: f64 },
    /// Positions whose coordinates are the numbers of two steps times a scale.
    Given { by: [usize; 2], scale: [f64; 2] },
    /// Positions after a linear map.
    Linear(LinearMap),
    /// Positions after a map that folds or bends the plane.
    Folded(Box<PositionMap>),
    /// Positions times the frequency of each octave, whose values are summed.
    Octaves {
        /// Frequency and weight of each octave.
        octaves: Vec<(f64, f32)>,
        shape: FractalShape,
    },
}

/// Maps a position to the position at which the input is evaluated.
pub(crate) type PositionMap = dyn Fn([f64; 2]) -> [f64; 2] + Send + Sync;

/// A linear map of positions: a rotation about the origin, then a scale for each axis, then an offset.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinearMap {
    /// Cosine and sine of the angle of rotation.
    pub(crate) direction: [f64; 2],
    pub(crate) frequency: [f64; 2],
    pub(crate) offset: [f64; 2],
}

impl LinearMap {
    /// Creates a map that scales positions along each axis.
    pub(crate) fn scale(frequency: [f64; 2]) -> Self {
        Self {
            direction: [1.0, 0.0],
            frequency,
            offset: [0.0; 2],
        }
    }

    /// Maps a vector; offsets do not apply.
    pub(crate) fn vector(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.direction;
        let rotated = [x * cos + y * sin, y * cos - x * sin];
        [0, 1].map(|axis| rotated[axis] * self.frequency[axis])
    }

    /// Maps a position: rotation, scale and offset.
    pub(crate) fn position(&self, position: [f64; 2]) -> [f64; 2] {
        let scaled = self.vector(position);
        [0, 1].map(|axis| scaled[axis] + self.offset[axis])
    }

    /// Returns whether the map has neither a rotation nor an offset.
    pub(crate) fn is_scale(&self) -> bool {
        self.direction == [1.0, 0.0] && self.offset == [0.0; 2]
    }

    /// Returns the width and height of a pixel after the map. `[width, height]` is the pixel's size before. Only the
    /// scale changes the pixel's area.
    pub(crate) fn area(&self, [width, height]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.direction;
        let side = |a: f64, b: f64| (a * cos * (a * cos) + b * sin * (b * sin)).sqrt();
        let rotated = [side(width, height), side(height, width)];
        [0, 1].map(|axis| rotated[axis] * self.frequency[axis].abs())
    }
}

/// A step that computes each value from the values of the inputs at the same position.
pub(crate) struct Local {
    pub(crate) inputs: Vec<usize>,
    pub(crate) color: bool,
    pub(crate) apply: Box<LocalFunction>,
}

type LocalFunction = dyn Fn(&[&Values]) -> Result<Values, RecipeError> + Send + Sync;

/// A step that computes its values from the inputs' values over the whole tile.
pub(crate) struct Global {
    pub(crate) inputs: Vec<usize>,
    pub(crate) color: bool,
    /// Number of copies of the inputs' images that fit in the tile, along each axis.
    pub(crate) copies: [u32; 2],
    pub(crate) apply: Box<GlobalFunction>,
}

type GlobalFunction = dyn Fn(&Tile<'_>) -> Result<Values, RecipeError> + Send + Sync;

/// Arguments of a global step's function.
pub(crate) struct Tile<'a> {
    pub(crate) inputs: &'a [&'a Values],
    /// Columns and rows of the inputs.
    pub(crate) input_size: [u32; 2],
    /// The window that covers all pixels of the tile.
    pub(crate) window: &'a Window,
    /// Reports progress to the caller's callback.
    pub(crate) watch: &'a Watch,
}

/// An image stretched over the tile.
#[derive(Clone, Debug)]
pub(crate) struct StretchedImage {
    pub(crate) picture: Picture,
    /// The position of the outer corner of the first pixel.
    pub(crate) origin: DVec2,
    pub(crate) extent: DVec2,
    pub(crate) wrap: [Wrap; 2],
}

impl Moved {
    /// Returns the inputs that are evaluated at the positions of this step itself, such as the displacements of a warp.
    fn at_same_positions(&self) -> Vec<usize> {
        match self.positions {
            Positions::Displaced { by, .. } | Positions::Given { by, .. } => by.to_vec(),
            Positions::Linear(_) | Positions::Folded(_) | Positions::Octaves { .. } => Vec::new(),
        }
    }

    /// Returns the number of times that the input is evaluated per position.
    pub(super) fn times(&self) -> usize {
        match &self.positions {
            Positions::Octaves { octaves, .. } => octaves.len(),
            _ => 1,
        }
    }
}

impl Tile<'_> {
    /// Returns a function that returns whether the caller's callback asks to stop.
    pub(crate) fn is_cancelled(&self) -> impl Fn() -> bool + Sync {
        || self.watch.is_cancelled()
    }

    /// Converts the inputs to images of the tile. All images are in color if any input is.
    pub(crate) fn maps(&self) -> Result<Vec<Map>, RecipeError> {
        Ok(Values::maps(self.inputs, self.input_size)?)
    }
}

impl fmt::Debug for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self {
            Self::Number(number) => return f.debug_tuple("Number").field(number).finish(),
            Self::Color(color) => return f.debug_tuple("Color").field(color).finish(),
            Self::Field(_) => "Field",
            Self::Colors(_) => "Colors",
            Self::Image(_) => "Image",
            Self::Local(_) => "Local",
            Self::Moved(_) => "Moved",
            Self::Neighborhood(_) => "Neighborhood",
            Self::Global(_) => "Global",
        };
        f.debug_tuple(name).field(&self.inputs()).finish()
    }
}

impl Step {
    /// Creates a step that evaluates a field.
    pub(crate) fn field(field: impl Field + 'static) -> Self {
        Self::Field(Arc::new(field))
    }

    /// Marks the step's values as colors, regardless of its inputs.
    pub(crate) fn with_colors(self) -> Self {
        self.with_color(true)
    }

    /// Marks the step's values as scalars, regardless of its inputs.
    pub(crate) fn with_numbers(self) -> Self {
        self.with_color(false)
    }

    fn with_color(mut self, makes_color: bool) -> Self {
        if let Self::Local(Local { color, .. })
        | Self::Neighborhood(Neighborhood { color, .. })
        | Self::Global(Global { color, .. }) = &mut self
        {
            *color = makes_color;
        }
        self
    }

    /// Returns whether the step's values are colors rather than scalars.
    pub(crate) fn is_color(&self) -> bool {
        match self {
            Self::Number(_) | Self::Field(_) => false,
            Self::Color(_) | Self::Colors(_) => true,
            Self::Image(laid) => matches!(laid.picture, Picture::Colors(_)),
            Self::Local(Local { color, .. })
            | Self::Moved(Moved { color, .. })
            | Self::Neighborhood(Neighborhood { color, .. })
            | Self::Global(Global { color, .. }) => *color,
        }
    }

    /// Returns whether storing the values of the step has no benefit: a constant is as fast to compute as to copy, and
    /// the image of a global step is stored already.
    pub(super) fn is_ready(&self) -> bool {
        matches!(self, Self::Number(_) | Self::Color(_) | Self::Global(_))
    }

    /// Returns the inputs that are evaluated on the same pixel grid as the step.
    pub(super) fn inputs_at_pixels(&self) -> Vec<usize> {
        match self {
            Self::Moved(moved) => moved.at_same_positions(),
            Self::Global(_) => Vec::new(),
            step => step.inputs(),
        }
    }

    /// Returns the indices of the inputs of the step.
    pub(crate) fn inputs(&self) -> Vec<usize> {
        match self {
            Self::Local(Local { inputs, .. })
            | Self::Neighborhood(Neighborhood { inputs, .. })
            | Self::Global(Global { inputs, .. }) => inputs.clone(),
            Self::Moved(moved) => {
                let mut inputs = vec![moved.input];
                inputs.extend(moved.at_same_positions());
                inputs
            }
            _ => Vec::new(),
        }
    }
}

/// Returns the indices of the steps that must be evaluated at the same positions as `wanted`, in order.
///
/// Four kinds of inputs are excluded: the inputs of moved steps, which are evaluated at other positions; the inputs of
/// neighborhoods, which are evaluated in a larger window; the inputs of steps that depend on the whole tile, which are
/// evaluated beforehand; and the inputs of known steps.
pub(super) fn needed(
    steps: &[Step],
    wanted: &[usize],
    is_known: impl Fn(usize) -> bool,
) -> Vec<usize> {
    reached(steps, wanted, |index| match &steps[index] {
        _ if is_known(index) => Vec::new(),
        Step::Neighborhood(_) => Vec::new(),
        step => step.inputs_at_pixels(),
    })
}

/// Returns the steps that need an image of the whole tile, in order: global steps, and neighborhoods that a moved step
/// reads at positions other than pixel centers.
pub(super) fn needed_wholes(steps: &[Step], wanted: &[usize]) -> Vec<usize> {
    let mut at_pixels = vec![false; steps.len()];
    let mut at_positions = vec![false; steps.len()];
    let mut wholes = Vec::new();
    wanted.iter().for_each(|&index| at_pixels[index] = true);
    for index in (0..steps.len()).rev() {
        if !at_pixels[index] && !at_positions[index] {
            continue;
        }
        let step = &steps[index];
        let is_image = match step {
            Step::Global(_) => true,
            Step::Neighborhood(_) => at_positions[index],
            _ => false,
        };
        if is_image {
            wholes.push(index);
        }
        if let Step::Moved(moved) = step {
            at_positions[moved.input] = true;
        }
        let inputs = match step {
            Step::Moved(moved) => moved.at_same_positions(),
            step => step.inputs(),
        };
        // The inputs of an image are evaluated at its pixels.
        let is_at_pixels = at_pixels[index] || is_image;
        let is_at_positions = at_positions[index] && !is_image;
        for input in inputs {
            at_pixels[input] |= is_at_pixels;
            at_positions[input] |= is_at_positions;
        }
    }
    wholes.reverse();
    wholes
}

/// Returns whether a step depends on an image, whose pixels end at the sides of the tile. Images are image files,
/// global steps, and neighborhoods that are read between pixels.
pub(super) fn reads_images(steps: &[Step], step: usize) -> bool {
    let mut ancestors = reached(steps, &[step], |index| steps[index].inputs()).into_iter();
    ancestors.any(|index| matches!(steps[index], Step::Image(_)))
        || !needed_wholes(steps, &[step]).is_empty()
}

/// Returns the steps reachable from `wanted`, in order. `leads_to` returns the edges of a step, which point to earlier
/// steps only.
fn reached(steps: &[Step], wanted: &[usize], leads_to: impl Fn(usize) -> Vec<usize>) -> Vec<usize> {
    let mut reached = vec![false; steps.len()];
    wanted.iter().for_each(|&index| reached[index] = true);
    for index in (0..steps.len()).rev() {
        if reached[index] {
            for input in leads_to(index) {
                reached[input] = true;
            }
        }
    }
    (0..steps.len()).filter(|&index| reached[index]).collect()
}

/// Returns the steps that both `wanted` and `of_height` depend on, except steps that are cheap to recompute.
pub(super) fn shared(steps: &[Step], of_height: &[usize], wanted: &[usize]) -> Vec<usize> {
    let of_height = needed(steps, of_height, |_| false);
    let is_shared =
        |index: usize| !steps[index].is_ready() && of_height.binary_search(&index).is_ok();
    let mut shared = needed(steps, wanted, is_shared);
    shared.retain(|&index| is_shared(index));
    shared
}
