//! `dapple wavelet`: renders wavelet noise.

use crate::args::{ImageArgs, Size};
use crate::error::{Exit, Hint, usage};
use crate::field::{Field, FieldArgs, draw, extent_of};
use crate::job::Context;
use crate::node::{Flag, NodeArgs, NodeFlags};
use anyhow::Result;
use dapple::recipe::{Frequency, Images, Node, WaveletNode};
use serde::Serialize;

const EXAMPLES: &str = "\
Examples:
  dapple wavelet -o noise.png
  dapple wavelet --cells 16 --octaves 5 --gain 0.5 --size 1024 -o clouds.png
  dapple wavelet --cells 30 --size 640x480 -o wide.png
  dapple wavelet --weights 1,0,0.5 --ramp lagoon -o two-bands.png
  dapple wavelet --cells 64 --format exr -o noise.exr

A single band has the variance 1 and values mostly between -3 and 3, which become black and
white in PNG; several bands have the range that goes with the sum of their variances.";

/// Draw wavelet noise: bands of frequencies that neither alias nor blur.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Number of cells across the shorter side, in the coarsest band.
    ///
    /// It must be an even number, at least 4, along each axis on which the image repeats.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 32.0,
        help_heading = "Texture"
    )]
    cells: f64,

    /// Number of bands, each twice as fine as the previous one, from 1 to 16.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16), help_heading = "Texture")]
    octaves: u32,

    /// Amplitude of a band relative to the previous one.
    #[arg(
        long,
        alias = "persistence",
        value_name = "PART",
        default_value_t = 0.5,
        help_heading = "Texture"
    )]
    gain: f64,

    #[command(flatten)]
    #[serde(flatten)]
    node: NodeArgs<WaveletFlags>,

    #[command(flatten)]
    field: FieldArgs,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// Marker for the flags that come from the recipe node `wavelet`.
#[derive(Clone, Debug)]
struct WaveletFlags;

impl NodeFlags for WaveletFlags {
    const KIND: &'static str = "wavelet";
    const FLAGS: &'static [Flag] = &[
        Flag::none("frequency"),
        Flag::none("seed"),
        Flag::new("weights", "weights")
            .without_default()
            .conflicting(&["octaves", "gain"]),
    ];
}

/// Runs the subcommand.
///
/// # Errors
///
/// If an option is out of range, or writing fails.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let weights = args.weights()?;
    let variance: f64 = weights
        .iter()
        .map(|&weight| f64::from(weight) * f64::from(weight))
        .sum();
    if !variance.is_finite() || variance == 0.0 {
        return Err(usage("the weights have no finite sum of squares above 0")
            .hint("give at least one that is not 0"));
    }
    let spaces = args.field.spaces()?;
    let extent = extent_of(spaces, args.cells);
    check_cells(extent, args.field.wrap.flags(), spaces)?;
    let reach = (3.0 * variance.sqrt()) as f32;
    let node = WaveletNode {
        frequency: Frequency([1.0; 2]),
        weights,
        seed: None,
    };
    let field = Field {
        command: "wavelet",
        node: Node::Wavelet(node),
        is_color: false,
        extent,
        range: [-reach, reach],
        frames: None,
        images: Images::new(),
    };
    draw(&field, &args.field, &args.image, args, context)
}

/// Minimum number of cells along an axis on which the noise repeats.
const FEWEST_CELLS: f64 = 4.0;

/// Checks that the noise can repeat with these numbers of cells along the sides. The hint lists nearby numbers that
/// can.
fn check_cells(cells: [f64; 2], repeats: [bool; 2], size: Size) -> Result<()> {
    let holds =
        |axis: usize| !repeats[axis] || (cells[axis] >= FEWEST_CELLS && cells[axis] % 2.0 == 0.0);
    if holds(0) && holds(1) {
        return Ok(());
    }
    let [across, down] = cells.map(|cells| (100.0 * cells).round() / 100.0);
    let [width, height] = size.0;
    let message = format!(
        "{across} × {down} cells on {width} × {height} pixels cannot repeat: wavelet noise needs an even number, from 4 on, along each axis"
    );
    Err(usage(message).hint(other_cells(cells, size)))
}

/// Returns a hint with the nearest numbers of cells with which the noise can repeat.
fn other_cells(cells: [f64; 2], size: Size) -> String {
    // Multiples of `step` along the shorter side give whole even numbers along both sides.
    let [width, height] = size.0;
    let step = f64::from(2 * (width.min(height) / greatest_common_divisor(width, height)));
    let shorter = cells[0].min(cells[1]);
    let least = (FEWEST_CELLS / step).ceil();
    let below = (shorter / step).floor().max(least) * step;
    let above = if below > shorter { below } else { below + step };
    match (below < shorter, above <= f64::from(width.min(height))) {
        (true, true) => format!("take --cells {below} or --cells {above}, or --wrap none"),
        (true, false) => format!("take --cells {below}, or --wrap none"),
        (false, true) => format!("take --cells {above}, or --wrap none"),
        (false, false) => {
            "take a --size whose sides have a simpler ratio, or --wrap none".to_owned()
        }
    }
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

impl Args {
    fn weights(&self) -> Result<Vec<f32>> {
        if let Node::Wavelet(node) = self.node.node()?
            && self.node.is_given("weights")
        {
            return Ok(node.weights);
        }
        let weights = std::iter::successors(Some(1.0), |weight| Some(weight * self.gain));
        let weights = weights.take(self.octaves as usize);
        Ok(weights.map(|weight| weight as f32).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::{check_cells, other_cells};
    use crate::args::Size;
    use crate::field::extent_of;

    #[test]
    fn cells_that_are_named_instead_repeat() {
        for (size, cells, expected) in [
            (
                [640, 480],
                32.0,
                "take --cells 30 or --cells 36, or --wrap none",
            ),
            ([80, 64], 5.0, "take --cells 8, or --wrap none"),
            ([512, 512], 2.0, "take --cells 4, or --wrap none"),
            (
                [1080, 1920],
                32.0,
                "take --cells 18 or --cells 36, or --wrap none",
            ),
            (
                [641, 480],
                32.0,
                "take a --size whose sides have a simpler ratio, or --wrap none",
            ),
        ] {
            let size = Size(size);
            let hint = other_cells(extent_of(size, cells), size);
            assert_eq!(hint, expected);
            let words: Vec<_> = hint.split([' ', ',']).collect();
            for pair in words.windows(2).filter(|pair| pair[0] == "--cells") {
                let extent = extent_of(size, pair[1].parse().unwrap());
                assert!(check_cells(extent, [true; 2], size).is_ok(), "{hint}");
            }
        }
    }
}
