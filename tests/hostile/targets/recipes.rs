//! Targets for recipes, and for lists of control points and directions, which the command reads.

use super::accepted;
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::{Bake, BakeOptions, Images, MapKind, Picture, Plan, PlanLimits, Recipe};
use dapple::synth::Direction;
use std::sync::Arc;

const LIMITS: PlanLimits = PlanLimits {
    control_points: 1000,
    wavelet_cells: 1 << 12,
    synthesized_pixels: 1 << 12,
    values: 256,
    warps: 4,
    pixels: 1 << 12,
};

/// Reads a recipe. It must be rejected, or be equal after it is written and read again, and its bake must be rejected
/// or within the limits.
pub fn recipe(bytes: &[u8]) {
    let Ok(text) = core::str::from_utf8(bytes) else {
        return;
    };
    let read = if text.trim_start().starts_with('{') {
        Recipe::from_json(text)
    } else {
        Recipe::from_toml(text)
    };
    let Some(recipe) = accepted(read) else {
        return;
    };
    check_text(&recipe);
    let _ = accepted(recipe.to_rust());
    check_bake(&recipe);
}

/// Reads a list of directions in CSV or JSON, and tries to read it as a list of control points.
pub fn directions(bytes: &[u8]) {
    let Ok(text) = core::str::from_utf8(bytes) else {
        return;
    };
    for read in [Direction::parse_csv(text), Direction::parse_json(text)] {
        for direction in accepted(read).into_iter().flatten() {
            assert!(direction.at.is_finite(), "a place that is not finite");
            assert!(direction.vector.is_finite(), "a vector that is not finite");
        }
    }
    let around = [
        r#"{"dapple": 1, "nodes": {"a": {"pups": {"points": {"points": "#,
        r#"}}}}, "material": {"height": "a"}}"#,
    ];
    recipe([around[0], text, around[1]].concat().as_bytes());
}

fn check_text(recipe: &Recipe) {
    // TOML has no seeds above 2^63, and JSON has no infinite numbers or NaN.
    if let Some(text) = accepted(recipe.to_toml()) {
        let again = Recipe::from_toml(&text).expect("what was written can be read");
        let second = again.to_toml().expect("what was read can be written");
        // Compare only lengths: the first reading sorts nodes by name.
        assert_eq!(text.len(), second.len(), "something was lost in {text}");
        let again = Recipe::from_toml(&second).expect("what was written can be read");
        assert_eq!(again.to_toml().as_ref(), Ok(&second), "TOML again");
    }
    // JSON writes infinite numbers and NaN as `null`, which leaves out an option; TOML writes them as `inf` and `nan`.
    let toml = recipe.to_toml().unwrap_or_default();
    let is_finite = !["inf", "nan"].iter().any(|word| toml.contains(word));
    if is_finite
        && let Some(text) = accepted(recipe.to_json())
        && let Some(again) = accepted(Recipe::from_json(&text))
    {
        assert_eq!(again.to_json().as_ref(), Ok(&text), "JSON again");
    }
}

fn check_bake(recipe: &Recipe) {
    let photo = Raster::from_fn([4, 4], |x, y| LinearRgb::gray((x ^ y) as f32 / 3.0));
    let photo = Picture::Colors(Arc::new(photo.expect("4 × 4 pixels")));
    let files = recipe.image_files().into_iter();
    let images: Images = files.map(|file| (file.to_owned(), photo.clone())).collect();
    let Some(plan) = accepted(Plan::new_within(recipe, &images, 0.25, &LIMITS)) else {
        return;
    };
    for kind in MapKind::ALL {
        let options = BakeOptions {
            size: [8, 8],
            maps: vec![kind],
            ..BakeOptions::default()
        };
        let Some(bake) = accepted(Bake::new(&plan, &options)) else {
            continue;
        };
        let mut rows = 0;
        for band in bake {
            let Some(band) = accepted(band) else {
                return;
            };
            rows += band.maps[0].1.size()[1];
        }
        assert_eq!(rows, 8, "all rows of {}", kind.name());
    }
}

/// Recipe to which the README's example nodes are added. The nodes `a` and `b` are scalars; `c` is a color.
const AROUND: &str = r##"
dapple = 1
seed = 3
extent = [8.0, 8.0]

[material]
height = "a"
albedo = "x"
relief = 0.2

[nodes]
a = { noise = { frequency = 0.5, octaves = 2 } }
b = { coordinate = { along = [0.125, 0.0] } }
c = { ramp = { input = "a", palette = "lagoon" } }
"##;

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let readme = include_str!("../../../crates/dapple-recipe/README.md");
    let mut seeds = Vec::new();
    for row in readme.lines().filter(|row| row.starts_with("| `")) {
        let example = row
            .strip_suffix("` |")
            .and_then(|row| row.rsplit_once(" | `"));
        let Some((_, example)) = example else {
            continue;
        };
        let text = format!("{AROUND}x = {{ {example} }}\n");
        if let Ok(recipe) = Recipe::from_toml(&text) {
            seeds.extend(recipe.to_json().ok().map(String::into_bytes));
            seeds.push(text.into_bytes());
        }
    }
    for name in Recipe::builtin_names() {
        seeds.extend(
            Recipe::builtin_text(name)
                .ok()
                .map(|text| text.as_bytes().to_vec()),
        );
    }
    seeds
}

pub(super) fn direction_seeds() -> Vec<Vec<u8>> {
    let texts = [
        "x,y,z,dx,dy,dz\n# the nose\n0, 1, 2,  0, 0, -1\n1e-3,-2.5,3,1,0,0\n",
        "[{\"at\": [0, 1, 2], \"vector\": [0, 0, -1]}]",
        "[{\"x\": 0.25, \"y\": 0.5, \"value\": 1}, {\"x\": 0.75, \"y\": 0.125, \"value\": 0}, {\"x\": 0.5, \"y\": 0.9, \"value\": 0.5}]",
        "[{\"x\": 0.25, \"y\": 0.5, \"value\": 1, \"orientation\": [1, 0]}, {\"x\": 0.75, \"y\": 0.125, \"value\": 0, \"orientation\": [0, -3]}]",
    ];
    texts.map(|text| text.as_bytes().to_vec()).into()
}
