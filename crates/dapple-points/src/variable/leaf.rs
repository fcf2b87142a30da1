//! Divides the domain into rectangles in which the radius hardly changes.
//!
//! A rectangle is halved along its longer side until a few hundred points fit and the radius varies by less than half.
//! The radius is sampled on a lattice of 10 × 10 positions, and differences of neighboring samples give the slope.
//! Between samples, the slope of the radius is assumed to be at most 1.5 times this slope. Each later evaluation
//! checks that the radius stays below this bound, since the distances of points depend on it.

use super::density::RSA_DENSITY;
use super::rule::DiskRule;
use crate::cancel::{IsCancelled, check};
use crate::{Domain, PointsError, PointsErrorKind};
use core::f64::consts::SQRT_2;
use dapple_raster::Varying;
use glam::DVec2;

/// Number of lattice samples of the radius per side.
const LATTICE: usize = 10;

/// Maximum number of cells along a side of a leaf.
const MOST_CELLS: f64 = 32.0;

/// Maximum number of cells along the sides of a leaf that is never divided, regardless of the variation of the radius.
const FEW_CELLS: f64 = 4.0;

/// Maximum ratio of the largest to the smallest radius in a leaf with more cells.
const MOST_RATIO: f64 = 1.5;

/// Assumed maximum ratio of the slope between lattice samples to the maximum slope from sample to sample.
const SLOPE_MARGIN: f64 = 1.5;

/// Relative upper bound, with some slack, of the rounding error of the diagonal of a cell.
const ROUNDING: f64 = 1e-9;

/// A rectangle of the domain, and the radii in it. Positions are relative to the domain's origin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Leaf {
    pub(super) min: DVec2,
    pub(super) size: DVec2,
    pub(super) radii: Radii,
    /// Columns and rows of cells whose diagonal is at most the smallest radius.
    pub(super) cells: [u32; 2],
    /// Radius samples, row by row.
    lattice: Lattice,
}

type Lattice = [[f64; LATTICE]; LATTICE];

impl Leaf {
    /// Returns the bounds of the radius in a rectangle of the leaf, provided that its slope is at most the slope of
    /// the lattice.
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
    /// Lower bound of the radius, provided that its slope between samples is at most the slope along them.
    pub(super) least: f64,
    /// Maximum sample of the radius.
    pub(super) largest: f64,
    /// Upper bound of the radius, checked at every later evaluation.
    pub(super) most: f64,
    /// Slope of the radius, with a margin.
    pub(super) slope: f64,
    /// Maximum distance of a position in the leaf to the nearest sample.
    pub(super) spread: f64,
}

/// Number of rectangles between checks for cancellation. In each, the radius is evaluated a hundred times, by the
/// caller's function, which takes at most a few microseconds.
const NODES: u32 = 64;

/// Tree of rectangles; parents precede their children.
#[derive(Debug, Default)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    pub(super) leaves: Vec<Leaf>,
}

#[derive(Debug)]
struct Node {
    min: DVec2,
    size: DVec2,
    /// Upper bound of the radius over the leaves below.
    most: f64,
    below: Below,
}

#[derive(Clone, Copy, Debug)]
enum Below {
    Leaf(u32),
    Nodes([u32; 2]),
}

/// A radius that varies over a domain.
#[derive(Clone, Copy, Debug)]
pub(super) struct RadiusField<'a> {
    pub(super) domain: &'a Domain,
    pub(super) radius: &'a Varying,
    /// Maximum slope of the radius between samples, if it is larger than the slope along them.
    pub(super) rise: f64,
}

impl RadiusField<'_> {
    /// Returns the radius at a position of the domain.
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

    /// Returns the leaf for a rectangle (`None` if the rectangle must be divided), and the approximate number of
    /// points in it.
    fn leaf(&self, min: DVec2, size: DVec2) -> Result<(Option<Leaf>, f64), PointsError> {
        // The smallest radius is at most the radius at the center, which suffices to divide most rectangles.
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

    /// Returns the range of the radius in a rectangle, its samples, and the approximate number of points in it.
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

    /// Returns the maximum slope between neighboring lattice samples.
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

    /// Returns the position of a lattice sample.
    fn place(&self, min: DVec2, step: DVec2, x: usize, y: usize) -> DVec2 {
        self.domain.origin + (min + step * DVec2::new(x as f64 + 0.5, y as f64 + 0.5))
    }
}

impl Tree {
    /// Builds the tree by dividing the whole domain.
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
            // Check the number as it grows, so that no large tree is built for a rejected set.
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

    /// Propagates the maximum radius from the leaves up to all nodes.
    fn sum_up(&mut self) {
        for node in (0..self.nodes.len()).rev() {
            if let Below::Nodes(children) = self.nodes[node].below {
                let [a, b] = children.map(|child| self.nodes[child as usize].most);
                self.nodes[node].most = a.max(b);
            }
        }
    }

    /// Calls `visit` with every leaf that, after a shift by `shift`, is close enough to `leaf` for a conflict.
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

/// Returns the numbers of columns and rows of cells in a leaf of this size; `None` if the leaf must be divided.
fn cells_of(size: DVec2, radii: &Radii) -> Option<[u32; 2]> {
    let cells = (size * (SQRT_2 * (1.0 + ROUNDING)) / radii.least).ceil();
    let is_leaf = radii.least > 0.0
        && cells.max_element() <= MOST_CELLS
        && (cells.max_element() <= FEW_CELLS || radii.largest <= MOST_RATIO * radii.least);
    is_leaf.then(|| cells.to_array().map(|count| (count as u32).max(1)))
}

/// Returns the two halves of a rectangle, which is cut across its longer side.
fn halves(min: DVec2, size: DVec2) -> [(DVec2, DVec2); 2] {
    let along = if size.x >= size.y { DVec2::X } else { DVec2::Y };
    let half = size * (DVec2::ONE - 0.5 * along);
    [(min, half), (min + half * along, half)]
}
