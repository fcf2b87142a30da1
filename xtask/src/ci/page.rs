//! The step `page`: checks and builds the page of the studio, and compares it with the command in a Chromium.
//!
//! It needs Node 20 or newer, and access to the npm registry. Without these, the step is reported as skipped. With
//! `DAPPLE_NO_SKIP=1`, it fails.

use super::{skip, works};
use xshell::{Shell, cmd};

/// Checks, builds and tests the page.
pub(super) fn page(shell: &Shell) -> anyhow::Result<()> {
    let root = shell.current_dir();
    let npm = crate::run::NPM;
    let is_new = "process.exit(parseInt(process.versions.node) < 20 ? 1 : 0)";
    if !works(cmd!(shell, "node -e {is_new}"))
        || !works(cmd!(shell, "{npm} --version").ignore_stdout())
    {
        return skip("there is no Node 20 with npm");
    }
    let _web = shell.push_dir("crates/dapple-studio/web");
    if !works(cmd!(shell, "{npm} ci --no-audit --no-fund --silent")) {
        return skip("npm cannot get the packages of the page");
    }
    cmd!(shell, "{npm} run --silent check").run()?;
    cmd!(shell, "{npm} run --silent build").run()?;
    let command = root.join("target/debug/dapple");
    if !shell.path_exists(&command) {
        cmd!(shell, "cargo build --quiet --package dapple-cli").run()?;
    }
    Ok(cmd!(shell, "{npm} test").env("DAPPLE", command).run()?)
}
