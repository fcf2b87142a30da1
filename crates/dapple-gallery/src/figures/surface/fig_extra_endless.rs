//! Endless textures, synthesized by correcting all pixels of a level at once, below textures by the paper's sweep:
//! courses of bricks continue, strands have no loose ends, and lines of text are lines. Each image is a window of an
//! infinite texture, and any other window can be computed independently.
//!
//! References: Sylvain Lefebvre and Hugues Hoppe, "Parallel Controllable Texture Synthesis", SIGGRAPH 2005, and
//! "Appearance-Space Texture Synthesis", SIGGRAPH 2006.

use super::exemplar::cut_out;
use crate::draw::enlarged;
use crate::figure::source;
use crate::{Figure, Panel};
use core::ops::ControlFlow;
use dapple_synth::{Edges, Endless, EndlessOptions, Exemplar, Options, synthesize_plane};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("exemplars", "bricks, 128²; hooks, 64²; text, 160²"),
        ("textures", "twice as wide and high"),
    ],
    source: source!(),
    render,
};

/// Exemplars: the name, the text for the label, and the side in pixels.
const SUBJECTS: [(&str, &str, u32); 3] = [
    ("color bricks", "bricks", 128),
    ("woven hooks", "hooks", 64),
    ("text", "text", 160),
];

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let [mut above, mut below] = [Vec::new(), Vec::new()];
    for (name, label, side) in SUBJECTS {
        let image = cut_out(name, side)?;
        let exemplar = Exemplar::new(&image, Edges::Cut)?;
        let whole = [2 * side; 2];
        let sweep = synthesize_plane(&exemplar, whole, [Edges::Cut; 2], &Options::default())?;
        let endless = Endless::new(&exemplar, &EndlessOptions::default())?;
        let endless = endless.window([0; 2], whole, |_| ControlFlow::Continue(()))?;
        above.push(Panel::color(
            format!("{label}, in a sweep"),
            enlarged(&sweep.transfer(&image)?, size)?,
        ));
        below.push(Panel::color(
            format!("{label}, endless"),
            enlarged(&endless.transfer(&image)?, size)?,
        ));
    }
    above.append(&mut below);
    Ok(above)
}
