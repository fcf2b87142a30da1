//! The Delaunay graph, in the plane and on domains that wrap.

use crate::lattice::Lattice;
use crate::{Axis, Graph, GraphError};
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;
use robust::{Coord, incircle};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

/// A point's image.
#[derive(Clone, Copy)]
struct Site {
    position: Point2<f64>,
    point: u32,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// The Delaunay graph: two points are connected if some circle through both has no point on it or in it besides them,
/// counting all images.
///
/// # Errors
///
/// [`Coincident`](crate::GraphErrorKind::Coincident) if two points lie at the same place.
pub fn delaunay(points: &PointSet) -> Result<Graph, GraphError> {
    let lattice = Lattice::new(points.domain());
    let sites = lattice.sites(points);
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let key = |&i: &u32| (sites[i as usize].x as u64, sites[i as usize].y as u64, i);
    order.sort_unstable_by_key(key);
    for pair in order.windows(2) {
        if sites[pair[0] as usize] == sites[pair[1] as usize] {
            return Err(GraphError::coincident(PointIdx(pair[0]), PointIdx(pair[1])));
        }
    }
    // First the points themselves, then their images.
    let image = |at: DVec2, point: u32| Site {
        position: Point2::new(at.x, at.y),
        point,
    };
    let mut all: Vec<Site> = Vec::new();
    let margin = match lattice.wrap {
        [true, true] => lattice.size.length(),
        _ => 2.3 * lattice.size.length(),
    };
    let reach = |axis: usize| {
        if lattice.wrap[axis] {
            (margin / lattice.size[axis]).ceil()
        } else {
            0.0
        }
    };
    let (rx, ry) = (reach(0), reach(1));
    let mut ky = -ry;
    while ky <= ry {
        let mut kx = -rx;
        while kx <= rx {
            for (i, &site) in sites.iter().enumerate() {
                let at = site + lattice.size * DVec2::new(kx, ky);
                let own = kx == 0.0 && ky == 0.0;
                let inside =
                    at.min_element() >= -margin && (at - lattice.size).max_element() <= margin;
                if own || inside {
                    all.push(image(at, i as u32));
                }
            }
            kx += 1.0;
        }
        ky += 1.0;
    }
    let triangulation =
        DelaunayTriangulation::<Site>::bulk_load(all).expect("lattice sites are in spade's range");
    let mut rows: Vec<Vec<Axis>> = vec![Vec::new(); points.len()];
    for vertex in triangulation.vertices() {
        let site = *vertex.data();
        let p = DVec2::new(site.position.x, site.position.y);
        if p != sites[site.point as usize] {
            continue;
        }
        for edge in vertex.out_edges() {
            let to = edge.to();
            let opposite = [edge.opposite_position(), edge.rev().opposite_position()];
            if let [Some(c), Some(d)] = opposite {
                let coord = |p: Point2<f64>| Coord { x: p.x, y: p.y };
                if incircle(
                    coord(site.position),
                    coord(to.position()),
                    coord(c),
                    coord(d),
                ) == 0.0
                {
                    continue;
                }
            }
            let steps = DVec2::new(to.position().x, to.position().y) - p;
            rows[site.point as usize].push(Axis {
                to: PointIdx(to.data().point),
                vector: lattice.vector(steps),
            });
        }
    }
    let mut offsets = vec![0];
    let mut axes = Vec::new();
    for mut row in rows {
        row.sort_unstable_by(Axis::order);
        axes.append(&mut row);
        offsets.push(axes.len() as u32);
    }
    Ok(Graph {
        lattice,
        sites,
        offsets,
        axes,
        symmetric: true,
    })
}

#[cfg(test)]
mod tests {
    use super::delaunay;
    use dapple_points::{Domain, PointIdx, PointSet};
    use glam::DVec2;

    #[test]
    fn delaunay_of_a_grid_on_a_torus_has_four_axes_each() {
        for n in [1, 2, 3, 4, 10] {
            let positions = (0..n * n)
                .map(|i| DVec2::new(f64::from(i % n), f64::from(i / n)) / f64::from(n))
                .collect();
            let set = PointSet::new(Domain::torus(DVec2::ZERO, DVec2::ONE), positions).unwrap();
            let graph = delaunay(&set).unwrap();
            for point in (0..set.len() as u32).map(PointIdx) {
                assert_eq!(graph.axes(point).len(), 4, "{n} {point:?}");
            }
            assert!(graph.every_axis_has_its_opposite(), "{n}");
        }
    }
}
