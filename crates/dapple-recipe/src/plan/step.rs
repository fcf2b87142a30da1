//! The steps of a plan, and how nodes become steps.

use super::generate::Generator;
use super::{Images, Picture, not_a_number, order};
use crate::operation::Operation;
use crate::{Input, Node, Recipe, RecipeError, RecipeErrorKind};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_hash::Seed;
use dapple_pups::VectorTexture;
use dapple_raster::Field;
use dapple_tile::{Blend, BlendMap, Disturbance, MatchBorders, Mixing, Seamless};
use glam::DVec2;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// What makes the values of a node. Inputs are the indices of earlier steps.
pub(crate) enum Step {
    Number(f32),
    Color(LinearRgb),
    Field(Arc<dyn Field>),
    Image(Laid),
    ColorNoise(Box<VectorTexture<3>>),
    /// Each value is made of the values of the inputs at the same position.
    Local(Operation, Vec<usize>, bool),
    Warp {
        input: usize,
        by: [usize; 2],
        amount: f64,
        color: bool,
    },
    /// Each value is made of all values of the inputs, over the whole tile.
    Global(Global, Vec<usize>, bool),
}

/// An image that lies over the tile.
#[derive(Clone, Debug)]
pub(crate) struct Laid {
    pub(crate) picture: Picture,
    pub(crate) extent: DVec2,
    pub(crate) wrap: [dapple_raster::Wrap; 2],
}

/// What sees the whole tile.
#[derive(Clone, Debug)]
pub(crate) enum Global {
    Tile(Seamless),
    /// The size of features is in units of the plane.
    BlendMap(BlendMap, f64),
    Blend(Layers),
    /// As many copies along each axis as are given.
    Disturb(Disturbance, [u32; 2]),
    MatchBorders(MatchBorders),
    CornerTiles(Corners),
}

/// What a board of corner tiles knows beside its inputs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    pub(crate) seed: Seed,
    pub(crate) copies: [u32; 2],
    pub(crate) width: f64,
}

/// What a blend knows beside its inputs.
#[derive(Clone, Debug)]
pub(crate) struct Layers {
    pub(crate) how: Blend,
    /// For each layer, whether it has a height.
    pub(crate) heights: Vec<bool>,
    pub(crate) mask: bool,
}

impl fmt::Debug for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => f.debug_tuple("Number").field(number).finish(),
            Self::Color(color) => f.debug_tuple("Color").field(color).finish(),
            Self::Field(_) => f.write_str("Field"),
            Self::Image(_) => f.write_str("Image"),
            Self::ColorNoise(_) => f.write_str("ColorNoise"),
            Self::Local(_, inputs, _) => f.debug_tuple("Local").field(inputs).finish(),
            Self::Warp { input, by, .. } => f.debug_tuple("Warp").field(input).field(by).finish(),
            Self::Global(_, inputs, _) => f.debug_tuple("Global").field(inputs).finish(),
        }
    }
}

impl Step {
    /// Whether it makes colors, not numbers.
    pub(crate) fn is_color(&self) -> bool {
        match self {
            Self::Number(_) | Self::Field(_) => false,
            Self::Color(_) | Self::ColorNoise(_) => true,
            Self::Image(laid) => matches!(laid.picture, Picture::Colors(_)),
            Self::Local(_, _, color) | Self::Warp { color, .. } | Self::Global(_, _, color) => {
                *color
            }
        }
    }

    /// The steps that it is made of.
    pub(crate) fn inputs(&self) -> Vec<usize> {
        match self {
            Self::Local(_, inputs, _) | Self::Global(_, inputs, _) => inputs.clone(),
            Self::Warp { input, by, .. } => vec![*input, by[0], by[1]],
            _ => Vec::new(),
        }
    }
}

/// The steps that are needed for others, in their order. What a warp asks elsewhere is not needed here, and what sees the
/// whole tile has been evaluated before; nor is what only those need that are known.
pub(super) fn needed(
    steps: &[Step],
    wanted: &[usize],
    is_known: impl Fn(usize) -> bool,
) -> Vec<usize> {
    let mut needed = vec![false; steps.len()];
    wanted.iter().for_each(|&index| needed[index] = true);
    for index in (0..steps.len()).rev() {
        if needed[index] && !is_known(index) {
            match &steps[index] {
                Step::Warp { by, .. } => by.iter().for_each(|&input| needed[input] = true),
                Step::Global(..) => {}
                step => step
                    .inputs()
                    .into_iter()
                    .for_each(|input| needed[input] = true),
            }
        }
    }
    (0..steps.len()).filter(|&index| needed[index]).collect()
}

/// Makes steps of nodes, one after the other.
pub(super) struct Builder<'a> {
    recipe: &'a Recipe,
    generator: Generator<'a>,
    steps: Vec<Step>,
    names: BTreeMap<&'a str, usize>,
}

impl<'a> Builder<'a> {
    pub(super) fn new(recipe: &'a Recipe, images: &'a Images, time: f64) -> Self {
        Self {
            recipe,
            generator: Generator {
                recipe,
                images,
                time,
            },
            steps: Vec::new(),
            names: BTreeMap::new(),
        }
    }

    pub(super) fn into_steps(self) -> Vec<Step> {
        self.steps
    }

    pub(super) fn generator(&self) -> &Generator<'a> {
        &self.generator
    }

    /// The step of a node all of whose inputs have steps.
    pub(super) fn node(&mut self, name: &'a str, node: &'a Node) -> Result<usize, RecipeError> {
        let step = match node {
            Node::Worley(worley) => Step::Field(self.generator.worley(name, worley)?),
            Node::Pups(pups) => self.generator.pups(name, pups)?,
            Node::Wavelet(wavelet) => Step::Field(self.generator.wavelet(name, wavelet)?),
            Node::Noise(noise) => Step::Field(self.generator.noise(name, noise)?),
            Node::Coordinate(coordinate) => Step::Field(self.generator.coordinate(coordinate)?),
            Node::Distance(distance) => Step::Field(self.generator.distance(distance)?),
            Node::Image(image) => self.image(&image.file)?,
            Node::Color(color) => Step::Color(*color),
            Node::Warp(warp) => {
                RecipeError::check(warp.amount.is_finite(), "amount", warp.amount, "finite")?;
                let input = self.any(&warp.input)?;
                Step::Warp {
                    input,
                    by: [self.number(&warp.x)?, self.number(&warp.y)?],
                    amount: warp.amount,
                    color: self.steps[input].is_color(),
                }
            }
            Node::Tile(tile) => {
                let seamless = Seamless {
                    method: tile.method,
                    axes: tile.axes,
                };
                self.global(Global::Tile(seamless), &[&tile.input], &[])?
            }
            Node::Disturb(node) => self.disturb(name, node)?,
            Node::MatchBorders(node) => {
                let inputs = [&node.border, &node.input];
                self.global(Global::MatchBorders(node.options), &inputs, &[])?
            }
            Node::CornerTiles(node) => self.corner_tiles(name, node)?,
            Node::BlendMap(map) => {
                let input = self.any(&map.input)?;
                let how = BlendMap::new(32.0)
                    .with_contrast(map.contrast)
                    .with_wrap(self.generator.wrap());
                Step::Global(Global::BlendMap(how, map.feature_size), vec![input], false)
            }
            Node::Blend(blend) => self.blend(blend)?,
            _ => self.operation(node)?,
        };
        self.steps.push(step);
        let index = self.steps.len() - 1;
        self.names.insert(name, index);
        Ok(index)
    }

    /// The step of an input that may be a color.
    pub(super) fn any(&mut self, input: &Input) -> Result<usize, RecipeError> {
        let step = match input {
            Input::Number(number) => {
                let finite = (*number as f32).is_finite();
                RecipeError::check(finite, "number", *number, "finite in single precision")?;
                Step::Number(*number as f32)
            }
            Input::Color(color) => Step::Color(*color),
            Input::Node(name) => {
                let known = self.names.get(name.as_str()).copied();
                return known.ok_or_else(|| order::unknown(self.recipe, name));
            }
        };
        self.steps.push(step);
        Ok(self.steps.len() - 1)
    }

    /// The step of an input that must be a number.
    pub(super) fn number(&mut self, input: &Input) -> Result<usize, RecipeError> {
        let step = self.any(input)?;
        if self.steps[step].is_color() {
            return Err(not_a_number(input));
        }
        Ok(step)
    }

    fn image(&self, file: &str) -> Result<Step, RecipeError> {
        let picture = self.generator.image(file)?;
        Ok(Step::Image(Laid {
            picture: picture.clone(),
            extent: self.recipe.extent.into(),
            wrap: self.generator.wrap(),
        }))
    }

    /// A step that works on each position alone.
    fn operation(&mut self, node: &Node) -> Result<Step, RecipeError> {
        let operation = match node {
            Node::Add(_) => Operation::Add,
            Node::Subtract(_) => Operation::Subtract,
            Node::Multiply(_) => Operation::Multiply,
            Node::Divide(_) => Operation::Divide,
            Node::Minimum(_) => Operation::Minimum,
            Node::Maximum(_) => Operation::Maximum,
            Node::Absolute(_) => Operation::Absolute,
            Node::Power(power) => Operation::power(power)?,
            Node::Wave(wave) => Operation::wave(wave)?,
            Node::Levels(levels) => Operation::levels(levels)?,
            Node::Profile(profile) => Operation::profile(profile.shape)?,
            Node::Mix(_) => Operation::Mix,
            Node::Ramp(ramped) => Operation::Ramp(ramp(ramped)?),
            _ => unreachable!("all other nodes were made above"),
        };
        let inputs = node.inputs();
        if inputs.is_empty() {
            return Err(RecipeError::new(RecipeErrorKind::Count {
                what: "inputs",
                count: 0,
                needed: "at least 1",
            }));
        }
        let mut steps = Vec::with_capacity(inputs.len());
        for (index, input) in inputs.into_iter().enumerate() {
            steps.push(if operation.takes_color(index) {
                self.any(input)?
            } else {
                self.number(input)?
            });
        }
        let color =
            operation.makes_color() || steps.iter().any(|&step| self.steps[step].is_color());
        Ok(Step::Local(operation, steps, color))
    }

    /// A step that sees all values of its inputs, of which the first ones may be colors.
    fn global(
        &mut self,
        global: Global,
        any: &[&Input],
        numbers: &[&Input],
    ) -> Result<Step, RecipeError> {
        let mut steps = Vec::new();
        for input in any {
            steps.push(self.any(input)?);
        }
        let color = steps.iter().any(|&step| self.steps[step].is_color());
        for input in numbers {
            steps.push(self.number(input)?);
        }
        Ok(Step::Global(global, steps, color))
    }

    fn disturb(&mut self, name: &str, node: &crate::Disturbed) -> Result<Step, RecipeError> {
        check_copies(node.copies)?;
        let disturbance = Disturbance {
            frozen: node.frozen,
            margin: node.margin,
            seed: self.generator.seed(name, node.seed.as_ref()),
        };
        self.global(
            Global::Disturb(disturbance, node.copies),
            &[&node.input],
            &[],
        )
    }

    fn corner_tiles(
        &mut self,
        name: &str,
        node: &crate::CornerTilesOf,
    ) -> Result<Step, RecipeError> {
        check_copies(node.copies)?;
        let count = node.inputs.len();
        if !(2..=4).contains(&count) {
            return Err(RecipeError::new(RecipeErrorKind::Count {
                what: "inputs",
                count,
                needed: "2 to 4",
            }));
        }
        let corners = Corners {
            seed: self.generator.seed(name, node.seed.as_ref()),
            copies: node.copies,
            width: node.width,
        };
        let inputs: Vec<_> = node.inputs.iter().collect();
        self.global(Global::CornerTiles(corners), &inputs, &[])
    }

    fn blend(&mut self, blend: &crate::Blended) -> Result<Step, RecipeError> {
        let count = blend.layers.len();
        if count == 0 {
            return Err(RecipeError::new(RecipeErrorKind::Count {
                what: "layers",
                count,
                needed: "at least 1",
            }));
        }
        let how = Blend::new(blend.weighting, blend.mixing);
        let heights = blend
            .layers
            .iter()
            .map(|layer| layer.height.is_some())
            .collect();
        let layers = Layers {
            how,
            heights,
            mask: blend.mask.is_some(),
        };
        let any: Vec<_> = blend.layers.iter().map(|layer| &layer.input).collect();
        let numbers: Vec<_> = blend
            .layers
            .iter()
            .map(|layer| &layer.weight)
            .chain(
                blend
                    .layers
                    .iter()
                    .filter_map(|layer| layer.height.as_ref()),
            )
            .chain(&blend.mask)
            .collect();
        let step = self.global(Global::Blend(layers.clone()), &any, &numbers)?;
        Ok(match step {
            // Each pixel on its own, as long as no mean over all is needed.
            Step::Global(_, inputs, color) if blend.mixing == Mixing::Linear => {
                Step::Local(Operation::Blend(layers), inputs, color)
            }
            step => step,
        })
    }
}

/// Refuses no copy at all.
fn check_copies(copies: [u32; 2]) -> Result<(), RecipeError> {
    copies.into_iter().try_for_each(|count| {
        RecipeError::check(count > 0, "number of copies", count.into(), "at least 1")
    })
}

/// The ramp of a node: a palette, or colors of its own.
fn ramp(node: &crate::Ramped) -> Result<ColorRamp, RecipeError> {
    let conflict = |rule| Err(RecipeError::new(RecipeErrorKind::Conflict { rule }));
    let colors = match (node.palette, node.colors.is_empty()) {
        (Some(palette), true) => palette.colors(),
        (None, false) => node.colors.clone(),
        (Some(_), false) => return conflict("a ramp has a `palette` or `colors`, but not both"),
        (None, true) => return conflict("a ramp needs a `palette` or `colors`"),
    };
    let ramp = if node.positions.is_empty() {
        ColorRamp::even(&colors)?
    } else if node.positions.len() == colors.len() {
        let stops = node.positions.iter().zip(colors);
        let stops = stops.map(|(&position, color)| dapple_color::ColorStop { position, color });
        ColorRamp::new(stops.collect::<Vec<_>>())?
    } else {
        return conflict("a ramp has as many `positions` as colors, or none");
    };
    Ok(ramp
        .with_space(node.space)
        .with_interpolation(node.interpolation)
        .with_outside(node.outside))
}
