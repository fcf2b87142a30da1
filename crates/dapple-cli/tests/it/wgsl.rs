//! Tests that printed shaders are valid WGSL and contain their parameters.

use crate::support::{Folder, assert_done, assert_refused, stdout};
use dapple::hash::Seed;
use dapple::noise::GradientNoise3;
use dapple::recipe::{Images, Recipe, ShaderOptions};

/// Prints the shader of noise modules, validates it, and returns it.
fn valid(folder: &Folder, arguments: &[&str]) -> String {
    valid_output(folder, &[&["wgsl"], arguments].concat())
}

/// Runs a command that prints a shader, validates the shader, and returns it.
fn valid_output(folder: &Folder, arguments: &[&str]) -> String {
    let output = folder.run(arguments);
    assert_done(&output, "a shader");
    let text = stdout(&output);
    validate(&arguments.join(" "), &text);
    text
}

/// Parses and validates a shader.
fn validate(what: &str, text: &str) {
    let module = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{what}: {}", error.emit_to_string(text)));
    let flags = naga::valid::ValidationFlags::all();
    let capabilities = naga::valid::Capabilities::empty();
    let result = naga::valid::Validator::new(flags, capabilities).validate(&module);
    assert!(result.is_ok(), "{what}: {result:?}");
}

#[test]
fn shaders_have_their_parameters_as_valid_constants() {
    let folder = Folder::new("wgsl");
    let all = [
        "gradient-noise-2d",
        "gradient_noise_3d",
        "gradient-noise-4d",
        "fractal",
        "worley-2d",
        "worley-3d",
    ];
    let plain = valid(&folder, &all);
    assert!(!plain.contains("const "), "no seed, no constants");
    let text = valid(
        &folder,
        &[&all[..], &["--seed", "7", "--period", "8"]].concat(),
    );
    assert_eq!(
        text.matches("\nconst ").count(),
        5,
        "fractal has no parameters"
    );
    let noise = GradientNoise3::new(Seed(7)).with_period([Some(8); 3]);
    let [x, y, z, ..] = noise.unwrap().shader_words(1.0).unwrap();
    let keys = format!("NOISE_3D = GradientNoise(vec4({x}u, {y}u, {z}u, 0u), vec4(8u, 8u, 8u, 0u)");
    assert!(text.contains(&keys), "{text}");
    let jittered = valid(&folder, &["worley-2d", "--seed", "7", "--jitter", "0.5"]);
    assert!(jittered.contains(", 1u, 512u, 0u);\n"), "{jittered}");
}

#[test]
fn shaders_for_naga_oil_are_single_modules() {
    let folder = Folder::new("naga-oil");
    let output = folder.run(&["wgsl", "worley-3d", "--naga-oil"]);
    assert_done(&output, "a module");
    let text = stdout(&output);
    assert!(
        text.starts_with("#define_import_path dapple::worley_3d\n"),
        "{text}"
    );
    assert!(
        text.contains("#import dapple::place_3d::{Place3d}\n"),
        "{text}"
    );
    let output = folder.run(&["wgsl", "worley-3d", "fractal", "--naga-oil"]);
    assert_refused(
        &output,
        2,
        "--naga-oil prints one module at a time",
        "two modules",
    );
    let output = folder.run(&["wgsl", "worley-2d", "--seed", "1", "--jitter", "2"]);
    assert_refused(
        &output,
        1,
        "jitter is 2, but it must be from 0 to 1",
        "jitter",
    );
}

#[test]
fn wesl_packages_have_all_modules_that_are_used() {
    let folder = Folder::new("wesl");
    let arguments = ["wgsl", "worley-3d", "--wesl", "dapple"];
    assert_done(&folder.run(&arguments), "a package");
    let read = |path: &str| std::fs::read_to_string(folder.path("dapple").join(path)).unwrap();
    assert!(read("wesl.toml").contains("root = \"./shaders\""));
    let worley = read("shaders/worley_3d.wesl");
    assert!(
        worley.starts_with("import package::exact::{exact"),
        "{worley}"
    );
    assert!(read("shaders/root.wesl").contains("fn exact_root"));
    let output = folder.run(&arguments);
    assert_refused(&output, 1, "--force", "an existing file");
}

#[test]
fn materials_of_builtin_recipes_are_valid_shaders() {
    let folder = Folder::new("recipe-wgsl");
    for name in Recipe::builtin_names() {
        let text = valid_output(&folder, &["recipe", name, "--wgsl", "--textures"]);
        assert!(text.contains("fn material(place: Place2d, "), "{name}");
        let parsed = naga::front::wgsl::parse_str(&text).expect("a valid shader");
        assert!(parsed.global_variables.is_empty(), "{name} has bindings");
    }
}

/// Returns the first code block of a language in a Markdown page.
fn block(page: &str, language: &str) -> String {
    let start = page.split_once(&format!("```{language}\n"));
    let (block, _) = start
        .and_then(|(_, rest)| rest.split_once("```"))
        .expect("a block");
    block.to_owned()
}

#[test]
fn the_recipe_of_the_readme_is_the_material_of_its_shader() {
    let readme = include_str!("../../../dapple-recipe/README.md");
    let block = |language: &str| block(readme, language);
    let folder = Folder::new("recipe-wgsl-readme");
    std::fs::write(folder.path("cobbles.toml"), block("toml")).expect("a file");
    let text = valid_output(&folder, &["recipe", "cobbles.toml", "--wgsl"]);
    validate("the shader of the README", &(text + &block("wgsl")));
}

#[test]
fn nodes_without_a_shader_are_refused_by_name_unless_they_are_textures() {
    let folder = Folder::new("recipe-wgsl-refused");
    let refused = folder.run(&["recipe", "rock-cliff", "--wgsl"]);
    for part in [
        "`ledges`: ",
        "with --textures, the shader takes their values as arguments",
    ] {
        assert_refused(&refused, 2, part, "a node without a shader");
    }
    let text = valid_output(&folder, &["recipe", "rock-cliff", "--wgsl", "--textures"]);
    assert!(text.contains("fn material(place: Place2d, textures: Textures, zero: u32)"));
    assert!(text.contains("    ledges_value: f32,\n"), "{text}");
}

#[test]
fn tiles_and_control_points_of_a_material_are_written_beside_its_shader() {
    let folder = Folder::new("recipe-wgsl-data");
    let output = folder.run(&["recipe", "flagstone", "--wgsl", "-o", "floor.wgsl"]);
    assert_done(&output, "a shader and its data");
    let text = std::fs::read_to_string(folder.path("floor.wgsl")).expect("a shader");
    assert!(text.contains("fn material(place: Place2d, data: texture_2d<u32>, zero: u32)"));
    let words = std::fs::read(folder.path("floor.bin")).expect("the words");
    let recipe = Recipe::builtin("flagstone").expect("a recipe");
    let shader = recipe.to_wgsl(&Images::new(), &ShaderOptions::default());
    let shader = shader.expect("a shader");
    let expected: Vec<u8> = shader
        .data
        .iter()
        .flat_map(|word| word.to_le_bytes())
        .collect();
    assert!(words == expected, "the words of the library");
    // Whole rows of 1024 texels of 16 bytes
    assert!(words.len().is_multiple_of(1024 * 16));
}

#[cfg(feature = "shader-languages")]
#[test]
fn shaders_in_glsl_have_all_functions_and_are_valid() {
    let folder = Folder::new("glsl");
    let modules = [
        "gradient-noise-2d",
        "gradient-noise-3d-with-gradient",
        "gradient-noise-4d",
        "fractal",
        "worley-2d",
        "worley-3d",
        "worley-4d",
        "worley-edges-2d",
        "double-sine",
        "position-2d",
        "power",
        "oklab",
        "spline",
        "rectangles",
        "roof-tiles",
        "weave",
    ];
    let noise = [
        &["wgsl"][..],
        &modules,
        &["--seed", "7", "--language", "glsl"],
    ]
    .concat();
    let material = [
        "recipe",
        "rock-cliff",
        "--wgsl",
        "--textures",
        "--language",
        "glsl",
    ];
    for arguments in [&noise[..], &material] {
        let output = folder.run(arguments);
        assert_done(&output, "a shader");
        let text = stdout(&output);
        // The text has functions alone, which `main` of another shader calls.
        for part in ["#version", "precision ", "layout(", "void main", "entry"] {
            assert!(!text.contains(part), "{part} in {text}");
        }
        let functions = ["Feature2d[2] worley_2d(Worley ", "vec4 exact_mul(vec4 "];
        for function in functions {
            assert!(text.contains(function), "{function} is missing: {text}");
        }
        let text = format!("#version 450\n{text}\nvoid main() {{}}");
        let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
        let parsed = naga::front::glsl::Frontend::default().parse(&options, &text);
        let module = parsed.unwrap_or_else(|errors| panic!("{}", errors.emit_to_string(&text)));
        let flags = naga::valid::ValidationFlags::all();
        let capabilities = naga::valid::Capabilities::empty();
        let result = naga::valid::Validator::new(flags, capabilities).validate(&module);
        assert!(result.is_ok(), "{result:?}");
    }
}

#[cfg(feature = "shader-languages")]
#[test]
fn shaders_in_glsl_look_up_tiles_in_a_sampler() {
    let folder = Folder::new("glsl-data");
    let noise = ["wgsl", "wavelet-noise-2d", "pups-2d", "--language", "glsl"];
    let material = ["recipe", "flagstone", "--wgsl", "--language", "glsl"];
    // naga writes parameters that are samplers, but does not read them.
    for (arguments, functions) in [
        (
            &noise[..],
            &["float wavelet_noise_2d(", "float pups_value("][..],
        ),
        (&material, &["Material material("]),
    ] {
        let output = folder.run(arguments);
        assert_done(&output, "a shader");
        let text = stdout(&output);
        for function in functions {
            let (_, rest) = text.split_once(function).expect(function);
            assert!(rest.contains("highp usampler2D data"), "{function}");
        }
        assert!(text.contains("texelFetch(data, "), "{text}");
    }
}

#[cfg(feature = "shader-languages")]
#[test]
fn shaders_in_hlsl_have_all_functions() {
    let folder = Folder::new("hlsl");
    let output = folder.run(&["wgsl", "worley-2d", "--seed", "7", "--language", "hlsl"]);
    assert_done(&output, "a shader");
    let text = stdout(&output);
    for part in [
        "static const Worley WORLEY_2D = ",
        "float4 exact_mul(float4 ",
        " worley_2d(Worley ",
    ] {
        assert!(text.contains(part), "{part} is missing: {text}");
    }
    let material = [
        "recipe",
        "flagstone",
        "--wgsl",
        "--textures",
        "--language",
        "hlsl",
        "-o",
        "m/",
    ];
    assert_done(&folder.run(&material), "a shader");
    let written = std::fs::read_to_string(folder.path("m/flagstone.hlsl")).expect("a file");
    assert!(written.contains("Material material(Place2d "), "{written}");
}

/// Converts a Godot surface shader to an entire GLSL shader, so that it can be validated.
#[cfg(feature = "shader-languages")]
fn as_glsl(godot: &str) -> String {
    let text = godot.replace("shader_type spatial;", "");
    let text = text.replace(
        "uniform uint always_zero = 0u;",
        "const uint always_zero = 0u;",
    );
    let outputs = "vec2 UV = vec2(0.5); vec3 ALBEDO; float ROUGHNESS; float METALLIC;";
    format!(
        "#version 450\n{}\nvoid main() {{ fragment(); }}\n",
        text.replace(
            "void fragment() {",
            &format!("void fragment() {{ {outputs}")
        )
    )
}

#[cfg(feature = "shader-languages")]
#[test]
fn the_shader_of_the_page_about_godot_is_complete() {
    let page = include_str!("../../../../docs/godot.md");
    let folder = Folder::new("godot");
    std::fs::write(folder.path("hills.toml"), block(page, "toml")).expect("a file");
    let command = block(page, "sh");
    let words: Vec<_> = command.split_whitespace().skip(1).collect();
    assert_done(&folder.run(&words), "a shader");
    let text = std::fs::read_to_string(folder.path("hills.gdshader")).expect("a file");
    assert!(text.starts_with("shader_type spatial;\n"), "{text}");
    assert!(text.ends_with(&block(page, "gdshader")), "{text}");
    // Cells have constants with arrays, signed shifts, and selected vectors of integers.
    let cells = folder.run(&["wgsl", "worley-2d", "--seed", "7", "--language", "godot"]);
    let cells = stdout(&cells) + "void fragment() {}";
    assert!(
        cells.contains("\n#define WORLEY_2D Worley(uvec4[2]("),
        "{cells}"
    );
    assert!(cells.contains("(rounded >> ivec2(21))"), "{cells}");
    for text in [text, cells] {
        for missing in [" mix(", "(mix(", "\nconst "] {
            assert!(!text.contains(missing), "{missing} in {text}");
        }
        let text = as_glsl(&text);
        let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
        let parsed = naga::front::glsl::Frontend::default().parse(&options, &text);
        parsed.unwrap_or_else(|errors| panic!("{}", errors.emit_to_string(&text)));
    }
    let refused = folder.run(&["recipe", "marble", "--wgsl", "--language", "godot"]);
    assert_refused(
        &refused,
        2,
        "bake the recipe",
        "a recipe that reads textures",
    );
}
