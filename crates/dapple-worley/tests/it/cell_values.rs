//! Tests of the random numbers of cells.

use dapple_hash::Seed;
use dapple_raster::{Field, FieldExt as _, Window, glam::DVec2};
use dapple_worley::Worley2;

#[test]
fn render_equals_sample_bit_for_bit() {
    let cells = Worley2::new(Seed(7)).cell_values();
    let window = Window::new(DVec2::new(-3.0, 1e6), DVec2::new(8.0, 5.0), [67, 41]).unwrap();
    let raster = cells.to_raster(&window).unwrap();
    for row in 0..41 {
        for column in 0..67 {
            let sample = cells.sample(window.position(column, row));
            let rendered = raster.row(row)[column as usize];
            assert_eq!(sample.to_bits(), rendered.to_bits(), "{column}, {row}");
        }
    }
    assert!(cells.sample(DVec2::NAN).is_nan(), "no place, no number");
}
