//! Combing: chooses one of the equivalent directions at each site so that neighbors agree, except across cuts.
//!
//! A field with a symmetry has several equivalent directions at each site. Matching needs a single one: it reads the
//! rows above a pixel, which are synthesized before it. Around a singularity no choice fits everywhere. Choices spread
//! from site to site along the edges at which the field bends least (a minimum spanning tree, by Prim's method). The
//! remaining disagreements are cuts, across which neighbors differ by a rotation. Cuts run where the field bends most,
//! along the shortest paths between singularities, and around handles.
//!
//! Reference: R. C. Prim, "Shortest Connection Networks and Some Generalizations", Bell System Technical Journal 36,
//! 1957, DOI 10.1002/j.1538-7305.1957.tb01515.x.

use super::push::Field;
use crate::columns;
use core::cmp::Reverse;
use glam::DVec3;
use std::collections::BinaryHeap;

/// Rotates each direction of a level to an equivalent one so that most neighbors agree.
pub(super) fn comb(field: &Field<'_>, vectors: &mut [DVec3]) {
    let bends = columns::column(vectors.len(), |site| bend(field, site, vectors));
    let mut is_combed = vec![false; vectors.len()];
    let mut edges = BinaryHeap::new();
    // Grow a spanning tree from the lowest site of each component.
    for start in 0..vectors.len() {
        let mut next = (!is_combed[start]).then_some(start);
        while let Some(site) = next {
            is_combed[site] = true;
            for other in field
                .links
                .neighbors(site)
                .iter()
                .map(|other| other.index())
            {
                if !is_combed[other] {
                    // The bits of nonnegative floats sort like their values.
                    let bend = bends[site].max(bends[other]).to_bits();
                    edges.push(Reverse((bend, other, site)));
                }
            }
            next = None;
            // Take the edge of least bend to a new site, and rotate its direction to agree with the near end.
            while let Some(Reverse((_, other, from))) = edges.pop() {
                if !is_combed[other] {
                    let turned =
                        field
                            .symmetry
                            .nearest(vectors[other], field.normals[other], vectors[from]);
                    vectors[other] = turned;
                    next = Some(other);
                    break;
                }
            }
        }
    }
}

/// Returns the bend of the field around `site`, as the weighted mean squared distance between its direction and the
/// nearest equivalent directions of its neighbors.
fn bend(field: &Field<'_>, site: usize, vectors: &[DVec3]) -> f64 {
    let links = field.links;
    let mut sum = 0.0;
    for (other, weight) in links.neighbors(site).iter().zip(links.weights(site)) {
        let other = other.index();
        let nearest = field
            .symmetry
            .nearest(vectors[other], field.normals[other], vectors[site]);
        sum += nearest.distance_squared(vectors[site]) * weight;
    }
    let weights = links.sums()[site];
    if weights > 0.0 { sum / weights } else { 0.0 }
}
