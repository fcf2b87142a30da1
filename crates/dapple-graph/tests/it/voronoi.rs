//! Compares Voronoi diagrams with a brute-force search over all sites and their images.

use dapple_graph::points::hash::{Seed, rand_core::Rng, unit_f64};
use dapple_graph::points::{Domain, poisson_disk};
use dapple_graph::{
    GraphErrorKind, PointIdx, PointSet, Voronoi, VoronoiCell, delaunay, gabriel, glam::DVec2,
};

const PLANE: [bool; 2] = [false, false];
const TORUS: [bool; 2] = [true, true];

/// Creates a point set on a domain of `size` whose origin is 0.
fn set(wrap: [bool; 2], size: DVec2, positions: Vec<DVec2>) -> PointSet {
    let domain = Domain {
        wrap,
        ..Domain::torus(DVec2::ZERO, size)
    };
    PointSet::new(domain, positions).unwrap()
}

/// Returns distinct random points whose coordinates are multiples of `step`. If `step` is large, many are co-circular.
fn random(seed: u64, n: usize, size: DVec2, step: f64) -> Vec<DVec2> {
    let mut stream = Seed(seed).stream();
    let mut positions = Vec::new();
    while positions.len() < n {
        let unit = DVec2::new(unit_f64(stream.next_u64()), unit_f64(stream.next_u64()));
        let position = (unit * size / step).floor() * step;
        if !positions.contains(&position) {
            positions.push(position);
        }
    }
    positions
}

fn grid(columns: u32, rows: u32) -> Vec<DVec2> {
    let at = |i: u32| DVec2::new(f64::from(i % columns), f64::from(i / columns));
    (0..columns * rows).map(at).collect()
}

/// Returns named point sets: random, regular and degenerate ones, with every kind of wrapping.
fn sets() -> Vec<(String, PointSet)> {
    let size = DVec2::new(16.0, 12.0);
    let mut sets = Vec::new();
    for wrap in [PLANE, [true, false], [false, true], TORUS] {
        for n in [1, 2, 3, 4, 7, 30, 150] {
            let fine = random(n as u64, n, size, libm::ldexp(1.0, -30));
            sets.push((format!("{n} random, {wrap:?}"), set(wrap, size, fine)));
            let coarse = random(n as u64, n, size, 0.5);
            sets.push((format!("{n} coarse, {wrap:?}"), set(wrap, size, coarse)));
        }
        let lattice = set(wrap, DVec2::new(6.0, 5.0), grid(6, 5));
        sets.push((format!("lattice, {wrap:?}"), lattice));
        let row = set(wrap, DVec2::new(6.0, 5.0), grid(6, 1));
        sets.push((format!("on a line, {wrap:?}"), row));
        let slope = (0..5).map(|i| DVec2::splat(f64::from(i) * 2.0 + 0.5));
        sets.push((
            format!("on a slope, {wrap:?}"),
            set(wrap, size, slope.collect()),
        ));
        // A dense crowd and a few points far away make thin triangles.
        let mut crowd = random(5, 40, size * libm::ldexp(1.0, -20), libm::ldexp(1.0, -40));
        crowd.extend([DVec2::new(15.0, 11.0), DVec2::new(8.0, 1.0)]);
        sets.push((format!("a crowd, {wrap:?}"), set(wrap, size, crowd)));
    }
    sets
}

/// Returns all images of the points that may be nearest to a position in the domain.
fn images(points: &PointSet) -> Vec<(u32, DVec2)> {
    let domain = points.domain();
    let turns = |axis: usize| if domain.wrap[axis] { -3..=3 } else { 0..=0 };
    let mut images = Vec::new();
    for (point, position) in points.iter() {
        for y in turns(1) {
            for x in turns(0) {
                let shift = DVec2::new(f64::from(x), f64::from(y)) * domain.size;
                images.push((point.0, position + shift));
            }
        }
    }
    images
}

fn cells(voronoi: &Voronoi) -> impl Iterator<Item = VoronoiCell<'_>> {
    (0..voronoi.n_cells() as u32).map(|site| voronoi.cell(PointIdx(site)))
}

fn area(corners: &[DVec2]) -> f64 {
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    0.5 * pairs.map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

#[test]
fn cells_cover_the_domain_once() {
    for (name, points) in sets() {
        let voronoi = Voronoi::new(&points).unwrap();
        let domain = *points.domain();
        // Some hundred roundings of vertices up to ten domains away.
        let slack = 1e-11 * domain.area();
        if domain.wrap == TORUS {
            let covered: f64 = cells(&voronoi).map(|cell| cell.area().unwrap()).sum();
            assert!((covered - domain.area()).abs() < slack, "{name}: {covered}");
        }
        if domain.wrap == PLANE {
            let (min, max) = (DVec2::new(1.0, 0.5), domain.size - 0.25);
            let clipped = cells(&voronoi).map(|cell| area(&cell.clipped(min, max)));
            let (covered, expected) = (clipped.sum::<f64>(), (max - min).element_product());
            assert!((covered - expected).abs() < slack, "{name}: {covered}");
            // A cell that is bounded and clipped by a rectangle around it is the same polygon.
            for cell in cells(&voronoi) {
                let whole = area(&cell.clipped([-1e4; 2], [1e4; 2]));
                if let Some(corners) = cell.polygon() {
                    let reach = corners.iter().fold(0.0_f64, |most, v| most.max(v.length()));
                    if reach < 1e3 {
                        let difference = (whole - area(&corners)).abs();
                        // Coordinates up to 1e4 are rounded.
                        assert!(difference < 1e-8, "{name}: {difference}");
                    }
                }
            }
        }
    }
}

#[test]
fn vertices_are_as_near_to_their_sites_as_to_no_other() {
    for (name, points) in sets() {
        let voronoi = Voronoi::new(&points).unwrap();
        let images = images(&points);
        for (number, vertex) in (0..).zip(voronoi.vertices()) {
            let radius = vertex.offset.length();
            // Brought into the domain, beside whose images it is compared.
            let place = points.position(vertex.site) + vertex.offset;
            let place = points.domain().wrap(place);
            // The vertex is rounded to some 10^-15 circumradii.
            let slack = 1e-13 * (radius + 16.0);
            let mut around = Vec::new();
            for &(site, image) in &images {
                let distance = image.distance(place);
                assert!(distance > radius - slack, "{name}: {site} in {vertex:?}");
                if distance < radius + slack {
                    around.push(site);
                }
            }
            let mut sites: Vec<u32> = voronoi
                .vertex_sites(number)
                .iter()
                .map(|site| site.0)
                .collect();
            sites.sort_unstable();
            around.sort_unstable();
            // In thin triangles of a crowd, other points come as near as rounding.
            if !name.contains("crowd") {
                assert_eq!(sites, around, "{name}: {vertex:?}");
            }
            assert!(sites.len() >= 3, "{name}");
        }
    }
}

#[test]
fn cells_are_convex_and_their_sides_lie_halfway_to_the_delaunay_neighbors() {
    for (name, points) in sets() {
        let graph = delaunay(&points).unwrap();
        let voronoi = Voronoi::of_graph(graph.clone()).unwrap();
        assert_eq!(voronoi.graph(), &graph);
        for cell in cells(&voronoi) {
            let neighbors: Vec<_> = cell.sides().map(|side| side.neighbor).collect();
            assert_eq!(neighbors, graph.axes(cell.site()), "{name}");
            for side in cell.sides() {
                for end in side.ends.into_iter().flatten() {
                    let to = side.neighbor.vector;
                    let off = ((end - 0.5 * to).dot(to) / to.length()).abs();
                    let slack = 1e-13 * (end.length() + to.length());
                    assert!(off <= slack, "{name}: {off} beside {side:?}");
                }
                // The side of the neighbor is the same one, seen from there.
                let sides = voronoi.cell(side.neighbor.to).sides();
                let same = sides.filter(|other| {
                    other.neighbor.to == cell.site()
                        && other.neighbor.vector == -side.neighbor.vector
                });
                let same: Vec<_> = same.collect();
                assert_eq!(same.len(), 1, "{name}");
                let [start, end] = same[0].vertices;
                assert_eq!([end, start], side.vertices, "{name}");
                if let [Some(start), Some(end)] = side.ends {
                    // No side has length zero, and all go around counterclockwise.
                    let along = (end - start).dot(side.direction());
                    let slack = 1e-13 * (start.length() + end.length()) * side.direction().length();
                    assert!(along > -slack, "{name}: {along} along {side:?}");
                }
            }
            let Some(corners) = cell.polygon() else {
                continue;
            };
            for at in 0..corners.len() {
                let [a, b, c] = [0, 1, 2].map(|next| corners[(at + next) % corners.len()]);
                let reach = a.length() + b.length() + c.length();
                let slack = 1e-12 * reach * reach;
                let turn = (b - a).perp_dot(c - b);
                assert!(turn > -slack, "{name}: {turn} at {b}");
            }
        }
        if points.domain().wrap == TORUS {
            assert!(cells(&voronoi).all(|cell| cell.is_bounded()), "{name}");
        }
    }
}

#[test]
fn rays_are_the_places_nearest_to_both_of_their_sites() {
    let points = set(
        PLANE,
        DVec2::splat(8.0),
        random(3, 60, DVec2::splat(8.0), libm::ldexp(1.0, -20)),
    );
    let voronoi = Voronoi::new(&points).unwrap();
    let mut n_rays = 0;
    for cell in cells(&voronoi) {
        for side in cell.sides() {
            let direction = side.direction().normalize();
            let on_ray = match side.ends {
                [None, Some(end)] => end - direction * 3.0,
                [Some(start), None] => start + direction * 1000.0,
                _ => continue,
            };
            n_rays += 1;
            assert!(!cell.is_bounded());
            let place = cell.position() + on_ray;
            let own = on_ray.length();
            let other = (on_ray - side.neighbor.vector).length();
            assert!((own - other).abs() < 1e-9, "{own} {other}");
            let nearest = points.positions().iter().map(|p| p.distance(place));
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            assert!(nearest > own - 1e-9, "{nearest} {own}");
        }
    }
    // Every ray is seen from both of its cells.
    let hull = cells(&voronoi).filter(|cell| !cell.is_bounded()).count();
    assert_eq!(n_rays, 2 * hull);
}

/// Returns the site nearest to a position and its squared distance, by brute force over all images. On a tie, the
/// lowest index wins.
fn nearest(images: &[(u32, DVec2)], position: DVec2) -> (u32, f64) {
    let mut best = (u32::MAX, f64::INFINITY);
    for &(site, image) in images {
        let distance_sq = image.distance_squared(position);
        if distance_sq < best.1 || (distance_sq == best.1 && site < best.0) {
            best = (site, distance_sq);
        }
    }
    best
}

#[test]
fn located_sites_are_the_nearest_with_the_lowest_index() {
    let mut n_ties = 0;
    let mut stream = Seed(4).stream();
    let size = DVec2::new(16.0, 8.0);
    for wrap in [PLANE, [true, false], TORUS] {
        // Half units, so that squares of distances are exact, and ties are frequent.
        for (n, positions) in [
            (1, random(1, 1, size, 0.5)),
            (2, random(2, 2, size, 0.5)),
            (5, random(3, 5, size, 0.5)),
            (60, random(4, 60, size, 0.5)),
            (128, grid(16, 8)),
        ] {
            let points = set(wrap, size, positions);
            let voronoi = Voronoi::new(&points).unwrap();
            let images = images(&points);
            let mut hint = PointIdx(0);
            for query in 0..1000 {
                let mut coordinate =
                    |size: f64| (unit_f64(stream.next_u64()) * size * 4.0).floor() / 4.0;
                let position = DVec2::new(coordinate(size.x), coordinate(size.y));
                let found = voronoi.locate(position, hint).unwrap();
                let (site, distance_sq) = nearest(&images, position);
                assert_eq!(found.site.0, site, "{n} points, {wrap:?}, {position}");
                assert_eq!(found.offset.length_squared(), distance_sq);
                let at_site = points.domain().wrap(position - found.offset);
                assert_eq!(at_site, points.position(found.site));
                // The hint makes no difference.
                let other = PointIdx(query % n);
                assert_eq!(voronoi.locate(position, other).unwrap(), found);
                let same = images
                    .iter()
                    .filter(|(_, image)| image.distance_squared(position) == distance_sq);
                n_ties += usize::from(same.count() > 1);
                hint = found.site;
            }
        }
    }
    assert!(n_ties > 2000, "{n_ties}");
}

#[test]
fn located_sites_of_a_large_set_are_the_nearest() {
    let points = poisson_disk(Domain::paper_torus(), 0.03, Seed(7)).unwrap();
    let voronoi = Voronoi::new(&points).unwrap();
    let images = images(&points);
    let mut stream = Seed(5).stream();
    for _ in 0..300 {
        let mut coordinate = || 2.0 * unit_f64(stream.next_u64()) - 1.0;
        let position = DVec2::new(coordinate(), coordinate());
        let found = voronoi.locate(position, PointIdx(17)).unwrap();
        let (site, distance_sq) = nearest(&images, position);
        assert_eq!(found.site.0, site);
        assert!((found.offset.length_squared() - distance_sq).abs() < 1e-14);
        // Around the torus it is the same place.
        let far = position + DVec2::new(2.0, -6.0);
        let again = voronoi.locate(far, PointIdx(3)).unwrap();
        // The far position was rounded.
        assert!((again.offset - found.offset).length() < 1e-14);
    }
}

#[test]
fn diagrams_of_few_points_are_what_geometry_says() {
    let square = DVec2::splat(2.0);
    let one = Voronoi::new(&set(TORUS, square, vec![DVec2::ONE])).unwrap();
    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(DVec2::from);
    assert_eq!(one.cell(PointIdx(0)).polygon().unwrap(), corners);
    assert_eq!(one.vertices().len(), 1);
    assert_eq!(one.vertex_sites(0), [PointIdx(0); 4]);
    let two = set(TORUS, square, vec![DVec2::ZERO, DVec2::ONE]);
    let two = Voronoi::new(&two).unwrap();
    for cell in cells(&two) {
        assert_eq!(cell.area(), Some(2.0), "diamonds");
        assert_eq!(cell.sides().len(), 4);
    }
    let alone = Voronoi::new(&set(PLANE, square, vec![DVec2::ONE])).unwrap();
    let cell = alone.cell(PointIdx(0));
    assert!(!cell.is_bounded() && cell.area().is_none() && cell.sides().len() == 0);
    assert_eq!(area(&cell.clipped([0.0; 2], [2.0, 1.0])), 2.0);
    assert_eq!(cell.clipped([0.0; 2], [0.0, 1.0]), []);
    assert_eq!(cell.clipped([0.0; 2], [f64::NAN, 1.0]), []);
    let pair = set(PLANE, square, vec![DVec2::ZERO, DVec2::new(2.0, 0.0)]);
    let pair = Voronoi::new(&pair).unwrap();
    let line: Vec<_> = pair.cell(PointIdx(1)).sides().collect();
    assert_eq!(line.len(), 1);
    assert_eq!((line[0].ends, line[0].vertices), ([None; 2], [None; 2]));
    assert_eq!(line[0].direction(), DVec2::new(0.0, -2.0));
    assert_eq!(pair.cell(PointIdx(0)).clipped([1.5, 0.0], [2.0, 2.0]), []);
    let empty = Voronoi::new(&set(PLANE, square, Vec::new())).unwrap();
    assert_eq!((empty.n_cells(), empty.vertices().len()), (0, 0));
}

#[test]
fn bad_questions_are_refused() {
    let points = set(
        [true, false],
        DVec2::splat(2.0),
        vec![DVec2::ZERO, DVec2::ONE],
    );
    let voronoi = Voronoi::new(&points).unwrap();
    let kind = |position: [f64; 2], hint| {
        let found = voronoi.locate(position, PointIdx(hint));
        found.map_err(|error| error.kind().clone())
    };
    for bad in [
        [0.0, 2.1],
        [0.0, -0.1],
        [0.0, f64::NAN],
        [f64::INFINITY, 0.0],
        [f64::NAN, 0.0],
    ] {
        let error = kind(bad, 0).unwrap_err();
        assert!(matches!(error, GraphErrorKind::Outside { .. }), "{bad:?}");
    }
    for good in [
        [0.0, 2.0],
        [2.0, 0.0],
        [-1e300, 0.0],
        [1e300, 2.0],
        [-1e-300, 0.0],
    ] {
        assert!(kind(good, 1).is_ok(), "{good:?}");
    }
    let error = kind([0.0, 0.0], 2).unwrap_err();
    assert!(matches!(
        error,
        GraphErrorKind::NotThere { n_points: 2, .. }
    ));
    let error = Voronoi::of_graph(gabriel(&points).unwrap()).unwrap_err();
    assert_eq!(error.kind(), &GraphErrorKind::NotDelaunay);
    let twice = set(TORUS, DVec2::ONE, vec![DVec2::ZERO; 2]);
    let error = Voronoi::new(&twice).unwrap_err();
    assert!(matches!(error.kind(), GraphErrorKind::Coincident { .. }));
}

#[test]
fn value_stability_voronoi() {
    let points = poisson_disk(Domain::paper_torus(), 0.2, Seed(7)).unwrap();
    let voronoi = Voronoi::new(&points).unwrap();
    let mut sum = 0_u64;
    for vertex in voronoi.vertices() {
        let [x, y] = vertex.offset.to_array().map(f64::to_bits);
        for part in [u64::from(vertex.site.0), x, y] {
            sum = sum.wrapping_mul(31).wrapping_add(part);
        }
    }
    assert_eq!((voronoi.vertices().len(), sum), (144, 8634012947247594910));
}
