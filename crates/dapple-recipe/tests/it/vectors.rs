//! Checks that fields take positions in the vectors of other libraries, such as another version of glam.

use dapple_hash::Seed;
use dapple_noise::{GradientNoise2, GradientNoise3};
use dapple_points::{Domain, PointIdx, white_noise};
use dapple_pups::Pups;
use dapple_raster::{FieldExt, FractalShape, field_fn, glam::DVec2};
use dapple_wavelet::{WaveletNoise2, WaveletNoise3};
use dapple_worley::{Combination, Worley2, Worley3};

/// A vector of another library. Like the vectors of every version of glam, it converts to an array.
#[derive(Clone, Copy)]
struct Foreign<const N: usize>([f64; N]);

impl<const N: usize> From<Foreign<N>> for [f64; N] {
    fn from(vector: Foreign<N>) -> Self {
        vector.0
    }
}

const PLANE: [f64; 2] = [0.3, -0.7];
const SPACE: [f64; 3] = [0.3, -0.7, 5.25];

/// Checks that a call has the same result for an array, for glam's vector and for another library's vector.
macro_rules! same_in_the_plane {
    ($position:ident => $call:expr) => {{
        let of_array = {
            let $position = PLANE;
            $call
        };
        let of_glam = {
            let $position = DVec2::from_array(PLANE);
            $call
        };
        let of_other = {
            let $position = Foreign(PLANE);
            $call
        };
        assert_eq!(of_array, of_glam, "{}", stringify!($call));
        assert_eq!(of_array, of_other, "{}", stringify!($call));
    }};
}

#[test]
fn noise_and_cells_take_any_vector() {
    let noise = GradientNoise2::new(Seed(7));
    let worley = Worley2::new(Seed(7));
    let cells = worley.combine(Combination::F2_MINUS_F1);
    let wavelet = WaveletNoise2::new(16, Seed(7)).unwrap();
    same_in_the_plane!(at => noise.sample(at));
    same_in_the_plane!(at => noise.sample_with_gradient(at));
    same_in_the_plane!(at => worley.sample::<2>(at));
    same_in_the_plane!(at => worley.nearest(at));
    same_in_the_plane!(at => worley.edge_distance(at));
    same_in_the_plane!(at => cells.sample(at));
    same_in_the_plane!(at => wavelet.sample(at));
    same_in_the_plane!(at => wavelet.sample_with_gradient(at));

    let octaves = noise.fractal(3, 0.5, 2.0, FractalShape::Ridged).unwrap();
    let composed = octaves
        .warp([&noise, &noise], 0.3)
        .offset(Foreign([0.5, 0.25]))
        .mul(&cells)
        .max(&wavelet);
    same_in_the_plane!(at => composed.sample(at));
    same_in_the_plane!(at => {
        let mut value = [0.0];
        composed.sample_many(&[at], &mut value).unwrap();
        value
    });
    let own = field_fn(|[x, y]| (x - y) as f32);
    same_in_the_plane!(at => own.sample(at));

    // In space
    let [noise, cells] = [GradientNoise3::new(Seed(7)), GradientNoise3::new(Seed(8))];
    assert_eq!(noise.sample(SPACE), noise.sample(Foreign(SPACE)));
    let sum = noise.add(cells);
    assert_eq!(sum.sample(SPACE), sum.sample(Foreign(SPACE)));
    let worley = Worley3::new(Seed(7));
    assert_eq!(worley.nearest(SPACE), worley.nearest(Foreign(SPACE)));
    let wavelet = WaveletNoise3::new(8, Seed(7)).unwrap();
    assert_eq!(wavelet.sample(SPACE), wavelet.sample(Foreign(SPACE)));
}

#[test]
fn textures_of_control_points_take_any_vector() {
    let points = white_noise(Domain::paper_torus(), 40, Seed(1)).unwrap();
    let pups = Pups::delaunay(&points).unwrap();
    same_in_the_plane!(at => pups.weight(PointIdx(3), at));
    same_in_the_plane!(at => pups.weights(at));
    same_in_the_plane!(at => pups.strongest(at));
    let values = (0..40).map(|value| value as f32).collect();
    let texture = pups.texture(values).unwrap();
    same_in_the_plane!(at => texture.sample(at));
    same_in_the_plane!(at => texture.gradient(at));
}
