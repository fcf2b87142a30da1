//! `dapple bake`: the maps of a recipe.

use crate::args::{OutputArgs, Region, Size};
use crate::baking::{self, MapFile, advise, read_images, read_recipe};
use crate::encode::Format;
use crate::error::{Exit, Hint, usage};
use crate::job::{Context, Job};
use crate::output::Target;
use anyhow::Result;
use clap::ValueEnum;
use dapple::color::NormalY;
use dapple::hash::Seed;
use dapple::recipe::{BakeMemory, BakeOptions, MapKind, Plan, Recipe};
use serde::Serialize;
use serde_json::{Value, json};

const EXAMPLES: &str = "\
Examples:
  dapple bake giraffe -o giraffe/
  dapple bake flagstone -o out/ --size 512 \\
    --maps height,normal,ao,albedo,roughness
  dapple bake my-rock.toml --maps orm,normal --normal directx -o rock/
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

    /// The maps, with commas between them.
    #[arg(long, value_name = "MAPS", value_delimiter = ',', default_value = "height,normal,ao,albedo,roughness", value_parser = map_kind)]
    #[serde(serialize_with = "names")]
    maps: Vec<MapKind>,

    /// Another seed than that of the recipe.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,

    /// Make only this part of the tile, in pixels: bit for bit the crop of the whole.
    #[arg(long, value_name = "X,Y,W,H")]
    region: Option<Region>,

    /// Where green points in normal maps: up (opengl: Blender, Unity, Godot, glTF) or down (directx: Unreal). By default as
    /// the recipe has it, which is up unless it says otherwise.
    #[arg(long, value_enum, value_name = "WAY")]
    normal: Option<NormalWay>,

    /// How many units of the plane a height of 1 stands for, from -1e6 to 1e6, instead of what the recipe says.
    #[arg(long, value_name = "UNITS")]
    relief: Option<f64>,

    /// Keep only some rows in memory, however large the tile is. Refused where a node sees the whole tile, and needed past
    /// 32768 × 32768 pixels.
    #[arg(long)]
    banded: bool,

    /// The format; by default PNG with 16 bits, or EXR where the output ends in `.exr`.
    #[arg(long, value_enum, value_name = "FORMAT", help_heading = "Output")]
    format: Option<Format>,

    #[command(flatten)]
    #[serde(skip)]
    files: OutputArgs,
}

/// Where green points.
#[derive(Clone, Copy, Debug, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
enum NormalWay {
    /// Up.
    #[value(name = "opengl")]
    OpenGl,
    /// Down.
    #[value(name = "directx")]
    DirectX,
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
    let sidecar = args
        .files
        .folder()
        .map(|folder| folder.join(file_name(&recipe.name) + ".json"));
    job.claim_sidecar_or(sidecar)?;
    let images = read_images(&recipe, folder)?;
    let plan = Plan::new(&recipe, &images, 0.0).map_err(advise)?;
    baking::bake(&mut job, &plan, &args.options(), &files)?;
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
        match self.normal {
            Some(NormalWay::OpenGl) => recipe.material.normal_y = NormalY::OpenGl,
            Some(NormalWay::DirectX) => recipe.material.normal_y = NormalY::DirectX,
            None => {}
        }
    }

    fn options(&self) -> BakeOptions {
        BakeOptions {
            size: self.size.0,
            region: self.region.map(Region::of_recipe),
            maps: self.maps.clone(),
            memory: if self.banded {
                BakeMemory::Banded
            } else {
                BakeMemory::Whole
            },
        }
    }
}

/// Claims a file for each map: in a folder as `NAME_MAP.png`, or the output itself for a single map.
fn claim(args: &Args, recipe: &Recipe, job: &mut Job<'_>) -> Result<Vec<MapFile>> {
    for (index, kind) in args.maps.iter().enumerate() {
        if args.maps[..index].contains(kind) {
            return Err(usage(format!("the map {} is asked for twice", kind.name())));
        }
    }
    let file = |job: &mut Job<'_>, kind, target: &Target| -> Result<MapFile> {
        let format = baking::format(args.format, target)?;
        Ok(MapFile {
            kind,
            output: job.claim(target)?,
            format,
        })
    };
    let Some(folder) = args.files.folder() else {
        let target = args.files.target()?;
        let &[kind] = &args.maps[..] else {
            return Err(usage("several maps need a folder")
                .hint("let -o end with a slash, as in -o out/, or ask for one map with --maps"));
        };
        return Ok(vec![file(job, kind, &target)?]);
    };
    job.make_folder(folder)?;
    let ending = args.format.map_or("png", Format::ending);
    let mut files = Vec::new();
    for &kind in &args.maps {
        let name = format!("{}_{}.{ending}", file_name(&recipe.name), kind.name());
        files.push(file(job, kind, &Target::Path(folder.join(name)))?);
    }
    Ok(files)
}

/// The name of a recipe as a part of file names: what is no letter, digit or `.` becomes `-`.
fn file_name(name: &str) -> String {
    let plain = |c: char| {
        if c.is_alphanumeric() || c == '.' || c == '_' {
            c
        } else {
            '-'
        }
    };
    let name: String = name.chars().map(plain).collect();
    let name = name.trim_start_matches('.');
    if name.is_empty() {
        "recipe".to_owned()
    } else {
        name.to_owned()
    }
}

fn map_kind(text: &str) -> Result<MapKind, String> {
    MapKind::from_name(text.trim()).ok_or_else(|| {
        let names: Vec<_> = MapKind::ALL.iter().map(|kind| kind.name()).collect();
        format!("{text:?} is no map; there are {}", names.join(", "))
    })
}

fn names<S: serde::Serializer>(maps: &[MapKind], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(maps.iter().map(|kind| kind.name()))
}

#[cfg(test)]
mod tests {
    use super::{file_name, map_kind};

    #[test]
    fn names_of_recipes_are_safe_in_file_names() {
        for (name, expected) in [
            ("giraffe", "giraffe"),
            ("my rock", "my-rock"),
            ("../up", "-up"),
            ("..", "recipe"),
            ("a/b", "a-b"),
        ] {
            assert_eq!(file_name(name), expected, "{name}");
        }
    }

    #[test]
    fn maps_go_by_their_names() {
        assert_eq!(map_kind("ao").map(|kind| kind.name()), Ok("ao"));
        assert!(
            map_kind("bumps").is_err_and(|error| error.contains("normal")),
            "the names are told"
        );
    }
}
