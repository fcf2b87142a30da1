//! Drawing for figures: disks, lines and contours, with smooth edges, in the coordinates of the plane.
//!
//! Coverage is that of an edge one pixel wide at the distance from the shape, which suits strokes that are thin and not
//! crossed many times; it needs nothing but arithmetic and square roots, so drawings are the same bits everywhere.

use dapple_color::LinearRgb;
use dapple_raster::{Raster, RasterError, Texel, Window, glam::DVec2};

/// A raster to draw on. Positions are those of its window, widths are in pixels.
#[derive(Clone, Debug)]
pub struct Canvas<T> {
    window: Window,
    raster: Raster<T>,
}

impl<T: Texel> Canvas<T> {
    /// An empty canvas: the pixels of `window`, all with the value `background`.
    ///
    /// # Errors
    ///
    /// If the window has a bad size.
    pub fn new(window: &Window, background: T) -> Result<Self, RasterError> {
        Ok(Self {
            window: *window,
            raster: Raster::filled(window.size, background)?,
        })
    }

    /// A canvas that begins with a picture, whose pixels are those of `window`.
    ///
    /// # Errors
    ///
    /// If the sizes differ.
    pub fn over(window: &Window, picture: Raster<T>) -> Result<Self, RasterError> {
        picture.check_same_size(window.size)?;
        Ok(Self {
            window: *window,
            raster: picture,
        })
    }

    /// Fills the disk about `center` with the given radius, in pixels.
    pub fn disk(&mut self, center: DVec2, radius_px: f64, ink: T) {
        let center = self.pixel_from_plane(center);
        self.stroke([center, center], radius_px, ink, |at| {
            (at - center).length()
        });
    }

    /// Draws the straight line between two positions, with round ends and the given width, in pixels.
    pub fn line(&mut self, from: DVec2, to: DVec2, width_px: f64, ink: T) {
        let [from, to] = [from, to].map(|end| self.pixel_from_plane(end));
        self.stroke([from, to], 0.5 * width_px, ink, |at| {
            distance_to_segment(at, from, to)
        });
    }

    /// Draws a line around `corners`, back to the first, with the given width, in pixels.
    pub fn outline(&mut self, corners: &[DVec2], width_px: f64, ink: T) {
        let next = corners.iter().cycle().skip(1);
        for (&from, &to) in corners.iter().zip(next) {
            self.line(from, to, width_px, ink);
        }
    }

    /// Draws the contours of a field, given by its values at the pixels, with the given width, in pixels.
    ///
    /// The distance from a contour is that to first order, `|value − level| / |gradient|`; where the gradient is zero
    /// there is no contour.
    ///
    /// # Errors
    ///
    /// If the sizes differ.
    pub fn iso_lines(
        &mut self,
        field: &Raster<f32>,
        levels: &[f32],
        width_px: f64,
        ink: T,
    ) -> Result<(), RasterError> {
        self.raster.check_same_size(field.size())?;
        for row in 0..field.height() {
            for column in 0..field.width() {
                let slope = gradient_px(field, column, row).length();
                let value = field.row(row)[column as usize];
                let gaps = levels.iter().map(|level| f64::from((value - level).abs()));
                let gap = gaps.fold(f64::INFINITY, f64::min);
                if slope > 0.0 {
                    self.blend(column, row, coverage(gap / slope, 0.5 * width_px), ink);
                }
            }
        }
        Ok(())
    }

    /// The pixels.
    #[must_use]
    pub fn into_raster(self) -> Raster<T> {
        self.raster
    }

    /// Inks the pixels that lie within `reach` pixels of a shape inside the box about two corners, all in pixels.
    fn stroke(&mut self, corners: [DVec2; 2], reach: f64, ink: T, distance: impl Fn(DVec2) -> f64) {
        let low = corners[0].min(corners[1]) - DVec2::splat(reach + 1.0);
        let high = corners[0].max(corners[1]) + DVec2::splat(reach + 1.0);
        let [width, height] = self.raster.size();
        for row in clamped(low.y, height)..clamped(high.y, height) {
            for column in clamped(low.x, width)..clamped(high.x, width) {
                let at = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                self.blend(column, row, coverage(distance(at), reach), ink);
            }
        }
    }

    fn blend(&mut self, column: u32, row: u32, coverage: f32, ink: T) {
        if coverage > 0.0 {
            let width = self.raster.width() as usize;
            let pixel = &mut self.raster.pixels_mut()[row as usize * width + column as usize];
            *pixel = *pixel + (ink - *pixel) * coverage;
        }
    }

    /// Where a position is, in pixels from the top left corner.
    fn pixel_from_plane(&self, position: DVec2) -> DVec2 {
        let [first_x, first_y] = self.window.first.map(|first| first as f64);
        (position - self.window.origin) / self.window.pixel - DVec2::new(first_x, first_y)
    }
}

/// A color for a label: neighboring labels get colors far apart, and a label has the same color everywhere.
#[must_use]
pub fn label_color(label: u32) -> LinearRgb {
    // Hues that are a golden section of the circle apart stay far apart, however many there are.
    let hue = fraction(f64::from(label) * 0.618_033_988_749_895) as f32 * 6.0;
    let value = [0.95, 0.70, 0.85][label as usize % 3];
    let channel = |shift: f32| {
        let along = (hue + shift) % 6.0;
        let strength = ((along - 3.0).abs() - 1.0).clamp(0.0, 1.0);
        let display = value * (0.42 + 0.58 * strength);
        display * display
    };
    LinearRgb::new(channel(0.0), channel(4.0), channel(2.0))
}

/// A shade of gray for a label, from 0.25 to 1.
#[must_use]
pub fn label_gray(label: u32) -> f32 {
    let spread = fraction(f64::from(label) * 0.618_033_988_749_895);
    0.25 + 0.75 * spread as f32
}

fn fraction(value: f64) -> f64 {
    value - value.floor()
}

/// The first whole pixel from `coordinate` on, within a side of `n` pixels.
fn clamped(coordinate: f64, n: u32) -> u32 {
    coordinate.clamp(0.0, f64::from(n)) as u32
}

/// How much of a pixel is covered by a shape that reaches `reach` pixels from its spine.
fn coverage(distance: f64, reach: f64) -> f32 {
    // A stroke thinner than a pixel keeps its weight by becoming paler.
    let (half, weight) = (reach.max(0.5), (2.0 * reach).min(1.0));
    ((half + 0.5 - distance).clamp(0.0, 1.0) * weight) as f32
}

fn distance_to_segment(at: DVec2, from: DVec2, to: DVec2) -> f64 {
    let (along, reach) = (to - from, at - from);
    let length_sq = along.length_squared();
    let t = if length_sq > 0.0 {
        (reach.dot(along) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (reach - along * t).length()
}

/// The change of a field per pixel, from the neighbors on both sides (one side at the edge).
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
    use super::{Canvas, label_color, label_gray};
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
            canvas.line(DVec2::new(-1.0, 0.4), DVec2::new(2.0, 0.4), width, 1.0);
            // The row of pixels is sampled at its center, so a thin level line is off by a fraction of a row.
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
        canvas.line(DVec2::splat(f64::NAN), DVec2::splat(0.5), 2.0, 1.0);
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
    fn neighboring_labels_differ_visibly() {
        for label in 0..1000 {
            let [a, b] = [label, label + 1].map(label_color);
            assert!(
                (a - b).to_array().iter().any(|gap| gap.abs() > 0.1),
                "colors of {label}"
            );
            let gap = (label_gray(label) - label_gray(label + 1)).abs();
            assert!(gap > 0.2, "grays of {label}");
        }
    }
}
