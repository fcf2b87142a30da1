//! `--docs`: the pictures in the documentation of the crates.
#![expect(
    clippy::disallowed_methods,
    reason = "the pictures are files beside the source"
)]

use crate::{root, say};
use anyhow::Context;
use dapple_gallery::docs::DOCUMENTED;
use std::fs;

/// Writes every strip into the folder `docs` of its crate, and says how large they are.
pub(crate) fn write() -> anyhow::Result<()> {
    for documented in DOCUMENTED {
        let package = documented.package;
        let folder = root().join("crates").join(package).join("docs");
        fs::create_dir_all(&folder)
            .with_context(|| format!("cannot make the folder {}", folder.display()))?;
        let mut n_bytes = 0;
        for strip in documented.strips {
            let markdown = strip.markdown()?;
            let path = folder.join(format!("{}.md", strip.name));
            n_bytes += markdown.len();
            fs::write(&path, markdown)
                .with_context(|| format!("cannot write {}", path.display()))?;
        }
        say(&format!(
            "{} strips with {n_bytes} bytes for {package}",
            documented.strips.len()
        ));
    }
    Ok(())
}
