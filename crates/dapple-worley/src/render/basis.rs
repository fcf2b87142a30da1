//! The interface between rendering and a basis, independent of the number of axes.

use crate::dispatch::DimensionDispatch as _;
use crate::fixed::{FlatPlace, MOST_AXES, Place, first_axes};
use crate::lattice::Lattice;
use crate::search::Hit;
use crate::{Dimensions, MAX_NEAREST, Metric, Space, Worley};
use core::fmt;

/// A basis as rendering sees it, independent of the number of axes. Positions and vectors have four components;
/// components of missing axes are zero.
pub trait Basis: Sync + fmt::Debug {
    /// Returns the metric of the basis.
    fn metric(&self) -> Metric;

    /// Returns the feature points of the basis.
    fn lattice(&self) -> &Lattice;

    /// Finds the points nearest to `place`, nearest first; at most four.
    fn nearest(&self, place: &FlatPlace, hits: &mut [Hit<MOST_AXES>]);

    /// Returns the distance from `place` to the nearest edge of its Voronoi cell.
    fn edge_distance(&self, place: &FlatPlace) -> f32;
}

impl<const N: usize> Basis for Worley<N>
where
    Dimensions: Space<N>,
{
    fn metric(&self) -> Metric {
        self.metric
    }

    fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    fn nearest(&self, place: &FlatPlace, hits: &mut [Hit<MOST_AXES>]) {
        // Search in the space of the basis, and pad the vectors with zeros.
        let place = own_axes(place);
        let mut found = [Hit::NONE; MAX_NEAREST];
        let found = &mut found[..hits.len()];
        Dimensions::nearest(self.metric, &self.lattice, &place, found);
        for (hit, found) in hits.iter_mut().zip(found) {
            hit.key = found.key;
            hit.name = found.name;
            hit.vector = [0.0; MOST_AXES];
            hit.vector[..N].copy_from_slice(&found.vector);
        }
    }

    fn edge_distance(&self, place: &FlatPlace) -> f32 {
        self.edge_distance_at(&own_axes(place))
    }
}

/// Converts a position with four components to the basis's number of axes.
fn own_axes<const N: usize>(place: &FlatPlace) -> Place<N> {
    Place {
        cell: first_axes(place.cell),
        steps: first_axes(place.steps),
    }
}
