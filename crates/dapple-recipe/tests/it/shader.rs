//! Tests of the WGSL generated for materials. `dapple-wgsl-tests` runs the shaders.

use dapple_recipe::hash::Seed;
use dapple_recipe::raster::FieldExt as _;
use dapple_recipe::{
    Images, MaterialShader, Plan, Recipe, RecipeErrorKind, ShaderOptions, field_to_wgsl,
};

const TEXTURES: ShaderOptions = ShaderOptions { textures: true };

fn recipe(text: &str) -> Recipe {
    Recipe::from_toml(&format!("dapple = 1\nextent = [4.0, 4.0]\n{text}")).expect("a recipe")
}

fn shader(text: &str, options: &ShaderOptions) -> MaterialShader {
    let shader = recipe(text).to_wgsl(&Images::new(), options);
    shader.unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn a_material_of_local_nodes_needs_no_textures() {
    let text = "
        nodes.joint.worley = { value = 'f2_minus_f1' }
        nodes.stone.worley = { value = 'cell_value', seed = 'joint' }
        nodes.grain.noise = { basis = 'gradient' }
        nodes.height.add = ['joint', 'stone', 'grain']
        material.height = 'height'";
    let shader = shader(text, &ShaderOptions::default());
    assert!(shader.textures.is_empty(), "{:?}", shader.textures);
    let count = |part: &str| shader.wgsl.matches(part).count();
    assert_eq!(
        count("fn material(place: Place2d, zero: u32) -> Material {"),
        1
    );
    assert_eq!(count("struct Textures"), 0);
    // The cells of both nodes are searched once, and a module of the library is there once.
    assert_eq!(count("= worley_2d("), 1);
    assert_eq!(count("fn worley_2d("), 1);
    assert_eq!(count("fn place_2d("), 1);
    // Four octaves of noise, each with its parameters
    assert_eq!(count("const NOISE_"), 4);
}

#[test]
fn refusals_name_each_node_and_the_reason() {
    let text = "
        nodes.cells.pups = { color_noise = {} }
        nodes.net.worley = { value = 'f4' }
        nodes.sum.add = ['cells', 'net', 'cells']
        material.albedo = 'sum'";
    let refused = recipe(text).to_wgsl(&Images::new(), &ShaderOptions::default());
    let refused = refused.expect_err("two nodes have no shader");
    let RecipeErrorKind::NotInShader { nodes } = refused.kind() else {
        panic!("{refused}");
    };
    let pair = |name: &str, reason: &str| (name.to_owned(), reason.to_owned());
    let expected = [
        pair("cells", "colors of control points have no shader"),
        pair("net", "the distances F3 and F4 have no shader"),
    ];
    assert_eq!(nodes[..], expected);
    let message = refused.to_string();
    assert!(
        message.contains("`net`: the distances F3 and F4 have no shader"),
        "{message}"
    );
    let shader = shader(text, &TEXTURES);
    assert_eq!(shader.textures, ["cells", "net"]);
    assert!(
        shader.wgsl.contains("    net_value: f32,"),
        "{}",
        shader.wgsl
    );
    assert!(
        shader.wgsl.contains("textures: Textures, zero: u32"),
        "{}",
        shader.wgsl
    );
}

#[test]
fn a_node_without_a_shader_at_other_positions_makes_the_node_that_moves_it_a_texture() {
    let text = "
        nodes.cells.worley = { value = 'f4' }
        nodes.color.ramp = { input = 'cells', colors = ['#000000', '#ffffff'] }
        nodes.by.worley = {}
        nodes.bent.warp = { input = 'color', x = 'by', y = 0.0 }
        material.albedo = 'bent'";
    let shader = shader(text, &TEXTURES);
    // The material does not read `by`, since the texture has its effect.
    assert_eq!(shader.textures, ["bent"]);
    assert!(
        shader.wgsl.contains("    bent_color: vec3<f32>,"),
        "{}",
        shader.wgsl
    );
    for part in ["worley_2d", "color_ramp", "bent_at"] {
        assert!(!shader.wgsl.contains(part), "{part}: {}", shader.wgsl);
    }
}

#[test]
fn names_of_nodes_become_different_names_in_a_shader() {
    // A hyphen is not allowed there, and `fn` and `smooth` are words of WGSL.
    let text = "
        nodes.a-b.worley = {}
        nodes.a_b.worley = {}
        nodes.fn.worley = { value = 'f4' }
        nodes.smooth.add = ['a-b', 'a_b', 'fn']
        material.height = 'smooth'";
    let shader = shader(text, &TEXTURES);
    for name in ["node_a_b", "node_a_b_", "node_fn", "node_smooth"] {
        let declaration = format!("    let {name} = ");
        assert_eq!(shader.wgsl.matches(&declaration).count(), 1, "{name}");
    }
    assert!(
        shader.wgsl.contains("    fn_value: f32,"),
        "{}",
        shader.wgsl
    );
}

#[test]
fn tiles_and_control_points_become_words_of_a_texture() {
    let text = "
        nodes.bands.wavelet = { frequency = 2.0 }
        nodes.bumps.noise = { basis = 'pups', frequency = 2.0, octaves = 2 }
        nodes.bent.warp = { input = 'bands', x = 'bumps', y = 'bands' }
        nodes.sum.add = ['bands', 'bumps', 'bent']
        material.height = 'sum'";
    let shader = shader(text, &ShaderOptions::default());
    let signature = "fn material(place: Place2d, data: texture_2d<u32>, zero: u32) -> Material {";
    assert!(shader.wgsl.contains(signature), "{}", shader.wgsl);
    // The texture has whole rows.
    assert!(!shader.data.is_empty());
    assert!(shader.data.len().is_multiple_of(MaterialShader::DATA_ROW));
    // A tile of 8 cells with a margin of one follows the size, the number of bands and one band. At both positions the
    // noise reads the same tile.
    assert_eq!(shader.data[..4], [8, 8, 1, 0]);
    assert_eq!(
        shader.wgsl.matches("wavelet_noise_2d(data, 0u, ").count(),
        2
    );
    assert!(
        shader
            .wgsl
            .contains("fn bands_at(data: texture_2d<u32>, at: Position2d, zero: u32)")
    );
    assert_eq!(
        shader.wgsl.matches("= number_min(pups_sum(data, ").count(),
        1
    );
}

#[test]
fn a_material_without_such_nodes_has_no_data() {
    let text = "nodes.joint.worley = {}\nmaterial.height = 'joint'";
    let shader = shader(text, &ShaderOptions::default());
    assert!(shader.data.is_empty());
    assert!(!shader.wgsl.contains("data"), "{}", shader.wgsl);
}

#[test]
fn nodes_that_move_have_no_shader_at_another_time_than_0() {
    let text = "
        nodes.waves.worley = { motion = { cells = 2 } }
        nodes.crests.output = { of = 'waves', value = 'cell_value' }
        nodes.joint.worley = {}
        nodes.sum.add = ['waves', 'crests', 'joint']
        material.height = 'sum'";
    let recipe = recipe(text);
    for (time, textures) in [(0.0, &[][..]), (0.5, &["waves", "crests"])] {
        let plan = Plan::new(&recipe, &Images::new(), time).expect("a plan");
        let shader = recipe.to_wgsl_with(&plan, &TEXTURES).expect("a shader");
        assert_eq!(shader.textures, textures, "at {time}");
    }
}

#[test]
fn ranges_that_are_longer_than_any_number_have_no_shader() {
    let field = dapple_noise::GradientNoise2::new(Seed(1));
    let field = field.remap([0.0, 1.0], [-3e38, 3e38]).expect("a field");
    let text = "
        nodes.joint.worley = {}
        nodes.wide.levels = { input = 'joint', to = [-3e38, 3e38] }
        material.height = 'wide'";
    let node = recipe(text).to_wgsl(&Images::new(), &ShaderOptions::default());
    let node = node.map(|_| ()).expect_err("an infinite length");
    let field = field_to_wgsl(&field).expect_err("an infinite length");
    for refused in [field, node] {
        let RecipeErrorKind::NotInShader { nodes } = refused.kind() else {
            panic!("{refused}");
        };
        assert!(nodes[0].1.ends_with("infinite"), "{refused}");
    }
}

#[test]
fn recipes_that_differ_in_values_have_one_text_without_numbers() {
    let text = |frequency: f64, gain: f64, low: f64, radius: f64| {
        format!(
            "
            nodes.joint.worley = {{ value = 'f2_minus_f1', frequency = {frequency}, metric = 'manhattan' }}
            nodes.grain.noise = {{ basis = 'gradient', gain = {gain} }}
            nodes.bumps.noise = {{ basis = 'pups', frequency = {frequency} }}
            nodes.bands.wavelet = {{ frequency = {frequency} }}
            nodes.dome.profile = {{ input = 'joint', shape = {{ spots = {{ radius = {radius} }} }} }}
            nodes.color.ramp = {{ input = 'dome', colors = ['#204060', '#f0e0d0'] }}
            nodes.sum.add = ['grain', 'bumps', 'bands', {low}]
            material.height = 'sum'
            material.albedo = 'color'"
        )
    };
    let shaders = [
        text(3.0, 0.6, 0.1, 0.3),
        text(5.0, 0.7, 0.0, 0.4),
        text(6.0, 0.3, -0.2, 0.7),
    ];
    let shaders = shaders.map(|text| shader(&text, &ShaderOptions::default()));
    let moved = shaders.clone().map(MaterialShader::with_numbers);
    let [first, ..] = &moved;
    for (other, plain) in moved.iter().zip(&shaders) {
        assert_eq!(other.wgsl, first.wgsl);
        assert_eq!(other.numbers.len(), first.numbers.len());
        assert_eq!(other.clone().with_numbers(), *other);
        // The library is the same as in the text with numbers.
        assert_ne!(plain.wgsl, other.wgsl);
        let library = "fn worley_place_2d(";
        let rest = |text: &str| text.split_once(library).expect("a library").1.to_owned();
        assert_eq!(rest(&plain.wgsl), rest(&other.wgsl));
    }
    assert_ne!(moved[1].numbers, first.numbers);
    let two_octaves = text(3.0, 0.6, 0.1, 0.3).replace("gain", "octaves = 2, gain");
    let two_octaves = shader(&two_octaves, &ShaderOptions::default()).with_numbers();
    assert_ne!(two_octaves.wgsl, first.wgsl);
}
