//! How much work a recipe asks for, found out before any of it is done.
//!
//! A few lines of a recipe can ask for any number of control points, for wavelet noise of any size, and for warps of
//! warps, each of which works out all that it is made of once more.

use super::generate::Generator;
use super::step::{Step, needed};
use crate::{FractalBasis, Node, PupsNode, RecipeError, RecipeErrorKind};
use core::f64::consts::SQRT_2;
use dapple_points::Domain;
use dapple_pups::{OctaveSource, OctavesOptions, SpaceGiraffeOptions, Spacing};

/// How much work a recipe may ask for before it is refused.
///
/// The defaults are far above what textures need, and within the memory of a small machine.
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
    /// Control points of all nodes together, by an estimate that is rather too high; 2^22 by default, which take about
    /// 2 GiB.
    pub control_points: u64,
    /// Cells of the tiles of all wavelet noise together; 2^24 by default, such as a tile of 4096 × 4096.
    pub wavelet_cells: u64,
    /// Values that are worked out for each pixel: one for each node and for each number or color that is an input. What is
    /// under a warp, or under a node that sees the whole tile, counts once more for each of these. 4096 by default.
    pub values: u64,
    /// How many warps may lie one under another; 32 by default.
    pub warps: u64,
    /// Pixels of all pictures of nodes that see the whole tile together, for the size of a bake; 2^29 by default.
    pub pixels: u64,
}

impl Default for PlanLimits {
    fn default() -> Self {
        Self {
            control_points: 1 << 22,
            wavelet_cells: 1 << 24,
            values: 4096,
            warps: 32,
            pixels: 1 << 29,
        }
    }
}

impl PlanLimits {
    /// Refuses more pixels than there may be.
    pub(super) fn check_pixels(&self, pictures: usize, size: [u32; 2]) -> Result<(), RecipeError> {
        let pixels = pictures as f64 * f64::from(size[0]) * f64::from(size[1]);
        check("pixels that are seen as a whole", pixels, self.pixels)
    }
}

/// Refuses more than there may be.
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

/// The work of the nodes that there have been.
pub(super) struct Work<'a> {
    limits: &'a PlanLimits,
    control_points: f64,
    wavelet_cells: f64,
}

impl<'a> Work<'a> {
    pub(super) fn new(limits: &'a PlanLimits) -> Self {
        Self {
            limits,
            control_points: 0.0,
            wavelet_cells: 0.0,
        }
    }

    /// Adds the work of making a node. What is wrong with its options is told when it is made.
    pub(super) fn add(
        &mut self,
        generator: &Generator<'_>,
        node: &Node,
    ) -> Result<(), RecipeError> {
        match node {
            Node::Pups(pups) => self.control_points += control_points(generator, pups),
            Node::Noise(noise) if noise.basis == FractalBasis::Pups => {
                self.control_points +=
                    of_octaves(&generator.fractal_options(noise), generator.domain());
            }
            Node::Noise(noise) => self.add_wavelet(generator, noise.frequency)?,
            Node::Wavelet(wavelet) => self.add_wavelet(generator, wavelet.frequency)?,
            _ => {}
        }
        check(
            "control points",
            self.control_points,
            self.limits.control_points,
        )?;
        check(
            "cells of wavelet noise",
            self.wavelet_cells,
            self.limits.wavelet_cells,
        )
    }

    fn add_wavelet(
        &mut self,
        generator: &Generator<'_>,
        frequency: f64,
    ) -> Result<(), RecipeError> {
        let cells = generator.wavelet_cells(frequency)?.map(f64::from);
        self.wavelet_cells += cells[0] * cells[1];
        Ok(())
    }
}

/// The control points of a texture of `dapple-pups`.
fn control_points(generator: &Generator<'_>, node: &PupsNode) -> f64 {
    let (tile, strip) = (generator.domain(), generator.strip());
    let of = |spacing: &Spacing| spacing.expected_points(tile);
    match node {
        PupsNode::Noise(options) => of(&options.spacing),
        PupsNode::Octaves(options) | PupsNode::Turbulence(options) => of_octaves(options, tile),
        PupsNode::Cells(options) => of(&options.spacing),
        PupsNode::CellularNoise(options) => {
            of_series(&options.spacing, tile, options.layers, options.lacunarity)
        }
        PupsNode::ColorNoise(options) => of(&options.spacing),
        PupsNode::Cow(options) => of(&options.spacing),
        PupsNode::SpaceGiraffe(options) => of(&options.spacing) * of_spot(options),
        PupsNode::CowProgression(options) | PupsNode::GiraffeProgression(options) => {
            let mut options = options.clone();
            options.domain = strip;
            let centers = options.spacing().expected_points(strip);
            match node {
                PupsNode::CowProgression(_) => centers,
                _ => centers * of_spot(&SpaceGiraffeOptions::default()),
            }
        }
        PupsNode::LabelRamp(options) => options.spacing.expected_points(strip),
        PupsNode::Reference(node) => of(&node.options.spacing),
        PupsNode::IteratedReference(node) => {
            of_series(&node.options.spacing, tile, node.options.iterations, SQRT_2)
        }
        PupsNode::Points(node) => node.points.len() as f64,
    }
}

/// The control points of a spot of a giraffe: its center, and at most so many pairs.
fn of_spot(options: &SpaceGiraffeOptions) -> f64 {
    1.0 + 2.0 * f64::from(options.pairs[1])
}

fn of_octaves(options: &OctavesOptions, domain: Domain) -> f64 {
    match options.source {
        OctaveSource::Separate => of_series(
            &options.spacing,
            domain,
            options.octaves,
            options.lacunarity,
        ),
        OctaveSource::Rescaled => options.spacing.expected_points(domain),
    }
}

/// The most layers, octaves or iterations; more are refused when they are to be made.
const MAX_SERIES: u32 = 16;

/// The control points of layers, each with distances `factor` times smaller than the one before.
fn of_series(spacing: &Spacing, domain: Domain, count: u32, factor: f64) -> f64 {
    let count = if count > MAX_SERIES { 0 } else { count };
    let scales = core::iter::successors(Some(1.0), |scale| Some(scale * factor));
    let scales = scales.take(count as usize);
    scales
        .map(|scale| spacing.finer(scale).expected_points(domain))
        .sum()
}

/// How much is worked out for each pixel.
struct Values {
    /// For each step, the values that are worked out for it once more, beside its own.
    under: Vec<f64>,
    /// For each step, how many warps lie one under another, itself counted.
    warps: Vec<u64>,
}

/// Refuses steps that work out too much for each pixel; the error comes with the step that it is about.
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
        check("warps one under another", warps, limits.warps).map_err(|error| (index, error))?;
    }
    Ok(())
}

impl Values {
    /// Adds a step, whose inputs are before it.
    fn add(&mut self, before: &[Step], step: &Step) {
        let apart = match step {
            Step::Warp { input, .. } => vec![*input],
            Step::Global(_, inputs, _) => inputs.clone(),
            _ => Vec::new(),
        };
        let under = needed(before, &apart, |_| false);
        self.under
            .push(under.iter().map(|&index| 1.0 + self.under[index]).sum());
        let warps = under
            .iter()
            .map(|&index| self.warps[index])
            .max()
            .unwrap_or(0);
        let is_warp = u64::from(matches!(step, Step::Warp { .. }));
        self.warps.push(is_warp * (warps + 1));
    }
}
