//! Implements the options `--check` and `--bless`, which compare the figures with `figures.lock` or rewrite it.
#![expect(clippy::disallowed_methods, reason = "the lock is a file")]

use crate::{draw_each, say};
use anyhow::{Context, bail};
use dapple_gallery::lock::Change;
use dapple_gallery::{Figure, LOCK_SIZE, Lock, figures};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Renders `selected` and fails if the hash of a figure differs from its line in the lock, if a line is missing, or if
/// a line has no figure.
pub(crate) fn check(selected: &[&'static Figure], path: &Path) -> anyhow::Result<()> {
    let old = read(path)?;
    let changes = old.changes(&updated(&old, selected)?);
    if changes.is_empty() {
        say(&format!(
            "{} figures are as in figures.lock",
            selected.len()
        ));
        return Ok(());
    }
    changes.iter().for_each(|change| say(&change.to_string()));
    bail!(
        "{} figures differ from figures.lock; look at them with `cargo xtask gallery`, then accept them with \
         `cargo xtask gallery --bless`",
        changes.len()
    )
}

/// Writes the hashes of `selected` into the lock, removes lines of deleted figures, and prints what changed.
pub(crate) fn bless(selected: &[&'static Figure], path: &Path) -> anyhow::Result<()> {
    let old = read(path)?;
    let new = updated(&old, selected)?;
    let changes: Vec<Change> = old.changes(&new);
    changes.iter().for_each(|change| say(&change.to_string()));
    say(&format!(
        "{} of {} figures changed",
        changes.len(),
        selected.len()
    ));
    fs::write(path, new.to_string()).with_context(|| format!("cannot write {}", path.display()))
}

/// Returns the lock with the new hashes of `selected`, and without the lines of deleted figures.
fn updated(old: &Lock, selected: &[&'static Figure]) -> anyhow::Result<Lock> {
    let mut lock = old.clone();
    let names: Vec<String> = figures().map(Figure::name).collect();
    lock.retain(|name| names.iter().any(|figure| figure == name));
    let hashes = draw_each(selected, |figure| figure.hash(LOCK_SIZE))?;
    for (figure, hash) in selected.iter().zip(hashes) {
        lock.insert(figure.name(), hash);
    }
    Ok(lock)
}

/// Reads the lock; it is empty if the file does not exist yet.
fn read(path: &Path) -> anyhow::Result<Lock> {
    match fs::read_to_string(path) {
        Ok(text) => Lock::parse(&text),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Lock::default()),
        Err(error) => Err(error).with_context(|| format!("cannot read {}", path.display())),
    }
}
