//! `cargo xtask web`: builds the studio as a static site with a WebAssembly worker.
//!
//! It needs Node, and a compiler with the standard library for `wasm32-unknown-unknown`. That is rustup's compiler
//! after `rustup target add wasm32-unknown-unknown`, or any other compiler named by `RUSTC`. Debian's `rustc-web`
//! lacks this library, but its source is in `rust-web-src`. To build it, run
//! `RUSTC_BOOTSTRAP=1 cargo build -Zbuild-std=std,panic_abort --target wasm32-unknown-unknown` in any crate, and copy
//! the files `deps/*.rlib` into the folder that `rustc --print target-libdir` prints. The linker is LLVM's `wasm-ld`,
//! set by `CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER`.

use crate::run;
use anyhow::bail;
use std::env;
use std::path::{Path, PathBuf};
use xshell::{Shell, cmd};

const TARGET: &str = "wasm32-unknown-unknown";

/// Error message for a missing standard library, with the fix.
pub(crate) const MISSING: &str = "the compiler has no standard library for WebAssembly: `rustup target add wasm32-unknown-unknown` \
    gets it, or RUSTC names another compiler";

/// Builds the site and lists its files.
pub(crate) fn web(shell: &Shell, out: Option<PathBuf>) -> anyhow::Result<()> {
    if !has_target(shell) {
        bail!("{MISSING}");
    }
    let out = shell.current_dir().join(out.unwrap_or("target/web".into()));
    let program = program(shell)?;
    let folder = out.display().to_string();
    let arguments = ["--mode", "static", "--outDir", &folder, "--emptyOutDir"];
    run::page(shell, &[&["run", "build", "--"][..], &arguments].concat())?;
    shell.copy_file(program, out.join("dapple.wasm"))?;
    for file in files(shell, &out)? {
        let name = file.strip_prefix(&out).unwrap_or(&file).display();
        let n_bytes = shell.read_binary_file(&file)?.len();
        crate::say(&format!("{:>8} KiB  {name}", n_bytes.div_ceil(1024)));
    }
    crate::say(&format!(
        "\n{folder} is ready for any host of files, such as:\n  python3 -m http.server --directory {folder}"
    ));
    Ok(())
}

/// Returns whether the compiler has the standard library for WebAssembly.
pub(crate) fn has_target(shell: &Shell) -> bool {
    let rustc = env::var("RUSTC").unwrap_or("rustc".into());
    let folder = cmd!(shell, "{rustc} --print target-libdir --target {TARGET}");
    let folder = folder.quiet().ignore_stderr().read().unwrap_or_default();
    let is_of_std = |file: &PathBuf| file.to_string_lossy().contains("libstd-");
    shell
        .read_dir(folder.trim())
        .is_ok_and(|files| files.iter().any(is_of_std))
}

/// Compiles the WebAssembly module of the worker.
fn program(shell: &Shell) -> anyhow::Result<PathBuf> {
    let flags = env::var("RUSTFLAGS").unwrap_or_default() + " -Ctarget-feature=+simd128";
    let build = cmd!(
        shell,
        "cargo rustc --profile wasm --target {TARGET} --package dapple-web --lib --crate-type cdylib"
    );
    build.env("RUSTFLAGS", flags.trim()).run()?;
    let target = env::var_os("CARGO_TARGET_DIR").map_or("target".into(), PathBuf::from);
    let target = shell.current_dir().join(target);
    Ok(target.join(TARGET).join("wasm/dapple_web.wasm"))
}

/// Returns all files of a folder, sorted.
fn files(shell: &Shell, folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for path in shell.read_dir(folder)? {
        if path.is_dir() {
            found.extend(files(shell, &path)?);
        } else {
            found.push(path);
        }
    }
    Ok(found)
}
