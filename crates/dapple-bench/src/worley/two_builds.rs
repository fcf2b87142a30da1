//! A build for any processor, which selects its instructions at run time, compared with a build for the current
//! processor.
//!
//! Both are builds of the program `worley_raster`, each in its own target directory under `target/`. They run in
//! turns as child processes, which print the processor time of every run; the row reports the medians of all runs.
//! Confirmed: the bits equal a raster rendered in this process. The first build of both takes a few minutes.

use super::digest::digest;
use super::{F2_MINUS_F1, Grid, PLANE};
use crate::harness::{Bench, median};
use crate::row::{Case, Goal, Unit};
use crate::sets::SEED;
use anyhow::{Context as _, Result, bail, ensure};
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

const DEFAULT_64: Case = Case {
    group: "worley",
    case: "2-D, 64 px per cell, F2 − F1, built for any processor",
    peer: "ours, built with target-cpu=native",
    unit: Unit::NsPerPixel,
    must: Goal::CostAtMost(1.15),
    note: "two programs, run in turns",
};

const DEFAULT_4: Case = Case {
    case: "2-D, 4 px per cell, F2 − F1, built for any processor",
    ..DEFAULT_64
};

/// Number of turns per row. Each turn runs both sides.
const TURNS: u32 = 9;

/// Number of runs of each program per turn.
const RUNS: u32 = 25;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants_any(&[DEFAULT_64, DEFAULT_4]) {
        return Ok(());
    }
    eprintln!("worley: building `worley_raster` twice, which takes minutes when it is new");
    let programs = [
        build("bench-any-processor", None).context("building for any processor")?,
        build("bench-this-processor", Some("-C target-cpu=native"))
            .context("building for this processor")?,
    ];
    row(bench, &DEFAULT_64, &programs, 64)?;
    row(bench, &DEFAULT_4, &programs, 4)
}

fn row(bench: &mut Bench, case: &Case, programs: &[PathBuf; 2], px_per_cell: u32) -> Result<()> {
    if !bench.wants(case) {
        return Ok(());
    }
    let grid = Grid::new(F2_MINUS_F1, PLANE, px_per_cell)?;
    let mut image = grid.image()?;
    grid.render(&mut image);
    grid.confirm(&image)?;
    let expected = digest(image.pixels());
    let mut seconds = [Vec::new(), Vec::new()];
    for _ in 0..TURNS {
        for (program, seconds) in programs.iter().zip(&mut seconds) {
            let found = run_program(program, px_per_cell, seconds)
                .with_context(|| format!("running {}", program.display()))?;
            ensure!(
                found == expected,
                "{} rendered other bits than this program",
                program.display()
            );
        }
    }
    let [ours, theirs] = seconds.map(|mut seconds| median(&mut seconds) / grid.n_pixels() as f64);
    bench.measured(case, ours, theirs);
    Ok(())
}

/// Builds the program with the given flags into a directory under `target/`.
fn build(directory: &str, flags: Option<&str>) -> Result<PathBuf> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .context("the workspace of this crate")?;
    let target = workspace.join("target").join(directory);
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .current_dir(workspace)
        .args(["build", "--quiet", "--release", "--package", "dapple-bench"])
        .args(["--bin", "worley_raster", "--target-dir"])
        .arg(&target)
        // The flags of the current build must not leak into the measured ones.
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env_remove("CARGO_BUILD_TARGET")
        .env_remove("RUSTFLAGS");
    if let Some(flags) = flags {
        cargo.env("RUSTFLAGS", flags);
    }
    let status = cargo.status().context("starting cargo")?;
    ensure!(status.success(), "cargo failed: {status}");
    let name = format!("worley_raster{}", env::consts::EXE_SUFFIX);
    Ok(target.join("release").join(name))
}

/// Runs the program, appends the times of its runs in seconds, and returns the hash of the rendered bits.
fn run_program(program: &Path, px_per_cell: u32, seconds: &mut Vec<f64>) -> Result<u64> {
    let arguments = [SEED.0, PLANE[0].into(), px_per_cell.into(), RUNS.into()];
    let output = Command::new(program)
        .args(arguments.map(|number| number.to_string()))
        .output()?;
    if !output.status.success() {
        bail!("{}", String::from_utf8_lossy(&output.stderr));
    }
    let text = String::from_utf8(output.stdout)?;
    let lines: Vec<&str> = text.lines().collect();
    let (found, times) = lines.split_last().context("it printed nothing")?;
    for time in times {
        seconds.push(
            time.parse()
                .with_context(|| format!("`{time}` is no time"))?,
        );
    }
    u64::from_str_radix(found, 16).with_context(|| format!("`{found}` is no hash"))
}
