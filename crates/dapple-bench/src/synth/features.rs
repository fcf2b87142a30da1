//! Further features of `texture-synthesis` compared with ours: several exemplars, guides, rotated exemplars, tiles and
//! repairs.
//!
//! Exemplars are drawings of 128×128 pixels, and images have 192×192 pixels, except for the repair, whose image is
//! the same size as its exemplar. Both sides use their defaults and run on one thread. Times are medians of processor
//! times; ours include all setup.

use super::drawings::{bricks, draw, scales};
use crate::harness::{Bench, median};
use crate::peers::flat;
use crate::row::{Case, Goal, Unit};
use anyhow::{Result, ensure};
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use dapple_synth::{
    Edges, Endless, EndlessOptions, Exemplar, Options, PlaneTexture, SideBySide, Turned,
    synthesize_plane_guided,
};
use texture_synthesis::{Dims, Example, Session, SessionBuilder};

const SEVERAL: Case = Case {
    group: "synth",
    case: "two examples, 192×192",
    peer: "texture-synthesis",
    unit: Unit::S,
    must: Goal::CostAtMost(0.4),
    note: "",
};

const GUIDED: Case = Case {
    case: "guided, 192×192",
    ..SEVERAL
};

const TURNED: Case = Case {
    case: "an example in eight ways, 192×192",
    peer: "texture-synthesis, flip-and-rotate",
    ..SEVERAL
};

const TILE: Case = Case {
    case: "tile, 192×192",
    ..SEVERAL
};

const REPAIR: Case = Case {
    case: "repair of 39×39 pixels of 128×128",
    ..SEVERAL
};

/// Width and height of exemplars and of images in pixels.
const EXEMPLAR: u32 = 128;
const SIDE: u32 = 192;

/// Number of turns per row. Each turn runs both sides.
const TURNS: usize = 3;

/// Function that a row measures on our side. `Theirs` is the peer's.
type Ours = fn(&Inputs) -> Result<Raster<LinearRgb>>;
type Theirs = fn(&Inputs) -> SessionBuilder<'_>;

struct Inputs {
    scales: Raster<LinearRgb>,
    bricks: Raster<LinearRgb>,
    /// Guide with lightness values: a disk in the middle of the image, and its surroundings.
    target: Raster<f32>,
    /// Mask of the pixels to repair.
    hole: Raster<bool>,
}

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    let rows: [(Case, Ours, Theirs); 5] = [
        (SEVERAL, several, their_several),
        (GUIDED, guided, their_guided),
        (TURNED, turned, their_turned),
        (TILE, tile, their_tile),
        (REPAIR, repair, their_repair),
    ];
    if !bench.wants_any(&rows.map(|(case, ..)| case)) {
        return Ok(());
    }
    let inputs = Inputs::new()?;
    for (case, ours, theirs) in rows {
        if !bench.wants(&case) {
            continue;
        }
        let [mut own, mut others] = [Vec::new(), Vec::new()];
        for _ in 0..TURNS {
            let (seconds, image) = bench.on_one(|| ours(&inputs));
            own.push(seconds);
            let (seconds, other) = flat::run(theirs(&inputs))?;
            others.push(seconds);
            ensure!(image?.size() == other.size(), "images of two sizes");
        }
        bench.measured(&case, median(&mut own), median(&mut others));
    }
    Ok(())
}

impl Inputs {
    fn new() -> Result<Self> {
        let is_near = |at: u32, side: u32, reach: u32| at.abs_diff(side / 2) < reach;
        let is_disk = |x: u32, y: u32| {
            let [x, y] = [x, y].map(|at| at.abs_diff(SIDE / 2));
            x * x + y * y < SIDE * SIDE / 10
        };
        Ok(Self {
            scales: draw(scales, EXEMPLAR)?,
            bricks: draw(bricks, EXEMPLAR)?,
            target: Raster::from_fn([SIDE; 2], |x, y| if is_disk(x, y) { 0.5 } else { 0.05 })?,
            hole: Raster::from_fn([EXEMPLAR; 2], |x, y| {
                is_near(x, EXEMPLAR, 20) && is_near(y, EXEMPLAR, 20)
            })?,
        })
    }
}

/// Synthesizes an endless texture from several exemplars, placed side by side in `layout`.
fn of_layout(layout: &SideBySide, images: &[&Raster<LinearRgb>]) -> Result<Raster<LinearRgb>> {
    let joined = layout.join(images, LinearRgb::default())?;
    let exemplar = Exemplar::new(&joined, Edges::Cut)?.with_mask(&layout.mask()?)?;
    let texture = Endless::new(&exemplar, &EndlessOptions::default())?;
    let texture = texture.window([0; 2], [SIDE; 2], |_| ControlFlow::Continue(()))?;
    Ok(texture.transfer(&joined)?)
}

fn several(inputs: &Inputs) -> Result<Raster<LinearRgb>> {
    let images = [&inputs.scales, &inputs.bricks];
    of_layout(&SideBySide::new(&images.map(Raster::size))?, &images)
}

fn their_several(inputs: &Inputs) -> SessionBuilder<'_> {
    let images = [&inputs.scales, &inputs.bricks];
    let examples = images.map(|image| Example::new(flat::image(image)));
    Session::builder()
        .add_examples(examples)
        .output_size(Dims::square(SIDE))
}

fn guided(inputs: &Inputs) -> Result<Raster<LinearRgb>> {
    let lightness = inputs.scales.map(|color| color.luminance());
    let exemplar = Exemplar::new(&inputs.scales, Edges::Cut)?.with_guides(&[(&lightness, 1.0)])?;
    let texture = synthesize_plane_guided(
        &exemplar,
        &[&inputs.target],
        [Edges::Cut; 2],
        &Options::default(),
        |_| ControlFlow::Continue(()),
    )?;
    Ok(texture.transfer(&inputs.scales)?)
}

fn their_guided(inputs: &Inputs) -> SessionBuilder<'_> {
    let gray = |image: &Raster<f32>| flat::image(&image.map(|&value| LinearRgb::gray(value)));
    let guide = gray(&inputs.scales.map(|color| color.luminance()));
    let example = Example::builder(flat::image(&inputs.scales)).with_guide(guide);
    Session::builder()
        .add_example(example)
        .load_target_guide(gray(&inputs.target))
        .output_size(Dims::square(SIDE))
}

fn turned(inputs: &Inputs) -> Result<Raster<LinearRgb>> {
    let layout = SideBySide::new(&[inputs.scales.size()])?.with_turned(Turned::All)?;
    of_layout(&layout, &[&inputs.scales])
}

fn their_turned(inputs: &Inputs) -> SessionBuilder<'_> {
    let image = flat::image(&inputs.scales);
    let mirrored = image.fliph();
    let ways = [&image, &mirrored].map(|image| {
        [
            image.clone(),
            image.rotate90(),
            image.rotate180(),
            image.rotate270(),
        ]
    });
    Session::builder()
        .add_examples(ways.into_iter().flatten().map(Example::new))
        .output_size(Dims::square(SIDE))
}

fn tile(inputs: &Inputs) -> Result<Raster<LinearRgb>> {
    let options = EndlessOptions {
        period: [Some(SIDE); 2],
        ..EndlessOptions::default()
    };
    let texture = Endless::new(&Exemplar::new(&inputs.scales, Edges::Cut)?, &options)?;
    let texture = texture.window([0; 2], [SIDE; 2], |_| ControlFlow::Continue(()))?;
    Ok(texture.transfer(&inputs.scales)?)
}

fn their_tile(inputs: &Inputs) -> SessionBuilder<'_> {
    Session::builder()
        .add_example(Example::new(flat::image(&inputs.scales)))
        .tiling_mode(true)
        .output_size(Dims::square(SIDE))
}

fn repair(inputs: &Inputs) -> Result<Raster<LinearRgb>> {
    let kept = inputs.hole.map(|is_made| !is_made);
    let exemplar = Exemplar::new(&inputs.scales, Edges::Cut)?.with_mask(&kept)?;
    let whole = PlaneTexture::identity(&exemplar)?;
    let texture = whole.repair(&exemplar, &inputs.hole, &Options::default(), |_| {
        ControlFlow::Continue(())
    })?;
    Ok(texture.transfer(&inputs.scales)?)
}

fn their_repair(inputs: &Inputs) -> SessionBuilder<'_> {
    let kept = |&is_made: &bool| LinearRgb::gray(if is_made { 0.0 } else { 1.0 });
    let mask = flat::image(&inputs.hole.map(kept));
    let example = Example::builder(flat::image(&inputs.scales)).set_sample_method(mask.clone());
    Session::builder().inpaint_example(mask, example, Dims::square(EXEMPLAR))
}
