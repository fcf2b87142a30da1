//! `dapple blend`: blends materials by weights.

pub(super) mod alpha;
pub(super) mod layer;
mod mixing;

use crate::args::{AlphaArgs, ImageArgs, MapArg, ReadArgs, Size};
use crate::encode::{Clear, Cover};
use crate::error::{Exit, Hint, usage};
use crate::input::{self, Kind};
use crate::job::{Context, Job};
use crate::output::OutputIdx;
use crate::progress::Progress;
use alpha::AlphaForm;
use anyhow::{Context as _, Error, Result};
use dapple::raster::Raster;
use dapple::tile::{Layer, Map, TileError, TileErrorKind, blend, blend_by_tile, rank_equalize};
use layer::{LayerArg, Reader};
use mixing::MixingArgs;
use serde::Serialize;
use serde_json::Value;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  dapple blend rock.png grass.png -o half.png
  dapple blend rock.png grass.png,weight=mask.png -o painted.png
  dapple blend rock.png,height=rock_height.png \\
    grass.png,height=grass_height.png,weight=mask.png --depth 0.1 -o both.png
  dapple blend rock.png grass.png,weight=0.3 --tile cracks.png --gain 8 -o cracked.png
  dapple blend rock.png,normal=rock_normal.png,height=rock_height.png \\
    grass.png,normal=grass_normal.png,height=grass_height.png,weight=mask.png -o material/
  dapple blend rock.png grass.png,weight=mask.png --size 512 \\
    --mixing keep-variance -o large.png

Layers:
  A layer is an image, and behind commas what belongs to it:
    weight=0.3 or weight=mask.png   how much of it there is
    height=FILE                     its height, from 0 to 1: what is higher shows; in a folder
                                    the heights are blended like other maps, if all have one
    normal=FILE                     its normals
    NAME=FILE                       another map, such as roughness=FILE
  Maps may also follow as --map normal=FILE, once for each layer, bottom first.
  The layer without a weight is the ground: it gets what the others leave, 1 less their
  weights. Without any weights all layers get the same.

How the weights are used, unless --weighting says it:
  mask    where there is a --tile: it is cut at thresholds, and the layers that are named
          later lie where it is lower
  height  where a layer has a height: what is higher shows
  given   else, as they are: plain splatting";

/// Blend textures by weights, by heights, or along the features of a blend tile.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The layers, bottom first: an image, with its other maps and options.
    #[arg(value_name = "IMAGE[,KEY=VALUE...]", required = true)]
    layers: Vec<LayerArg>,

    /// Further map, such as normal=FILE; the first of a name belongs to the first image, and so on; repeatable.
    #[arg(long, value_name = "NAME=IMAGE")]
    map: Vec<MapArg>,

    /// A blend tile, such as one from `dapple blend-map`; any gray image works.
    #[arg(long, value_name = "IMAGE")]
    tile: Option<PathBuf>,

    /// Use the values of the tile unchanged, without equalizing their distribution.
    ///
    /// By default they are equalized, so that weights are areas.
    #[arg(long, requires = "tile")]
    plain_tile: bool,

    #[command(flatten)]
    #[serde(flatten)]
    alpha: AlphaArgs,

    #[command(flatten)]
    #[serde(flatten)]
    read: ReadArgs,

    #[command(flatten)]
    mixing: MixingArgs,

    /// Output size in pixels; smaller images repeat, larger ones are cropped [default: the common size].
    ///
    /// Without it all images must have the same size.
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// Blends the layers.
///
/// # Errors
///
/// If an option, an image or another file is invalid.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let args = &Args {
        layers: LayerArg::with_maps(&args.layers, &args.map)?,
        ..args.clone()
    };
    let mut job = Job::new(context, "blend", &args.image.files);
    let outputs = claim(args, &mut job)?;
    let hint = "--size WxH repeats what is smaller and cuts what is larger";
    let mut reader = Reader::new(args.size, args.alpha.alpha, &args.read, hint);
    let read = args.layers.iter().map(|layer| layer.read(&mut reader));
    let mut materials = read.collect::<Result<Vec<_>>>()?;
    reader.agree(&args.layers, &mut materials)?;
    if outputs.len() > materials[0].maps.len() {
        // Write the heights as a map, too.
        for material in &mut materials {
            let height = material.height.clone().map(Map::Value);
            material.maps.extend(height);
        }
    }
    let form = alpha::multiply(&mut materials)?;
    let tile = tile(args, &mut reader)?;
    let weights = layer::weights(&materials, materials[0].maps[0].size())?;
    let mut layers = Vec::new();
    // Reverse the order: the library shows its first layer where the tile is lowest, where the top layer shall begin.
    for (material, weight) in materials.iter().zip(&weights).rev() {
        layers.push(Layer {
            maps: &material.maps,
            weight,
            height: material.height.as_ref(),
        });
    }
    let has_heights = materials.iter().any(|material| material.height.is_some());
    let how = args.mixing.blend(tile.is_some(), has_heights)?;
    let progress = Progress::spinner("blending", context);
    let maps = match &tile {
        Some(tile) => blend_by_tile(&layers, tile, &how),
        None => blend(&layers, &how),
    };
    let mut maps = maps.map_err(advise)?;
    let alpha = alpha::take(&mut maps, form)?;
    let mut cover = Cover::of(
        alpha.as_ref(),
        form == AlphaForm::Associated,
        Clear::NOT_WRAPPED,
    );
    drop(progress);
    let is_deep = materials.iter().any(|material| material.is_deep);
    for (map, output) in maps.into_iter().zip(outputs) {
        // The alpha belongs to the first map.
        job.write_with_alpha(output, map, cover.take(), is_deep, &args.image)?;
    }
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}

/// Claims an output for each map. If the output is a directory and all layers have heights, the heights also get one.
fn claim(args: &Args, job: &mut Job<'_>) -> Result<Vec<OutputIdx>> {
    let names = args.layers[0].map_names();
    for layer in &args.layers[1..] {
        if layer.map_names() != names {
            let message = format!(
                "{} has the maps {}, but {} has {}",
                args.layers[0].path().display(),
                names.join(", "),
                layer.path().display(),
                layer.map_names().join(", ")
            );
            return Err(usage(message).hint("give all layers the same maps"));
        }
    }
    let mut names = names;
    let files = &args.image.files;
    let is_one_file = names.len() == 1 && files.folder(1).is_none();
    if !is_one_file && args.layers.iter().all(LayerArg::has_height) {
        names.push(layer::HEIGHT);
    }
    let targets = files.targets("blend", &names, args.image.ending())?;
    job.claim_images(&targets, args.image.format)
}

/// Reads the blend tile, repeated or cropped to the size of the blend. Without `--plain-tile`, its values are replaced
/// by their ranks.
fn tile(args: &Args, reader: &mut Reader<'_>) -> Result<Option<Raster<f32>>> {
    let Some(path) = &args.tile else {
        return Ok(None);
    };
    let values = layer::values(reader.read_opaque(path, Kind::ByChannels)?.map);
    if args.plain_tile {
        return Ok(Some(values));
    }
    let ranks = rank_equalize(&values);
    Ok(Some(ranks.with_context(|| input::name(path))?))
}

/// Adds a hint to common errors.
fn advise(error: TileError) -> Error {
    let hint = match error.kind() {
        TileErrorKind::Raster(_) => "--size WxH repeats what is smaller and cuts what is larger",
        TileErrorKind::KindMismatch { .. } => {
            "give gray images for a map in all layers, or in none"
        }
        TileErrorKind::Range { .. } => return Error::new(error).wrong_value(),
        TileErrorKind::Wavelet(_) => {
            let hint = "take fewer --levels, or --wrap none";
            return Error::new(error).hint(hint).wrong_value();
        }
        TileErrorKind::Count {
            what: "heights", ..
        } => "give every layer height=FILE, or a --tile",
        _ => return error.into(),
    };
    Error::new(error).hint(hint)
}
