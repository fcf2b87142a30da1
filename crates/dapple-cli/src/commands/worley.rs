//! `dapple worley`: renders Worley's cellular basis.

use crate::args::{Extent, ImageArgs};
use crate::error::{Exit, Hint};
use crate::field::{Field, FieldArgs, check_whole_cells, draw, extent_of};
use crate::job::Context;
use crate::node::{Flag, NodeArgs, NodeFlags};
use anyhow::Result;
use dapple::hash::Seed;
use dapple::recipe::{Images, Motion, Node, WorleyNode, WorleyValue};
use dapple::worley::Worley2;
use serde::Serialize;

const EXAMPLES: &str = "\
Examples:
  dapple worley -o cells.png
  dapple worley --value f2_minus_f1 --cells 12 --size 1024 --seed 3 -o cracks.png
  dapple worley --metric manhattan --ramp ember --size 1024x512 -o hull.png
  dapple worley --octaves 6 --value f1 -o crumpled.exr
  dapple worley --octaves 6 --octave-seeds same --lacunarity 2 --gain 0.5 -o worley-1996.png
  dapple worley --coefficients=-1,-1,2,0 -o odd.png
  dapple worley --frames 24 --loop-cells 2 --size 96 -o sea.png
  dapple worley --size 8192 --region 0,0,256,256 -o corner.png

Values are distances in cells. In PNG the range that 998 of 1000 places have becomes black to
white, measured over the texture and not over the picture; --range says otherwise.";

/// Draw Worley's cellular basis: distances to the nearest of scattered feature points.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    #[serde(flatten)]
    node: NodeArgs<WorleyFlags>,

    /// Number of cells across the shorter side of the image.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 8.0,
        conflicts_with = "period",
        help_heading = "Texture"
    )]
    cells: f64,

    /// Period in cells, such as 8 or 12x6; the image shows one period. Replaces --cells.
    #[arg(long, value_name = "N[xM]", help_heading = "Texture")]
    period: Option<Extent>,

    /// Number of frames of a loop, a moving slice through 4-D cells.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000), help_heading = "Loop")]
    frames: Option<u32>,

    /// Number of cells that a loop passes; more is faster.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..), requires = "frames", help_heading = "Loop")]
    loop_cells: u32,

    #[command(flatten)]
    field: FieldArgs,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// Marker for the flags that come from the recipe node `worley`.
#[derive(Clone, Debug)]
struct WorleyFlags;

impl NodeFlags for WorleyFlags {
    const KIND: &'static str = "worley";
    const FLAGS: &'static [Flag] = &[
        Flag::new("value", "value"),
        Flag::new("value", "coefficients")
            .of_numbers()
            .with_help("Coefficients of F1 to F4; replaces --value")
            .conflicting(&["value"]),
        Flag::new("metric", "metric"),
        Flag::new("metric/minkowski", "minkowski")
            .with_help("Exponent of the Minkowski metric, from 1 to 10; replaces --metric")
            .conflicting(&["metric"]),
        Flag::new("scatter/poisson/density", "density"),
        Flag::new("scatter/jittered/jitter", "jitter")
            .with_help(
                "One feature point per cell, offset from its center by 0 to 1; replaces --density",
            )
            .conflicting(&["density"]),
        Flag::new("octaves/count", "octaves").without_default(),
        Flag::new("octaves/lacunarity", "lacunarity").requiring("octaves"),
        Flag::new("octaves/gain", "gain").requiring("octaves"),
        Flag::new("octaves/seeds", "octave-seeds").requiring("octaves"),
        Flag::none("frequency"),
        Flag::none("range"),
        Flag::none("motion"),
        Flag::none("seed"),
    ];
}

/// Runs the subcommand.
///
/// # Errors
///
/// If an option is out of range, or writing fails.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let node = args.node()?;
    let extent = match args.period {
        Some(period) => period.0,
        None => extent_of(args.field.spaces()?, args.cells),
    };
    check_whole_cells(extent, args.field.wrap.flags(), "--period")?;
    let field = Field {
        command: "worley",
        range: args.range(&node).wrong_value()?,
        node: Node::Worley(node),
        is_color: false,
        extent,
        frames: args.frames,
        images: Images::new(),
    };
    draw(&field, &args.field, &args.image, args, context)
}

impl Args {
    fn node(&self) -> Result<WorleyNode> {
        let node = match self.node.node()? {
            Node::Worley(node) => node,
            _ => WorleyNode::default(),
        };
        let motion = self.frames.map(|_| Motion {
            cells: self.loop_cells,
            z: 0.0,
        });
        Ok(WorleyNode { motion, ..node })
    }

    /// Returns the values that become black and white. They are measured on a texture with the same options and a large
    /// number of cells.
    fn range(&self, node: &WorleyNode) -> Result<[f32; 2]> {
        /// Number of positions at which values are measured.
        const N: u32 = 20_000;
        let WorleyValue::Combination(combination) = node.value else {
            return Ok([0.0, 1.0]);
        };
        let seed = Seed(0);
        let worley = Worley2::new(seed)
            .with_metric(node.metric)?
            .with_scatter(node.scatter)?;
        let cellular = worley.combine(combination);
        let range = match node.octaves {
            None => cellular.measure_range(seed, N)?,
            Some(octaves) => cellular.fractal(octaves)?.measure_range(seed, N)?,
        };
        Ok(if range[0] < range[1] {
            range
        } else {
            [range[0], range[0] + 1.0]
        })
    }
}
