//! Tests of the node `scatter`.

use crate::bakes::{assert_parts_have_the_bits_of_the_whole, plan};
use dapple_hash::Seed;
use dapple_pattern::{StampOptions, StampOverlap, StampShape, StampValue, Stamps};
use dapple_raster::{Field as _, FieldExt as _, Window};
use dapple_recipe::{Images, Plan, Recipe, RecipeErrorKind, Region};

const STAMPS: &str = "shape = \"leaf\", frequency = [3, 6], density = 2.5, jitter = 0.5, spacing = 0.25, row_offset = 0.5, \
    size = [0.8, 1.2], aspect = [0.4, 0.5], rotation = [-30, 30], height = [0.5, 1], bevel = 0.1, lift = 0.6, \
    tilt = 0.2, overlap = \"order\"";

#[test]
fn the_node_is_the_field_of_the_crate() {
    let text = format!(
        "dapple = 1\nseed = 7\nextent = [2, 1]\n[nodes]\na = {{ scatter = {{ {STAMPS} }} }}\n\
         b = {{ scatter = {{ {STAMPS}, value = \"random2\", seed = \"a\" }} }}\n[material]\n"
    );
    let plan = plan(&text);
    let options = StampOptions {
        period: [Some(6), Some(6)],
        cell_height: 0.5,
        shape: StampShape::Leaf,
        density: 2.5,
        jitter: 0.5,
        spacing: 0.25,
        row_offset: 0.5,
        size: [0.8, 1.2],
        aspect: [0.4, 0.5],
        rotation: [-30.0, 30.0],
        height: [0.5, 1.0],
        bevel: 0.1,
        lift: 0.6,
        tilt: 0.2,
        overlap: StampOverlap::Order,
    };
    let stamps = Stamps::new(Seed(7).child("a", 0), options).unwrap();
    let window = Window::new([-0.3, 0.2], [2.0, 1.0], [64, 32]).unwrap();
    for (node, value) in [("a", StampValue::Height), ("b", StampValue::Random2)] {
        let found = plan.field(node).unwrap().to_raster(&window).unwrap();
        let field = stamps.field(value).frequency_per_axis([3.0, 6.0]);
        assert_eq!(found.pixels(), field.to_raster(&window).unwrap().pixels());
        assert!(found.pixels().iter().any(|&value| value > 0.0));
    }
}

#[test]
fn regions_and_bands_have_the_bits_of_the_whole() {
    let plan = plan(&format!(
        "dapple = 1\nextent = [2, 1]\n[nodes]\na = {{ scatter = {{ {STAMPS} }} }}\n\
         b = {{ warp = {{ input = \"a\", x = \"a\", y = 0.1, amount = 0.1 }} }}\n[material]\nheight = \"a\"\n\
         roughness = \"b\"\n"
    ));
    let region = Region {
        first: [40, 31],
        size: [56, 30],
    };
    assert_parts_have_the_bits_of_the_whole(&plan, [128, 64], region);
}

#[test]
fn stamps_out_of_range_are_refused_with_the_node() {
    let error = |options: &str| {
        let text =
            format!("dapple = 1\n[nodes]\na = {{ scatter = {{ {options} }} }}\n[material]\n");
        Plan::new(&Recipe::from_toml(&text).unwrap(), &Images::new(), 0.0).unwrap_err()
    };
    let broken = error("frequency = 2.5");
    assert!(
        matches!(broken.kind(), RecipeErrorKind::Range { value: 2.5, .. }),
        "{broken}"
    );
    for options in [
        "size = [1, 9]",
        "density = 0",
        "frequency = 3, row_offset = 0.5",
        "density = 16, size = [1, 8]",
    ] {
        let error = error(options);
        assert!(
            matches!(error.kind(), RecipeErrorKind::Pattern(_)),
            "{options}: {error}"
        );
        assert_eq!(error.node(), Some("a"));
    }
}
