//! `dapple recipe`: lists, checks and prints recipes.

use super::bake::Setting;
use crate::args::{FiniteArgs, OutputArgs, seed};
use crate::baking::{advise, is_json, read_images, read_recipe};
use crate::error::{Exit, Hint, usage};
use crate::job::{Context, Job, put_text, say};
use crate::output::Target;
use crate::shader_language::ShaderLanguage;
use anyhow::Result;
use dapple::hash::Seed;
use dapple::recipe::{KINDS, MaterialShader, NODE_TAGS, Plan, Recipe, ShaderOptions};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

const EXAMPLES: &str = "\
Examples:
  dapple recipe --list
  dapple recipe --list wood
  dapple recipe giraffe
  dapple recipe giraffe -o my-giraffe.toml
  dapple recipe flagstone --rust
  dapple recipe flagstone --wgsl --textures -o flagstone.wgsl
  dapple recipe flagstone -o flagstone.json
  dapple recipe --schema -o recipe.schema.json

A built-in recipe is printed as it was written, with its comments; change it and give the
file to `dapple bake`. With --rust it becomes a Rust program that holds it as text and bakes it
with the crate `dapple`. With --wgsl it becomes a function for shaders, with the same bits: height,
color, roughness and metalness at a position. The tiles and control points that it looks up are written
next to it, as flagstone.bin: little-endian words of a texture of the format rgba32uint. With the first line `#:schema recipe.schema.json` in a recipe, editors that use
Taplo complete and check it.";

/// List the built-in recipes; print a recipe as TOML, JSON, Rust or WGSL, or the schema of all; check one of your own.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A built-in recipe, or a file in TOML or JSON; `-` is standard input.
    #[arg(value_name = "RECIPE", required_unless_present_any = ["list", "schema", "reference"])]
    recipe: Option<String>,

    /// List the built-in recipes by family; with a word, those whose name, description or tags contain it, and nodes.
    #[arg(long, value_name = "WORD", num_args = 0..=1, conflicts_with = "recipe")]
    list: Option<Option<String>>,

    /// Print the JSON Schema of recipes, for completion and checks in editors.
    #[arg(long, conflicts_with_all = ["recipe", "list", "reference"])]
    schema: bool,

    /// Print a reference of all options of recipes, as Markdown.
    #[arg(long, conflicts_with_all = ["recipe", "list"])]
    reference: bool,

    /// Print a Rust program that bakes the recipe.
    #[arg(long, conflicts_with = "to")]
    rust: bool,

    /// Print the material as a function of WGSL, in one file without bindings; with --output, write the texture that it
    /// looks up next to it.
    #[arg(long, conflicts_with_all = ["to", "rust"])]
    wgsl: bool,

    /// Let the shader take the values of nodes that it cannot compute as arguments, from baked textures.
    #[arg(long, requires = "wgsl")]
    textures: bool,

    /// Language of the shader.
    #[arg(
        long,
        requires = "wgsl",
        value_enum,
        value_name = "NAME",
        default_value_t
    )]
    language: ShaderLanguage,

    /// Rewrite the recipe in this format [default: by the extension of the output].
    #[arg(long = "as", value_enum, value_name = "FORMAT")]
    to: Option<Text>,

    /// Replace a value of the recipe: an option of a node, or a value such as `material.relief`; repeatable.
    #[arg(long, value_name = "NODE.OPTION=VALUE")]
    set: Vec<Setting>,

    /// Random seed [default: the recipe's].
    #[arg(long, value_name = "N", value_parser = seed)]
    seed: Option<u64>,

    /// Only check whether the recipe can be baked.
    #[arg(long, conflicts_with_all = ["rust", "wgsl", "to", "output"])]
    check: bool,

    #[command(flatten)]
    #[serde(skip)]
    finite: FiniteArgs,

    #[command(flatten)]
    #[serde(skip)]
    files: OutputArgs,
}

/// The formats of recipes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
enum Text {
    /// TOML.
    Toml,
    /// JSON.
    Json,
}

/// Runs the subcommand.
///
/// # Errors
///
/// If the recipe is invalid, options conflict, or writing fails.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let Some(name) = args.recipe.as_deref() else {
        return match (args.schema, args.reference) {
            (true, _) => {
                let text = format!("{:#}\n", Recipe::text_schema());
                let job = Job::new(context, "recipe", &args.files);
                put_text(job, "recipe.schema", "json", &text, args)
            }
            (_, true) => {
                let job = Job::new(context, "recipe", &args.files);
                put_text(job, "recipe", "md", &Recipe::reference(), args)
            }
            _ => list(args.list.as_ref().and_then(|word| word.as_deref())),
        };
    };
    let (mut recipe, folder) = read_recipe(name)?;
    for setting in &args.set {
        setting.apply(&mut recipe)?;
    }
    if args.check {
        let images = read_images(&recipe, folder, args.finite)?;
        Plan::new(&recipe, &images, 0.0).map_err(advise)?;
        say(&format!(
            "{name} can be baked: {} nodes",
            recipe.nodes.len()
        ))?;
        return Ok(Exit::Done);
    }
    if let Some(seed) = args.seed {
        recipe.seed = Seed(seed);
    }
    if args.wgsl {
        let images = read_images(&recipe, folder, args.finite)?;
        let options = ShaderOptions {
            textures: args.textures,
        };
        let shader = recipe.to_wgsl(&images, &options).map_err(advise)?;
        return put_shader(args, context, &recipe, shader);
    }
    let is_as_written =
        !args.rust && args.format().is_none() && args.seed.is_none() && args.set.is_empty();
    let text = match (Recipe::builtin_text(name), args.format()) {
        (Ok(text), _) if is_as_written && folder.as_os_str().is_empty() => text.to_owned(),
        _ if args.rust => recipe.to_rust().map_err(advise)?,
        (_, Some(Text::Json)) => recipe.to_json().map_err(advise)? + "\n",
        _ => recipe.to_toml().map_err(advise)?,
    };
    let ending = match args.format() {
        _ if args.rust => "rs",
        Some(Text::Json) => "json",
        _ => "toml",
    };
    let job = Job::new(context, "recipe", &args.files);
    put_text(job, &recipe.name, ending, &text, args)
}

/// Writes a shader. The contents of its `data` texture, if it has one, go to a file next to it, with the extension
/// `bin`.
fn put_shader(
    args: &Args,
    context: &Context,
    recipe: &Recipe,
    shader: MaterialShader,
) -> Result<Exit> {
    let mut job = Job::new(context, "recipe", &args.files);
    let target = match args.files.output {
        Some(_) => args.files.target(&recipe.name, args.language.extension())?,
        None => Target::Stdout,
    };
    let output = job.claim_text(&target)?;
    // Standard output takes the text alone.
    if !shader.data.is_empty() && target != Target::Stdout {
        let words = job.claim(&target.clone().with_ending("bin"))?;
        let bytes: Vec<u8> = shader
            .data
            .iter()
            .flat_map(|word| word.to_le_bytes())
            .collect();
        job.write(words, &bytes)?;
    }
    job.claim_sidecar(&target)?;
    job.write(output, args.language.material(shader, recipe)?.as_bytes())?;
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}

impl Args {
    /// Returns the format of the recipe text: the requested one, or JSON if the output has its extension; otherwise
    /// `None`.
    fn format(&self) -> Option<Text> {
        let is_json = self.files.output.as_deref().is_some_and(is_json);
        self.to
            .or_else(|| (is_json && !self.rust && !self.wgsl).then_some(Text::Json))
    }
}

/// Lists the built-in recipes by family, each with its description. If `word` is given, lists only recipes whose name,
/// description or tags contain it.
fn list(word: Option<&str>) -> Result<Exit> {
    let mut families: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for name in Recipe::builtin_names() {
        let recipe = Recipe::builtin(name).map_err(advise)?;
        let texts = [&name.to_owned(), &recipe.about];
        let contains = |word: &str| {
            let mut texts = texts.into_iter().chain(&recipe.tags);
            texts.any(|text| text.to_lowercase().contains(&word.to_lowercase()))
        };
        if word.is_none_or(contains) {
            let family = recipe.tags.first().cloned().unwrap_or_default();
            let line = format!("  {name:<18} {}", recipe.about);
            families.entry(family).or_default().push(line);
        }
    }
    // List the nodes that the word is about, also by the words of other programs.
    if let Some(word) = word.map(str::to_lowercase) {
        let nodes = KINDS.into_iter().zip(NODE_TAGS);
        let nodes = nodes.filter(|(kind, tags)| kind.contains(&word) || tags.contains(&word));
        let lines: Vec<_> = nodes
            .map(|(kind, tags)| format!("  {kind:<18} {tags}"))
            .collect();
        if !lines.is_empty() {
            families.insert("nodes of recipes".to_owned(), lines);
        }
    }
    if families.is_empty() {
        let word = word.unwrap_or_default();
        return Err(usage(format!("no built-in recipe is about `{word}`"))
            .hint("`dapple recipe --list` names all"));
    }
    let lines = families
        .into_iter()
        .flat_map(|(family, lines)| core::iter::once(family).chain(lines));
    say(&lines.collect::<Vec<_>>().join("\n"))?;
    Ok(Exit::Done)
}
