//! Measures how similar textures are to their exemplars, ours compared with `texture-synthesis`.
//!
//! The rows report sliced Wasserstein distances (`Likeness`) between images of 256×256 pixels and their exemplars, for
//! colors and for 5×5 patches, with the default options of both sides. These are not times: a smaller number is a
//! better match. Bricks are always drawn. The other three exemplars are photographs if the files exist, and drawings
//! otherwise.

use super::drawings::{self, Drawing};
use super::scene::{Picture, picture};
use crate::harness::Bench;
use crate::peers::flat;
use crate::row::{Case, Goal, Unit};
use anyhow::Result;
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use dapple_synth::{Edges, Endless, EndlessOptions, Exemplar, Likeness, Options, synthesize_plane};

const COLORS: Case = Case {
    group: "synth",
    case: "likeness of colors, bricks",
    peer: "texture-synthesis",
    unit: Unit::Thousandths,
    must: Goal::CostAtMost(0.7),
    note: "",
};

/// An exemplar and its rows. The exemplar is a photograph, or a drawing if the file of the photograph is missing. The
/// rows compare the colors and patches of two textures: one synthesized by a sweep, and an endless one.
struct Subject {
    file: &'static str,
    drawing: Drawing,
    rows: [[Case; 2]; 2],
}

const fn row(case: &'static str) -> Case {
    Case { case, ..COLORS }
}

const SUBJECTS: [Subject; 4] = [
    Subject {
        file: "",
        drawing: drawings::bricks,
        rows: [
            [COLORS, row("likeness of patches, bricks")],
            [
                row("likeness of colors, bricks, endless"),
                row("likeness of patches, bricks, endless"),
            ],
        ],
    },
    Subject {
        file: "exemplars/grass_cc0_128.png",
        drawing: drawings::weave,
        rows: [
            [
                row("likeness of colors, grass or else weave"),
                row("likeness of patches, grass or else weave"),
            ],
            [
                row("likeness of colors, grass or else weave, endless"),
                row("likeness of patches, grass or else weave, endless"),
            ],
        ],
    },
    Subject {
        file: "exemplars/leaves_cc0_128.png",
        drawing: drawings::scales,
        rows: [
            [
                row("likeness of colors, leaves or else scales"),
                row("likeness of patches, leaves or else scales"),
            ],
            [
                row("likeness of colors, leaves or else scales, endless"),
                row("likeness of patches, leaves or else scales, endless"),
            ],
        ],
    },
    Subject {
        file: "exemplars/rock023_cc0_128.png",
        drawing: drawings::puzzle,
        rows: [
            [
                row("likeness of colors, rock or else puzzle pieces"),
                row("likeness of patches, rock or else puzzle pieces"),
            ],
            [
                row("likeness of colors, rock or else puzzle pieces, endless"),
                row("likeness of patches, rock or else puzzle pieces, endless"),
            ],
        ],
    },
];

/// Width and height of an exemplar in pixels.
const EXEMPLAR: u32 = 128;

/// Width and height of a synthesized image in pixels.
const SIDE: u32 = 256;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    for subject in &SUBJECTS {
        if !bench.wants_any(&subject.rows.concat()) {
            continue;
        }
        let picture = picture(subject.file, subject.drawing, EXEMPLAR)?;
        let note = if picture.is_photograph {
            "a photograph, 128²; images have 256² pixels"
        } else {
            "a drawing, 128²; images have 256² pixels"
        };
        let [ours @ .., theirs] = likenesses(&picture)?;
        for (rows, ours) in subject.rows.iter().zip(ours) {
            let pairs = [(ours.colors, theirs.colors), (ours.patches, theirs.patches)];
            for (case, (ours, theirs)) in rows.iter().zip(pairs) {
                if bench.wants(case) {
                    bench.measured(&Case { note, ..*case }, ours, theirs);
                }
            }
        }
    }
    Ok(())
}

/// Returns the distances from an exemplar to three images: ours by a sweep, our endless texture, and the peer's.
fn likenesses(picture: &Picture) -> Result<[Likeness; 3]> {
    let exemplar = picture.exemplar()?;
    let sweep = synthesize_plane(&exemplar, [SIDE; 2], [Edges::Cut; 2], &Options::default())?;
    let endless = Endless::new(&exemplar, &EndlessOptions::default())?;
    let endless = endless.window([0; 2], [SIDE; 2], |_| ControlFlow::Continue(()))?;
    let (_, theirs) = flat::synthesize(&picture.image, SIDE)?;
    let likeness = |image: &Raster<LinearRgb>| -> Result<Likeness> {
        Ok(Likeness::new(
            &exemplar,
            &Exemplar::new(image, Edges::Cut)?,
        )?)
    };
    Ok([
        likeness(&sweep.transfer(&picture.image)?)?,
        likeness(&endless.transfer(&picture.image)?)?,
        likeness(&theirs)?,
    ])
}
