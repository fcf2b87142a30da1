//! Rows of documentation images about recipes with labels, which have edges.

use super::labels;
use crate::Panel;
use crate::docs::Strip;
use crate::docs::picture::{GRAYS, LARGE, shaded, square};
use crate::draw::label_gray;
use crate::figures::pups::flower::flower;
use dapple_pups::{
    CellsOptions, CowOptions, IteratedOptions, IterationPoints, LabelRampOptions,
    ProgressionOptions, ReferenceImage, ReferenceOptions, SpaceGiraffeOptions, Spacing, Spots,
    cells, cow, cow_progression, giraffe_progression, hash::Seed, iterated_reference, label_ramp,
    reference_texture, space_giraffe,
};

/// Side of an image in units of the domain: the paper's square, that is, a whole tile.
const TILE: f64 = 2.0;

pub(super) const CELLS: Strip = Strip {
    name: "cells",
    caption: "With random orientations",
    render: || {
        [
            ("of one control point", CellsOptions::default()),
            ("of three or four", CellsOptions::of_three_or_four()),
        ]
        .into_iter()
        .map(|(label, options)| {
            let texture = cells(&options, Seed(9))?;
            let shades = (0..).take(texture.values().len()).map(label_gray);
            labels(label, 1.2, &texture.with_values(shades.collect())?)
        })
        .collect()
    },
};

pub(super) const COW: Strip = Strip {
    name: "cow",
    caption: "A tile each, probability of white",
    render: || {
        [("0.5", 0.5), ("0.25", 0.25)]
            .into_iter()
            .map(|(label, probability)| {
                let options = CowOptions {
                    probability: probability.into(),
                    ..CowOptions::default()
                };
                labels(label, TILE, &cow(&options, Seed(11))?)
            })
            .collect()
    },
};

pub(super) const SPACE_GIRAFFE: Strip = Strip {
    name: "space-giraffe",
    caption: "A tile each, pairs of points around a center",
    render: || {
        [("10 to 20", [10, 20]), ("4 to 6", [4, 6])]
            .into_iter()
            .map(|(label, pairs)| giraffe(label, pairs, Spots::Separated))
            .collect()
    },
};

pub(super) const SPOTS: Strip = Strip {
    name: "spots",
    caption: "A tile each",
    render: || {
        [("separated", Spots::Separated), ("literal", Spots::Literal)]
            .into_iter()
            .map(|(label, spots)| giraffe(label, [10, 20], spots))
            .collect()
    },
};

pub(super) const REFERENCE: Strip = Strip {
    name: "reference-texture",
    caption: "",
    render: || {
        let mut panels = vec![image_panel()?];
        for (label, distance) in [("distance 0.1", 0.1), ("distance 0.025", 0.025)] {
            let options = ReferenceOptions {
                spacing: Spacing::from(distance),
                ..ReferenceOptions::default()
            };
            let texture = reference_texture(&image()?, &options, Seed(13))?;
            panels.push(labels(label, TILE, &texture)?);
        }
        Ok(panels)
    },
};

pub(super) const ITERATED: Strip = Strip {
    name: "iterated-reference",
    caption: "",
    render: || {
        let iterations = iterated_reference(&image()?, &IteratedOptions::default(), Seed(14))?;
        let mut panels = vec![image_panel()?];
        for (label, index) in [("iteration 1", 0), ("iteration 2", 1), ("iteration 4", 3)] {
            panels.push(labels(label, TILE, &iterations[index])?);
        }
        Ok(panels)
    },
};

pub(super) const ITERATION_POINTS: Strip = Strip {
    name: "iteration-points",
    caption: "Iteration 4",
    render: || {
        [
            ("fresh points", IterationPoints::Fresh),
            ("nested points", IterationPoints::Nested),
        ]
        .into_iter()
        .map(|(label, points)| {
            let options = IteratedOptions {
                points,
                ..IteratedOptions::default()
            };
            let iterations = iterated_reference(&image()?, &options, Seed(14))?;
            labels(label, TILE, &iterations[3])
        })
        .collect()
    },
};

pub(super) const COW_PROGRESSION: Strip = Strip {
    name: "cow-progression",
    caption: "",
    render: || {
        let texture = cow_progression(&ProgressionOptions::default(), Seed(15))?;
        Ok(vec![labels("distances from 0.2 to 0.025", TILE, &texture)?])
    },
};

pub(super) const GIRAFFE_PROGRESSION: Strip = Strip {
    name: "giraffe-progression",
    caption: "",
    render: || {
        let options = ProgressionOptions {
            distances: [0.4, 0.08],
            ..ProgressionOptions::default()
        };
        let texture = giraffe_progression(&options, Seed(16))?;
        Ok(vec![labels("distances from 0.4 to 0.08", TILE, &texture)?])
    },
};

pub(super) const LABEL_RAMP: Strip = Strip {
    name: "label-ramp",
    caption: "",
    render: || {
        let texture = label_ramp(&LabelRampOptions::default(), Seed(17))?;
        Ok(vec![labels("probabilities from 0 to 1", TILE, &texture)?])
    },
};

fn giraffe(label: &str, pairs: [u32; 2], spots: Spots) -> anyhow::Result<Panel> {
    let options = SpaceGiraffeOptions {
        pairs,
        spots,
        ..SpaceGiraffeOptions::default()
    };
    labels(label, TILE, &space_giraffe(&options, Seed(12))?)
}

/// Returns the flower of figure 13 as a reference image.
fn image() -> anyhow::Result<ReferenceImage> {
    Ok(ReferenceImage::new(flower(&square(TILE, 256)?)?)?)
}

fn image_panel() -> anyhow::Result<Panel> {
    let flower = flower(&square(TILE, LARGE)?)?;
    Ok(shaded("the reference image", &flower, GRAYS))
}
