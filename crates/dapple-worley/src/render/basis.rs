//! The interface between rendering and a basis, for any number of axes.

use super::bins::{Bins, Grid};
use super::table::{CellBox, Table};
use crate::doors::Doors as _;
use crate::fixed::{FlatPlace, MOST_AXES, Place};
use crate::search::Hit;
use crate::{Axes, LIMIT, Metric, Space, Worley};
use core::fmt;
use dapple_raster::simd;
use dapple_raster::simd::dispatch;
use fearless_simd::Level;

/// A basis in the form that rendering uses: only hashes and the tables of feature points depend on the number of axes.
/// Places and vectors have zeros along the missing axes.
pub trait Basis: Sync + fmt::Debug {
    /// The metric of the basis.
    fn metric(&self) -> Metric;

    /// The mean number of feature points per cell, near a cell.
    fn density(&self, cell: [i64; MOST_AXES]) -> f64;

    /// Generates the feature points of some cells into a table.
    fn fill(&self, level: Level, table: &mut Table, cells: CellBox);

    /// Generates the feature points of some cells into bins.
    fn collect(&self, level: Level, bins: &mut Bins, cells: &CellBox, grid: &Grid);

    /// The nearest points of a place, nearest first; at most four.
    fn nearest(&self, place: &FlatPlace, hits: &mut [Hit<MOST_AXES>]);

    /// The distance from a place to the nearest edge of its Voronoi cell.
    fn edge_distance(&self, place: &FlatPlace) -> f32;
}

impl<const N: usize> Basis for Worley<N>
where
    Axes: Space<N>,
{
    fn metric(&self) -> Metric {
        self.metric
    }

    fn density(&self, cell: [i64; MOST_AXES]) -> f64 {
        match &self.lattice.density {
            None => self.lattice.counts.mean(),
            Some(density) => self.lattice.density_at(density, first(cell)),
        }
    }

    fn fill(&self, level: Level, table: &mut Table, cells: CellBox) {
        dispatch!(level, simd => table.fill(simd, &self.lattice, cells));
    }

    fn collect(&self, level: Level, bins: &mut Bins, cells: &CellBox, grid: &Grid) {
        dispatch!(level, simd => bins.collect(simd, &self.lattice, cells, grid));
    }

    fn nearest(&self, place: &FlatPlace, hits: &mut [Hit<MOST_AXES>]) {
        let place = first_axes(place);
        let mut found = [Hit::NONE; LIMIT];
        let found = &mut found[..hits.len()];
        Axes::nearest(self.metric, &self.lattice, simd::level(), &place, found);
        for (hit, found) in hits.iter_mut().zip(found) {
            hit.key = found.key;
            hit.name = found.name;
            hit.vector = [0.0; MOST_AXES];
            hit.vector[..N].copy_from_slice(&found.vector);
        }
    }

    fn edge_distance(&self, place: &FlatPlace) -> f32 {
        self.edge_distance_at(&first_axes(place))
    }
}

/// A place without the coordinates of the missing axes.
fn first_axes<const N: usize>(place: &FlatPlace) -> Place<N> {
    Place {
        cell: first(place.cell),
        steps: first(place.steps),
    }
}

/// The components along the axes of the basis.
fn first<T: Copy, const N: usize>(parts: [T; MOST_AXES]) -> [T; N] {
    core::array::from_fn(|axis| parts[axis])
}
