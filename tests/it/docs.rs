//! The pictures in the documentation of the crates: they are as made now, small, and shown.
//!
//! `cargo xtask gallery --docs` rewrites them.
#![expect(
    clippy::disallowed_methods,
    reason = "the pictures are files beside the source"
)]

use dapple_gallery::docs::{DOCUMENTED, Documented, Strip, split};
use dapple_image::{Limits, PngImage, decode_png};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// What all pictures of a crate may have together, in bytes of Markdown: a user downloads them with the source.
const BYTES_MAX: u64 = 300_000;

fn folder(documented: &Documented, name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    root.join("crates").join(documented.package).join(name)
}

/// The text of a strip, and its decoded pictures: how they were packed may change with the library that does it.
fn decoded(markdown: &str) -> (String, Vec<PngImage>) {
    let (text, files) = split(markdown).expect("base64");
    let images = files
        .iter()
        .map(|file| decode_png(file, &Limits::default()).expect("a PNG file"));
    (text, images.collect())
}

fn is_as_made_now(documented: &Documented, strip: &Strip) -> bool {
    let path = folder(documented, "docs").join(format!("{}.md", strip.name));
    let made = strip.markdown().expect("the strip renders");
    fs::read_to_string(path).is_ok_and(|kept| decoded(&kept) == decoded(&made))
}

#[test]
fn docs_pictures_are_as_made_now() {
    for documented in DOCUMENTED {
        let strips = documented.strips.iter();
        let old: Vec<_> = strips
            .filter(|strip| !is_as_made_now(documented, strip))
            .map(|strip| strip.name)
            .collect();
        assert!(
            old.is_empty(),
            "{}/docs: {old:?} are not as made now; accept them with `cargo xtask gallery --docs`",
            documented.package
        );
    }
}

#[test]
fn docs_folders_hold_the_strips_and_nothing_else_and_are_small() {
    for documented in DOCUMENTED {
        let strips = documented.strips.iter();
        let expected: BTreeSet<_> = strips.map(|strip| format!("{}.md", strip.name)).collect();
        let mut found = BTreeSet::new();
        let mut n_bytes = 0;
        for entry in fs::read_dir(folder(documented, "docs")).expect("the folder is there") {
            let entry = entry.expect("the folder can be read");
            n_bytes += entry.metadata().expect("a file").len();
            found.insert(entry.file_name().to_string_lossy().into_owned());
        }
        assert_eq!(found, expected, "{}/docs", documented.package);
        assert!(n_bytes <= BYTES_MAX, "{n_bytes} bytes are too many");
    }
}

#[test]
fn docs_pictures_are_all_shown_by_the_source() {
    for documented in DOCUMENTED {
        let mut sources = String::new();
        for entry in fs::read_dir(folder(documented, "src")).expect("the source is there") {
            let path = entry.expect("the folder can be read").path();
            if path.is_file() {
                sources += &fs::read_to_string(path).expect("a source file");
            }
        }
        for strip in documented.strips {
            let attribute = format!(
                "#[cfg_attr(doc, doc = include_str!(\"../docs/{}.md\"))]",
                strip.name
            );
            assert!(sources.contains(&attribute), "nothing shows {}", strip.name);
        }
    }
}
