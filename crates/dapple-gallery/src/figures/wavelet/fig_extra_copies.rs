//! Maps of more than one tile: copies of one tile, copies disturbed inside of their borders, unlike tiles given the same
//! borders, and corner tiles.
//!
//! Copies show their repetition. Disturbed, each keeps the border of the tile and has an inside of its own. Unlike tiles fit
//! in any order once they change over to one of them at their borders, and corner tiles do because an edge depends on the
//! colors of its two ends alone.

use super::tile_side;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::hash::Seed;
use dapple_raster::{Field, Raster, Window};
use dapple_tile::{CornerTiles, Disturbance, MatchBorders, repeat};
use dapple_worley::{Combination, Worley2};
use glam::DVec2;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("tile, map", "128 × 128, 512 × 512"),
        ("tiles", "F2 − F1 with 4, and 7, cells across"),
        ("frozen, ramp", "8, 24 pixels"),
        ("width of matched borders", "32 pixels"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let side = tile_side(size);
    let tiles = [cracks(4, side)?, cracks(7, side)?];
    let disturbance = Disturbance {
        frozen: side / 16,
        ramp: side / 16 * 3,
        seed: Seed(2),
    };
    let matched = MatchBorders {
        width: side / 4,
        ..MatchBorders::default()
    };
    let matched = matched.apply(&tiles)?;
    let board = Raster::from_fn([size; 2], |column, row| {
        let tile = &matched[((column / side + row / side) % 2) as usize];
        tile.row(row % side)[(column % side) as usize]
    })?;
    // Whole copies repeat, and so does a board of an even number of them.
    let n_copies = size / side;
    let whole = size.is_multiple_of(side);
    Ok(vec![
        Panel::gray("copies of one tile", repeat(&tiles[0], [size; 2])?)
            .repeating_along([whole; 2]),
        Panel::gray(
            "disturbed inside of their borders",
            disturbance.render(&tiles[0], [0, 0], [size; 2])?,
        )
        .repeating_along([whole; 2]),
        Panel::gray("unlike tiles with the same borders", board)
            .repeating_along([whole && n_copies.is_multiple_of(2); 2]),
        Panel::gray(
            "corner tiles of both",
            CornerTiles::new(&tiles)?.render(Seed(3), [0, 0], [size; 2])?,
        ),
    ])
}

/// A tile of cracks between cells, so many of which are across it.
fn cracks(cells: u32, side: u32) -> anyhow::Result<Raster<f32>> {
    let worley = Worley2::new(Seed(8)).with_period([Some(cells); 2])?;
    let cracks = worley.combine(Combination::F2_MINUS_F1).normalized()?;
    let window = Window::new(DVec2::ZERO, DVec2::splat(cells.into()), [side; 2])?;
    let mut raster = Raster::filled([side; 2], 0.0)?;
    cracks.render(&window, raster.view_mut())?;
    Ok(raster)
}
