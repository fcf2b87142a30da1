//! Bakes a material while a game loads, on a separate thread, with a progress bar, and stops if loading is cancelled.
//!
//! One callback reports all work, from the first node to the last row, and can stop it. Here the first attempt is
//! cancelled after a tenth of its work, as when a player leaves the level, and the second one completes.
//!
//! ```sh
//! cargo run -p dapple --example 14_recipe_at_load
//! ```

mod out;

use core::ops::ControlFlow;
use dapple::image::{Depth, write_color_png, write_gray_png, write_normal_png};
use dapple::recipe::{
    Bake, BakeOptions, Images, MapKind, MapRows, Plan, PlanLimits, Progress, Recipe, RecipeError,
    RecipeErrorKind,
};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, mpsc};
use std::thread;

/// Maps of a material.
type Maps = Vec<(MapKind, MapRows)>;

/// A material that is being baked on another thread.
struct Loading {
    /// Receives the completed fraction of the work, from 0 to 1, whenever it grows.
    parts: mpsc::Receiver<f64>,
    /// Whether the work has been cancelled.
    is_over: Arc<AtomicBool>,
    maps: thread::JoinHandle<Result<Maps, RecipeError>>,
}

impl Loading {
    fn new(recipe: Recipe) -> Self {
        let (sender, parts) = mpsc::channel();
        let is_over = Arc::new(AtomicBool::new(false));
        let asked = is_over.clone();
        let listen = move |progress: Progress| {
            // The receiver may already be gone.
            let _ = sender.send(progress.part());
            match asked.load(Relaxed) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let maps = thread::spawn(move || {
            let (images, limits) = (Images::new(), PlanLimits::default());
            let plan = Plan::new_with_progress(&recipe, &images, 0.0, &limits, None, listen)?;
            let options = BakeOptions {
                size: [512, 512],
                maps: vec![MapKind::Height, MapKind::Normal, MapKind::Albedo],
                ..BakeOptions::default()
            };
            Bake::new(&plan, &options)?.whole_maps()
        });
        Self {
            parts,
            is_over,
            maps,
        }
    }

    /// Shows the progress until the fraction `end` of the work is done. Returns the maps, or an error if the work was
    /// cancelled.
    fn until(self, end: f64) -> Result<Maps, RecipeError> {
        let mut shown = 0;
        // A game polls once per frame, with `try_iter`.
        for part in &self.parts {
            let percent = (100.0 * part) as u32;
            if percent >= shown + 10 {
                shown = percent;
                say(&format!("{percent} %"));
            }
            if part > end {
                self.is_over.store(true, Relaxed);
            }
        }
        match self.maps.join() {
            Ok(maps) => maps,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let recipe = Recipe::builtin("stone-and-grass")?;
    let given_up = Loading::new(recipe.clone()).until(0.1);
    match given_up {
        Err(error) if *error.kind() == RecipeErrorKind::Cancelled => say("given up"),
        Err(error) => return Err(error.into()),
        Ok(_) => return Err("it was done before it was given up".into()),
    }
    for (kind, rows) in Loading::new(recipe).until(1.0)? {
        let path = out::path(&format!("14_recipe_at_load_{}.png", kind.name()))?;
        match rows {
            MapRows::Gray(rows) => write_gray_png(&path, &rows, Depth::Sixteen)?,
            MapRows::Color(rows) => write_color_png(&path, &rows, Depth::Eight)?,
            MapRows::Normal(rows) => write_normal_png(&path, &rows, Depth::Eight)?,
            MapRows::Packed(_) => continue,
        }
        out::wrote(&path);
    }
    Ok(())
}

/// Prints a line.
#[expect(clippy::print_stdout, reason = "an example talks")]
fn say(line: &str) {
    println!("{line}");
}

#[cfg(test)]
mod tests {
    use super::Loading;
    use dapple::recipe::{Recipe, RecipeErrorKind};

    #[test]
    fn a_material_is_given_up_when_it_is_not_wanted() {
        let recipe = Recipe::builtin("stone-and-grass").unwrap();
        let error = Loading::new(recipe).until(0.1).unwrap_err();
        assert_eq!(*error.kind(), RecipeErrorKind::Cancelled);
    }
}
