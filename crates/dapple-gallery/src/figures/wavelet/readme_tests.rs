//! Compares the numbers in a README with a figure's measurements.

use super::fig_extra_methods::{margin_of, measured, methods};
use super::{crops, tile_side};
use dapple_tile::Seamless;

/// README of the crate with the tiling methods.
const README: &str = include_str!("../../../../dapple-tile/README.md");
/// Figure size, in pixels, at which crops have 160 × 160 pixels as in the README.
const SIZE: u32 = 512;
/// The figure's method that the README omits.
const LEFT_OUT: &str = "Feather over the margin, variance kept";

/// Returns the numbers in a table row as text: the seam at 1 and at 4 pixels, the finest octave, and the contrast.
fn row(line: &str) -> Vec<String> {
    let cells = line.trim_matches('|').split('|').skip(1);
    let numbers = cells.flat_map(|cell| cell.split('/'));
    numbers.map(|number| number.trim().to_owned()).collect()
}

#[test]
fn the_readme_of_tiling_methods_has_the_numbers_of_the_figure() {
    let table = README
        .lines()
        .skip_while(|line| !line.starts_with("| the crop itself"));
    let table: Vec<_> = table.take_while(|line| line.starts_with('|')).collect();
    let margin = margin_of(SIZE);
    let [noise, _, pebbles, _] = crops(tile_side(SIZE) + margin).unwrap();
    let methods = methods(margin);
    let methods: Vec<_> = methods
        .iter()
        .filter(|(name, _)| *name != LEFT_OUT)
        .collect();
    assert_eq!(table.len(), methods.len());
    let mut wrong = String::new();
    for (line, (name, method)) in table.into_iter().zip(methods) {
        let mut found = Vec::new();
        for (_, crop) in [&noise, &pebbles] {
            let tile = match method {
                Some(method) => Seamless::new(*method).apply(crop).unwrap(),
                None => crop.clone(),
            };
            let [near, far, fine, contrast, _] = measured(crop, &tile).unwrap();
            found.extend([near, far, fine, contrast].map(|number| format!("{number:.2}")));
        }
        if row(line) != found {
            wrong += &format!(
                "{name}: {} and not {}\n",
                found.join(" "),
                row(line).join(" ")
            );
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
