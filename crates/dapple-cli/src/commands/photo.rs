//! `dapple photo`: estimates a material that repeats from a single photograph.

use super::bake::MaterialFiles;
use super::tile::{MethodArgs, best};
use crate::args::{Axes, PartArgs, ReadArgs, Size, image_alpha};
use crate::error::{Exit, Hint};
use crate::input::{self, ALPHA_HINT, Kind};
use crate::job::{Context, eprintln_if_possible};
use crate::progress::Progress;
use crate::words::NamedValueParser;
use anyhow::{Context as _, Error, Result, bail};
use dapple::hash::Seed;
use dapple::raster::Raster;
use dapple::recipe::{
    ImageAlpha, ImageNode, Images, Input, Material, Node, Picture, Recipe, SCHEMA,
};
use dapple::tile::{Estimate, EstimateOptions, Map, estimate_material};
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;

const EXAMPLES: &str = "\
Examples:
  dapple photo photo.png -o ground/
  dapple photo stones.png --preset unreal --size 512 -o Content/Stones/
  dapple photo photo.png --rectify 8,4,60,0,62,63,3,58 -o wall/
  dapple photo rock.png --invert --slope 0.3 --preview -o rock/
  dapple photo sand.png --light 135 --method periodic -o sand.glb

What it is: a multi-scale shape from shading, and the local contrast, of one photograph. Dark is deep,
unless --light or --invert say otherwise. No model is learned, and nothing is measured: stains become
dents, and the scale of heights and roughness is a guess, to be set by --slope and --roughness.
All maps are cut along the same lines. Normals and occlusion come from the heights of the tile.
A photograph in even light, such as under clouds, is best.";

/// Estimate a material that repeats from one photograph: albedo, height, normal, ao and roughness.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The photograph; `-` is standard input.
    #[arg(value_name = "PHOTO")]
    photo: PathBuf,

    #[command(flatten)]
    #[serde(flatten)]
    part: PartArgs,

    /// Handling of transparency: drop it, or composite over a color such as `over:#888`.
    #[arg(long, value_name = "drop|over:COLOR", value_parser = image_alpha)]
    alpha: Option<ImageAlpha>,

    #[command(flatten)]
    #[serde(flatten)]
    read: ReadArgs,

    #[command(flatten)]
    #[serde(flatten)]
    estimate: EstimateArgs,

    #[command(flatten)]
    method: MethodArgs,

    /// Axes along which the material repeats.
    #[arg(long, value_name = "AXES", default_value = "both", value_parser = NamedValueParser::<Axes>::all())]
    wrap: Axes,

    /// Size of the maps in pixels [default: the size of the tile that the method makes].
    #[arg(long, value_name = "N[xN]", help_heading = "Output")]
    size: Option<Size>,

    #[command(flatten)]
    #[serde(flatten)]
    files: MaterialFiles,
}

/// The options of the estimate.
#[derive(clap::Args, Clone, Copy, Debug, Serialize)]
#[command(next_help_heading = "Estimate")]
struct EstimateArgs {
    /// Remove changes of light over more than PX pixels; forms are at most this wide [default: a sixth of the shorter side].
    #[arg(long, value_name = "PX")]
    even: Option<f64>,

    /// Depth of wide forms: each octave is 2^N times as deep as the next finer one, from 0 to 2.
    #[arg(long, value_name = "N", default_value_t = EstimateOptions::default().coarseness)]
    coarseness: f64,

    /// Direction of the light in the image, in degrees: 0 is from the right, 90 from the top [default: diffuse].
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true)]
    light: Option<f64>,

    /// Bright is deep, as in light joints between dark stones.
    #[arg(long)]
    invert: bool,

    /// Root mean square slope of the surface, from 0 to 10.
    #[arg(long, value_name = "N", default_value_t = EstimateOptions::default().slope)]
    slope: f64,

    /// Share of the estimated shading that is removed from the albedo, from 0 to 1.
    #[arg(long, value_name = "N", default_value_t = EstimateOptions::default().delight)]
    delight: f64,

    /// Mean roughness, from 0 to 1.
    #[arg(long, value_name = "N", default_value_t = EstimateOptions::default().roughness)]
    roughness: f64,

    /// Maximum deviation from the mean roughness, from 0 to 1.
    #[arg(long, value_name = "N", default_value_t = EstimateOptions::default().variation)]
    variation: f64,
}

/// Runs the subcommand.
///
/// # Errors
///
/// If an option, the photograph or another file is invalid.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    args.method.check_used()?;
    args.files.check()?;
    let progress = Progress::spinner("estimating", context);
    let mut loaded = input::map(
        &args.photo,
        Kind::Colors,
        args.part.region,
        args.alpha,
        &args.read,
        ALPHA_HINT,
    )?;
    args.part
        .rectify(&mut loaded)
        .with_context(|| input::name(&args.photo))?;
    let Map::Color(photo) = &loaded.map else {
        bail!("a photograph has colors");
    };
    let estimate = estimate_material(photo, &args.estimate.options())
        .map_err(|error| Error::new(error).wrong_value())?;
    // Cut all maps along the same lines.
    let relief = estimate.relief;
    let maps = maps_of(estimate);
    let tiles = match args.wrap {
        Axes::None => maps,
        wrap => best(&args.method, &maps, wrap.flags(), None)?.tiles,
    };
    drop(progress);
    let size = tiles[0].size();
    let note = args.size.and_then(|wanted| wanted.stretch_note(size));
    if let Some(note) = note.filter(|_| !context.quiet) {
        eprintln_if_possible(&format!("note: {note}"));
    }
    // One unit is the shorter side of the tile, and a height of 1 is as many pixels high as in the photograph.
    let recipe = recipe(args, size, relief / shorter_side(size));
    let images = ["albedo", "height", "roughness"]
        .into_iter()
        .zip(tiles)
        .map(|(name, tile)| (name.to_owned(), picture(tile)))
        .collect::<Images>();
    let size = args.size.map_or(size, |size| size.0);
    args.files.bake(size, recipe, images, context)?;
    Ok(Exit::Done)
}

impl EstimateArgs {
    fn options(&self) -> EstimateOptions {
        EstimateOptions {
            radius: self.even,
            coarseness: self.coarseness,
            light: self.light,
            invert: self.invert,
            slope: self.slope,
            delight: self.delight,
            roughness: self.roughness,
            variation: self.variation,
        }
    }
}

fn shorter_side([width, height]: [u32; 2]) -> f64 {
    f64::from(width.min(height))
}

fn maps_of(estimate: Estimate) -> Vec<Map> {
    vec![
        Map::Color(estimate.albedo),
        Map::Value(estimate.height),
        Map::Value(estimate.roughness),
    ]
}

/// Converts a tile to an image for the recipe, clamped to the range of its values. Methods that solve a linear system
/// may exceed that range.
fn picture(tile: Map) -> Picture {
    let unit = |values: Raster<f32>| values.map(|value| value.clamp(0.0, 1.0));
    match tile {
        Map::Value(values) => Picture::Numbers(Arc::new(unit(values))),
        Map::Color(colors) => Picture::Colors(Arc::new(colors)),
        Map::Normal(normals) => Picture::Numbers(Arc::new(normals.map(|normal| normal.z))),
    }
}

/// Returns the recipe of the material, with an image for each map.
fn recipe(args: &Args, size: [u32; 2], relief: f64) -> Recipe {
    let image = |file: &str| {
        Node::Image(ImageNode {
            file: file.to_owned(),
            alpha: None,
            layer: None,
        })
    };
    let names = ["albedo", "height", "roughness"];
    let shorter = shorter_side(size);
    Recipe {
        dapple: SCHEMA,
        name: match args.photo.file_stem() {
            Some(stem) if args.photo.as_os_str() != "-" => stem.to_string_lossy().into_owned(),
            _ => "photo".to_owned(),
        },
        about: "Estimated from one photograph".to_owned(),
        tags: Vec::new(),
        seed: Seed::default(),
        extent: size.map(|side| f64::from(side) / shorter),
        wrap: args.wrap.flags(),
        parameters: Default::default(),
        nodes: names
            .map(|name| (name.to_owned(), image(name)))
            .into_iter()
            .collect(),
        material: Material {
            height: Input::from("height"),
            relief,
            albedo: Some(Input::from("albedo")),
            roughness: Input::from("roughness"),
            ..Material::default()
        },
    }
}
