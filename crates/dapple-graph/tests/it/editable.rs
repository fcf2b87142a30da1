//! Compares edits of a graph, one by one, with a new graph of the same points.

use dapple_graph::{EditableDelaunay, GraphErrorKind, PointIdx, PointSet, Star, delaunay};
use dapple_points::hash::{Seed, rand_core::Rng, unit_f64};
use dapple_points::{Domain, poisson_disk, white_noise};
use glam::DVec2;

/// Random numbers for a test.
struct Dice(Box<dyn Rng>);

impl Dice {
    fn unit(&mut self) -> f64 {
        unit_f64(self.0.next_u64())
    }

    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    fn position(&mut self, domain: &Domain) -> DVec2 {
        domain.origin + domain.size * DVec2::new(self.unit(), self.unit())
    }
}

/// Checks an edited graph, and that the returned stars are exactly the vanished and the new ones.
fn check(
    graph: &EditableDelaunay,
    positions: &[DVec2],
    former: &[Star],
    stars: &[Star],
    what: &str,
) -> Vec<Star> {
    let points = PointSet::new(*graph.domain(), positions.to_vec()).unwrap();
    let expected = delaunay(&points).unwrap();
    assert!(graph.to_graph() == expected, "{what}: another graph");
    assert!(graph.to_points().unwrap() == points, "{what}: other points");
    let now: Vec<Star> = (0..positions.len() as u32)
        .map(|point| graph.star(PointIdx(point)).unwrap())
        .collect();
    for (here, there) in [(former, &now[..]), (&now[..], former)] {
        for star in here.iter().filter(|star| !there.contains(star)) {
            assert!(
                stars.contains(star),
                "{what}: a star changed without a word"
            );
        }
    }
    for star in stars {
        assert!(
            former.contains(star) || now.contains(star),
            "{what}: a star that never was"
        );
    }
    now
}

fn edit(points: &PointSet, n_edits: usize, name: &str) {
    let domain = *points.domain();
    let mut dice = Dice(Box::new(Seed(points.len() as u64).stream()));
    let mut positions = points.positions().to_vec();
    let mut graph = EditableDelaunay::new(points).unwrap();
    let of_point = |point| graph.star(PointIdx(point)).unwrap();
    let mut stars: Vec<Star> = (0..positions.len() as u32).map(of_point).collect();
    for edit in 0..n_edits {
        let kind = dice.below(4);
        let changed = if kind == 0 || positions.len() < 2 {
            let position = dice.position(&domain);
            positions.push(domain.wrap(position));
            graph.insert(position).unwrap()
        } else {
            let point = dice.below(positions.len());
            let index = PointIdx(point as u32);
            if kind == 1 {
                positions.remove(point);
                graph.remove(index).unwrap()
            } else {
                let step =
                    (dice.position(&domain) - domain.origin) * if kind == 2 { 0.02 } else { 1.0 };
                let mut position = positions[point] + step;
                for axis in (0..2).filter(|&axis| !domain.wrap[axis]) {
                    if position[axis] > domain.end()[axis] {
                        position[axis] -= domain.size[axis];
                    }
                }
                positions[point] = domain.wrap(position);
                graph.move_to(index, position).unwrap()
            }
        };
        stars = check(
            &graph,
            &positions,
            &stars,
            &changed,
            &format!("{name}, edit {edit} of kind {kind}"),
        );
    }
}

#[test]
fn edited_graphs_are_graphs_made_anew_bit_for_bit() {
    let torus = Domain::torus(DVec2::new(-1.0, 3.0), DVec2::new(2.0, 1.5));
    for wrap in [[true, true], [true, false], [false, true], [false, false]] {
        let domain = Domain { wrap, ..torus };
        for n_points in [1, 2, 3, 12, 255, 700] {
            let points = white_noise(domain, n_points, Seed(9)).unwrap();
            edit(
                &points,
                if n_points > 100 { 60 } else { 40 },
                &format!("{n_points} random points, wrap {wrap:?}"),
            );
        }
        let points = poisson_disk(domain, 0.05, Seed(10)).unwrap();
        edit(
            &points,
            60,
            &format!("{} even points, wrap {wrap:?}", points.len()),
        );
    }
}

#[test]
fn edits_of_crowds_and_lattices_are_exact() {
    let domain = Domain::torus(DVec2::ZERO, DVec2::ONE);
    let mut dice = Dice(Box::new(Seed(3).stream()));
    // Points that crowd towards the origin, so that some stars reach far.
    let crowd = (0..600).map(|_| dice.position(&domain) * dice.position(&domain) * dice.unit());
    edit(
        &PointSet::new(domain, crowd.collect()).unwrap(),
        60,
        "a crowd",
    );
    // Squares, all of whose diagonals are left out.
    let grid = (0..1024).map(|i| DVec2::new(f64::from(i % 32), f64::from(i / 32)) / 32.0);
    edit(
        &PointSet::new(domain, grid.collect()).unwrap(),
        40,
        "a grid",
    );
    let thin = Domain::torus(DVec2::ZERO, DVec2::new(1.0, 1e-3));
    edit(
        &white_noise(thin, 400, Seed(4)).unwrap(),
        20,
        "a thin torus",
    );
}

#[test]
fn edits_that_are_refused_change_nothing() {
    let domain = Domain {
        wrap: [true, false],
        ..Domain::paper_torus()
    };
    let points = white_noise(domain, 400, Seed(5)).unwrap();
    let mut graph = EditableDelaunay::new(&points).unwrap();
    let there = points.position(PointIdx(17));
    let errors = [
        graph.insert(there).unwrap_err(),
        graph.move_to(PointIdx(3), there).unwrap_err(),
        graph.insert(DVec2::new(0.0, 1.1)).unwrap_err(),
        graph.insert(DVec2::NAN).unwrap_err(),
        graph.remove(PointIdx(400)).unwrap_err(),
        graph.move_to(PointIdx(400), DVec2::ZERO).unwrap_err(),
    ];
    let is_expected = |error: &GraphErrorKind, index: usize| match error {
        GraphErrorKind::Coincident { first, second } => {
            [first.0, second.0] == [[17, 400], [3, 17]][index]
        }
        GraphErrorKind::Outside { .. } => (2..4).contains(&index),
        GraphErrorKind::NotThere { point, n_points } => {
            index >= 4 && (point.0, *n_points) == (400, 400)
        }
        _ => false,
    };
    for (index, error) in errors.iter().enumerate() {
        assert!(is_expected(error.kind(), index), "{error}");
    }
    assert!(
        graph.move_to(PointIdx(17), there).is_ok(),
        "a point may stay where it is"
    );
    assert_eq!(graph.to_graph(), delaunay(&points).unwrap());
}

#[test]
fn a_few_points_grow_to_many() {
    let mut graph =
        EditableDelaunay::new(&white_noise(Domain::paper_torus(), 1, Seed(6)).unwrap()).unwrap();
    let mut dice = Dice(Box::new(Seed(7).stream()));
    for _ in 0..900 {
        graph.insert(dice.position(&Domain::paper_torus())).unwrap();
    }
    assert_eq!(
        graph.to_graph(),
        delaunay(&graph.to_points().unwrap()).unwrap()
    );
}
