//! Renders a single field, for the subcommands that render noise. Each creates a recipe with one node and bakes it.

use crate::args::{Axes, Frame, ImageArgs, Region, SamplesArgs, Size, Targets, seed};
use crate::baking::{self, MapFile, advise, report};
use crate::encode::{Format, ramped_recipe};
use crate::error::{Exit, Hint, usage};
use crate::estimate::print_estimate;
use crate::job::{Context, Job, put_text};
use crate::layers::{Image, Layers};
use crate::output::Target;
use crate::progress::Progress;
use crate::words::NamedValueParser;
use anyhow::{Error, Result};
use dapple::hash::Seed;
use dapple::recipe::{
    Bake, BakeMemory, BakeOptions, Images, Input, Levels, LevelsCurve, MapKind, Node, Plan, Recipe,
    RecipeError,
};
use serde::Serialize;

/// Options of subcommands that draw a field.
#[derive(clap::Args, Clone, Debug, Serialize)]
pub(crate) struct FieldArgs {
    /// Random seed.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed)]
    pub(crate) seed: u64,

    /// Image size in pixels.
    #[arg(long, value_name = "WxH", default_value = "512")]
    pub(crate) size: Size,

    #[command(flatten)]
    #[serde(flatten)]
    pub(crate) samples: SamplesArgs,

    /// Axes along which the image repeats.
    #[arg(long, value_parser = NamedValueParser::<Axes>::all(), default_value_t = Axes::Both)]
    pub(crate) wrap: Axes,

    /// Draw only this region, in pixels: bit for bit a crop of the whole.
    #[arg(long, value_name = "X,Y,W,H")]
    pub(crate) region: Option<Region>,

    /// Values that become black and white: `LO,HI`, or `raw` for the values as they are.
    ///
    /// By default the range of the subcommand for PNG and raw heights, and `raw` for EXR and NumPy arrays.
    #[arg(long, value_name = "LO,HI|raw", allow_hyphen_values = true)]
    pub(crate) range: Option<RangeArg>,

    /// Write the recipe as TOML for `dapple bake` instead of drawing it; printed without -o.
    #[arg(long)]
    pub(crate) recipe: bool,
}

/// A range of values, as given on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum RangeArg {
    /// The values are unchanged.
    Raw,
    /// The values that become 0 and 1.
    Ends([f32; 2]),
}

impl std::str::FromStr for RangeArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("raw") {
            return Ok(Self::Raw);
        }
        let ends: Result<Vec<f32>, _> = text.split(',').map(|end| end.trim().parse()).collect();
        match ends.as_deref() {
            Ok(&[low, high]) if low.is_finite() && high.is_finite() && low != high => {
                Ok(Self::Ends([low, high]))
            }
            _ => Err(format!(
                "{text:?} is not a range: give two numbers, such as 0,1 or -3,3, or raw"
            )),
        }
    }
}

/// A field to render, with its defaults.
#[derive(Clone, Debug)]
pub(crate) struct Field {
    /// The name of the subcommand.
    pub(crate) command: &'static str,
    /// The recipe node of the field.
    pub(crate) node: Node,
    /// Whether the field has colors.
    pub(crate) is_color: bool,
    /// Width and height of the image, in units of the plane.
    pub(crate) extent: [f64; 2],
    /// The values that become black and white in integer formats.
    pub(crate) range: [f32; 2],
    /// Number of frames in a looping animation; `None` for a still image.
    pub(crate) frames: Option<u32>,
    /// The images that the node reads.
    pub(crate) images: Images,
}

/// Renders a field to a file, or each frame of a looping animation to a separate file.
///
/// # Errors
///
/// If an option is out of range, or writing fails.
pub(crate) fn draw(
    field: &Field,
    args: &FieldArgs,
    image: &ImageArgs,
    options: &impl Serialize,
    context: &Context,
) -> Result<Exit> {
    // Write the recipe alone, if requested.
    let mut job = Job::new(context, field.command, &image.files);
    if args.recipe {
        let format = image.format.unwrap_or(Format::Png16);
        let text = recipe(field, args, image, format)?.to_toml();
        let text = text.map_err(advise)?;
        return put_text(job, field.command, "toml", &text, options);
    }
    // Choose the format, and claim the files.
    let Targets { main, files } =
        image
            .files
            .targets(field.command, &frames(field.frames), image.ending())?;
    let is_ramped = image.ramp.is_some();
    let is_color = field.is_color || is_ramped;
    let default = if is_ramped {
        Format::Png8
    } else {
        Format::Png16
    };
    let format = Format::choose(image.format, &main, default)?;
    let recipe = recipe(field, args, image, format)?;
    let kind = if is_color {
        MapKind::Albedo
    } else {
        MapKind::Height
    };
    let image_of_map = Image {
        layers: Layers::Map(kind),
        format,
    };
    format.check(image_of_map.layers.content(), &main)?;
    let claim = |target: &Target| {
        Ok(MapFile {
            image: image_of_map,
            output: job.claim(target)?,
            sheet: None,
        })
    };
    let files = files.iter().map(claim).collect::<Result<Vec<_>>>()?;
    job.claim_sidecar(&main)?;
    // Bake each frame.
    let bake = BakeOptions {
        size: args.size.0,
        samples: args.samples.samples,
        region: args.region.map(Region::of_recipe),
        maps: vec![kind],
        memory: BakeMemory::Banded,
        ..BakeOptions::default()
    };
    let n_rows = args.region.map_or(args.size.0[1], |region| region.size[1]);
    let n_rows = u64::from(n_rows) * files.len() as u64;
    let progress = Progress::bar("drawing", n_rows, context);
    for (index, (frame, file)) in Frame::all(field.frames).zip(&files).enumerate() {
        let time = frame.map_or(0.0, Frame::time);
        let plan = Plan::new(&recipe, &field.images, time).map_err(refused)?;
        if index == 0 {
            print_estimate(&plan, &bake, &vec![image_of_map; files.len()], &job)?;
        }
        let bake = Bake::new(&plan, &bake).map_err(refused)?;
        baking::write(&mut job, bake, std::slice::from_ref(file), &progress)?;
    }
    drop(progress);
    let sidecar = FieldSidecar {
        options,
        recipe: &recipe,
    };
    job.finish(&sidecar, report(&recipe))?;
    Ok(Exit::Done)
}

impl FieldArgs {
    /// Returns the number of sample spacings from one side of the image to the other, along each axis.
    ///
    /// # Errors
    ///
    /// If the samples are on corners and a side has only one.
    pub(crate) fn spaces(&self) -> Result<Size> {
        self.samples.spaces(self.size)
    }
}

/// Converts an error about the recipe to an error about an option. The node's name is removed from the message, because
/// users of the subcommand never see the node.
pub(crate) fn refused(error: RecipeError) -> Error {
    let message = error.kind().to_string();
    Error::new(error).context(message).wrong_value()
}

/// Content of the sidecar: the options and the recipe.
#[derive(Serialize)]
struct FieldSidecar<'a, T> {
    #[serde(flatten)]
    options: &'a T,
    #[serde(rename = "baked")]
    recipe: &'a Recipe,
}

/// Builds the recipe that renders a field: its node, mapped to the range and colored by the ramp.
fn recipe(field: &Field, args: &FieldArgs, image: &ImageArgs, format: Format) -> Result<Recipe> {
    let mut recipe = Recipe::of_node(field.command, field.node.clone(), Seed(args.seed));
    recipe.extent = field.extent;
    recipe.wrap = args.wrap.flags();
    let range = match args.range {
        Some(RangeArg::Raw) => None,
        Some(RangeArg::Ends(ends)) => Some(ends),
        // With a ramp, which takes values from 0 to 1, the default range applies to every format.
        None if format.keeps_numbers() && image.ramp.is_none() => None,
        None => Some(field.range),
    };
    if field.is_color {
        if image.ramp.is_some() || args.range.is_some() {
            return Err(usage("colors take neither a ramp nor a range"));
        }
        recipe.material.height = Input::Number(0.5);
        recipe.material.albedo = Some(Input::from(field.command));
        return Ok(recipe);
    }
    if let Some(from) = range.filter(|&range| range != [0.0, 1.0]) {
        let levels = Levels {
            input: Input::from(field.command),
            from,
            to: [0.0, 1.0],
            curve: LevelsCurve::Unclamped,
        };
        recipe
            .nodes
            .insert("levels".to_owned(), Node::Levels(levels));
        recipe.material.height = Input::from("levels");
    }
    if let Some(ramp) = &image.ramp {
        recipe.nodes.insert(
            "colors".to_owned(),
            ramped_recipe(ramp, &recipe.material.height),
        );
        recipe.material.albedo = Some(Input::from("colors"));
    }
    Ok(recipe)
}

/// Returns the frame labels for file names, such as `001`. A still image has a single empty label.
fn frames(count: Option<u32>) -> Vec<String> {
    let label = |frame: Option<Frame>| frame.map_or(String::new(), Frame::label);
    Frame::all(count).map(label).collect()
}

/// Returns the width and height of an image with square pixels whose shorter side is `shorter` units of the plane.
/// `spaces` is the number of sample spacings along each axis.
pub(crate) fn extent_of(spaces: Size, shorter: f64) -> [f64; 2] {
    let [width, height] = spaces.0.map(f64::from);
    // Multiply before dividing, so that sides that are whole numbers of units are exact.
    let side = |pixels: f64| pixels * shorter / width.min(height);
    [side(width), side(height)]
}

/// Checks that the number of cells is whole along each axis that repeats. The hint suggests changing `option`.
pub(crate) fn check_whole_cells(cells: [f64; 2], repeats: [bool; 2], option: &str) -> Result<()> {
    for (cells, repeats) in cells.into_iter().zip(repeats) {
        if repeats && cells.fract() != 0.0 {
            let message = format!("{cells} cells along a side cannot repeat");
            let hint = format!(
                "take a whole number of cells along each side with {option}, or --wrap none"
            );
            return Err(usage(message).hint(hint));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{RangeArg, extent_of, frames};
    use crate::args::Size;

    #[test]
    fn whole_numbers_of_units_come_out_whole_for_any_size() {
        for side in 1..2000 {
            assert_eq!(extent_of(Size([side; 2]), 32.0), [32.0; 2], "{side}");
        }
        let wide = extent_of(Size([640, 480]), 246.0);
        assert_eq!(wide, [328.0, 246.0]);
    }

    #[test]
    fn ranges_are_two_ends_or_raw() {
        assert_eq!("raw".parse(), Ok(RangeArg::Raw));
        assert_eq!("-3, 3".parse(), Ok(RangeArg::Ends([-3.0, 3.0])));
        for text in ["", "1", "1,1", "0,nan", "0,1,2", "low,high"] {
            assert!(text.parse::<RangeArg>().is_err(), "{text:?} is no range");
        }
    }

    #[test]
    fn pictures_of_a_loop_are_numbered() {
        assert_eq!(frames(None), [""]);
        assert_eq!(frames(Some(2)), ["001", "002"]);
    }
}
