//! Renders every figure at a small size and compares it with its line in figures.lock, for any number of threads.

use crate::with_threads;
use dapple::recipe::Recipe;
use dapple_gallery::{LOCK_SIZE, Lock, figures, select};
use std::collections::BTreeSet;

fn lock() -> Lock {
    Lock::parse(include_str!("../../crates/dapple-gallery/figures.lock"))
        .expect("figures.lock can be read")
}

/// Renders the figures with `n` threads and returns their hashes.
fn rendered_by(n: usize) -> Lock {
    let mut lock = Lock::default();
    for figure in figures() {
        let hash = with_threads(n, || figure.hash(LOCK_SIZE));
        lock.insert(figure.name(), hash.expect("the figure renders"));
    }
    lock
}

#[test]
fn figures_equal_the_lock_with_1_thread() {
    assert_eq!(
        lock().changes(&rendered_by(1)),
        [],
        "see `cargo xtask gallery --check`"
    );
}

#[test]
fn figures_equal_the_lock_with_2_threads() {
    assert_eq!(
        lock().changes(&rendered_by(2)),
        [],
        "see `cargo xtask gallery --check`"
    );
}

#[test]
fn figures_equal_the_lock_with_7_threads() {
    assert_eq!(
        lock().changes(&rendered_by(7)),
        [],
        "see `cargo xtask gallery --check`"
    );
}

#[test]
fn figures_have_names_of_their_own_captions_and_numbers() {
    let mut names = BTreeSet::new();
    for figure in figures() {
        let name = figure.name();
        assert!(!figure.caption().is_empty(), "{name} has no caption");
        assert!(!figure.number.is_empty(), "{name} has no number");
        assert!(names.insert(name.clone()), "{name} is there twice");
        assert!(
            !select(std::slice::from_ref(&name)).is_empty(),
            "{name} is not found by its name"
        );
    }
}

#[test]
fn figures_keep_their_shape_at_another_size() {
    for figure in figures() {
        let small = figure.render(24).expect("the figure renders");
        let sides = small.iter().map(|panel| panel.size());
        for size in sides {
            assert_eq!(
                size[0].max(size[1]),
                24,
                "the longer side of {}",
                figure.name()
            );
        }
    }
}

#[test]
fn recipes_of_figures_are_built_in() {
    let parameters = figures().flat_map(|figure| figure.parameters);
    let recipes = parameters.filter(|(name, _)| *name == "recipe");
    let names: Vec<&str> = recipes.map(|(_, recipe)| *recipe).collect();
    assert!(!names.is_empty());
    for name in names {
        assert!(Recipe::builtin_names().any(|known| known == name), "{name}");
    }
}
