//! The step `web`: builds the studio without a server and compares it with the command, under Node and in a Chromium.
//!
//! It needs Node and a compiler for WebAssembly, which CI lacks. Without these, the step is reported as skipped, even
//! with `DAPPLE_NO_SKIP=1`. The tests need the command built by the other steps.

use super::works;
use crate::web::{MISSING, has_target};
use xshell::{Shell, cmd};

/// Builds and tests the static site of the studio.
pub(super) fn web(shell: &Shell) -> anyhow::Result<()> {
    let npm = crate::run::NPM;
    if !works(cmd!(shell, "{npm} --version").ignore_stdout()) {
        crate::say("skipped: there is no Node");
        return Ok(());
    }
    if !has_target(shell) {
        crate::say(&format!("skipped: {MISSING}"));
        return Ok(());
    }
    let folder = shell.current_dir().join("target/web");
    let command = shell.current_dir().join("target/debug/dapple");
    if !shell.path_exists(&command) {
        cmd!(shell, "cargo build --quiet --package dapple-cli")
            .env_remove("RUSTC")
            .run()?;
    }
    crate::web::web(shell, None)?;
    let _page = shell.push_dir("crates/dapple-studio/web");
    let tests = cmd!(
        shell,
        "node --test --test-concurrency=1 tests/wasm.test.mjs tests/static.test.mjs"
    );
    Ok(tests.env("DAPPLE", command).env("STATIC", folder).run()?)
}
