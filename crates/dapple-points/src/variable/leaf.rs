//! Cutting the domain into rectangles in which the radius hardly changes.
//!
//! A rectangle is halved along its longer side until a few hundred points fit and the radius varies by less than half.
//! The radius is read on a lattice of 10 × 10 places, and the differences of neighboring places give the slope. Between
//! the places the radius is assumed to fall and rise by no more than 1.5 times this slope allows. Each later reading
//! checks that it does not rise further, since the distances of points depend on it.

use super::density::RSA_DENSITY;
use super::rule::DiskRule;
use crate::cancel::{IsCancelled, check};
use crate::{Domain, PointsError, PointsErrorKind};
use core::f64::consts::SQRT_2;
use dapple_raster::Varying;
use glam::DVec2;

/// Places per side of the lattice on which the radius is read.
const LATTICE: usize = 10;

/// The largest number of cells along a side of a leaf.
const MOST_CELLS: f64 = 32.0;

/// The number of cells along its sides up to which a leaf is not cut, however much the radius varies in it.
const FEW_CELLS: f64 = 4.0;

/// The ratio of the largest to the smallest radius that a leaf of more cells may have.
const MOST_RATIO: f64 = 1.5;

/// By how much a slope between lattice places may exceed the slopes along them.
const SLOPE_MARGIN: f64 = 1.5;

/// The most that rounding may add to the diagonal of a cell, with room to spare.
const ROUNDING: f64 = 1e-9;

/// A rectangle with its radii, relative to the origin of the domain.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Leaf {
    pub(super) min: DVec2,
    pub(super) size: DVec2,
    pub(super) radii: Radii,
    /// Columns and rows of cells whose diagonal is at most the smallest radius.
    pub(super) cells: [u32; 2],
    /// The radii on the lattice, row by row.
    lattice: Lattice,
}

type Lattice = [[f64; LATTICE]; LATTICE];

impl Leaf {
    /// Bounds of the radius in a rectangle of the leaf, as far as its slope is no larger than along the lattice.
    pub(super) fn bounds(&self, min: DVec2, size: DVec2) -> [f64; 2] {
        let place = (min + size * 0.5) / self.size * LATTICE as f64;
        let [x, y] = place
            .to_array()
            .map(|place| (place as usize).min(LATTICE - 1));
        let radius = self.lattice[y][x];
        let change = self.radii.slope * (self.radii.spread + 0.5 * (size.x + size.y));
        [(radius - change).max(self.radii.least), radius + change]
    }
}

/// The range and slope of the radius in a rectangle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Radii {
    /// The lower bound of the radius, valid while its slope between the places read is no larger than along them.
    pub(super) least: f64,
    /// The largest radius that was read.
    pub(super) largest: f64,
    /// The upper bound of the radius, checked wherever it is read later.
    pub(super) most: f64,
    /// The change of the radius per distance, with a margin.
    pub(super) slope: f64,
    /// The largest distance of a place in the leaf to the places where the radius was read.
    pub(super) spread: f64,
}

/// The number of rectangles that are cut before it is asked again whether the set is still wanted. In each the radius is
/// read a hundred times, by a function of the caller at most some microseconds each.
const NODES: u32 = 64;

/// The tree of rectangles; parents come before their children.
#[derive(Debug, Default)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    pub(super) leaves: Vec<Leaf>,
}

#[derive(Debug)]
struct Node {
    min: DVec2,
    size: DVec2,
    /// The largest `most` of the leaves below.
    most: f64,
    below: Below,
}

#[derive(Clone, Copy, Debug)]
enum Below {
    Leaf(u32),
    Nodes([u32; 2]),
}

/// The radius as it varies over a domain.
#[derive(Clone, Copy, Debug)]
pub(super) struct RadiusField<'a> {
    pub(super) domain: &'a Domain,
    pub(super) radius: &'a Varying,
    /// The slope with which the radius may rise between the places where it is read, if that is larger than the slope
    /// along them.
    pub(super) rise: f64,
}

impl RadiusField<'_> {
    /// The radius at a position of the domain.
    pub(super) fn at(&self, position: DVec2) -> Result<f64, PointsError> {
        let radius = self.radius.at(position);
        if radius > 0.0 && radius.is_finite() {
            Ok(radius)
        } else {
            Err(PointsError::new(PointsErrorKind::Radius {
                position,
                radius,
            }))
        }
    }

    /// The leaf of a rectangle, if it is fit to be one, and the approximate number of points in it.
    fn leaf(&self, min: DVec2, size: DVec2) -> Result<(Option<Leaf>, f64), PointsError> {
        // The smallest radius is no larger than the one in the middle, which decides the matter for most rectangles.
        let middle = self.at(self.domain.origin + (min + size * 0.5))?;
        if size.max_element() * SQRT_2 > MOST_CELLS * middle {
            return Ok((None, RSA_DENSITY * (size.x / middle) * (size.y / middle)));
        }
        let (radii, lattice, n_points) = self.survey(min, size)?;
        let leaf = cells_of(size, &radii).map(|cells| Leaf {
            min,
            size,
            radii,
            cells,
            lattice,
        });
        Ok((leaf, n_points))
    }

    /// The range of the radius in a rectangle, and the approximate number of points in it.
    fn survey(&self, min: DVec2, size: DVec2) -> Result<(Radii, Lattice, f64), PointsError> {
        if let Varying::Constant(_) = self.radius {
            let radius = self.at(self.domain.origin + min)?;
            let radii = Radii {
                least: radius,
                largest: radius,
                most: radius,
                slope: 0.0,
                spread: 0.0,
            };
            let n_points = RSA_DENSITY * (size.x / radius) * (size.y / radius);
            return Ok((radii, [[radius; LATTICE]; LATTICE], n_points));
        }
        let step = size / LATTICE as f64;
        let mut values = Lattice::default();
        let (mut least, mut largest, mut n_points) = (f64::INFINITY, 0.0_f64, 0.0);
        for (y, row) in values.iter_mut().enumerate() {
            for (x, value) in row.iter_mut().enumerate() {
                *value = self.at(self.place(min, step, x, y))?;
                least = least.min(*value);
                largest = largest.max(*value);
                n_points += (step.x / *value) * (step.y / *value);
            }
        }
        let slope = SLOPE_MARGIN * self.slope(&values, min, step)?;
        let spread = 0.5 * step.length_squared().sqrt();
        let radii = Radii {
            least: least - slope * spread,
            largest,
            most: largest + slope.max(self.rise) * spread,
            slope,
            spread,
        };
        Ok((radii, values, RSA_DENSITY * n_points))
    }

    /// The largest slope along the lattice.
    fn slope(&self, values: &Lattice, min: DVec2, step: DVec2) -> Result<f64, PointsError> {
        let mut steepest = 0.0_f64;
        for y in 0..LATTICE - 1 {
            for x in 0..LATTICE - 1 {
                let here = values[y][x];
                let rise = DVec2::new(values[y][x + 1] - here, values[y + 1][x] - here) / step;
                let slope = rise.length_squared().sqrt();
                if slope >= 1.0 {
                    return Err(PointsError::new(PointsErrorKind::TooSteep {
                        position: self.place(min, step, x, y),
                        slope,
                    }));
                }
                steepest = steepest.max(slope);
            }
        }
        Ok(steepest)
    }

    /// A place of the lattice.
    fn place(&self, min: DVec2, step: DVec2, x: usize, y: usize) -> DVec2 {
        self.domain.origin + (min + step * DVec2::new(x as f64 + 0.5, y as f64 + 0.5))
    }
}

impl Tree {
    /// Cuts up the whole domain.
    pub(super) fn new(
        field: RadiusField<'_>,
        point_limit: u64,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, PointsError> {
        let mut tree = Self::default();
        let (mut n_points, mut first_guess) = (0.0, 0.0_f64);
        let mut open = vec![(DVec2::ZERO, field.domain.size, None)];
        while let Some((min, size, parent)) = open.pop() {
            let node = tree.nodes.len() as u32;
            if node.is_multiple_of(NODES) {
                check(is_cancelled)?;
            }
            if let Some((parent, child)) = parent {
                tree.set_child(parent, child, node);
            }
            let (leaf, n_in) = field.leaf(min, size)?;
            if node == 0 {
                first_guess = n_in;
            }
            let mut most = 0.0;
            let below = if let Some(leaf) = leaf {
                n_points += n_in;
                most = leaf.radii.most;
                tree.leaves.push(leaf);
                Below::Leaf(tree.leaves.len() as u32 - 1)
            } else {
                let [first, second] = halves(min, size);
                open.push((second.0, second.1, Some((node, 1))));
                open.push((first.0, first.1, Some((node, 0))));
                Below::Nodes([0; 2])
            };
            // The number is checked as it grows, so that no large tree is built for a set that is refused.
            if n_points > point_limit as f64 {
                return Err(PointsError::new(PointsErrorKind::TooMany {
                    needed: n_points.max(first_guess),
                    limit: point_limit,
                }));
            }
            tree.nodes.push(Node {
                min,
                size,
                most,
                below,
            });
        }
        tree.sum_up();
        Ok(tree)
    }

    fn set_child(&mut self, parent: u32, child: usize, node: u32) {
        if let Below::Nodes(children) = &mut self.nodes[parent as usize].below {
            children[child] = node;
        }
    }

    /// Gives each node the largest radius below it.
    fn sum_up(&mut self) {
        for node in (0..self.nodes.len()).rev() {
            if let Below::Nodes(children) = self.nodes[node].below {
                let [a, b] = children.map(|child| self.nodes[child as usize].most);
                self.nodes[node].most = a.max(b);
            }
        }
    }

    /// Calls `visit` with every leaf that, moved by `shift`, comes close enough to `leaf` for a conflict.
    pub(super) fn visit_near(
        &self,
        leaf: &Leaf,
        shift: DVec2,
        rule: DiskRule,
        mut visit: impl FnMut(u32),
    ) {
        let mut open = vec![0_u32];
        while let Some(node) = open.pop() {
            let node = &self.nodes[node as usize];
            let min = node.min + shift;
            let gap = (min - (leaf.min + leaf.size)).max(leaf.min - (min + node.size));
            let reach = rule.distance(leaf.radii.most, node.most);
            if gap.max(DVec2::ZERO).length_squared() > reach * reach {
                continue;
            }
            match node.below {
                Below::Leaf(index) => visit(index),
                Below::Nodes([first, second]) => open.extend([second, first]),
            }
        }
    }
}

/// The columns and rows of cells of a leaf of this size, if it is fit to be one.
fn cells_of(size: DVec2, radii: &Radii) -> Option<[u32; 2]> {
    let cells = (size * (SQRT_2 * (1.0 + ROUNDING)) / radii.least).ceil();
    let is_leaf = radii.least > 0.0
        && cells.max_element() <= MOST_CELLS
        && (cells.max_element() <= FEW_CELLS || radii.largest <= MOST_RATIO * radii.least);
    is_leaf.then(|| cells.to_array().map(|count| (count as u32).max(1)))
}

/// The two halves of a rectangle, cut across its longer side.
fn halves(min: DVec2, size: DVec2) -> [(DVec2, DVec2); 2] {
    let along = if size.x >= size.y { DVec2::X } else { DVec2::Y };
    let half = size * (DVec2::ONE - 0.5 * along);
    [(min, half), (min + half * along, half)]
}
