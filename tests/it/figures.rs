//! Renders every figure at a small size, with one or several threads, and compares it with its line in figures.lock.

use crate::with_threads;
use dapple::recipe::Recipe;
use dapple_gallery::lock::{Change, Hash};
use dapple_gallery::{LOCK_SIZE, Lock, figures, select};
use std::collections::BTreeSet;

fn lock() -> Lock {
    Lock::parse(include_str!("../../crates/dapple-gallery/figures.lock"))
        .expect("figures.lock can be read")
}

/// Renders every third figure, starting at `first`, with `n_threads` threads, and returns the differences from the
/// lock.
///
/// Adjacent figures in the list are of the same kind, so that each kind is rendered with each number of threads. The
/// tests of the crates compare numbers of threads for every algorithm.
fn changes(first: usize, n_threads: usize) -> Vec<Change> {
    let mut found = lock();
    for figure in figures().skip(first).step_by(3) {
        let hash = with_threads(n_threads, || figure.hash(LOCK_SIZE));
        found.insert(figure.name(), hash.expect("the figure renders"));
    }
    lock().changes(&found)
}

#[test]
fn figures_equal_the_lock_with_1_thread() {
    assert_eq!(changes(0, 1), [], "see `cargo xtask gallery --check`");
}

#[test]
fn figures_equal_the_lock_with_2_threads() {
    assert_eq!(changes(1, 2), [], "see `cargo xtask gallery --check`");
}

#[test]
fn figures_equal_the_lock_with_7_threads() {
    assert_eq!(changes(2, 7), [], "see `cargo xtask gallery --check`");
}

#[test]
fn every_line_of_the_lock_is_that_of_a_figure() {
    let mut named = Lock::default();
    for figure in figures() {
        named.insert(figure.name(), Hash(0));
    }
    let changes = lock().changes(&named).into_iter();
    let gone: Vec<_> = changes
        .filter(|change| matches!(change, Change::Gone(_)))
        .collect();
    assert_eq!(gone, [], "see `cargo xtask gallery --bless`");
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

/// Renders every fifth figure, which includes each kind. [`Figure::render`](dapple_gallery::Figure::render) returns an
/// error if an image does not have the requested size.
#[test]
fn figures_keep_their_shape_at_another_size() {
    for figure in figures().step_by(5) {
        figure.render(24).expect("the figure renders at its size");
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
