//! Tests of `blur` against sums over both axes in double precision.

use super::{assert_near, numbers, with_image};
use crate::bakes::plan;
use dapple_raster::{Raster, Wrap};
use dapple_recipe::Picture;

/// Returns the blurred value of a pixel: a sum over both axes, weighted by the product of the axes' weights. `per_unit`
/// is the number of pixels per unit along each axis.
pub(super) fn naive(
    values: &Raster<f32>,
    [x, y]: [i64; 2],
    radius: f64,
    per_unit: [f64; 2],
) -> f64 {
    blurred(values, [x, y], radius, per_unit, [Wrap::Repeat; 2])
}

fn blurred(
    values: &Raster<f32>,
    [x, y]: [i64; 2],
    radius: f64,
    per_unit: [f64; 2],
    wrap: [Wrap; 2],
) -> f64 {
    let reach = per_unit.map(|pixels| (3.0 * radius * pixels + 1e-6) as i64);
    let (mut sum, mut total) = (0.0, 0.0);
    for (dx, dy) in
        (-reach[0]..=reach[0]).flat_map(|dx| (-reach[1]..=reach[1]).map(move |dy| (dx, dy)))
    {
        let [u, v] = [dx as f64 / per_unit[0], dy as f64 / per_unit[1]];
        let weight = libm::exp(-(u * u + v * v) / (2.0 * radius * radius));
        sum += weight * f64::from(*values.at(x + dx, y + dy, wrap));
        total += weight;
    }
    sum / total
}

#[test]
fn blur_equals_the_sum_over_both_axes_also_on_pixels_that_are_not_square() {
    let text = "dapple = 1\nextent = [2.0, 1.0]\n[nodes]\ncells.worley.frequency = 4.0\n\
                soft.blur = { input = \"cells\", radius = 0.06 }\nfirm.blur = { input = \"cells\", radius = 0.005 }\n\
                [material]\nheight = \"soft\"\n";
    let plan = plan(text);
    for size in [[48, 24], [40, 50]] {
        let [cells, soft, firm] = ["cells", "soft", "firm"].map(|node| numbers(&plan, node, size));
        let per_unit = [f64::from(size[0]) / 2.0, f64::from(size[1])];
        // Sums are in single precision; positions past the sides round.
        assert_near(&soft, |x, y| naive(&cells, [x, y], 0.06, per_unit), 1e-5);
        assert_eq!(firm, cells, "less than a third of a pixel");
    }
}

#[test]
fn images_that_do_not_repeat_are_continued_by_their_border_pixels() {
    let text = "dapple = 1\nwrap = [false, false]\n[nodes]\na.image = { file = \"a.png\" }\n\
                soft.blur = { input = \"a\", radius = 0.1 }\n[material]\nheight = \"soft\"\n";
    let image = Raster::from_fn([20, 20], |x, y| ((3 * x + 5 * y) % 7) as f32).unwrap();
    let plan = with_image(text, image.clone());
    let right = |x, y| blurred(&image, [x, y], 0.1, [20.0; 2], [Wrap::Clamp; 2]);
    assert_near(&numbers(&plan, "soft", [20, 20]), right, 1e-5);
}

#[test]
fn a_constant_stays_the_same_bit_for_bit_and_colors_are_blurred_by_channel() {
    let text = "dapple = 1\n[nodes]\nsoft.blur = { input = 0.3, radius = 0.1 }\n\
                runs.blur = { input = 0.3, radius = 0.1, along = 33, one_sided = true }\n\
                cells.worley.frequency = 4.0\n\
                colors.ramp = { input = \"cells\", colors = [\"#000\", \"#fff\"], space = \"linear\" }\n\
                held.clamp.input = \"cells\"\n\
                soft_colors.blur = { input = \"colors\", radius = 0.1 }\n\
                soft_held.blur = { input = \"held\", radius = 0.1 }\n[material]\n";
    let plan = plan(text);
    for node in ["soft", "runs"] {
        let raster = numbers(&plan, node, [32, 32]);
        assert!(raster.pixels().iter().all(|&value| value == 0.3), "{node}");
    }
    let Picture::Colors(colors) = plan.node_picture("soft_colors", [32, 32], None).unwrap() else {
        panic!("colors stay colors");
    };
    // Linear interpolation from black to white gives the clamped number in each channel, but for its rounding.
    let held = numbers(&plan, "soft_held", [32, 32]);
    for channel in 0..3 {
        let one = colors.map(|color| color.to_array()[channel]);
        assert_near(&one, |x, y| held.row(y as u32)[x as usize].into(), 1e-6);
    }
}

#[test]
fn directional_blur_smears_forward_along_its_direction() {
    // A single white pixel.
    let mut image = Raster::filled([16, 16], 0.0).unwrap();
    image.pixels_mut()[5 * 16 + 8] = 1.0;
    let at = |node: &str| {
        let text = format!(
            "dapple = 1\n[nodes]\na.image = {{ file = \"a.png\" }}\nb.blur = {{ input = \"a\", radius = 0.125, {node} }}\n\
             [material]\n"
        );
        numbers(&with_image(&text, image.clone()), "b", [16, 16])
    };
    let gauss = |distance: f64| libm::exp(-distance * distance / 8.0);
    let total =
        |from: i32, step: f64| -> f64 { (from..=6).map(|k| gauss(f64::from(k) * step)).sum() };
    // The radius is two pixels, so that six pixels are reached.
    let down = at("along = 90, one_sided = true");
    let right = |x: i64, y: i64| match (x, y - 5) {
        (8, k @ 0..=6) => gauss(k as f64) / total(0, 1.0),
        _ => 0.0,
    };
    assert_near(&down, right, 1e-6);
    let both = at("along = 180");
    let right = |x: i64, y: i64| match (x - 8, y) {
        (k @ -6..=6, 5) => gauss(k as f64) / total(-6, 1.0),
        _ => 0.0,
    };
    assert_near(&both, right, 1e-6);
    // At 30 degrees, a step of one column is 1/cos 30° long, and half of 2/√3 rows down; five steps are in reach.
    let slanted = at("along = 30, one_sided = true");
    let (cos, tan) = (0.75_f64.sqrt(), (1.0_f64 / 3.0).sqrt());
    let all: f64 = (0..=5).map(|k| gauss(f64::from(k) / cos)).sum();
    let right = |x: i64, y: i64| {
        let k = x - 8;
        let part = (1.0 - ((y - 5) as f64 - k as f64 * tan).abs()).max(0.0);
        match k {
            0..=5 => part * gauss(k as f64 / cos) / all,
            _ => 0.0,
        }
    };
    assert_near(&slanted, right, 1e-6);
}
