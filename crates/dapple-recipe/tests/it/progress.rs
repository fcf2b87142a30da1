//! Tests of the progress callback of plans and bakes, which can stop them.

use core::ops::ControlFlow;
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use dapple_raster::{Raster, parallel};
use dapple_recipe::{
    Bake, BakeOptions, Images, MapKind, MapRows, Picture, Plan, PlanCache, PlanLimits, Progress,
    Recipe, RecipeError, RecipeErrorKind,
};
use std::sync::{Arc, Mutex};

/// A recipe with each kind of slow node: control points, a synthesized texture, copies, borders, global nodes and a
/// warp.
const RECIPE: &str = "\
dapple = 1
extent = [4.0, 4.0]
[nodes]
stones = { synth = { file = \"stones.png\", size = [64, 64], levels = 3 } }
clouds = { noise = { frequency = 2.0, octaves = 3 } }
hide = { pups = { cow = { spacing = 0.1 } } }
bent = { warp = { input = \"clouds\", x = \"hide\", y = \"clouds\", amount = 0.1 } }
sum = { add = [\"stones\", \"bent\"] }
copies = { disturb = { input = \"sum\", copies = [2, 2], frozen = 1, margin = 4 } }
framed = { match_borders = { input = \"copies\", border = \"clouds\", options = { width = 8 } } }
first = { blend_map = { input = \"framed\", feature_size = 0.5 } }
[material]
height = \"framed\"
roughness = \"first\"
";

fn recipe() -> (Recipe, Images) {
    let stones = Raster::from_fn([32, 32], |x, y| {
        f32::from((x * x + 3 * y) % 11 < 6) + 0.01 * (x + y) as f32
    });
    let picture = Picture::Numbers(Arc::new(stones.unwrap()));
    let images = Images::from([("stones.png".to_owned(), picture)]);
    (Recipe::from_toml(RECIPE).unwrap(), images)
}

/// Returns the maps of the recipe, planned and baked with a progress callback.
fn made(
    memory: Option<&PlanCache>,
    progress: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static,
) -> Result<Vec<(MapKind, MapRows)>, RecipeError> {
    let (recipe, images) = recipe();
    let limits = PlanLimits::default();
    let plan = Plan::new_with_progress(&recipe, &images, 0.0, &limits, memory, progress)?;
    let options = BakeOptions {
        size: [128, 128],
        maps: vec![
            MapKind::Height,
            MapKind::Normal,
            MapKind::Occlusion,
            MapKind::Roughness,
        ],
        band_pixels: 1 << 11,
        ..BakeOptions::default()
    };
    Bake::new(&plan, &options)?.whole_maps()
}

/// Returns the result of a bake that is stopped when the callback has been called `last` times, and the number of
/// calls.
fn stopped_at(
    last: usize,
    memory: Option<&PlanCache>,
) -> (Result<Vec<(MapKind, MapRows)>, RecipeError>, usize) {
    let n_calls = Arc::new(AtomicUsize::new(0));
    let calls = n_calls.clone();
    let made = made(memory, move |_| match calls.fetch_add(1, Relaxed) >= last {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    });
    (made, n_calls.load(Relaxed))
}

#[test]
fn work_can_be_stopped_at_every_call_and_leaves_nothing_behind() {
    let (plain, n_calls) = stopped_at(usize::MAX, None);
    let plain = plain.unwrap();
    for last in (0..6).chain((6..n_calls).step_by(n_calls / 16)) {
        let memory = PlanCache::new(1 << 26);
        let (stopped, n_calls) = stopped_at(last, Some(&memory));
        let error = stopped.unwrap_err();
        assert_eq!(
            error.kind(),
            &RecipeErrorKind::Cancelled,
            "at call {last}: {error}"
        );
        // Threads that were at a call when it was stopped end it.
        let most = last + parallel::n_threads();
        assert!(n_calls <= most, "{n_calls} calls, stopped at {last}");
        // What the memory kept is whole.
        let (again, _) = stopped_at(usize::MAX, Some(&memory));
        assert_eq!(again.unwrap(), plain, "after call {last}");
    }
}

#[test]
fn progress_goes_on_from_the_first_node_to_the_last_row() {
    let heard = Arc::new(Mutex::new(Vec::new()));
    let listener = heard.clone();
    // On one thread, calls come in the order of the work.
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap()
        .install(|| {
            let listen = move |progress| {
                listener.lock().unwrap().push(progress);
                ControlFlow::Continue(())
            };
            made(None, listen).unwrap();
        });
    let heard = heard.lock().unwrap();
    assert_eq!(heard[0].part(), 0.0, "before the first node");
    assert!(heard.is_sorted_by(|a, b| a.part() <= b.part()), "{heard:?}");
    assert!(heard.iter().all(|progress| progress.n_passes == 3));
    let calls_in = |pass: usize| heard.iter().filter(move |progress| progress.pass == pass);
    // Half a second is taken by the trials for the texture that is grown, and a tenth of a second by each of the others.
    assert!(
        calls_in(0).count() > 100,
        "{} for the nodes",
        calls_in(0).count()
    );
    assert!(
        calls_in(1).count() > 10,
        "{} for the tile",
        calls_in(1).count()
    );
    let rows: std::collections::BTreeSet<_> = calls_in(2).map(|progress| progress.done).collect();
    assert_eq!(rows.len(), 8, "of each band of 16 rows: {rows:?}");
    let within_synth = calls_in(0).filter(|progress| (1..1000).contains(&(progress.done % 1000)));
    assert!(within_synth.count() > 10, "while the texture grows");
}

#[test]
fn usual_pictures_have_several_bands() {
    let plan = Plan::new(&Recipe::builtin("flagstone").unwrap(), &Images::new(), 0.0).unwrap();
    for (size, n_bands) in [([1024, 1024], 8), ([2048, 1024], 8), ([100, 100], 1)] {
        let options = BakeOptions {
            size,
            ..BakeOptions::default()
        };
        let bake = Bake::new(&plan, &options).unwrap();
        assert_eq!(bake.map(Result::unwrap).count(), n_bands, "{size:?}");
    }
}

/// Returns the number of calls while a recipe with the node `made` is planned, and in the pass over the whole tile while
/// it is baked.
fn n_calls_for(made: &str) -> [usize; 2] {
    let recipe = format!(
        "dapple = 1\nextent = [32.0, 32.0]\n[nodes]\nclouds = {{ noise = {{ frequency = 0.25 }} }}\nmade = {made}\n\
         [material]\nheight = \"made\"\n"
    );
    let recipe = Recipe::from_toml(&recipe).unwrap();
    let n_calls = Arc::new([0, 1, 2].map(|_| AtomicUsize::new(0)));
    let calls = n_calls.clone();
    let count = move |progress: Progress| {
        calls[progress.pass].fetch_add(1, Relaxed);
        ControlFlow::Continue(())
    };
    let (images, limits) = (Images::new(), PlanLimits::default());
    let plan = Plan::new_with_progress(&recipe, &images, 0.0, &limits, None, count).unwrap();
    let planned = n_calls[0].load(Relaxed);
    let options = BakeOptions {
        size: [128, 128],
        maps: vec![MapKind::Height],
        ..BakeOptions::default()
    };
    Bake::new(&plan, &options).unwrap().whole_maps().unwrap();
    [planned, n_calls[1].load(Relaxed)]
}

#[test]
fn tiles_and_wavelets_call_back_while_they_are_made() {
    let [small, large] = [8.0, 64.0].map(|frequency| {
        n_calls_for(&format!("{{ wavelet = {{ frequency = {frequency:?} }} }}"))[0]
    });
    // 2048 × 2048 cells are 64 times 65,536, which are filled and subtracted; 256 × 256 cells make a call for each.
    assert!(large >= small + 2 * 63, "{small} and {large} calls");
    let blend_map = n_calls_for("{ blend_map = { input = \"clouds\", feature_size = 4.0 } }")[1];
    let tile = n_calls_for("{ tile = { input = \"clouds\", method = \"periodic\" } }")[1];
    // A blend map makes five calls by itself, a tile one for each of eight bands of columns and eight of rows.
    assert!(
        tile + 5 >= blend_map + 8 + 8,
        "{tile} calls, {blend_map} for a blend map"
    );
}
