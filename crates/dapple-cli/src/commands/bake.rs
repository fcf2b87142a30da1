//! `dapple bake`: the maps of recipes.

mod batch;
mod claim;
mod documents;
mod images;
mod maps;
mod presets;
mod recipes;

use crate::args::{OutputArgs, Region, Size, seed};
use crate::baking::{advise, read_images, read_recipe, report};
use crate::encode::Format;
use crate::error::{Exit, Hint, usage};
use crate::foresight::foresee;
use crate::job::{Context, Job};
use crate::preview::{self, Thing};
use crate::progress::Progress;
use crate::words::Word;
use anyhow::{Error, Result};
use batch::Batch;
use claim::claim;
use dapple::color::NormalY;
use dapple::hash::Seed;
use dapple::recipe::{Bake, BakeMemory, BakeOptions, Plan, Recipe, RecipeError, RecipeErrorKind};
use dapple::tile::Map;
use maps::Maps;
use presets::Preset;
use serde::Serialize;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  dapple bake giraffe -o giraffe/
  dapple bake flagstone -o out/ --size 512 \\
    --maps height,normal,ao,albedo,roughness
  dapple bake my-rock.toml --maps orm,normal --normal-y directx -o rock/
  dapple bake marble --maps albedo -o marble.png --size 1024x512
  dapple bake clouds --maps height --size 4096 --region 0,0,512,512 -o part.exr
  dapple bake craters --maps height --size 4096x256 --banded -o wide.exr
  dapple bake rock ice marble -o all/ --size 256 --preview
  dapple bake 'my-*.toml' --keep-going --maps albedo --sheet -o mine/
  dapple bake rock --preset unity -o Assets/Rock/
  dapple bake rock -o rock.glb
  dapple bake marble -o marble.mtlx
  dapple bake mountains --maps height --size 2017 -o island.r16

`dapple recipe --list` names the built-in recipes, and `dapple recipe rock` prints one, to
begin your own with.

Units: heights are from 0 to 1, and `relief` in the recipe says how many units of the plane
a height of 1 stands for. Normals point out of the surface; occlusion is 1 where all of the
sky is seen; curvature is 0.5 where it is flat. Albedo is sRGB in PNG and linear in EXR and
NumPy arrays, and everything else is linear in all. For programs that know meters, a unit is one.";

/// Bake the maps of materials from recipes: height, normal, ao, curvature, albedo, roughness, metallic, orm.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(after_help = EXAMPLES, after_long_help = format!("{EXAMPLES}\n\n{}", presets::table()))]
pub(crate) struct Args {
    /// Built-in recipes, or files in TOML or JSON; `-` is standard input. A pattern such as 'rocks/*.toml' stands for the files
    /// that it matches, or for built-in recipes if there are none.
    #[arg(value_name = "RECIPE", required = true)]
    recipes: Vec<String>,

    /// Columns and rows of the tile, in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024")]
    size: Size,

    /// The maps, with commas between them, or all. By default height, normal, ao, albedo and roughness.
    #[arg(long, value_name = "MAPS")]
    maps: Option<Maps>,

    /// The images of a program: their names, what their channels hold, their bits, and where green points in normal maps.
    #[arg(long, value_name = "PROGRAM", value_parser = Preset::parser(), conflicts_with_all = ["maps", "format"])]
    preset: Option<&'static Preset>,

    /// The seed, instead of that of the recipe.
    #[arg(long, value_name = "N", value_parser = seed)]
    seed: Option<u64>,

    /// Make only this part of the tile, in pixels: bit for bit the crop of the whole.
    #[arg(long, value_name = "X,Y,W,H")]
    region: Option<Region>,

    /// Where green points in normal maps. By default as the preset or the recipe says, or else up (opengl).
    #[arg(long, value_name = "WAY", value_parser = Word::<NormalY>::all())]
    normal_y: Option<NormalY>,

    /// How many units of the plane a height of 1 stands for, from -1e6 to 1e6, instead of what the recipe says.
    #[arg(long, value_name = "UNITS")]
    relief: Option<f64>,

    /// Keep only a band of rows in memory, for large tiles. Refused where a node sees the whole tile, and needed past
    /// 32768 × 32768 pixels.
    #[arg(long)]
    banded: bool,

    /// Go on with the other recipes if one cannot be baked.
    #[arg(long)]
    keep_going: bool,

    /// Write 2 x 2 copies of each map, too, as `NAME_MAP_2x2`.
    #[arg(long, help_heading = "Output")]
    sheet: bool,

    /// Write a lit preview of the material, too, as `NAME_preview.png`: on a plane of 2 x 2 tiles or on a sphere.
    #[arg(long, value_name = "THING", value_parser = Word::<Thing>::all(), num_args = 0..=1, require_equals = true, default_missing_value = "plane", help_heading = "Output")]
    preview: Option<Thing>,

    /// The format; by default PNG with 16 bits, or by the ending of the output: EXR, a NumPy array, or raw heights.
    #[arg(long, value_name = "FORMAT", value_parser = Word::<Format>::all(), help_heading = "Output")]
    format: Option<Format>,

    #[command(flatten)]
    #[serde(skip)]
    files: OutputArgs,
}

/// A recipe with what its images are relative to.
struct Work {
    recipe: Recipe,
    folder: PathBuf,
}

/// Bakes the recipes.
///
/// # Errors
///
/// Options, recipes and files that are refused.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    args.check_document()?;
    let names = recipes::expanded(&args.recipes)?;
    let files = args.files_for(names.len())?;
    let mut batch = Batch::new(names.len(), args.keep_going, context);
    let mut works = Vec::new();
    for name in &names {
        // All recipes are read and all files claimed before the work begins.
        let work = Work::read(name, args).and_then(|work| {
            claim(
                args,
                &files,
                &work.recipe,
                &mut Job::new(context, "bake", &files),
            )?;
            Ok((name, work))
        });
        works.extend(batch.checked(name, work)?);
    }
    for (index, (name, work)) in works.iter().enumerate() {
        let is_same = |(_, other): &(&String, Work)| other.recipe.name == work.recipe.name;
        if works[..index].iter().any(is_same) {
            let message = format!(
                "{name} and another recipe are both called {}",
                work.recipe.name
            );
            return Err(usage(message).hint("give each a `name`"));
        }
    }
    let n_rows = u64::from(args.n_rows()) * works.len() as u64;
    let progress = Progress::bar("baking", n_rows, context);
    for (index, (name, work)) in (0..).zip(&works) {
        let baked = work.bake(args, &files, Job::new(context, "bake", &files), &progress);
        batch.checked(name, baked)?;
        progress.set(u64::from(args.n_rows()) * (index + 1));
    }
    drop(progress);
    Ok(batch.exit())
}

impl Work {
    fn read(name: &str, args: &Args) -> Result<Self> {
        let (mut recipe, folder) = read_recipe(name)?;
        args.change(&mut recipe);
        let folder = folder.to_owned();
        Ok(Self { recipe, folder })
    }

    fn bake(
        &self,
        args: &Args,
        files: &OutputArgs,
        mut job: Job<'_>,
        progress: &Progress,
    ) -> Result<()> {
        let recipe = &self.recipe;
        let claimed = claim(args, files, recipe, &mut job)?;
        let images = read_images(recipe, &self.folder)?;
        let plan = Plan::new(recipe, &images, 0.0).map_err(|error| args.blame(error))?;
        foresee(&plan, &args.options(), &claimed.images, &job)?;
        let bake =
            Bake::new(&plan, &args.options()).map_err(|error| advise(error).wrong_value())?;
        claimed.write(&mut job, bake, recipe, progress)?;
        if let (Some((output, format)), Some(thing)) = (claimed.preview, args.preview) {
            let picture = preview::picture(recipe, &images, thing)?;
            job.write_map(output, &Map::Color(picture), format)?;
        }
        job.finish(&Told { args, recipe }, report(recipe))
    }
}

/// The options and the recipe that they were used with, for the JSON file.
#[derive(Serialize)]
struct Told<'a> {
    #[serde(flatten)]
    args: &'a Args,
    #[serde(rename = "baked")]
    recipe: &'a Recipe,
}

impl Args {
    /// The only recipe, which has to be a file.
    ///
    /// # Errors
    ///
    /// If it is none.
    pub(super) fn only_file(&self) -> Result<&Path> {
        match self.recipes.as_slice() {
            [recipe] if Path::new(recipe).is_file() => Ok(Path::new(recipe)),
            _ => Err(usage("only a single recipe in a file can be watched")
                .hint("`dapple recipe NAME -o my.toml` writes one to begin with")),
        }
    }

    /// The size, after one like it with a longer side of `small` pixels, if that is less.
    pub(super) fn sizes(&self, small: u32) -> Vec<Size> {
        let longer = self.size.0[0].max(self.size.0[1]);
        if longer <= small || self.region.is_some() {
            return vec![self.size];
        }
        let side =
            |side: u32| (u64::from(side) * u64::from(small) / u64::from(longer)).max(1) as u32;
        vec![Size(self.size.0.map(side)), self.size]
    }

    /// Whether files that are there are replaced.
    pub(super) fn may_replace(&self) -> bool {
        self.files.force
    }

    /// These options with another size, and with or without `--force`.
    pub(super) fn at(&self, size: Size, may_replace: bool) -> Self {
        let mut args = Self {
            size,
            ..self.clone()
        };
        args.files.force = may_replace;
        args
    }

    /// The outputs of a number of recipes, which need a folder if there are several.
    fn files_for(&self, n_recipes: usize) -> Result<OutputArgs> {
        let mut files = self.files.clone();
        if n_recipes == 1 || files.output.is_none() {
            return Ok(files);
        }
        if files.name.is_some() || matches!(files.json, Some(Some(_))) {
            let message =
                format!("--name and --json=FILE are for one recipe, and there are {n_recipes}");
            return Err(usage(message).hint("their files are called after their names"));
        }
        // With a slash at its end it is a folder for the files of each.
        let folder = files.folder(n_recipes).map(|folder| folder.join(""));
        files.output = Some(folder.ok_or_else(|| {
            usage("several recipes need a folder").hint("let -o end with a slash, as in -o out/")
        })?);
        Ok(files)
    }

    /// How many rows of maps are baked for a recipe.
    fn n_rows(&self) -> u32 {
        let rows = self.region.map_or(self.size.0[1], |region| region.size[1]);
        if self.sheet { 2 * rows } else { rows }
    }

    /// Puts what the command line says into the recipe.
    fn change(&self, recipe: &mut Recipe) {
        if let Some(seed) = self.seed {
            recipe.seed = Seed(seed);
        }
        if let Some(relief) = self.relief {
            recipe.material.relief = relief;
        }
        let preset = self.preset().map(|preset| preset.normal_y);
        if let Some(normal_y) = self.normal_y.or(preset) {
            recipe.material.normal_y = normal_y;
        }
    }

    /// The refusal of a plan, as wrong usage if it is about the relief that was typed.
    fn blame(&self, error: RecipeError) -> Error {
        let is_typed = matches!(error.kind(), RecipeErrorKind::Range { value, .. } if self.relief == Some(*value));
        match is_typed {
            true => advise(error).wrong_value(),
            false => advise(error),
        }
    }

    fn options(&self) -> BakeOptions {
        BakeOptions {
            size: self.size.0,
            region: self.region.map(Region::of_recipe),
            maps: self.map_kinds(),
            memory: if self.banded {
                BakeMemory::Banded
            } else {
                BakeMemory::Whole
            },
        }
    }
}
