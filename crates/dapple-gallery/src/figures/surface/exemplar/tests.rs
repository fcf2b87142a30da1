use super::{EXEMPLARS, Edges, Exemplar};
use dapple_color::LinearRgb;
use dapple_raster::Raster;

fn draw(exemplar: &Exemplar, size: u32) -> Raster<LinearRgb> {
    (exemplar.draw)(size).unwrap()
}

/// How much two rows or columns differ in the mean, by the positions of their pixels.
fn apart(image: &Raster<LinearRgb>, pair: impl Fn(i64) -> [[i64; 2]; 2]) -> f64 {
    let side = i64::from(image.width());
    let at = |[column, row]: [i64; 2]| image.row(row as u32)[column as usize];
    let gap = |index: i64| {
        let [a, b] = pair(index).map(at);
        let gap = (a - b).to_array().map(|part| f64::from(part.abs()));
        gap.iter().sum::<f64>()
    };
    (0..side).map(gap).sum::<f64>() / side as f64
}

/// The step over the border between copies, over the largest step between neighbors within; across and down.
fn seams(image: &Raster<LinearRgb>) -> [f64; 2] {
    let last = i64::from(image.width()) - 1;
    let within = |pair: &dyn Fn(i64, i64) -> [[i64; 2]; 2]| {
        let steps = (0..last).map(|at| apart(image, |index| pair(index, at)));
        steps.fold(f64::MIN_POSITIVE, f64::max)
    };
    let across = within(&|index, at| [[at, index], [at + 1, index]]);
    let down = within(&|index, at| [[index, at], [index, at + 1]]);
    [
        apart(image, |index| [[last, index], [0, index]]) / across,
        apart(image, |index| [[index, last], [index, 0]]) / down,
    ]
}

#[test]
fn exemplars_repeat_where_they_say_so() {
    for exemplar in &EXEMPLARS {
        let seams = seams(&draw(exemplar, exemplar.side));
        match exemplar.edges {
            // A border that is no different from what is within has no larger step.
            Edges::Repeating => assert!(
                seams.iter().all(|&seam| seam <= 1.0),
                "{}: {seams:?}",
                exemplar.name
            ),
            Edges::Cropped => assert!(
                seams.iter().any(|&seam| seam > 1.0),
                "{}: {seams:?}",
                exemplar.name
            ),
        }
    }
}

#[test]
fn exemplars_have_colors_that_a_screen_shows_at_any_size() {
    for exemplar in &EXEMPLARS {
        for size in [16, 33, exemplar.side] {
            let image = draw(exemplar, size);
            assert_eq!(image.size(), [size; 2], "{}", exemplar.name);
            let shades = image.map(|color| color.luminance()).statistics();
            assert!(shades.deviation > 0.02, "{} is flat", exemplar.name);
            let parts = image.pixels().iter().flat_map(|color| color.to_array());
            let shown = parts.filter(|part| (0.0..=1.0).contains(part)).count();
            // Highlights may be brighter than a screen, in few places.
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
