//! Points assigned to groups according to their location: the probability of white rises from left to right.

use super::picture_of_labels;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{LabelRampOptions, hash::Seed, label_ramp};

pub(super) const FIGURE: Figure = Figure {
    number: "17",
    parameters: &[
        ("minimum distance", "0.05"),
        ("probability of white", "0 on the left to 1 on the right"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let texture = label_ramp(&LabelRampOptions::default(), Seed(17))?;
    Ok(vec![
        picture_of_labels("", &texture, size)?.repeating_along([false, true]),
    ])
}
