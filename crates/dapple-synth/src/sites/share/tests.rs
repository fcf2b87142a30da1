//! Tests of the distribution of sites over the pieces of a surface.

use super::Pieces;
use crate::shapes::{scraps, torus};

/// Computes the shares by Webster's method, one site at a time.
fn one_by_one(areas: &[f64], n: usize) -> Vec<usize> {
    let mut shares = vec![0; areas.len()];
    for _ in 0..n {
        let claim = |piece: usize| areas[piece] / (2 * shares[piece] + 1) as f64;
        let strongest = (0..areas.len())
            .rev()
            .max_by(|&a, &b| claim(a).total_cmp(&claim(b)));
        shares[strongest.unwrap()] += 1;
    }
    shares
}

#[test]
fn shares_are_those_of_one_site_after_the_other() {
    let pieces = Pieces::new(&scraps(7));
    for n in 0..300 {
        assert_eq!(pieces.shares(n), one_by_one(&pieces.areas, n), "{n} sites");
    }
}

#[test]
fn shares_sum_up_and_never_shrink() {
    let pieces = Pieces::new(&scraps(40));
    let mut before = vec![0; 40];
    for n in (0..5000).step_by(7) {
        let shares = pieces.shares(n);
        assert_eq!(shares.iter().sum::<usize>(), n);
        assert!(before.iter().zip(&shares).all(|(a, b)| a <= b), "{n} sites");
        before = shares;
    }
}

#[test]
fn pieces_are_counted_across_edges_only() {
    assert_eq!(Pieces::new(&torus(48, 24)).faces.len(), 1);
    let pieces = Pieces::new(&scraps(3));
    assert_eq!(pieces.of_face, [0, 1, 2]);
    assert_eq!(pieces.faces.len(), 3);
}
