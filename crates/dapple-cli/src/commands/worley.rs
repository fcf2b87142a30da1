//! `dapple worley`: renders Worley's cellular basis.

use crate::args::{Extent, ImageArgs, Numbers};
use crate::error::{Exit, Hint};
use crate::field::{Field, FieldArgs, check_whole_cells, draw, extent_of};
use crate::job::Context;
use crate::words::{NamedValueParser, unknown, with_underscores};
use anyhow::Result;
use dapple::hash::Seed;
use dapple::recipe::{Images, Motion, Node, WorleyNode, WorleyValue};
use dapple::worley::{Combination, Metric, OctaveSeeds, Octaves, Scatter, Worley2};
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

/// The help text of `--value`.
const VALUE: &str = "\
The value that is drawn: f1, f2, f3, f4, f2_minus_f1, f1_plus_f2, f3_minus_f1, f3_minus_f2, f4_minus_f1, f4_minus_f3, \
2f3_minus_f2_minus_f1, cell_value (a random gray for each cell), or edge_distance";

/// Draw Worley's cellular basis: distances to the nearest of scattered feature points.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    // The help is a constant, since names in a doc comment would need markup.
    #[arg(long, value_name = "VALUE", default_value = "f1",
        help = VALUE, value_parser = value, help_heading = "Texture")]
    value: WorleyValue,

    /// Coefficients of F1 to F4, instead of --value.
    #[arg(
        long,
        value_name = "C1,C2,C3,C4",
        allow_hyphen_values = true,
        conflicts_with = "value",
        help_heading = "Texture"
    )]
    coefficients: Option<Numbers<f32, 4>>,

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

    /// Distance metric.
    #[arg(long, value_name = "METRIC", default_value = "euclidean", value_parser = NamedValueParser::of(Metric::NAMED), help_heading = "Texture")]
    metric: Metric,

    /// Exponent of the Minkowski metric, from 1 to 10; replaces --metric.
    #[arg(
        long,
        value_name = "P",
        conflicts_with = "metric",
        help_heading = "Texture"
    )]
    minkowski: Option<f32>,

    /// Mean number of feature points per cell, from 1/64 to 64.
    #[arg(long, value_name = "N", default_value_t = Scatter::DENSITY, help_heading = "Texture")]
    density: f64,

    /// One feature point per cell, jittered from 0 (a grid) to 1 (anywhere); replaces --density.
    #[arg(
        long,
        value_name = "PART",
        conflicts_with = "density",
        help_heading = "Texture"
    )]
    jitter: Option<f64>,

    /// Number of octaves to sum, from 1 to 32.
    #[arg(long, value_name = "N", help_heading = "Texture")]
    octaves: Option<u32>,

    /// Frequency ratio of successive octaves, from 1 to 16; a whole number if the image repeats.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 2.0,
        requires = "octaves",
        help_heading = "Texture"
    )]
    lacunarity: f64,

    /// Feature points of octaves: separate, or shared as in Worley's paper.
    #[arg(
        long,
        value_name = "SEEDS",
        default_value = "own",
        value_parser = NamedValueParser::of([("own", OctaveSeeds::Own), ("same", OctaveSeeds::Same)]),
        requires = "octaves",
        help_heading = "Texture"
    )]
    octave_seeds: OctaveSeeds,

    /// Amplitude of an octave relative to the previous one, from -1 to 1.
    #[arg(
        long,
        visible_alias = "persistence",
        allow_negative_numbers = true,
        value_name = "PART",
        default_value_t = 0.5,
        requires = "octaves",
        help_heading = "Texture"
    )]
    gain: f64,

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
        let metric = self.minkowski.map_or(self.metric, Metric::Minkowski);
        let scatter = match self.jitter {
            Some(jitter) => Scatter::Jittered { jitter },
            None => Scatter::Poisson {
                density: self.density,
            },
        };
        let octaves = self.octaves.map(|count| Octaves {
            count,
            lacunarity: self.lacunarity,
            gain: self.gain,
            seeds: self.octave_seeds,
        });
        let value = match self.coefficients {
            Some(Numbers(coefficients)) => WorleyValue::Combination(Combination::new(coefficients)),
            None => self.value,
        };
        let motion = self.frames.map(|_| Motion {
            cells: self.loop_cells,
            z: 0.0,
        });
        Ok(WorleyNode {
            value,
            metric,
            scatter,
            octaves,
            motion,
            ..WorleyNode::default()
        })
    }

    /// Returns the values that are drawn as black and white. They are measured on a texture with the same options that
    /// covers a large number of cells.
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

fn value(text: &str) -> Result<WorleyValue, String> {
    WorleyValue::from_name(&with_underscores(text))
        .ok_or_else(|| unknown("value", text, &WorleyValue::names(), ""))
}
