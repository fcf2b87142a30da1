//! Tests of nodes that compute a value from values at the same position.

use crate::bakes::plan;
use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_pattern::{GaborNoise, GaborOptions, GaborValue};
use dapple_raster::FieldExt as _;
use dapple_recipe::{Images, Plan, Recipe, RecipeErrorKind};

/// Returns the value of a node at the position (x, 0.5). `node` is its TOML. Its inputs may be the node `x`, whose
/// value is x.
fn number(node: &str, x: f64) -> f32 {
    let text = format!(
        "dapple = 1\nwrap = [false, false]\n[nodes]\nx = {{ coordinate = {{ along = [1, 0] }} }}\nb = {{ {node} }}\n[material]\n"
    );
    plan(&text).field("b").unwrap().sample([x, 0.5])
}

/// Returns the color of a node at the position (x, 0.5). `node` is its TOML. Its inputs may be the node `x`, whose
/// value is x.
fn color(node: &str, x: f64) -> LinearRgb {
    let text = format!(
        "dapple = 1\nwrap = [false, false]\n[nodes]\nx = {{ coordinate = {{ along = [1, 0] }} }}\nb = {{ {node} }}\n[material]\n"
    );
    plan(&text).colors("b").unwrap().sample([x, 0.5]).unwrap()
}

/// Returns the color of sRGB codes.
fn hex(codes: [u8; 3]) -> LinearRgb {
    LinearRgb::from_srgb(codes)
}

#[test]
fn channels_are_components_of_the_color() {
    let channel = |color: &str, channel: &str| {
        number(
            &format!("channel = {{ input = \"{color}\", channel = \"{channel}\" }}"),
            0.0,
        )
    };
    let orange = hex([255, 128, 0]);
    assert_eq!(channel("#ff8000", "red"), orange.r);
    assert_eq!(channel("#ff8000", "green"), orange.g);
    assert_eq!(channel("#ff8000", "blue"), 0.0);
    assert_eq!(channel("#ff8000", "luminance"), orange.luminance());
    for (color, hue) in [
        ("#ff0000", 0.0),
        ("#ffff00", 1.0 / 6.0),
        ("#00ff00", 1.0 / 3.0),
        ("#00ffff", 0.5),
        ("#0000ff", 2.0 / 3.0),
        ("#ff00ff", 5.0 / 6.0),
        ("#ff8000", 128.0 / 255.0 / 6.0),
        ("#808080", 0.0),
    ] {
        // Rounded to f32
        let found = channel(color, "hue");
        assert!((found - hue).abs() < 1e-6, "{color}: {found}");
    }
    for (color, saturation, value) in [
        ("#ff8000", 1.0, 1.0),
        ("#804040", 0.5, 128.0 / 255.0),
        ("#000000", 0.0, 0.0),
    ] {
        assert_eq!(channel(color, "saturation"), saturation, "{color}");
        assert_eq!(channel(color, "value"), value, "{color}");
    }
    // A number is a gray.
    assert_eq!(
        number("channel = { input = \"x\" }", 0.25),
        LinearRgb::gray(0.25).luminance()
    );
}

#[test]
fn hues_saturations_and_lightnesses_are_those_of_css() {
    let changed = |input: &str, change: &str| -> [u8; 3] {
        color(&format!("hsl = {{ input = \"{input}\", {change} }}"), 0.0).to_srgb()
    };
    assert_eq!(changed("#ff0000", "hue = 0.33333333333"), [0, 255, 0]);
    assert_eq!(changed("#ff0000", "hue = -0.33333333333"), [0, 0, 255]);
    assert_eq!(changed("#ff8000", "hue = 0.5"), [0, 127, 255]);
    // hsl(30 100% 50%) with half of the saturation is hsl(30 50% 50%).
    assert_eq!(changed("#ff8000", "saturation = 0.5"), [191, 128, 64]);
    assert_eq!(changed("#ff8000", "saturation = 0"), [128, 128, 128]);
    // hsl(30 100% 25%)
    assert_eq!(changed("#ff8000", "lightness = 0.5"), [128, 64, 0]);
    assert_eq!(changed("#ff8000", "lightness = 2"), [255, 255, 255]);
    // Without a change, no channel is rounded.
    assert_eq!(
        color("hsl = { input = \"#345678\" }", 0.0),
        hex([0x34, 0x56, 0x78])
    );
    // A change by a node: none at 0, half a turn at 0.5
    let by = "hsl = { input = \"#ff0000\", hue = \"x\" }";
    assert_eq!(color(by, 0.0), hex([255, 0, 0]));
    assert_eq!(color(by, 0.5).to_srgb::<u8>(), [0, 255, 255]);
}

#[test]
fn curves_and_steps_map_numbers() {
    let curve = "curve = { input = \"x\", points = [[0, 0], [1, 1], [2, 4]] }";
    // Hermite: 0.5 + 1/8 (1 − 1.5)
    assert_eq!(
        [-1.0, 0.5, 1.0, 3.0].map(|x| number(curve, x)),
        [0.0, 0.4375, 1.0, 4.0]
    );
    let steps = "quantize = { input = \"x\", steps = 5 }";
    let found = [-0.2, 0.1, 0.13, 0.5, 0.9, 1.3].map(|x| number(steps, x));
    assert_eq!(found, [-0.25, 0.0, 0.25, 0.5, 1.0, 1.25]);
}

#[test]
fn thresholds_are_hard_or_soft() {
    let hard = "threshold = { input = \"x\", threshold = 0.25 }";
    assert_eq!([0.2, 0.25, 0.3].map(|x| number(hard, x)), [0.0, 1.0, 1.0]);
    let soft = "threshold = { input = \"x\", width = 0.5 }";
    let found = [0.25, 0.375, 0.5, 0.75, 2.0].map(|x| number(soft, x));
    // Smoothstep of 1/4 is 3/16 − 2/64.
    assert_eq!(found, [0.0, 0.15625, 0.5, 1.0, 1.0]);
    let of_node = "threshold = { input = 0.5, threshold = \"x\" }";
    assert_eq!([0.4, 0.6].map(|x| number(of_node, x)), [1.0, 0.0]);
}

#[test]
fn numbers_select_inputs_of_equal_parts() {
    let numbers = "select = { inputs = [5, \"x\", 7, 8], by = \"x\" }";
    let found = [-1.0, 0.0, 0.24, 0.3, 0.5, 0.75, 1.0, 9.0].map(|x| number(numbers, x));
    assert_eq!(found, [5.0, 5.0, 5.0, 0.3, 7.0, 8.0, 8.0, 8.0]);
    let colors = "select = { inputs = [\"x\", \"#ff8000\"], by = \"x\" }";
    assert_eq!(color(colors, 0.25), LinearRgb::gray(0.25));
    assert_eq!(color(colors, 0.75), hex([255, 128, 0]));
}

#[test]
fn inverted_numbers_and_colors_are_one_minus_them() {
    assert_eq!(number("invert = \"x\"", 0.25), 0.75);
    let LinearRgb { r, g, b } = hex([255, 128, 0]);
    assert_eq!(
        color("invert = \"#ff8000\"", 0.0),
        LinearRgb::new(1.0 - r, 1.0 - g, 1.0 - b)
    );
}

#[test]
fn noise_may_have_a_frequency_for_each_axis() {
    let field = |node: &str| {
        let text = format!("dapple = 1\nextent = [2, 3]\n[nodes]\na = {{ {node} }}\n[material]\n");
        plan(&text).field("a").unwrap()
    };
    for basis in [
        "noise = { basis = \"gradient\", octaves = 3, frequency = ",
        "noise = { basis = \"wavelet\", frequency = ",
        "wavelet = { frequency = ",
    ] {
        let [one, two, wide] =
            ["4", "[4, 4]", "[2, 8]"].map(|frequency| field(&format!("{basis}{frequency} }}")));
        let mut differs = false;
        for step in 0..200 {
            let [x, y] = [f64::from(step) * 0.0137, f64::from(step) * 0.0091];
            assert_eq!(one.sample([x, y]).to_bits(), two.sample([x, y]).to_bits());
            differs |= one.sample([x, y]) != wide.sample([x, y]);
            // Rounding positions in the next tile changes the noise by less than 1e-5.
            let there = wide.sample([x + 2.0, y - 3.0]);
            assert!((wide.sample([x, y]) - there).abs() < 1e-5, "{basis}");
        }
        assert!(differs, "{basis}");
    }
    // Gradient noise with the same seed, stretched
    let [stretched, plain] = ["[2, 8]", "2"].map(|frequency| {
        field(&format!(
            "noise = {{ basis = \"gradient\", octaves = 1, frequency = {frequency} }}"
        ))
    });
    assert_eq!(stretched.sample([0.3, 0.2]), plain.sample([0.3, 0.8]));
}

#[test]
fn gabor_noise_is_about_half_and_its_phase_is_in_turns() {
    let field = |options: &str| {
        let text = format!(
            "dapple = 1\nextent = [2, 1]\nseed = 3\n[nodes]\na = {{ gabor = {{ {options} }} }}\n[material]\n"
        );
        plan(&text).field("a").unwrap()
    };
    let of = GaborOptions {
        period: [Some(6), Some(4)],
        waves: 3.0,
        impulses: 5,
        angle: 30.0,
        spread: 90.0,
    };
    let noise = GaborNoise::new(Seed(3).child("a", 0), of).unwrap();
    let options = "frequency = [3, 4], waves = 3, angle = 30, spread = 90, impulses = 5";
    let [half, phase] = [options.to_owned(), format!("{options}, value = \"phase\"")]
        .map(|options| field(&options));
    for step in 0..200 {
        let [x, y] = [f64::from(step) * 0.0137, f64::from(step) * 0.0091];
        let at = [3.0 * x, 4.0 * y];
        let expected = (0.5 + noise.field(GaborValue::Noise).sample(at) / 6.0).clamp(0.0, 1.0);
        assert_eq!(half.sample([x, y]), expected);
        assert_eq!(
            phase.sample([x, y]),
            noise.field(GaborValue::Phase).sample(at)
        );
    }
}

#[test]
fn options_out_of_range_are_refused_with_the_limit() {
    let kind = |node: &str| {
        let text = format!("dapple = 1\n[nodes]\na = {{ {node} }}\n[material]\n");
        Plan::new(&Recipe::from_toml(&text).unwrap(), &Images::new(), 0.0)
            .unwrap_err()
            .kind()
            .clone()
    };
    for node in [
        "quantize = { input = 1, steps = 1 }",
        "threshold = { input = 1, width = -1 }",
        "curve = { input = 1, points = [[0, 0], [0, 1]] }",
        "curve = { input = 1, points = [[0, 0], [1, inf]] }",
        "gabor = { frequency = 2.5 }",
        "noise = { basis = \"gradient\", frequency = [0, 1] }",
        "noise = { basis = \"gradient\", frequency = [1, 1.5] }",
    ] {
        assert!(
            matches!(kind(node), RecipeErrorKind::Range { .. }),
            "{node}: {:?}",
            kind(node)
        );
    }
    for node in [
        "curve = { input = 1, points = [[0, 0]] }",
        "select = { inputs = [], by = 0 }",
    ] {
        assert!(
            matches!(kind(node), RecipeErrorKind::Count { .. }),
            "{node}: {:?}",
            kind(node)
        );
    }
    for node in [
        "threshold = { input = \"#fff\" }",
        "select = { inputs = [1], by = \"#fff\" }",
        "hsl = { input = 1, hue = \"#fff\" }",
    ] {
        assert!(
            matches!(kind(node), RecipeErrorKind::NotANumber { .. }),
            "{node}: {:?}",
            kind(node)
        );
    }
    let pups = kind("noise = { frequency = [4, 8] }");
    assert!(matches!(pups, RecipeErrorKind::Conflict { .. }), "{pups:?}");
}
