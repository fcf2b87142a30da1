//! Plans: recipes prepared for evaluation, with names resolved, seeds derived and fields built.
//!
//! Nodes become steps in topological order: the inputs of a step come before it. A window or a list of positions is
//! evaluated in a single pass over the steps. The value of a pixel depends on its position alone, except for two kinds
//! of steps. A neighborhood depends on the pixels around it; its inputs are evaluated in a larger window. A global step
//! depends on the whole tile; [`Plan::whole`] evaluates it beforehand, for all pixels of the tile.

mod builder;
mod cache;
mod evaluate;
mod field;
mod neighborhood;
mod order;
mod renderer;
mod samples;
mod step;
mod watch;
mod whole;
mod work;

#[cfg(feature = "schema")]
pub(crate) use builder::RADIUS;
pub(crate) use builder::{Builder, FREQUENCY, at_least_one, seed_of};
pub use cache::PlanCache;
use cache::StepId;
use evaluate::Grid;
pub(crate) use evaluate::Known;
pub use field::{NodeColors, NodeField};
pub(crate) use neighborhood::{Neighborhood, with_margin};
pub(crate) use order::{is_name, order};
pub use renderer::{Renderer, RendererError};
pub use samples::Samples;
pub(crate) use samples::TileSamples;
pub(crate) use step::{LinearMap, Moved, Positions, Step, StretchedImage};
pub(crate) use watch::{OF_NODE, Pass, Watch};
pub use whole::Whole;
pub use work::PlanLimits;
pub(crate) use work::Work;

use crate::{ImageAlpha, Input, Material, Node, Recipe, RecipeError, RecipeErrorKind, Values};
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_raster::{Parts, Raster, Window};
use dapple_raster::{Range, range};
use dapple_synth::Progress;
use glam::DVec2;
use indexmap::IndexMap;
use std::cell::RefCell;
use std::sync::Arc;
use step::needed_wholes;
use work::check_steps;

/// An image that a recipe reads, or that a plan renders.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// Numbers, without color encoding.
    Numbers(Arc<Raster<f32>>),
    /// Linear colors.
    Colors(Arc<Raster<LinearRgb>>),
}

impl Picture {
    /// Returns the numbers of columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Numbers(numbers) => numbers.size(),
            Self::Colors(colors) => colors.size(),
        }
    }
}

/// A recipe's images by file name. If nodes read several layers of one file, each layer has the key
/// [`ImageSource::key`].
pub type Images = std::collections::BTreeMap<String, Picture>;

/// An image that a recipe's nodes read, which is a file or one of its layers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ImageSource<'a> {
    /// The file name.
    pub file: &'a str,
    /// The layer of an OpenEXR file; `None` unless a node names one.
    pub layer: Option<&'a str>,
    /// How the alpha is handled, if a node sets it.
    pub alpha: Option<ImageAlpha>,
}

impl ImageSource<'_> {
    /// Returns the key of the image in [`Images`]: the file name, followed by NUL and the layer if a layer is named. No
    /// file name contains NUL.
    #[must_use]
    pub fn key(&self) -> String {
        match self.layer {
            Some(layer) => format!("{}\0{layer}", self.file),
            None => self.file.to_owned(),
        }
    }

    /// Looks the image up by its key, then by its file name.
    pub(crate) fn picture<'a>(&self, images: &'a Images) -> Option<&'a Picture> {
        images.get(&self.key()).or_else(|| images.get(self.file))
    }
}

/// A recipe prepared for evaluation.
///
/// # Examples
///
/// ```
/// use dapple_recipe::{Images, Plan, Recipe};
/// use dapple_recipe::raster::{Field, Window};
///
/// let recipe = Recipe::builtin("flagstone")?;
/// let plan = Plan::new(&recipe, &Images::new(), 0.0)?;
/// let height = plan.height()?;
/// let raster = height.to_raster(&plan.window([64, 64])?)?;
/// assert!(raster.pixels().iter().all(|height| (0.0..=1.0).contains(height)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Plan {
    extent: DVec2,
    wrap: [bool; 2],
    steps: Arc<[Step]>,
    names: IndexMap<String, usize>,
    channels: Channels,
    material: Material,
    limits: PlanLimits,
    cache: Option<PlanCache>,
    /// Reusable parts of steps, such as control nets. Shaders are generated from them.
    parts: Parts,
    renderer: Option<Arc<dyn Renderer>>,
    watch: Watch,
    time: f64,
    /// Names of the nodes whose own values change with time. Nodes that change only because of an input are not listed.
    moving: Vec<String>,
    /// Each step's id in the cache; empty without a cache.
    ids: Arc<[StepId]>,
}

/// The indices of the steps that the material's maps read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channels {
    pub(crate) height: usize,
    pub(crate) albedo: usize,
    pub(crate) roughness: usize,
    pub(crate) metallic: usize,
    pub(crate) emission: usize,
    pub(crate) opacity: usize,
    pub(crate) specular: usize,
    pub(crate) clearcoat: usize,
}

impl Channels {
    /// Returns the indices of all steps, in the order of the fields.
    pub(crate) fn steps(&self) -> [usize; 8] {
        [
            self.height,
            self.albedo,
            self.roughness,
            self.metallic,
            self.emission,
            self.opacity,
            self.specular,
            self.clearcoat,
        ]
    }
}

impl Recipe {
    /// Returns the names of the recipe's image files, each once, in the order of its nodes.
    #[must_use]
    pub fn image_files(&self) -> Vec<&str> {
        let mut files = Vec::new();
        for file in self.nodes.values().flat_map(Node::image_files) {
            if !files.contains(&file) {
                files.push(file);
            }
        }
        files
    }

    /// Returns the recipe's images, each once, in the order of its nodes. Each layer of a file counts as an image.
    ///
    /// # Errors
    ///
    /// [`Conflict`](RecipeErrorKind::Conflict) if two nodes handle the alpha of one image differently.
    pub fn image_sources(&self) -> Result<Vec<ImageSource<'_>>, RecipeError> {
        let mut sources: Vec<ImageSource<'_>> = Vec::new();
        for (name, node) in &self.nodes {
            for source in node.image_sources() {
                let is_same = |other: &&ImageSource<'_>| {
                    (other.file, other.layer) == (source.file, source.layer)
                };
                match sources.iter().find(is_same) {
                    Some(other) if other.alpha != source.alpha => {
                        let rule = "nodes that name one image say the same of its `alpha`";
                        let error = RecipeError::new(RecipeErrorKind::Conflict { rule });
                        return Err(error.within(name));
                    }
                    Some(_) => {}
                    None => sources.push(source),
                }
            }
        }
        Ok(sources)
    }
}

impl Plan {
    /// Builds all nodes of the recipe. `time` is the phase of a looping animation, from 0 to 1, for nodes that move.
    ///
    /// # Errors
    ///
    /// If the recipe has unknown names, cycles, colors where numbers are needed, or numbers out of range, or if a
    /// node's crate reports an error. The error names the node. Also [`TooMuch`](RecipeErrorKind::TooMuch) if the work
    /// exceeds the default [`PlanLimits`].
    pub fn new(recipe: &Recipe, images: &Images, time: f64) -> Result<Self, RecipeError> {
        Self::new_within(recipe, images, time, &PlanLimits::default())
    }

    /// Builds all nodes of the recipe if the estimated work is within `limits`.
    ///
    /// # Errors
    ///
    /// Same as [`new`](Self::new), with `limits` instead of the default ones.
    pub fn new_within(
        recipe: &Recipe,
        images: &Images,
        time: f64,
        limits: &PlanLimits,
    ) -> Result<Self, RecipeError> {
        Self::make(recipe, images, time, limits, None, Watch::default())
    }

    /// Builds all nodes of the recipe, and reuses parts of earlier plans from `cache`. This is for programs
    /// that redraw a recipe as it changes. Bakes and node images use the cache, too.
    ///
    /// # Errors
    ///
    /// Same as [`new_within`](Self::new_within).
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_recipe::{Images, PlanCache, Plan, PlanLimits, Recipe};
    ///
    /// let (images, limits, cache) = (Images::new(), PlanLimits::default(), PlanCache::new(1 << 26));
    /// let mut recipe = Recipe::builtin("flagstone")?;
    /// let plan = Plan::new_with_cache(&recipe, &images, 0.0, &limits, &cache)?;
    /// let grain = plan.node_picture("grain", [64, 64], None)?;
    ///
    /// recipe.material.relief = 0.5;
    /// let plan = Plan::new_with_cache(&recipe, &images, 0.0, &limits, &cache)?;
    /// assert_eq!(plan.node_picture("grain", [64, 64], None)?, grain);
    /// # Ok::<(), dapple_recipe::RecipeError>(())
    /// ```
    pub fn new_with_cache(
        recipe: &Recipe,
        images: &Images,
        time: f64,
        limits: &PlanLimits,
        cache: &PlanCache,
    ) -> Result<Self, RecipeError> {
        Self::make(recipe, images, time, limits, Some(cache), Watch::default())
    }

    /// Builds all nodes of the recipe and reports to the callback `progress`, which can stop the work with
    /// [`Cancelled`](RecipeErrorKind::Cancelled). Games load recipes on a thread, show a progress bar and offer to
    /// cancel. The plan stores the callback for its bakes and node images.
    ///
    /// The callback runs on any thread, possibly on several threads at once: at the start, and then at least once per
    /// 50 milliseconds or so of single-core work. Calls are further apart while wavelet noise is built, during a
    /// Delaunay triangulation of points that do not repeat, and during a single pass of a `tile`, `blend` or
    /// `corner_tiles` node over an image of millions of pixels. Once the callback has asked to stop, only threads that
    /// are calling it at that moment still call it.
    ///
    /// There are three passes. The first builds the nodes. The second, in [`Bake::new`](crate::Bake::new), evaluates
    /// the nodes that depend on the whole tile. A node counts as a thousand sites. The third computes the bands of a
    /// bake, where a row counts as a site. [`Progress::part`] is the completed fraction of all work.
    ///
    /// # Errors
    ///
    /// Same as [`new_within`](Self::new_within), or [`Cancelled`](RecipeErrorKind::Cancelled) if `progress` asks to
    /// stop.
    ///
    /// # Examples
    ///
    /// ```
    /// use core::ops::ControlFlow;
    /// use dapple_recipe::{Images, Plan, PlanLimits, Recipe, RecipeErrorKind};
    ///
    /// let (recipe, limits) = (Recipe::builtin("rock")?, PlanLimits::default());
    /// let plan = Plan::new_with_progress(&recipe, &Images::new(), 0.0, &limits, None, |progress| {
    ///     println!("{:.0} %", 100.0 * progress.part());
    ///     ControlFlow::Break(())
    /// });
    /// assert!(matches!(plan.unwrap_err().kind(), RecipeErrorKind::Cancelled));
    /// # Ok::<(), dapple_recipe::RecipeError>(())
    /// ```
    pub fn new_with_progress(
        recipe: &Recipe,
        images: &Images,
        time: f64,
        limits: &PlanLimits,
        cache: Option<&PlanCache>,
        progress: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static,
    ) -> Result<Self, RecipeError> {
        Self::make(recipe, images, time, limits, cache, Watch::by(progress))
    }

    /// Builds all nodes of the recipe, with an optional cache and callback.
    fn make(
        recipe: &Recipe,
        images: &Images,
        time: f64,
        limits: &PlanLimits,
        cache: Option<&PlanCache>,
        watch: Watch,
    ) -> Result<Self, RecipeError> {
        RecipeError::check_in(TIME, "time", time)?;
        for side in recipe.extent {
            RecipeError::check_in(EXTENT, "extent", side)?;
        }
        if let Some(cache) = cache {
            cache.begin();
        }
        // Build the step of each node after its inputs.
        watch.begin(Pass::Nodes, OF_NODE * recipe.nodes.len());
        let mut builder = Builder::new(recipe, images, time, limits, cache, &watch);
        for (index, name) in order(recipe)?.into_iter().enumerate() {
            watch.reach(OF_NODE * index);
            watch.check()?;
            let added = builder.add(name, &recipe.nodes[name]);
            added.map_err(|error| watch.reason(error.within(name)))?;
        }
        // Add the steps that the material reads, such as constants.
        let channels = channels(recipe, &mut builder).map_err(|error| error.within("material"))?;
        let plan = Self {
            extent: recipe.extent.into(),
            wrap: recipe.wrap,
            steps: builder.steps.into(),
            names: builder.names,
            channels,
            material: recipe.material.clone(),
            limits: *limits,
            cache: cache.cloned(),
            parts: builder.parts,
            renderer: None,
            watch: watch.clone(),
            time,
            moving: builder.moving,
            ids: builder.ids.into(),
        };
        check_steps(&plan.steps, limits).map_err(|(step, error)| plan.within(step, error))?;
        Ok(plan)
    }

    /// Sets the progress callback for bakes and node images, which replaces an earlier one: see
    /// [`new_with_progress`](Self::new_with_progress).
    ///
    /// # Examples
    ///
    /// ```
    /// use core::ops::ControlFlow;
    /// use dapple_recipe::{Bake, BakeOptions, Images, Plan, Recipe, RecipeErrorKind};
    ///
    /// let plan = Plan::new(&Recipe::builtin("rock")?, &Images::new(), 0.0)?;
    /// let plan = plan.with_progress(|_| ControlFlow::Break(()));
    /// let mut bake = Bake::new(&plan, &BakeOptions::default())?;
    /// let error = bake.next().expect("a band is left").unwrap_err();
    /// assert!(matches!(error.kind(), RecipeErrorKind::Cancelled));
    /// # Ok::<(), dapple_recipe::RecipeError>(())
    /// ```
    #[must_use]
    pub fn with_progress(
        mut self,
        progress: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static,
    ) -> Self {
        self.watch = Watch::by(progress);
        self
    }

    /// Returns the width and height of the tile, in units of the plane.
    #[must_use]
    pub fn extent(&self) -> DVec2 {
        self.extent
    }

    /// Returns whether a node changes with time. Otherwise, all frames of a loop are equal.
    #[must_use]
    pub fn moves(&self) -> bool {
        !self.moving.is_empty()
    }

    /// Returns whether the plan's time is not 0 and the node itself changes with time.
    pub(crate) fn has_moved(&self, node: &str) -> bool {
        self.time != 0.0 && self.moving.iter().any(|moving| moving == node)
    }

    /// Returns the window that covers the tile with `size` columns and rows. It may have more pixels than a raster can
    /// hold.
    ///
    /// # Errors
    ///
    /// [`Range`](RecipeErrorKind::Range) if a side is zero.
    pub fn window(&self, size: [u32; 2]) -> Result<Window, RecipeError> {
        for side in size {
            RecipeError::check(
                side > 0,
                "number of pixels along a side",
                side.into(),
                "at least 1",
            )?;
        }
        Ok(Window {
            origin: [0.0; 2],
            pixel: (self.extent / DVec2::new(size[0].into(), size[1].into())).into(),
            first: [0, 0],
            size,
            scale: [1.0; 2],
        })
    }

    /// Returns the material's height as a field. If it depends on the neighborhood of pixels, as a blur does, the field
    /// has values in windows and none at single positions.
    ///
    /// # Errors
    ///
    /// [`Global`](RecipeErrorKind::Global) if it depends on a node that needs the whole tile, which has no value at a
    /// single position.
    pub fn height(&self) -> Result<NodeField, RecipeError> {
        self.local(self.channels.height)?;
        Ok(NodeField::new(self.steps.clone(), self.channels.height))
    }

    /// Returns the numbers of the node called `node` as a field.
    ///
    /// # Errors
    ///
    /// [`UnknownNode`](RecipeErrorKind::UnknownNode) if there is no such node,
    /// [`NotANumber`](RecipeErrorKind::NotANumber) if it has colors, or the same errors as [`height`](Self::height).
    pub fn field(&self, node: &str) -> Result<NodeField, RecipeError> {
        let step = self.find(node)?;
        if self.steps[step].is_color() {
            return Err(not_a_number(&Input::from(node)));
        }
        Ok(NodeField::new(self.steps.clone(), step))
    }

    /// Returns the colors of the node called `node` as a function of position. Numbers are converted to grays.
    ///
    /// # Errors
    ///
    /// [`UnknownNode`](RecipeErrorKind::UnknownNode) if there is no such node, or the same errors as
    /// [`height`](Self::height).
    pub fn colors(&self, node: &str) -> Result<NodeColors, RecipeError> {
        Ok(NodeColors::new(self.steps.clone(), self.find(node)?))
    }

    /// Returns the names of the nodes, each after its inputs.
    pub fn node_names(&self) -> impl Iterator<Item = &str> {
        self.names.keys().map(String::as_str)
    }

    /// Returns whether a node's values are colors rather than scalars; false if there is no such node.
    #[must_use]
    pub fn is_color(&self, node: &str) -> bool {
        self.names
            .get(node)
            .is_some_and(|&step| self.steps[step].is_color())
    }

    /// Returns whether a node itself depends on the whole tile, regardless of its inputs.
    #[must_use]
    pub fn is_global(&self, node: &str) -> bool {
        let step = self.names.get(node).map(|&step| &self.steps[step]);
        matches!(step, Some(Step::Global(_)))
    }

    /// Returns the index of a node's step. Fails if the node has no value at a single position.
    fn find(&self, node: &str) -> Result<usize, RecipeError> {
        let step = self.step_of(node)?;
        self.local(step)?;
        Ok(step)
    }

    /// Returns the index of a node's step.
    fn step_of(&self, node: &str) -> Result<usize, RecipeError> {
        self.names.get(node).copied().ok_or_else(|| {
            let name = node.to_owned();
            let names = self.names.keys().map(String::as_str);
            RecipeError::new(RecipeErrorKind::UnknownNode { name }).meant(node, names)
        })
    }

    /// Returns an error if a step depends on the whole tile, directly or through an input.
    fn local(&self, step: usize) -> Result<(), RecipeError> {
        let Some(&global) = needed_wholes(&self.steps, &[step]).first() else {
            return Ok(());
        };
        let during = "at single positions";
        Err(self.within(global, RecipeError::new(RecipeErrorKind::Global { during })))
    }

    /// Computes the values of the steps `wanted` at the pixels of a window, in the order of `wanted`. Runs on all cores
    /// if the feature `rayon` is enabled. Nodes that the renderer supports are passed to it. `known` holds values that
    /// the caller has already computed.
    pub(crate) fn values(
        &self,
        whole: &Whole,
        window: &Window,
        wanted: &[usize],
        known: &Known,
    ) -> Result<Vec<Values>, RecipeError> {
        match &self.renderer {
            None => self.own_values(whole, window, wanted, known),
            Some(renderer) => self.values_by(&**renderer, whole, window, wanted, known),
        }
    }

    /// Computes the values of steps without the renderer.
    fn own_values(
        &self,
        whole: &Whole,
        window: &Window,
        wanted: &[usize],
        known: &Known,
    ) -> Result<Vec<Values>, RecipeError> {
        match &self.cache {
            None => neighborhood::window(&self.steps, Some(whole), grid(window), wanted, known),
            Some(cache) => self.values_with(cache, whole, window, wanted, known),
        }
    }

    /// Computes the values of steps; reads stored values from the cache, and stores new ones in it.
    fn values_with(
        &self,
        cache: &PlanCache,
        whole: &Whole,
        window: &Window,
        wanted: &[usize],
        known: &Known,
    ) -> Result<Vec<Values>, RecipeError> {
        let is_kept = |index: usize| {
            !matches!(
                self.steps[index],
                Step::Number(_) | Step::Color(_) | Step::Global(_)
            )
        };
        // Take the needed steps in order, and look each up in the cache. The inputs of a step found there are not
        // needed.
        let mut known = known.to_vec();
        let found = RefCell::new(Vec::new());
        let order = step::needed(&self.steps, wanted, |index| {
            let is_known = known.iter().any(|(known, _)| *known == index);
            let values = (!is_known && is_kept(index))
                .then(|| cache.values(self.ids[index], window))
                .flatten();
            let is_found = values.is_some();
            found
                .borrow_mut()
                .extend(values.map(|values| (index, (*window, values))));
            is_known || is_found
        });
        known.append(&mut found.into_inner());
        // Evaluate the other steps, and store their values unless they would evict most of the cache.
        let is_new =
            |index: &usize| is_kept(*index) && !known.iter().any(|(known, _)| known == index);
        let fresh: Vec<_> = order.into_iter().filter(is_new).collect();
        if !cache.has_room(fresh.len(), window) {
            return neighborhood::window(&self.steps, Some(whole), grid(window), wanted, &known);
        }
        let all = [wanted, &fresh].concat();
        let mut values =
            neighborhood::window(&self.steps, Some(whole), grid(window), &all, &known)?;
        for (&index, values) in fresh.iter().zip(values.drain(wanted.len()..)) {
            cache.keep(self.ids[index], window, Arc::new(values));
        }
        Ok(values)
    }

    /// Returns the steps that both `wanted` and the height depend on. Callers store the values of these steps to avoid
    /// computing them twice.
    pub(crate) fn shared_with_height(&self, wanted: &[usize]) -> Vec<usize> {
        let [of_height, wanted] =
            [&[self.channels.height][..], wanted].map(|steps| self.own_steps(steps));
        step::shared(&self.steps, &of_height, &wanted)
    }

    /// Returns, for each axis, whether heights past the sides of the tile must be extrapolated.
    ///
    /// Extrapolation is needed if the recipe does not repeat along the axis and the height depends on an image, which
    /// ends at the sides of the tile. Heights computed from functions alone are known everywhere.
    pub(crate) fn continues_heights(&self) -> [bool; 2] {
        let ends = step::reads_images(&self.steps, self.channels.height);
        self.wrap.map(|repeats| ends && !repeats)
    }

    /// Returns the height of the margin above and below a window that the neighborhoods of the material need, in rows
    /// of the window's pixel size.
    pub(crate) fn margin_rows(&self, window: &Window) -> Result<u32, RecipeError> {
        neighborhood::margin(&self.steps, window, &self.channels.steps()).map(|margin| margin[1])
    }

    /// Returns the steps whose values neighborhoods read around a window, and the margin in which they are needed.
    /// Callers store these values to avoid computing the rows of the margin again.
    pub(crate) fn sources(
        &self,
        window: &Window,
        wanted: &[usize],
    ) -> Result<(Vec<usize>, [u32; 2]), RecipeError> {
        neighborhood::sources(&self.steps, window, wanted)
    }

    /// Returns a copy of the plan's callback with separate progress, for new work.
    pub(crate) fn watch(&self) -> Watch {
        self.watch.again()
    }

    pub(crate) fn material(&self) -> &Material {
        &self.material
    }

    pub(crate) fn channels(&self) -> &Channels {
        &self.channels
    }

    pub(crate) fn steps(&self) -> &Arc<[Step]> {
        &self.steps
    }
}

/// Returns the pixels of a window as a bake evaluates them, with images averaged over each pixel.
fn grid(window: &Window) -> Grid<'_> {
    Grid {
        window,
        averages: true,
    }
}

pub(crate) const TIME: Range = range!(finite);
pub(crate) const EXTENT: Range = range!(above 0 to 1e6);
/// The allowed range of the relief. It is far larger than textures need, and small enough that slopes and their squares
/// stay finite.
pub(crate) const RELIEF: Range = range!(from -1e6 to 1e6);
/// Allowed range of the emission strength.
pub(crate) const EMISSION: Range = range!(from 0 to 1e6);
/// Allowed range of the opacity cutoff, and of the roughness of the clear coat.
pub(crate) const UNIT: Range = range!(from 0 to 1);

/// Adds the steps that the material reads, after the steps of all nodes.
fn channels(recipe: &Recipe, builder: &mut Builder<'_>) -> Result<Channels, RecipeError> {
    let material = &recipe.material;
    RecipeError::check_in(RELIEF, "relief", material.relief)?;
    for (range, what, value) in [
        (EMISSION, "emission strength", material.emission_strength),
        (UNIT, "cut-off of the opacity", material.opacity_cutoff),
        (
            UNIT,
            "roughness of the clear coat",
            material.clearcoat_roughness,
        ),
    ] {
        value.map_or(Ok(()), |value| RecipeError::check_in(range, what, value))?;
    }
    let height = builder.number(&material.height)?;
    let albedo = match &material.albedo {
        Some(albedo) => builder.any(albedo)?,
        None => height,
    };
    let emission = material.emission.as_ref();
    let emission = builder.any(emission.unwrap_or(&Input::Color(LinearRgb::BLACK)))?;
    let mut number = |input: &Option<Input>, default: f64| {
        builder.number(input.as_ref().unwrap_or(&Input::Number(default)))
    };
    let opacity = number(&material.opacity, 1.0)?;
    let specular = number(&material.specular, 1.0)?;
    let clearcoat = number(&material.clearcoat, 0.0)?;
    Ok(Channels {
        height,
        albedo,
        roughness: builder.number(&material.roughness)?,
        metallic: builder.number(&material.metallic)?,
        emission,
        opacity,
        specular,
        clearcoat,
    })
}

impl Input {
    /// Returns the input as written in the recipe, for error messages.
    pub(crate) fn written(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Color(color) => format!("`{}`", crate::input::hex_from_color(*color)),
            Self::Node(name) => format!("`{name}`"),
        }
    }
}

/// Returns the error for `input`, a color where a number is needed.
pub(crate) fn not_a_number(input: &Input) -> RecipeError {
    RecipeError::new(RecipeErrorKind::NotANumber {
        input: input.written(),
    })
}
