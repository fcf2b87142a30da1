//! Tests of planar slices of 3-D and 4-D bases as fields.

use dapple_hash::Seed;
use dapple_raster::{Field, FieldExt as _, Raster, Window, glam::DVec2};
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
    let values = cells.worley().cell_values();
    let slices: [&dyn Field; 5] = [
        &(&cells).slice([0.5, 1.25]),
        &(&fractal).slice([0.5, 1.25]),
        &edges.slice([0.5, 1.25]),
        &values.slice([0.5, 1.25]),
        // The third and the fourth axis are scaled with the first two.
        &(&fractal).frequency(0.5).slice([1.0, 2.5]),
    ];
    for slice in slices {
        let raster = slice.to_raster(&window).unwrap();
        for (row, column) in (0..17).flat_map(|row| (0..23).map(move |column| (row, column))) {
            let sample = slice.sample(window.position(column, row));
            let rendered = raster.row(row)[column as usize];
            assert_eq!(sample.to_bits(), rendered.to_bits(), "{column}, {row}");
        }
        let positions: Vec<_> = (0..23).map(|column| window.position(column, 9)).collect();
        let mut values = [0.0; 23];
        slice.sample_many(&positions, &mut values).unwrap();
        assert_eq!(values, *raster.row(9));
    }
}

#[test]
fn a_stack_of_windows_has_the_values_of_each_bit_for_bit() {
    let cells = Worley4::new(Seed(7)).combine(Combination::F2_MINUS_F1);
    let octaves = Octaves {
        count: 2,
        ..Octaves::default()
    };
    let fractal = cells.fractal(octaves).unwrap();
    let wide = Window::new([-3.0, 7.0], [4.0, 3.0], [23, 17]).unwrap();
    let narrow = wide.crop([2, 1], [9, 17]).unwrap();
    let places = [0.5, 0.6, 0.7, 0.7];
    let planes = [wide, wide, narrow, wide];
    let windows: Vec<_> = (planes.iter().zip(places))
        .map(|(plane, z)| plane.in_space([0.0, 0.0, z, 1.25]))
        .collect();
    for field in [&cells as &dyn Field<4>, &fractal] {
        let mut rasters = planes.map(|plane| Raster::filled(plane.size, 0.0).unwrap());
        let views = rasters.iter_mut().map(Raster::view_mut).collect();
        field.render_stack(&windows, views).unwrap();
        for (window, raster) in windows.iter().zip(&rasters) {
            assert_eq!(*raster, field.to_raster(window).unwrap());
        }
        assert!(field.render_stack(&windows, Vec::new()).is_err());
    }
}

#[test]
fn compositions_of_cells_have_gradients() {
    let cells = Worley4::new(Seed(7)).combine(Combination::F1);
    let field = (&cells).frequency(2.0).slice([0.5, 1.25]);
    for index in 0..50 {
        let at = [0.31 * f64::from(index), 5.0 - 0.17 * f64::from(index)];
        let (value, gradient) = field.sample_with_gradient(at);
        assert_eq!(value, field.sample(at));
        let [x, y] = at;
        let expected = cells.gradient([2.0 * x, 2.0 * y, 1.0, 2.5]).to_array();
        let expected = [expected[0], expected[1]].map(|part| (2.0 * part) as f32);
        assert_eq!(gradient, expected);
    }
}
