//! Tests of `dilate`, `erode`, `distance_to`, `edges` and `sharpen` against formulas over all pixels of the tile.

use super::{assert_near, numbers, with_image};
use dapple_raster::{Raster, Wrap};

const REPEAT: [Wrap; 2] = [Wrap::Repeat; 2];

/// An image of a tile of 2 × 1 units. Its pixels are not square: 1/20 × 1/25 of a unit.
fn picture() -> Raster<f32> {
    let number = |x: u32, y: u32| (x * x * 31 + y * 17 + x * y * 5) % 97;
    Raster::from_fn([40, 25], |x, y| number(x, y) as f32 / 96.0 - 0.3).unwrap()
}

fn of_picture(image: Raster<f32>, node: &str) -> Raster<f32> {
    let text = format!(
        "dapple = 1\nextent = [2.0, 1.0]\n[nodes]\na.image = {{ file = \"a.png\" }}\nb = {{ {node} }}\n[material]\n"
    );
    let size = image.size();
    numbers(&with_image(&text, image), "b", size)
}

/// Returns the offsets within a radius, in pixels, each with its length in units.
fn disk(radius: f64) -> Vec<(i64, i64, f64)> {
    let offsets = (-40..=40).flat_map(|x| (-25..=25).map(move |y| (x, y)));
    let with_length = offsets.map(|(x, y)| {
        let [u, v] = [x as f64 / 20.0, y as f64 / 25.0];
        (x, y, (u * u + v * v).sqrt())
    });
    with_length
        .filter(|&(_, _, length)| length <= radius + 1e-9)
        .collect()
}

#[test]
fn dilate_and_erode_are_the_extremes_of_a_disk() {
    let image = picture();
    // 0.13² is the squared distance 0.05² + 0.12² of a pixel, and 0.2 is a whole number of columns and rows.
    for radius in [0.02, 0.05, 0.13, 0.2, 0.41] {
        let disk = disk(radius);
        let largest = of_picture(
            image.clone(),
            &format!("dilate = {{ input = \"a\", radius = {radius} }}"),
        );
        let least = of_picture(
            image.clone(),
            &format!("erode = {{ input = \"a\", radius = {radius} }}"),
        );
        let around = |x: i64, y: i64| disk.iter().map(move |&(dx, dy, _)| (x + dx, y + dy));
        let largest_at = |x, y| {
            let values = around(x, y).map(|(x, y)| *image.at(x, y, REPEAT));
            values.fold(f32::NEG_INFINITY, f32::max).into()
        };
        let least_at = |x, y| {
            let values = around(x, y).map(|(x, y)| *image.at(x, y, REPEAT));
            values.fold(f32::INFINITY, f32::min).into()
        };
        assert_near(&largest, largest_at, 0.0);
        assert_near(&least, least_at, 0.0);
    }
}

#[test]
fn zero_has_one_sign_and_nan_counts_as_nothing() {
    let mut image = Raster::filled([40, 25], -0.0).unwrap();
    image.pixels_mut()[3] = f32::NAN;
    for kind in ["dilate", "erode"] {
        let found = of_picture(
            image.clone(),
            &format!("{kind} = {{ input = \"a\", radius = 0.1 }}"),
        );
        let is_zero = found.pixels().iter().all(|value| value.to_bits() == 0);
        assert!(is_zero, "{kind}");
    }
}

#[test]
fn distance_to_a_mask_is_exact_between_pixel_centers() {
    let mask = picture().map(|&value| f32::from(u8::from(value > 0.65)));
    for radius in [0.02, 0.11, 0.5] {
        let disk = disk(radius);
        let right = |x: i64, y: i64| {
            let inside = disk
                .iter()
                .filter(|(dx, dy, _)| *mask.at(x + dx, y + dy, REPEAT) > 0.5);
            inside.map(|&(_, _, length)| length).fold(radius, f64::min)
        };
        let node = format!("distance_to = {{ input = \"a\", radius = {radius} }}");
        // Distances are rounded to single precision.
        assert_near(&of_picture(mask.clone(), &node), right, 1e-7);
    }
    let none = Raster::filled([40, 25], 0.5).unwrap();
    let found = of_picture(none, "distance_to = { input = \"a\", radius = 0.3 }");
    assert!(found.pixels().iter().all(|&distance| distance == 0.3));
}

#[test]
fn edges_are_half_of_a_step_within_the_radius() {
    let step =
        Raster::from_fn([40, 25], |x, _| f32::from(u8::from((10..30).contains(&x)))).unwrap();
    let found = of_picture(step, "edges = { input = \"a\", radius = 0.15 }");
    let right = |x: i64, _: i64| match x {
        7..=12 | 27..=32 => 0.5,
        _ => 0.0,
    };
    assert_near(&found, right, 1e-6);
    let image = picture();
    let found = of_picture(image.clone(), "edges = { input = \"a\", radius = 0.08 }");
    let right = |x: i64, y: i64| {
        // The radius is rounded to two columns and two rows.
        let at = |dx: i64, dy: i64| f64::from(*image.at(x + dx, y + dy, REPEAT));
        let [u, v] = [(at(2, 0) - at(-2, 0)) / 0.2, (at(0, 2) - at(0, -2)) / 0.16];
        0.08 * (u * u + v * v).sqrt()
    };
    assert_near(&found, right, 1e-6);
}

#[test]
fn edges_of_a_gray_color_are_those_of_its_number() {
    let text = "dapple = 1\nextent = [2.0, 1.0]\n[nodes]\na.image = { file = \"a.png\" }\nheld.clamp.input = \"a\"\n\
                gray.ramp = { input = \"held\", colors = [\"#000\", \"#fff\"], space = \"linear\" }\n\
                of_number.edges = { input = \"held\", radius = 0.1 }\nof_color.edges = { input = \"gray\", radius = 0.1 }\n\
                [material]\n";
    let plan = with_image(text, picture());
    let [number, color] = ["of_number", "of_color"].map(|node| numbers(&plan, node, [40, 25]));
    // The ramp rounds.
    assert_near(&color, |x, y| number.row(y as u32)[x as usize].into(), 1e-6);
}

#[test]
fn sharpening_adds_the_difference_from_the_blur() {
    let image = picture();
    let soft = of_picture(image.clone(), "blur = { input = \"a\", radius = 0.07 }");
    let found = of_picture(
        image.clone(),
        "sharpen = { input = \"a\", radius = 0.07, amount = 1.5 }",
    );
    let right = |x: i64, y: i64| {
        let [here, soft] =
            [&image, &soft].map(|raster| f64::from(raster.row(y as u32)[x as usize]));
        here + 1.5 * (here - soft)
    };
    assert_near(&found, right, 1e-6);
}
