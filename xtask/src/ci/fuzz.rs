//! The step `fuzz`: runs libFuzzer for 10 seconds on each target of `tests/fuzz`.
//!
//! It needs nightly Rust and cargo-fuzz and does not install them. Without either, the step is reported as skipped.
//! Crashes found and inputs learned by libFuzzer are kept in `target/fuzz`.

use anyhow::Context;
use std::path::Path;
use xshell::{Cmd, Shell, cmd};

/// Number of targets that run in parallel.
const AT_ONCE: usize = 2;

/// Running time of each target, in seconds.
const SECONDS: &str = "10";

/// Time limit per input, in seconds. Most inputs take less than a thousandth of it.
const SECONDS_OF_AN_INPUT: &str = "10";

/// Memory limit per input, in MiB.
const MEMORY: &str = "2048";

/// Runs every fuzz target, and stops at the first crash.
pub(super) fn fuzz(shell: &Shell) -> anyhow::Result<()> {
    if let Some(missing) = missing(shell) {
        crate::say(&format!("skipped: {missing}"));
        return Ok(());
    }
    let folder = shell.current_dir().join("target/fuzz");
    let seeds = folder.join("seeds");
    // Build with the whole workspace, so that the test builds are reused.
    let write_seeds = "inputs_are_written";
    cmd!(
        shell,
        "cargo test --quiet --workspace --test hostile {write_seeds}"
    )
    .env("DAPPLE_FUZZ_SEEDS", &seeds)
    .run()?;
    cargo_fuzz(shell, "build", &folder).run()?;
    for some in targets(shell)?.chunks(AT_ONCE) {
        run_together(shell, &folder, some)?;
    }
    Ok(())
}

/// Runs targets in parallel, each on one core.
fn run_together(shell: &Shell, folder: &Path, targets: &[String]) -> anyhow::Result<()> {
    std::thread::scope(|scope| {
        let runs = targets.iter().map(|target| {
            // Clone the shell, since it cannot be shared between threads.
            let shell = shell.clone();
            scope.spawn(move || run(&shell, folder, target))
        });
        let runs: Vec<_> = runs.collect();
        for (run, target) in runs.into_iter().zip(targets) {
            let done = run.join().expect("it does not panic");
            done.with_context(|| format!("the fuzz target `{target}`"))?;
        }
        Ok(())
    })
}

/// Returns the command `cargo fuzz COMMAND` for the targets of this workspace.
fn cargo_fuzz<'a>(shell: &'a Shell, command: &str, folder: &Path) -> Cmd<'a> {
    let built = folder.join("build");
    // The address sanitizer is off: the crates have no `unsafe` code of their own, and it would take half of the
    // time.
    let fuzz = cmd!(
        shell,
        "cargo +nightly fuzz {command} --fuzz-dir tests/fuzz --target-dir {built} --sanitizer none"
    );
    // Do not inherit RUSTFLAGS: the build is separate anyway, and compiling all SIMD levels is for the tests.
    fuzz.quiet().env_remove("RUSTFLAGS")
}

/// Returns a message about a missing tool, if any.
fn missing(shell: &Shell) -> Option<&'static str> {
    let works = |command: Cmd<'_>| {
        let output = command.quiet().ignore_status().ignore_stderr().output();
        output.is_ok_and(|output| output.status.success())
    };
    // Only rustup understands `+nightly`. It must not download the toolchain.
    if !works(cmd!(shell, "cargo +nightly --version").env("RUSTUP_AUTO_INSTALL", "0")) {
        return Some("there is no nightly Rust");
    }
    if !works(cmd!(shell, "cargo fuzz --version")) {
        return Some("there is no cargo-fuzz");
    }
    None
}

/// Returns the names of the targets, one per file.
fn targets(shell: &Shell) -> anyhow::Result<Vec<String>> {
    let files = shell.read_dir("tests/fuzz/targets")?;
    let stem = |path: &std::path::PathBuf| Some(path.file_stem()?.to_str()?.to_owned());
    Ok(files.iter().filter_map(stem).collect())
}

fn run(shell: &Shell, folder: &Path, target: &str) -> anyhow::Result<()> {
    crate::say(&format!("-- {target}"));
    let (learned, seeds) = (
        folder.join("learned").join(target),
        folder.join("seeds").join(target),
    );
    let findings = folder.join("findings");
    shell.create_dir(&learned)?;
    shell.create_dir(&findings)?;
    let prefix = format!("-artifact_prefix={}/{target}-", findings.display());
    let fuzz = cargo_fuzz(shell, "run", folder)
        .arg(target)
        .args([&learned, &seeds])
        .args([
            "--",
            "-seed=1996",
            "-max_len=4096",
            "-print_funcs=0",
            "-verbosity=0",
            &prefix,
        ])
        .arg(format!("-max_total_time={SECONDS}"))
        .arg(format!("-timeout={SECONDS_OF_AN_INPUT}"))
        .arg(format!("-rss_limit_mb={MEMORY}"));
    Ok(fuzz.run()?)
}
