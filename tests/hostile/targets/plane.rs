//! The target for point sets: arbitrary domains and positions, statistics, and graphs.

use super::accepted;
use super::bytes::Bytes;
use dapple::graph::{EdgeDirection, delaunay, gabriel, k_nearest, yao};
use dapple::points::glam::DVec2;
use dapple::points::{Domain, PointSet, SpectrumOptions, spectrum};

/// Maximum number of points. It is small, since some steps take time proportional to its square.
const MOST_POINTS: usize = 32;

/// Builds a point set. It must be rejected, or its statistics and its graph must be computed or rejected.
pub fn points(bytes: &[u8]) {
    let mut bytes = Bytes(bytes);
    let choice = bytes.byte();
    let mut vector = || DVec2::new(bytes.number(), bytes.number());
    let domain = Domain {
        origin: vector(),
        size: vector(),
        wrap: [choice & 1 != 0, choice & 2 != 0],
    };
    let scale = if choice & 4 == 0 {
        domain.size
    } else {
        DVec2::ONE
    };
    let mut positions = Vec::new();
    while !bytes.is_empty() && positions.len() < MOST_POINTS {
        positions.push(domain.origin + DVec2::new(bytes.number(), bytes.number()) * scale);
    }
    let Some(points) = accepted(PointSet::new(domain, positions)) else {
        return;
    };
    for (_, position) in points.iter() {
        assert!(
            domain.contains(position),
            "{position} is outside of {domain:?}"
        );
    }
    check_statistics(&points);
    let direction = if choice & 8 == 0 {
        EdgeDirection::Directed
    } else {
        EdgeDirection::Symmetric
    };
    let count = u32::from(choice >> 6) * 3;
    // Build only one graph per input: on thin domains, each graph may use its entire work limit.
    let graph = match choice >> 4 & 3 {
        0 => delaunay(&points),
        1 => gabriel(&points),
        2 => yao(&points, count, direction),
        _ => k_nearest(&points, count, direction),
    };
    if let Some(graph) = accepted(graph) {
        assert_eq!(graph.n_points(), points.len(), "a row for each point");
        graph.sanity_check().expect("a sane graph");
    }
}

fn check_statistics(points: &PointSet) {
    let distance = points.minimum_distance();
    assert!(
        distance.is_none_or(|distance| distance >= 0.0),
        "the smallest distance is {distance:?}"
    );
    if let Some(distance) = distance {
        let _ = points.mean_neighbor_count(distance);
        let _ = points.normalized_density(distance);
        let _ = points.packing_fraction(distance);
        let _ = points.mean_coverage(distance);
    }
    if let Some(circle) = points.largest_empty_circle() {
        assert!(circle.radius >= 0.0, "the radius is {}", circle.radius);
    }
    let options = SpectrumOptions {
        highest_frequency: 1.0,
        ring_width: 0.25,
    };
    let _ = accepted(spectrum(core::slice::from_ref(points), &options));
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let mut seeds = Vec::new();
    for choice in [0x40, 0x53, 0xab, 0x71, 0xe7] {
        // Points at the origin, and domains that are square, long and thin.
        for size in [[2, 2], [2, 4], [2, 6], [8, 7]] {
            let mut seed = vec![choice, 0, 0, size[0], size[1]];
            let codes = (0..24_u32).map(|index| index.wrapping_mul(0x9e37_79b9));
            seed.extend(codes.flat_map(|code| [200, (code >> 8) as u8, (code >> 16) as u8]));
            seeds.push(seed);
        }
    }
    // A lattice, where many points lie on the same circle.
    let lattice = (0..16).flat_map(|index| [64, index % 4, 64, index / 4]);
    seeds.push(
        [0x03, 0, 0, 64, 4, 64, 4]
            .into_iter()
            .chain(lattice)
            .collect(),
    );
    seeds
}
