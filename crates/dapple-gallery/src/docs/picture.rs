//! Helpers shared by all strips: images with few shades, whose files are small, and rows of images.

use crate::draw::shrink;
use crate::figures::{figures, lit};
use crate::{Panel, Picture};
use anyhow::Context;
use dapple_color::{Code, LinearRgb};
use dapple_raster::{Field, Raster, Window};
use dapple_recipe::Recipe;
use glam::DVec2;

/// Width and height of an image, in pixels.
pub(super) const SIDE: u32 = 92;

/// Width and height, in pixels, of an image of dots, lines or flat areas, which compresses well.
pub(super) const LARGE: u32 = 108;

/// Number of samples along each side of a pixel, for images with edges.
pub(super) const SAMPLES: u32 = 3;

/// Number of gray levels in a smooth image; with fewer, steps would be visible.
pub(super) const SMOOTH_GRAYS: f32 = 32.0;

/// Number of gray levels in other images; a file with all 256 levels is several times as large.
pub(super) const GRAYS: f32 = 16.0;

/// Number of shades per channel in a color image.
pub(super) const COLORS: f32 = 10.0;

/// Height of an image in a README, in pixels.
pub(super) const BANNER: u32 = 96;

/// Gap between the images of a row, in pixels.
const GAP: u32 = 8;

/// Returns a square window, `units` wide and centered at the origin, with `side` × `side` pixels.
pub(super) fn square(units: f64, side: u32) -> anyhow::Result<Window> {
    let corner = DVec2::splat(-0.5 * units);
    Ok(Window::new(corner, DVec2::splat(units), [side; 2])?)
}

/// Renders a smooth field with values from 0 to 1.
pub(super) fn smooth(label: &str, field: &dyn Field, window: &Window) -> anyhow::Result<Panel> {
    Ok(shaded(label, &field.to_raster(window)?, SMOOTH_GRAYS))
}

/// Renders a field with edges, with values from 0 to 1, by supersampling. `window` is the window of the finished
/// image.
pub(super) fn edged(label: &str, field: &dyn Field, window: &Window) -> anyhow::Result<Panel> {
    let fine = field.to_raster(&finer(window)?)?;
    Ok(shaded(label, &shrink(&fine, SAMPLES)?, GRAYS))
}

/// Returns the window of all samples, with [`SAMPLES`] along each side of a pixel.
pub(super) fn finer(window: &Window) -> anyhow::Result<Window> {
    let size = window.size.map(|pixels| pixels * SAMPLES);
    let extent = DVec2::from(window.size.map(f64::from)) * DVec2::from(window.pixel);
    Ok(Window::new(window.origin, extent, size)?)
}

/// Returns a gray image with the given number of shades.
pub(super) fn shaded(label: &str, raster: &Raster<f32>, shades: f32) -> Panel {
    Panel::gray(label, raster.map(|&value| rounded(value, shades)))
}

/// Returns a color image with the given number of shades in each sRGB channel.
pub(super) fn colored(label: &str, raster: &Raster<LinearRgb>, shades: f32) -> Panel {
    let colors = raster.map(|color| {
        let codes = color
            .to_srgb::<u8>()
            .map(|code| u8::from_unit(rounded(f32::from(code) / 255.0, shades)));
        LinearRgb::from_srgb(codes)
    });
    Panel::color(label, colors)
}

/// Rounds a value from 0 to 1 to the nearest of `shades` evenly spaced shades.
pub(super) fn rounded(value: f32, shades: f32) -> f32 {
    let last = shades - 1.0;
    (value.clamp(0.0, 1.0) * last).round() / last
}

/// Returns panels of figures, scaled to `height` pixels. Each entry of `places` is the name of a figure and the index
/// of its panel, starting at 0.
pub(super) fn of_figures(places: &[(&str, usize)], height: u32) -> anyhow::Result<Vec<Panel>> {
    places
        .iter()
        .map(|&(name, panel)| of_figure(name, panel, height))
        .collect()
}

fn of_figure(name: &str, number: usize, height: u32) -> anyhow::Result<Panel> {
    let figure = figures()
        .find(|figure| figure.name() == name)
        .with_context(|| format!("no figure {name}"))?;
    let panel = |size| -> anyhow::Result<Panel> {
        let panel = figure.render(size)?.into_iter().nth(number);
        panel.with_context(|| format!("too few panels in {name}"))
    };
    let first = panel(height)?;
    match first.size() {
        [_, found] if found < height => panel((height * height).div_ceil(found)),
        _ => Ok(first),
    }
}

/// Returns the upper left quarter of a built-in recipe's tile, lit, with `side` × `side` pixels.
pub(super) fn lit_recipe(name: &str, side: u32) -> anyhow::Result<Panel> {
    let recipe = Recipe::builtin(name)?;
    let [width, height] = recipe.extent;
    // Half of the shorter side of the tile is `side` pixels long.
    let longer = width.max(height) / width.min(height) * f64::from(2 * side);
    let tile = lit(&recipe, longer.ceil() as u32)?;
    Ok(Panel::color(name, tile.crop([0, 0], [side; 2])?))
}

/// Joins panels of figures in a row, as the image for a README.
pub(super) fn banner(figures: &[(&str, usize)]) -> anyhow::Result<Panel> {
    banner_of(&of_figures(figures, BANNER)?)
}

/// Joins panels in a row, as the image for a README.
pub(super) fn banner_of(panels: &[Panel]) -> anyhow::Result<Panel> {
    Ok(colored("", &row(panels)?, COLORS))
}

/// Joins images in a row with white gaps, cropped to the smallest height.
pub(super) fn row(panels: &[Panel]) -> anyhow::Result<Raster<LinearRgb>> {
    let height = panels.iter().map(|panel| panel.size()[1]).min();
    let height = height.context("there is no picture for the row")?;
    let widths: u32 = panels.iter().map(|panel| panel.size()[0] + GAP).sum();
    let width = widths - GAP;
    let mut row = Raster::filled([width, height], LinearRgb::WHITE)?;
    let mut left = 0;
    for panel in panels {
        let picture = in_color(panel);
        let mut place = row.view_mut().crop([left, 0], [picture.width(), height])?;
        for (number, pixels) in (0..).zip(place.rows_mut()) {
            pixels.copy_from_slice(picture.row(number));
        }
        left += picture.width() + GAP;
    }
    Ok(row)
}

/// Stacks rows of the same width with white gaps.
pub(super) fn below(rows: &[Raster<LinearRgb>]) -> anyhow::Result<Raster<LinearRgb>> {
    let width = rows.first().context("there is no row")?.width();
    let mut pixels = Vec::new();
    for (number, row) in rows.iter().enumerate() {
        if number > 0 {
            pixels.resize(pixels.len() + (GAP * width) as usize, LinearRgb::WHITE);
        }
        pixels.extend_from_slice(row.pixels());
    }
    let heights: u32 = rows.iter().map(|row| row.height() + GAP).sum();
    Ok(Raster::from_vec([width, heights - GAP], pixels)?)
}

fn in_color(panel: &Panel) -> Raster<LinearRgb> {
    match &panel.picture {
        Picture::Color(colors) => colors.clone(),
        Picture::Gray(shades) => {
            shades.map(|&shade| LinearRgb::from_srgb([u8::from_unit(shade); 3]))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{GAP, below, row, shaded};
    use crate::Panel;
    use dapple_color::LinearRgb;
    use dapple_raster::Raster;

    #[test]
    fn shaded_pictures_have_so_many_shades() {
        let ramp = Raster::from_fn([256, 1], |column, _| column as f32 / 255.0).unwrap();
        let mut bytes = shaded("", &ramp, 5.0).bytes();
        bytes.dedup();
        assert_eq!(bytes, [0, 64, 128, 191, 255]);
    }

    #[test]
    fn rows_have_white_between_pictures_and_the_height_of_the_lowest() {
        let dark = |size| Panel::gray("", Raster::filled(size, 0.0).unwrap());
        let row = row(&[dark([3, 2]), dark([1, 4])]).unwrap();
        assert_eq!(row.size(), [4 + GAP, 2]);
        let n_white = row
            .pixels()
            .iter()
            .filter(|&&color| color == LinearRgb::WHITE);
        assert_eq!(n_white.count(), 2 * GAP as usize);
        assert!(super::row(&[]).is_err(), "a row of nothing");
    }

    #[test]
    fn rows_stand_below_each_other_and_are_of_one_width() {
        let white = |size| Raster::filled(size, LinearRgb::WHITE).unwrap();
        assert_eq!(
            below(&[white([3, 2]), white([3, 1])]).unwrap().size(),
            [3, 3 + GAP]
        );
        assert!(below(&[white([3, 2]), white([2, 1])]).is_err(), "widths");
        assert!(below(&[]).is_err(), "no row");
    }
}
