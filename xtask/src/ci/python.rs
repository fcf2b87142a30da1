//! The step `python`: the package of `crates/dapple-python`, built as a wheel, installed and tested.
//!
//! It needs Python 3.11 or newer, and the Python index for what the tests use. Where one is missing, the step says so and is
//! skipped. Blender's module `bpy` wants an older NumPy than others, so its tests have an environment of their own, and are
//! skipped where no index has it for this Python. All of it lies in `target/python`.

use anyhow::Context;
use std::path::{Path, PathBuf};
use xshell::{Cmd, Shell, cmd};

/// Builds and tests the package.
pub(super) fn python(shell: &Shell) -> anyhow::Result<()> {
    let root = shell.current_dir();
    let (package, folder) = (
        root.join("crates/dapple-python"),
        root.join("target/python"),
    );
    let is_new = "import sys, venv; sys.exit(sys.version_info < (3, 11))";
    if !works(cmd!(shell, "python3 -c {is_new}")) {
        crate::say("skipped: there is no Python 3.11 with venv");
        return Ok(());
    }
    let Some(main) = environment(shell, &folder.join("main"), &["maturin"]) else {
        crate::say("skipped: the Python index cannot be reached");
        return Ok(());
    };
    let _package = shell.push_dir(&package);
    cmd!(shell, "cargo fmt --check").run()?;
    cmd!(shell, "cargo clippy --quiet --release -- -D warnings").run()?;
    let wheel = wheel(shell, &main, &folder.join("wheels"))?;
    let wheel = wheel.display().to_string();
    let with_extras = format!("{wheel}[test,docs]");
    let (pip, python) = (main.join("pip"), main.join("python"));
    cmd!(shell, "{pip} install --quiet {with_extras}").run()?;
    let tests = cmd!(shell, "{python} -m pytest -q -rs").env("PATH", with_first(&main)?);
    // The command that the tests of the workspace built: the package has its bits.
    let command = root.join("target/debug/dapple");
    if shell.path_exists(&command) {
        tests.env("DAPPLE", command).run()?;
    } else {
        tests.run()?;
    }
    cmd!(
        shell,
        "{python} -m mkdocs build --quiet --strict --site-dir {folder}/site"
    )
    .run()?;
    let wants = ["bpy==4.5.*", "pytest", "trimesh", "pillow"];
    let Some(blender) = environment(shell, &folder.join("blender"), &wants) else {
        crate::say("the tests in Blender are skipped: there is no bpy 4.5 for this Python");
        return Ok(());
    };
    let (pip, python) = (blender.join("pip"), blender.join("python"));
    cmd!(
        shell,
        "{pip} install --quiet --force-reinstall --no-deps {wheel}"
    )
    .run()?;
    Ok(cmd!(shell, "{python} -m pytest -q -rs tests/test_blender.py").run()?)
}

/// The folder of the programs of an environment with some packages, if they can be had.
fn environment(shell: &Shell, folder: &Path, packages: &[&str]) -> Option<PathBuf> {
    let bin = folder.join(if cfg!(windows) { "Scripts" } else { "bin" });
    let pip = bin.join("pip");
    let is_there = works(cmd!(shell, "python3 -m venv {folder}"))
        && works(cmd!(
            shell,
            "{pip} install --quiet --only-binary :all: {packages...}"
        ));
    is_there.then_some(bin)
}

/// Builds the wheel, the only file of its folder.
fn wheel(shell: &Shell, bin: &Path, folder: &Path) -> anyhow::Result<PathBuf> {
    shell.remove_path(folder)?;
    let maturin = bin.join("maturin");
    cmd!(shell, "{maturin} build --release --quiet --out {folder}").run()?;
    let files = shell.read_dir(folder)?;
    files.into_iter().next().context("maturin made no wheel")
}

fn works(command: Cmd<'_>) -> bool {
    command.quiet().ignore_stderr().run().is_ok()
}

/// The search path with a folder in front.
fn with_first(folder: &Path) -> anyhow::Result<std::ffi::OsString> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = [folder.to_owned()].into_iter();
    Ok(std::env::join_paths(
        folders.chain(std::env::split_paths(&path)),
    )?)
}
