//! The pieces of a surface, and how many of the sites each gets.

use dapple_mesh::{FaceIdx, Surface};
use std::collections::BinaryHeap;

/// The pieces of a surface: faces that can be reached from each other across edges.
#[derive(Debug)]
pub(crate) struct Pieces {
    /// The piece of each face.
    pub(crate) of_face: Vec<u32>,
    /// The faces of each piece, lowest first; the pieces are in the order of their lowest face.
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

    /// How many of `n` sites each piece gets: in proportion to the areas, by Webster's method.
    ///
    /// With more sites no piece gets fewer, so that shares of nested sets are nested. A piece with less than about half
    /// of the area of a site may get none.
    pub(crate) fn shares(&self, n: usize) -> Vec<usize> {
        let total: f64 = self.areas.iter().sum();
        // Rounding half up gives each piece at most half a site more than its part, so this many are surely due.
        let sure = (n as f64 - 0.5 * self.areas.len() as f64).max(0.0);
        let round = |area: &f64| (area / total * sure + 0.5) as usize;
        let mut shares: Vec<usize> = self.areas.iter().map(round).collect();
        let mut left = n.saturating_sub(shares.iter().sum());
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

/// How strongly a piece claims one more site; of equal claims the first piece's is the strongest.
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
