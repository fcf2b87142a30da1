//! Tests of the outputs (distance, vector, position, id, cell value) that one search can render.

use dapple_hash::Seed;
use dapple_raster::{Raster, Window, glam::DVec2};
use dapple_worley::{Dimensions, FeatureView, Metric, POSITION_STEP, Plane, Space, Vector, Worley};

/// All outputs for one rank of nearest point.
struct Planes<const N: usize> {
    distance: Raster<f32>,
    vector: Raster<[f32; N]>,
    position: Raster<[f64; N]>,
    id: Raster<u64>,
    cell_value: Raster<f32>,
}

impl<const N: usize> Planes<N> {
    fn new(size: [u32; 2]) -> Self {
        Self {
            distance: Raster::filled(size, -1.0).unwrap(),
            vector: Raster::filled(size, [-1.0; N]).unwrap(),
            position: Raster::filled(size, [-1.0; N]).unwrap(),
            id: Raster::filled(size, 1).unwrap(),
            cell_value: Raster::filled(size, -1.0).unwrap(),
        }
    }

    fn all(&mut self) -> FeatureView<'_, N> {
        FeatureView {
            distance: Some(self.distance.view_mut()),
            vector: Some(self.vector.view_mut()),
            position: Some(self.position.view_mut()),
            id: Some(self.id.view_mut()),
            cell_value: Some(self.cell_value.view_mut()),
        }
    }
}

fn render<const N: usize>(worley: &Worley<N>, plane: &Plane<N>, window: &Window) -> [Planes<N>; 2]
where
    Dimensions: Space<N>,
{
    let mut planes = [(); 2].map(|()| Planes::new(window.size));
    let views = planes.each_mut().map(Planes::all);
    worley.render_features(plane, window, views).unwrap();
    planes
}

fn planes_are_those_of_samples<const N: usize>(worley: &Worley<N>, plane: &Plane<N>)
where
    Dimensions: Space<N>,
{
    let window = Window::new(DVec2::new(-3.0, 1e6), DVec2::new(4.0, 2.5), [67, 41]).unwrap();
    let planes = render(worley, plane, &window);
    for (row, column) in (0..41).flat_map(|row| (0..67).map(move |column| (row, column))) {
        let at = plane.position(window.position(column, row));
        let features = worley.sample::<2>(at);
        let column = column as usize;
        for (planes, feature) in planes.iter().zip(features) {
            let found = (
                planes.distance.row(row)[column],
                Vector::<N>::from(planes.vector.row(row)[column].map(f64::from)),
                planes.id.row(row)[column],
                planes.cell_value.row(row)[column],
            );
            let expected = (
                feature.distance,
                feature.vector,
                feature.id,
                feature.cell_value(),
            );
            assert_eq!(found, expected, "{column}, {row}");
            let position = planes.position.row(row)[column];
            let cell = position.map(|part| part.floor() as i64);
            let points = worley.cell_points(cell);
            let point = points.iter().find(|point| point.id == feature.id);
            let offset: [f64; N] = point.expect("a point of its cell").offset.into();
            let [at, vector]: [[f64; N]; 2] = [at.into(), feature.vector.into()];
            for axis in 0..N {
                let expected = cell[axis] as f64 + offset[axis];
                assert_eq!(
                    position[axis].to_bits(),
                    expected.to_bits(),
                    "{column}, {row}"
                );
                let from_vector = at[axis] - vector[axis];
                let tolerance = f64::from(POSITION_STEP) * 1.01;
                assert!(
                    (from_vector - expected).abs() <= tolerance,
                    "{from_vector} is not {expected} at {column}, {row}"
                );
            }
        }
    }
}

#[test]
fn planes_of_one_search_are_those_of_samples_bit_for_bit() {
    let worley = Worley::<2>::new(Seed(7));
    planes_are_those_of_samples(&worley, &Plane::default());
    let worley = worley.with_metric(Metric::Minkowski(3.0)).unwrap();
    planes_are_those_of_samples(&worley, &Plane::default());
    let worley = Worley::<3>::new(Seed(7))
        .with_metric(Metric::Chebyshev)
        .unwrap();
    planes_are_those_of_samples(&worley, &Plane::slice([0.0, 0.0, -7.3].into()));
    planes_are_those_of_samples(&Worley::<4>::new(Seed(7)), &Plane::default());
}

#[test]
fn planes_without_a_place_are_not_numbers() {
    let window = Window::new(DVec2::new(0.0, 1e300), DVec2::ONE, [2, 2]).unwrap();
    for planes in render(&Worley::<2>::new(Seed(7)), &Plane::default(), &window) {
        assert!(planes.distance.row(0)[0].is_nan(), "no distance");
        assert!(planes.position.row(0)[0][1].is_nan(), "no position");
        assert!(planes.cell_value.row(0)[0].is_nan(), "no cell");
        assert_eq!(planes.id.row(0)[0], 0, "no point");
    }
}
