//! Tests which exemplars tile and which do not.

use super::{EXEMPLARS, Edges, Exemplar};
use dapple_color::LinearRgb;
use dapple_raster::Raster;

fn draw(exemplar: &Exemplar, size: u32) -> Raster<LinearRgb> {
    (exemplar.draw)(size).unwrap()
}

/// Returns the mean difference between the pixels of two lines, over all channels.
fn apart(a: &[LinearRgb], b: &[LinearRgb]) -> f64 {
    let gaps = a.iter().zip(b).flat_map(|(&a, &b)| (a - b).to_array());
    gaps.map(|gap| f64::from(gap.abs())).sum::<f64>() / a.len() as f64
}

/// Returns the difference between the last row and the first, divided by the largest difference between any row and
/// the first.
fn seam(image: &Raster<LinearRgb>) -> f64 {
    let from_first = |row: u32| apart(image.row(0), image.row(row));
    let largest = (0..image.height())
        .map(from_first)
        .fold(f64::MIN_POSITIVE, f64::max);
    from_first(image.height() - 1) / largest
}

#[test]
fn exemplars_repeat_where_they_say_so() {
    for exemplar in &EXEMPLARS {
        // Features are many pixels large at this size, so adjacent rows are similar.
        let image = draw(exemplar, 256);
        let turned = Raster::from_fn([256; 2], |column, row| image.row(column)[row as usize]);
        let seams = [seam(&turned.unwrap()), seam(&image)];
        let fits = seams.iter().all(|&seam| seam < 0.5);
        let repeats = exemplar.edges == Edges::Repeating;
        assert_eq!(fits, repeats, "{}: {seams:?}", exemplar.name);
    }
}

#[test]
fn exemplars_have_colors_that_a_screen_shows_at_any_size() {
    for exemplar in &EXEMPLARS {
        for size in [16, 33, exemplar.side] {
            let image = draw(exemplar, size);
            assert_eq!(image.size(), [size; 2], "{}", exemplar.name);
            let shades = image.map(|color| color.luminance()).statistics();
            assert!(shades.deviation > 0.005, "{} is flat", exemplar.name);
            let parts = image.pixels().iter().flat_map(|color| color.to_array());
            let shown = parts.filter(|part| (0.0..=1.0).contains(part)).count();
            // A few highlights may be brighter than a display can show.
            let all = 3 * size as usize * size as usize;
            assert!(shown * 20 > all * 19, "{} is too bright", exemplar.name);
        }
    }
}

#[test]
fn exemplars_without_pixels_are_refused() {
    for exemplar in &EXEMPLARS {
        assert!((exemplar.draw)(0).is_err(), "{} of nothing", exemplar.name);
    }
}

#[test]
fn letter_and_text_differ_from_their_mirror_images() {
    for name in ["letter", "text"] {
        let exemplar = EXEMPLARS.iter().find(|exemplar| exemplar.name == name);
        let image = draw(exemplar.unwrap(), 64);
        let mirrored = Raster::from_fn([64; 2], |column, row| image.row(row)[63 - column as usize]);
        let apart = image
            .zip_map(&mirrored.unwrap(), |&a, &b| (a - b).luminance().abs())
            .unwrap();
        assert!(apart.statistics().mean > 0.03, "{name} is symmetric");
    }
}
