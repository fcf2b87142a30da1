//! Draws points, graphs, lines and contours for figures, with smooth edges, in the coordinates of the plane.
//!
//! Drawing uses only arithmetic and square roots, so results have the same bits on every machine. On a domain that
//! wraps, shapes are drawn at every position that the window shows.

mod diagram;
mod enlarged;
mod label;
mod letters;
mod sampled;
mod sheet;
mod shrink;
mod stencil;

pub use enlarged::enlarged;
pub use label::{graph_grays, label_color, label_gray};
pub use sampled::{sampled, smooth_step};
pub use sheet::sheet;
pub use shrink::shrink;

use dapple_graph::Graph;
use dapple_points::{Domain, PointSet};
use dapple_raster::{Raster, RasterError, Texel, Window, glam::DVec2};
use stencil::Stencil;

/// A raster to draw on. Positions are in the coordinates of its window, and widths are in pixels.
#[derive(Clone, Debug)]
pub struct Canvas<T> {
    window: Window,
    raster: Raster<T>,
}

impl<T: Texel> Canvas<T> {
    /// Returns a canvas with the pixels of `window`, all filled with `background`.
    ///
    /// # Errors
    ///
    /// If the window has an invalid size.
    pub fn new(window: &Window, background: T) -> Result<Self, RasterError> {
        Ok(Self {
            window: *window,
            raster: Raster::filled(window.size, background)?,
        })
    }

    /// Returns a canvas that starts with an image; the image's pixels correspond to the pixels of `window`.
    ///
    /// # Errors
    ///
    /// If the image and `window` differ in size.
    pub fn over(window: &Window, picture: Raster<T>) -> Result<Self, RasterError> {
        picture.check_same_size(window.size)?;
        Ok(Self {
            window: *window,
            raster: picture,
        })
    }

    /// Draws every point of a set as a disk with the given radius, in pixels.
    pub fn points(&mut self, points: &PointSet, radius_px: f64, ink: T) {
        let mut stencil = Stencil::new(self.window.size);
        for (_, position) in points.iter() {
            for copy in self.copies(points.domain(), [position; 2], radius_px) {
                stencil.segment(copy, radius_px);
            }
        }
        stencil.ink(&mut self.raster, ink);
    }

    /// Draws the edges of a graph with the given width, in pixels.
    pub fn graph(&mut self, points: &PointSet, graph: &Graph, width_px: f64, ink: T) {
        let mut stencil = Stencil::new(self.window.size);
        for (point, position) in points.iter() {
            for axis in graph.axes(point) {
                let edge = [position, position + axis.vector];
                for copy in self.copies(points.domain(), edge, width_px) {
                    stencil.segment(copy, 0.5 * width_px);
                }
            }
        }
        stencil.ink(&mut self.raster, ink);
    }

    /// Fills a disk with the given center and radius; the radius is in pixels.
    pub fn disk(&mut self, center: DVec2, radius_px: f64, ink: T) {
        self.lines(&[[center; 2]], 2.0 * radius_px, ink);
    }

    /// Draws straight lines between pairs of positions, with round ends and the given width, in pixels.
    pub fn lines(&mut self, lines: &[[DVec2; 2]], width_px: f64, ink: T) {
        let mut stencil = Stencil::new(self.window.size);
        for line in lines {
            stencil.segment(line.map(|end| self.pixel_from_plane(end)), 0.5 * width_px);
        }
        stencil.ink(&mut self.raster, ink);
    }

    /// Draws a closed line through `corners` with the given width, in pixels.
    pub fn outline(&mut self, corners: &[DVec2], width_px: f64, ink: T) {
        let next = corners.iter().cycle().skip(1);
        let lines: Vec<_> = corners
            .iter()
            .zip(next)
            .map(|(&from, &to)| [from, to])
            .collect();
        self.lines(&lines, width_px, ink);
    }

    /// Draws contours of a field, given by its values at the pixels. `width_px` is the line width in pixels.
    ///
    /// The distance to a contour is a first-order estimate, `|value − level| / |gradient|`. There is no contour where
    /// the gradient is zero.
    ///
    /// # Errors
    ///
    /// If the raster and the canvas differ in size.
    pub fn iso_lines(
        &mut self,
        field: &Raster<f32>,
        levels: &[f32],
        width_px: f64,
        ink: T,
    ) -> Result<(), RasterError> {
        self.raster.check_same_size(field.size())?;
        let mut stencil = Stencil::new(self.window.size);
        for row in 0..field.height() {
            for column in 0..field.width() {
                let slope = gradient_px(field, column, row).length();
                let value = field.row(row)[column as usize];
                let gaps = levels.iter().map(|level| f64::from((value - level).abs()));
                let gap = gaps.fold(f64::INFINITY, f64::min);
                if slope > 0.0 {
                    let inside = 0.5 * width_px + 0.5 - gap / slope;
                    stencil.cover(column, row, inside.clamp(0.0, 1.0) as f32);
                }
            }
        }
        stencil.ink(&mut self.raster, ink);
        Ok(())
    }

    /// Returns the pixels.
    #[must_use]
    pub fn into_raster(self) -> Raster<T> {
        self.raster
    }

    /// Returns the copies of a line that may be visible in the window, on a domain that may wrap. Positions are in
    /// pixels, and so is `margin_px`, the margin on both sides of the line.
    fn copies(&self, domain: &Domain, [from, to]: [DVec2; 2], margin_px: f64) -> Vec<[DVec2; 2]> {
        let [shift, size] = [domain.origin, domain.origin + domain.size]
            .map(|corner| self.pixel_from_plane(corner));
        let period = size - shift;
        let line = [from, to].map(|end| self.pixel_from_plane(end));
        let shifts = |axis: usize| {
            let [low, high] = [
                line[0][axis].min(line[1][axis]),
                line[0][axis].max(line[1][axis]),
            ];
            let seen = f64::from(self.window.size[axis]) + margin_px;
            let turns = [
                (-margin_px - high) / period[axis],
                (seen - low) / period[axis],
            ];
            let wraps = domain.wrap[axis] && turns.iter().all(|turn| turn.is_finite());
            let [first, last] = if wraps {
                [
                    turns[0].min(turns[1]).ceil(),
                    turns[0].max(turns[1]).floor(),
                ]
            } else {
                [0.0; 2]
            };
            (first as i64..=last as i64).map(move |turn| turn as f64 * period[axis])
        };
        let shifts = shifts(0).flat_map(|x| shifts(1).map(move |y| DVec2::new(x, y)));
        shifts.map(|shift| line.map(|end| end + shift)).collect()
    }

    /// Converts a position in the plane to pixels from the top left corner of the window.
    fn pixel_from_plane(&self, position: DVec2) -> DVec2 {
        let [first_x, first_y] = self.window.first.map(|first| first as f64);
        let [origin, pixel] = [self.window.origin, self.window.pixel].map(DVec2::from);
        (position - origin) / pixel - DVec2::new(first_x, first_y)
    }
}

/// Returns the gradient of a field per pixel, from the neighbors on both sides, or from one side at the edge.
fn gradient_px(field: &Raster<f32>, column: u32, row: u32) -> DVec2 {
    let [width, height] = field.size();
    let at = |column: u32, row: u32| f64::from(field.row(row)[column as usize]);
    let [left, right] = [column.saturating_sub(1), (column + 1).min(width - 1)];
    let [above, below] = [row.saturating_sub(1), (row + 1).min(height - 1)];
    DVec2::new(
        (at(right, row) - at(left, row)) / f64::from((right - left).max(1)),
        (at(column, below) - at(column, above)) / f64::from((below - above).max(1)),
    )
}

#[cfg(test)]
mod tests {
    use super::Canvas;
    use dapple_graph::delaunay;
    use dapple_points::{Domain, PointSet};
    use dapple_raster::{Raster, Window, glam::DVec2};

    fn canvas(size: u32) -> Canvas<f32> {
        Canvas::new(&Window::unit([size; 2]).unwrap(), 0.0).unwrap()
    }

    fn sum(raster: &Raster<f32>) -> f64 {
        raster.pixels().iter().map(|&value| f64::from(value)).sum()
    }

    #[test]
    fn disk_covers_its_area() {
        let mut canvas = canvas(64);
        canvas.disk(DVec2::new(0.47, 0.52), 10.0, 1.0);
        let area = core::f64::consts::PI * 100.0;
        // The soft edge is exact on a straight edge and good to about 1/6 pixel-width of curvature here.
        assert!(
            (sum(&canvas.into_raster()) - area).abs() < 1.5,
            "not the area of the disk"
        );
    }

    #[test]
    fn line_covers_its_length_times_its_width_even_when_thin() {
        for (width, tolerance) in [(3.0, 0.5), (1.0, 1.0), (0.5, 1.0)] {
            let mut canvas = canvas(64);
            canvas.lines(&[[DVec2::new(-1.0, 0.4), DVec2::new(2.0, 0.4)]], width, 1.0);
            // The row of pixels is sampled at its center, so a thin horizontal line is off by a fraction of a row.
            let covered = sum(&canvas.into_raster()) / 64.0;
            assert!(
                (covered - width).abs() < tolerance * 0.5,
                "{covered} for {width}"
            );
        }
    }

    #[test]
    fn shapes_outside_or_not_finite_leave_the_canvas_alone() {
        let mut canvas = canvas(16);
        canvas.disk(DVec2::splat(7.0), 3.0, 1.0);
        canvas.lines(&[[DVec2::splat(f64::NAN), DVec2::splat(0.5)]], 2.0, 1.0);
        canvas.disk(DVec2::splat(f64::INFINITY), 3.0, 1.0);
        assert_eq!(sum(&canvas.into_raster()), 0.0);
    }

    #[test]
    fn iso_lines_lie_on_the_level_and_need_a_slope() {
        let window = Window::unit([32, 8]).unwrap();
        let ramp = Raster::from_window(&window, |at| at.x as f32).unwrap();
        let mut canvas = Canvas::new(&window, 0.0).unwrap();
        canvas.iso_lines(&ramp, &[0.5], 2.0, 1.0).unwrap();
        let flat = Raster::filled(window.size, 0.25).unwrap();
        canvas.iso_lines(&flat, &[0.25], 2.0, 1.0).unwrap();
        let drawn = canvas.into_raster();
        assert_eq!(drawn.row(3)[14..18], [0.0, 1.0, 1.0, 0.0]);
        assert_eq!(sum(&drawn), 16.0, "only the two columns beside the level");
    }

    #[test]
    fn what_wraps_is_drawn_wherever_the_window_shows_it() {
        let positions = [
            [0.01, 0.02],
            [0.5, 0.9],
            [0.97, 0.4],
            [0.3, 0.35],
            [0.7, 0.6],
        ]
        .map(DVec2::from);
        let points =
            PointSet::new(Domain::torus(DVec2::ZERO, DVec2::ONE), positions.to_vec()).unwrap();
        let graph = delaunay(&points).unwrap();
        let draw = |origin: f64| {
            let window = Window::new(DVec2::splat(origin), DVec2::splat(2.0), [64; 2]).unwrap();
            let mut canvas = Canvas::new(&window, 0.0).unwrap();
            canvas.graph(&points, &graph, 1.5, 0.5);
            canvas.points(&points, 2.0, 1.0);
            canvas.into_raster()
        };
        let (here, far) = (draw(0.0), draw(-3.0));
        let quarter = here.crop([0, 0], [32, 32]).unwrap();
        for first in [[32, 0], [0, 32], [32, 32]] {
            assert_same(&here.crop(first, [32, 32]).unwrap(), &quarter);
        }
        assert_same(&here, &far);
    }

    /// Checks that two rasters are equal up to a small tolerance. Shifted copies of a line are rounded at their ends,
    /// so their coverage may differ in the last bits.
    fn assert_same(a: &Raster<f32>, b: &Raster<f32>) {
        let largest = a
            .zip_map(b, |a, b| (a - b).abs())
            .unwrap()
            .pixels()
            .iter()
            .copied()
            .fold(0.0, f32::max);
        assert!(largest < 1e-5, "pixels differ by {largest}");
    }
}
