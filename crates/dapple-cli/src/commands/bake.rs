//! `dapple bake`: bakes the maps of recipes.

mod batch;
mod claim;
mod contact_sheet;
mod documents;
mod files;
mod flipbook;
mod images;
mod maps;
mod material;
mod presets;
mod recipes;
mod seeds;
mod unity;

use crate::args::{Frame, OutputArgs, Region, Shard, Size};
use crate::baking::{STILL, advise, advise_shard, read_images, read_recipe, report};
use crate::encode::Format;
use crate::error::{Exit, Hint, usage};
use crate::estimate::print_estimate;
use crate::gpu;
use crate::job::{Context, Job};
use crate::preview::{self, Thing};
use crate::progress::Progress;
use crate::shards::{List, Wanted};
use crate::words::{NamedValueParser, unknown};
use anyhow::Result;
use batch::Batch;
use claim::{Claimed, claim};
use contact_sheet::ContactSheet;
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::{
    Bake, BakeMemory, BakeOptions, Images, Input, MapKind, Material, Plan, PlanCache, PlanLimits,
    Recipe, Samples,
};
use dapple::tile::Map;
pub(super) use files::MaterialFiles;
use maps::Maps;
pub(super) use material::{MaterialArgs, Setting};
use presets::Preset;
use serde::Serialize;
use std::path::{Path, PathBuf};
#[cfg(feature = "studio")]
use std::sync::{Arc, atomic::AtomicBool};

const EXAMPLES: &str = "\
Examples:
  dapple bake giraffe -o giraffe/
  dapple bake flagstone -o out/ --size 512 \\
    --maps height,normal,ao,albedo,roughness
  dapple bake my-rock.toml --maps orm,normal --normal-y directx -o rock/
  dapple bake marble --maps albedo -o marble.png --size 1024x512
  dapple bake brick-wall --size 512 --supersample 3 -o bricks/
  dapple bake clouds --maps height --size 4096 --region 0,0,512,512 -o part.exr
  dapple bake craters --maps height --size 4096x256 --banded -o wide.exr
  dapple bake rock ice marble -o all/ --size 256 --preview
  dapple bake flagstone --set joint.seed=5 --set material.relief=0.6 -o deep/
  dapple bake rock --seed 1-20 --size 256 --maps albedo --contact-sheet -o variants/
  dapple bake flagstone --node joint -o joint.png
  dapple bake 'my-*.toml' --keep-going --maps albedo --sheet -o mine/
  dapple bake rock --preset unity -o Assets/Rock/
  dapple bake rock --preset unreal,godot -o rock/
  dapple bake granite -o granite.tres
  dapple bake rock -o rock.glb
  dapple bake marble -o marble.mtlx
  dapple bake mountains --maps height --size 2017 --samples corners -o island.r16
  dapple bake rock --size 8192 --shard 3,1,512 -o parts/
  dapple bake sea-water --frames 24 --size 128 --maps normal,albedo -o sea/
  dapple bake sea-water --flipbook 6x4 --size 128 --maps normal -o waves.png

`dapple recipe --list` names the built-in recipes, and `dapple recipe rock` prints one, to
begin your own with.

Units: heights are from 0 to 1, and `relief` in the recipe says how many units of the plane
a height of 1 stands for. Normals point out of the surface; occlusion is 1 where all of the
sky is seen; curvature is 0.5 where it is flat. Albedo is sRGB in PNG and linear in EXR and
NumPy arrays, and everything else is linear in all. For programs that know meters, a unit is one.";

/// Bake the maps of materials from recipes: height, normal, ao, curvature, albedo, roughness, metallic, orm, emission,
/// opacity, specular, clearcoat.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(after_help = EXAMPLES, after_long_help = format!("{EXAMPLES}\n\n{}", presets::table()))]
pub(crate) struct Args {
    /// Built-in recipes, or files in TOML or JSON; `-` is standard input.
    ///
    /// A pattern such as 'rocks/*.toml' selects the files that it matches, or built-in recipes if there are none.
    #[arg(value_name = "RECIPE", required = true)]
    recipes: Vec<String>,

    #[command(flatten)]
    #[serde(flatten)]
    material: MaterialArgs,

    /// Write the files that a program expects: names, channel packing, bit depth and normal direction.
    ///
    /// The files of several programs, with commas between them, go to a directory of each.
    #[arg(long, value_name = "PROGRAM,…", value_delimiter = ',', value_parser = Preset::parser(), conflicts_with_all = ["maps", "format"])]
    preset: Vec<&'static Preset>,

    /// Bake this node alone, as a height or, if it has colors, as an albedo map.
    ///
    /// Its values may be ids, so it is not baked with --supersample.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["preset", "maps", "shard", "preview", "supersample"])]
    node: Option<String>,

    /// Bake only this region, in pixels: bit for bit a crop of the whole.
    #[arg(long, value_name = "X,Y,W,H")]
    region: Option<Region>,

    /// Bake only this shard, as `dapple shards` lists it.
    ///
    /// These are its column and row, from 0, and the size of all shards, with their overlap. It is written to a
    /// directory of its list in the output, as EXR, and not baked again if it is there.
    #[arg(long, value_name = "COLUMN,ROW,WxH[+OVERLAP]", conflicts_with_all = ["region", "preset", "sheet", "preview", "format", "name", "json"])]
    shard: Option<Shard>,

    /// Frame K of a loop of N, from 1 [default: the first].
    #[arg(long, value_name = "K/N")]
    frame: Option<Frame>,

    /// Bake all N frames of a loop.
    ///
    /// The files are those of `--frame 1/N` to `--frame N/N`, in a directory, with names that end in 001 and so on.
    /// Parts that do not move are computed once.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000), conflicts_with_all = ["frame", "shard"])]
    frames: Option<u32>,

    /// Write all frames of a loop into one image for each map: a grid with this number of columns and rows.
    ///
    /// The loop has a frame for each cell, from the top left, row by row.
    #[arg(long, value_name = "COLUMNSxROWS", conflicts_with_all = ["frame", "frames", "shard", "sheet"])]
    flipbook: Option<Size>,

    /// Keep only a band of rows in memory; required past 32768 × 32768 pixels.
    ///
    /// Refused where a node sees the whole tile.
    #[arg(long)]
    banded: bool,

    /// Compute nodes on a GPU, with the same bytes.
    ///
    /// Nodes without a shader, normals and occlusion are computed on the CPU. Needs a program with the feature `gpu`.
    #[arg(long)]
    #[serde(skip)]
    gpu: bool,

    /// Continue with the other recipes if one fails.
    #[arg(long)]
    keep_going: bool,

    /// Also write 2 x 2 copies of each map, as `NAME_MAP_2x2`.
    #[arg(long, help_heading = "Output")]
    sheet: bool,

    /// Also write a lit preview, `NAME_preview.png`, on a sphere, a plane of 2 x 2 tiles or a torus.
    #[arg(long, value_name = "THING", value_parser = NamedValueParser::<Thing>::all(), num_args = 0..=1, require_equals = true, default_missing_value = "sphere", help_heading = "Output")]
    preview: Option<Thing>,

    /// Also write `contact_sheet.png`, with a lit preview of each recipe and seed: on a sphere, or as by --preview.
    #[arg(long, conflicts_with_all = ["shard", "node"], help_heading = "Output")]
    contact_sheet: bool,

    /// File format [default: by the extension of the output, else PNG with 16 bits].
    #[arg(long, value_name = "FORMAT", value_parser = NamedValueParser::<Format>::all(), help_heading = "Output")]
    format: Option<Format>,

    #[command(flatten)]
    #[serde(skip)]
    files: OutputArgs,
}

/// Hint for errors about an output that must be a directory.
const FOLDER_HINT: &str = "let -o end with a slash, as in -o out/";

/// One bake: a recipe with its options, the directory of its images and, for a shard, the list of shards.
struct Work {
    /// Images and nodes of earlier plans of the recipe.
    made: Made,
    /// The options, with a single seed.
    args: Args,
    recipe: Recipe,
    folder: PathBuf,
    /// The list of the recipe's shards; `None` unless a shard is baked.
    list: Option<List>,
    files: OutputArgs,
}

/// Bakes the recipes.
///
/// # Errors
///
/// If an option, a recipe or a file is invalid.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    args.check_document()?;
    args.check_samples()?;
    if args.gpu {
        gpu::check()?;
    }
    let names = recipes::expanded(&args.recipes)?;
    let by_preset = args.by_preset()?;
    let n_recipes = names.len() * args.material.variants().len();
    let files = args.files_for(n_recipes)?;
    let mut batch = Batch::new(n_recipes * by_preset.len(), args.keep_going, context);
    let works = works(&names, &by_preset, &mut batch, context)?;
    let sheet = args
        .contact_sheet
        .then(|| ContactSheet::claim(&files, context));
    let mut sheet = sheet.transpose()?;
    // Bake each recipe.
    let rows = u64::from(args.n_rows()?) * u64::from(args.n_frames().unwrap_or(1));
    let progress = Progress::bar("baking", rows * works.len() as u64, context);
    for (index, (name, mut work)) in (0..).zip(works) {
        let baked = work.bake(context, &progress);
        let preview = batch.checked(&name, baked)?.flatten();
        if let (Some(sheet), Some(preview)) = (&mut sheet, preview) {
            sheet.add(&preview)?;
        }
        progress.set(rows * (index + 1));
    }
    drop(progress);
    sheet.map(ContactSheet::write).transpose()?;
    Ok(batch.exit())
}

/// Reads all recipes, with each seed and each preset, and checks that all output files can be claimed, before the work
/// begins. Returns each bake with its title for messages.
fn works(
    names: &[String],
    by_preset: &[Args],
    batch: &mut Batch<'_>,
    context: &Context,
) -> Result<Vec<(String, Work)>> {
    let variants = by_preset[0].material.variants();
    let mut works: Vec<(String, Work)> = Vec::new();
    for name in names {
        // Read the recipe once for all variants, since standard input can be read only once.
        let mut read = None;
        for (seed, material) in &variants {
            for args in by_preset {
                let args = Args {
                    material: material.clone(),
                    ..args.clone()
                };
                let mut title = match seed {
                    Some(seed) => format!("{name} with seed {seed}"),
                    None => name.clone(),
                };
                if let ([_, _, ..], [preset, ..]) = (by_preset, args.preset.as_slice()) {
                    title += &format!(" for {}", preset.name);
                }
                let files = args.files_for(names.len() * variants.len());
                let work = files.and_then(|files| {
                    let read = match &mut read {
                        Some(read) => read,
                        none => none.insert(read_recipe(name)?),
                    };
                    let mut work = Work::new(name, read.clone(), args, files, seed.as_deref())?;
                    if names.len() * variants.len() > 1 {
                        // Do not hold the images and nodes of all bakes at once.
                        work.made = work.args.made();
                    }
                    for args in work.args.pictures() {
                        let mut job = Job::new(context, "bake", &work.files);
                        claim(&args, &work.files, &work, &mut job)?;
                    }
                    Ok(work)
                });
                works.extend(batch.checked(&title, work)?.map(|work| (title, work)));
            }
        }
    }
    check_names(&works)?;
    Ok(works)
}

/// Refuses recipes whose output files would have the same names.
fn check_names(works: &[(String, Work)]) -> Result<()> {
    for (index, (name, work)) in works.iter().enumerate() {
        let is_same = |(_, other): &(String, Work)| {
            other.recipe.name == work.recipe.name && other.files.output == work.files.output
        };
        if works[..index].iter().any(is_same) {
            let message = format!(
                "{name} and another recipe are both called {}",
                work.recipe.name
            );
            return Err(usage(message).hint("give each a `name`"));
        }
    }
    Ok(())
}

/// Bakes a recipe from memory. `words` are options as typed after `dapple bake RECIPE`. Stops when `stop` becomes true.
///
/// # Errors
///
/// If an option or the recipe is invalid, or the bake was stopped.
#[cfg(feature = "studio")]
pub(super) fn bake_with(
    words: &[String],
    recipe: &Recipe,
    folder: &Path,
    stop: Arc<AtomicBool>,
    context: &Context,
) -> Result<()> {
    let command = <Args as clap::Args>::augment_args(clap::Command::new("bake"));
    let words = ["bake", "recipe"]
        .into_iter()
        .chain(words.iter().map(String::as_str));
    let matches = command.try_get_matches_from(words)?;
    let args = <Args as clap::FromArgMatches>::from_arg_matches(&matches)?;
    args.check_document()?;
    args.check_samples()?;
    args.material.check_single()?;
    let works = Work::of_presets(&args, recipe, folder, None)?;
    let rows = u64::from(args.n_rows()?) * works.len() as u64;
    let progress = Progress::bar("baking", rows, context).until(stop);
    for mut work in works {
        work.bake(context, &progress)?;
    }
    Ok(())
}

/// Returns the names of the presets, with a sentence about each.
#[cfg(feature = "studio")]
pub(super) fn presets() -> impl Iterator<Item = (&'static str, &'static str)> {
    presets::PRESETS
        .iter()
        .map(|preset| (preset.name, preset.about()))
}

/// Images and node values that the plans of a bake share.
#[derive(Default)]
struct Made {
    /// The recipe's images; `None` until the first plan needs them.
    images: Option<Images>,
    /// The cache of nodes and their values; `None` for a single plan.
    cache: Option<PlanCache>,
}

/// Size of the cache for node values that the frames of a looping animation share, in bytes.
const MEMORY: usize = 1 << 28;

impl Work {
    /// Applies the options to the recipe called `name`, which was read from `folder`. `seed` is the seed's label in file
    /// names, if there are several seeds.
    fn new(
        name: &str,
        (mut recipe, folder): (Recipe, &Path),
        mut args: Args,
        files: OutputArgs,
        seed: Option<&str>,
    ) -> Result<Self> {
        args.change(&mut recipe)?;
        let mut made = args.made();
        if let Some(node) = args.node.clone() {
            let map = args.show_node(&node, &mut recipe, folder, &mut made)?;
            args.material.maps = Some(Maps(vec![map]));
        }
        if let Some(seed) = seed {
            recipe.name = format!("{}_{seed}", recipe.name);
        }
        let maps = args.material.map_kinds(&recipe.material);
        let wanted = args.shard.map(|shard| Wanted {
            size: args.material.size,
            samples: args.material.samples,
            supersample: args.material.supersample_word(),
            shard: shard.size,
            overlap: shard.overlap,
            maps: &maps,
            frames: args.frame.map(Frame::count),
            finite: args.material.finite,
        });
        let list = wanted.map(|wanted| List::new(name, &recipe, folder, &wanted));
        Ok(Self {
            made,
            list: list.transpose()?,
            folder: folder.to_owned(),
            recipe,
            args,
            files,
        })
    }

    /// Prepares one bake of `recipe` for each preset. `folder` is the directory of the recipe's images, unless `images`
    /// are given.
    fn of_presets(
        args: &Args,
        recipe: &Recipe,
        folder: &Path,
        images: Option<&Images>,
    ) -> Result<Vec<Self>> {
        let work = |args: Args| {
            let mut recipe = recipe.clone();
            args.change(&mut recipe)?;
            Ok(Self {
                made: Made {
                    images: images.cloned(),
                    ..args.made()
                },
                files: args.files_for(1)?,
                args,
                recipe,
                folder: folder.to_owned(),
                list: None,
            })
        };
        args.by_preset()?.into_iter().map(work).collect()
    }

    /// Bakes all frames of a looping animation, or a single image. Nodes that do not change with time are evaluated
    /// once. Returns the lit preview of the first frame if the options need one.
    fn bake(
        &mut self,
        context: &Context,
        progress: &Progress,
    ) -> Result<Option<Raster<LinearRgb>>> {
        let mut made = core::mem::take(&mut self.made);
        let mut preview = None;
        for args in self.args.pictures() {
            let job = Job::new(context, "bake", &self.files);
            let of_frame = match args.flipbook {
                Some(grid) => self.bake_flipbook(grid, job, &mut made, progress)?,
                None => self.bake_picture(&args, job, &mut made, progress)?,
            };
            preview = preview.or(of_frame);
        }
        Ok(preview)
    }

    /// Bakes a single image, and returns its lit preview if the options need one.
    fn bake_picture(
        &self,
        args: &Args,
        mut job: Job<'_>,
        made: &mut Made,
        progress: &Progress,
    ) -> Result<Option<Raster<LinearRgb>>> {
        let recipe = &self.recipe;
        let claimed = claim(args, job.args(), self, &mut job)?;
        for target in &claimed.finished {
            job.note_work(&format!("{target} is there already"));
        }
        if claimed.images.is_empty() {
            return Ok(None);
        }
        let time = args.frame.map_or(0.0, Frame::time);
        let images = args.images_of(recipe, &self.folder, &mut made.images)?;
        progress.check()?;
        let plan = self.plan(images, made.cache.as_ref(), time, progress)?;
        if args.frames.is_some() && args.is_first_frame() && !plan.moves() {
            job.note_work(STILL);
        }
        let options = args.options(claimed.map_kinds())?;
        print_estimate(&plan, &options, &claimed.images, &job)?;
        let refused = match args.shard {
            Some(_) => advise_shard,
            None => advise,
        };
        let bake = Bake::new(&plan, &options);
        progress.check()?;
        let bake = bake.map_err(|error| refused(error).wrong_value())?;
        claimed.write(&mut job, bake, recipe, progress)?;
        self.finish(args, job, &claimed, images, time)
    }

    /// Builds the plan of a frame, on the GPU if the options ask for it.
    fn plan(
        &self,
        images: &Images,
        cache: Option<&PlanCache>,
        time: f64,
        progress: &Progress,
    ) -> Result<Plan> {
        let (limits, listen) = (PlanLimits::default(), progress.listener());
        let plan = Plan::new_with_progress(&self.recipe, images, time, &limits, cache, listen);
        // Report a stop as such, before an error of the plan is attributed to an option.
        progress.check()?;
        let plan = plan.map_err(|error| self.args.material.blame(error))?;
        match self.args.gpu {
            true => gpu::on_gpu(&self.recipe, &plan),
            false => Ok(plan),
        }
    }

    /// Writes the files that accompany an image, such as its document, and finishes all files. Returns the lit preview
    /// if the options need one.
    fn finish(
        &self,
        args: &Args,
        mut job: Job<'_>,
        claimed: &Claimed,
        images: &Images,
        time: f64,
    ) -> Result<Option<Raster<LinearRgb>>> {
        let recipe = &self.recipe;
        claimed.write_metas(&job, recipe)?;
        if let Some(option) = args.left_out().filter(|_| args.is_first_frame()) {
            job.note_work(&format!(
                "note: {option} leaves out the material for Godot, {}.tres",
                recipe.name
            ));
        }
        if let Some(note) = args.import_note(&recipe.material) {
            job.note_work(&note);
        }
        // The contact sheet shows the first frame.
        let preview = if args.preview.is_some() || (args.contact_sheet && args.is_first_frame()) {
            let thing = args.preview.unwrap_or(Thing::Sphere);
            Some(preview::picture(recipe, images, time, thing)?)
        } else {
            None
        };
        if let (Some((output, format)), Some(preview)) = (claimed.preview, &preview) {
            job.write_map(output, &Map::Color(preview.clone()), format)?;
        }
        job.finish(&BakeSidecar { args, recipe }, report(recipe))?;
        Ok(preview)
    }
}

/// Content of the sidecar: the options, and the recipe as it was baked.
#[derive(Serialize)]
struct BakeSidecar<'a> {
    #[serde(flatten)]
    args: &'a Args,
    #[serde(rename = "baked")]
    recipe: &'a Recipe,
}

impl Args {
    /// Refuses samples on corners together with `--sheet`.
    ///
    /// # Errors
    ///
    /// If both are given, or if a side has only a single corner sample.
    fn check_samples(&self) -> Result<()> {
        self.material.samples.spaces(self.material.size)?;
        if self.sheet && self.material.samples.samples == Samples::Corners {
            let error = usage(
                "copies beside each other have no samples on corners: the last column is the first of the next copy",
            );
            return Err(error.hint("leave out --sheet or --samples corners"));
        }
        Ok(())
    }

    /// Returns the path of the only recipe, which must be a file.
    ///
    /// # Errors
    ///
    /// If there are several recipes, or the recipe is not a file.
    pub(super) fn only_file(&self) -> Result<&Path> {
        match self.recipes.as_slice() {
            [recipe] if Path::new(recipe).is_file() => Ok(Path::new(recipe)),
            _ => Err(usage("only a single recipe in a file can be watched")
                .hint("`dapple recipe NAME -o my.toml` writes one to begin with")),
        }
    }

    /// Returns how to handle NaN and infinite values in images.
    #[cfg(feature = "studio")]
    pub(super) fn finite(&self) -> crate::args::FiniteArgs {
        self.material.finite
    }

    /// Returns the sizes to bake, in order. If the requested size is larger than `small` pixels along its longer side,
    /// it is preceded by the same size scaled down to `small`.
    pub(super) fn sizes(&self, small: u32) -> Vec<Size> {
        let size = self.material.size;
        let longer = size.0[0].max(size.0[1]);
        if longer <= small || self.region.is_some() || self.shard.is_some() {
            return vec![size];
        }
        let side =
            |side: u32| (u64::from(side) * u64::from(small) / u64::from(longer)).max(1) as u32;
        vec![Size(size.0.map(side)), size]
    }

    /// Returns whether an output was given.
    #[cfg(feature = "studio")]
    pub(super) fn has_output(&self) -> bool {
        self.files.output.is_some()
    }

    /// Returns whether existing files may be replaced.
    pub(super) fn may_replace(&self) -> bool {
        self.files.force
    }

    /// Returns a copy of the options with another size. `may_replace` sets `--force`.
    pub(super) fn at(&self, size: Size, may_replace: bool) -> Self {
        let mut args = self.clone();
        args.material.size = size;
        args.files.force = may_replace;
        args
    }

    /// Returns a copy of the options for each frame of a looping animation. For a still image, returns a single copy.
    fn pictures(&self) -> impl Iterator<Item = Self> {
        Frame::all(self.frames).map(move |frame| {
            let frame = frame.or(self.frame);
            Self {
                frame,
                ..self.clone()
            }
        })
    }

    /// Returns the note that lists images to import without sRGB decoding. For a loop, it is returned for the first
    /// frame only.
    fn import_note(&self, material: &Material) -> Option<String> {
        if self.document().is_some() || !self.is_first_frame() {
            return None;
        }
        self.preset()?.import_note(material)
    }

    /// Returns whether these are the options of a still image, or of the first frame of a loop.
    fn is_first_frame(&self) -> bool {
        self.frames.is_none() || self.frame.is_none_or(Frame::is_first)
    }

    /// Returns the number of frames of a loop; `None` for a still image.
    fn n_frames(&self) -> Option<u32> {
        let of_grid = |Size([columns, rows]): Size| columns.saturating_mul(rows);
        self.frames.or(self.flipbook.map(of_grid))
    }

    /// Returns copies of the options, one for each preset, each with a directory named after the preset. Returns a
    /// single unchanged copy if there is at most one preset. Only the first copy adds to the contact sheet.
    ///
    /// # Errors
    ///
    /// If there are several presets, and the output is not a directory or the sidecar has a name.
    fn by_preset(&self) -> Result<Vec<Self>> {
        if self.preset.len() < 2 {
            return Ok(vec![self.clone()]);
        }
        if matches!(self.files.json, Some(Some(_))) {
            let error = usage("--json=FILE is for one preset, and there are several");
            return Err(error.hint("with --json each material has its own, called after it"));
        }
        let Some(folder) = self.files.folder(2) else {
            return Err(usage("several presets need a folder").hint(FOLDER_HINT));
        };
        let mut presets: Vec<&'static Preset> = Vec::new();
        for &preset in &self.preset {
            if !presets.contains(&preset) {
                presets.push(preset);
            }
        }
        let of_preset = |(index, preset): (usize, &'static Preset)| {
            let mut args = self.clone();
            args.preset = vec![preset];
            args.contact_sheet &= index == 0;
            // A trailing slash makes the path a directory.
            args.files.output = Some(folder.join(preset.name).join(""));
            args
        };
        Ok(presets.into_iter().enumerate().map(of_preset).collect())
    }

    /// Returns the output options for `n_recipes` recipes. If there are several recipes or frames, the output must be a
    /// directory.
    fn files_for(&self, n_recipes: usize) -> Result<OutputArgs> {
        let mut files = self.files.clone();
        // Another run may finish a shard first, with the same bytes, which this run may then replace.
        files.force |= self.shard.is_some();
        if self.frames.is_some() && matches!(files.json, Some(Some(_))) {
            let error = usage("--json=FILE is for one picture, and a loop has several");
            return Err(error.hint("with --json each has its own, called after it"));
        }
        if n_recipes == 1 || files.output.is_none() {
            let of_loop = self.frames.and_then(|count| files.folder(count as usize));
            if let Some(folder) = of_loop.map(|folder| folder.join("")) {
                files.output = Some(folder);
            }
            return Ok(files);
        }
        if files.name.is_some() || matches!(files.json, Some(Some(_))) {
            let message =
                format!("--name and --json=FILE are for one recipe, and there are {n_recipes}");
            return Err(usage(message).hint("their files are called after their names"));
        }
        // Append a slash, so that the output is a directory for the files of each recipe.
        let folder = files.folder(n_recipes).map(|folder| folder.join(""));
        files.output =
            Some(folder.ok_or_else(|| {
                usage("several recipes or seeds need a folder").hint(FOLDER_HINT)
            })?);
        Ok(files)
    }

    /// Returns the region of the tile to bake, from `--shard` or `--region`; `None` for the whole tile.
    fn part(&self) -> Result<Option<dapple::recipe::Region>> {
        match self.shard {
            Some(shard) => shard.region(self.material.size).map(Some),
            None => Ok(self.region.map(Region::of_recipe)),
        }
    }

    /// Returns the number of rows to bake for a recipe. The rows of a sheet count twice, because they are baked twice.
    fn n_rows(&self) -> Result<u32> {
        let size = self.part()?.map_or(self.material.size.0, |part| part.size);
        Ok(if self.sheet { 2 * size[1] } else { size[1] })
    }

    /// Returns an empty store for the images and node values that the plans of a bake share.
    fn made(&self) -> Made {
        Made {
            images: None,
            cache: self.n_frames().map(|_| PlanCache::new(MEMORY)),
        }
    }

    /// Returns the images of a recipe. They are read on the first call and stored in `images`.
    fn images_of<'a>(
        &self,
        recipe: &Recipe,
        folder: &Path,
        images: &'a mut Option<Images>,
    ) -> Result<&'a Images> {
        Ok(match images {
            Some(images) => images,
            none => none.insert(read_images(recipe, folder, self.material.finite)?),
        })
    }

    /// Replaces the recipe's material by a single node, and returns the map that shows the node. The images and nodes
    /// of the plan that finds it are stored in `made` for the bake.
    fn show_node(
        &self,
        node: &str,
        recipe: &mut Recipe,
        folder: &Path,
        made: &mut Made,
    ) -> Result<MapKind> {
        let images = self.images_of(recipe, folder, &mut made.images)?;
        let cache = made.cache.get_or_insert_with(|| PlanCache::new(0));
        let limits = PlanLimits::default();
        let plan = Plan::new_with_cache(recipe, images, 0.0, &limits, cache);
        let plan = plan.map_err(|error| self.material.blame(error))?;
        if !plan.node_names().any(|name| name == node) {
            let names: Vec<_> = plan.node_names().collect();
            return Err(usage(unknown("node", node, &names, "")));
        }
        let is_color = plan.is_color(node);
        recipe.name = format!("{}_{node}", recipe.name);
        recipe.material = Material {
            height: match is_color {
                true => Input::Number(0.5),
                false => Input::from(node),
            },
            albedo: is_color.then(|| Input::from(node)),
            ..Material::default()
        };
        Ok(match is_color {
            true => MapKind::Albedo,
            false => MapKind::Height,
        })
    }

    /// Applies options such as `--seed`, `--relief` and `--set` to the recipe.
    fn change(&self, recipe: &mut Recipe) -> Result<()> {
        let preset = self.preset().map(|preset| preset.normal_y);
        self.material.change(recipe, preset)
    }

    fn options(&self, maps: Vec<MapKind>) -> Result<BakeOptions> {
        Ok(BakeOptions {
            size: self.material.size.0,
            samples: self.material.samples.samples,
            supersample: self.material.supersample,
            region: self.part()?,
            maps,
            memory: if self.banded || self.shard.is_some() {
                BakeMemory::Banded
            } else {
                BakeMemory::Whole
            },
            ..BakeOptions::default()
        })
    }
}
