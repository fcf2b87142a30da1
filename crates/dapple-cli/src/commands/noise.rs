//! `dapple noise`: renders gradient noise.

mod space;

use crate::args::ImageArgs;
use crate::error::Exit;
use crate::field::{Field, FieldArgs, check_whole_cells, draw, extent_of};
use crate::job::{Context, eprintln_if_possible};
use crate::node::{Flag, NodeArgs, NodeFlags};
use anyhow::Result;
use dapple::recipe::{FractalBasis, FractalNode, Frequency, Images, Node};
use serde::Serialize;

const EXAMPLES: &str = "\
Examples:
  dapple noise -o noise.png
  dapple noise --cells 4 --octaves 6 --size 1024 --format png16 -o height.png
  dapple noise --octaves 5 --gain 0.6 --ramp lagoon -o clouds.png
  dapple noise --cells 6 --size 640x480 -o wide.png
  dapple noise --sphere --cells 4 --octaves 8 --size 1024x512 --ramp terrain -o planet.png
  dapple noise --cube --cells 4 --octaves 8 --size 512 --samples corners -o sky/

Values are from 0 to 1, about one half. The same noise is the node `noise` of recipes with the
basis `gradient`; domain warps and ridges are made of it there.";

/// Draw Perlin's gradient noise: smooth bumps of one size, or fractal sums of them (fBm).
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Number of cells across the shorter side, in the coarsest octave.
    ///
    /// It must be a whole number along each axis on which the image repeats. Of a sphere or cube, it is the number across
    /// the diameter.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 8.0,
        help_heading = "Texture"
    )]
    cells: f64,

    /// Draw the noise in space on a sphere, as an equirectangular image: twice as wide as high, without a seam.
    ///
    /// It needs a --size, such as 1024x512. The center looks along +x, and y is up. With --samples corners, the last
    /// column equals the first, and the width is 2 × height − 1, such as 1025x513.
    #[arg(long, conflicts_with_all = ["cube", "region", "wrap", "recipe"], help_heading = "Texture")]
    sphere: bool,

    /// Draw the noise in space on a sphere, as the six faces of a cube map: `NAME_px`, `_nx`, `_py`, `_ny`, `_pz`, `_nz`.
    ///
    /// The faces are turned as in OpenGL. With --samples corners, neighboring faces have equal pixels on their edge.
    #[arg(long, conflicts_with_all = ["region", "wrap", "recipe"], help_heading = "Texture")]
    cube: bool,

    #[command(flatten)]
    #[serde(flatten)]
    node: NodeArgs<NoiseFlags>,

    #[command(flatten)]
    field: FieldArgs,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// Marker for the flags that come from the recipe node `noise`.
#[derive(Clone, Debug)]
struct NoiseFlags;

impl NodeFlags for NoiseFlags {
    const KIND: &'static str = "noise";
    const FLAGS: &'static [Flag] = &[
        Flag::new("octaves", "octaves").with_default("1"),
        Flag::none("basis"),
        Flag::none("frequency"),
        Flag::none("seed"),
    ];
}

/// Runs the subcommand.
///
/// # Errors
///
/// If options conflict or are out of range, or writing fails.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let node = match args.node.node()? {
        Node::Noise(node) => FractalNode {
            basis: FractalBasis::Gradient,
            frequency: Frequency([1.0; 2]),
            ..node
        },
        _ => FractalNode::default(),
    };
    if args.sphere || args.cube {
        return space::draw(args, &node, context);
    }
    let spaces = args.field.spaces()?;
    let extent = extent_of(spaces, args.cells);
    check_whole_cells(extent, args.field.wrap.flags(), "--cells")?;
    let pixels = spaces.0.into_iter().min().unwrap_or(1);
    if let Some(octave) = first_below_a_pixel(args.cells, node.octaves, pixels)
        && !context.quiet
    {
        eprintln_if_possible(&format!(
            "note: octaves from number {octave} on have cells of at most a pixel, and are 0 at the pixels or look like static; \
             take fewer --cells or --octaves, or a larger --size"
        ));
    }
    let field = Field {
        command: "noise",
        node: Node::Noise(node),
        is_color: false,
        extent,
        range: [0.0, 1.0],
        frames: None,
        images: Images::new(),
    };
    draw(&field, &args.field, &args.image, args, context)
}

/// Returns the number, starting at 1, of the first octave whose cells are at most one pixel wide; `None` if all cells
/// are wider. `cells` is the number of cells of the first octave across `pixels`.
fn first_below_a_pixel(cells: f64, octaves: u32, pixels: u32) -> Option<u32> {
    let mut cells_of_octave = cells;
    for octave in 1..=octaves {
        if cells_of_octave >= f64::from(pixels) {
            return Some(octave);
        }
        cells_of_octave *= 2.0;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::first_below_a_pixel;

    #[test]
    fn octaves_below_a_pixel_are_counted_from_one() {
        assert_eq!(first_below_a_pixel(512.0, 1, 256), Some(1));
        assert_eq!(first_below_a_pixel(256.0, 6, 256), Some(1));
        assert_eq!(first_below_a_pixel(8.0, 6, 256), Some(6));
        assert_eq!(first_below_a_pixel(8.0, 5, 256), None);
    }
}
