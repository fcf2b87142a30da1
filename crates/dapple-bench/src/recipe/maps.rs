//! Each map of each built-in recipe baked alone, and its height with a margin, compared with a bake of all its maps.
//!
//! One map can cost more than all of them only if it takes a separate code path. The two rows report the most
//! expensive of these jobs.

use crate::harness::Bench;
use crate::row::{Case, Goal, Unit};
use anyhow::{Context as _, Result};
use dapple_raster::Field as _;
use dapple_recipe::{
    Bake, BakeOptions, Images, MapKind, Plan, Recipe, RecipeError, RecipeErrorKind,
};

const ALONE: Case = Case {
    group: "recipe",
    case: "256×256, one map of a built-in recipe",
    peer: "ours, all maps of it",
    unit: Unit::Ms,
    must: Goal::CostAtMost(1.3),
    note: "",
};

const MARGIN: Case = Case {
    case: "256×256, height of a built-in recipe with a margin of 0 to 16 pixels",
    ..ALONE
};

/// Width and height of the tile in pixels.
const SIDE: u32 = 256;

/// Maximum margin, in pixels.
const WIDEST: u32 = 16;

/// Number of runs of each job; the fastest one counts.
const RUNS: u32 = 3;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants_any(&[ALONE, MARGIN]) {
        return Ok(());
    }
    let [mut alone, mut margin] = [const { Costliest::new() }; 2];
    for name in Recipe::builtin_names() {
        let plan = Plan::new(&Recipe::builtin(name)?, &Images::new(), 0.0)?;
        let all = fastest(bench, || bake(&plan, &MapKind::ALL)).context(name)?;
        for map in MapKind::ALL {
            let one = fastest(bench, || bake(&plan, &[map])).context(name)?;
            alone.keep([one, all], || format!("the map {} of {name}", map.name()));
        }
        // A height that depends on the whole tile is not defined around the tile.
        let is_global =
            |error: &RecipeError| matches!(error.kind(), RecipeErrorKind::Global { .. });
        if plan.height().is_err_and(|error| is_global(&error)) {
            continue;
        }
        for pixels in 0..=WIDEST {
            let one = fastest(bench, || height(&plan, pixels)).context(name)?;
            margin.keep([one, all], || format!("{pixels} pixels about {name}"));
        }
    }
    for (case, Costliest { times, what }) in [(&ALONE, alone), (&MARGIN, margin)] {
        if bench.wants(case) {
            let note = format!("the costliest of all: {what}");
            bench.measured_with(case, times[0], times[1], note);
        }
    }
    Ok(())
}

/// The job with the highest cost relative to the reference job, a bake of all maps.
struct Costliest {
    /// Times of the job and of the reference job, in seconds.
    times: [f64; 2],
    what: String,
}

impl Costliest {
    const fn new() -> Self {
        Self {
            times: [0.0, 1.0],
            what: String::new(),
        }
    }

    fn keep(&mut self, times: [f64; 2], what: impl FnOnce() -> String) {
        if times[0] / times[1] > self.times[0] / self.times[1] {
            *self = Self {
                times,
                what: what(),
            };
        }
    }
}

/// Returns the minimum processor time of `job` over several runs on one thread, in seconds.
fn fastest(bench: &Bench, job: impl Fn() -> Result<(), RecipeError> + Sync) -> Result<f64> {
    let mut least = f64::INFINITY;
    for _ in 0..RUNS {
        let (seconds, done) = bench.on_one(&job);
        done?;
        least = least.min(seconds);
    }
    Ok(least)
}

fn bake(plan: &Plan, maps: &[MapKind]) -> Result<(), RecipeError> {
    let options = BakeOptions {
        size: [SIDE; 2],
        maps: maps.to_vec(),
        ..BakeOptions::default()
    };
    Bake::new(plan, &options)?.try_for_each(|band| band.map(drop))
}

/// Renders the tile's height with a margin of `pixels` pixels.
fn height(plan: &Plan, pixels: u32) -> Result<(), RecipeError> {
    let first = [-i64::from(pixels); 2];
    let window = plan
        .window([SIDE; 2])?
        .crop(first, [SIDE + 2 * pixels; 2])?;
    plan.height()?.to_raster(&window)?;
    Ok(())
}
