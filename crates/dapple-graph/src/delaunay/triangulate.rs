//! Triangulates images: few of them at once, many one by one, so that the work can be canceled.
//!
//! Reference for many: Nina Amenta, Sunghee Choi and Günter Rote, "Incremental Constructions con BRIO", Symposium on
//! Computational Geometry 2003, <https://doi.org/10.1145/777792.777824>. Images are inserted in random rounds of doubling
//! size, and within a round along a space-filling curve, so that each is near the one before.

use super::order::{farthest_first, in_rounds};
use super::patch::Image;
use super::{Refusal, check};
use crate::IsCancelled;
use robust::{Coord, orient2d};
use spade::handles::FixedVertexHandle;
use spade::{DelaunayTriangulation, Triangulation};

/// Maximum number of images that are triangulated in one call of `spade`, which takes some 30 milliseconds.
const AT_ONCE: usize = 50_000;

/// Number of images that are inserted between two calls of the callback.
const PER_CALL: usize = 4096;

/// Number of collinear images that are many: while all vertices are collinear, `spade` sorts all of them for each
/// insertion.
pub(super) const MANY: usize = 1024;

/// Triangulates images at distinct positions.
///
/// Fails with [`Refusal::Thin`] if many images are collinear.
pub(super) fn triangulate(
    images: &[Image],
    is_cancelled: &IsCancelled,
) -> Result<DelaunayTriangulation<Image>, Refusal> {
    let triangulation = match at_once(images) {
        // Sites are finite integers, which are always accepted.
        Some(order) => DelaunayTriangulation::bulk_load(order).map_err(|_| Refusal::Coincident)?,
        None => one_by_one(images, is_cancelled)?,
    };
    match triangulation.num_vertices() < images.len() {
        true => Err(Refusal::Coincident),
        false => Ok(triangulation),
    }
}

/// Returns the order in which `spade` inserts all images at once; `None` if there are too many, or if it would begin with
/// many collinear ones.
fn at_once(images: &[Image]) -> Option<Vec<Image>> {
    if images.len() > AT_ONCE {
        return None;
    }
    let order = farthest_first(images);
    // The last images come first.
    match order.last_chunk::<MANY>() {
        Some([a, b, rest @ ..]) if rest.iter().all(|c| turn([a, b, c]) == 0.0) => None,
        _ => Some(order),
    }
}

fn one_by_one(
    images: &[Image],
    is_cancelled: &IsCancelled,
) -> Result<DelaunayTriangulation<Image>, Refusal> {
    let mut order = in_rounds(images, is_cancelled)?;
    put_triangle_first(&mut order).ok_or(Refusal::Thin)?;
    let mut triangulation = DelaunayTriangulation::<Image>::new();
    let mut last = FixedVertexHandle::from_index(0);
    for (index, &image) in order.iter().enumerate() {
        if index.is_multiple_of(PER_CALL) {
            check(is_cancelled)?;
        }
        let inserted = match index {
            0 => triangulation.insert(image),
            _ => triangulation.insert_with_hint(image, last),
        };
        last = inserted.map_err(|_| Refusal::Coincident)?;
    }
    Ok(triangulation)
}

/// Moves images that are not collinear to the first three places; `None` if all are collinear.
fn put_triangle_first(order: &mut [Image]) -> Option<()> {
    let first = *order.first()?;
    let is_other = |image: &Image| image.position != first.position;
    order.swap(1, order.iter().position(is_other)?);
    let second = order[1];
    let is_beside = |image: &Image| turn([&first, &second, image]) != 0.0;
    order.swap(2, order.iter().position(is_beside)?);
    Some(())
}

/// Returns a number with the sign of the turn from the first to the third image, 0 if they are collinear.
fn turn(images: [&Image; 3]) -> f64 {
    let [a, b, c] = images.map(|image| Coord {
        x: image.position.x,
        y: image.position.y,
    });
    orient2d(a, b, c)
}

#[cfg(test)]
mod tests {
    use super::{at_once, one_by_one};
    use crate::delaunay::patch::Image;
    use dapple_points::hash::{Seed, rand_core::Rng, unit_f64};
    use glam::DVec2;
    use spade::{DelaunayTriangulation, Triangulation};

    /// Returns the edges of a triangulation as sorted pairs of points.
    fn edges(triangulation: &DelaunayTriangulation<Image>) -> Vec<[u32; 2]> {
        let edges = triangulation.undirected_edges();
        let ends = edges.map(|edge| edge.vertices().map(|vertex| vertex.data().point));
        let mut ends: Vec<_> = ends.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        ends.sort_unstable();
        ends
    }

    #[test]
    fn one_by_one_equals_all_at_once() {
        let mut stream = Seed(3).stream();
        let mut unit = || unit_f64(stream.next_u64());
        let uniform: Vec<_> = (0..3000).map(|_| DVec2::new(unit(), unit())).collect();
        let on_circle = |at: &DVec2| DVec2::new(at.x, (1.0 - at.x * at.x).sqrt());
        let squared = |at: &DVec2| *at * *at;
        let sets = [
            uniform.clone(),
            uniform.iter().map(squared).map(|at| squared(&at)).collect(),
            uniform.iter().map(on_circle).collect(),
            uniform
                .iter()
                .map(|at| DVec2::new(at.x, 1e-9 * at.y))
                .collect(),
        ];
        for (set, positions) in sets.into_iter().enumerate() {
            let site = |at: DVec2| (at * (1_u64 << 50) as f64).round();
            let images = (0..)
                .zip(positions)
                .map(|(point, at)| Image::new(site(at), point, point));
            let images: Vec<_> = images.collect();
            let order = at_once(&images).expect("these are few");
            let expected = DelaunayTriangulation::bulk_load(order).unwrap();
            let made = one_by_one(&images, &|| false).unwrap();
            assert_eq!(edges(&made), edges(&expected), "set {set}");
        }
    }
}
