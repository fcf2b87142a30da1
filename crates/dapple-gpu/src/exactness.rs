//! Compares the arithmetic of a device with the CPU.
//!
//! WGSL lets a compiler fuse products and sums, and reorder sums. Quotients and square roots may be wrong by several
//! units in the last place, and denormal numbers may be 0. The functions of `dapple-wgsl` avoid all but the last; whether
//! they succeed depends on the compiler of the driver. So the test runs them on random numbers.

use crate::GpuError;
use crate::device::{Device, Program};
use dapple_recipe::hash::Seed;
use dapple_recipe::hash::rand_core::Rng;
use dapple_wgsl::{Module, source};

/// How the results of a device compare with the CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Exactness {
    /// All bits are the same.
    Same,
    /// The device replaces denormal numbers, which are below 2^-126 in size, by 0. All other bits are the same.
    WithoutDenormals,
    /// The bits of an operation differ.
    Differs {
        /// The operation.
        operation: &'static str,
    },
}

impl Exactness {
    /// Returns whether all bits are the same, except for those of denormal numbers.
    #[must_use]
    pub fn is_exact(self) -> bool {
        !matches!(self, Self::Differs { .. })
    }
}

/// An operation, as an expression of the numbers `a`, `b` and `c` in WGSL and on the CPU.
struct Operation {
    name: &'static str,
    wgsl: &'static str,
    on_cpu: fn(f32, f32, f32) -> f32,
}

const OPERATIONS: [Operation; 9] = [
    Operation {
        name: "sums",
        wgsl: "number_add(a, b, zero)",
        on_cpu: |a, b, _| a + b,
    },
    Operation {
        name: "products",
        wgsl: "number_mul(a, b, zero)",
        on_cpu: |a, b, _| a * b,
    },
    Operation {
        name: "a product and a sum",
        wgsl: "number_add(number_mul(a, b, zero), c, zero)",
        on_cpu: |a, b, c| a * b + c,
    },
    Operation {
        name: "a product and a sum of four numbers",
        wgsl: "exact_sub(exact_mul(vec4(a), vec4(b), zero), vec4(c), zero).y",
        on_cpu: |a, b, c| a * b - c,
    },
    Operation {
        name: "the difference of a sum and its first term",
        wgsl: "number_sub(number_add(a, b, zero), a, zero)",
        on_cpu: |a, b, _| a + b - a,
    },
    Operation {
        name: "sums of three numbers",
        wgsl: "number_add(number_add(a, b, zero), c, zero)",
        on_cpu: |a, b, c| a + b + c,
    },
    Operation {
        name: "quotients",
        wgsl: "number_div(a, b, zero)",
        on_cpu: |a, b, _| a / b,
    },
    Operation {
        name: "square roots",
        wgsl: "exact_root(abs(a))",
        on_cpu: |a, _, _| a.abs().sqrt(),
    },
    Operation {
        name: "the smaller one of two numbers",
        wgsl: "number_min(number_mul(c, none, zero), number_mul(a, none, zero), zero)",
        on_cpu: |a, _, c| {
            let [first, second] = [c * 0.0, a * 0.0];
            if second < first { second } else { first }
        },
    },
];

/// Number of triples of numbers.
const N: usize = 256;

/// A sum and a product whose results are denormal.
const DENORMALS: &str = "vec2(number_add(number(1.5 * 0x1p-126, zero), -0x1p-126, zero), number_mul(0x1p-100, number(0x1p-30, zero), zero))";

/// Runs the test. `change` changes the text of the shader; tests of the test do so.
pub(crate) fn test(
    device: &Device,
    change: impl Fn(String) -> String,
) -> Result<Exactness, GpuError> {
    let numbers = numbers();
    let words = OPERATIONS.len() + 2;
    let program = Program::new(device, &change(shader()), [&[]; 2])?;
    let columns: Vec<u32> = numbers.iter().flatten().map(|x| x.to_bits()).collect();
    let out = program.run(
        device,
        [&[0, N as u32], &columns, &[0]],
        [N as u32, 1],
        N * words,
    )?;
    for (at, operation) in OPERATIONS.iter().enumerate() {
        let mut results = numbers.iter().zip(out.chunks_exact(words));
        let is_same = |([a, b, c], words): (&[f32; 3], &[u32])| {
            (operation.on_cpu)(*a, *b, *c).to_bits() == words[at]
        };
        if !results.all(is_same) {
            let operation = operation.name;
            return Ok(Exactness::Differs { operation });
        }
    }
    let kept = [1 << 22, 1 << 19];
    let mut all = out.chunks_exact(words);
    Ok(match all.all(|words| words[OPERATIONS.len()..] == kept) {
        true => Exactness::Same,
        false => Exactness::WithoutDenormals,
    })
}

/// Returns normal numbers of similar size, in triples, with random signs.
fn numbers() -> [[f32; 3]; N] {
    let mut stream = Seed(0).stream();
    [(); N].map(|()| {
        [(); 3].map(|()| {
            let draw = stream.next_u32();
            let exponent = 127 - 3 + draw % 7;
            f32::from_bits(draw & 0x8000_0000 | exponent << 23 | draw >> 8 & 0x7F_FFFF)
        })
    })
}

fn shader() -> String {
    let mut text = source(&[Module::Number, Module::Exact, Module::Root]);
    text += "
@group(0) @binding(0) var<storage> job: array<u32>;
@group(0) @binding(1) var<storage> numbers: array<f32>;
@group(0) @binding(2) var<storage> unused: array<f32>;
@group(0) @binding(3) var<storage, read_write> out: array<f32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let zero = job[0];
    let none = number(0.0, zero);
    let a = numbers[3u * id.x];
    let b = numbers[3u * id.x + 1u];
    let c = numbers[3u * id.x + 2u];
";
    let words = OPERATIONS.len() + 2;
    for (at, operation) in OPERATIONS.iter().enumerate() {
        let wgsl = operation.wgsl;
        text += &format!("    out[{words}u * id.x + {at}u] = {wgsl};\n");
    }
    let at = OPERATIONS.len();
    text += &format!(
        "    let denormals = {DENORMALS};
    out[{words}u * id.x + {at}u] = denormals.x;
    out[{words}u * id.x + {at}u + 1u] = denormals.y;
}}"
    );
    text
}

#[cfg(test)]
pub(crate) mod tests {
    use super::{Exactness, OPERATIONS, numbers, test};
    use crate::device::Device;

    /// Opens a device. Without an adapter the tests pass, unless `DAPPLE_NO_SKIP=1` is set.
    pub(crate) fn device() -> Option<Device> {
        match Device::headless() {
            Ok(device) => Some(device),
            Err(error) => {
                let may_skip = std::env::var_os("DAPPLE_NO_SKIP").is_none_or(|value| value != "1");
                assert!(
                    may_skip,
                    "{error}; DAPPLE_NO_SKIP=1 lets nothing be skipped"
                );
                None
            }
        }
    }

    #[test]
    fn fused_and_reordered_operations_have_other_bits() {
        let differ = |wrong: fn(f32, f32, f32) -> f32, name: &str| {
            let operation = OPERATIONS.iter().find(|operation| operation.name == name);
            let right = operation.expect("an operation").on_cpu;
            let numbers = numbers();
            let differ = numbers
                .iter()
                .filter(|[a, b, c]| wrong(*a, *b, *c).to_bits() != right(*a, *b, *c).to_bits());
            differ.count()
        };
        let fused = |a: f32, b: f32, c: f32| (f64::from(a) * f64::from(b) + f64::from(c)) as f32;
        assert!(differ(fused, "a product and a sum") > 8, "fused");
        let simplified = |_: f32, b: f32, _: f32| b;
        let name = "the difference of a sum and its first term";
        assert!(differ(simplified, name) > 8, "simplified");
        let reordered = |a: f32, b: f32, c: f32| a + (b + c);
        assert!(differ(reordered, "sums of three numbers") > 8, "reordered");
        let reciprocal = |a: f32, b: f32, _: f32| a * (1.0 / b);
        assert!(
            differ(reciprocal, "quotients") > 8,
            "a product with the reciprocal"
        );
    }

    #[test]
    fn a_device_is_exact_with_the_barrier_and_not_without() {
        let Some(device) = device() else { return };
        let exactness = test(&device, |text| text).expect("a result");
        assert_eq!(exactness, Exactness::Same);
        let wrong = test(&device, |text| text.replace(", zero)", ", 0u)")).expect("a result");
        assert!(!wrong.is_exact(), "{wrong:?}");
        let rounded = |text: String| text.replace("exact_root(abs(a))", "sqrt(abs(a) * 1.0000001)");
        let wrong = test(&device, rounded).expect("a result");
        let operation = "square roots";
        assert_eq!(wrong, Exactness::Differs { operation });
        // An addition that replaces denormal numbers by 0
        let flush = |text: String| {
            text.replace(
                "fn number_add(a: f32, b: f32, zero: u32) -> f32 { return number(a + b, zero); }",
                "fn number_add(a: f32, b: f32, zero: u32) -> f32 {
                    return select(number(a + b, zero), 0.0, abs(a + b) < 0x1p-126);
                }",
            )
        };
        let flushed = test(&device, flush).expect("a result");
        assert_eq!(flushed, Exactness::WithoutDenormals);
    }
}
