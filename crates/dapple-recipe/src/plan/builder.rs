//! Builds the steps of nodes, and gives the nodes access to the tile, the seed and their inputs.

use super::cache::{PlanCache, StepId};
use super::neighborhood::{Neighborhood, Surroundings};
use super::step::{Global, Local, Moved, Positions, Step, Tile, reads_images};
use super::work::{Work, WorkSum};
use super::{ImageSource, Images, Picture, Plan, PlanLimits, RELIEF, Watch, not_a_number, order};
use crate::text::is_data;
use crate::{Input, Node, NodeSeed, Recipe, RecipeError, RecipeErrorKind, Values};
use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_points::Domain;
use dapple_raster::{Parts, Wrap};
use dapple_raster::{Range, range};
use glam::DVec2;
use indexmap::IndexMap;
use std::cell::Cell;
use std::fmt::Write as _;

/// Builds the steps of all nodes, in topological order.
pub(crate) struct Builder<'a> {
    recipe: &'a Recipe,
    images: &'a Images,
    time: f64,
    /// The name of the current node.
    node: &'a str,
    work: WorkSum<'a>,
    cache: Option<&'a PlanCache>,
    watch: &'a Watch,
    /// Reusable parts of steps, from this plan and, if there is a cache, from earlier plans.
    pub(super) parts: Parts,
    /// Whether the current node has read the time.
    asks_time: Cell<bool>,
    /// Names of the nodes that have read the time, and so change during an animation.
    pub(super) moving: Vec<String>,
    pub(super) steps: Vec<Step>,
    /// The id of each step; empty without a cache.
    pub(super) ids: Vec<StepId>,
    pub(super) names: IndexMap<String, usize>,
}

/// The allowed range of a frequency, in cells or bumps per unit of the plane.
pub(crate) const FREQUENCY: Range = range!(above 0 to 1e6);

/// The allowed range of a radius, in units of the plane. It is also at most the longer side of the tile.
pub(crate) const RADIUS: Range = range!(above 0 to 1e6);

impl<'a> Builder<'a> {
    pub(crate) fn new(
        recipe: &'a Recipe,
        images: &'a Images,
        time: f64,
        limits: &'a PlanLimits,
        cache: Option<&'a PlanCache>,
        watch: &'a Watch,
    ) -> Self {
        Self {
            recipe,
            images,
            time,
            node: "",
            work: WorkSum::new(limits),
            cache,
            watch,
            parts: cache.map_or_else(Parts::keeping, |cache| cache.parts().clone()),
            asks_time: Cell::new(false),
            moving: Vec::new(),
            steps: Vec::new(),
            ids: Vec::new(),
            names: IndexMap::new(),
        }
    }

    /// Adds a node's step. The steps of its inputs must have been added already.
    pub(super) fn add(&mut self, name: &'a str, node: &Node) -> Result<(), RecipeError> {
        self.enter(name, node)?;
        // Take the step from the cache, or build it and see whether it reads the time.
        let before = self.cache.and_then(|cache| self.id_in(cache, node));
        let known = before.and_then(|(id, _)| self.cache?.source(id));
        self.asks_time.set(false);
        let is_known = known.is_some();
        let step = match known {
            Some(step) => step,
            None => node.kind().build(self)?,
        };
        // Choose the id under which the step is cached. The id of a step that reads the time includes the time.
        let id = self.cache.map(|cache| match before {
            None => cache.new_id(),
            Some((id, false)) if self.asks_time.get() => cache.at_time(id, self.time),
            Some((id, _)) => id,
        });
        if self.asks_time.get() || before.is_some_and(|(_, is_timed)| is_timed) {
            self.moving.push(name.to_owned());
        }
        if let (Some(cache), Some(id), false) = (self.cache, id, is_known) {
            cache.keep_source(id, &step);
        }
        self.names.insert(name.to_owned(), self.steps.len());
        self.push(step, id);
        Ok(())
    }

    fn push(&mut self, step: Step, id: Option<StepId>) {
        self.steps.push(step);
        self.ids.extend(id);
    }

    /// Returns the id of a node's key in the cache, and whether the key includes the time; `None` if the node has no
    /// key.
    fn id_in(&self, cache: &PlanCache, node: &Node) -> Option<(StepId, bool)> {
        // Options that cannot be written as data, such as functions, cannot be compared; such a node has no key.
        if !is_data(node) {
            return None;
        }
        let Recipe {
            seed, extent, wrap, ..
        } = self.recipe;
        let mut text = format!("{} {extent:?} {wrap:?} {:?} ", seed.0, self.node);
        for input in node.inputs() {
            if let Some(name) = input.node() {
                write!(text, "{} ", self.ids.get(*self.names.get(name)?)?).ok()?;
            }
        }
        for source in node.image_sources() {
            let picture = source.picture(self.images)?;
            write!(text, "image {} ", cache.picture_id(picture)).ok()?;
        }
        if node.kind().reads_relief() {
            write!(text, "relief {:?} ", self.recipe.material.relief).ok()?;
        }
        write!(text, "{node:?}").ok()?;
        let id = cache.id(text);
        Some(match cache.is_timed(id) {
            true => (cache.at_time(id, self.time), true),
            false => (id, false),
        })
    }

    /// Sets the current node. Fails if its work exceeds the limits.
    pub(crate) fn enter(&mut self, name: &'a str, node: &Node) -> Result<(), RecipeError> {
        self.node = name;
        let work: Work = node.kind().work(self)?;
        self.work.add(&work)
    }

    /// Reports progress to the caller's callback.
    pub(crate) fn watch(&self) -> &'a Watch {
        self.watch
    }

    /// Reuses the parts of an existing plan, such as its nets of control points.
    pub(crate) fn with_parts_of(mut self, plan: &Plan) -> Self {
        self.parts = plan.parts.clone();
        self
    }

    /// Returns reusable parts of steps, such as control nets, from this plan and, if there is a cache, from earlier
    /// plans.
    pub(crate) fn parts(&self) -> &Parts {
        &self.parts
    }

    /// Returns the phase of the looping animation, from 0 to 1, and records that the current node reads it.
    pub(crate) fn time(&self) -> f64 {
        self.asks_time.set(true);
        self.time
    }

    /// Returns, for each axis, whether the tile is repeated or clamped past its sides.
    pub(crate) fn wrap(&self) -> [Wrap; 2] {
        wrap(self.recipe.wrap)
    }

    /// Returns the tile as a domain.
    pub(crate) fn domain(&self) -> Domain {
        Domain {
            origin: DVec2::ZERO,
            size: self.recipe.extent.into(),
            wrap: self.recipe.wrap,
        }
    }

    /// Returns the image called `file`.
    pub(crate) fn image(&self, file: &str) -> Result<&'a Picture, RecipeError> {
        self.layer_of(file, None)
    }

    /// Returns the image called `file`, or one of its layers.
    pub(crate) fn layer_of(
        &self,
        file: &str,
        layer: Option<&str>,
    ) -> Result<&'a Picture, RecipeError> {
        let alpha = None;
        let source = ImageSource { file, layer, alpha };
        source.picture(self.images).ok_or_else(|| {
            let file = file.to_owned();
            RecipeError::new(RecipeErrorKind::NoImage { file })
        })
    }

    /// Returns the current node's seed, which is derived from its name unless `other` is given.
    pub(crate) fn seed(&self, other: Option<&NodeSeed>) -> Seed {
        seed_of(self.recipe, self.node, other)
    }

    /// Returns, for each axis that repeats, the number of cells across the tile at this frequency; `None` for the other
    /// axes.
    pub(crate) fn periods(&self, frequency: [f64; 2]) -> Result<[Option<u32>; 2], RecipeError> {
        let mut periods = [None; 2];
        for axis in 0..2 {
            RecipeError::check_in(FREQUENCY, "frequency", frequency[axis])?;
            if self.recipe.wrap[axis] {
                let cells = self.recipe.extent[axis] * frequency[axis];
                let whole = cells >= 1.0 && cells.fract() == 0.0 && cells <= f64::from(u32::MAX);
                let range =
                    "a whole number, at least 1 (extent times frequency, since the recipe repeats)";
                let what = "number of cells along a side of the tile";
                RecipeError::check(whole, what, cells, range)?;
                periods[axis] = Some(cells as u32);
            }
        }
        Ok(periods)
    }

    /// Returns the name and the node of an input; `None` for a constant.
    pub(crate) fn node_of(
        &self,
        input: &Input,
    ) -> Result<Option<(&'a str, &'a Node)>, RecipeError> {
        let Some(name) = input.node() else {
            return Ok(None);
        };
        let found = self.recipe.nodes.get_key_value(name);
        let (name, node) = found.ok_or_else(|| order::unknown(self.recipe, name))?;
        Ok(Some((name, node)))
    }

    /// Calls `build` with the node called `name` as the current node, so that its seed is used.
    pub(crate) fn as_node<T>(&mut self, name: &'a str, build: impl FnOnce(&mut Self) -> T) -> T {
        let own = core::mem::replace(&mut self.node, name);
        let built = build(self);
        self.node = own;
        built
    }

    /// Returns a step for an input that is a number or a color. A node as input is an error.
    pub(crate) fn constant(&mut self, input: &Input) -> Result<Step, RecipeError> {
        let index = self.any(input)?;
        Ok(self.local(vec![index], |inputs| Ok(inputs[0].clone())))
    }

    /// Returns the index of an input's step, whose values are scalars or colors. Adds a step if the input is a
    /// constant.
    pub(crate) fn any(&mut self, input: &Input) -> Result<usize, RecipeError> {
        let step = match input {
            Input::Number(number) => {
                let finite = (*number as f32).is_finite();
                RecipeError::check(finite, "number", *number, "finite in single precision")?;
                Step::Number(*number as f32)
            }
            Input::Color(color) => Step::Color(*color),
            Input::Node(name) => {
                let known = self.names.get(name).copied();
                return known.ok_or_else(|| order::unknown(self.recipe, name));
            }
        };
        let id = self.cache.map(|cache| cache.id(format!("{step:?}")));
        self.push(step, id);
        Ok(self.steps.len() - 1)
    }

    /// Returns the index of an input's step. Fails if its values are colors.
    pub(crate) fn number(&mut self, input: &Input) -> Result<usize, RecipeError> {
        let step = self.any(input)?;
        if self.is_color(step) {
            return Err(not_a_number(input));
        }
        Ok(step)
    }

    /// Returns whether a step's values are colors.
    pub(crate) fn is_color(&self, step: usize) -> bool {
        self.steps[step].is_color()
    }

    /// Adds a step that combines the values of the inputs at each position. Its values are colors if any input's values
    /// are colors.
    pub(crate) fn local(
        &self,
        inputs: Vec<usize>,
        apply: impl Fn(&[&Values]) -> Result<Values, RecipeError> + Send + Sync + 'static,
    ) -> Step {
        Step::Local(Local {
            color: inputs.iter().any(|&input| self.is_color(input)),
            inputs,
            apply: Box::new(apply),
        })
    }

    /// Builds a step that combines the inputs over the whole tile. It has colors if any input has colors. The inputs
    /// are rendered at the size of the tile divided by `copies`.
    pub(crate) fn global(
        &self,
        inputs: Vec<usize>,
        copies: [u32; 2],
        apply: impl Fn(&Tile<'_>) -> Result<Values, RecipeError> + Send + Sync + 'static,
    ) -> Step {
        Step::Global(Global {
            color: inputs.iter().any(|&input| self.is_color(input)),
            inputs,
            copies,
            apply: Box::new(apply),
        })
    }

    /// Builds a step that combines the inputs within a halo around each pixel. It has colors if any input has colors.
    /// `halo` gives the columns and rows of the halo for a width and height of pixels in units of the plane.
    ///
    /// Past the sides of a tile that does not repeat, images repeat their outermost pixels.
    pub(crate) fn neighborhood(
        &self,
        inputs: Vec<usize>,
        halo: impl Fn(DVec2) -> [u32; 2] + Send + Sync + 'static,
        apply: impl Fn(&Surroundings<'_>) -> Result<Values, RecipeError> + Send + Sync + 'static,
    ) -> Step {
        Step::Neighborhood(Neighborhood {
            color: inputs.iter().any(|&input| self.is_color(input)),
            inputs,
            node: self.node.to_owned(),
            ends: [None; 2],
            limits: *self.work.limits,
            halo: Box::new(halo),
            apply: Box::new(apply),
        })
    }

    /// Builds a step that computes numbers from the heights within a halo around each pixel. Past the sides of a tile
    /// that does not repeat, the heights of images are extrapolated, as in the maps of a bake.
    pub(crate) fn neighborhood_of_heights(
        &self,
        input: usize,
        halo: impl Fn(DVec2) -> [u32; 2] + Send + Sync + 'static,
        apply: impl Fn(&Surroundings<'_>) -> Result<Values, RecipeError> + Send + Sync + 'static,
    ) -> Step {
        let Recipe { extent, wrap, .. } = self.recipe;
        let mut step = self.neighborhood(vec![input], halo, apply);
        if let Step::Neighborhood(neighborhood) = &mut step
            && reads_images(&self.steps, input)
        {
            neighborhood.ends = [0, 1].map(|axis| (!wrap[axis]).then_some(extent[axis]));
        }
        step
    }

    /// Returns `radius`, by default `part` times the tile's shorter side. Fails unless it is above 0 and at most the
    /// tile's longer side.
    pub(crate) fn radius(&self, radius: Option<f64>, part: f64) -> Result<f64, RecipeError> {
        let extent = DVec2::from(self.recipe.extent);
        let radius = radius.unwrap_or(part * extent.min_element());
        let range = "above 0 and at most the longer side of the tile";
        let holds = RADIUS.holds(radius) && radius <= extent.max_element();
        RecipeError::check(holds, "radius", radius, range)?;
        Ok(radius)
    }

    /// Returns `relief`, or by default the relief of the material.
    pub(crate) fn relief(&self, relief: Option<f64>) -> Result<f64, RecipeError> {
        let relief = relief.unwrap_or(self.recipe.material.relief);
        RecipeError::check_in(RELIEF, "relief", relief)?;
        Ok(relief)
    }

    /// Builds a step that evaluates an input at the positions that a map returns.
    pub(crate) fn folded(
        &mut self,
        input: &Input,
        map: impl Fn([f64; 2]) -> [f64; 2] + Send + Sync + 'static,
    ) -> Result<Step, RecipeError> {
        let input = self.any(input)?;
        Ok(Step::Moved(Moved {
            input,
            color: self.is_color(input),
            positions: Positions::Folded(Box::new(map)),
        }))
    }

    /// Builds a step that applies a function to the numbers of an input.
    pub(crate) fn each(
        &mut self,
        input: &Input,
        change: impl Fn(f32) -> f32 + Send + Sync + 'static,
    ) -> Result<Step, RecipeError> {
        let inputs = vec![self.number(input)?];
        Ok(self.local(inputs, move |inputs| {
            let numbers = inputs[0].numbers().iter();
            Ok(Values::Numbers(
                numbers.map(|&number| change(number)).collect(),
            ))
        }))
    }

    /// Builds a step that combines the numbers of the inputs pairwise, from the first to the last.
    pub(crate) fn fold(
        &mut self,
        inputs: &[Input],
        combine: impl Fn(f32, f32) -> f32 + Send + Sync + 'static,
    ) -> Result<Step, RecipeError> {
        let inputs = inputs.iter().map(|input| self.number(input));
        let inputs = at_least_one(inputs.collect::<Result<_, _>>()?)?;
        Ok(self.local(inputs, move |inputs| {
            Ok(Values::fold(inputs, &combine, |first, _| first))
        }))
    }

    /// Builds a step that combines the numbers or colors of the inputs pairwise, from the first to the last.
    pub(crate) fn fold_any(
        &mut self,
        inputs: &[Input],
        combine: impl Fn(f32, f32) -> f32 + Send + Sync + 'static,
        combine_colors: impl Fn(LinearRgb, LinearRgb) -> LinearRgb + Send + Sync + 'static,
    ) -> Result<Step, RecipeError> {
        let inputs = inputs.iter().map(|input| self.any(input));
        let inputs = at_least_one(inputs.collect::<Result<_, _>>()?)?;
        Ok(self.local(inputs, move |inputs| {
            Ok(Values::fold(inputs, &combine, &combine_colors))
        }))
    }
}

/// Returns the seed of the node called `node`, which is derived from its name unless `other` is given.
pub(crate) fn seed_of(recipe: &Recipe, node: &str, other: Option<&NodeSeed>) -> Seed {
    match other {
        None => recipe.seed.child(node, 0),
        Some(NodeSeed::Name(name)) => recipe.seed.child(name, 0),
        Some(NodeSeed::Seed(seed)) => *seed,
    }
}

/// Returns, for each axis, how the tile continues past its sides: repeated, or clamped.
pub(super) fn wrap(repeats: [bool; 2]) -> [Wrap; 2] {
    repeats.map(|repeats| if repeats { Wrap::Repeat } else { Wrap::Clamp })
}

/// Returns `inputs`; an error if the list is empty.
pub(crate) fn at_least_one<T>(inputs: Vec<T>) -> Result<Vec<T>, RecipeError> {
    if inputs.is_empty() {
        let (what, count, needed) = ("inputs", 0, "at least 1");
        return Err(RecipeError::new(RecipeErrorKind::Count {
            what,
            count,
            needed,
        }));
    }
    Ok(inputs)
}
