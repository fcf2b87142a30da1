//! Tests of the modules for `naga_oil`, composed by `naga_oil`.

use dapple_wgsl::Module;
use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor};

/// A shader that imports functions of several modules.
const SHADER: &str = "
#import dapple::gradient_noise_parts::GradientNoise
#import dapple::gradient_noise_3d_with_gradient::gradient_noise_3d_with_gradient
#import dapple::place_2d::place_2d
#import dapple::place_3d::place_3d
#import dapple::worley_2d::worley_2d
#import dapple::worley_parts::Worley

@group(0) @binding(0) var<uniform> noise: GradientNoise;
@group(0) @binding(1) var<uniform> worley: Worley;
@group(0) @binding(2) var<uniform> zero: u32;

@fragment
fn main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let slopes = gradient_noise_3d_with_gradient(noise, place_3d(at.xyz), zero);
    return slopes * worley_2d(worley, place_2d(at.xy), zero)[0].distance;
}";

#[test]
fn modules_are_composed_by_naga_oil() {
    // The composer validates each module.
    let mut composer = Composer::default();
    for module in Module::ALL {
        let added = composer.add_composable_module(ComposableModuleDescriptor {
            source: &module.naga_oil(),
            file_path: module.name(),
            ..Default::default()
        });
        let refused = added.err();
        let refused = refused.map(|error| error.emit_to_string(&composer));
        assert_eq!(refused, None, "{}", module.name());
    }
    let made = composer.make_naga_module(NagaModuleDescriptor {
        source: SHADER,
        file_path: "shader",
        ..Default::default()
    });
    let shader = made.unwrap_or_else(|error| panic!("{}", error.emit_to_string(&composer)));
    let names = shader.functions.iter();
    let mut names = names.filter_map(|(_, function)| function.name.as_deref());
    assert!(names.any(|name| name.contains("worley_2d")), "it is called");
}
