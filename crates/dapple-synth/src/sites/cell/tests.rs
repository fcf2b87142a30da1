//! Tests of Voronoi cells against a brute-force oracle and a triangulation by spade.

use super::*;
use dapple_hash::{Seed, hash1, unit_f64};
use spade::{DelaunayTriangulation, Point2, Triangulation};

fn random(seed: u64, n: i64, counter: u32) -> Vec<DVec2> {
    let part = |number, counter| 2.0 * unit_f64(hash1(Seed(seed), [number], counter)) - 1.0;
    (0..n)
        .map(|number| DVec2::new(part(number, counter), part(number, counter + 1)))
        .collect()
}

/// Returns the tags of the neighbors of the origin, sorted, and whether all of them are joined.
fn star(points: &[DVec2]) -> (Vec<u32>, bool) {
    let mut sorted: Vec<(u32, DVec2)> = (0..).zip(points.iter().copied()).collect();
    sorted.sort_by(|a, b| a.1.length_squared().total_cmp(&b.1.length_squared()));
    let mut cell = Cell::default();
    cell.clear();
    for (tag, at) in sorted {
        cell.clip(at, tag);
    }
    let all: Vec<Neighbor> = cell.neighbors(f64::INFINITY).collect();
    let mut tags: Vec<u32> = all.iter().map(|neighbor| neighbor.tag).collect();
    tags.sort_unstable();
    (tags, all.iter().all(|neighbor| neighbor.joined))
}

/// Returns the neighbors of the origin in spade's triangulation of the origin and the points.
fn spade_star(points: &[DVec2]) -> Vec<u32> {
    let mut triangulation = DelaunayTriangulation::<Point2<f64>>::new();
    let center = triangulation.insert(Point2::new(0.0, 0.0)).unwrap();
    let mut tags = vec![u32::MAX];
    for (tag, at) in (0..).zip(points) {
        let handle = triangulation.insert(Point2::new(at.x, at.y)).unwrap();
        assert_eq!(handle.index(), tags.len(), "the points must differ");
        tags.push(tag);
    }
    let edges = triangulation.vertex(center).out_edges();
    let mut star: Vec<u32> = edges.map(|edge| tags[edge.to().index()]).collect();
    star.sort_unstable();
    star
}

/// Returns the neighbors of the origin by brute force: the points that lie on an empty circle through the origin. The
/// side of a neighbor is a segment of positive length, a ray, or a line.
fn naive_star(points: &[DVec2]) -> Vec<u32> {
    let in_circle = |a: DVec2, b: DVec2, c: DVec2| {
        order(incircle(coord(DVec2::ZERO), coord(a), coord(b), coord(c)))
    };
    let is_neighbor = |&tag: &u32| {
        let a = points[tag as usize];
        let others = || {
            points
                .iter()
                .copied()
                .enumerate()
                .filter(move |(other, _)| *other != tag as usize)
        };
        // Circles through the origin and a: on either side the first point hit bounds the position of the center. That
        // point is the one whose circle has no other point of this side inside.
        let left = others().filter(|(_, b)| turns(a, *b).is_gt());
        let right = others().filter(|(_, b)| turns(a, *b).is_lt());
        let first_left = left.reduce(|b, c| if in_circle(a, b.1, c.1).is_gt() { c } else { b });
        let first_right = right.reduce(|b, c| if in_circle(b.1, a, c.1).is_gt() { c } else { b });
        let between = others().any(|(_, b)| {
            turns(a, b).is_eq() && a.dot(b) > 0.0 && b.length_squared() < a.length_squared()
        });
        let allowed = match (first_left, first_right) {
            (Some((_, b)), Some((_, c))) => in_circle(a, b, c).is_lt(),
            _ => true,
        };
        allowed && !between
    };
    (0..points.len() as u32).filter(is_neighbor).collect()
}

#[test]
fn cell_has_the_neighbors_of_spade_for_random_points() {
    for seed in 0..400 {
        let points = random(seed, 3 + seed as i64 % 40, 0);
        let (tags, _) = star(&points);
        assert_eq!(tags, naive_star(&points), "seed {seed}, naive {points:?}");
        assert_eq!(tags, spade_star(&points), "seed {seed} {points:?}");
    }
}

#[test]
fn cell_has_the_neighbors_of_the_naive_rule_on_lattices() {
    // With small integer coordinates, most points are on a line or a circle with others.
    for seed in 0..2000 {
        let size = 2.0 + (seed % 4) as f64;
        let mut points: Vec<DVec2> = random(seed, 3 + seed as i64 % 12, 0)
            .into_iter()
            .map(|at| (at * size).round() + DVec2::ZERO)
            .filter(|at| *at != DVec2::ZERO)
            .collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        points.dedup();
        assert_eq!(
            star(&points).0,
            naive_star(&points),
            "seed {seed}: {points:?}"
        );
    }
}

#[test]
fn cell_has_the_neighbors_of_the_naive_rule_nearly_on_a_circle() {
    // Points on a circle through the origin, off by a few rounding units.
    for seed in 0..500 {
        let center = random(seed, 1, 7)[0];
        let points: Vec<DVec2> = random(seed, 9, 0)
            .into_iter()
            .map(|at| center + at.normalize() * center.length())
            .collect();
        let (tags, _) = star(&points);
        assert_eq!(tags, naive_star(&points), "seed {seed}");
        let unique = points.iter().enumerate().all(|(index, a)| {
            points[..index].iter().enumerate().all(|(other, b)| {
                points[..other]
                    .iter()
                    .all(|c| incircle(coord(DVec2::ZERO), coord(*a), coord(*b), coord(*c)) != 0.0)
            })
        });
        if unique {
            assert_eq!(tags, spade_star(&points), "seed {seed}, spade");
        }
    }
}

#[test]
fn cell_takes_no_diagonal_of_a_square_and_of_an_octagon() {
    let square = [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(DVec2::from);
    assert_eq!(star(&square).0, [0, 1], "the corner across is no neighbor");
    // Corners of an octagon with integer coordinates, relative to one of them.
    let octagon = [
        [2.0, 0.0],
        [3.0, 1.0],
        [3.0, 3.0],
        [2.0, 4.0],
        [0.0, 4.0],
        [-1.0, 3.0],
        [-1.0, 1.0],
    ];
    let octagon = octagon.map(DVec2::from);
    // All corners lie on one circle through the origin, so only the first ones on either side are neighbors.
    assert_eq!(star(&octagon).0, [0, 6], "only the corners beside it");
}

#[test]
fn cell_is_open_until_points_are_all_around() {
    let mut cell = Cell::default();
    cell.clear();
    let joined = |cell: &Cell| {
        cell.neighbors(f64::INFINITY)
            .filter(|neighbor| neighbor.joined)
            .count()
    };
    for (tag, (at, triangles)) in [
        ([1.0, 0.0], 0),
        ([-1.0, 0.0], 0),
        ([0.0, 1.0], 2),
        ([0.0, -1.5], 4),
    ]
    .into_iter()
    .enumerate()
    {
        assert_eq!(cell.diameter_sq(), f64::INFINITY, "before point {tag}");
        cell.clip(at.into(), tag as u32);
        assert_eq!(joined(&cell), triangles, "after point {tag}");
    }
    // The largest circle passes through the origin, [1, 0] and [0, -1.5].
    assert!(
        (cell.diameter_sq() - 3.25).abs() < 1e-12,
        "the bound is tight but for rounding: {}",
        cell.diameter_sq()
    );
}

#[test]
fn neighbors_past_the_limit_are_left_out() {
    let mut cell = Cell::default();
    cell.clear();
    for (tag, at) in [[0.0, 1.0], [2.0, 0.5], [-2.0, 0.5]]
        .into_iter()
        .enumerate()
    {
        cell.clip(at.into(), tag as u32);
    }
    let within = |limit: f64| {
        cell.neighbors(limit)
            .map(|neighbor| neighbor.tag)
            .collect::<Vec<_>>()
    };
    assert_eq!(within(100.0).len(), 3, "all lie on small empty circles");
    assert_eq!(
        within(4.0),
        [0],
        "the others are farther away than the diameter"
    );
    assert_eq!(within(0.5).len(), 0, "none is that near");
}
