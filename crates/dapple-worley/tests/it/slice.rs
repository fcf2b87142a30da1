//! Tests of slices of spaces as fields.

use dapple_hash::Seed;
use dapple_raster::{Field, Window, glam::DVec2};
use dapple_worley::{Combination, Octaves, Worley4};

#[test]
fn render_equals_sample_bit_for_bit() {
    let cells = Worley4::new(Seed(7)).combine(Combination::F1);
    let octaves = Octaves {
        count: 2,
        ..Octaves::default()
    };
    let fractal = cells.fractal(octaves).unwrap();
    let window = Window::new(DVec2::new(-3.0, 7.0), DVec2::new(4.0, 3.0), [23, 17]).unwrap();
    let edges = cells.worley().edge_distances();
    for slice in [
        cells.slice([0.5, 1.25]),
        fractal.slice([0.5, 1.25]),
        edges.slice([0.5, 1.25]),
    ] {
        let raster = slice.to_raster(&window).unwrap();
        for (row, column) in (0..17).flat_map(|row| (0..23).map(move |column| (row, column))) {
            let sample = slice.sample(window.position(column, row));
            let rendered = raster.row(row)[column as usize];
            assert_eq!(sample.to_bits(), rendered.to_bits(), "{column}, {row}");
        }
        let positions: Vec<DVec2> = (0..23).map(|column| window.position(column, 9)).collect();
        let mut values = [0.0; 23];
        slice.sample_many(&positions, &mut values).unwrap();
        assert_eq!(values, *raster.row(9));
    }
}
