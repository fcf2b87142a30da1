//! Draws lines of English text in upright letters, cropped from a page.
//!
//! The image does **not** tile: words are cut off at the right, and the last line at the bottom. Mirroring would be
//! obvious.

use crate::draw::Canvas;
use dapple_color::LinearRgb;
use dapple_raster::{Raster, Window};
use glam::DVec2;

/// Lines of the text, each longer than the width of the image.
const LINES: [&str; 14] = [
    "of all the small things that a hand may",
    "copy, a page of words is the one that",
    "Where a stripe bends, we see a stripe,",
    "but let one letter turn its back and",
    "every reader stops. So paint the hide with",
    "lines of type. Begin at the nose, and so",
    "follow the grain of the coat down along",
    "the neck, over the belly, to the tail.",
    "No word has to be kept, only the look",
    "of words, the quick rhythm of thin and",
    "wide, of gap and stem, the way a dozen",
    "rows run level and never quite meet or part",
    "or drift. Then it is a good match, good",
    "for a page, and so for any other skin of",
];

/// Shift of each line to the left, in multiples of the image width.
const SHIFTS: [f64; 14] = [
    0.03, -0.01, 0.05, 0.02, -0.02, 0.06, 0.01, 0.04, -0.01, 0.07, 0.03, 0.00, 0.05, 0.02,
];

/// Number of lines that fit in the height of the image.
const N_LINES: f64 = 13.4;

/// Height of capital letters, in multiples of the line spacing.
const CAPITAL: f64 = 0.56;

/// Draws text, `size` pixels wide and high.
pub(super) fn text(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let [ink, paper] = [[22_u8, 20, 26], [238, 230, 212]].map(LinearRgb::from_srgb);
    let mut canvas = Canvas::new(&Window::unit([size; 2])?, paper)?;
    let height_px = CAPITAL / N_LINES * f64::from(size);
    for (row, (line, shift)) in (0..).zip(LINES.iter().zip(SHIFTS)) {
        let start = DVec2::new(-shift, (f64::from(row) + 0.75) / N_LINES);
        canvas.text(start, height_px, line, ink);
    }
    Ok(canvas.into_raster())
}
