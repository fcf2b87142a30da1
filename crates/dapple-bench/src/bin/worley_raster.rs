//! Renders F2 − F1 repeatedly: `worley_raster SEED SIDE PX_PER_CELL RUNS`.
//!
//! The benchmark `dapple-bench` builds this program once for any processor and once for the current one, and runs both.
//! It prints the processor time of every run in seconds, then a hash of the raster's bits.

#![forbid(unsafe_code)]
#![expect(clippy::print_stdout, reason = "what it prints is what it is for")]

#[path = "../worley/digest.rs"]
mod digest;

use anyhow::{Context as _, Result, ensure};
use cpu_time::ThreadTime;
use dapple_hash::Seed;
use dapple_raster::{Field as _, Raster, Window};
use dapple_worley::{Combination, Worley2};
use glam::DVec2;
use rayon::ThreadPoolBuilder;
use std::hint::black_box;

fn main() -> Result<()> {
    let numbers: Vec<u32> = std::env::args()
        .skip(1)
        .map(|text| {
            text.parse()
                .with_context(|| format!("`{text}` is no number"))
        })
        .collect::<Result<_>>()?;
    let [seed, side, px_per_cell, n_runs] = numbers[..] else {
        anyhow::bail!("expected a seed, a side, pixels per cell and a number of runs");
    };
    ensure!(px_per_cell > 0, "a cell has at least one pixel");

    let cellular = Worley2::new(Seed(seed.into())).combine(Combination::F2_MINUS_F1);
    let extent = DVec2::splat(f64::from(side) / f64::from(px_per_cell));
    let window = Window::new(DVec2::ZERO, extent, [side; 2])?;
    let mut image = Raster::filled(window.size, 0.0)?;
    let mut render = || {
        let start = ThreadTime::now();
        let done = cellular.render(&window, image.view_mut());
        black_box(&mut image);
        done.map(|()| start.elapsed().as_secs_f64())
    };
    // One warm-up run, as in the benchmark itself, so that memory is mapped.
    let seconds: Result<Vec<f64>, _> = ThreadPoolBuilder::new()
        .num_threads(1)
        .build()?
        .install(|| (0..=n_runs).map(|_| render()).collect());
    for seconds in &seconds?[1..] {
        println!("{seconds}");
    }
    println!("{:016x}", digest::digest(image.pixels()));
    Ok(())
}
