//! Directions of the pixels of images around a point: equirectangular images, and the six faces of a cube.
//!
//! A field in space that is sampled at these directions covers a sphere without a seam. Samples are at pixel centers, or
//! on corners, where opposite sides of an equirectangular image and neighboring faces have the same directions, bit for
//! bit.
//!
//! Axes are those of OpenGL and glTF: x to the right, y up, z toward the viewer. Directions have the length 1.

use core::cmp::Ordering;
use core::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

/// An equirectangular image: longitude to the right, latitude from +90° at the top to −90° at the bottom. The center looks
/// along +x, and the center of the right half along +z, as in three.js.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Equirectangular {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Whether samples are on corners: the last column is the first, and the first and last row are the poles.
    pub on_corners: bool,
}

dapple_raster::named! {
    /// A face of a cube map.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum CubeFace {
        /// Around +x.
        PositiveX = "px",
        /// Around −x.
        NegativeX = "nx",
        /// Around +y, up.
        PositiveY = "py",
        /// Around −y, down.
        NegativeY = "ny",
        /// Around +z.
        PositiveZ = "pz",
        /// Around −z.
        NegativeZ = "nz",
    }
}

/// A cube map. Its faces are oriented as in OpenGL, with the first row at the top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CubeMap {
    /// Width and height of a face, in pixels.
    pub side: u32,
    /// Whether samples are on corners: neighboring faces share the samples of their edge.
    pub on_corners: bool,
}

impl Equirectangular {
    /// Returns the directions of a row of pixels.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_noise::hash::Seed;
    /// use dapple_noise::{Equirectangular, GradientNoise3};
    ///
    /// let planet = Equirectangular { size: [8, 5], on_corners: true };
    /// let noise = GradientNoise3::new(Seed(7));
    /// let equator = planet.directions(2).map(|[x, y, z]| noise.sample([4.5 * x, 4.5 * y, 4.5 * z]));
    /// let values: Vec<f32> = equator.collect();
    /// assert_eq!(values[0], values[7]);
    /// ```
    pub fn directions(self, row: u32) -> impl Iterator<Item = [f64; 3]> {
        let [width, height] = self.size;
        // The row is an angle from the pole in half turns.
        let (latitude, half_turn) = fraction(row, height, self.on_corners);
        let [up, radius] = turned(latitude, 2 * half_turn);
        (0..width).map(move |column| {
            let (longitude, turn) = fraction(column, width, self.on_corners);
            let [x, z] = turned(longitude, turn);
            // The first column looks along −x. Adding 0 turns −0 into 0.
            [-radius * x + 0.0, up + 0.0, -radius * z + 0.0]
        })
    }
}

impl CubeMap {
    /// Returns the directions of a row of pixels of a face.
    pub fn directions(self, face: CubeFace, row: u32) -> impl Iterator<Item = [f64; 3]> {
        // From −1 to 1, with the same bits on both sides of 0
        let coordinate = move |index: u32| {
            let (part, whole) = fraction(index, self.side, self.on_corners);
            (2.0 * part as f64 - whole as f64) / whole as f64
        };
        let t = coordinate(row);
        (0..self.side).map(move |column| {
            let s = coordinate(column);
            let [x, y, z] = match face {
                CubeFace::PositiveX => [1.0, -t, -s],
                CubeFace::NegativeX => [-1.0, -t, s],
                CubeFace::PositiveY => [s, 1.0, t],
                CubeFace::NegativeY => [s, -1.0, -t],
                CubeFace::PositiveZ => [s, -t, 1.0],
                CubeFace::NegativeZ => [-s, -t, -1.0],
            };
            let length = (x * x + y * y + z * z).sqrt();
            // Adding 0 turns −0 into 0, which are on different faces.
            [x, y, z].map(|part| part / length + 0.0)
        })
    }
}

/// Returns the position of a sample along a side as a fraction: numerator and denominator.
fn fraction(index: u32, count: u32, on_corners: bool) -> (u64, u64) {
    let (index, count) = (u64::from(index), u64::from(count));
    match on_corners {
        true => (index, count.saturating_sub(1).max(1)),
        false => (2 * index + 1, 2 * count.max(1)),
    }
}

/// Returns the cosine and the sine of `part` / `whole` turns. They are computed from an angle of at most an eighth turn, so
/// that they have the symmetries of a circle, bit for bit.
fn turned(part: u64, whole: u64) -> [f64; 2] {
    let part = part % whole;
    let quarter = 4 * part / whole;
    let rest = 4 * part - quarter * whole;
    let near = rest.min(whole - rest);
    let (sin, cos) = libm::sincos(FRAC_PI_2 * near as f64 / whole as f64);
    let [cos, sin] = match rest.cmp(&(whole - rest)) {
        Ordering::Less => [cos, sin],
        // The cosine and the sine of an eighth turn round differently.
        Ordering::Equal => [FRAC_1_SQRT_2; 2],
        Ordering::Greater => [sin, cos],
    };
    match quarter {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}

#[cfg(test)]
mod tests {
    use super::{CubeFace, CubeMap, Equirectangular, turned};
    use core::f64::consts::TAU;
    use dapple_raster::Named as _;

    fn bits(directions: &[[f64; 3]]) -> Vec<[u64; 3]> {
        directions.iter().map(|at| at.map(f64::to_bits)).collect()
    }

    #[test]
    fn turns_are_those_of_libm_with_exact_symmetries() {
        for (part, whole) in (1..40).flat_map(|whole| (0..whole).map(move |part| (part, whole))) {
            let angle = TAU * part as f64 / whole as f64;
            let [cos, sin] = turned(part, whole);
            // The angle of up to 2 π rounds in libm's argument.
            assert!(
                (cos - libm::cos(angle)).abs() < 4e-15 && (sin - libm::sin(angle)).abs() < 4e-15
            );
            let [again, minus] = turned(whole - part, whole);
            assert_eq!([again, minus + 0.0], [cos, -sin + 0.0], "{part} of {whole}");
        }
        assert_eq!(turned(3, 12), [-0.0, 1.0]);
    }

    #[test]
    fn an_equirectangular_image_meets_itself_and_ends_in_poles() {
        let map = Equirectangular {
            size: [17, 9],
            on_corners: true,
        };
        let row = |row: u32| map.directions(row).collect::<Vec<_>>();
        for index in 0..9 {
            let row = row(index);
            assert_eq!(bits(&row[..1]), bits(&row[16..]), "row {index}");
        }
        assert_eq!(row(0), [[0.0, 1.0, 0.0]; 17]);
        assert_eq!(row(8), [[0.0, -1.0, 0.0]; 17]);
        assert_eq!(row(4)[8], [1.0, 0.0, 0.0], "the center looks along x");
        assert_eq!(row(4)[12], [0.0, 0.0, 1.0]);
        // With samples at centers, the step across the sides is a step like any other.
        let map = Equirectangular {
            on_corners: false,
            ..map
        };
        let row: Vec<_> = map.directions(3).collect();
        let step = |a: [f64; 3], b: [f64; 3]| -> f64 {
            let differences = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
            differences.iter().map(|part| part * part).sum()
        };
        assert!((step(row[16], row[0]) - step(row[4], row[5])).abs() < 1e-15);
    }

    #[test]
    fn faces_of_a_cube_share_their_edges() {
        for side in [5, 6] {
            let last = side as usize - 1;
            let map = CubeMap {
                side,
                on_corners: true,
            };
            let mut edges: Vec<[u64; 3]> = Vec::new();
            for &face in CubeFace::ALL {
                let rows: Vec<Vec<_>> = (0..side)
                    .map(|row| map.directions(face, row).collect())
                    .collect();
                assert!(rows.iter().flatten().all(|direction: &[f64; 3]| {
                    let square: f64 = direction.iter().map(|part| part * part).sum();
                    (square - 1.0).abs() < 1e-15
                }));
                edges.extend(bits(&rows[0]));
                edges.extend(bits(&rows[last]));
                for row in &rows[1..last] {
                    edges.extend(bits(&[row[0], row[last]]));
                }
            }
            // A cube has 8 corners on three faces each, and 12 edges whose inner samples are on two faces each.
            edges.sort_unstable();
            let (mut on_two, mut on_three) = (0, 0);
            for same in edges.chunk_by(|a, b| a == b) {
                match same.len() {
                    2 => on_two += 1,
                    3 => on_three += 1,
                    count => panic!("a direction on {count} faces of {side}"),
                }
            }
            assert_eq!((on_two, on_three), (12 * (last - 1), 8), "{side}");
        }
    }

    #[test]
    fn faces_are_turned_as_in_opengl() {
        let map = CubeMap {
            side: 1,
            on_corners: false,
        };
        let centers: Vec<_> = CubeFace::ALL
            .iter()
            .flat_map(|&face| map.directions(face, 0))
            .map(|direction| direction.map(|part| part as i32))
            .collect();
        let expected = [
            [1, 0, 0],
            [-1, 0, 0],
            [0, 1, 0],
            [0, -1, 0],
            [0, 0, 1],
            [0, 0, -1],
        ];
        assert_eq!(centers, expected);
        let map = CubeMap { side: 2, ..map };
        // The upper left pixel of +x is near +y and +z, and that of +y near −x and −z.
        let first = |face| map.directions(face, 0).next().unwrap().map(f64::signum);
        assert_eq!(first(CubeFace::PositiveX), [1.0, 1.0, 1.0]);
        assert_eq!(first(CubeFace::PositiveY), [-1.0, 1.0, -1.0]);
    }
}
