//! Benchmarks against other crates: `cargo xtask bench [filter…] [--missing] [--write-results] [--json FILE] [--check]`.
//!
//! Every row compares a job of ours with the same job of another crate (a peer), or with our own job under other
//! conditions, in one run. It states the ratio that must be reached. A filter is the name of a group, which selects
//! its rows, or a part of the name of a case or peer.
//!
//! The module `harness` measures rows, `peers` calls each peer in its fastest configuration, and each group has a
//! module: `pups`, `points`, `graph`, `worley`, `noise`, `pattern`, `wavelet`, `tile`, `mesh`, `synth` and `recipe`. The peers
//! are built only with the feature `peers`, which `cargo xtask bench` enables. Without it only the rows that compare
//! our own jobs run.

#![forbid(unsafe_code)]

mod row;

mod harness;

mod machine;

mod report;

mod naive;

mod sets;

#[cfg(feature = "peers")]
mod peers;

mod graph;
mod mesh;
#[cfg(feature = "peers")]
mod noise;
#[cfg(feature = "peers")]
mod pattern;
mod points;
mod pups;
mod recipe;
mod synth;
mod tile;
mod wavelet;
mod worley;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use harness::Bench;
use machine::Machine;
use report::Page;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Benchmarks against other crates, one row for each goal that the library sets itself.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask bench")]
struct Arguments {
    /// Groups (pups, points, graph, worley, noise, pattern, wavelet, tile, mesh, synth, recipe), or parts of the names of cases or
    /// peers; without filters all rows run.
    filters: Vec<String>,
    /// Writes the rows as JSON to this file.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Fails if a row misses its goal.
    #[arg(long)]
    check: bool,
    /// Writes the rows to `crates/dapple-bench/RESULTS.md`. With a filter or `--missing`, its other rows stay.
    #[arg(long)]
    write_results: bool,
    /// Runs only the rows that `RESULTS.md` lacks.
    #[arg(long)]
    missing: bool,
    /// Synthesizes a texture with this number of sites and prints time and memory; a row runs it as a separate process.
    #[arg(long, hide = true, value_name = "N")]
    synthesize: Option<usize>,
}

fn main() -> Result<ExitCode> {
    let arguments = Arguments::parse();
    if let Some(n_sites) = arguments.synthesize {
        synth::size::synthesize_here(n_sites)?;
        return Ok(ExitCode::SUCCESS);
    }
    if cfg!(not(feature = "peers")) {
        eprintln!("built without the feature `peers`: only the rows of ours alone run");
    }
    let results = Path::new(env!("CARGO_MANIFEST_DIR")).join("RESULTS.md");
    let old = report::read(&results);
    let known = if arguments.missing {
        old.clone()
    } else {
        Page::default()
    };
    let mut bench = Bench::new(arguments.filters.clone(), known)?;
    pups::run(&mut bench)?;
    points::run(&mut bench)?;
    graph::run(&mut bench)?;
    worley::run(&mut bench)?;
    #[cfg(feature = "peers")]
    {
        noise::run(&mut bench)?;
        pattern::run(&mut bench)?;
    }
    wavelet::run(&mut bench)?;
    tile::run(&mut bench)?;
    mesh::run(&mut bench)?;
    synth::run(&mut bench)?;
    recipe::run(&mut bench)?;
    let rows = bench.into_rows();
    if arguments.missing && rows.is_empty() {
        eprintln!("the results have all rows");
        return Ok(ExitCode::SUCCESS);
    }
    ensure!(!rows.is_empty(), "no case matches {:?}", arguments.filters);

    let page = Page::new(&Machine::this(), &rows);
    report::print(&page.markdown());
    if let Some(path) = &arguments.json {
        let json = serde_json::to_string_pretty(&rows)?;
        report::write(path, &json).with_context(|| format!("writing {}", path.display()))?;
    }
    if arguments.write_results {
        let is_part = arguments.missing || !arguments.filters.is_empty();
        let page = if is_part { old.merged(page) } else { page };
        report::write(&results, &page.markdown())
            .with_context(|| format!("writing {}", results.display()))?;
    }
    Ok(report::exit_code(&rows, arguments.check))
}
