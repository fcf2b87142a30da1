//! Finds the images of points that a patch needs.

use super::hull::Hull;
use super::patch::Image;
use super::star::Star;
use crate::grid::{Budget, LazyGrid, TooThin, triangulated_limit};
use crate::lattice::Lattice;
use glam::DVec2;
use robust::{Coord, incircle};
use std::collections::BTreeSet;

/// A rectangle in which a patch contains all images; it is unbounded along axes that do not wrap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cover {
    low: DVec2,
    high: DVec2,
}

impl Cover {
    /// Creates the rectangle from `low` to `high`, extended by a margin.
    pub(super) fn new(lattice: &Lattice, low: DVec2, high: DVec2, margin: f64) -> Self {
        let margin = lattice
            .wrap
            .map(|wraps| if wraps { margin } else { f64::INFINITY });
        let margin = DVec2::from(margin);
        Self {
            low: low - margin,
            high: high + margin,
        }
    }

    /// Creates the rectangle of a tile, extended by a margin along all axes.
    pub(super) fn of_tile(low: DVec2, high: DVec2, margin: f64) -> Self {
        Self {
            low: low - margin,
            high: high + margin,
        }
    }

    /// Returns whether there are positions outside of the rectangle.
    pub(super) fn is_bounded(&self) -> bool {
        self.low.max(-self.high).max_element() > f64::NEG_INFINITY
    }

    /// Returns the distance from a position in the rectangle to the rectangle's border.
    #[inline]
    pub(super) fn depth(&self, at: DVec2) -> f64 {
        (at - self.low).min(self.high - at).min_element()
    }

    /// Returns all images of all points in the rectangle. The points themselves get a row of the graph; their copies
    /// do not.
    ///
    /// Fails if their number exceeds the limit.
    pub(super) fn images(&self, lattice: &Lattice, sites: &[DVec2]) -> Result<Vec<Image>, TooThin> {
        let size = lattice.size;
        let copies = [0, 1].map(|axis| {
            let (first, last) = lattice.images(axis, self.low[axis], self.high[axis]);
            last - first + 1.0
        });
        if copies[0] * copies[1] * sites.len() as f64 > triangulated_limit(sites.len()) as f64 {
            return Err(TooThin);
        }
        let mut images = Vec::with_capacity(sites.len() + sites.len() / 2);
        for (point, &site) in (0..).zip(sites) {
            images.push(Image::new(site, point, point));
            let [xs, ys] = [0, 1].map(|axis| {
                let (mut first, mut last) = (0_i32, 0_i32);
                while site[axis] + f64::from(first - 1) * size[axis] >= self.low[axis]
                    && lattice.wrap[axis]
                {
                    first -= 1;
                }
                while site[axis] + f64::from(last + 1) * size[axis] <= self.high[axis]
                    && lattice.wrap[axis]
                {
                    last += 1;
                }
                first..=last
            });
            for y in ys {
                for x in xs.clone() {
                    if (x, y) != (0, 0) {
                        let image = DVec2::new(f64::from(x), f64::from(y));
                        images.push(Image::new(site + image * size, point, Image::FOREIGN));
                    }
                }
            }
        }
        Ok(images)
    }

    /// Returns the nearest images of point 0 along the wrapped axes that are outside of the rectangle.
    pub(super) fn images_outside(
        &self,
        lattice: &Lattice,
        site: DVec2,
    ) -> impl Iterator<Item = Image> {
        let steps = [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y].map(|step| step * lattice.size);
        let wraps = [0, 0, 1, 1].map(|axis| lattice.wrap[axis]);
        let images = steps.into_iter().zip(wraps).filter(|(_, wraps)| *wraps);
        images
            .map(move |(step, _)| site + step)
            .filter(|&at| self.depth(at) < 0.0)
            .map(|at| Image::new(at, 0, Image::FOREIGN))
    }
}

/// A search for the images that a patch lacks.
pub(super) struct Missing<'g, 'a> {
    lattice: &'a Lattice,
    cover: Cover,
    grid: &'g LazyGrid<'a>,
    /// The hull of all sites, on a domain that does not wrap.
    hull: Option<&'g Hull>,
    /// Maximum extent, along each axis, of the circumcircles of the triangles at a point in the final triangulation.
    /// Along an axis that does not wrap, only the part within the domain counts.
    reach: DVec2,
    /// Positions of images that were already inserted.
    inserted: BTreeSet<(i64, i64)>,
    /// Positions of images found since the last insertion.
    pending: BTreeSet<(i64, i64)>,
    /// Images to insert next, each with the row whose star needs it.
    found: Vec<(Image, u32)>,
    scaffolded: bool,
    /// Row of the point whose star is being searched.
    row: u32,
    /// Whether the star will change once the found images are inserted.
    changes: bool,
    budget: Budget,
    /// Whether there were too many images to search.
    too_thin: bool,
}

impl<'g, 'a> Missing<'g, 'a> {
    pub(super) fn new(
        lattice: &'a Lattice,
        cover: Cover,
        grid: &'g LazyGrid<'a>,
        hull: Option<&'g Hull>,
        budget: Budget,
    ) -> Self {
        let size = lattice.size;
        let corners = hull.into_iter().flat_map(|hull| &hull.corners);
        Self {
            lattice,
            cover,
            grid,
            hull,
            // On a torus, the diameter of an empty circle is at most the diagonal of the domain. On a cylinder it may
            // be larger, but both borders of the strip contain a point in each period; the two kinds of cylinder
            // exchange width and height.
            reach: 1.01 * (2.0 * size.element_sum() - size),
            inserted: corners
                .map(|&corner| key(grid.sites()[corner as usize]))
                .collect(),
            pending: BTreeSet::new(),
            found: Vec::new(),
            scaffolded: false,
            row: 0,
            changes: false,
            budget,
            too_thin: false,
        }
    }

    /// For each circumcircle of the star at `center`, adds the missing image inside it that is nearest to its center,
    /// if there is one. Returns whether the star will change.
    pub(super) fn search(&mut self, row: u32, center: DVec2, star: &Star) -> bool {
        self.row = row;
        self.changes = false;
        if self.too_thin {
            return false;
        }
        if star.wedges().nth(1).is_none() {
            self.scaffold();
        }
        for (a, b) in star.wedges() {
            if let (Some(hull), true) = (self.hull, a.gap_after) {
                // All corners are present, so the position is on the border of the hull.
                for point in hull.beside(center).into_iter().flatten() {
                    self.add(point, self.grid.sites()[point as usize]);
                }
            } else if a.gap_after {
                self.search_border(center, a.at);
                self.search_border(center, b.at);
            } else {
                self.search_circle(center, a.at, b.at);
            }
        }
        self.changes
    }

    /// Adds the nearest missing image for an edge next to a gap, or adds the scaffold if there should be no gap.
    fn search_border(&mut self, p: DVec2, vector: DVec2) {
        // On a cylinder, only edges on the borders of the unrolled strip may be next to a gap.
        let is_border = match self.lattice.wrap {
            [true, false] => vector.y == 0.0,
            [false, true] => vector.x == 0.0,
            _ => false,
        };
        if !is_border {
            return self.scaffold();
        }
        let (low, high) = (p.min(p + vector), p.max(p + vector));
        let mut nearest: Option<(f64, u32, DVec2)> = None;
        let visited = self
            .grid
            .get()
            .visit_box(low, high, &mut self.budget, |point, at| {
                let between = at.cmpge(low).all() && at.cmple(high).all() && at != p;
                let distance = (at - p).abs().element_sum();
                if between && nearest.is_none_or(|(best, ..)| distance < best) {
                    nearest = Some((distance, point, at));
                }
            });
        self.too_thin |= visited.is_err();
        if let Some((_, point, at)) = nearest {
            self.add(point, at);
        }
    }

    /// Adds images around the domain that leave no gap in the star of any point inside it.
    fn scaffold(&mut self) {
        self.changes = true;
        if core::mem::replace(&mut self.scaffolded, true) {
            return;
        }
        let sites = self.grid.sites();
        let size = self.lattice.size;
        let across = usize::from(self.lattice.wrap[0]);
        let along = |&a: &u32, &b: &u32| {
            let [a, b] = [a, b].map(|point| sites[point as usize][across]);
            a.total_cmp(&b)
        };
        let points = || 0..sites.len() as u32;
        let ends = if self.lattice.wrap == [true, true] {
            [Some(0), None]
        } else {
            [points().min_by(along), points().max_by(along)]
        };
        let images = |axis: usize| {
            if self.lattice.wrap[axis] {
                -2..=2
            } else {
                0..=0
            }
        };
        for point in ends.into_iter().flatten() {
            for y in images(1) {
                for x in images(0) {
                    let image = DVec2::new(f64::from(x), f64::from(y));
                    self.add(point, sites[point as usize] + image * size);
                }
            }
        }
    }

    fn search_circle(&mut self, p: DVec2, a: DVec2, b: DVec2) {
        let circle = Circle::new(a, b);
        let depth = self.cover;
        let low = p + (circle.center - circle.radius);
        let high = p + (circle.center + circle.radius);
        if low.cmpgt(depth.low).all() && high.cmplt(depth.high).all() {
            return;
        }
        let mut nearest: Option<(f64, u32, DVec2)> = None;
        let coord = |at: DVec2| Coord { x: at.x, y: at.y };
        let visit = |point: u32, at: DVec2| {
            if self.cover.depth(at) >= 0.0 || self.inserted.contains(&key(at)) {
                return;
            }
            let distance_sq = (at - p - circle.center).length_squared();
            // A center that is not finite has no nearest site, and any site will do.
            let nearer = nearest.is_none_or(|(best, ..)| distance_sq < best);
            if nearer && incircle(coord(p), coord(p + a), coord(p + b), coord(at)) >= 0.0 {
                nearest = Some((distance_sq, point, at));
            }
        };
        let grid = self.grid.get();
        let visited = if self.hull.is_some() {
            let (center, radius) = circle.finite();
            grid.visit_disk(p + center, radius, &mut self.budget, visit)
        } else {
            // Comparisons with a NaN center are false, so the whole reach is searched.
            let low = (p - self.reach).max(low);
            let high = (p + self.reach).min(high);
            grid.visit_box(low, high, &mut self.budget, visit)
        };
        self.too_thin |= visited.is_err();
        if let Some((_, point, at)) = nearest {
            self.add(point, at);
        }
    }

    /// Adds an image, unless it was inserted or found before.
    fn add(&mut self, point: u32, at: DVec2) {
        if self.cover.depth(at) >= 0.0 || self.inserted.contains(&key(at)) {
            return;
        }
        self.changes = true;
        if self.pending.insert(key(at)) {
            let image = Image::new(at, point, Image::FOREIGN);
            self.found.push((image, self.row));
        }
    }

    /// Removes and returns the images that were found, for insertion.
    ///
    /// Fails if there were too many images to search, or if their number exceeds the limit.
    pub(super) fn take(&mut self) -> Result<Vec<(Image, u32)>, TooThin> {
        self.inserted.append(&mut self.pending);
        if self.too_thin || self.inserted.len() as u64 > triangulated_limit(self.grid.sites().len())
        {
            return Err(TooThin);
        }
        Ok(core::mem::take(&mut self.found))
    }
}

/// Converts a site to integers, which have a total order.
pub(super) fn key(at: DVec2) -> (i64, i64) {
    (at.x as i64, at.y as i64)
}

/// A circle through the origin and two other positions, slightly enlarged for rounding.
struct Circle {
    center: DVec2,
    radius: f64,
}

impl Circle {
    fn new(a: DVec2, b: DVec2) -> Self {
        let cross = 2.0 * a.perp_dot(b);
        let (a_sq, b_sq) = (a.length_squared(), b.length_squared());
        let center = DVec2::new(b.y * a_sq - a.y * b_sq, a.x * b_sq - b.x * a_sq) / cross;
        let radius = center.length();
        // Bound on the rounding error of the center, which is large if the three positions are nearly collinear.
        let (a_length, b_length) = (a_sq.sqrt(), b_sq.sqrt());
        let sides = a_length * b_length * (a_length + b_length + radius);
        let error = 8.0 * f64::EPSILON * sides / cross.abs();
        Self {
            center,
            radius: radius * (1.0 + 1e-9) + error,
        }
    }

    /// Returns the center and the radius, which is infinite if the center is not finite.
    fn finite(&self) -> (DVec2, f64) {
        if self.center.is_finite() && self.radius.is_finite() {
            return (self.center, self.radius);
        }
        (DVec2::ZERO, f64::INFINITY)
    }
}
