//! Chooses the output folder of the examples: the first argument, or `target/examples-out`.

use std::io;
use std::path::{Path, PathBuf};

/// Returns the path of the file called `name` in the output folder, which is created if it does not exist.
#[expect(clippy::disallowed_methods, reason = "an example writes files")]
pub(crate) fn path(name: &str) -> io::Result<PathBuf> {
    let folder = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from("target/examples-out"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    Ok(folder.join(name))
}

/// Prints the path of a written file.
#[expect(clippy::print_stdout, reason = "an example talks")]
pub(crate) fn wrote(path: &Path) {
    println!("wrote {}", path.display());
}
