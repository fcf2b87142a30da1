//! Measures time and memory of whole programs, for one size and for four times as many sites.
//!
//! Each size runs in a separate process on one thread: this program with the hidden argument `--synthesize`. Linux
//! reports the peak memory of a process in a file; on other systems that row is omitted.

use super::scene::{N_SITES, count, exact, leaves, model, synthesizer};
use crate::harness::Bench;
use crate::report::{print, three_digits};
use crate::row::{Case, Goal, Unit};
use anyhow::{Context as _, Result, ensure};
use cpu_time::ThreadTime;
use rayon::ThreadPoolBuilder;
use std::process::Command;

const SYNTHESIS: Case = Case {
    group: "synth",
    case: "synthesis, 1,048,576 sites",
    peer: "ours, 262,144 sites",
    unit: Unit::S,
    must: Goal::CostAtMost(4.4),
    note: "",
};

const MEMORY: Case = Case {
    case: "memory, 1,048,576 sites",
    peer: "the limit of 600 MB",
    unit: Unit::Megabytes,
    must: Goal::CostAtMost(1.0),
    note: "the most that a process had that read the model, made sites and texture, and nothing else",
    ..SYNTHESIS
};

/// Measurements of one process.
struct Took {
    /// Setup time, in seconds of processor time.
    setup: f64,
    synthesis: f64,
    /// Peak memory in bytes; 0 if it is unknown.
    memory: f64,
}

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants_any(&[SYNTHESIS, MEMORY]) {
        return Ok(());
    }
    let large = in_process(4 * N_SITES)?;
    if bench.wants(&SYNTHESIS) {
        let small = in_process(N_SITES)?;
        let note = format!(
            "one thread, 3 levels; points, graph, directions and sweep took {} s more beside {} s, which is {} times as \
             much; {}; {}",
            three_digits(large.setup),
            three_digits(small.setup),
            three_digits(large.setup / small.setup),
            model()?.note,
            leaves(64)?.note(),
        );
        bench.measured_with(&SYNTHESIS, large.synthesis, small.synthesis, note);
    }
    if large.memory == 0.0 {
        eprintln!(
            "synth: {}: skipped, this system does not tell it",
            MEMORY.case
        );
    } else if bench.wants(&MEMORY) {
        bench.measured(&MEMORY, large.memory, 600e6);
    }
    Ok(())
}

/// Calls [`synthesize_here`] in a new process of this program, and returns the measurements.
fn in_process(n_sites: usize) -> Result<Took> {
    let program = std::env::current_exe()?;
    let output = Command::new(&program)
        .args(["--synthesize", &n_sites.to_string()])
        .output()
        .with_context(|| format!("running {}", program.display()))?;
    ensure!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(output.stdout)?;
    let numbers: Vec<f64> = text
        .split_whitespace()
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    let [setup, synthesis, memory] = numbers[..] else {
        anyhow::bail!("`{text}` is not three numbers");
    };
    Ok(Took {
        setup,
        synthesis,
        memory,
    })
}

/// Synthesizes a texture with `n_sites` sites. Prints the setup time and the synthesis time in seconds, and the peak
/// memory.
pub(crate) fn synthesize_here(n_sites: usize) -> Result<()> {
    let one = ThreadPoolBuilder::new().num_threads(1).build()?;
    let (setup, synthesis) = one.install(|| -> Result<_> {
        let exemplar = leaves(64)?.exemplar()?;
        let start = ThreadTime::now();
        let sites = synthesizer(&model()?, n_sites, 3)?;
        let setup = start.elapsed().as_secs_f64();
        let start = ThreadTime::now();
        let texture = sites.synthesize(&exemplar, &exact(3))?;
        let synthesis = start.elapsed().as_secs_f64();
        // Read the memory before the check, which allocates too.
        let memory = most_memory();
        ensure!(count(&texture)? == n_sites, "a site is missing");
        Ok((setup, (synthesis, memory)))
    })?;
    let (synthesis, memory) = synthesis;
    print(&format!("{setup} {synthesis} {}\n", memory.unwrap_or(0.0)));
    Ok(())
}

/// Returns the peak memory of this process in bytes, if it is known.
fn most_memory() -> Option<f64> {
    #[expect(clippy::disallowed_methods, reason = "Linux tells it in a file")]
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    high_water(&text)
}

/// Returns the `VmHWM` value in the text of `/proc/self/status`, in bytes.
fn high_water(status: &str) -> Option<f64> {
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024.0)
}

#[cfg(test)]
mod tests {
    use super::high_water;

    #[test]
    fn high_water_is_in_bytes() {
        let text = "Name:\tbench\nVmPeak:\t 900 kB\nVmHWM:\t     256 kB\nVmRSS:\t 12 kB\n";
        assert_eq!(high_water(text), Some(262_144.0), "256 KiB");
        assert_eq!(high_water("Name:\tbench\n"), None, "another system");
    }
}
