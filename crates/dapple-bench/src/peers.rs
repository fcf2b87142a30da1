//! The peers, each in its fastest configuration: the performance advice in its documentation is followed, and memory
//! is reused between calls.
//!
//! * `spade` interpolates inside the convex hull of its points. It therefore gets a point set of the unit torus
//!   with the copies within a margin, which makes it defined in the whole unit square. The interpolators reuse their
//!   buffers. An image is scanned in serpentine order, so that the last vertex, where `spade` starts to search for a
//!   position, is always near. For scattered positions it uses its hierarchy of triangulations.
//! * `bluenoise` makes few attempts (10) per point, as in its own examples; more are slower.
//! * `poisson-diskus` and `fast_poisson` make the 30 attempts that they recommend. `fast_poisson` is not periodic.
//! * `simdnoise` and `noise-functions` are in `noise`, `rustfft` in `fourier`, `texture-synthesis` in `flat`, `kiddo`
//!   in `kd_tree`.

pub(crate) mod filter;
pub(crate) mod flat;
pub(crate) mod fourier;
pub(crate) mod kd_tree;
pub(crate) mod noise;

use dapple_points::glam::DVec2;
use rand_08::SeedableRng as _;
use spade::{
    DelaunayTriangulation, FloatTriangulation as _, HasPosition, HierarchyHintGenerator,
    HintGenerator, LastUsedVertexHintGenerator, Point2, Triangulation as _,
};

/// A position with a value, as a vertex for `spade`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    position: Point2<f64>,
    value: f64,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// `spade` with the last used vertex as a hint, for positions near the previous one.
pub(crate) type ScanlineSpade = Spade<LastUsedVertexHintGenerator>;

/// `spade` with a hierarchy of triangulations as a hint, for scattered positions.
pub(crate) type ScatteredSpade = Spade<HierarchyHintGenerator<f64>>;

/// A triangulation of a periodic point set that covers the unit square.
#[derive(Debug)]
pub(crate) struct Spade<L: HintGenerator<f64>> {
    triangulation: DelaunayTriangulation<Site, (), (), (), L>,
}

impl<L: HintGenerator<f64>> Spade<L> {
    /// Triangulates points with values, and copies of the points within `margin` of the sides of the unit square.
    ///
    /// # Panics
    ///
    /// If a position is not finite.
    pub(crate) fn new(positions: &[DVec2], values: &[f32], margin: f64) -> Self {
        let mut sites = Vec::new();
        for (position, &value) in positions.iter().zip(values) {
            for shift in [-1.0, 0.0, 1.0]
                .map(|y| [-1.0, 0.0, 1.0].map(|x| DVec2::new(x, y)))
                .as_flattened()
            {
                let at = *position + *shift;
                if at.cmpge(DVec2::splat(-margin)).all()
                    && at.cmple(DVec2::splat(1.0 + margin)).all()
                {
                    sites.push(Site {
                        position: Point2::new(at.x, at.y),
                        value: f64::from(value),
                    });
                }
            }
        }
        let triangulation =
            DelaunayTriangulation::bulk_load(sites).expect("positions of a point set are finite");
        Self { triangulation }
    }

    /// Fills a square image of the unit square by natural neighbor interpolation.
    pub(crate) fn natural_neighbor(&self, side: usize, image: &mut [f32]) {
        let interpolator = self.triangulation.natural_neighbor();
        serpentine(side, image, |at| {
            interpolator.interpolate(|vertex| vertex.data().value, at)
        });
    }

    /// Fills a square image of the unit square by barycentric interpolation.
    pub(crate) fn barycentric(&self, side: usize, image: &mut [f32]) {
        let interpolator = self.triangulation.barycentric();
        serpentine(side, image, |at| {
            interpolator.interpolate(|vertex| vertex.data().value, at)
        });
    }

    /// Interpolates at each position by natural neighbor interpolation.
    pub(crate) fn natural_neighbor_at(&self, positions: &[DVec2], values: &mut [f32]) {
        let interpolator = self.triangulation.natural_neighbor();
        for (at, value) in positions.iter().zip(values) {
            let at = Point2::new(at.x, at.y);
            *value = or_nan(interpolator.interpolate(|vertex| vertex.data().value, at));
        }
    }
}

/// Fills an image of the unit square with the values that `value_at` returns. Every other row is visited from right to
/// left.
fn serpentine(side: usize, image: &mut [f32], value_at: impl Fn(Point2<f64>) -> Option<f64>) {
    let pixel = 1.0 / side as f64;
    for (row, values) in image.chunks_exact_mut(side).enumerate() {
        let y = (row as f64 + 0.5) * pixel;
        let mut fill = |(column, value): (usize, &mut f32)| {
            *value = or_nan(value_at(Point2::new((column as f64 + 0.5) * pixel, y)));
        };
        if row % 2 == 0 {
            values.iter_mut().enumerate().for_each(&mut fill);
        } else {
            values.iter_mut().enumerate().rev().for_each(&mut fill);
        }
    }
}

/// Returns the value as `f32`, or NaN where a peer has no value.
fn or_nan(value: Option<f64>) -> f32 {
    value.map_or(f32::NAN, |value| value as f32)
}

/// Converts positions to `spade`'s point type.
pub(crate) fn spade_positions(positions: &[DVec2]) -> Vec<Point2<f64>> {
    positions.iter().map(|at| Point2::new(at.x, at.y)).collect()
}

/// Returns the bounded triangulation of a list of positions. `spade` takes ownership of the list.
///
/// # Panics
///
/// If a position is not finite.
pub(crate) fn spade_bulk_load(positions: Vec<Point2<f64>>) -> DelaunayTriangulation<Point2<f64>> {
    DelaunayTriangulation::bulk_load(positions).expect("positions of a point set are finite")
}

/// Returns the number of vertices of a triangulation.
pub(crate) fn n_vertices(triangulation: &DelaunayTriangulation<Point2<f64>>) -> usize {
    triangulation.num_vertices()
}

/// Generates points with `bluenoise` on a torus with the given side, at least 1 apart.
pub(crate) fn bluenoise(side: f32, seed: u64) -> Vec<[f32; 2]> {
    let mut noise =
        bluenoise::WrappingBlueNoise::<rand_09::rngs::SmallRng>::from_seed(side, side, 1.0, seed);
    noise.with_samples(10);
    noise.map(|at| [at.x, at.y]).collect()
}

/// Generates points with `poisson-diskus` on the unit torus.
///
/// # Panics
///
/// If the radius is not positive.
pub(crate) fn poisson_diskus(radius: f64, seed: u64) -> Vec<[f64; 2]> {
    let mut rng = rand_08::rngs::SmallRng::seed_from_u64(seed);
    poisson_diskus::bridson_rng(&[1.0, 1.0], radius, 30, true, &mut rng)
        .expect("the radius is positive")
}

/// Generates points with `fast_poisson` in the unit square, which does not wrap.
pub(crate) fn fast_poisson(radius: f64, seed: u64) -> Vec<[f64; 2]> {
    fast_poisson::Poisson2D::new()
        .with_dimensions([1.0, 1.0], radius)
        .with_seed(seed)
        .generate()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a grid of points, and values that are linear except at the seam of the torus.
    fn grid() -> (Vec<DVec2>, Vec<f32>) {
        let steps = || (0..16).map(|i| (f64::from(i) + 0.5) / 16.0);
        let positions: Vec<DVec2> = steps()
            .flat_map(|y| steps().map(move |x| DVec2::new(x, y)))
            .collect();
        let values = positions.iter().map(|at| at.x as f32).collect();
        (positions, values)
    }

    #[test]
    fn spade_rasters_cover_the_square_and_reproduce_a_linear_function() {
        let (positions, values) = grid();
        let spade = ScanlineSpade::new(&positions, &values, 0.25);
        let mut image = vec![0.0; 64 * 64];
        for fill in [ScanlineSpade::natural_neighbor, ScanlineSpade::barycentric] {
            fill(&spade, 64, &mut image);
            assert!(
                image.iter().all(|value: &f32| value.is_finite()),
                "the margin covers the square"
            );
            // Only the inside of the square is checked, away from the seam, where the values jump.
            for (index, value) in image
                .iter()
                .enumerate()
                .filter(|(index, _)| (8..56).contains(&(index % 64)))
            {
                let x = ((index % 64) as f32 + 0.5) / 64.0;
                assert!(
                    (value - x).abs() < 1e-5,
                    "linear precision, up to f32: {value} at {x}"
                );
            }
        }
    }

    #[test]
    fn scattered_spade_equals_scanline_spade() {
        let (positions, values) = grid();
        let scattered = ScatteredSpade::new(&positions, &values, 0.25);
        let mut image = vec![0.0; 16 * 16];
        ScanlineSpade::new(&positions, &values, 0.25).natural_neighbor(16, &mut image);
        let mut one_by_one = vec![0.0; 16 * 16];
        scattered.natural_neighbor_at(&positions, &mut one_by_one);
        for (one, pixel) in one_by_one.iter().zip(&image) {
            assert!(
                (one - pixel).abs() < 1e-6,
                "the grid's points are the pixel centers: {one} and {pixel}"
            );
        }
    }
}
