//! The step `python`: builds the package of `crates/dapple-python` as a wheel, installs it and tests it.
//!
//! It needs Python 3.11 or newer, and a Python package index for the packages that the tests use. Without these, the
//! step prints pip's error and is skipped. With `DAPPLE_NO_SKIP=1`, it fails, and so do tests that would skip
//! optional packages. Blender's module `bpy` needs an older NumPy than other packages, so its tests and its
//! documentation page have a separate environment. They are skipped if the index has no `bpy` for this Python. All
//! files are in `target/python`.

use super::{skip, works};
use anyhow::{Context, bail};
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
        return skip("there is no Python 3.11 with venv");
    }
    let main = match environment(shell, &folder.join("main"), &["maturin"]) {
        Ok(main) => main,
        Err(error) => return skip(&format!("there is no environment: {error:#}")),
    };
    let _package = shell.push_dir(&package);
    cmd!(shell, "cargo fmt --check").run()?;
    cmd!(
        shell,
        "cargo clippy --quiet --release --locked -- -D warnings"
    )
    .run()?;
    // Build and install the wheel, then run the tests and build the documentation.
    let wheel = wheel(shell, &main, &folder.join("wheels"))?;
    let wheel = wheel.display().to_string();
    let with_extras = format!("{wheel}[test,docs]");
    let (pip, python) = (main.join("pip"), main.join("python"));
    cmd!(shell, "{pip} install --quiet {with_extras}").run()?;
    // An earlier wheel has the same version, so force the installation.
    let again = ["--quiet", "--force-reinstall", "--no-deps"];
    cmd!(shell, "{pip} install {again...} {wheel}").run()?;
    let tests = cmd!(shell, "{python} -m pytest -q -rs").env("PATH", with_first(&main)?);
    // The command built by the workspace tests, whose output the package must reproduce bit for bit.
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
    // Repeat the tests for Blender in a separate environment.
    let wants = ["bpy==4.5.*", "pytest", "trimesh", "pillow"];
    let blender = match environment(shell, &folder.join("blender"), &wants) {
        Ok(blender) => blender,
        // Each version of Blender's module supports a single version of Python.
        Err(error) => {
            crate::say(&format!("skipped: the tests in Blender: {error:#}"));
            return Ok(());
        }
    };
    let (pip, python) = (blender.join("pip"), blender.join("python"));
    cmd!(shell, "{pip} install {again...} {wheel}").run()?;
    let files = ["tests/test_blender.py", "tests/test_docs.py"];
    Ok(cmd!(shell, "{python} -m pytest -q -rs -k blender {files...}").run()?)
}

/// Creates a virtual environment with some packages. Returns the folder of its programs.
///
/// # Errors
///
/// The error output of Python or pip, if the environment or a package cannot be installed.
fn environment(shell: &Shell, folder: &Path, packages: &[&str]) -> anyhow::Result<PathBuf> {
    let bin = folder.join(if cfg!(windows) { "Scripts" } else { "bin" });
    let pip = bin.join("pip");
    run(cmd!(shell, "python3 -m venv {folder}"))?;
    run(cmd!(
        shell,
        "{pip} install --quiet --only-binary :all: {packages...}"
    ))?;
    Ok(bin)
}

/// Runs a command. If it fails, its standard error becomes the error message.
fn run(command: Cmd<'_>) -> anyhow::Result<()> {
    let done = command.quiet().ignore_status().output()?;
    if !done.status.success() {
        bail!("{}", String::from_utf8_lossy(&done.stderr).trim());
    }
    Ok(())
}

/// Builds the wheel and returns its path. The wheel is the only file of its folder.
fn wheel(shell: &Shell, bin: &Path, folder: &Path) -> anyhow::Result<PathBuf> {
    shell.remove_path(folder)?;
    let maturin = bin.join("maturin");
    cmd!(
        shell,
        "{maturin} build --release --locked --quiet --out {folder}"
    )
    .run()?;
    let files = shell.read_dir(folder)?;
    files.into_iter().next().context("maturin made no wheel")
}

/// Returns the value of `PATH` with a folder added at its front.
fn with_first(folder: &Path) -> anyhow::Result<std::ffi::OsString> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = [folder.to_owned()].into_iter();
    Ok(std::env::join_paths(
        folders.chain(std::env::split_paths(&path)),
    )?)
}
