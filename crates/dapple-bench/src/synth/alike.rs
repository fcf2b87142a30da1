//! The likeness of textures to their exemplars, ours beside `texture-synthesis`.
//!
//! Measured are sliced Wasserstein distances (`Likeness`) between images of 256×256 pixels and their exemplars, for
//! colors and for 5×5 patches, with the default options of both sides. These are not times: a smaller number is a
//! better likeness. Bricks are always drawn; the other three exemplars are photographs if the files exist, and drawings
//! otherwise.

use super::drawings::{self, Drawing};
use super::scene::{Picture, picture};
use crate::harness::Bench;
use crate::peers::flat;
use crate::row::{Case, Must, Unit};
use anyhow::Result;
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use dapple_synth::{Edges, Exemplar, Likeness, Options, synthesize_plane};

const COLORS: Case = Case {
    group: "synth",
    case: "likeness of colors, bricks",
    peer: "texture-synthesis",
    unit: Unit::Thousandths,
    must: Must::CostAtMost(0.7),
    note: "",
};

const PATCHES: Case = Case {
    case: "likeness of patches, bricks",
    ..COLORS
};

/// An exemplar: a photograph, a drawing that replaces it if the file is missing, and its two rows.
struct Subject {
    file: &'static str,
    drawing: Drawing,
    colors: Case,
    patches: Case,
}

const SUBJECTS: [Subject; 4] = [
    Subject {
        file: "",
        drawing: drawings::bricks,
        colors: COLORS,
        patches: PATCHES,
    },
    Subject {
        file: "exemplars/grass_cc0_128.png",
        drawing: drawings::weave,
        colors: Case {
            case: "likeness of colors, grass or else weave",
            ..COLORS
        },
        patches: Case {
            case: "likeness of patches, grass or else weave",
            ..PATCHES
        },
    },
    Subject {
        file: "exemplars/leaves_cc0_128.png",
        drawing: drawings::scales,
        colors: Case {
            case: "likeness of colors, leaves or else scales",
            ..COLORS
        },
        patches: Case {
            case: "likeness of patches, leaves or else scales",
            ..PATCHES
        },
    },
    Subject {
        file: "exemplars/rock023_cc0_128.png",
        drawing: drawings::puzzle,
        colors: Case {
            case: "likeness of colors, rock or else puzzle pieces",
            ..COLORS
        },
        patches: Case {
            case: "likeness of patches, rock or else puzzle pieces",
            ..PATCHES
        },
    },
];

/// Width and height of an exemplar in pixels.
const EXEMPLAR: u32 = 128;

/// Width and height of a made image in pixels.
const SIDE: u32 = 256;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    for subject in &SUBJECTS {
        let Subject {
            colors, patches, ..
        } = subject;
        if !bench.wants_any(&[*colors, *patches]) {
            continue;
        }
        let picture = subject.picture()?;
        let note = if picture.is_photograph {
            "a photograph, 128²; images have 256² pixels"
        } else {
            "a drawing, 128²; images have 256² pixels"
        };
        let [ours, theirs] = likenesses(&picture)?;
        for (case, ours, theirs) in [
            (colors, ours.colors, theirs.colors),
            (patches, ours.patches, theirs.patches),
        ] {
            if bench.wants(case) {
                bench.measured(&Case { note, ..*case }, ours, theirs);
            }
        }
    }
    Ok(())
}

impl Subject {
    fn picture(&self) -> Result<Picture> {
        picture(self.file, self.drawing, EXEMPLAR)
    }
}

/// Returns the likeness to an exemplar of our image and of the peer's.
fn likenesses(picture: &Picture) -> Result<[Likeness; 2]> {
    let exemplar = picture.exemplar()?;
    let ours = synthesize_plane(&exemplar, [SIDE; 2], [Edges::Cut; 2], &Options::default())?;
    let (_, theirs) = flat::synthesize(&picture.image, SIDE)?;
    let likeness = |image: &Raster<LinearRgb>| -> Result<Likeness> {
        Ok(Likeness::new(
            &exemplar,
            &Exemplar::new(image, Edges::Cut)?,
        )?)
    };
    Ok([
        likeness(&ours.transfer(&picture.image)?)?,
        likeness(&theirs)?,
    ])
}
