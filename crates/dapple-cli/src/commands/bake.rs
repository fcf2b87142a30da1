//! `dapple bake`: the maps of a recipe.

use crate::args::{OutputArgs, Region, Size, seed};
use crate::baking::{self, MapFile, advise, read_images, read_recipe};
use crate::encode::Format;
use crate::error::{Exit, Hint};
use crate::job::{Context, Job};
use crate::words::{Word, nearest, with_underscores};
use anyhow::Result;
use dapple::color::NormalY;
use dapple::hash::Seed;
use dapple::recipe::{Bake, BakeMemory, BakeOptions, MapKind, Plan, Recipe};
use serde::{Serialize, Serializer};
use serde_json::{Value, json};
use std::str::FromStr;

const EXAMPLES: &str = "\
Examples:
  dapple bake giraffe -o giraffe/
  dapple bake flagstone -o out/ --size 512 \\
    --maps height,normal,ao,albedo,roughness
  dapple bake my-rock.toml --maps orm,normal --normal-y directx -o rock/
  dapple bake marble --maps albedo -o marble.png --size 1024x512
  dapple bake clouds --maps height --size 4096 --region 0,0,512,512 -o part.exr
  dapple bake craters --maps height --size 4096x256 --banded -o wide.exr

`dapple recipe --list` names the built-in recipes, and `dapple recipe rock` prints one, to
begin your own with.

Units: heights are from 0 to 1, and `relief` in the recipe says how many units of the plane
a height of 1 stands for. Normals point out of the surface; occlusion is 1 where all of the
sky is seen; curvature is 0.5 where it is flat. Albedo is sRGB in PNG and linear in EXR, and
everything else is linear in both.";

/// Bake the maps of a material from a recipe: height, normal, ao, curvature, albedo, roughness, metallic, orm.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A built-in recipe, or a file in TOML or JSON; `-` is standard input.
    #[arg(value_name = "RECIPE")]
    recipe: String,

    /// Columns and rows of the tile, in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024")]
    size: Size,

    /// The maps, with commas between them, or all.
    #[arg(
        long,
        value_name = "MAPS",
        default_value = "height,normal,ao,albedo,roughness"
    )]
    maps: Maps,

    /// Another seed than that of the recipe.
    #[arg(long, value_name = "N", value_parser = seed)]
    seed: Option<u64>,

    /// Make only this part of the tile, in pixels: bit for bit the crop of the whole.
    #[arg(long, value_name = "X,Y,W,H")]
    region: Option<Region>,

    /// Where green points in normal maps: up (opengl: Blender, Unity, Godot, glTF) or down (directx: Unreal). By default as
    /// the recipe has it, which is up unless it says otherwise.
    #[arg(long, value_name = "WAY", value_parser = Word::<NormalY>::of(&["opengl", "directx"]))]
    normal_y: Option<NormalY>,

    /// How many units of the plane a height of 1 stands for, instead of what the recipe says.
    #[arg(long, value_name = "UNITS")]
    relief: Option<f64>,

    /// Keep only some rows in memory, however large the tile is. Refused where a node sees the whole tile.
    #[arg(long)]
    banded: bool,

    /// The format; by default PNG with 16 bits, or EXR where the output ends in `.exr`.
    #[arg(long, value_enum, value_name = "FORMAT", help_heading = "Output")]
    format: Option<Format>,

    #[command(flatten)]
    #[serde(skip)]
    files: OutputArgs,
}

/// The maps that are baked, each once.
#[derive(Clone, Debug)]
struct Maps(Vec<MapKind>);

impl FromStr for Maps {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if with_underscores(text) == "all" {
            return Ok(Self(MapKind::ALL.to_vec()));
        }
        let mut maps = Vec::new();
        for name in text.split(',') {
            let names = || MapKind::ALL.into_iter().map(MapKind::name);
            let word = with_underscores(name);
            let kind = MapKind::from_name(&word).ok_or_else(|| match nearest(&word, names()) {
                Some(near) => format!("{name:?} is no map; did you mean {near}?"),
                None => format!(
                    "{name:?} is no map; there are {}, or all",
                    names().collect::<Vec<_>>().join(", ")
                ),
            })?;
            if maps.contains(&kind) {
                return Err(format!("the map {} is asked for twice", kind.name()));
            }
            maps.push(kind);
        }
        Ok(Self(maps))
    }
}

impl Serialize for Maps {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(|kind| kind.name()))
    }
}

/// Runs it.
///
/// # Errors
///
/// Whatever went wrong.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let (mut recipe, folder) = read_recipe(&args.recipe)?;
    args.change(&mut recipe);
    let mut job = Job::new(context, "bake", &args.files);
    let files = claim(args, &recipe, &mut job)?;
    let images = read_images(&recipe, folder)?;
    let plan = Plan::new(&recipe, &images, 0.0).map_err(advise)?;
    let mut bake =
        Bake::new(&plan, &args.options()).map_err(|error| advise(error).wrong_value())?;
    baking::write(&mut job, &mut bake, &files)?;
    job.finish(
        &Told {
            args,
            recipe: &recipe,
        },
        report(&recipe),
    )?;
    Ok(Exit::Done)
}

/// The options and the recipe that they were used with, for the JSON file.
#[derive(Serialize)]
struct Told<'a> {
    #[serde(flatten)]
    args: &'a Args,
    #[serde(rename = "baked")]
    recipe: &'a Recipe,
}

/// What programs that read the maps need to know.
fn report(recipe: &Recipe) -> Value {
    json!({
        "name": recipe.name,
        "seed": recipe.seed.0,
        "extent": recipe.extent,
        "repeats": recipe.wrap,
        "relief": recipe.material.relief,
    })
}

impl Args {
    /// Puts what the command line says into the recipe.
    fn change(&self, recipe: &mut Recipe) {
        if let Some(seed) = self.seed {
            recipe.seed = Seed(seed);
        }
        if let Some(relief) = self.relief {
            recipe.material.relief = relief;
        }
        if let Some(normal_y) = self.normal_y {
            recipe.material.normal_y = normal_y;
        }
    }

    fn options(&self) -> BakeOptions {
        BakeOptions {
            size: self.size.0,
            region: self.region.map(Region::of_recipe),
            maps: self.maps.0.clone(),
            memory: if self.banded {
                BakeMemory::Banded
            } else {
                BakeMemory::Whole
            },
        }
    }
}

/// Claims a file for each map: the output itself for a single map, unless that is a folder, and else `NAME_MAP.png`.
fn claim(args: &Args, recipe: &Recipe, job: &mut Job<'_>) -> Result<Vec<MapFile>> {
    let names: Vec<_> = args.maps.0.iter().map(|kind| kind.name()).collect();
    let ending = args.format.map_or("png", Format::ending);
    let targets = args.files.targets(&recipe.name, &names, ending)?;
    let mut files = Vec::new();
    for (&kind, target) in args.maps.0.iter().zip(&targets.files) {
        let format = baking::format(args.format, target)?;
        files.push(MapFile {
            kind,
            output: job.claim(target)?,
            format,
        });
    }
    job.claim_sidecar(&targets.main)?;
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::Maps;

    #[test]
    fn maps_go_by_their_names_in_any_case() {
        let names = |text: &str| -> Result<Vec<_>, String> {
            let maps: Maps = text.parse()?;
            Ok(maps.0.iter().map(|kind| kind.name()).collect())
        };
        assert_eq!(names("AO, BaseColor"), Ok(vec!["ao", "albedo"]));
        assert_eq!(names("base-color"), names("albedo"));
        assert_eq!(names("All").map(|maps| maps.len()), Ok(8));
        for (wrong, part) in [
            ("bumps", "roughness"),
            ("heigth", "height?"),
            ("ao,ao", "twice"),
        ] {
            let error = names(wrong).unwrap_err();
            assert!(error.contains(part), "{wrong}: {error}");
        }
    }
}
