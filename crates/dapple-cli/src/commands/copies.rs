//! `dapple copies`: covers a map with varied copies of tiles.

mod method;

use super::blend::alpha::{self, AlphaForm};
use super::blend::layer::{HEIGHT, LayerArg, Material, Reader};
use crate::args::{AlphaArgs, ImageArgs, MapArg, ReadArgs, Size, seed};
use crate::encode::{Clear, Cover};
use crate::error::{Exit, Hint, usage};
use crate::job::{Context, Job};
use crate::output::OutputIdx;
use crate::progress::Progress;
use anyhow::{Error, Result};
use dapple::hash::Seed;
use dapple::tile::{Map, TileError, TileErrorKind};
use method::{MethodArgs, Tiles};
use serde::Serialize;
use serde_json::Value;

const EXAMPLES: &str = "\
Examples:
  dapple copies stones.png --size 256 -o ground.png
  dapple copies rock.png grass.png --size 256x128 --seed 7 -o board.png
  dapple copies rock.png sand.png --map normal=rock_normal.png --map normal=normal.png \\
    --size 256 -o ground/
  dapple copies rock.png grass.png sand.png --method borders --tiles -o tiles/
  dapple copies rock.png grass.png --method corners --tiles -o set/

Which method:
  disturb  one tile: each copy keeps its border, and inside of it has another piece of the tile;
           the default for one tile
  corners  two to four tiles: pieces of them, chosen by random colors at the corners where
           pieces meet; the default for two to four
  borders  any number: all get the border of the first one and lie in random order;
           the default for more

Tiles repeat by themselves, as those of `dapple tile` do. A map of whole tiles repeats, too.
Further maps of the tiles follow as --map height=FILE, --map normal=FILE or --map NAME=FILE, once
for each tile, or behind commas as in a layer of `dapple blend`. All maps of a tile are cut along
the same line.";

/// Cover a map with varied copies of a tile, or with several tiles in random order.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The tiles: an image each, with its other maps.
    #[arg(value_name = "IMAGE[,KEY=FILE...]", required = true)]
    images: Vec<LayerArg>,

    /// Further map, such as normal=FILE; the first of a name belongs to the first image, and so on; repeatable.
    #[arg(long, value_name = "NAME=IMAGE")]
    map: Vec<MapArg>,

    /// Output size in pixels.
    #[arg(
        long,
        value_name = "WxH",
        required_unless_present = "tiles",
        conflicts_with = "tiles"
    )]
    size: Option<Size>,

    /// Random seed, any whole number from 0 to 2^64 - 1.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed, conflicts_with = "tiles")]
    seed: u64,

    #[command(flatten)]
    #[serde(flatten)]
    alpha: AlphaArgs,

    #[command(flatten)]
    #[serde(flatten)]
    read: ReadArgs,

    #[command(flatten)]
    method: MethodArgs,

    /// Write the tiles themselves, for a program that lays them out.
    ///
    /// Tiles with matched borders have a number starting at 1, as in `NAME_1`. Corner tiles have the colors of their
    /// corners (top left and right, bottom left and right), as in `NAME_1221`.
    #[arg(long, help_heading = "Output")]
    tiles: bool,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// Runs the subcommand.
///
/// # Errors
///
/// If an option, an image or another file is invalid.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let args = &Args {
        images: LayerArg::with_maps(&args.images, &args.map)?,
        ..args.clone()
    };
    let method = args.method.method(args.images.len(), args.tiles)?;
    let names = names(args)?;
    let mut job = Job::new(context, "copies", &args.image.files);
    let sets = match args.tiles {
        true => method.tile_names(args.images.len()),
        false => vec![String::new()],
    };
    let outputs = claim(args, &sets, &names, &mut job)?;
    let (materials, form, is_deep) = read(args)?;
    let progress = Progress::spinner("cutting", context);
    let tiles = Tiles {
        method,
        materials: &materials,
    };
    let made = match args.size {
        Some(Size(size)) => tiles.render(Seed(args.seed), size).map(|maps| vec![maps]),
        None => tiles.tiles(),
    };
    let made = made.map_err(advise)?;
    drop(progress);
    let mut outputs = outputs.into_iter();
    for mut maps in made {
        let alpha = alpha::take(&mut maps, form)?;
        let mut cover = Cover::of(
            alpha.as_ref(),
            form == AlphaForm::Associated,
            Clear::NOT_WRAPPED,
        );
        for (map, output) in maps.into_iter().zip(&mut outputs) {
            // The alpha belongs to the first map.
            job.write_with_alpha(output, map, cover.take(), is_deep, &args.image)?;
        }
    }
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}

/// Returns the names of the maps, with the height last if there is one. Fails unless all tiles have the same maps.
fn names(args: &Args) -> Result<Vec<&str>> {
    let of = |tile: &LayerArg| -> Vec<String> {
        let height = tile.has_height().then_some(HEIGHT);
        let names = tile.map_names().into_iter().chain(height);
        names.map(str::to_owned).collect()
    };
    let first = &args.images[0];
    for tile in &args.images {
        if tile.has_weight() {
            let message = format!(
                "{} has a weight, which a tile does not take",
                tile.path().display()
            );
            return Err(usage(message).hint("give it to a layer of `dapple blend`"));
        }
        if of(tile) != of(first) {
            let message = format!(
                "{} has the maps {}, but {} has {}",
                first.path().display(),
                of(first).join(", "),
                tile.path().display(),
                of(tile).join(", ")
            );
            return Err(usage(message).hint("give all tiles the same maps"));
        }
    }
    let height = first.has_height().then_some(HEIGHT);
    Ok(first.map_names().into_iter().chain(height).collect())
}

/// Claims an output for each map of each tile of `sets`, the names of the tiles. A map of copies counts as one tile
/// with an empty name.
fn claim(
    args: &Args,
    sets: &[String],
    names: &[&str],
    job: &mut Job<'_>,
) -> Result<Vec<OutputIdx>> {
    let part = |tile: &String, name: &str| match (tile.as_str(), names.len()) {
        ("", 1) => String::new(),
        ("", _) => name.to_owned(),
        (tile, 1) => tile.to_owned(),
        (tile, _) => format!("{tile}_{name}"),
    };
    let parts = sets
        .iter()
        .flat_map(|tile| names.iter().map(move |name| part(tile, name)));
    let parts: Vec<_> = parts.collect();
    let targets = args
        .image
        .files
        .targets("copies", &parts, args.image.ending())?;
    job.claim_images(&targets, args.image.format)
}

/// Reads the maps of all tiles: for each tile, the maps, its height, and last its alpha. Also returns how the alpha is
/// stored, and whether any image has more than 8 bits per channel.
fn read(args: &Args) -> Result<(Vec<Vec<Map>>, AlphaForm, bool)> {
    let mut reader = Reader::new(
        None,
        args.alpha.alpha,
        &args.read,
        "tiles and their maps must have the same size",
    );
    let read = args.images.iter().map(|tile| tile.read(&mut reader));
    let mut materials = read.collect::<Result<Vec<Material>>>()?;
    reader.agree(&args.images, &mut materials)?;
    for material in &mut materials {
        material.maps.extend(material.height.take().map(Map::Value));
    }
    let form = alpha::multiply(&mut materials)?;
    let is_deep = materials.iter().any(|material| material.is_deep);
    let maps = materials.into_iter().map(|material| material.maps);
    Ok((maps.collect(), form, is_deep))
}

/// Adds a hint to common errors.
fn advise(error: TileError) -> Error {
    let hint = match error.kind() {
        TileErrorKind::Margin { .. } => {
            "take a smaller --frozen or --margin for disturb, or a smaller --width for borders"
        }
        TileErrorKind::KindMismatch { .. } => "give gray images for a map in all tiles, or in none",
        TileErrorKind::NotFinite { .. } => return error.into(),
        _ => return Error::new(error).wrong_value(),
    };
    Error::new(error).hint(hint).wrong_value()
}
