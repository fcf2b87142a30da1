//! A texture whose control points can be inserted, moved, removed and changed one by one, as in an editor.
//!
//! An edit changes the weights of the point, and of all points that it is or was connected to, within their supports.
//! So an edit returns the rectangles in which it changed the texture. To render a window, a net is built only from the
//! points whose supports intersect the window, in order, which gives the same bits as the whole net.

use crate::net::Net;
use crate::support::padded_box;
use crate::{
    ControlPoint, ControlPoints, NetField, Orientation, Orientations, Pups, PupsError,
    PupsErrorKind,
};
use dapple_graph::{EditableDelaunay, Graph, Star};
use dapple_hash::Seed;
use dapple_points::{Domain, PointIdx, PointSet};
use dapple_raster::{RasterViewMut, Window};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Maximum number of periodic copies of a rectangle that get separate windows of an image.
const COPIES_LIMIT: f64 = 64.0;

/// An editable texture of control points. It always equals, bit for bit, the texture that
/// [`control_points`](crate::control_points) builds from the same points.
///
/// A point's index is its position in [`points`](Self::points). A new point is appended. When a point is removed, the
/// indices after it decrease by one, as in a list.
///
/// The time for an edit of a few points, and for rendering the changed windows, does not depend on the number of
/// points, if the domain wraps along both axes. Along an axis that does not wrap, supports of points at the border are
/// unbounded, and windows are rendered from all points.
///
/// # Examples
///
/// ```
/// use dapple_pups::raster::{Raster, Window};
/// use dapple_pups::{CowOptions, EditablePups, PupsRecipe, glam::DVec2, hash::Seed, points::PointIdx};
///
/// let cow = CowOptions::default();
/// let points = cow.build(&(), Seed(7))?.to_points(cow.domain).expect("a cow is one net of numbers");
/// let mut hide = EditablePups::new(points, Seed(7))?;
///
/// let picture = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [512, 512])?;
/// let changed = hide.move_to(PointIdx(3), DVec2::new(0.25, -0.5))?;
/// for window in hide.windows(&changed, &picture) {
///     let mut part = Raster::filled(window.size, 0.0)?;
///     hide.render(&window, part.view_mut())?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct EditablePups {
    /// Current points, each with its own orientation if there are orientations.
    options: ControlPoints,
    graph: EditableDelaunay,
    /// Maximum distance that a support extends from its point, along each axis.
    reach: DVec2,
}

/// A rectangle of the plane in which an edit may change the texture.
///
/// Along an axis that wraps, the rectangle starts in the domain, and any part beyond the domain's end continues at its
/// start. The rectangle is infinite where the supports of points at a non-wrapping border are unbounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Changed {
    /// Corner with the smallest coordinates.
    pub min: DVec2,
    /// Corner with the largest coordinates.
    pub max: DVec2,
}

impl EditablePups {
    /// Creates an editable texture. Orientations in the options are assigned to the points.
    ///
    /// # Errors
    ///
    /// Same as [`control_points`](crate::control_points), and [`Conflict`](PupsErrorKind::Conflict) if points move.
    pub fn new(mut options: ControlPoints, seed: Seed) -> Result<Self, PupsError> {
        if options.net.motion.is_some() {
            let rule = "points with a `motion` cannot be edited; edit them without it";
            return Err(PupsError::new(PupsErrorKind::Conflict { rule }));
        }
        let points = options.point_set()?;
        // Make the same checks as for a texture that is not editable.
        let field = crate::control_points(&options, seed)?;
        let nets = field.nets();
        let orientations = nets[0].orientations();
        for (index, point) in options.points.iter_mut().enumerate() {
            point.orientation = orientations.as_ref().map(|vectors| vectors[index]);
        }
        options.net.orientations = Orientations::None;
        let mut editable = Self {
            options,
            graph: EditableDelaunay::new(&points)?,
            reach: DVec2::ZERO,
        };
        for (point, _) in points.iter() {
            let star = editable.graph.star(point)?;
            editable.extend_reach(&[star]);
        }
        Ok(editable)
    }

    /// Returns the points, in the order of their indices.
    #[must_use]
    pub fn points(&self) -> &[ControlPoint] {
        &self.options.points
    }

    /// Returns the options from which [`control_points`](crate::control_points) builds the same texture.
    #[must_use]
    pub fn options(&self) -> &ControlPoints {
        &self.options
    }

    /// Returns the Delaunay graph of the points.
    #[must_use]
    pub fn graph(&self) -> Graph {
        self.graph.to_graph()
    }

    /// Appends a point. Returns the changed rectangles.
    ///
    /// # Errors
    ///
    /// * [`Graph`](PupsErrorKind::Graph) if the position is outside of the domain or at another point
    /// * [`ShortAxis`](PupsErrorKind::ShortAxis) if the position is too close to another point
    /// * [`Range`](PupsErrorKind::Range) if the value is not finite or the orientation has no length
    /// * [`Conflict`](PupsErrorKind::Conflict) if only the new point or only the other points have an orientation, or
    ///   if the point does not have exactly one of value and label
    /// * [`Count`](PupsErrorKind::Count) if the label has no value
    ///
    /// The texture is unchanged after an error.
    pub fn insert(&mut self, point: ControlPoint) -> Result<Vec<Changed>, PupsError> {
        self.check(&point)?;
        let at = DVec2::new(point.x, point.y);
        let index = PointIdx(self.options.points.len() as u32);
        let stars = self.graph.insert(at)?;
        if let Err(error) = self.check_stars(index, &stars) {
            self.graph.remove(index)?;
            return Err(error);
        }
        self.options.points.push(point);
        Ok(self.changed(&stars, [at; 2]))
    }

    /// Moves a point. Along wrapped axes, the position may be beyond the end of the domain. Returns the changed
    /// rectangles.
    ///
    /// # Errors
    ///
    /// [`Graph`](PupsErrorKind::Graph) if the index is invalid or the position is outside of the domain or at another
    /// point, and [`ShortAxis`](PupsErrorKind::ShortAxis) if the position is too close to another point. The texture is
    /// unchanged after an error.
    pub fn move_to(&mut self, point: PointIdx, position: DVec2) -> Result<Vec<Changed>, PupsError> {
        let former = self.graph.star(point)?.center;
        let stars = self.graph.move_to(point, position)?;
        if let Err(error) = self.check_stars(point, &stars) {
            self.graph.move_to(point, former)?;
            return Err(error);
        }
        let moved = &mut self.options.points[point.index()];
        (moved.x, moved.y) = (position.x, position.y);
        Ok(self.changed(&stars, [former, position]))
    }

    /// Removes a point, which decreases the indices after it by one. Returns the changed rectangles.
    ///
    /// # Errors
    ///
    /// [`Graph`](PupsErrorKind::Graph) if the index is invalid, and [`NoPoints`](PupsErrorKind::NoPoints) if the point
    /// is the only remaining one. The texture is unchanged after an error.
    pub fn remove(&mut self, point: PointIdx) -> Result<Vec<Changed>, PupsError> {
        let at = self.graph.star(point)?.center;
        if self.options.points.len() == 1 {
            return Err(PupsError::new(PupsErrorKind::NoPoints));
        }
        let stars = self.graph.remove(point)?;
        self.options.points.remove(point.index());
        self.extend_reach(&stars);
        Ok(self.changed(&stars, [at; 2]))
    }

    /// Sets a point's value and orientation. The value replaces the point's previous value or label. Returns the
    /// changed rectangles.
    ///
    /// # Errors
    ///
    /// [`Graph`](PupsErrorKind::Graph) if the index is invalid. If the value or the orientation is invalid, same as
    /// [`insert`](Self::insert). The texture is unchanged after an error.
    pub fn set(
        &mut self,
        point: PointIdx,
        value: f32,
        orientation: Option<DVec3>,
    ) -> Result<Vec<Changed>, PupsError> {
        let star = self.graph.star(point)?;
        let changed = ControlPoint {
            value: Some(value),
            label: None,
            orientation,
            ..self.options.points[point.index()]
        };
        self.check(&changed)?;
        self.options.points[point.index()] = changed;
        let at = star.center;
        Ok(self.changed(&[star], [at; 2]))
    }

    /// Returns the windows of the image `picture` that contain the changed rectangles. Windows may overlap.
    #[must_use]
    pub fn windows(&self, changed: &[Changed], picture: &Window) -> Vec<Window> {
        let mut windows = Vec::new();
        for changed in changed {
            let [columns, rows] = [0, 1].map(|axis| self.pixels(changed, picture, axis));
            for &(row, n_rows) in &rows {
                for &(column, n_columns) in &columns {
                    let first = [i64::from(column), i64::from(row)];
                    // Crop the image to the changed pixels.
                    windows.extend(picture.crop(first, [n_columns, n_rows]));
                }
            }
        }
        windows
    }

    /// Renders the texture's values in a window.
    ///
    /// # Errors
    ///
    /// [`Raster`](PupsErrorKind::Raster) if the size of `out` differs from the window's.
    pub fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), PupsError> {
        Ok(self.field(window)?.render(window, out)?)
    }

    /// Builds the texture of the points whose supports intersect a window.
    fn field(&self, window: &Window) -> Result<Arc<dyn NetField>, PupsError> {
        let [width, height] = window.size;
        let corners = [[0, 0], [width.max(1) - 1, height.max(1) - 1]];
        let [first, last] = corners.map(|[x, y]| DVec2::from(window.position(x, y)));
        // Select the points, and build their net in the order of their indices.
        let (low, high) = (first.min(last) - self.reach, first.max(last) + self.reach);
        let points = self.graph.points_in(low, high);
        let given = points
            .iter()
            .map(|point| &self.options.points[point.index()]);
        let vectors: Option<Vec<DVec3>> = given.clone().map(|point| point.orientation).collect();
        let orientation = vectors
            .map(|vectors| Orientation::new(vectors).with_strength(self.options.net.strength));
        let options = self.options.net.pups_options(orientation);
        let mut net = Net::empty(*self.graph.domain(), options, points.len())?;
        let mut centers = Vec::with_capacity(points.len());
        for (index, &point) in (0..).map(PointIdx).zip(&points) {
            let star = self.graph.star(point)?;
            net.push(index, star.center, &star.vectors)?;
            centers.push(star.center);
        }
        let points = PointSet::new(net.domain, centers)?;
        let values = self.options.numbers(given)?;
        self.options
            .cells
            .texture(Pups::of_net(net, points), values)
    }

    /// Checks a point's value and orientation.
    fn check(&self, point: &ControlPoint) -> Result<(), PupsError> {
        for value in self.options.numbers([point])? {
            let (finite, value) = (value.is_finite(), f64::from(value));
            PupsError::check(finite, "value of a control point", value, "finite")?;
        }
        let first = self.options.points.first();
        if first.is_some_and(|first| first.orientation.is_some() != point.orientation.is_some()) {
            let rule = "all points have an `orientation`, or none has";
            return Err(PupsError::new(PupsErrorKind::Conflict { rule }));
        }
        let orientation = point
            .orientation
            .map(|vector| Orientation::new(vec![vector]));
        self.options.net.pups_options(orientation).check(1)
    }

    /// Checks that no axis of the stars is too short, and extends `reach` to cover their supports.
    fn check_stars(&mut self, point: PointIdx, stars: &[Star]) -> Result<(), PupsError> {
        let options = self.options.net.pups_options(None);
        let mut net = Net::empty(*self.graph.domain(), options, 0)?;
        for star in stars {
            net.push(point, star.center, &star.vectors)?;
        }
        self.extend_reach(stars);
        Ok(())
    }

    fn support(&self, star: &Star) -> (DVec2, DVec2) {
        padded_box(&star.vectors, self.options.net.axis_scale)
    }

    fn extend_reach(&mut self, stars: &[Star]) {
        for star in stars {
            let (min, max) = self.support(star);
            self.reach = self.reach.max(-min).max(max);
        }
    }

    /// Returns the bounds of the stars' supports near the two positions of an edit. If the two rectangles overlap,
    /// returns a single one.
    fn changed(&self, stars: &[Star], places: [DVec2; 2]) -> Vec<Changed> {
        let domain = self.graph.domain();
        let [here, there] = places.map(|place| domain.wrap(place));
        let places = [here, here + domain.delta(here, there)];
        let mut boxes = [None, None];
        for star in stars {
            let ways = [here, there].map(|place| domain.delta(place, star.center));
            let near = usize::from(ways[1].length_squared() < ways[0].length_squared());
            let center = places[near] + ways[near];
            let (min, max) = self.support(star);
            let (min, max) = (center + min, center + max);
            let around: &mut Option<Changed> = &mut boxes[near];
            *around = Some(match *around {
                Some(around) => around.joined(&Changed { min, max }),
                None => Changed { min, max },
            });
        }
        if let [Some(here), Some(there)] = boxes
            && here.min.cmple(there.max).all()
            && there.min.cmple(here.max).all()
        {
            boxes = [Some(here.joined(&there)), None];
        }
        let found = boxes.into_iter().flatten();
        found.map(|changed| changed.begun_in(domain)).collect()
    }

    /// For each periodic image of a rectangle, returns the first pixel and the number of pixels of `picture` along an
    /// axis.
    fn pixels(&self, changed: &Changed, picture: &Window, axis: usize) -> Vec<(u32, u32)> {
        let domain = self.graph.domain();
        let n_pixels = picture.size[axis];
        let last = n_pixels.max(1) - 1;
        let ends = match axis {
            0 => [picture.column_x(0), picture.column_x(last)],
            _ => [picture.row_y(0), picture.row_y(last)],
        };
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let (min, max) = (changed.min[axis], changed.max[axis]);
        // Find the periodic copies that intersect the image.
        let mut copies = (0.0, 0.0);
        if domain.wrap[axis] {
            let size = domain.size[axis];
            copies = (((low - max) / size).floor(), ((high - min) / size).ceil());
        }
        let are_few = copies.1 - copies.0 <= COPIES_LIMIT;
        if !are_few || n_pixels < 2 {
            return vec![(0, n_pixels)];
        }
        let per_pixel = (ends[1] - ends[0]) / f64::from(last);
        let mut pixels = Vec::new();
        let mut copy = copies.0;
        while copy <= copies.1 {
            let shift = copy * domain.size[axis];
            let at = [min, max].map(|end| (end + shift - ends[0]) / per_pixel);
            // Add a pixel on either side for rounding; the conversion saturates.
            let first = (at[0].min(at[1]) - 1.0).floor().max(0.0);
            let end = (at[0].max(at[1]) + 2.0).ceil().min(f64::from(n_pixels));
            if first < end {
                pixels.push((first as u32, (end - first) as u32));
            }
            copy += 1.0;
        }
        pixels
    }
}

impl Changed {
    /// Returns the bounds of both rectangles.
    fn joined(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Shifts the rectangle to start in the domain. Along a wrapping axis that is no longer than the rectangle, the
    /// whole axis is returned.
    fn begun_in(mut self, domain: &Domain) -> Self {
        for axis in (0..2).filter(|&axis| domain.wrap[axis]) {
            let (origin, size) = (domain.origin[axis], domain.size[axis]);
            let length = self.max[axis] - self.min[axis];
            if length < size {
                self.min[axis] = domain.wrap_axis(axis, self.min[axis]);
                self.max[axis] = self.min[axis] + length;
            } else {
                self.min[axis] = origin;
                self.max[axis] = origin + size;
            }
        }
        self
    }
}
