//! Tests of `slope_blur` and `flow_warp`.

use super::{assert_near, numbers, random, with_image};
use dapple_raster::{Raster, Wrap};

/// An image of 32 × 24 random numbers.
fn picture() -> Raster<f32> {
    Raster::from_fn([32, 24], random).unwrap()
}

#[test]
fn on_a_plane_it_is_a_one_sided_blur_downhill() {
    let text = "dapple = 1\nextent = [4.0, 3.0]\nwrap = [false, false]\n[nodes]\na.image = { file = \"a.png\" }\n\
                falling.coordinate = { along = [0.0, -2.0] }\n\
                flat.coordinate = { along = [0.0, 0.0] }\n\
                runs.slope_blur = { input = \"a\", height = \"falling\", radius = 0.25 }\n\
                still.slope_blur = { input = \"a\", height = \"flat\", radius = 0.25 }\n\
                small.slope_blur = { input = \"a\", height = \"falling\", radius = 0.04 }\n\
                down.blur = { input = \"a\", radius = 0.25, along = 90, one_sided = true }\n[material]\n";
    let plan = with_image(text, picture());
    let node = |node: &str| numbers(&plan, node, [32, 24]);
    let [down, a] = ["down", "a"].map(node);
    assert_near(
        &node("runs"),
        |x, y| down.row(y as u32)[x as usize].into(),
        1e-6,
    );
    assert_eq!(node("still"), a, "level ground");
    assert_eq!(node("small"), a, "less than a third of a pixel");
}

#[test]
fn on_a_plane_values_flow_by_whole_pixels() {
    let text = "dapple = 1\nextent = [4.0, 3.0]\nwrap = [false, false]\n[nodes]\na.image = { file = \"a.png\" }\n\
                falling.coordinate = { along = [0.0, -2.0] }\n\
                flat.coordinate = { along = [0.0, 0.0] }\n\
                down.flow_warp = { input = \"a\", height = \"falling\", amount = 0.25 }\n\
                up.flow_warp = { input = \"a\", height = \"falling\", amount = 0.25, direction = \"uphill\" }\n\
                right.flow_warp = { input = \"a\", height = \"falling\", amount = 0.25, steps = 3, direction = \"contour\" }\n\
                still.flow_warp = { input = \"a\", height = \"flat\", amount = 0.25 }\n[material]\n";
    let plan = with_image(text, picture());
    let node = |node: &str| numbers(&plan, node, [32, 24]);
    let a = node("a");
    assert_eq!(node("still"), a, "level ground");
    for (name, from) in [("down", [0, -2]), ("up", [0, 2]), ("right", [-2, 0])] {
        let moved = node(name);
        for y in 2..22 {
            for x in 2..30_i64 {
                let source = a.row((y + from[1]) as u32)[(x + from[0]) as usize];
                let found = moved.row(y as u32)[x as usize];
                // The steps round.
                assert!((found - source).abs() < 1e-5, "{name} at {x}, {y}");
            }
        }
    }
}

#[test]
fn paths_follow_the_interpolated_gradient_on_pixels_that_are_not_square() {
    let text = "dapple = 1\nextent = [2.0, 3.0]\n[nodes]\na.image = { file = \"a.png\" }\n\
                hill.blur = { input = \"a\", radius = 0.2 }\n\
                runs.slope_blur = { input = \"a\", height = \"hill\", radius = 0.1 }\n[material]\n";
    let plan = with_image(text, picture());
    let [hill, runs] = ["hill", "runs"].map(|node| numbers(&plan, node, [32, 24]));
    let image = picture();
    let pixel = [2.0 / 32.0, 3.0 / 24.0];
    let at = |raster: &Raster<f32>, x: f64, y: f64| {
        let [left, above] = [x.floor(), y.floor()];
        let value = |dx: i64, dy: i64| {
            let [column, row] = [left as i64 + dx, above as i64 + dy];
            f64::from(*raster.at(column, row, [Wrap::Repeat; 2]))
        };
        let [s, t] = [x - left, y - above];
        (1.0 - t) * ((1.0 - s) * value(0, 0) + s * value(1, 0))
            + t * ((1.0 - s) * value(0, 1) + s * value(1, 1))
    };
    let right = |x: i64, y: i64| {
        let [mut u, mut v] = [x as f64, y as f64];
        let (mut sum, mut total) = (at(&image, u, v), 1.0);
        // The smaller side of a pixel fits 4.8 times into three radii.
        for step in 1..=4 {
            let dx = (at(&hill, u + 1.0, v) - at(&hill, u - 1.0, v)) / pixel[0];
            let dy = (at(&hill, u, v + 1.0) - at(&hill, u, v - 1.0)) / pixel[1];
            let length = (dx * dx + dy * dy).sqrt();
            u += pixel[0] * dx / length / pixel[0];
            v += pixel[0] * dy / length / pixel[1];
            let part = f64::from(step) * pixel[0] / 0.1;
            let weight = libm::exp(-0.5 * part * part);
            sum += weight * at(&image, u, v);
            total += weight;
        }
        sum / total
    };
    // The hill past the sides rounds, which turns paths a little.
    assert_near(&runs, right, 1e-4);
}
