//! Tests for pieces and differences of textures in the plane.

use crate::{Edges, Exemplar, PlaneTexture, SynthErrorKind};
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::Raster;

const SIZE: [u32; 2] = [13, 11];

/// Returns noise that is different for each channel.
fn noise(channel: u64) -> Raster<f32> {
    let value = |x: u32, y: u32| {
        let place = [x, y].map(i64::from);
        unit_f32((hash2(Seed(9), place, channel as u32) >> 32) as u32)
    };
    Raster::from_fn(SIZE, value).unwrap()
}

fn exemplar(edges: Edges) -> Exemplar {
    Exemplar::from_planes(&[(&noise(0), 1.0), (&noise(1), 0.25)], edges).unwrap()
}

/// Returns a texture with the sources that a function returns.
fn texture(
    edges: [Edges; 2],
    exemplar_edges: Edges,
    source: impl FnMut(u32, u32) -> [u32; 2],
) -> PlaneTexture {
    let sources = Raster::from_fn([16, 12], source).unwrap();
    PlaneTexture::from_sources(sources, edges, SIZE, exemplar_edges).unwrap()
}

/// Returns sources in blocks of 4 × 3 pixels, each from a different position. Some reach past the edges of an exemplar
/// that wraps.
fn blocks(x: u32, y: u32) -> [u32; 2] {
    let shift = (hash2(Seed(3), [x / 4, y / 3].map(i64::from), 0) >> 40) as u32;
    [(x + shift) % SIZE[0], (y + shift / 7) % SIZE[1]]
}

#[test]
fn copies_are_one_piece_and_random_pixels_one_each() {
    let copy = texture([Edges::Cut; 2], Edges::Wrap, |x, y| {
        [(x + 5) % 13, (y + 9) % 11]
    });
    assert!(
        copy.pieces()
            .unwrap()
            .pixels()
            .iter()
            .all(|&piece| piece == 0)
    );
    // If the exemplar's edges are cut, sources that wrap around split the texture into pieces.
    let cut = texture([Edges::Cut; 2], Edges::Cut, |x, y| {
        [(x + 5) % 13, (y + 9) % 11]
    });
    let corner = |x: u32, y: u32| cut.pieces().unwrap().row(y)[x as usize];
    assert_eq!(
        [corner(0, 0), corner(8, 0), corner(0, 2), corner(15, 11)],
        [0, 1, 2, 3]
    );
    let alone = texture([Edges::Wrap; 2], Edges::Cut, |x, y| {
        [x * 5 % 13, y * 3 % 11]
    });
    let expected: Vec<u32> = (0..16 * 12).collect();
    assert_eq!(alone.pieces().unwrap().pixels(), expected);
}

#[test]
fn pieces_are_those_that_joining_pairs_of_pixels_finds() {
    for edges in [[Edges::Cut; 2], [Edges::Wrap, Edges::Cut], [Edges::Wrap; 2]] {
        for exemplar_edges in [Edges::Cut, Edges::Wrap] {
            let texture = texture(edges, exemplar_edges, blocks);
            let mut expected: Vec<u32> = (0..16 * 12).collect();
            // Both pixels of each pair take the smaller label, until no label changes.
            let mut last = Vec::new();
            while last != expected {
                last.clone_from(&expected);
                for [x, y] in (0..12).flat_map(|y| (0..16).map(move |x| [x, y])) {
                    for [dx, dy] in [[1, 0], [0, 1]] {
                        let beside = [x + dx, y + dy];
                        let is_past = [beside[0] == 16, beside[1] == 12];
                        if (0..2).any(|axis| is_past[axis] && edges[axis] == Edges::Cut) {
                            continue;
                        }
                        let beside = [beside[0] % 16, beside[1] % 12];
                        let [a, b] = [blocks(x, y), blocks(beside[0], beside[1])];
                        let next = match exemplar_edges {
                            Edges::Cut => [a[0] + dx, a[1] + dy],
                            Edges::Wrap => [(a[0] + dx) % 13, (a[1] + dy) % 11],
                        };
                        if next == b {
                            let [a, b] = [[x, y], beside].map(|[x, y]| (y * 16 + x) as usize);
                            let least = expected[a].min(expected[b]);
                            (expected[a], expected[b]) = (least, least);
                        }
                    }
                }
            }
            // Renumber without gaps, in the order of the first pixels.
            let mut firsts = expected.clone();
            firsts.sort_unstable();
            firsts.dedup();
            assert!(firsts.len() > 4, "{firsts:?}");
            let numbered = expected
                .iter()
                .map(|first| firsts.binary_search(first).unwrap() as u32);
            let pieces = texture.pieces().unwrap();
            assert_eq!(
                pieces.pixels(),
                numbered.collect::<Vec<_>>(),
                "{edges:?} {exemplar_edges:?}"
            );
        }
    }
}

#[test]
fn differences_are_nothing_within_pieces_and_those_of_plain_loops_elsewhere() {
    let whole = PlaneTexture::identity(&exemplar(Edges::Cut)).unwrap();
    let none = whole.differences(&exemplar(Edges::Cut)).unwrap();
    assert!(none.pixels().iter().all(|&difference| difference == 0.0));

    let exemplar = exemplar(Edges::Cut);
    let made = texture([Edges::Wrap, Edges::Cut], Edges::Cut, blocks);
    let differences = made.differences(&exemplar).unwrap();
    let planes = [(noise(0), 1.0_f64), (noise(1), 0.25)];
    for [x, y] in (0..12_i64).flat_map(|y| (0..16_i64).map(move |x| [x, y])) {
        let source = blocks(x as u32, y as u32).map(i64::from);
        let (mut sum, mut n_values) = (0.0, 0.0);
        for [dx, dy] in (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| [dx, dy])) {
            let expected = [source[0] + dx, source[1] + dy];
            let row = y + dy;
            if !(0..12).contains(&row)
                || !(0..13).contains(&expected[0])
                || !(0..11).contains(&expected[1])
            {
                continue;
            }
            let found = blocks((x + dx).rem_euclid(16) as u32, row as u32);
            for (plane, weight) in &planes {
                let a = plane.row(found[1])[found[0] as usize];
                let b = plane.row(expected[1] as u32)[expected[0] as usize];
                sum += weight * f64::from(a - b) * f64::from(a - b);
                n_values += 1.0;
            }
        }
        let expected = (sum / n_values).sqrt();
        let found = f64::from(differences.row(y as u32)[x as usize]);
        // Tolerance: sums of 50 squares in single precision.
        assert!(
            (found - expected).abs() < 1e-5,
            "{x} {y}: {found} and {expected}"
        );
    }
    assert!(
        differences
            .pixels()
            .iter()
            .any(|&difference| difference > 0.1)
    );
    let other =
        Exemplar::from_planes(&[(&Raster::filled([4, 4], 0.0).unwrap(), 1.0)], Edges::Cut).unwrap();
    let refused = made.differences(&other).unwrap_err();
    assert!(
        matches!(refused.kind(), SynthErrorKind::Raster(_)),
        "{refused}"
    );
}
