//! `dapple wavelet`: wavelet noise.

use crate::args::ImageArgs;
use crate::error::{Exit, Hint, usage};
use crate::field::{Field, FieldArgs, draw, extent_of};
use crate::job::Context;
use anyhow::Result;
use dapple::recipe::{Images, Node, WaveletNode};
use serde::Serialize;

const EXAMPLES: &str = "\
Examples:
  dapple wavelet -o noise.png
  dapple wavelet --cells 16 --octaves 5 --gain 0.5 --size 1024 -o clouds.png
  dapple wavelet --weights 1,0,0.5 --ramp lagoon -o two-bands.png
  dapple wavelet --cells 64 --format exr -o noise.exr

A single band has the variance 1 and values mostly between -3 and 3, which become black and
white in PNG; several bands have the range that goes with the sum of their variances.";

/// Draw wavelet noise: bands of frequencies that neither alias nor blur.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Cells across the shorter side of the picture, in the coarsest band: an even number, from 4 on, if it repeats.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 32.0,
        help_heading = "Texture"
    )]
    cells: f64,

    /// How many bands, each twice as fine as the one before, from 1 to 16.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16), help_heading = "Texture")]
    octaves: u32,

    /// How high a band is beside the one before.
    #[arg(
        long,
        alias = "persistence",
        value_name = "PART",
        default_value_t = 0.5,
        help_heading = "Texture"
    )]
    gain: f64,

    /// The weight of each band, coarsest first; takes the place of --octaves and --gain.
    #[arg(long, value_name = "W,W,…", value_delimiter = ',', allow_hyphen_values = true, conflicts_with_all = ["octaves", "gain"], help_heading = "Texture")]
    weights: Vec<f32>,

    #[command(flatten)]
    field: FieldArgs,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// Runs it.
///
/// # Errors
///
/// Whatever went wrong.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let weights = args.weights();
    let variance: f64 = weights
        .iter()
        .map(|&weight| f64::from(weight) * f64::from(weight))
        .sum();
    if !variance.is_finite() || variance == 0.0 {
        return Err(usage("the weights have no finite sum of squares above 0")
            .hint("give at least one that is not 0"));
    }
    let reach = (3.0 * variance.sqrt()) as f32;
    let node = WaveletNode {
        frequency: 1.0,
        weights,
        seed: None,
    };
    let field = Field {
        command: "wavelet",
        node: Node::Wavelet(node),
        is_color: false,
        extent: extent_of(args.field.size, args.cells),
        range: [-reach, reach],
        frames: None,
        images: Images::new(),
    };
    draw(&field, &args.field, &args.image, args, context)
}

impl Args {
    fn weights(&self) -> Vec<f32> {
        if !self.weights.is_empty() {
            return self.weights.clone();
        }
        let weights = std::iter::successors(Some(1.0), |weight| Some(weight * self.gain));
        weights
            .take(self.octaves as usize)
            .map(|weight| weight as f32)
            .collect()
    }
}
