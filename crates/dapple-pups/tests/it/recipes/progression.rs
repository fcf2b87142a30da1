//! Tests that progressions increase from left to right, and repeat from top to bottom.

use super::common::{digest, paper_window};
use dapple_hash::Seed;
use dapple_pups::*;
use dapple_raster::{Field, Raster, Window};
use glam::DVec2;

/// Returns the number of vertically adjacent pixels that differ, in each quarter of the raster from left to right.
fn changes(raster: &Raster<f32>) -> [usize; 4] {
    let [width, height] = raster.size();
    let quarter = width as usize / 4;
    [0, 1, 2, 3].map(|at| {
        let columns = at * quarter..(at + 1) * quarter;
        let differ = |row: u32| {
            let [a, b] = [row - 1, row].map(|row| &raster.row(row)[columns.clone()]);
            a.iter().zip(b).filter(|(a, b)| a != b).count()
        };
        (1..height).map(differ).sum()
    })
}

#[test]
fn progressions_become_finer_to_the_right() {
    let options = ProgressionOptions::default();
    for (name, texture) in [
        ("cow", cow_progression(&options, Seed(1)).unwrap()),
        ("giraffe", giraffe_progression(&options, Seed(1)).unwrap()),
    ] {
        let raster = texture.to_raster(&paper_window(256)).unwrap();
        let changes = changes(&raster);
        assert!(
            changes.is_sorted_by(|a, b| a < b),
            "{name}: {changes:?} changes"
        );
        assert!(changes[3] > 2 * changes[0], "{name}: {changes:?} changes");
        let below = Window::new(DVec2::new(-1.0, 1.0), DVec2::splat(2.0), [256; 2]).unwrap();
        let below = texture.to_raster(&below).unwrap();
        assert_eq!(
            digest(&below),
            digest(&raster),
            "{name} does not repeat in y"
        );
    }
}

#[test]
fn a_label_ramp_becomes_whiter_to_the_right() {
    let texture = label_ramp(&LabelRampOptions::default(), Seed(1)).unwrap();
    let raster = texture.to_raster(&paper_window(256)).unwrap();
    let shares = [0, 1, 2, 3].map(|quarter| {
        let rows = (0..256).map(|row| &raster.row(row)[quarter * 64..(quarter + 1) * 64]);
        rows.flatten().sum::<f32>() / 16384.0
    });
    for (quarter, share) in shares.into_iter().enumerate() {
        // 280 control points to a quarter: a standard deviation of at most 0.03.
        let expected = 0.125 + 0.25 * quarter as f32;
        assert!((share - expected).abs() < 0.11, "{shares:?} white");
    }
}

#[test]
fn value_stability_progressions() {
    let window = paper_window(32);
    let options = ProgressionOptions::default();
    let digests = [
        cow_progression(&options, Seed(7)).unwrap(),
        giraffe_progression(&options, Seed(7)).unwrap(),
        label_ramp(&LabelRampOptions::default(), Seed(7)).unwrap(),
    ]
    .map(|texture| digest(&texture.to_raster(&window).unwrap()));
    assert_eq!(
        digests,
        [
            11321456807880717093,
            4751766841400521509,
            10429935572434318117
        ]
    );
}
