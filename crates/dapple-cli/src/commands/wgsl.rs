//! `dapple wgsl`: prints shaders that compute the noise of the command.

use crate::args::{OutputArgs, seed};
use crate::error::{Exit, usage};
use crate::job::{Context, Job, say};
use crate::output::Target;
use crate::shader_language::ShaderLanguage;
use crate::words::{NamedValueParser, with_dashes};
use anyhow::Result;
use dapple::hash::Seed;
use dapple::noise::{GradientNoise, GradientNoise2, GradientNoise3, GradientNoise4};
use dapple::worley::{Dimensions, Scatter, Space, Worley, Worley2, Worley3};
use dapple_wgsl::{Module, gradient_noise_value, source, wesl_package, worley_value};
use serde_json::Value;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  dapple wgsl gradient-noise-2d > noise.wgsl
  dapple wgsl gradient-noise-3d fractal > clouds.wgsl
  dapple wgsl worley-2d --seed 7 --period 8 > cells.wgsl
  dapple wgsl worley-2d --seed 7 --language glsl > cells.glsl
  dapple wgsl gradient-noise-2d --naga-oil > gradient_noise_2d.wgsl
  dapple wgsl worley-2d fractal --wesl shaders/dapple

A file is complete: it imports nothing, and has no bindings and entry points. --seed adds the
parameters as a constant; otherwise `shader_words` of the Rust crates gives them for a uniform.
With --naga-oil, as for Bevy, a file is one module; print those that it imports, too. --wesl writes
all of them and `wesl.toml`.";

/// Print noise as a shader in WGSL, with the same bits as here.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Modules to print, with all modules that they use.
    #[arg(required = true, value_name = "MODULE", value_parser = NamedValueParser::of(Module::ALL.iter().map(|module| (with_dashes(module.name()), *module))))]
    modules: Vec<Module>,

    /// Language of the shader.
    #[arg(long, value_enum, value_name = "NAME", default_value_t)]
    language: ShaderLanguage,

    /// Print a single module with its import path, as Bevy needs it.
    #[arg(long, conflicts_with_all = ["seed", "language"])]
    naga_oil: bool,

    /// Write the modules, with all modules that they use, as a WESL package to this directory.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["seed", "language", "naga_oil"])]
    wesl: Option<PathBuf>,

    /// Overwrite existing files.
    #[arg(long, requires = "wesl")]
    force: bool,

    /// Add the parameters of this random seed as constants.
    #[arg(long, value_name = "N", value_parser = seed)]
    seed: Option<u64>,

    /// Period along all axes, in cells.
    #[arg(long, value_name = "N", requires = "seed", value_parser = clap::value_parser!(u32).range(1..=1 << 31))]
    period: Option<u32>,

    /// Place one point in each cell, at most this far from the center, from 0 to 1.
    #[arg(long, value_name = "PART", requires = "seed")]
    jitter: Option<f64>,
}

/// Prints the shader.
///
/// # Errors
///
/// If the jitter is out of range, several modules are asked for with `--naga-oil`, or the output cannot be written.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    if let Some(folder) = &args.wesl {
        return put_package(args, context, folder);
    }
    if args.naga_oil {
        let [module] = args.modules[..] else {
            return Err(usage("--naga-oil prints one module at a time"));
        };
        say(module.naga_oil().trim_end())?;
        return Ok(Exit::Done);
    }
    let mut text = source(&args.modules);
    if let Some(seed) = args.seed {
        for &module in &args.modules {
            text += &constant(module, Seed(seed), args)?;
        }
    }
    say(args.language.translate(text)?.trim_end())?;
    Ok(Exit::Done)
}

/// Writes the modules as a WESL package.
fn put_package(args: &Args, context: &Context, folder: &Path) -> Result<Exit> {
    let output = OutputArgs {
        force: args.force,
        ..OutputArgs::default()
    };
    let mut job = Job::new(context, "wgsl", &output);
    for (path, text) in wesl_package(&args.modules) {
        let file = job.claim_text(&Target::Path(folder.join(path)))?;
        job.write(file, text.as_bytes())?;
    }
    job.finish(&Value::Null, Value::Null)?;
    Ok(Exit::Done)
}

/// Returns the WGSL constant with the parameters of a module; empty if the module has no parameters.
fn constant(module: Module, seed: Seed, args: &Args) -> Result<String> {
    Ok(match module {
        Module::GradientNoise2d => noise("NOISE_2D", GradientNoise2::new(seed), args)?,
        Module::GradientNoise3d => noise("NOISE_3D", GradientNoise3::new(seed), args)?,
        Module::GradientNoise4d => noise("NOISE_4D", GradientNoise4::new(seed), args)?,
        Module::Worley2d => worley("WORLEY_2D", Worley2::new(seed), args)?,
        Module::Worley3d => worley("WORLEY_3D", Worley3::new(seed), args)?,
        _ => String::new(),
    })
}

fn noise<const N: usize>(name: &str, noise: GradientNoise<N>, args: &Args) -> Result<String> {
    let words = noise.with_period([args.period; N])?.shader_words(1.0)?;
    let value = gradient_noise_value(&words);
    Ok(format!("\nconst {name} = {value};\n"))
}

fn worley<const N: usize>(name: &str, worley: Worley<N>, args: &Args) -> Result<String>
where
    Dimensions: Space<N>,
{
    let mut worley = worley.with_period([args.period; N])?;
    if let Some(jitter) = args.jitter {
        worley = worley.with_scatter(Scatter::Jittered { jitter })?;
    }
    let words = worley.shader_words()?;
    let value = worley_value(&words);
    Ok(format!("\nconst {name} = {value};\n"))
}
