//! Checks that the images in the crates' documentation are up to date, small, and included.
//!
//! `cargo xtask docs-images` rewrites them.
#![expect(
    clippy::disallowed_methods,
    reason = "the pictures are files beside the source"
)]

use dapple_gallery::docs::{Documented, documented};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Maximum total size of a crate's images, in bytes. Users download the images with the source.
const BYTES_MAX: u64 = 360_000;

fn folder(documented: &Documented, name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    root.join(documented.folder).join(name)
}

/// Iterates over the crates that have images. The workspace's own folder `docs` is left out, since it may contain other
/// files.
fn crates() -> impl Iterator<Item = &'static Documented> {
    documented()
        .iter()
        .filter(|documented| !documented.folder.is_empty())
}

#[test]
fn docs_pictures_are_as_made_now() {
    for documented in documented() {
        let folder = folder(documented, "docs");
        let files = documented.files().expect("the pictures are made");
        let old: Vec<_> = files
            .iter()
            .filter(|file| {
                let before = fs::read(folder.join(&file.name));
                !before.is_ok_and(|before| file.shows_the_same_as(&before))
            })
            .map(|file| file.name.as_str())
            .collect();
        assert!(
            old.is_empty(),
            "{}/docs: {old:?} are not as made now; accept them with `cargo xtask docs-images`",
            documented.folder
        );
    }
}

#[test]
fn docs_folders_hold_the_pictures_and_nothing_else_and_are_small() {
    for documented in crates() {
        let strips = documented.strips.iter();
        let mut expected: BTreeSet<_> = strips.map(|strip| format!("{}.md", strip.name)).collect();
        expected.insert("gallery.png".to_owned());
        if documented.folder == "crates/dapple-recipe" {
            // The reference of all options, which `dapple recipe --reference` writes.
            expected.insert("reference.md".to_owned());
        }
        let mut found = BTreeSet::new();
        let mut n_bytes = 0;
        for entry in fs::read_dir(folder(documented, "docs")).expect("the folder is there") {
            let entry = entry.expect("the folder can be read");
            n_bytes += entry.metadata().expect("a file").len();
            found.insert(entry.file_name().to_string_lossy().into_owned());
        }
        assert_eq!(found, expected, "{}/docs", documented.folder);
        let folder = documented.folder;
        assert!(
            n_bytes <= BYTES_MAX,
            "{folder}: {n_bytes} bytes are too many"
        );
    }
}

#[test]
fn docs_pictures_are_all_shown_by_the_source() {
    for documented in crates() {
        let sources = sources(&folder(documented, "src"));
        for strip in documented.strips {
            let included = format!("docs/{}.md\"))]", strip.name);
            let shown = sources.lines().any(|line| {
                line.trim_start()
                    .starts_with("#[cfg_attr(doc, doc = include_str!(\"../")
                    && line.ends_with(&included)
            });
            assert!(shown, "{}: nothing shows {}", documented.folder, strip.name);
        }
    }
}

#[test]
fn docs_pictures_of_readmes_are_shown_by_them() {
    for documented in documented() {
        let readme = fs::read_to_string(folder(documented, "README.md")).expect("a README");
        let shown = readme
            .lines()
            .any(|line| line.starts_with("![") && line.ends_with("](docs/gallery.png)"));
        assert!(shown, "{}/README.md shows no picture", documented.folder);
    }
}

/// Returns the texts of all files in a folder and its subfolders, joined.
fn sources(folder: &Path) -> String {
    let mut text = String::new();
    for entry in fs::read_dir(folder).expect("the source is there") {
        let path = entry.expect("the folder can be read").path();
        text += &if path.is_dir() {
            sources(&path)
        } else {
            fs::read_to_string(path).expect("a source file")
        };
    }
    text
}
