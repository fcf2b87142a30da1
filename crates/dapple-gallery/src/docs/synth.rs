//! Renders the rows of images for the documentation of `dapple-synth`.

use super::picture::{BANNER, COLORS, banner_of, colored, of_figures};
use super::{Documented, Strip};
use crate::Panel;
use crate::figures::surface::exemplar::{EXEMPLARS, Edges as Ends};
use anyhow::Context;
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use dapple_synth::{Coherence, Edges, Exemplar, Options, synthesize_plane};

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-synth",
    strips: &[PLANE, COHERENCE],
    banner: || {
        let (image, exemplar) = exemplar("woven hooks")?;
        let options = Options::default();
        let mut panels = vec![
            on_white(&image)?,
            grown("", &image, &exemplar, BANNER, &options)?,
        ];
        panels.extend(of_figures(
            &[("surface-fig-01", 1), ("surface-fig-01", 2)],
            BANNER,
        )?);
        banner_of(&panels)
    },
};

/// Width and height of a texture, in pixels.
const SMALL: u32 = 80;

const PLANE: Strip = Strip {
    name: "synthesize-plane",
    caption: "",
    render: || {
        let (image, exemplar) = exemplar("woven hooks")?;
        let grown = grown("the texture", &image, &exemplar, SMALL, &Options::default())?;
        Ok(vec![colored("an exemplar", &image, COLORS), grown])
    },
};

const COHERENCE: Strip = Strip {
    name: "coherence",
    caption: "Coherence",
    render: || {
        let (image, exemplar) = exemplar("scales")?;
        [("0, as in the paper", 0.0), ("2", 2.0), ("8", 8.0)]
            .into_iter()
            .map(|(label, coherence)| {
                let options = Options {
                    coherence: Coherence::Factor(coherence),
                    ..Options::default()
                };
                grown(label, &image, &exemplar, SMALL, &options)
            })
            .collect()
    },
};

/// Draws one of the figures' exemplars with 64 × 64 pixels; returns the image and the exemplar built from it.
fn exemplar(name: &str) -> anyhow::Result<(Raster<LinearRgb>, Exemplar)> {
    let of_figures = EXEMPLARS.iter().find(|exemplar| exemplar.name == name);
    let exemplar = of_figures.with_context(|| format!("no exemplar {name}"))?;
    let image = (exemplar.draw)(64)?;
    let edges = match exemplar.edges {
        Ends::Repeating => Edges::Wrap,
        Ends::Cropped => Edges::Cut,
    };
    let exemplar = Exemplar::new(&image, edges)?;
    Ok((image, exemplar))
}

/// Synthesizes a texture that tiles.
fn grown(
    label: &str,
    image: &Raster<LinearRgb>,
    exemplar: &Exemplar,
    side: u32,
    options: &Options,
) -> anyhow::Result<Panel> {
    let texture = synthesize_plane(exemplar, [side; 2], [Edges::Wrap; 2], options)?;
    let colors = texture.transfer(image)?;
    Ok(colored(label, &colors, COLORS))
}

/// Returns an exemplar centered on a white image that is as high as the other images of its row.
fn on_white(image: &Raster<LinearRgb>) -> anyhow::Result<Panel> {
    let [width, height] = image.size();
    let above = BANNER.saturating_sub(height) / 2;
    let white = Raster::from_fn([width, BANNER.max(height)], |column, row| {
        match row.checked_sub(above) {
            Some(row) if row < height => image.row(row)[column as usize],
            _ => LinearRgb::WHITE,
        }
    })?;
    Ok(Panel::color("", white))
}
