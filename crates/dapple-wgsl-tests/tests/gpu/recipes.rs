//! Tests of the materials of recipes, as WGSL functions of the position.

use super::{Place, differing, places, words};
use dapple_raster::{Field, Window};
use dapple_recipe::{Images, Input, Material, Plan, Recipe, RecipeErrorKind, ShaderOptions};
use dapple_wgsl_tests::Gpu;

/// Number of random positions per recipe, near the origin and far from it.
const RANDOM: usize = 1 << 8;

/// Number of pixels along each side of a window.
const SIDE: u32 = 96;

/// Positions at which a material is compared: single positions, or the pixels of a window.
enum At {
    Places(Vec<Place<2>>),
    Window(Window),
}

impl At {
    fn places(&self) -> Vec<Place<2>> {
        match self {
            Self::Places(places) => places.clone(),
            Self::Window(window) => {
                let pixels = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (column, row)));
                let positions = pixels.map(|(column, row)| window.position(column, row));
                positions.map(Place::of).collect()
            }
        }
    }

    /// Returns the values of a scalar input at these positions, computed on the CPU.
    fn numbers(&self, plan: &Plan, input: &Input) -> Vec<f32> {
        let node = match input {
            Input::Node(node) => node,
            Input::Number(number) => return vec![*number as f32; self.places().len()],
            Input::Color(_) => unreachable!("a color is not a number"),
        };
        let field = plan.field(node).expect("a number");
        match self {
            Self::Window(window) => field.to_raster(window).expect("a raster").into_pixels(),
            Self::Places(places) => {
                let positions: Vec<_> = places.iter().map(Place::position).collect();
                let mut values = vec![0.0; positions.len()];
                field.values(&positions, &mut values).expect("one length");
                values
            }
        }
    }

    /// Returns the linear colors of an input at these positions, computed on the CPU. Numbers become grays.
    fn colors(&self, plan: &Plan, input: &Input) -> Vec<[f32; 3]> {
        let node = match input {
            Input::Node(node) => node,
            Input::Color(color) => return vec![color.to_array(); self.places().len()],
            Input::Number(number) => return vec![[*number as f32; 3]; self.places().len()],
        };
        let colors = plan.colors(node).expect("a node");
        match self {
            Self::Window(window) => {
                let raster = colors.to_raster(window).expect("a raster");
                raster
                    .pixels()
                    .iter()
                    .map(|color| color.to_array())
                    .collect()
            }
            Self::Places(places) => {
                let colors = places.iter().map(|at| colors.sample(at.position()));
                colors
                    .map(|color| color.expect("a color").to_array())
                    .collect()
            }
        }
    }
}

/// Members of the WGSL material: the scalars, followed by the components of the colors.
const MEMBERS: [&str; WORDS] = [
    "height",
    "roughness",
    "metallic",
    "opacity",
    "specular",
    "clearcoat",
    "albedo.x",
    "albedo.y",
    "albedo.z",
    "emission.x",
    "emission.y",
    "emission.z",
];

/// Number of words of a material in the output.
const WORDS: usize = 12;

/// Returns the inputs of a material's scalars, in the order of [`MEMBERS`].
fn numbers_of(material: &Material) -> [Input; 6] {
    let or = |input: &Option<Input>, default| input.clone().unwrap_or(Input::Number(default));
    [
        material.height.clone(),
        material.roughness.clone(),
        material.metallic.clone(),
        or(&material.opacity, 1.0),
        or(&material.specular, 1.0),
        or(&material.clearcoat, 0.0),
    ]
}

/// Returns the inputs of a material's colors, in the order of [`MEMBERS`].
fn colors_of(material: &Material) -> [Input; 2] {
    let albedo = material.albedo.as_ref().unwrap_or(&material.height);
    let black = Input::Number(0.0);
    [albedo.clone(), material.emission.clone().unwrap_or(black)]
}

/// Result of a comparison: the number of different scalars, and the number of different color components.
#[derive(Debug, Default, PartialEq, Eq)]
struct Difference {
    numbers: usize,
    colors: usize,
}

/// Returns the WGSL entry point, which evaluates the material at every position. `width` is the number of words per
/// position that are read from textures. `textures` are the arguments of the call for the `data` texture and these
/// words.
fn entry_point(width: usize, textures: &str) -> String {
    format!(
        "
@group(0) @binding(0) var<storage> zero: u32;
@group(0) @binding(1) var<storage> places: array<array<vec4<u32>, 2>>;
@group(0) @binding(2) var<storage> values: array<f32>;
@group(0) @binding(3) var<storage, read_write> out: array<f32>;
@group(0) @binding(4) var data: texture_2d<u32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let words = places[id.x];
    let place = Place2d(bitcast<vec4<i32>>(words[0]).xy, bitcast<vec4<f32>>(words[1]).xy);
    let base = {width}u * id.x + u32(values[0] * 0.0);
    let result = material(place, {textures}zero);
    let numbers = array({});
    for (var i = 0u; i < {WORDS}u; i++) {{ out[{WORDS}u * id.x + i] = numbers[i]; }}
}}",
        MEMBERS.map(|member| format!("result.{member}")).join(", ")
    )
}

/// Compares a material's shader with its plan. The values of nodes without a shader come from the plan.
fn compare(gpu: &Gpu, recipe: &Recipe, plan: &Plan, at: &[At]) -> Difference {
    let options = ShaderOptions { textures: true };
    let shader = recipe.to_wgsl(&Images::new(), &options).expect("a shader");
    let numbers =
        |input: &Input| -> Vec<f32> { at.iter().flat_map(|at| at.numbers(plan, input)).collect() };
    let colors = |input: &Input| -> Vec<[f32; 3]> {
        at.iter().flat_map(|at| at.colors(plan, input)).collect()
    };
    let places: Vec<_> = at.iter().flat_map(At::places).collect();
    let n = places.len();
    // The values of textures, position by position
    let mut columns = Vec::new();
    let mut members = Vec::new();
    for node in &shader.textures {
        let first = columns.len();
        if plan.is_color(node) {
            let colors = colors(&Input::from(node.as_str()));
            columns.extend([0, 1, 2].map(|axis| colors.iter().map(|color| color[axis]).collect()));
            let parts = [0, 1, 2].map(|axis| format!("values[base + {}u]", first + axis));
            members.push(format!("vec3({})", parts.join(", ")));
        } else {
            columns.push(numbers(&Input::from(node.as_str())));
            members.push(format!("values[base + {first}u]"));
        }
    }
    let rows = (0..n).flat_map(|row| columns.iter().map(move |column: &Vec<f32>| column[row]));
    let mut values: Vec<u32> = rows.map(f32::to_bits).collect();
    values.push(0);
    let mut textures = String::new();
    if !shader.data.is_empty() {
        textures += "data, ";
    }
    if !members.is_empty() {
        textures += &format!("Textures({}), ", members.join(", "));
    }
    let text = shader.wgsl + &entry_point(columns.len(), &textures);
    let inputs = [&[0][..], &words(&places), &values];
    let on_gpu = gpu.compute_with_data(&text, &inputs, &shader.data, n, WORDS);
    let mut difference = Difference::default();
    for (index, input) in numbers_of(&recipe.material).iter().enumerate() {
        let on_cpu = numbers(input).into_iter().map(f32::to_bits);
        let on_cpu: Vec<u32> = on_cpu.collect();
        let column: Vec<u32> = on_gpu.chunks_exact(WORDS).map(|row| row[index]).collect();
        difference.numbers += differing(&on_cpu, &column);
    }
    for (index, input) in colors_of(&recipe.material).iter().enumerate() {
        let first = 6 + 3 * index;
        for (row, color) in on_gpu.chunks_exact(WORDS).zip(colors(input)) {
            for (&bits, on_cpu) in row[first..first + 3].iter().zip(color) {
                difference.colors += usize::from(bits != on_cpu.to_bits());
            }
        }
    }
    difference
}

/// Returns positions near the origin and far from it: pixels of windows, and random ones.
fn everywhere() -> Vec<At> {
    let window = |origin: [f64; 2], pixel: f64| {
        let side = pixel * f64::from(SIDE);
        At::Window(Window::new(origin, [side; 2], [SIDE; 2]).expect("a window"))
    };
    let random = [4, 17].map(|bits| {
        let mut places = places::<2>(7, bits);
        places.truncate(RANDOM);
        At::Places(places)
    });
    let windows = [
        window([-3.5, 1000.25], 1.0 / 32.0),
        window([100_000.0, -70_000.0], 3.0 / 1024.0),
    ];
    random.into_iter().chain(windows).collect()
}

/// Returns whether values at single positions exist: of the material, and of the nodes that its shader reads from
/// textures.
fn has_single_positions(plan: &Plan, recipe: &Recipe) -> bool {
    let numbers = numbers_of(&recipe.material).into_iter();
    let inputs = numbers.chain(colors_of(&recipe.material));
    let of_material = inputs.filter_map(|input| match input {
        Input::Node(node) => Some(node),
        _ => None,
    });
    let options = ShaderOptions { textures: true };
    let shader = recipe.to_wgsl(&Images::new(), &options).expect("a shader");
    of_material
        .chain(shader.textures)
        .all(|node| match plan.is_color(&node) {
            true => plan
                .colors(&node)
                .is_ok_and(|at| at.sample([0.0; 2]).is_ok()),
            false => {
                let field = plan.field(&node);
                field.is_ok_and(|field| field.values(&[[0.0; 2]], &mut [0.0]).is_ok())
            }
        })
}

/// Returns the names of the built-in recipes to compare: all of them with `DAPPLE_ALL_RECIPES=1`, otherwise a few,
/// since lavapipe takes many seconds to compile each shader.
fn builtin_names() -> impl Iterator<Item = &'static str> {
    let all = std::env::var_os("DAPPLE_ALL_RECIPES").is_some();
    Recipe::builtin_names().step_by(if all { 1 } else { 12 })
}

#[test]
fn builtin_recipes_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    for name in builtin_names() {
        let recipe = Recipe::builtin(name).expect("a recipe");
        // The values of nodes that depend on the whole tile, which a texture has, are not known at single positions.
        let plan = Plan::new(&recipe, &Images::new(), 0.0).expect("a plan");
        // Recipes that blend by height need the whole tile.
        if plan.height().is_err() {
            continue;
        }
        let mut at = everywhere();
        if !has_single_positions(&plan, &recipe) {
            // Nodes that depend on their neighborhood have values in windows.
            at.retain(|at| matches!(at, At::Window(_)));
        }
        let difference = compare(&gpu, &recipe, &plan, &at);
        assert_eq!(difference, Difference::default(), "{name}");
    }
}

#[test]
fn builtin_recipes_read_textures_of_nodes_that_are_not_local_alone() {
    // Nodes that depend on a neighborhood, and two textures without a shader
    let kinds = [
        "blur",
        "curvature",
        "occlusion",
        "slope",
        "slope_blur",
        "blend_map",
    ];
    let mut reasons = kinds.map(|kind| format!("`{kind}` has no shader")).to_vec();
    reasons.push("it depends on the whole tile".to_owned());
    let mut complete = 0;
    for name in Recipe::builtin_names() {
        let recipe = Recipe::builtin(name).expect("a recipe");
        let refused = match recipe.to_wgsl(&Images::new(), &ShaderOptions::default()) {
            Ok(_) => {
                complete += 1;
                continue;
            }
            Err(refused) => refused,
        };
        let RecipeErrorKind::NotInShader { nodes } = refused.kind() else {
            panic!("{name}: {refused}");
        };
        println!("{name}: {nodes:?}");
        for (node, reason) in nodes {
            let mut known = reasons.iter();
            assert!(
                known.any(|known| reason.contains(known)),
                "{name}: {node}: {reason}"
            );
        }
    }
    println!("{complete} recipes need no textures");
    assert!(complete >= 60, "{complete}");
}

#[test]
fn stamps_and_gabor_noise_have_a_shader_where_the_recipe_repeats() {
    for (node, what) in [("scatter", "stamps"), ("gabor", "Gabor noise")] {
        let text = format!(
            "dapple = 1\nwrap = [true, false]\nnodes.a.{node} = {{}}\nmaterial.height = 'a'"
        );
        let recipe = Recipe::from_toml(&text).expect("a recipe");
        let refused = recipe.to_wgsl(&Images::new(), &ShaderOptions::default());
        let refused = refused.expect_err("it does not repeat along y").to_string();
        let limit = format!("period of {what} is 0, but it must be above 0 along both axes");
        assert!(refused.contains(&limit), "{refused}");
    }
}

/// A recipe of all nodes that have a shader, with options that the built-in recipes do not use.
const NODES: &str = r##"
    dapple = 1
    extent = [5.0, 3.0]
    wrap = [false, false]
    [nodes]
    hills.noise = { basis = "gradient", frequency = 3.7, octaves = 6, gain = 0.6 }
    cells.worley = { frequency = [0.3, 1.7], value = [0.25, -0.5, 0.0, 0.0], range = [-0.3, 0.2] }
    first.worley = { scatter = { jittered = { jitter = 0.0 } } }
    negative.worley = { value = [-1.0, 0.0, 0.0, 0.0], scatter = { jittered = { jitter = 0.0 } } }
    sum.worley = { value = "f2_minus_f1", octaves = { count = 3, lacunarity = 1.5, gain = -0.7, seeds = "same" }, range = [0.1, 0.8] }
    stone.worley = { value = "cell_value", scatter = { poisson = { density = 0.5 } } }
    rings.distance = { center = [0.3, -7.1] }
    blocks.worley = { frequency = 2.0, value = "f2_minus_f1", metric = "manhattan" }
    boxes.worley = { value = "cell_value", metric = "chebyshev" }
    joints.worley = { frequency = [1.0, 2.0], value = "edge_distance" }
    foam.worley = { value = "f1", octaves = { count = 3, gain = 0.4 }, motion = { cells = 1 } }
    growth.worley = { frequency = [1.0, 0.25], value = [0.25, 0.25, -0.25, 0.25], motion = { cells = 3, z = -7.3 } }
    sparks.worley = { value = "cell_value", motion = { cells = 2, z = 0.5 }, metric = "manhattan" }
    sine.wave = { input = "hills", frequency = 3.0, phase = 0.1 }
    far_sine.wave = { input = "across", frequency = -0.25 }
    wavelets.wavelet = { frequency = [2.0, 3.7], weights = [1.0, 0.0, -0.5, 0.25] }
    bands.noise = { basis = "wavelet", frequency = [7.0, 4.0], octaves = 5, gain = 0.8 }
    bumps.noise = { basis = "pups", frequency = 3.0, octaves = 3, gain = 0.7 }
    turbulent.pups.turbulence = { spacing = { count = 20 }, octaves = 2, net = { weight = "quintic" } }
    patches.pups.cells = { spacing = { distance = 0.5 }, points_per_cell = [2, 3], net = { orientations = "random", strength = 0.9 } }
    layers.pups.cellular_noise = { spacing = { distance = 1.0 } }
    slope_of_bumps.warp = { input = "bumps", x = "wavelets", y = 0.3, amount = 0.2 }
    across.coordinate = { center = [0.1, -2.0], along = [0.7, -1.3] }
    right.coordinate = {}
    sawtooth.wave = { input = "across", frequency = 1.3, phase = 0.37, form = "sawtooth" }
    triangle.wave = { input = "hills", frequency = -9.0, form = "triangle" }
    square.wave = { input = "right", frequency = 4.0, form = "square" }
    turned.transform = { input = "cells", frequency = [1.1, 0.6], offset = [0.2, -7.3], rotation = 30.0 }
    twice.transform = { input = "turned", frequency = 3.0, rotation = 90.0 }
    ridges.fractal = { input = "cells", octaves = 3, gain = -0.6, lacunarity = 2.3, shape = "ridged" }
    creases.fractal = { input = "across", shape = "billow" }
    bent.warp = { input = "sum", x = "hills", y = "across", amount = 0.3 }
    bent_color.warp = { input = "color", x = "first", y = "twice" }
    quotient.divide = ["hills", "stone"]
    by_zero.divide = ["across", "square"]
    least.minimum = ["across", 0.0, "negative"]
    most.maximum = ["negative", 0.0, "across"]
    size.absolute = "across"
    power.power = { input = "across", exponent = 1.2 }
    cube.power = { input = "size", exponent = 3.0 }
    root.power = { input = "size", exponent = 0.5 }
    square_power.power = { input = "hills", exponent = 2.0 }
    flat.power = { input = "hills", exponent = 0.35 }
    same.power = { input = "across", exponent = 1.0 }
    far_power.power = { input = "across", exponent = 31.7 }
    steep.levels = { input = "size", from = [0.9, 0.2], to = [0.3, -0.4], curve = "unclamped" }
    soft.levels = { input = "first", from = [0.3, 0.1], to = [0.0, -0.25], curve = "smooth" }
    low.clamp = { input = "negative", low = -0.3, high = 0.0 }
    spot.profile = { input = "across", shape = { spots = { radius = 0.7 } } }
    channel.profile = { input = "negative", shape = { channels = { width = 0.4 } } }
    parts.multiply = ["quotient", "spot", "channel", -1.5]
    between.mix = { from = "steep", to = "soft", by = "ridges" }
    rest.subtract = ["parts", "between"]
    color.ramp = { input = "hills", colors = ["#a04020", "#a04020", "#20c0f0"], positions = [0.2, 0.4, 0.7], space = "linear", interpolation = "smooth" }
    steps.ramp = { input = "stone", colors = ["#ff0000", "#00ff00", "#0000ff"], positions = [0.2, 0.5, 0.5], interpolation = "stepped" }
    tint = { color = "#336699" }
    all_colors.add = ["color", "steps", "bent_color", "square"]
    albedo.mix = { from = "all_colors", to = "tint", by = "triangle" }
    [material]
    albedo = "albedo"
    metallic = 1.0
"##;

/// A recipe of nodes that evaluate their input at other positions, compare, or select.
const FOLDS: &str = r##"
    dapple = 1
    extent = [5.0, 3.0]
    wrap = [true, false]
    [nodes]
    hills.noise = { basis = "gradient", frequency = [2.0, 3.7], octaves = 2 }
    cells.worley = { frequency = [1.0, 1.7], value = "cell_value" }
    red.ramp = { input = "hills", colors = ["#a04020", "#20c0f0"], space = "linear" }
    hard.threshold = { input = "hills", threshold = "cells" }
    soft.threshold = { input = "hills", threshold = 0.45, width = 0.3 }
    terraces.quantize = { input = "hills", steps = 7 }
    halves.quantize = { input = "distance", steps = 9 }
    less.invert = "hills"
    distance.distance = { center = [4.5, 0.25] }
    one.select = { inputs = ["hills", 0.25, "less", "distance"], by = "cells" }
    bump.curve = { input = "hills", points = [[0.2, 0.1], [0.4, 0.15], [0.5, 0.9], [0.8, 0.3]] }
    line.curve = { input = "distance", points = [[0.1, 0.0], [3.0, 1.0]] }
    joined.smooth_minimum = { inputs = ["hills", "cells", "less"], radius = 0.3 }
    cut.smooth_maximum = { inputs = ["hills", "cells"], radius = 0.25 }
    sharp.smooth_maximum = { inputs = ["hills", "cells"], radius = 0.0 }
    green.channel = { input = "red", channel = "green" }
    light.channel = { input = "red" }
    mapped.sample = { input = "cells", x = "hills", y = "distance", scale = [2.0, 0.3] }
    mirrored.mirror = { input = "hills", center = [1.1, 0.0] }
    left.mirror = { input = "hills", axes = [true, false], center = [1.1, 0.0] }
    ring.polar = { input = "hills", repeat = 3 }
    turned.kaleidoscope = { input = "hills", sectors = 5, center = [2.2, 1.3] }
    first.output = { of = "cells", value = "f1" }
    inverted.invert = "red"
    tint.select = { inputs = ["inverted", "red", "hard"], by = "cells" }
    [material]
    albedo = "tint"
"##;

/// Compares all nodes of a recipe with the CPU, three per shader, and its color.
fn compare_nodes(gpu: &Gpu, text: &str, at: &[At]) {
    let mut recipe = Recipe::from_toml(text).expect("a recipe");
    let plan = Plan::new(&recipe, &Images::new(), 0.0).expect("a plan");
    let numbers = plan.node_names().filter(|name| !plan.is_color(name));
    let numbers: Vec<_> = numbers.map(Input::from).collect();
    for nodes in numbers.chunks(3) {
        recipe.material.height = nodes[0].clone();
        recipe.material.roughness = nodes[nodes.len() / 2].clone();
        recipe.material.metallic = nodes[nodes.len() - 1].clone();
        let shader = recipe.to_wgsl(&Images::new(), &ShaderOptions::default());
        assert!(shader.is_ok(), "{nodes:?}: {shader:?}");
        let plan = Plan::new(&recipe, &Images::new(), 0.0).expect("a plan");
        let difference = compare(gpu, &recipe, &plan, at);
        assert_eq!(difference, Difference::default(), "{nodes:?}");
    }
}

#[test]
fn every_node_with_a_shader_has_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    compare_nodes(&gpu, NODES, &everywhere());
}

#[test]
fn nodes_that_fold_compare_and_choose_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    compare_nodes(&gpu, FOLDS, &everywhere());
}

/// Nodes with several outputs, bricks and weaves, each with options for a bond or a draft.
const VALUES: &[(&str, &str)] = &[
    (
        "bricks",
        "bond = 'stack', frequency = [0.8, 3.0], jitter = 0.7, bevel = 0.3",
    ),
    (
        "bricks",
        "bond = 'running', frequency = [1.2, 2.0], offset = 0.3, joint = 0.3",
    ),
    (
        "bricks",
        "bond = 'flemish', frequency = [1.6, 2.0], rounding = 0.2, jitter = 1.0",
    ),
    (
        "bricks",
        "bond = 'herringbone', frequency = [2.4, 2.0], length = 3, joint = 0.4",
    ),
    (
        "bricks",
        "bond = 'basket', frequency = [1.6, 2.0], length = 2, jitter = 0.2",
    ),
    (
        "bricks",
        "bond = 'planks', frequency = [0.8, 3.0], variation = 0.9, jitter = 0.1",
    ),
    (
        "bricks",
        "bond = 'roof_tiles', frequency = [1.0, 2.0], joint = 0.2, jitter = 0.3",
    ),
    (
        "bricks",
        "bond = 'slates', frequency = [1.2, 2.0], joint = 0.2, rounding = 0.3",
    ),
    (
        "bricks",
        "bond = 'hexagons', frequency = [0.8, 2.0], joint = 0.2, rounding = 0.3, jitter = 0.6",
    ),
    (
        "bricks",
        "bond = 'hexagons', frequency = [1.6, 0.7], joint = 0.1, bevel = 0.4",
    ),
    ("weave", "frequency = [1.6, 2.0], jitter = 0.5"),
    (
        "weave",
        "draft = 'satin', frequency = [1.0, 3.0], roundness = 0.6",
    ),
    (
        "weave",
        "draft = 'basket', over = 3, frequency = [1.2, 4.0], width = 0.7",
    ),
];

#[test]
fn bricks_and_weaves_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    // Positions in repeated tiles, near and far
    let at: Vec<_> = everywhere().into_iter().skip(2).collect();
    for (kind, options) in VALUES {
        let values = match *kind {
            "bricks" => ["edge_distance", "u", "random2"],
            _ => ["v", "u", "random"],
        };
        let outputs =
            values.map(|value| format!("{value}.output = {{ of = 'a', value = '{value}' }}"));
        let text = format!(
            "dapple = 1
            extent = [5.0, 3.0]
            wrap = [true, false]
            [nodes]
            a.{kind} = {{ {options} }}
            {}
            [material]
            albedo = 'a'",
            outputs.join("\n")
        );
        let mut recipe = Recipe::from_toml(&text).expect("a recipe");
        recipe.material.height = Input::from(values[0]);
        recipe.material.roughness = Input::from(values[1]);
        recipe.material.metallic = Input::from(values[2]);
        let shader = recipe.to_wgsl(&Images::new(), &ShaderOptions::default());
        assert!(shader.is_ok(), "{options}: {shader:?}");
        let plan = Plan::new(&recipe, &Images::new(), 0.0).expect("a plan");
        let difference = compare(&gpu, &recipe, &plan, &at);
        assert_eq!((difference.numbers, difference.colors), (0, 0), "{options}");
    }
}

/// Options of the node `shape`, for all kinds of shapes.
const SHAPES: &[&str] = &[
    "kind = 'circle', center = [0.3, 1.1], size = 0.4, onion = 0.3, frequency = [1.2, 0.7]",
    "kind = 'box', size = 0.7, rotation = 25.0, rounding = 0.2, frequency = 1.0",
    "kind = 'polygon', size = 0.4, sides = 6, rounding = 0.3, edge = 0.7, frequency = [1.6, 2.3]",
    "kind = 'star', size = 1.2, ratio = 0.4, rotation = 7.0",
    "kind = 'capsule', size = 0.6, ratio = 0.3, rotation = -110.0, frequency = [0.4, 2.0]",
    "kind = 'ring', size = 0.6, ratio = 0.8, onion = 0.1, center = [4.9, 0.1]",
    "kind = 'moon', size = 1.4, ratio = 0.3, edge = 1.5, rounding = 0.1",
    "kind = 'heart', size = 0.8, rounding = 0.2, rotation = 200.0, frequency = [1.0, 1.2]",
];

/// Options of the node `scatter`, which together have all shapes and overlaps.
const STAMPS: &[&str] = &[
    "shape = 'dome', overlap = 'highest'",
    "shape = 'cone', overlap = 'add', density = 2.5, size = [0.5, 2.5]",
    "shape = 'disk', overlap = 'order', bevel = 0.0, spacing = 0.7",
    "shape = 'plate', overlap = 'rows', aspect = [0.2, 0.9], lift = 0.4",
    "shape = 'slate', overlap = 'rows', jitter = 0.0, rotation = [90.0, 90.0], row_offset = 0.5, tilt = -0.7",
    "shape = 'pebble', overlap = 'highest', height = [0.2, 0.9], tilt = 0.3, size = [1.0, 1.6]",
    "shape = 'leaf', overlap = 'order', aspect = [0.3, 0.5], lift = 0.5, size = [0.8, 2.0]",
    "shape = 'blade', overlap = 'highest', aspect = [0.5, 0.6], size = [1.0, 3.0]",
    "shape = 'capsule', overlap = 'add', aspect = [0.05, 0.2], rotation = [-30.0, 10.0]",
    "shape = 'star', overlap = 'highest', bevel = 0.6, spacing = 1.2, density = 4.0",
    "shape = 'flake', overlap = 'order', size = [0.3, 1.8]",
];

/// Options of the node `gabor`.
const GABOR: &[&str] = &[
    "frequency = [0.8, 2.0], angle = 30.0",
    "waves = 5.0, impulses = 3, spread = 180.0, angle = -200.0",
];

/// Compares the outputs `values` of a node with the CPU, three per shader, on a tile that repeats along both axes.
fn compare_values(gpu: &Gpu, kind: &str, options: &str, values: &[&str], at: &[At]) {
    let outputs = values.iter();
    let outputs =
        outputs.map(|value| format!("{value}.output = {{ of = 'a', value = '{value}' }}\n"));
    let text = format!(
        "dapple = 1
        extent = [5.0, 10.0]
        [nodes]
        a.{kind} = {{ {options} }}
        {}
        [material]
        albedo = 'a'",
        outputs.collect::<String>()
    );
    let mut recipe = Recipe::from_toml(&text).expect("a recipe");
    for values in values.chunks(3) {
        recipe.material.height = Input::from(values[0]);
        recipe.material.roughness = Input::from(values[values.len() / 2]);
        recipe.material.metallic = Input::from(values[values.len() - 1]);
        let shader = recipe.to_wgsl(&Images::new(), &ShaderOptions::default());
        assert!(shader.is_ok(), "{options}: {shader:?}");
        let plan = Plan::new(&recipe, &Images::new(), 0.0).expect("a plan");
        let difference = compare(gpu, &recipe, &plan, at);
        assert_eq!(difference, Difference::default(), "{options}: {values:?}");
    }
}

#[test]
fn shapes_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    for options in SHAPES {
        compare_values(&gpu, "shape", options, &["distance", "mask"], &everywhere());
    }
}

#[test]
fn stamps_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    let all = [
        "height",
        "mask",
        "random",
        "random2",
        "random3",
        "u",
        "v",
        "edge_distance",
        "angle",
    ];
    for (index, options) in STAMPS.iter().enumerate() {
        let options = format!("frequency = [1.2, 1.0], {options}");
        // All values of some stamps, and those that depend on the shape of all
        let values = match index {
            1 | 2 => &all[..],
            _ => &["height", "edge_distance", "u"],
        };
        compare_values(&gpu, "scatter", &options, values, &everywhere());
    }
}

#[test]
fn gabor_noise_has_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    for options in GABOR {
        let options = match options.contains("frequency") {
            true => (*options).to_owned(),
            false => format!("frequency = 2.0, {options}"),
        };
        compare_values(&gpu, "gabor", &options, &["noise", "phase"], &everywhere());
    }
}

/// A recipe of nodes that compute with sRGB colors, and of blends of layers.
const COLORS: &str = r##"
    dapple = 1
    extent = [5.0, 3.0]
    [nodes]
    hills.noise = { basis = "gradient", frequency = [2.0, 3.0], octaves = 2 }
    cells.worley = { frequency = [1.0, 2.0], value = "cell_value" }
    stones.worley = { frequency = [1.0, 2.0], value = "f1" }
    paint.ramp = { input = "hills", colors = ["#a04020", "#20c0f0", "#f0f0f0"] }
    tinted.hsl = { input = "paint", hue = "cells", saturation = 1.7, lightness = "hills" }
    same.hsl = { input = "paint" }
    hue.channel = { input = "tinted", channel = "hue" }
    saturation.channel = { input = "tinted", channel = "saturation" }
    value.channel = { input = "paint", channel = "value" }
    given.blend = { layers = [{ input = "hills" }, { input = "stones", weight = "cells" }] }
    high.blend = { layers = [{ input = 0.2, height = "hills" }, { input = "hills", weight = "cells", height = 0.4 }, { input = "stones", weight = 0.3, height = "stones" }], weighting = { height = { depth = 0.3 } } }
    masked.blend = { layers = [{ input = "hills" }, { input = "stones", weight = "cells" }, { input = 0.25, weight = 2.0 }], weighting = { mask = { gain = 3.0 } }, mask = "hills" }
    hard.blend = { layers = [{ input = "same" }, { input = "hills" }, { input = "#336699", weight = 0.4 }], weighting = { mask = { gain = 1e9 } }, mask = "cells" }
    all.blend = { layers = [{ input = "tinted" }, { input = "hard", weight = "masked" }] }
    [material]
    albedo = "all"
    emission = "hard"
    emission_strength = 3.0
    opacity = "hills"
    specular = "masked"
    clearcoat = "hue"
"##;

#[test]
fn srgb_colors_and_blends_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    compare_nodes(&gpu, COLORS, &everywhere());
}
