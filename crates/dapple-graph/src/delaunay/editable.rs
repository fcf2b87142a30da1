//! A Delaunay graph whose points can be inserted, moved and removed individually.
//!
//! An edit changes the axes of the edited point, and of the points that it is or was connected to. The points near
//! the edit are triangulated again, like a tile of [`delaunay`], in a square that grows until no image outside it can
//! affect one of these stars. If there are few points, or at the hull of points that do not wrap, all points are
//! triangulated.
//!
//! The triangulation is not stored. On a torus it would contain several images of points at its border, all of which
//! an edit would have to update, and triangulating a hundred points takes no longer than locating a position in a
//! large triangulation.
//!
//! Each point has an internal number, which is never reused, so that an edit does not affect distant points. The index
//! of a point is the rank of its number among the numbers in use.

use super::buckets::Buckets;
use super::images::Cover;
use super::patch::{Image, Patch};
use super::{Refusal, delaunay, rows};
use crate::lattice::Lattice;
use crate::{Axis, Graph, GraphError, GraphErrorKind};
use dapple_points::{Domain, PointIdx, PointSet};
use glam::DVec2;
use std::collections::BTreeMap;

/// Maximum number of points for which an edit triangulates all points.
const FEW: usize = 256;

/// Half-side lengths of the squares in which points are triangulated, in multiples of the mean point spacing. They
/// are tried in order.
const REACHES: [f64; 3] = [4.0, 7.0, 14.0];

/// Maximum number of images in a square of [`REACHES`]. Only clustered points and thin domains exceed it.
const IMAGES_LIMIT: usize = 4096;

/// Number of points per cell of the buckets above which the number of cells grows.
const CROWD: usize = 8;

/// A Delaunay graph of points that can be inserted, moved and removed. At any time it equals the result of
/// [`delaunay`], bit for bit.
///
/// # Examples
///
/// ```
/// use dapple_graph::{EditableDelaunay, PointIdx, delaunay, glam::DVec2};
/// use dapple_graph::points::{Domain, hash::Seed, jittered_grid};
///
/// let points = jittered_grid(Domain::paper_torus(), [20, 20], 0.9, Seed(7))?;
/// let mut graph = EditableDelaunay::new(&points)?;
/// let stars = graph.move_to(PointIdx(5), DVec2::new(0.25, -0.5))?;
/// assert!(stars.len() < 40);
/// assert_eq!(graph.to_graph(), delaunay(&graph.to_points()?)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct EditableDelaunay {
    domain: Domain,
    lattice: Lattice,
    /// Position, site and axes for each number. Axes refer to numbers. Entries of removed points are retained.
    positions: Vec<DVec2>,
    sites: Vec<DVec2>,
    rows: Vec<Vec<Axis>>,
    /// Numbers of the current points, in ascending order; the index of a point is its index in this list.
    numbers: Vec<u32>,
    buckets: Buckets,
}

/// A point, and the vectors of its axes in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Star {
    /// Position of the point.
    pub center: DVec2,
    /// Vectors from the point along its axes.
    pub vectors: Vec<DVec2>,
}

impl EditableDelaunay {
    /// Creates the Delaunay graph of a point set.
    ///
    /// # Errors
    ///
    /// Same as [`delaunay`].
    pub fn new(points: &PointSet) -> Result<Self, GraphError> {
        let graph = delaunay(points)?;
        let of_row = |point| graph.axes(PointIdx(point)).to_vec();
        let n_points = points.len() as u32;
        let mut buckets = Buckets::new(&graph.lattice, points.len());
        for (number, &site) in (0..).zip(&graph.sites) {
            buckets.insert(number, site);
        }
        Ok(Self {
            domain: *points.domain(),
            lattice: graph.lattice,
            positions: points.positions().to_vec(),
            rows: (0..n_points).map(of_row).collect(),
            sites: graph.sites,
            numbers: (0..n_points).collect(),
            buckets,
        })
    }

    /// Returns the number of points.
    #[must_use]
    pub fn n_points(&self) -> usize {
        self.numbers.len()
    }

    /// Returns the domain of the points.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Returns the position of `point` and the vectors of its axes.
    ///
    /// # Errors
    ///
    /// [`NotThere`](GraphErrorKind::NotThere) if the point does not exist.
    pub fn star(&self, point: PointIdx) -> Result<Star, GraphError> {
        Ok(self.star_of(self.number(point)?))
    }

    /// Returns the points that have an image in a rectangle, and possibly some points near it, in index order.
    #[must_use]
    pub fn points_in(&self, low: DVec2, high: DVec2) -> Vec<PointIdx> {
        let steps = |at: DVec2, slack: f64| self.lattice.steps(at - self.domain.origin) + slack;
        let mut found = Vec::new();
        let limit = self.n_points();
        // Positions are snapped to whole steps, so extend the rectangle by one step.
        let corners = [steps(low, -1.0), steps(high, 1.0)];
        if !corners[0].is_finite() || !corners[1].is_finite() {
            return (0..limit as u32).map(PointIdx).collect();
        }
        self.buckets.visit(&self.lattice, corners, |number, _| {
            found.push(number);
            // In a rectangle of more than a period, every point is found more than once.
            found.len() <= 2 * limit
        });
        if found.len() > 2 * limit {
            return (0..limit as u32).map(PointIdx).collect();
        }
        found.sort_unstable();
        found.dedup();
        found.into_iter().map(|number| self.index(number)).collect()
    }

    /// Returns the points as a set.
    ///
    /// # Errors
    ///
    /// Never fails in practice, because each position was validated before.
    pub fn to_points(&self) -> Result<PointSet, dapple_points::PointsError> {
        let numbers = self.numbers.iter();
        let positions = numbers.map(|&number| self.positions[number as usize]);
        PointSet::new(self.domain, positions.collect())
    }

    /// Returns the graph, which equals the result of [`delaunay`].
    #[must_use]
    pub fn to_graph(&self) -> Graph {
        let mut graph = Graph {
            lattice: self.lattice,
            sites: self.dense_sites(),
            offsets: vec![0],
            axes: Vec::new(),
            symmetric: true,
            delaunay: true,
        };
        for &number in &self.numbers {
            graph
                .axes
                .extend(self.rows[number as usize].iter().map(|axis| Axis {
                    to: self.index(axis.to.0),
                    ..*axis
                }));
            graph.offsets.push(graph.axes.len() as u32);
        }
        graph
    }

    /// Appends a point. Returns the stars that changed, in their old and new states.
    ///
    /// # Errors
    ///
    /// [`Outside`](GraphErrorKind::Outside) for a position outside the domain,
    /// [`Coincident`](GraphErrorKind::Coincident) if another point is at this position,
    /// [`Thin`](GraphErrorKind::Thin) as for [`delaunay`]. The graph is unchanged after an error.
    pub fn insert(&mut self, position: DVec2) -> Result<Vec<Star>, GraphError> {
        let (position, site) = self.accepted(position, None)?;
        let number = self.positions.len() as u32;
        self.positions.push(position);
        self.sites.push(site);
        self.rows.push(Vec::new());
        self.numbers.push(number);
        self.buckets.insert(number, site);
        let rows = self.rows_about(site, Some(number), &[]);
        let replaced = self.replace(rows);
        if replaced.is_err() {
            self.buckets.remove(number, site);
            self.numbers.pop();
            self.rows.pop();
            self.sites.pop();
            self.positions.pop();
        }
        let mut stars = replaced?;
        // The new point had no star before.
        stars.retain(|star| star.center != position || !star.vectors.is_empty());
        if self.n_points() > CROWD * self.buckets.n_cells() {
            self.buckets = Buckets::new(&self.lattice, self.n_points());
            for &number in &self.numbers {
                self.buckets.insert(number, self.sites[number as usize]);
            }
        }
        Ok(stars)
    }

    /// Moves a point; along wrapped axes the position is wrapped into the domain. Returns the stars that changed, in
    /// their old and new states.
    ///
    /// # Errors
    ///
    /// Same as [`insert`](Self::insert), plus [`NotThere`](GraphErrorKind::NotThere) if the point does not exist.
    pub fn move_to(&mut self, point: PointIdx, position: DVec2) -> Result<Vec<Star>, GraphError> {
        let number = self.number(point)?;
        let (position, site) = self.accepted(position, Some(number))?;
        let before = self.star_of(number);
        let former = (self.positions[number as usize], self.sites[number as usize]);
        let neighbors = self.neighbors(number);
        self.put(number, (position, site));
        let rows = self
            .rows_about(former.1, None, &neighbors)
            .and_then(|mut rows| {
                rows.extend(self.rows_about(site, Some(number), &[])?);
                Some(rows)
            });
        let replaced = self.replace(rows);
        if replaced.is_err() {
            self.put(number, former);
        }
        let mut stars = replaced?;
        // The star of the moved point changes even if its axes do not.
        stars.retain(|star| star.center != position);
        stars.extend([before, self.star_of(number)]);
        Ok(stars)
    }

    /// Removes a point; the indices of later points decrease by one. Returns the stars that changed, in their old and
    /// new states.
    ///
    /// # Errors
    ///
    /// [`NotThere`](GraphErrorKind::NotThere) if the point does not exist, [`Thin`](GraphErrorKind::Thin) as for
    /// [`delaunay`]. The graph is unchanged after an error.
    pub fn remove(&mut self, point: PointIdx) -> Result<Vec<Star>, GraphError> {
        let number = self.number(point)?;
        let site = self.sites[number as usize];
        let before = self.star_of(number);
        let neighbors = self.neighbors(number);
        self.buckets.remove(number, site);
        self.numbers.remove(point.index());
        let rows = self.rows_about(site, None, &neighbors);
        let replaced = self.replace(rows);
        if replaced.is_err() {
            self.numbers.insert(point.index(), number);
            self.buckets.insert(number, site);
        }
        let mut stars = replaced?;
        self.rows[number as usize] = Vec::new();
        stars.push(before);
        Ok(stars)
    }

    fn number(&self, point: PointIdx) -> Result<u32, GraphError> {
        let n_points = self.n_points();
        let kind = GraphErrorKind::NotThere { point, n_points };
        let number = self.numbers.get(point.index()).copied();
        number.ok_or(GraphError::new(kind))
    }

    fn index(&self, number: u32) -> PointIdx {
        // The number is in use; otherwise this would be its insertion index.
        let (Ok(index) | Err(index)) = self.numbers.binary_search(&number);
        PointIdx(index as u32)
    }

    fn star_of(&self, number: u32) -> Star {
        let axes = self.rows[number as usize].iter();
        Star {
            center: self.positions[number as usize],
            vectors: axes.map(|axis| axis.vector).collect(),
        }
    }

    /// Returns the numbers of the other points that point `number` is connected to.
    fn neighbors(&self, number: u32) -> Vec<u32> {
        let axes = self.rows[number as usize].iter();
        let mut neighbors: Vec<u32> = axes.map(|axis| axis.to.0).collect();
        neighbors.sort_unstable();
        neighbors.dedup();
        neighbors.retain(|&other| other != number);
        neighbors
    }

    fn dense_sites(&self) -> Vec<DVec2> {
        let numbers = self.numbers.iter();
        numbers.map(|&number| self.sites[number as usize]).collect()
    }

    fn put(&mut self, number: u32, (position, site): (DVec2, DVec2)) {
        self.buckets.remove(number, self.sites[number as usize]);
        (self.positions[number as usize], self.sites[number as usize]) = (position, site);
        self.buckets.insert(number, site);
    }

    /// Checks that a position is in the domain and not occupied; returns the wrapped position and its site.
    fn accepted(&self, position: DVec2, own: Option<u32>) -> Result<(DVec2, DVec2), GraphError> {
        let wrapped = self.domain.wrap(position);
        if !position.is_finite() || !self.domain.contains(wrapped) {
            return Err(GraphError::new(GraphErrorKind::Outside { position }));
        }
        let site = self.lattice.site(wrapped);
        let is_there = |&&other: &&u32| Some(other) != own && self.sites[other as usize] == site;
        if let Some(&other) = self.buckets.beside(site).iter().find(is_there) {
            let own = own.map_or(PointIdx(self.n_points() as u32), |own| self.index(own));
            return Err(GraphError::coincident(self.index(other), own));
        }
        Ok((wrapped, site))
    }

    /// Computes the axes of the `asked` points near a position, and those of the point `hub` at this position and all
    /// its neighbors; `None` if too many points would have to be triangulated.
    fn rows_about(
        &self,
        place: DVec2,
        hub: Option<u32>,
        asked: &[u32],
    ) -> Option<Vec<(u32, Vec<Axis>)>> {
        if self.n_points() <= FEW {
            return None;
        }
        let size = self.lattice.size;
        let mean = (size.x * (size.y / self.n_points() as f64)).sqrt();
        REACHES.into_iter().find_map(|reach| {
            let mut certain = self.certain_rows(place, reach * mean)?;
            let mut wanted = asked.to_vec();
            if let Some(hub) = hub {
                let axes = certain.get(&hub)?.iter();
                wanted.extend(axes.map(|axis| axis.to.0));
                wanted.push(hub);
            }
            wanted.sort_unstable();
            wanted.dedup();
            let row = |number: u32| Some((number, certain.remove(&number)?));
            wanted.into_iter().map(row).collect()
        })
    }

    /// Computes the axes of those points in the square around a position that no image outside the square can affect.
    fn certain_rows(&self, place: DVec2, reach: f64) -> Option<BTreeMap<u32, Vec<Axis>>> {
        let cover = Cover::about(&self.lattice, place, reach);
        let mut images = Vec::new();
        let mut numbers = BTreeMap::new();
        self.buckets
            .visit(&self.lattice, cover.corners(), |number, shift| {
                let at = self.sites[number as usize] + shift;
                if cover.depth(at) >= 0.0 {
                    let next = numbers.len() as u32;
                    let row = match numbers.entry(number) {
                        std::collections::btree_map::Entry::Vacant(free) => *free.insert(next),
                        std::collections::btree_map::Entry::Occupied(_) => Image::FOREIGN,
                    };
                    images.push(Image::new(at, number, row));
                }
                images.len() <= IMAGES_LIMIT
            });
        if images.len() > IMAGES_LIMIT {
            return None;
        }
        let patch = Patch::new(&self.lattice, cover, &images, numbers.len()).ok()?;
        let mut rows = patch.certain_rows();
        let taken = |(number, row): (u32, u32)| Some((number, rows[row as usize].take()?));
        Some(numbers.into_iter().filter_map(taken).collect())
    }

    /// Replaces the given rows; `None` computes and replaces all rows. Returns the stars that changed, in their old
    /// and new states.
    fn replace(&mut self, rows: Option<Vec<(u32, Vec<Axis>)>>) -> Result<Vec<Star>, GraphError> {
        let rows = match rows {
            Some(rows) => rows,
            None => self.all_rows()?,
        };
        let mut stars = Vec::new();
        for (number, row) in rows {
            if self.rows[number as usize] != row {
                stars.push(self.star_of(number));
                self.rows[number as usize] = row;
                stars.push(self.star_of(number));
            }
        }
        Ok(stars)
    }

    /// Computes the axes of all points.
    fn all_rows(&self) -> Result<Vec<(u32, Vec<Axis>)>, GraphError> {
        let rows = match rows(&self.lattice, &self.dense_sites(), &|| false) {
            Ok(rows) => rows,
            // Sites are distinct, and the callback never cancels.
            Err(Refusal::Thin | Refusal::Coincident | Refusal::Cancelled) => {
                return Err(GraphError::new(GraphErrorKind::Thin {
                    size: self.domain.size,
                    limit: crate::grid::Budget::limit(self.n_points()),
                }));
            }
        };
        let row = |(index, &number): (usize, &u32)| {
            let [start, end] = [index, index + 1].map(|at| rows.offsets[at] as usize);
            let axes = rows.axes[start..end].iter().map(|axis| Axis {
                to: PointIdx(self.numbers[axis.to.index()]),
                ..*axis
            });
            (number, axes.collect())
        };
        Ok(self.numbers.iter().enumerate().map(row).collect())
    }
}
