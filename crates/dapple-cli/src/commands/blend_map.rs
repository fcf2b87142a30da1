//! `dapple blend-map`: computes a blend tile from the features of a texture.

use crate::args::{Axes, ImageArgs, ReadArgs, Region, image_alpha};
use crate::error::{Exit, Hint};
use crate::input::{self, ALPHA_HINT, Kind};
use crate::job::{Context, Job};
use crate::node::{Flag, NodeArgs, NodeFlags};
use crate::progress::Progress;
use crate::words::NamedValueParser;
use anyhow::{Result, anyhow};
use dapple::raster::Wrap;
use dapple::recipe::ImageAlpha;
use dapple::tile::{BlendMap, Map, rank_equalize};
use serde::Serialize;
use serde_json::Value;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  dapple blend-map stones.png -o cracks.png --feature-size 24
  dapple blend-map height.png -o soft.png --contrast 0.5 --plain
  dapple blend stones.png grass.png,weight=0.3 --tile cracks.png -o field.png

The map is low in cracks and high on what stands out. As the --tile of `dapple blend`,
it lets what is blended in begin in the cracks. Without --plain its values are spread
evenly, so that a weight of 0.3 covers 0.3 of the area.";

/// Make a blend tile from a texture: low in its cracks, high on raised or bright parts.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The texture, or its height. `-` is standard input.
    #[arg(value_name = "IMAGE")]
    image: PathBuf,

    /// Use only this part of the image, in pixels.
    #[arg(long, value_name = "X,Y,W,H")]
    region: Option<Region>,

    /// Handling of transparency, an error by default: drop it, or composite over a color such as `over:#888`.
    #[arg(long, value_name = "drop|over:COLOR", value_parser = image_alpha)]
    alpha: Option<ImageAlpha>,

    #[command(flatten)]
    #[serde(flatten)]
    read: ReadArgs,

    #[command(flatten)]
    #[serde(flatten)]
    node: NodeArgs<MapFlags>,

    /// Axes along which texture and map repeat; along others the texture is mirrored.
    #[arg(long, value_parser = NamedValueParser::<Axes>::all(), default_value_t = Axes::Both)]
    wrap: Axes,

    /// Keep the values instead of replacing each by its rank, from 0 to 1.
    #[arg(long)]
    plain: bool,

    #[command(flatten)]
    #[serde(skip)]
    output: ImageArgs,
}

/// Marker for the flags that come from the recipe node `blend_map`.
#[derive(Clone, Debug)]
struct MapFlags;

impl NodeFlags for MapFlags {
    const KIND: &'static str = "blend_map";
    const HEADING: Option<&'static str> = None;
    const FLAGS: &'static [Flag] = &[
        Flag::new("feature_size", "feature-size")
            .with_default("32")
            .with_help(
                "Size of the features, such as the diameter of stones, in pixels, from 1 to 4096",
            ),
        Flag::none("input"),
    ];
}

/// Runs the subcommand.
///
/// # Errors
///
/// If an option, an image or another file is invalid.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let mut job = Job::new(context, "blend-map", &args.output.files);
    let (files, ending) = (&args.output.files, args.output.ending());
    let targets = files.targets("blend-map", &[""], ending)?;
    let outputs = job.claim_images(&targets, args.output.format)?;
    let kind = Kind::ByChannels;
    let loaded = input::map(
        &args.image,
        kind,
        args.region,
        args.alpha,
        &args.read,
        ALPHA_HINT,
    )?;
    let options = BlendMap {
        wrap: args.wrap.choose(Wrap::Repeat, Wrap::Mirror),
        ..args.node.read(&[])?
    };
    let progress = Progress::spinner("looking for features", context);
    let map = match &loaded.map {
        Map::Value(values) => options.apply(values).wrong_value()?,
        Map::Color(colors) => options.apply_color(colors).wrong_value()?,
        Map::Normal(_) => return Err(anyhow!("normals have no features of their own")),
    };
    let map = if args.plain {
        map
    } else {
        rank_equalize(&map)?
    };
    drop(progress);
    job.write_image(outputs[0], Map::Value(map), true, &args.output)?;
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}
