//! Tests of nodes that evaluate their input at other positions: `transform`, `fractal` and `warp`.

use crate::bakes::{assert_parts_have_the_bits_of_the_whole, plan};
use dapple_raster::{Field, FieldExt, Fractal, FractalShape, Raster, Window};
use dapple_recipe::{Images, Picture, Plan, Recipe, RecipeErrorKind, Region};

/// Returns the plan of a recipe with the node `a`, two octaves of noise, and the node `b` of the given text.
fn plan_of(head: &str, b: &str) -> Plan {
    plan(&format!(
        "dapple = 1\n{head}\n[nodes]\na = {{ noise = {{ octaves = 2 }} }}\nb = {{ {b} }}\n[material]\n"
    ))
}

/// Checks that node `b` equals `field` bit for bit: at the pixels of two windows, and at these pixels' centers as single
/// positions.
fn assert_same(plan: &Plan, field: &impl Field) {
    let node = plan.field("b").expect("a field");
    for window in [
        Window::unit([37, 29]).unwrap(),
        Window::new([-3.25, 40.1], [0.013, -0.021], [41, 23]).unwrap(),
    ] {
        let [found, expected] = [
            node.to_raster(&window).unwrap(),
            field.to_raster(&window).unwrap(),
        ];
        let bits = |raster: &Raster<f32>| -> Vec<u32> {
            raster
                .pixels()
                .iter()
                .map(|value| value.to_bits())
                .collect()
        };
        assert_eq!(bits(&found), bits(&expected), "{window:?}");
        for (column, row) in [(0, 0), (36, 22), (5, 17)] {
            let position = window.position(column, row);
            let at = found.row(row)[column as usize].to_bits();
            assert_eq!(node.value(position).to_bits(), at, "{position:?}");
        }
    }
}

#[test]
fn transforms_equal_the_combinators_of_fields() {
    let repeating = plan_of(
        "",
        "transform = { input = \"a\", frequency = [2, 3], offset = [0.25, -0.5] }",
    );
    let a = repeating.field("a").unwrap();
    assert_same(
        &repeating,
        &a.clone()
            .offset([0.25, -0.5])
            .frequency_per_axis([2.0, 3.0]),
    );
    let scaled = plan_of("", "transform = { input = \"a\", frequency = 5 }");
    assert_same(&scaled, &a.frequency(5.0));
    let open = plan_of(
        "wrap = [false, false]",
        "transform = { input = \"a\", frequency = 0.7, offset = [1, 2], rotation = 30 }",
    );
    let a = open.field("a").unwrap();
    let angle = 30.0_f64.to_radians();
    assert_same(&open, &a.offset([1.0, 2.0]).frequency(0.7).rotate(angle));
}

#[test]
fn a_quarter_turn_is_exact() {
    let plan = plan_of("", "transform = { input = \"a\", rotation = -270 }");
    let [a, b] = ["a", "b"].map(|node| plan.field(node).unwrap());
    for [x, y] in [[0.3, 0.8], [0.0, 0.125], [7.5, -2.25]] {
        assert_eq!(b.sample([x, y]).to_bits(), a.sample([y, -x]).to_bits());
    }
}

#[test]
fn fractal_sums_of_a_node_equal_those_of_fields() {
    for (name, shape) in [
        ("sum", FractalShape::Sum),
        ("ridged", FractalShape::Ridged),
        ("billow", FractalShape::Billow),
    ] {
        let plan = plan_of(
            "",
            &format!(
                "fractal = {{ input = \"a\", octaves = 5, gain = 0.6, lacunarity = 3, shape = \"{name}\" }}"
            ),
        );
        let octaves = vec![plan.field("a").unwrap(); 5];
        assert_same(&plan, &Fractal::new(octaves, 0.6, 3.0, shape).unwrap());
    }
}

#[test]
fn a_node_that_sees_the_whole_tile_is_averaged_where_it_is_repeated() {
    let plan = plan_of("", "tile = { input = \"a\", method = \"periodic\" }");
    let text = "dapple = 1\n[nodes]\na = { noise = { octaves = 2 } }\nb = { tile = { input = \"a\" } }\n\
        c = { transform = { input = \"b\", frequency = 2 } }\n[material]\nheight = \"c\"\n";
    let repeated = self::plan(text);
    let numbers = |plan: &Plan, node: &str| match plan.node_picture(node, [32, 32], None) {
        Ok(Picture::Numbers(raster)) => raster,
        other => panic!("{node}: {other:?}"),
    };
    let (tile, repeated) = (numbers(&plan, "b"), numbers(&repeated, "c"));
    for row in 0..32 {
        for column in 0..32 {
            // A pixel at twice the frequency covers two by two pixels of the tile.
            let of =
                |x: usize, y: usize| tile.row((2 * row + y as u32) % 32)[(2 * column + x) % 32];
            let mean = (of(0, 0) + of(1, 0) + of(0, 1) + of(1, 1)) / 4.0;
            let found = repeated.row(row)[column];
            // Weights of the average are rounded to f32.
            assert!(
                (found - mean).abs() < 1e-5,
                "{column}, {row}: {found}, {mean}"
            );
        }
    }
}

/// Returns pairs of values at 500 positions: the value of the node `b`, and the value of its input `a` at the position
/// that `expected` returns.
fn moved(head: &str, b: &str, expected: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f32; 2]> {
    let plan = plan_of(head, b);
    let [a, b] = ["a", "b"].map(|node| plan.field(node).unwrap());
    let positions = (0..500).map(|step| {
        [
            f64::from(step) * 0.0137 - 1.7,
            f64::from(step) * -0.0091 + 2.3,
        ]
    });
    positions
        .map(|position| [b.sample(position), a.sample(expected(position))])
        .collect()
}

/// Checks that the values of each pair differ by less than 1e-6. The noise changes by less than 50 per unit, and
/// positions are rounded to 2^-50.
fn assert_near(values: &[[f32; 2]]) {
    for [found, expected] in values {
        assert!((found - expected).abs() < 1e-6, "{found}, {expected}");
    }
}

#[test]
fn samples_are_at_the_given_positions() {
    let text = "dapple = 1\n[nodes]\na = { noise = { octaves = 2 } }\nx = { worley = {} }\ny = { noise = {} }\n\
        b = { sample = { input = \"a\", x = \"x\", y = \"y\", scale = [0.5, -2.0] } }\n[material]\n";
    let plan = plan(text);
    let [a, b, x, y] = ["a", "b", "x", "y"].map(|node| plan.field(node).unwrap());
    for step in 0..500 {
        let position = [f64::from(step) * 0.0137, f64::from(step) * -0.0091];
        let at = [
            0.5 * f64::from(x.sample(position)),
            -2.0 * f64::from(y.sample(position)),
        ];
        assert_eq!(b.sample(position).to_bits(), a.sample(at).to_bits());
    }
}

#[test]
fn mirrors_fold_the_tile_at_the_center_and_half_a_tile_away() {
    let folded = |x: f64, center: f64| {
        let offset = (x - center).rem_euclid(1.0);
        center + offset.min(1.0 - offset)
    };
    assert_near(&moved(
        "",
        "mirror = { input = \"a\", center = [0.25, 0.5] }",
        |[x, y]| [folded(x, 0.25), folded(y, 0.5)],
    ));
    assert_near(&moved(
        "",
        "mirror = { input = \"a\", axes = [false, true] }",
        |[x, y]| [x, folded(y, 0.0)],
    ));
    let open = "wrap = [false, false]";
    assert_near(&moved(
        open,
        "mirror = { input = \"a\", center = [0.25, 0.5] }",
        |[x, y]| [0.25 + (x - 0.25).abs(), 0.5 + (y - 0.5).abs()],
    ));
}

#[test]
fn polar_positions_are_the_angle_and_the_distance() {
    let open = "wrap = [false, false]\nextent = [2, 1]";
    assert_near(&moved(
        open,
        "polar = { input = \"a\", repeat = 3 }",
        |[x, y]| {
            let [x, y] = [x - 1.0, y - 0.5];
            let turns = libm::atan2(y, x) / core::f64::consts::TAU;
            [6.0 * turns.rem_euclid(1.0), (x * x + y * y).sqrt()]
        },
    ));
    // Right, below, left of and above the center
    let plan = plan_of("", "polar = { input = \"a\", center = [0.5, 0.5] }");
    let [a, b] = ["a", "b"].map(|node| plan.field(node).unwrap());
    for (at, turns) in [
        ([0.75, 0.5], 0.0),
        ([0.5, 0.75], 0.25),
        ([0.25, 0.5], 0.5),
        ([0.5, 0.25], 0.75),
    ] {
        assert_eq!(b.sample(at), a.sample([turns, 0.25]), "{at:?}");
    }
}

#[test]
fn a_kaleidoscope_has_the_symmetries_of_its_sectors() {
    let plan = plan_of(
        "wrap = [false, false]",
        "kaleidoscope = { input = \"a\", sectors = 5 }",
    );
    let [a, b] = ["a", "b"].map(|node| plan.field(node).unwrap());
    let at = |radius: f64, turns: f64| {
        let angle = turns * core::f64::consts::TAU;
        [
            0.5 + radius * libm::cos(angle),
            0.5 + radius * libm::sin(angle),
        ]
    };
    for step in 0..200 {
        let (radius, turns) = (0.01 * f64::from(step), 0.0005 * f64::from(step));
        // The first half of a sector shows the input; the other halves are its copies.
        let expected = a.sample(at(radius, turns));
        for sector in 0..5 {
            for turns in [turns, -turns] {
                let found = b.sample(at(radius, turns + f64::from(sector) / 5.0));
                assert!(
                    (found - expected).abs() < 1e-5,
                    "{radius}, {turns}: {found}, {expected}"
                );
            }
        }
    }
}

#[test]
fn folded_nodes_repeat_with_the_tile() {
    let head = "extent = [2, 1]";
    for node in [
        "mirror = { input = \"a\", center = [0.3, 0.1] }",
        "polar = { input = \"a\", repeat = 2 }",
        "kaleidoscope = { input = \"a\", sectors = 7, center = [0.25, 0.75] }",
        "sample = { input = \"a\", x = \"a\", y = \"a\" }",
    ] {
        let b = plan_of(head, node).field("b").unwrap();
        let window = |x, y| Window::new([x, y], [2.0, 1.0], [64, 32]).unwrap();
        let [here, there] =
            [window(0.0, 0.0), window(-6.0, 3.0)].map(|at| b.to_raster(&at).unwrap());
        for (here, there) in here.pixels().iter().zip(there.pixels()) {
            // Positions in other tiles are rounded to 2^-50.
            assert!((here - there).abs() < 1e-6, "{node}: {here}, {there}");
        }
    }
}

#[test]
fn options_of_folds_are_refused_with_their_range() {
    for node in [
        "mirror = { input = \"a\", center = [nan, 0] }",
        "polar = { input = \"a\", repeat = 0 }",
        "polar = { input = \"a\", center = [0, inf] }",
        "kaleidoscope = { input = \"a\", sectors = 0 }",
        "sample = { input = \"a\", x = 0, y = 0, scale = [1, inf] }",
    ] {
        let text =
            format!("dapple = 1\n[nodes]\na = {{ noise = {{}} }}\nb = {{ {node} }}\n[material]\n");
        let error = Plan::new(&Recipe::from_toml(&text).unwrap(), &Images::new(), 0.0).unwrap_err();
        assert!(
            matches!(error.kind(), RecipeErrorKind::Range { .. }),
            "{error}"
        );
        assert_eq!(error.node(), Some("b"));
    }
}

#[test]
fn maps_that_break_the_period_are_refused() {
    let refused = |head: &str, b: &str| {
        let text = format!(
            "dapple = 1\n{head}\n[nodes]\na = {{ noise = {{}} }}\nb = {{ {b} }}\n[material]\n"
        );
        let recipe = Recipe::from_toml(&text).unwrap();
        match Plan::new(&recipe, &Images::new(), 0.0) {
            Ok(_) => false,
            Err(error) => {
                assert!(
                    matches!(error.kind(), RecipeErrorKind::Conflict { .. }),
                    "{error}"
                );
                assert_eq!(error.node(), Some("b"));
                true
            }
        }
    };
    let turned = |degrees: f64| format!("transform = {{ input = \"a\", rotation = {degrees:?} }}");
    assert!(refused("", &turned(45.0)));
    assert!(!refused("", &turned(90.0)));
    assert!(refused("extent = [2, 1]", &turned(90.0)));
    assert!(!refused("extent = [2, 1]", &turned(180.0)));
    assert!(!refused("wrap = [false, false]", &turned(45.0)));
    assert!(refused("wrap = [true, false]", &turned(90.0)));
    let at = |frequency: &str| format!("transform = {{ input = \"a\", frequency = {frequency} }}");
    assert!(refused("", &at("1.5")));
    assert!(refused("", &at("[2, 0.5]")));
    assert!(!refused("wrap = [true, false]", &at("[2, 0.5]")));
    let sum =
        |lacunarity: f64| format!("fractal = {{ input = \"a\", lacunarity = {lacunarity:?} }}");
    assert!(refused("", &sum(2.5)));
    assert!(!refused("wrap = [false, false]", &sum(2.5)));
}

#[test]
fn nested_sums_are_refused_before_they_take_forever() {
    let text = "dapple = 1\n[nodes]\na = { noise = {} }\nb = { fractal = { input = \"a\", octaves = 32, lacunarity = 1 } }\n\
        c = { fractal = { input = \"b\", octaves = 32, lacunarity = 1 } }\nd = { fractal = { input = \"c\", octaves = 32, \
        lacunarity = 1 } }\n[material]\nheight = \"d\"\n";
    let recipe = Recipe::from_toml(text).unwrap();
    let error = Plan::new(&recipe, &Images::new(), 0.0).unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::TooMuch { limit: 4096, .. }),
        "{error}"
    );
    assert_eq!(error.node(), Some("d"));
}

#[test]
fn regions_and_bands_have_the_bits_of_the_whole() {
    let plan = plan(
        r#"
dapple = 1
extent = [4.0, 3.0]
[nodes]
a = { noise = { frequency = 2.0, octaves = 2 } }
sum = { fractal = { input = "a", octaves = 3, lacunarity = 3.0, shape = "ridged" } }
held = { clamp = { input = "sum", low = 0.25, high = 1.5 } }
turned = { transform = { input = "held", frequency = [2.0, 1.0], offset = [0.3, 0.1], rotation = 180.0 } }
colors = { ramp = { input = "turned", palette = "lagoon" } }
repeated = { transform = { input = "inside", frequency = 3.0 } }
folded = { mirror = { input = "colors", center = [0.3, 0.2] } }
around = { polar = { input = "folded" } }
star = { kaleidoscope = { input = "around", sectors = 5 } }
inside = { sample = { input = "star", x = "held", y = "turned" } }
[material]
height = "turned"
albedo = "repeated"
"#,
    );
    let region = Region {
        first: [40, 31],
        size: [56, 40],
    };
    assert_parts_have_the_bits_of_the_whole(&plan, [96, 72], region);
}
