//! The procedural materials of the figures, which replace the paper's photographs: each one lit, the height and the
//! cracks of one, and one that repeats. Then a tile of Perlin noise, and Perlin's functions of such noise.

use super::functions::{cloud, marble, wood};
use super::grass::grass;
use super::patch::Edges;
use super::pebble::pebble;
use super::perlin::perlin;
use super::soil::soil;
use super::stone::stone;
use crate::draw::shrink;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_points::hash::Seed;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        (
            "stones",
            "warped Voronoi cells of a Poisson-disk set of varying radius",
        ),
        (
            "pebbles, crumbs of soil",
            "three layers of lumps, each over the ones below",
        ),
        ("grass", "18 432 bent blades on 1.5 × 1.5 pictures"),
        ("Perlin noise", "5 octaves, 4 cells across"),
        ("marble, wood, clouds", "6 octaves, 8 cells across"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let edges = Edges::Cropped;
    let stones = stone(size, Seed(1), edges)?;
    let repeating = pebble(size, Seed(1), Edges::Repeating)?.color;
    let noise = perlin(size, 8.0, 6, Seed(5))?;
    Ok(vec![
        Panel::color("stone", stones.color),
        Panel::color("pebbles", pebble(size, Seed(1), edges)?.color),
        Panel::color("grass", grass(size, Seed(1), edges)?.color),
        Panel::color("soil", soil(size, Seed(1), edges)?.color),
        Panel::gray("the height of the stone", stones.height),
        Panel::gray("its cracks", stones.gap),
        Panel::color(
            "pebbles that repeat, 2 × 2",
            shrink(&repeating.tile([2, 2])?, 2)?,
        )
        .repeating(),
        Panel::gray("a tile of Perlin noise", perlin(size, 4.0, 5, Seed(5))?),
        Panel::color("marble", marble(&noise, 4)?),
        Panel::color("wood", wood(&noise, 14)?),
        Panel::color("clouds", cloud(&noise)?),
    ])
}
