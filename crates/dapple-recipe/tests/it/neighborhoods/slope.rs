//! Tests of `slope` on planes and against differences in double precision.

use super::{assert_near, numbers, with_image};
use crate::bakes::plan;
use dapple_raster::{Raster, Wrap};

#[test]
fn slope_is_the_angle_of_a_plane_up_to_its_last_row() {
    // A rise of 1 per unit is 45 degrees, from a function or from an image that ends at the sides.
    let text = "dapple = 1\nextent = [1.0, 2.0]\nwrap = [false, false]\n[nodes]\nx.coordinate = { along = [2.0, 0.0] }\n\
                a.image = { file = \"a.png\" }\nof_x.slope = { input = \"x\" }\n\
                of_image.slope = { input = \"a\", relief = 16.0 }\nfar.slope = { input = \"a\", relief = 16.0, radius = 1.0 }\n\
                soft.blur = { input = \"of_image\", radius = 0.2 }\n\
                twice.slope = { input = \"of_image\", radius = 0.5 }\n\
                [material]\nrelief = 0.5\n";
    // Each pixel rises by 1/256 of 16 units, and is 1/16 unit high.
    let image = Raster::from_fn([16, 32], |_, y| f32::from(y as u8) / 256.0).unwrap();
    let plan = with_image(text, image);
    for node in ["of_x", "of_image", "far", "soft"] {
        assert_near(&numbers(&plan, node, [16, 32]), |_, _| 0.5, 1e-6);
    }
    assert_near(&numbers(&plan, "twice", [16, 32]), |_, _| 0.0, 1e-6);
}

#[test]
fn slope_equals_central_differences_on_pixels_that_are_not_square() {
    let text = "dapple = 1\nextent = [2.0, 1.0]\n[nodes]\ncells.worley.frequency = 4.0\n\
                near.slope = { input = \"cells\", relief = 0.2 }\n\
                far.slope = { input = \"cells\", relief = -0.2, radius = 0.1 }\n[material]\n";
    let plan = plan(text);
    let size = [40, 50];
    let cells = numbers(&plan, "cells", size);
    for (node, spans) in [("near", [1, 1]), ("far", [2, 5])] {
        let right = |x: i64, y: i64| {
            let at = |dx: i64, dy: i64| f64::from(*cells.at(x + dx, y + dy, [Wrap::Repeat; 2]));
            let [u, v] = [spans[0] as f64 / 20.0, spans[1] as f64 / 50.0];
            let dx = 0.2 * (at(spans[0], 0) - at(-spans[0], 0)) / (2.0 * u);
            let dy = 0.2 * (at(0, spans[1]) - at(0, -spans[1])) / (2.0 * v);
            libm::atan((dx * dx + dy * dy).sqrt()) / std::f64::consts::FRAC_PI_2
        };
        // Positions past the sides round.
        assert_near(&numbers(&plan, node, size), right, 1e-5);
    }
}
