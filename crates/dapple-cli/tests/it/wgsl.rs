//! Shaders are valid WGSL, with their parameters.

use crate::support::{Folder, assert_done, assert_refused, stdout};
use dapple::hash::Seed;
use dapple::noise::GradientNoise3;
use dapple::recipe::Recipe;

/// Prints modules of noise and validates them.
fn valid(folder: &Folder, arguments: &[&str]) -> String {
    valid_output(folder, &[&["wgsl"], arguments].concat())
}

/// Runs a command that prints a shader, and validates it.
fn valid_output(folder: &Folder, arguments: &[&str]) -> String {
    let output = folder.run(arguments);
    assert_done(&output, "a shader");
    let text = stdout(&output);
    let module = naga::front::wgsl::parse_str(&text)
        .unwrap_or_else(|error| panic!("{arguments:?}: {}", error.emit_to_string(&text)));
    let flags = naga::valid::ValidationFlags::all();
    let capabilities = naga::valid::Capabilities::empty();
    let result = naga::valid::Validator::new(flags, capabilities).validate(&module);
    assert!(result.is_ok(), "{arguments:?}: {result:?}");
    text
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
    assert!(jittered.contains(", 1u, 512u);\n"), "{jittered}");
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
fn materials_of_builtin_recipes_are_valid_shaders() {
    let folder = Folder::new("recipe-wgsl");
    for name in Recipe::builtin_names() {
        let text = valid_output(&folder, &["recipe", name, "--wgsl", "--textures"]);
        assert!(text.contains("fn material(place: Place2d, "), "{name}");
        let parsed = naga::front::wgsl::parse_str(&text).expect("a valid shader");
        assert!(parsed.global_variables.is_empty(), "{name} has bindings");
    }
}

#[test]
fn nodes_without_a_shader_are_refused_by_name_unless_they_are_textures() {
    let folder = Folder::new("recipe-wgsl-refused");
    let refused = folder.run(&["recipe", "flagstone", "--wgsl"]);
    assert_refused(
        &refused,
        2,
        "`swell`: noise of the basis `pups` has no shader",
        "the node",
    );
    assert_refused(
        &refused,
        2,
        "with --textures, the shader takes their values as arguments",
        "the way out",
    );
    let text = valid_output(&folder, &["recipe", "flagstone", "--wgsl", "--textures"]);
    assert!(text.contains("fn material(place: Place2d, textures: Textures, zero: u32)"));
    assert!(text.contains("    swell_value: f32,\n"), "{text}");
}
