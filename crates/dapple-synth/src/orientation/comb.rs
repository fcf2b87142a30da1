//! Which of its turns each direction of a field is: turns that neighbors agree on, but for cuts between singularities.
//!
//! A field of a symmetry says at every place one of several directions, and matching wants to know which: the rows above a
//! pixel were made before it. Around a singularity no choice fits everywhere. Here choices spread from site to site over
//! edges along which the field bends least first (a minimum spanning tree, by Prim's method). What remains are cuts, along
//! which neighbors are off by a turn: they lie where the field bends most, the shortest ways between singularities, and
//! around handles.
//!
//! Reference: R. C. Prim, "Shortest Connection Networks and Some Generalizations", Bell System Technical Journal 36, 1957,
//! DOI 10.1002/j.1538-7305.1957.tb01515.x.

use super::push::Field;
use crate::columns;
use core::cmp::Reverse;
use glam::DVec3;
use std::collections::BinaryHeap;

/// Turns the directions of a level, so that those of most neighbors are the nearest of their turns.
pub(super) fn comb(field: &Field<'_>, vectors: &mut [DVec3]) {
    let bends = columns::column(vectors.len(), |site| bend(field, site, vectors));
    let mut is_combed = vec![false; vectors.len()];
    let mut edges = BinaryHeap::new();
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
                    // The bits of numbers of at least zero rise with them.
                    let bend = bends[site].max(bends[other]).to_bits();
                    edges.push(Reverse((bend, other, site)));
                }
            }
            next = None;
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

/// How much the field bends around a site: the mean square of how far neighbors' nearest turns are from its direction.
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
