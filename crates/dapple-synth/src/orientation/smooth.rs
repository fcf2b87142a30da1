//! Computes the smoothest field with a symmetry on the coarsest level: a globally optimal direction field.
//!
//! Reference: Felix Knöppel, Keenan Crane, Ulrich Pinkall, Peter Schröder, "Globally Optimal Direction Fields",
//! SIGGRAPH 2013, <https://doi.org/10.1145/2461912.2462005>.
//!
//! Directions that differ by n-ths of a turn have the same n-th power as complex numbers in a frame of their tangent
//! plane. The field whose powers change least from site to site, without being zero everywhere, is the lowest
//! eigenvector of the connection Laplacian A: `(A u)_i = Σ_j w_ij (u_i - r_ij u_j)`. Here `r_ij` is the n-th power of
//! the rotation from the frame of i to the frame of j, after the latter is transported to i by the smallest rotation
//! between the normals. The paper works on the vertices of a triangulation. This module uses the edges of the graph of
//! sites, weighted by inverse lengths. The eigenvector is found by inverse iteration, separately in each connected
//! component, and rotated as a whole to fit the axis best.
//!
//! Given directions are held fixed. The smoothest field with these values solves the paper's shifted system
//! `(A - λ) u = 0`, with λ a little below the lowest eigenvalue. For one direction the solution is nearly the
//! eigenvector, rotated to that direction.

use super::pull::Known;
use super::push::Field;
use crate::bake_normals::turned as carried;
use crate::columns;
use crate::solve::{System, conjugate_gradients};
use dapple_hash::{Seed, hash1, unit_f32};
use glam::{DVec2, DVec3};

/// Maximum number of inverse iterations. Each reduces the error by the ratio of the two lowest eigenvalues.
const ITERATIONS: usize = 12;
/// Maximum number of solver steps in one inverse iteration.
const STEPS_MAX: usize = 200;
/// Maximum number of solver steps for a field with fixed directions.
const STEPS_MAX_FIXED: usize = 500;
/// Solver tolerance. The solver stops when another averaging step would change no power by more. Powers are about 1.
const TOLERANCE: f64 = 1e-7;
/// Relative tolerance of the eigenvalues. The iteration stops when none decreases by more.
const EIGENVALUE_TOLERANCE: f64 = 1e-3;
/// Shift of the diagonal, as a fraction of its mean. It makes the system nonsingular where a constant field has
/// eigenvalue 0.
const SHIFT: f64 = 1e-6;
/// λ of the system with fixed directions, as a fraction of the lowest eigenvalue. At 1 the system would be nearly
/// singular with a single direction.
const TOWARD_EIGENVALUE: f64 = 0.9;
/// Amplitude of the noise in the initial field, relative to its part along the axis. Without noise, the initial field
/// could be orthogonal to the smoothest one.
const NOISE: f64 = 0.5;

/// Computes the smoothest field of a level, as unit tangent vectors at all sites. Each vector is an arbitrary one of
/// the equivalent directions.
pub(super) fn smoothest(field: &Field<'_>, components: &[u32], known: &[Known]) -> Vec<DVec3> {
    let mut smooth = Smooth::new(field, components);
    // Solve for the powers of the smoothest field, and rotate it to the known directions or the axis.
    let (mut powers, eigenvalues) = smooth.lowest();
    let of_known: Vec<(usize, DVec2)> = known
        .iter()
        .map(|known| (known.site, smooth.power(known)))
        .collect();
    smooth.turn_to(&mut powers, &of_known);
    // Solve once more with the known directions held fixed.
    if !known.is_empty() {
        smooth.hold(&mut powers, &of_known, &eigenvalues);
    }
    columns::column(powers.len(), |site| {
        let [x, y] = smooth.frames[site];
        // Take an n-th root of the power, in the frame of the site.
        let root = field.symmetry.root(powers[site]).unwrap_or(DVec2::X);
        field.unit(site, x * root.x + y * root.y)
    })
}

/// Linear system of a level: the connection Laplacian with a shifted diagonal, and the right-hand side.
pub(super) struct Smooth<'a> {
    field: &'a Field<'a>,
    components: &'a [u32],
    /// Frame of each site: the tangent along the axis, and the tangent perpendicular to it.
    frames: Vec<[DVec3; 2]>,
    /// For each link, the n-th power of the rotation from the frame of the near end to the transported frame of the far
    /// end.
    carried: Vec<DVec2>,
    /// Shift of the diagonal at each site.
    shifts: Vec<f64>,
    right: Vec<DVec2>,
    is_fixed: Vec<bool>,
}

impl<'a> Smooth<'a> {
    pub(super) fn new(field: &'a Field<'a>, components: &'a [u32]) -> Self {
        let (links, normals) = (field.links, field.normals);
        let n_sites = links.len();
        let frames: Vec<[DVec3; 2]> = columns::column(n_sites, |site| {
            let along = super::axis_tangent(field.axis, normals[site]);
            [along, normals[site].cross(along)]
        });
        let mut of_links = Vec::new();
        // Transport the frame of each neighbor to the site, and take the power of its rotation.
        for site in 0..n_sites {
            let [x, y] = frames[site];
            of_links.extend(links.neighbors(site).iter().map(|other| {
                let other = other.index();
                let there = carried(frames[other][0], normals[other], normals[site]);
                let turn = DVec2::new(there.dot(x), there.dot(y)).normalize_or(DVec2::X);
                field.symmetry.power(turn)
            }));
        }
        let mean = columns::sum(n_sites, |site| links.sums()[site]) / n_sites.max(1) as f64;
        Self {
            field,
            components,
            frames,
            carried: of_links,
            shifts: vec![SHIFT * mean; n_sites],
            right: vec![DVec2::ZERO; n_sites],
            is_fixed: vec![false; n_sites],
        }
    }

    /// Computes the lowest eigenvector of every component, scaled to a mean square of 1. Returns the eigenvectors and
    /// the eigenvalues.
    pub(super) fn lowest(&mut self) -> (Vec<DVec2>, Vec<f64>) {
        let n_sites = self.frames.len();
        let mut powers: Vec<DVec2> = (0..n_sites as i64).map(first).collect();
        let mut eigenvalues = self.normalize(&mut powers);
        // Inverse iteration: solve A x = λ u, which keeps x at about the length of u.
        for _ in 0..ITERATIONS {
            for (site, right) in self.right.iter_mut().enumerate() {
                *right = powers[site] * eigenvalues[self.components[site] as usize];
            }
            conjugate_gradients(self, &mut powers, STEPS_MAX);
            let next = self.normalize(&mut powers);
            let falls =
                |(next, before): (&f64, &f64)| before - next > EIGENVALUE_TOLERANCE * before;
            let go_on = next.iter().zip(&eigenvalues).any(falls);
            eigenvalues = next;
            if !go_on {
                break;
            }
        }
        (powers, eigenvalues)
    }

    /// Scales the powers of every component to a mean square of 1. Returns the Rayleigh quotient of each component.
    fn normalize(&self, powers: &mut [DVec2]) -> Vec<f64> {
        let images = columns::column(powers.len(), |site| {
            self.row(powers, site).dot(powers[site])
        });
        let energies = self.by_component(|site| images[site]);
        let squares = self.by_component(|site| powers[site].length_squared());
        let counts = self.by_component(|_| 1.0);
        for (power, &component) in powers.iter_mut().zip(self.components) {
            let component = component as usize;
            if squares[component] > 0.0 {
                *power *= (counts[component] / squares[component]).sqrt();
            }
        }
        let ratio =
            |(energy, square): (&f64, &f64)| if *square > 0.0 { energy / square } else { 0.0 };
        energies.iter().zip(&squares).map(ratio).collect()
    }

    /// Rotates the field of every component as a whole to fit its known directions, or the axis if it has none.
    fn turn_to(&self, powers: &mut [DVec2], known: &[(usize, DVec2)]) {
        let n_components = self.by_component(|_| 0.0).len();
        let (mut of_known, mut of_axis) = (
            vec![DVec2::ZERO; n_components],
            vec![DVec2::ZERO; n_components],
        );
        let conjugate = |number: DVec2| DVec2::new(number.x, -number.y);
        // Sum up the rotations from the field to the known directions, and to the axis.
        for &(site, power) in known {
            of_known[self.components[site] as usize] += conjugate(powers[site]).rotate(power);
        }
        for (&power, &component) in powers.iter().zip(self.components) {
            of_axis[component as usize] += conjugate(power);
        }
        for (power, &component) in powers.iter_mut().zip(self.components) {
            let component = component as usize;
            let turn = of_known[component]
                .try_normalize()
                .or_else(|| of_axis[component].try_normalize());
            *power = turn.unwrap_or(DVec2::X).rotate(*power);
        }
    }

    /// Solves for the smoothest field with the known values, in the components that have known values.
    fn hold(&mut self, powers: &mut [DVec2], known: &[(usize, DVec2)], eigenvalues: &[f64]) {
        let mut is_known = vec![false; eigenvalues.len()];
        // Fix the known sites.
        for &(site, power) in known {
            powers[site] = power;
            self.is_fixed[site] = true;
            is_known[self.components[site] as usize] = true;
        }
        // Fix components without known sites, and subtract λ from the diagonal.
        for (site, &component) in self.components.iter().enumerate() {
            let component = component as usize;
            self.is_fixed[site] |= !is_known[component];
            self.shifts[site] -= TOWARD_EIGENVALUE * eigenvalues[component];
        }
        self.right.fill(DVec2::ZERO);
        conjugate_gradients(self, powers, STEPS_MAX_FIXED);
    }

    /// Returns the n-th power of a known direction, in the frame of its site.
    fn power(&self, known: &Known) -> DVec2 {
        let [x, y] = self.frames[known.site].map(|axis| axis.dot(known.vector));
        self.field
            .symmetry
            .power(DVec2::new(x, y).normalize_or(DVec2::X))
    }

    /// Sums `value(site)` over the sites of each component.
    fn by_component(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut sums = Vec::new();
        for (site, &component) in self.components.iter().enumerate() {
            // Components are numbered in the order of their lowest sites.
            if component as usize == sums.len() {
                sums.push(0.0);
            }
            sums[component as usize] += value(site);
        }
        sums
    }
}

impl System<DVec2> for Smooth<'_> {
    #[inline]
    fn row(&self, column: &[DVec2], row: usize) -> DVec2 {
        if self.is_fixed[row] {
            return DVec2::ZERO;
        }
        let links = self.field.links;
        let carried = &self.carried[links.row(row)];
        let mut sum = column[row] * (links.sums()[row] + self.shifts[row]);
        for ((other, weight), turn) in links
            .neighbors(row)
            .iter()
            .zip(links.weights(row))
            .zip(carried)
        {
            sum -= turn.rotate(column[other.index()]) * *weight;
        }
        sum
    }

    fn right(&self, row: usize) -> DVec2 {
        self.right[row]
    }

    fn diagonal(&self, row: usize) -> f64 {
        if self.is_fixed[row] {
            0.0
        } else {
            self.field.links.sums()[row] + self.shifts[row]
        }
    }

    fn is_near(&self, _value: DVec2, change: DVec2) -> bool {
        change.length_squared() <= TOLERANCE * TOLERANCE
    }
}

/// Returns the initial direction of `site` as a complex power, which is the same for all equivalent directions: that of
/// the axis, 1, plus noise.
fn first(site: i64) -> DVec2 {
    let part = |index| {
        f64::from(unit_f32(
            (hash1(Seed(0).child("smoothest field", 0), [site], index) >> 32) as u32,
        )) - 0.5
    };
    DVec2::X + DVec2::new(part(0), part(1)) * (2.0 * NOISE)
}
