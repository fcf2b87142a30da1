//! Implements the commands that run programs of the workspace.

use anyhow::bail;
use std::ffi::OsString;
use xshell::{Shell, cmd};

/// Renders the figures.
pub(crate) fn gallery(shell: &Shell, arguments: &[OsString]) -> anyhow::Result<()> {
    let run = cmd!(
        shell,
        "cargo run --quiet --release --package dapple-gallery -- {arguments...}"
    );
    Ok(run.quiet().run()?)
}

/// Rewrites or compares the images in the documentation.
pub(crate) fn docs_images(shell: &Shell, check: bool) -> anyhow::Result<()> {
    let mut arguments = vec![OsString::from("--docs")];
    arguments.extend(check.then(|| "--check".into()));
    gallery(shell, &arguments)
}

/// Runs the benchmarks, including the peer libraries.
pub(crate) fn bench(shell: &Shell, arguments: &[OsString]) -> anyhow::Result<()> {
    let run = cmd!(
        shell,
        "cargo run --release --package dapple-bench --features peers -- {arguments...}"
    );
    Ok(run.quiet().run()?)
}

/// The program `npm`, which installs the packages of the studio's page and builds it.
pub(crate) const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

/// Builds the page of the studio, then runs the studio with it.
pub(crate) fn studio(shell: &Shell, arguments: &[OsString]) -> anyhow::Result<()> {
    page(shell, &["run", "build"])?;
    let run = cmd!(
        shell,
        "cargo run --quiet --release --package dapple-cli -- studio {arguments...}"
    );
    Ok(run.quiet().run()?)
}

/// Installs the packages of the studio's page and builds the page.
pub(crate) fn page(shell: &Shell, build: &[&str]) -> anyhow::Result<()> {
    let _page = shell.push_dir("crates/dapple-studio/web");
    let npm = NPM;
    if cmd!(shell, "{npm} --version")
        .quiet()
        .ignore_stdout()
        .ignore_stderr()
        .run()
        .is_err()
    {
        bail!(
            "the page of the studio is built with Node 20 or newer, whose `npm` was not found: see https://nodejs.org"
        );
    }
    cmd!(shell, "{npm} ci --no-audit --no-fund").run()?;
    Ok(cmd!(shell, "{npm} {build...}").run()?)
}

/// Compares or rewrites the golden images, which a test of the crate `dapple-tests` renders.
pub(crate) fn golden(shell: &Shell, bless: bool) -> anyhow::Result<()> {
    let test = cmd!(
        shell,
        "cargo test --quiet --package dapple-tests --test it golden"
    );
    Ok(if bless {
        test.env("DAPPLE_BLESS", "1")
    } else {
        test
    }
    .quiet()
    .run()?)
}
