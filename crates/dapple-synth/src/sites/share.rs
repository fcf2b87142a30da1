//! Splits a surface into connected pieces, and computes the number of sites on each.

use dapple_mesh::{FaceIdx, Surface};
use std::collections::BinaryHeap;

/// Pieces of a surface: sets of faces that are connected across edges.
#[derive(Debug)]
pub(crate) struct Pieces {
    /// Index of the piece of each face.
    pub(crate) of_face: Vec<u32>,
    /// Faces of each piece in ascending order. Pieces are in the order of their lowest face.
    pub(crate) faces: Vec<Vec<FaceIdx>>,
    areas: Vec<f64>,
}

impl Pieces {
    pub(crate) fn new(surface: &Surface) -> Self {
        let (of_face, areas) = (surface.components(), surface.component_areas());
        let mut faces = vec![Vec::new(); areas.len()];
        for (face, &piece) in (0..).map(FaceIdx).zip(&of_face) {
            faces[piece as usize].push(face);
        }
        Self {
            of_face,
            faces,
            areas,
        }
    }

    /// Distributes `n` sites over the pieces in proportion to their areas, by Webster's method.
    ///
    /// With a larger `n` no piece gets fewer sites, so the shares of nested sets are nested. A piece smaller than about
    /// half of the mean area per site may get none.
    pub(crate) fn shares(&self, n: usize) -> Vec<usize> {
        let total: f64 = self.areas.iter().sum();
        // Start with rounded shares of `sure` sites. Rounding adds at most half a site per piece, so at most n sites
        // are assigned.
        let sure = (n as f64 - 0.5 * self.areas.len() as f64).max(0.0);
        let round = |area: &f64| (area / total * sure + 0.5) as usize;
        let mut shares: Vec<usize> = self.areas.iter().map(round).collect();
        let mut left = n.saturating_sub(shares.iter().sum());
        // Give the remaining sites, one at a time, to the piece with the highest priority.
        let claim = |piece: usize, share: usize| Claim {
            weight: self.areas[piece] / (2 * share + 1) as f64,
            piece,
        };
        let mut claims: BinaryHeap<Claim> = shares
            .iter()
            .enumerate()
            .map(|(piece, &share)| claim(piece, share))
            .collect();
        while left > 0
            && let Some(Claim { piece, .. }) = claims.pop()
        {
            shares[piece] += 1;
            left -= 1;
            claims.push(claim(piece, shares[piece]));
        }
        shares
    }
}

/// Priority of a piece for the next site in Webster's method. Of equal priorities, the lower piece wins.
#[derive(Debug, PartialEq)]
struct Claim {
    weight: f64,
    piece: usize,
}

impl Eq for Claim {}

impl Ord for Claim {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        self.weight
            .total_cmp(&other.weight)
            .then(other.piece.cmp(&self.piece))
    }
}

impl PartialOrd for Claim {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

#[cfg(test)]
mod tests;
