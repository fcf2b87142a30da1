//! Reads the machine code that Mesa's driver for AMD GPUs generates from the shaders. If `RADV_FORCE_FAMILY` names a
//! GPU, the driver compiles for it even if it is not installed.
//!
//! A product and a sum that are fused to one instruction are rounded once, but the CPU rounds twice.

use ash::vk;
use dapple_wgsl::Module;
use std::ffi::CStr;
use std::path::Path;
use std::process::Command;
use wgpu::naga;

/// Path of Mesa's description of the driver, for the Vulkan loader.
const DRIVER: &str = "/usr/share/vulkan/icd.d/radeon_icd.x86_64.json";

/// Environment variable that is set in the child process, which compiles a shader: the index of the shader.
const CHILD: &str = "DAPPLE_RADV";

/// Name of the shader without a barrier. The driver fuses its product and sum, so the test can fail.
const BROKEN: &str = "without a barrier";

/// Name of the only test. It starts itself as a child process.
const TEST: &str = "no_product_and_sum_are_one_instruction";

#[test]
fn no_product_and_sum_are_one_instruction() {
    let shaders = shaders();
    if let Ok(number) = std::env::var(CHILD) {
        let number: usize = number.parse().expect("a number");
        return compile(&spir_v(&shaders[number].1));
    }
    if !Path::new(DRIVER).exists() {
        let may_skip = std::env::var_os("DAPPLE_NO_SKIP").is_none_or(|value| value != "1");
        assert!(may_skip, "there is no {DRIVER}");
        println!("skipped: there is no {DRIVER}");
        return;
    }
    for (number, (name, _)) in shaders.iter().enumerate() {
        let code = machine_code(number);
        let has = |names: &[&str]| names.iter().any(|name| code.contains(name));
        let is_fused = has(&["v_fma", "v_mad_f32", "v_mac_f32", "v_pk_fma"]);
        let is_separate = has(&["v_mul_f32"]) && has(&["v_add_f32"]);
        let is_broken = *name == BROKEN;
        assert_eq!(
            [is_fused, is_separate],
            [is_broken, !is_broken],
            "{name}:\n{code}"
        );
    }
}

/// Returns the shaders with their names. The last one has no barrier.
fn shaders() -> Vec<(&'static str, String)> {
    let product = "
@group(0) @binding(0) var<storage> zero: u32;
@group(0) @binding(1) var<storage> numbers: array<vec4<f32>>;
@group(0) @binding(2) var<storage> places: array<array<vec4<u32>, 2>>;
@group(0) @binding(3) var<storage, read_write> out: array<f32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let numbers = numbers[id.x];
    let product = exact_mul(numbers, numbers.yzwx, zero);
    out[id.x] = exact_add(product, numbers.zwxy, zero).x;
}";
    let exact = Module::Exact.source() + product;
    let barrier = "return bitcast<vec4<f32>>(bitcast<vec4<u32>>(x) ^ vec4(zero));";
    assert_eq!(exact.matches(barrier).count(), 1, "one barrier");
    let broken = exact.replace(barrier, "return x;");
    vec![
        ("exact", exact),
        ("gradient noise, 2-D", noise(Module::GradientNoise2d, 2)),
        ("gradient noise, 3-D", noise(Module::GradientNoise3d, 3)),
        ("gradient noise, 4-D", noise(Module::GradientNoise4d, 4)),
        ("Worley, 2-D", worley(Module::Worley2d, 2)),
        ("Worley, 3-D", worley(Module::Worley3d, 3)),
        (BROKEN, broken),
    ]
}

fn noise(module: Module, axes: usize) -> String {
    let value = format!("gradient_noise_{axes}d(parameters[0], place, zero)");
    shader(module, axes, "GradientNoise", &value)
}

fn worley(module: Module, axes: usize) -> String {
    let value = format!("worley_{axes}d(parameters[0], place, zero)[1].distance");
    shader(module, axes, "Worley", &value)
}

/// Returns a shader that writes a value at every position.
fn shader(module: Module, axes: usize, parameters: &str, value: &str) -> String {
    let swizzle = &"xyzw"[..axes];
    module.source()
        + &format!(
            "
@group(0) @binding(0) var<storage> zero: u32;
@group(0) @binding(1) var<storage> parameters: array<{parameters}>;
@group(0) @binding(2) var<storage> places: array<array<vec4<u32>, 2>>;
@group(0) @binding(3) var<storage, read_write> out: array<f32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let words = places[id.x];
    let cell = bitcast<vec4<i32>>(words[0]);
    let fraction = bitcast<vec4<f32>>(words[1]);
    let place = Place{axes}d(cell.{swizzle}, fraction.{swizzle});
    let value = {value};
    out[id.x] = value;
}}"
        )
}

/// Compiles a shader in a child process, and returns the machine code that the driver prints.
fn machine_code(number: usize) -> String {
    let output = Command::new(std::env::current_exe().expect("this program"))
        .args([TEST, "--exact", "--nocapture"])
        .env(CHILD, number.to_string())
        .env("VK_ICD_FILENAMES", DRIVER)
        .env("RADV_FORCE_FAMILY", "navi21")
        .env("RADV_DEBUG", "shaders,nocache")
        .output()
        .expect("the test starts itself");
    let printed = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{printed}");
    // The driver prints the code in several forms; the last has the instructions of the GPU.
    let code = printed.rsplit_once("disasm:").map_or("", |(_, code)| code);
    assert!(!code.is_empty(), "no machine code:\n{printed}");
    code.to_owned()
}

fn spir_v(shader: &str) -> Vec<u32> {
    let module = naga::front::wgsl::parse_str(shader).expect("valid WGSL");
    let flags = naga::valid::ValidationFlags::all();
    let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty());
    let info = validator.validate(&module).expect("a valid module");
    let options = naga::back::spv::Options::default();
    naga::back::spv::write_vec(&module, &info, &options, None).expect("SPIR-V")
}

/// Creates a compute pipeline with the entry point `main`, so that the driver prints its machine code.
#[expect(unsafe_code, reason = "wgpu refuses the driver without a GPU")]
fn compile(spir_v: &[u32]) {
    const MAIN: &CStr = c"main";
    let bindings: Vec<_> = (0..4)
        .map(|binding| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(binding)
                .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                .descriptor_count(1)
                .stage_flags(vk::ShaderStageFlags::COMPUTE)
        })
        .collect();
    // SAFETY: structures live until the calls return, handles come from the calls before, and the process ends after.
    unsafe {
        let entry = ash::Entry::load().expect("Vulkan's loader");
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_2);
        let instance = vk::InstanceCreateInfo::default().application_info(&application);
        let instance = entry.create_instance(&instance, None).expect("an instance");
        let devices = instance.enumerate_physical_devices().expect("devices");
        let queues = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
        let device = vk::DeviceCreateInfo::default().queue_create_infos(&queues);
        let device = instance
            .create_device(devices[0], &device, None)
            .expect("a device");
        let set = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let sets = [device
            .create_descriptor_set_layout(&set, None)
            .expect("a set")];
        let layout = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        let layout = device
            .create_pipeline_layout(&layout, None)
            .expect("a layout");
        let module = vk::ShaderModuleCreateInfo::default().code(spir_v);
        let module = device
            .create_shader_module(&module, None)
            .expect("a module");
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(MAIN);
        let pipeline = vk::ComputePipelineCreateInfo::default()
            .stage(stage)
            .layout(layout);
        let made = device.create_compute_pipelines(vk::PipelineCache::null(), &[pipeline], None);
        assert!(made.is_ok(), "{made:?}");
    }
}
