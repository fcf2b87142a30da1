//! Terrain whose heights are on the GPU, and a ray of the CPU that ends on the same surface, to the last bit.
//!
//! A game draws the texture and casts rays against the plan, for physics or the mouse, without reading anything back.
//! This example reads the heights back once, to compare them.
//!
//! ```sh
//! cargo run -p dapple-gpu --example terrain
//! ```
#![expect(clippy::print_stdout, reason = "an example shows its results")]

use dapple_gpu::recipe::raster::{Field, Window};
use dapple_gpu::recipe::{Images, Plan, Recipe};
use dapple_gpu::{Gpu, GpuPlan};
use std::error::Error;

/// Hills of gradient noise with creases of Worley's cells.
const TERRAIN: &str = r#"
    dapple = 1
    wrap = [false, false]
    [nodes]
    hills.noise = { basis = "gradient", frequency = 0.7, octaves = 6 }
    creases.worley = { frequency = 2.0, value = "f2_minus_f1", range = [0.0, 1.0] }
    ground.mix = { from = "hills", to = "creases", by = 0.2 }
    [material]
    height = "ground"
    "#;

/// Vertices along each side of the terrain, and their distance.
const SIDE: u32 = 256;
const STEP: f64 = 1.0 / 32.0;

fn main() -> Result<(), Box<dyn Error>> {
    let gpu = match Gpu::headless() {
        Ok(gpu) => gpu,
        Err(error) => {
            println!("{error}");
            return Ok(());
        }
    };
    println!(
        "on {}: {:?}",
        gpu.device().adapter_info().name,
        gpu.exactness()
    );
    let recipe = Recipe::from_toml(TERRAIN)?;
    let plan = Plan::new(&recipe, &Images::new(), 0.0)?;
    let ground = plan.field("ground")?;

    // Vertices at multiples of the step, far from the origin
    let first = [1e6, -2e6];
    let corner = first.map(|at| at - STEP / 2.0);
    let window = Window::new(corner, [STEP * f64::from(SIDE); 2], [SIDE; 2])?;
    let on_gpu = GpuPlan::new(&gpu, &recipe, &plan)?;
    let texture = on_gpu.texture("ground", &window)?;
    println!(
        "a texture of {} x {} heights",
        texture.width(),
        texture.height()
    );

    // A ray against the surface between the vertices, whose heights the CPU computes
    let vertex = |column: u32, row: u32| ground.value(window.position(column, row));
    let (column, row, height) =
        cast([3.3, 2.0, 9.1], [0.5, -0.15, 0.35], vertex).ok_or("no hit")?;
    println!("the ray ends in the square of vertex ({column}, {row}), at height {height}");

    // The same surface with the heights of the GPU
    let heights = on_gpu.raster("ground", &window)?;
    let vertex = |column: u32, row: u32| heights.pixels()[(row * SIDE + column) as usize];
    let on_gpu = cast([3.3, 2.0, 9.1], [0.5, -0.15, 0.35], vertex).ok_or("no hit")?;
    println!("with the heights of the GPU, at height {}", on_gpu.2);
    assert_eq!(
        (column, row, height.to_bits()),
        (on_gpu.0, on_gpu.1, on_gpu.2.to_bits()),
        "the ray of the CPU lands elsewhere"
    );
    let on_cpu = ground.to_raster(&window)?;
    let same = heights.pixels().iter().zip(on_cpu.pixels());
    let same = same.filter(|(gpu, cpu)| gpu.to_bits() == cpu.to_bits());
    println!(
        "{} of {} heights have the same bits",
        same.count(),
        SIDE * SIDE
    );
    Ok(())
}

/// Marches along a ray until it is below the surface, in units of a step. Returns the square, and the surface's height.
fn cast(
    origin: [f32; 3],
    direction: [f32; 3],
    vertex: impl Fn(u32, u32) -> f32,
) -> Option<(u32, u32, f32)> {
    (0..4096).find_map(|march| {
        let [x, height, y] =
            [0, 1, 2].map(|axis| origin[axis] + march as f32 * 0.05 * direction[axis]);
        let (column, row) = (x.floor() as u32, y.floor() as u32);
        if column + 1 >= SIDE || row + 1 >= SIDE {
            return None;
        }
        let [across, down] = [x.fract(), y.fract()];
        let mix = |a: f32, b: f32, part: f32| a + (b - a) * part;
        let above = mix(vertex(column, row), vertex(column + 1, row), across);
        let below = mix(vertex(column, row + 1), vertex(column + 1, row + 1), across);
        let surface = mix(above, below, down);
        (height <= surface).then_some((column, row, surface))
    })
}
