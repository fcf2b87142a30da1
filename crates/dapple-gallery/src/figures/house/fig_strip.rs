//! The picture of the README: some figures in a row.
//!
//! Remade by `cargo xtask gallery house-fig-strip --size 1080`, and copied from there to `docs/gallery.png`.

use crate::figure::source;
use crate::figures::figures;
use crate::{Figure, Panel, Picture};
use anyhow::Context;
use dapple_color::{Code, LinearRgb};
use dapple_raster::Raster;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[("figures", "2, 5c, 8, colors, 14 and 15")],
    source: source!(),
    render,
};

/// The names of figures, and which panel of each.
const ROW: [(&str, usize); 6] = [
    ("pups-fig-02", 0),
    ("pups-fig-05", 2),
    ("pups-fig-08", 0),
    ("pups-fig-extra-colors", 0),
    ("pups-fig-14", 3),
    ("pups-fig-15", 0),
];

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let n = ROW.len() as u32;
    let side = (size.saturating_sub((n - 1) * (size / 100)) / n).max(1);
    let mut strip = Raster::filled([size, side], LinearRgb::WHITE)?;
    for (place, (name, panel)) in (0..).zip(ROW) {
        let picture = picture(name, panel, side)?;
        let left = (size.saturating_sub(side) * place / (n - 1)) as usize;
        for row in 0..side {
            let start = row as usize * size as usize + left;
            strip.pixels_mut()[start..start + side as usize].copy_from_slice(picture.row(row));
        }
    }
    Ok(vec![Panel::color("", strip)])
}

/// One panel of a figure, in color.
fn picture(name: &str, panel: usize, size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let figure = figures().find(|figure| figure.name() == name);
    let panels = figure
        .with_context(|| format!("no figure {name}"))?
        .render(size)?;
    let panel = panels.into_iter().nth(panel);
    let panel = panel.with_context(|| format!("too few panels in {name}"))?;
    Ok(match panel.picture {
        Picture::Color(colors) => colors,
        Picture::Gray(shades) => {
            shades.map(|&shade| LinearRgb::from_srgb([u8::from_unit(shade); 3]))
        }
    })
}
