//! Converts positions to single precision, and chooses an origin for meshes that need one.

use glam::DVec3;

/// Maximum displacement of a vertex by rounding to `f32`, relative to the extent of the mesh. If it is exceeded,
/// positions are written relative to an origin.
const MOVE_MAX: f64 = 1.0 / (1 << 20) as f64;
/// Minimum ratio of the largest coordinate to the extent at which an origin is used. Below it, an origin would gain
/// less than four bits.
const FAR: f64 = 16.0;
/// Maximum coordinate of a mesh with an origin, so that the sum of a coordinate and the origin is below the limit for
/// positions.
const COORDINATE_MAX: f64 = 1e29;
/// Largest number that is written; chosen so that rounding never exceeds the limit of
/// [`Model::check`](dapple_mesh::Model::check).
const PART_MAX: f32 = 1e30f32.next_down();

/// Returns the origin of a mesh whose positions are too far from zero for single precision; `None` if none is needed.
/// It is the center of the mesh, rounded to a multiple of a power of two below the extent, so that differences lose
/// few bits or none.
pub(crate) fn origin(positions: &[DVec3]) -> Option<DVec3> {
    let first = *positions.first()?;
    let grow = |[least, most]: [DVec3; 2], at: &DVec3| [least.min(*at), most.max(*at)];
    let [least, most] = positions.iter().fold([first; 2], grow);
    let extent = (most - least).max_element();
    let largest = least.abs().max(most.abs()).max_element();
    if largest < FAR * extent || largest > COORDINATE_MAX {
        return None;
    }
    let moved = |at: &DVec3| (at - at.map(|part| f64::from(narrow(part)))).abs();
    let moved = positions.iter().map(|at| moved(at).max_element());
    if moved.fold(0.0, f64::max) <= MOVE_MAX * extent {
        return None;
    }
    // Power of two with the exponent of the extent
    let step = f64::from_bits(extent.to_bits() & f64::INFINITY.to_bits());
    Some((least.midpoint(most)).map(|part| {
        let steps = part / step;
        // Larger numbers are already integers.
        if steps.abs() < (1u64 << 52) as f64 {
            (steps + 0.5).floor() * step
        } else {
            part
        }
    }))
}

/// Rounds to single precision, and clamps to the limit for positions.
pub(crate) fn narrow(part: f64) -> f32 {
    (part as f32).clamp(-PART_MAX, PART_MAX)
}
