//! Points on orbits: three images of a loop in time, and the rate of change of a line of the texture through the whole
//! loop (time goes down). Where the triangulation changes, the line jumps, unless the axes of an edge fade before it
//! disappears.
//!
//! "The main difficulty here lies in smoothing out sudden changes in the texture arising from sudden changes in the
//! control net topology" (section 5). The fading axes are compared with the same moving points with axes that do not
//! fade.

use super::{picture, square};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{NetOptions, NoiseOptions, Orbits, Pups, Spacing, Texture, hash::Seed, noise};
use dapple_raster::{Field, Raster, Window};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("minimum distance", "0.2"),
        ("radius of the orbits", "0.25 of the mean distance"),
        ("fade", "0.25"),
    ],
    source: source!(),
    render,
};

/// Rate of change that is drawn as white, in values per loop.
const WHITE: f32 = 8.0;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let mut panels = Vec::new();
    for (label, time) in [
        ("time 0", 0.0),
        ("time 1/3", 1.0 / 3.0),
        ("time 2/3", 2.0 / 3.0),
    ] {
        panels.push(picture(label, &moving(time)?, size)?);
    }
    let window = square(size)?.crop([0, i64::from(size / 2)], [size, 1])?;
    let fading = through_time(&window, size, moving)?;
    let jumping = through_time(&window, size, |time| still(&moving(time)?))?;
    for (label, lines) in [
        ("change in time, without fading", &jumping),
        ("change in time, with fading", &fading),
    ] {
        panels.push(Panel::gray(label, changes(lines)?).repeating());
    }
    Ok(panels)
}

/// Returns the texture at a time within the loop, from 0 to 1.
fn moving(time: f64) -> anyhow::Result<Texture> {
    let options = NoiseOptions {
        spacing: Spacing::from(0.2),
        net: NetOptions {
            motion: Some(Orbits { radius: 0.25 }),
            time,
            ..NetOptions::default()
        },
        ..NoiseOptions::default()
    };
    Ok(noise(&options, Seed(4))?)
}

/// Returns a copy of a texture with the same points and values, but without fading axes.
fn still(texture: &Texture) -> anyhow::Result<Texture> {
    let pups = Pups::delaunay(texture.pups().points())?;
    Ok(pups.texture(texture.values().to_vec())?)
}

/// Stacks renderings of one line of pixels, one row for each of `n_times` times that are evenly spaced over the loop.
fn through_time(
    line: &Window,
    n_times: u32,
    texture: impl Fn(f64) -> anyhow::Result<Texture>,
) -> anyhow::Result<Raster<f32>> {
    let mut lines = Vec::new();
    for row in 0..n_times {
        let time = f64::from(row) / f64::from(n_times);
        lines.extend_from_slice(texture(time)?.to_raster(line)?.pixels());
    }
    Ok(Raster::from_vec([line.size[0], n_times], lines)?)
}

/// Returns the rate of change from each row to the next. The first row is compared with the last.
fn changes(lines: &Raster<f32>) -> anyhow::Result<Raster<f32>> {
    let [width, height] = lines.size();
    let per_difference = height as f32 / WHITE;
    Ok(Raster::from_fn([width, height], |x, y| {
        let above = lines.row((y + height - 1) % height)[x as usize];
        ((lines.row(y)[x as usize] - above).abs() * per_difference).min(1.0)
    })?)
}
