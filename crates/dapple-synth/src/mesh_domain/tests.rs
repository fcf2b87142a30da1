//! Tests sampling on surfaces against samples that are found by separate walks and interpolated from all sites.

use super::{MeshDomain, MeshMemory, interpolate};
use crate::domain::{Plain, Rows, Samples, Square, SynthesisDomain};
use crate::{Axes, HierarchyOptions, INTERPOLATION_RADIUS, Synthesizer};
use dapple_hash::Seed;
use dapple_mesh::{Mesh, Surface};
use dapple_raster::simd::{self, for_every_level};
use glam::{DVec2, DVec3};

/// Returns a torus as a grid of triangles, or a part of it with two borders.
fn torus(n_around: u32, is_open: bool) -> Surface {
    let n_tube = 12;
    let place = |around: u32, tube: u32| {
        let [a, t] = [(around, n_around), (tube, n_tube)]
            .map(|(at, n)| core::f64::consts::TAU * f64::from(at) / f64::from(n));
        let outward = 1.0 + 0.4 * libm::cos(t);
        DVec3::new(
            outward * libm::cos(a),
            0.4 * libm::sin(t),
            outward * libm::sin(a),
        )
    };
    let positions = (0..n_around)
        .flat_map(|around| (0..n_tube).map(move |tube| place(around, tube)))
        .collect();
    let mut faces = Vec::new();
    for around in 0..n_around - u32::from(is_open) {
        for tube in 0..n_tube {
            let [next_around, next_tube] = [(around + 1) % n_around, (tube + 1) % n_tube];
            let at = |around: u32, tube: u32| around * n_tube + tube;
            let [a, b] = [at(around, tube), at(next_around, tube)];
            let [c, d] = [at(next_around, next_tube), at(around, next_tube)];
            faces.extend([[a, c, b], [a, d, c]]);
        }
    }
    Surface::new(Mesh::new(positions, &faces).unwrap()).unwrap()
}

struct Case(Synthesizer);

impl Case {
    fn new(surface: Surface, n_sites: usize) -> Self {
        let options = HierarchyOptions {
            n_sites,
            n_levels: 2,
            seed: Seed(5),
            ..HierarchyOptions::default()
        };
        Self(Synthesizer::new(surface, &[], &options).unwrap())
    }

    fn domain(&self) -> MeshDomain<'_> {
        self.0.domain(Axes::Carried, false)
    }

    /// Walks to one sample, i steps along P and j steps along O.
    fn walk(&self, square: &Square, [i, j]: [i32; 2]) -> (DVec3, DVec3) {
        let spacing = self.0.hierarchy().levels()[square.reads].spacing();
        let at = square.site as usize;
        let mut point = self.0.hierarchy().sites().points()[at];
        let down = self.0.orientation().vectors()[at];
        let mut right = self
            .0
            .surface()
            .flatten(point.face, down)
            .normalize()
            .perp();
        let mut go = |way: f64, turn: fn(DVec2) -> DVec2| {
            let walk = self.0.surface().walk(point, turn(right) * way, spacing);
            point = walk.point;
            let direction = walk.direction * way;
            right = if turn(DVec2::X) == DVec2::X {
                direction
            } else {
                direction.perp()
            };
        };
        for _ in 0..i.abs() {
            go(f64::from(i.signum()), |right| right);
        }
        for _ in 0..j.abs() {
            go(f64::from(j.signum()), |right| -right.perp());
        }
        let position = self.0.surface().position(point);
        (position, self.0.surface().face_normal(point.face))
    }

    /// Evaluates equation 1 in `f64`, over all sites of the level.
    fn mix(&self, level: usize, position: DVec3, normal: DVec3, column: &[f32]) -> Option<f64> {
        let radius = self.0.hierarchy().levels()[level].spacing() * INTERPOLATION_RADIUS;
        let (mut sum, mut weights) = (0.0, 0.0);
        let n_sites = self.0.hierarchy().levels()[level].n_sites();
        for (site, &value) in self.0.hierarchy().sites().iter().zip(&column[..n_sites]) {
            let at = self.0.hierarchy().sites().positions()[site.index()];
            let opposed = self.0.hierarchy().sites().normals()[site.index()].dot(normal) < 0.0;
            let x = at.distance(position) / radius;
            if x < 1.0 && !opposed {
                let weight = (2.0 * x - 3.0) * x * x + 1.0;
                sum += weight * f64::from(value);
                weights += weight;
            }
        }
        (weights > 1e-3).then_some(sum / weights)
    }
}

fn square(site: u32, reads: usize, half: i32) -> Square {
    Square {
        site,
        level: 0,
        reads,
        half,
        rows: Rows::All,
    }
}

/// Returns values that differ between nearby sites.
fn column(n: usize) -> Vec<f32> {
    (0..n).map(|at| (at * 7919 % 101) as f32 / 101.0).collect()
}

fn plain(values: &[f32], n_channels: usize) -> Plain<'_> {
    Plain { values, n_channels }
}

#[test]
fn squares_are_those_of_single_walks_and_of_all_sites() {
    for is_open in [false, true] {
        let case = Case::new(torus(40, is_open), 3000);
        let (domain, column) = (case.domain(), column(3000));
        let (mut samples, mut memory) = (Samples::default(), MeshMemory::default());
        let mut n_compared = 0;
        for (reads, half) in [(0, 3), (1, 3), (1, 1), (0, 5)] {
            let prepared = domain.prepare(0, Some(half), Some(half));
            for site in (0..3000).step_by(97) {
                let square = square(site, reads, half);
                samples.make_room(square.side(), 1);
                let colors = plain(&column, 1);
                domain.read(square, &prepared, colors, &mut samples, &mut memory);
                for (sample, &value) in samples.values.iter().enumerate() {
                    let [i, j] =
                        [sample % square.side(), sample / square.side()].map(|at| at as i32 - half);
                    let (position, normal) = case.walk(&square, [i, j]);
                    if let Some(oracle) = case.mix(reads, position, normal, &column) {
                        // Positions are rounded to f32: 1e-7 of the surface's size, which is 3e-6 of a radius here,
                        // times the slope of a mean of few sites, which is at most some 50 values per radius.
                        assert!(
                            (f64::from(value) - oracle).abs() < 1e-3,
                            "site {site}, sample {i} {j}: {value} beside {oracle}"
                        );
                        n_compared += 1;
                    }
                }
            }
        }
        assert!(n_compared > 5000, "only {n_compared} samples were compared");
    }
}

#[test]
fn squares_have_the_same_bits_at_every_simd_level() {
    let case = Case::new(torus(40, false), 2000);
    let (domain, column) = (case.domain(), column(2000 * 3));
    let prepared = domain.prepare(0, Some(3), None);
    let around = prepared.same.as_ref().unwrap();
    let mut all: Vec<Vec<Samples>> = Vec::new();
    for_every_level(|level| {
        let mut memory = MeshMemory::default();
        let mut read = Vec::new();
        for site in (0..2000).step_by(53) {
            let mut samples = Samples::default();
            samples.make_room(7, 3);
            let square = square(site, 0, 3);
            let colors = plain(&column, 3);
            domain.read(square, &prepared, colors, &mut samples, &mut memory);
            let radius = (case.0.hierarchy().levels()[0].spacing() * INTERPOLATION_RADIUS) as f32;
            let again = (colors, &mut samples);
            interpolate(
                level,
                &memory.lattice,
                around.collect(level, site, &mut memory.nearby),
                radius,
                again,
                &mut memory.interpolation,
            );
            read.push(samples);
        }
        all.push(read);
    });
    for other in &all[1..] {
        assert_eq!(&all[0], other, "a level has other bits");
    }
}

#[test]
fn square_of_constant_values_is_constant() {
    let case = Case::new(torus(30, true), 500);
    let domain = case.domain();
    let (mut samples, mut memory) = (Samples::default(), MeshMemory::default());
    let prepared = domain.prepare(0, Some(7), Some(3));
    for site in 0..500 {
        let square = square(site, 0, 7);
        samples.make_room(15, 1);
        let colors = plain(&[0.75; 500], 1);
        domain.read(square, &prepared, colors, &mut samples, &mut memory);
        // A weighted mean of equal values has a few rounding errors.
        let off = samples
            .values
            .iter()
            .map(|value| (value - 0.75).abs())
            .fold(0.0, f32::max);
        assert!(off < 1e-6, "site {site} is off by {off}");
        assert_eq!(
            samples.nearest[7 * 15 + 7],
            site,
            "a site is nearest to itself"
        );
    }
}

#[test]
fn turns_keep_the_order_of_sites_that_read_each_other() {
    let case = Case::new(torus(40, false), 4000);
    let domain = case.domain();
    let prepared = domain.prepare(0, Some(3), None);
    let turns = domain.turns(0, &prepared);
    let around = prepared.same.as_ref().unwrap();
    let mut memory = MeshMemory::default();
    let mut turn_of = vec![usize::MAX; 4000];
    for turn in 0..turns.len() {
        turn_of[turns.turn(turn).0 as usize] = turn;
    }
    let mut rank = vec![0; 4000];
    for (at, site) in domain.order(0).into_iter().enumerate() {
        rank[site as usize] = at;
    }
    assert!(!turn_of.contains(&usize::MAX), "a site is missing");
    for turn in 0..4000 {
        let (site, wait) = turns.turn(turn);
        let near = around.collect(simd::level(), site, &mut memory.nearby);
        for record in near.sites() {
            let (site, other) = (site as usize, record.site as usize);
            if rank[other] < rank[site] {
                assert!(turn_of[other] < wait, "{site} does not wait for {other}");
            } else if other != site {
                let (_, wait) = turns.turn(turn_of[other]);
                assert!(turn < wait, "{other} does not wait for {site}");
            }
        }
    }
}

#[test]
fn piece_without_a_coarse_site_reads_the_nearest_one() {
    // A large triangle, and a distant one so small that it has no site of the coarser level.
    let positions = [
        [0.0, 0.0],
        [10.0, 0.0],
        [0.0, 10.0],
        [50.0, 0.0],
        [52.0, 0.0],
        [50.0, 2.0],
    ];
    let positions = positions.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
    let mesh = Mesh::new(positions, &[[0, 1, 2], [3, 4, 5]]).unwrap();
    let case = Case::new(Surface::new(mesh).unwrap(), 60);
    let domain = case.domain();
    let prepared = domain.prepare(0, None, Some(1));
    let (mut samples, mut memory) = (Samples::default(), MeshMemory::default());
    for site in 0..60 {
        samples.make_room(3, 1);
        domain.read(
            square(site, 1, 1),
            &prepared,
            plain(&column(60), 1),
            &mut samples,
            &mut memory,
        );
        assert!(
            samples.nearest.iter().all(|&site| site < 15),
            "not a site of level 1"
        );
    }
}
