//! The step `python`: the package of `crates/dapple-python`, built as a wheel, installed and tested.
//!
//! It needs Python 3.11 or newer, and the Python index for what the tests use. Where one is missing, the step says so and is
//! skipped; Blender's module `bpy` is there for few Pythons, and its tests skip themselves without it. The environment is in
//! `target/python`.

use std::path::Path;
use xshell::{Shell, cmd};

/// The packages that no index has for some Pythons: without them their tests are skipped.
const OPTIONAL: [&str; 2] = ["bpy==4.5.*", "scikit-image"];

/// Builds and tests the package.
pub(super) fn python(shell: &Shell) -> anyhow::Result<()> {
    let root = shell.current_dir();
    let package = root.join("crates/dapple-python");
    let folder = root.join("target/python");
    if let Some(missing) = prepare(shell, &folder) {
        crate::say(&format!("skipped: {missing}"));
        return Ok(());
    }
    let bin = folder.join(if cfg!(windows) { "Scripts" } else { "bin" });
    let pip = bin.join("pip");
    {
        let _package = shell.push_dir(&package);
        cmd!(shell, "cargo fmt --check").run()?;
        cmd!(shell, "cargo clippy --quiet --release -- -D warnings").run()?;
    }
    cmd!(shell, "{pip} install --quiet {package}[test,docs]").run()?;
    for optional in OPTIONAL {
        let installed = cmd!(
            shell,
            "{pip} install --quiet --only-binary :all: {optional}"
        );
        if installed.ignore_stderr().run().is_err() {
            crate::say(&format!(
                "{optional} cannot be had: what needs it is skipped"
            ));
        }
    }
    let (python, path) = (bin.join("python"), with_first(&bin)?);
    let _package = shell.push_dir(&package);
    let mut tests = cmd!(shell, "{python} -m pytest -q -rs").env("PATH", path);
    // The command that the tests of the workspace built: the package has its bits.
    let command = root.join("target/debug/dapple");
    if shell.path_exists(&command) {
        tests = tests.env("DAPPLE", command);
    }
    tests.run()?;
    Ok(cmd!(
        shell,
        "{python} -m mkdocs build --quiet --strict --site-dir {folder}/site"
    )
    .run()?)
}

/// Makes the environment, or says what is missing for it.
fn prepare(shell: &Shell, folder: &Path) -> Option<&'static str> {
    let is_new = "import sys, venv; sys.exit(sys.version_info < (3, 11))";
    let python = cmd!(shell, "python3 -c {is_new}").ignore_stderr().quiet();
    if python.run().is_err() {
        return Some("there is no Python 3.11 with venv");
    }
    if cmd!(shell, "python3 -m venv {folder}").run().is_err() {
        return Some("Python cannot make an environment");
    }
    let pip = folder.join(if cfg!(windows) {
        "Scripts/pip"
    } else {
        "bin/pip"
    });
    let download = cmd!(shell, "{pip} install --quiet maturin").ignore_stderr();
    download
        .run()
        .is_err()
        .then_some("the Python index cannot be reached")
}

/// The search path with a folder in front.
fn with_first(folder: &Path) -> anyhow::Result<std::ffi::OsString> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = [folder.to_owned()]
        .into_iter()
        .chain(std::env::split_paths(&path));
    Ok(std::env::join_paths(folders)?)
}
