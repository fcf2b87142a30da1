//! The step `web`: the studio without a server, built and compared with the command, under Node and in a Chromium.
//!
//! It needs Node and a compiler for WebAssembly, which CI has not: where one is missing the step says so and is skipped, also
//! with `DAPPLE_NO_SKIP=1`. The tests need the command that the other steps built.

use super::works;
use crate::web::{MISSING, has_target};
use xshell::{Shell, cmd};

/// Builds and tests the folder.
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
