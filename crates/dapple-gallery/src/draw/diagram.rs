//! Draws elements of diagrams other than points and plain lines: arrows, dashed lines and labels.

use super::Canvas;
use super::letters::strokes;
use super::stencil::Stencil;
use dapple_raster::{Texel, glam::DVec2};

/// Stroke width of a letter, as a fraction of its height.
const STROKE: f64 = 0.14;

impl<T: Texel> Canvas<T> {
    /// Draws a straight line with an arrowhead at its end. `width_px` is in pixels.
    pub fn arrow(&mut self, [from, to]: [DVec2; 2], width_px: f64, ink: T) {
        let back = (from - to).normalize_or_zero()
            * (5.0 * width_px)
            * DVec2::from(self.window.pixel).abs();
        let aside = 0.5 * back.perp();
        let head = [[back + aside, DVec2::ZERO], [back - aside, DVec2::ZERO]];
        let head = head.map(|line| line.map(|end| to + end));
        self.lines(&[[from, to], head[0], head[1]], width_px, ink);
    }

    /// Draws a straight line of `n` dashes with gaps of the same length. `width_px` is in pixels.
    pub fn dashes(&mut self, [from, to]: [DVec2; 2], n: u32, width_px: f64, ink: T) {
        let n_parts = f64::from(2 * n.max(1) - 1);
        let part = |index: u32| from.lerp(to, f64::from(index) / n_parts);
        let dashes: Vec<_> = (0..n.max(1))
            .map(|dash| [part(2 * dash), part(2 * dash + 1)])
            .collect();
        self.lines(&dashes, width_px, ink);
    }

    /// Writes a line of text that starts at `start`, the left end of its baseline. Capitals are `height_px` pixels
    /// high.
    ///
    /// The alphabet has the English letters, `Δ` and a few signs; any other character leaves a space.
    pub fn text(&mut self, start: DVec2, height_px: f64, text: &str, ink: T) {
        let start = self.pixel_from_plane(start);
        let mut stencil = Stencil::new(self.window.size);
        for line in strokes(text) {
            let line = line.map(|end| start + height_px * end);
            stencil.segment(line, 0.5 * STROKE * height_px);
        }
        stencil.ink(&mut self.raster, ink);
    }
}

#[cfg(test)]
mod tests {
    use super::super::Canvas;
    use dapple_raster::{Window, glam::DVec2};

    fn canvas() -> Canvas<f32> {
        Canvas::new(&Window::unit([32; 2]).unwrap(), 0.0).unwrap()
    }

    #[test]
    fn text_stands_on_its_line_and_ends_where_its_letters_do() {
        let mut canvas = canvas();
        canvas.text(DVec2::new(0.25, 0.75), 16.0, "L", 1.0);
        let drawn = canvas.into_raster();
        assert_eq!(drawn.row(15)[8], 1.0, "the upright of the L");
        assert_eq!(drawn.row(23)[14], 1.0, "its foot");
        assert_eq!(drawn.row(15)[14], 0.0, "nothing between");
        assert_eq!(drawn.row(26)[8], 0.0, "nothing below");
    }

    #[test]
    fn arrows_have_their_head_at_the_end() {
        let mut canvas = canvas();
        canvas.arrow([DVec2::new(0.1, 0.5), DVec2::new(0.9, 0.5)], 1.0, 1.0);
        let drawn = canvas.into_raster();
        let covered = |column: usize| (0..32).filter(|&row| drawn.row(row)[column] > 0.2).count();
        assert!(covered(25) > covered(6), "the head is not wider");
    }

    #[test]
    fn dashes_begin_and_end_with_a_dash() {
        let mut canvas = canvas();
        let line = [DVec2::new(0.0, 0.52), DVec2::new(1.0, 0.52)];
        canvas.dashes(line, 3, 1.0, 1.0);
        let drawn = canvas.into_raster();
        let row = drawn.row(16);
        let ends = [row[2], row[29], row[15]];
        assert!(ends.iter().all(|&dash| dash > 0.5), "no dashes: {ends:?}");
        assert_eq!([row[9], row[22]], [0.0; 2], "no gaps");
    }

    #[test]
    fn diagrams_that_are_not_finite_leave_the_canvas_alone() {
        let mut canvas = canvas();
        let nowhere = DVec2::splat(f64::NAN);
        canvas.arrow([nowhere, nowhere], 1.0, 1.0);
        canvas.dashes([nowhere, DVec2::ZERO], 0, 1.0, 1.0);
        canvas.text(nowhere, 8.0, "x", 1.0);
        assert_eq!(canvas.into_raster().statistics().max, 0.0);
    }
}
