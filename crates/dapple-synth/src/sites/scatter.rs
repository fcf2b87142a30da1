//! Random points on a surface, uniformly distributed by area.
//!
//! A face is chosen with a probability in proportion to its area. Then a position in the face is chosen. With two
//! uniform numbers s and t the weights of the corners are `1 - sqrt(s)`, `sqrt(s) (1 - t)` and `sqrt(s) t` (Reference:
//! Greg Turk, "Generating Random Points in Triangles", in Graphics Gems, 1990).

use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_mesh::{FaceIdx, Surface, SurfacePoint};

/// Scatters `n` independent random points over `surface`, uniformly by area.
///
/// Point `i` depends only on the surface, the seed and `i`, so the points for a smaller `n` are a prefix of the points
/// for a larger one.
///
/// # Examples
///
/// ```
/// use dapple_hash::Seed;
/// use dapple_mesh::{Mesh, Surface, glam::DVec3};
/// use dapple_synth::scatter;
///
/// let triangle = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// let points = scatter(&Surface::new(triangle)?, 100, Seed(7));
/// assert!(points.iter().all(|point| point.flat.x >= 0.0 && point.flat.y >= 0.0));
/// # Ok::<(), dapple_synth::SynthError>(())
/// ```
#[must_use]
pub fn scatter(surface: &Surface, n: usize, seed: Seed) -> Vec<SurfacePoint> {
    let faces = (0..surface.mesh().faces().len() as u32).map(FaceIdx);
    let scatter = Scatter::new(surface, faces.collect());
    let seed = seed.child("scattered points", 0);
    (0..n as u64)
        .filter_map(|number| scatter.point(surface, seed, number))
        .collect()
}

/// Sampler of random points on a set of faces of a surface.
#[derive(Debug)]
pub(crate) struct Scatter {
    faces: Vec<FaceIdx>,
    /// Cumulative area of the faces up to and including each face.
    ends: Vec<f64>,
}

impl Scatter {
    pub(crate) fn new(surface: &Surface, faces: Vec<FaceIdx>) -> Self {
        let mut end = 0.0;
        let area_so_far = |&face| {
            end += surface.face_area(face);
            end
        };
        let ends = faces.iter().map(area_so_far).collect();
        Self { faces, ends }
    }

    /// Returns the total area of the faces.
    pub(crate) fn area(&self) -> f64 {
        self.ends.last().copied().unwrap_or(0.0)
    }

    /// Returns a random point on the faces, which `seed` and `number` determine. `None` if there are no faces.
    pub(crate) fn point(&self, surface: &Surface, seed: Seed, number: u64) -> Option<SurfacePoint> {
        let hash = CellHash::new(seed, [number.cast_signed()]);
        let [place, s, t] = [0, 1, 2].map(|counter| unit_f64(hash.at(counter)));
        let place = place * self.area();
        // Search the cumulative areas, so that faces are chosen in proportion to their area.
        let face = self.ends.partition_point(|&end| end <= place);
        // By rounding, the position may be the end of the last face.
        let face = *self.faces.get(face).or(self.faces.last())?;
        let root = s.sqrt();
        let weights = [1.0 - root, root * (1.0 - t), root * t];
        Some(surface.point(face, weights))
    }
}

#[cfg(test)]
mod tests;
