//! Implements the option `--docs`, which writes or checks the images in the crates' documentation and READMEs.
#![expect(
    clippy::disallowed_methods,
    reason = "the pictures are files beside the source"
)]

use crate::{root, say};
use anyhow::{Context, ensure};
use dapple_gallery::docs::{Documented, documented};
use std::fs;
use std::path::PathBuf;

/// Writes each changed image into the folder `docs` of its crate. Prints the total size of all images.
pub(crate) fn write() -> anyhow::Result<()> {
    for documented in documented() {
        let folder = folder(documented);
        fs::create_dir_all(&folder)
            .with_context(|| format!("cannot make the folder {}", folder.display()))?;
        let files = documented.files()?;
        for file in &files {
            let path = folder.join(&file.name);
            // Another build may compress the same pixels to different bytes.
            if !file.shows_the_same_as(&fs::read(&path).unwrap_or_default()) {
                fs::write(&path, &file.bytes)
                    .with_context(|| format!("cannot write {}", path.display()))?;
            }
        }
        let n_bytes: usize = files.iter().map(|file| file.bytes.len()).sum();
        let folder = documented.folder;
        say(&format!(
            "{} files with {n_bytes} bytes in {folder}/docs",
            files.len()
        ));
    }
    Ok(())
}

/// Fails if an image on disk differs from a newly rendered one.
pub(crate) fn check() -> anyhow::Result<()> {
    let mut old = Vec::new();
    for documented in documented() {
        let folder = folder(documented);
        for file in documented.files()? {
            let path = folder.join(&file.name);
            let before = fs::read(&path).unwrap_or_default();
            if !file.shows_the_same_as(&before) {
                say(&format!("changed  {}", path.display()));
                old.push(path);
            }
        }
    }
    ensure!(
        old.is_empty(),
        "{} pictures are not as made now; accept them with `cargo xtask docs-images`",
        old.len()
    );
    Ok(())
}

fn folder(documented: &Documented) -> PathBuf {
    root().join(documented.folder).join("docs")
}
