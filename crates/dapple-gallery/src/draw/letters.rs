//! A small stroke font, for labels and for text as an image.
//!
//! A letter is drawn on a grid: `y` is 0 at the top of capitals, 3 at the top of small letters, 9 on the baseline and
//! 12 at the bottom of descenders. It is a list of strokes, separated by spaces. A stroke is a list of grid points
//! with two digits (in base 36) each. A plain stroke is straight from point to point; after `~` it is a curve from the
//! first to the last point, with the points between as control points; after `@` it is a closed curve.

use dapple_raster::glam::DVec2;

/// Height of a capital letter, in grid lines.
const CAPITAL: f64 = 9.0;

/// Gap between letters, in grid lines.
const GAP: f64 = 2.3;

/// Width of a space, in grid lines, in addition to the gap after it.
const SPACE: f64 = 2.5;

/// Number of corner-cutting iterations for a curve.
const N_CUTS: usize = 3;

/// Returns text as straight line segments, with capital letters of height 1. The text starts at `x = 0` with its
/// baseline at `y = 0`; `y` points down.
///
/// A character that is not in the alphabet leaves a space.
pub(super) fn strokes(text: &str) -> Vec<[DVec2; 2]> {
    let mut lines = Vec::new();
    let mut left = 0.0;
    for letter in text.chars() {
        let glyph = glyph(letter);
        let mut right = if glyph.is_empty() { SPACE } else { 0.0 };
        for stroke in glyph.split_whitespace() {
            let corners = corners(stroke);
            right = corners.iter().fold(right, |right, at| right.max(at.x));
            let place = |at: DVec2| (at + DVec2::new(left, -CAPITAL)) / CAPITAL;
            // A stroke of a single point is a dot.
            lines.extend(corners.first().map(|&first| [place(first); 2]));
            lines.extend(corners.windows(2).map(|pair| [pair[0], pair[1]].map(place)));
        }
        left += right + GAP;
    }
    lines
}

/// Returns the corners of a stroke, on the grid.
fn corners(stroke: &str) -> Vec<DVec2> {
    let digits: Vec<_> = stroke
        .chars()
        .filter_map(|digit| digit.to_digit(36))
        .collect();
    let mut points: Vec<_> = digits
        .chunks_exact(2)
        .map(|at| DVec2::new(f64::from(at[0]), f64::from(at[1])))
        .collect();
    let curve = stroke.starts_with(['~', '@']);
    if stroke.starts_with('@') {
        // A closed curve starts and ends at the midpoint of a side.
        let middle = 0.5 * (points[0] + points[points.len() - 1]);
        points.insert(0, middle);
        points.push(middle);
    }
    for _ in 0..if curve { N_CUTS } else { 0 } {
        points = cut(&points);
    }
    points
}

/// Cuts the corners of a polyline once. Its two ends stay in place (Chaikin, An algorithm for high-speed curve
/// generation, 1974).
fn cut(points: &[DVec2]) -> Vec<DVec2> {
    let last = points.len().saturating_sub(2);
    let mut finer = vec![points[0]];
    for (side, pair) in points.windows(2).enumerate() {
        if side > 0 {
            finer.push(pair[0].lerp(pair[1], 0.25));
        }
        if side < last {
            finer.push(pair[0].lerp(pair[1], 0.75));
        }
    }
    finer.push(points[points.len() - 1]);
    finer
}

/// Returns the strokes of a letter; empty if the alphabet does not have it.
const fn glyph(letter: char) -> &'static str {
    match letter {
        'a' => "@03535909 5359",
        'b' => "@03535909 0009",
        'c' => "~545303095958",
        'd' => "@03535909 5059",
        'e' => "0656 ~565303095958",
        'f' => "~4010131619 0333",
        'g' => "@03535909 ~53595c0c0b",
        'h' => "0009 ~0603535659",
        'i' => "0309 00",
        'j' => "~23292c0c0b 20",
        'k' => "0009 5306 2559",
        'l' => "0009",
        'm' => "0309 ~0603434649 ~4643838689",
        'n' => "0309 ~0603535659",
        'o' => "@03535909",
        'p' => "@03535909 030c",
        'q' => "@03535909 535c",
        'r' => "0309 ~06034344",
        's' => "~5453030656590908",
        't' => "~1013161949 0333",
        'u' => "~0306095956 5359",
        'v' => "033963",
        'w' => "0329436983",
        'x' => "0359 5309",
        'y' => "0339 631c",
        'z' => "03530959",
        'A' => "093069 1656",
        'B' => "0009 ~003050543404 ~043464693909",
        'C' => "~626000096967",
        'D' => "0009 ~002060693909",
        'E' => "50000959 0444",
        'F' => "500009 0444",
        'G' => "~6260000969 6965 6535",
        'H' => "0009 6069 0464",
        'I' => "0009",
        'J' => "~404649090706",
        'K' => "0009 6005 2369",
        'L' => "000959",
        'M' => "0900478089",
        'N' => "09006960",
        'O' => "@00606909",
        'P' => "0009 ~003060653505",
        'Q' => "@00606909 4669",
        'R' => "0009 ~003060653505 3569",
        'S' => "~6260000465690907",
        'T' => "0060 3039",
        'U' => "~000609696660",
        'V' => "003960",
        'W' => "0029426980",
        'X' => "0069 6009",
        'Y' => "003460 3439",
        'Z' => "00600969",
        'Δ' => "09306909",
        '.' => "09",
        ',' => "191a0b",
        '-' => "0646",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::{corners, glyph, strokes};
    use dapple_raster::glam::DVec2;

    #[test]
    fn every_letter_has_strokes_on_the_grid() {
        for letter in ('a'..='z').chain('A'..='Z').chain("Δ.,-".chars()) {
            let glyph = glyph(letter);
            assert!(!glyph.is_empty(), "no `{letter}`");
            for stroke in glyph.split_whitespace() {
                let digits = stroke.trim_start_matches(['~', '@']);
                assert_eq!(digits.len() % 2, 0, "half a point in `{letter}`");
                for at in corners(stroke) {
                    let inside = (0.0..=8.0).contains(&at.x) && (0.0..=12.0).contains(&at.y);
                    assert!(inside, "`{letter}` reaches {at}");
                }
            }
        }
    }

    #[test]
    fn small_letters_differ_from_their_mirror_images_in_a_text() {
        let lines = strokes("dapple");
        let right = lines.iter().flatten().fold(0.0_f64, |x, at| x.max(at.x));
        let mirrored = |at: &DVec2| DVec2::new(right - at.x, at.y);
        let has = |at: DVec2| lines.iter().flatten().any(|other| other.distance(at) < 0.1);
        let unlike = lines.iter().flatten().filter(|at| !has(mirrored(at)));
        assert!(unlike.count() > 10, "the text is symmetric");
    }

    #[test]
    fn unknown_characters_leave_a_space() {
        assert!(strokes("\u{1f980}\u{0}").is_empty(), "strokes of nothing");
        assert_eq!(strokes("a\u{1f980}b"), strokes("a b"));
    }
}
