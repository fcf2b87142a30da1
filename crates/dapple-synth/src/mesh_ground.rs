//! Sites on a surface: squares of samples are laid out by walking along O and P.
//!
//! A sample at the offset (i, j) is found by going i spacings along P, to the right, and from there j spacings along O, down,
//! on the polygons of the surface; both directions are carried along. Its value is that of equation 1, with distances in
//! space. The sites that count are those within reach of the square as it would be on a plane.

mod interpolate;
mod lattice;

use crate::ground::{Ground, Samples, Square};
use crate::groups::Groups;
use crate::{Orientation, Sweep};
use dapple_mesh::{Hierarchy, INTERPOLATION_RADIUS, SiteIdx, Surface};
use dapple_raster::simd;
use glam::DVec3;
use interpolate::Nearby;
use lattice::Lattice;

/// How much farther than on a plane sites may lie from a sample's site and still count, in spacings.
const REACH_SPARE: f64 = 0.5;

/// The sites of a hierarchy, with the directions of the texture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshGround<'a> {
    pub(crate) surface: &'a Surface,
    pub(crate) hierarchy: &'a Hierarchy,
    pub(crate) orientation: &'a Orientation,
    pub(crate) sweep: &'a Sweep,
}

/// What reading a square works in.
#[derive(Debug, Default)]
pub(crate) struct MeshMemory {
    nearby: Nearby,
    small: Lattice<8>,
    large: Lattice<16>,
}

impl MeshGround<'_> {
    /// How far sites lie that count for a square, in units of the mesh.
    fn reach(&self, reads: usize, half: i32) -> f64 {
        let spacings = core::f64::consts::SQRT_2 * f64::from(half) + INTERPOLATION_RADIUS;
        (spacings + REACH_SPARE) * self.hierarchy.levels()[reads].spacing()
    }

    /// Reads a square whose rows fit `N` lanes.
    fn read_lanes<const N: usize>(
        &self,
        square: &Square,
        column: &[f32],
        samples: &mut Samples,
        lattice: &mut Lattice<N>,
        nearby: &mut Nearby,
    ) {
        let sites = self.hierarchy.sites();
        let at = square.site as usize;
        let level = &self.hierarchy.levels()[square.reads];
        lattice.lay(
            self.surface,
            sites.points()[at],
            self.orientation.vectors()[at],
            square,
            level.spacing(),
        );
        nearby.collect(
            sites,
            level,
            sites.positions()[at],
            self.reach(square.reads, square.half),
        );
        let radius = (level.spacing() * INTERPOLATION_RADIUS) as f32;
        interpolate::interpolate(simd::level(), lattice, nearby, radius, column, samples);
    }
}

impl Ground for MeshGround<'_> {
    type Memory = MeshMemory;

    fn n_sites(&self, level: usize) -> usize {
        self.hierarchy.levels()[level].n_sites()
    }

    fn order(&self, level: usize) -> Vec<u32> {
        self.sweep
            .order(level)
            .into_iter()
            .map(|SiteIdx(site)| site)
            .collect()
    }

    fn groups(&self, level: usize, half: i32) -> Groups {
        let n_sites = self.n_sites(level);
        let positions: &[DVec3] = &self.hierarchy.sites().positions()[..n_sites];
        let spacing = self.hierarchy.levels()[level].spacing();
        Groups::in_space(
            &self.order(level),
            positions,
            self.reach(level, half),
            spacing,
        )
    }

    fn read(
        &self,
        square: Square,
        column: &[f32],
        _: usize,
        samples: &mut Samples,
        memory: &mut MeshMemory,
    ) {
        let MeshMemory {
            nearby,
            small,
            large,
        } = memory;
        if square.side() <= 8 {
            self.read_lanes(&square, column, samples, small, nearby);
        } else {
            self.read_lanes(&square, column, samples, large, nearby);
        }
    }
}
