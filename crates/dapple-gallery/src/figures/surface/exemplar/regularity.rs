//! Tests whether the measure behind [`Coherence::Auto`](dapple_synth::Coherence) agrees with human judgment.
//!
//! Textures of 256 × 256 pixels were synthesized from each exemplar with coherences of 0 and 2. The judgments
//! below were written down before the measure existed. Where neither texture looks better, the judgment says so.
//! Every texture that was better with 0 was also better if only the passes that read a coarser level used 0.

#![expect(clippy::disallowed_methods, reason = "photographs are read here")]

use super::{EXEMPLARS, Edges as Ends};
use dapple_color::LinearRgb;
use dapple_image::{Limits, read_image};
use dapple_raster::Raster;
use dapple_synth::{Edges, Exemplar};
use std::path::Path;

/// The coherence whose texture looks better to a person.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Better {
    /// A coherence of 0 on finer levels is better. With 2, the texture has tears.
    Least,
    /// A coherence of 2 is better. With 0, details blur or shapes melt.
    Coherent,
    Neither,
}
use Better::{Coherent, Least, Neither};

/// Judgments for the exemplars of our figures.
const OURS: [(&str, Better); 9] = [
    ("wiggly checker", Least),
    ("suckers", Least),
    ("scales", Least),
    ("woven hooks", Least),
    ("text", Neither),
    ("puzzle pieces", Coherent),
    ("color bricks", Least),
    ("stripes", Neither),
    ("letter", Neither),
];

/// Judgments for photographs and scans, identified by the beginnings of their file names.
const PHOTOGRAPHS: [(&str, Better); 15] = [
    ("grass_cc0", Coherent),
    ("ground037", Coherent),
    ("leaves", Coherent),
    ("rock023", Coherent),
    ("sand", Coherent),
    ("materialx_brass", Coherent),
    ("materialx_brick_gray", Least),
    ("materialx_brick_normal", Coherent),
    ("materialx_brick_roughness", Neither),
    ("materialx_cloth", Neither),
    ("materialx_onyx", Neither),
    ("materialx_wood", Coherent),
    ("skimage_brick", Least),
    ("skimage_grass", Coherent),
    ("skimage_gravel", Coherent),
];

/// Measures an exemplar and compares the result with the limit of [`Coherence::Auto`](dapple_synth::Coherence), 0.9.
/// Exemplars with a clear judgment are well above or below it.
fn check(name: &str, better: Better, image: &Raster<LinearRgb>, edges: Edges) {
    let regularity = Exemplar::new(image, edges).unwrap().regularity();
    println!("{regularity:.3} {better:?} {name}");
    let agrees = match better {
        Least => regularity > 0.925,
        Coherent => regularity < 0.875,
        Neither => (0.0..=1.0).contains(&regularity),
    };
    assert!(agrees, "{name}: {regularity}, but {better:?} looks better");
}

#[test]
fn regularity_says_which_coherence_looks_better_for_our_exemplars() {
    assert_eq!(OURS.len(), EXEMPLARS.len(), "one choice for each");
    for (exemplar, (name, better)) in EXEMPLARS.iter().zip(OURS) {
        assert_eq!(exemplar.name, name, "in the same order");
        let edges = match exemplar.edges {
            Ends::Repeating => Edges::Wrap,
            Ends::Cropped => Edges::Cut,
        };
        check(
            name,
            better,
            &(exemplar.draw)(exemplar.side).unwrap(),
            edges,
        );
    }
}

#[test]
fn regularity_says_which_coherence_looks_better_for_photographs() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/exemplars");
    let Ok(files) = std::fs::read_dir(&folder) else {
        println!("skipped: there are no photographs in {}", folder.display());
        return;
    };
    for file in files {
        let path = file.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let known = PHOTOGRAPHS
            .iter()
            .find(|(start, _)| name.starts_with(start));
        let image = read_image(&path, &Limits::default())
            .unwrap()
            .color()
            .unwrap();
        check(
            &name,
            known.map_or(Neither, |known| known.1),
            &image,
            Edges::Cut,
        );
    }
}
