//! `dapple synth`: synthesizes a texture from an example, in the plane or on a mesh.

mod along;
mod corners;
mod displace;
mod example_mesh;
mod guides;
mod inspect;
mod material;
mod options;
mod plane;
mod reading;
mod repair_mesh;
mod surface;
mod tiles;

use crate::args::{AlphaArgs, ImageArgs, MapArg, ReadArgs, Region};
use crate::error::{Exit, Hint, usage};
use crate::job::{Context, Job};
use crate::output::{OutputIdx, Target};
use crate::progress::Progress;
use anyhow::{Error, Result};
use dapple::synth::{Progress as Steps, SynthError, SynthErrorKind};
use guides::GuideArgs;
use options::{MatchArgs, PlaneArgs, SurfaceArgs};
use serde::Serialize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  dapple synth grass.png --size 256 --wrap both -o meadow.png
  dapple synth grass.png --size 128 --at 4096,-128 -o far.png
  dapple synth photo.png --repair scratch.png -o clean.png
  dapple synth stones.png --turned all --size 256 --pieces pieces.png -o yard.png
  dapple synth grass.png --size 256 --sources meadow_places.exr -o meadow.png
  dapple synth sand.png --replay places.exr -o desert.png
  dapple synth stones.png --guide photo.png -o mosaic.png
  dapple synth grass.png --example sand.png --which mask.png -o garden.png
  dapple synth rock.png --directions rock_height.png --scale mask.png -o flow.png
  dapple synth grass.png --size 300x200 --map normal=grass_normal.png \\
    --seed 7 -o meadow.png
  dapple synth rock.png --size 128 --map height=rock_height.png \\
    --weight height=0.5 -o cliff.png
  dapple synth checker.png --mesh model.obj --edges wrap --sites 4000 \\
    --texture-size 512 -o checkered.glb
  dapple synth rock.png --map normal=rock_normal.png --map ao=cracks.png \\
    --map roughness=rock_height.png --mesh model.obj --sites 4000 -o rocky.glb
  dapple synth leaves.png --mesh model.obj --sites 4000 -o hedge.glb
  dapple synth shell.glb --mesh model.obj --sites 4000 -o lifted.glb
  dapple synth shell.glb --repair stain.png --example-sites 4000 -o clean.glb
  dapple synth rock.png --map height=rock_height.png --displace 0.05 \\
    --mesh model.obj --sites 4000 -o rocky.ply
  dapple synth checker.png --mesh model.obj --sites 4000 \\
    --directions directions.csv -o checkered.ply
  dapple synth checker.png --mesh model.obj --sites 4000 \\
    --directions directions.csv --scales 0.5,2 -o grown.glb
  dapple synth checker.png --mesh model.obj --sites 4000 \\
    --texture-size 512 -o checkered.obj

The example is best 64 to 256 pixels wide: its features should be a tenth of it or
less. More sites make the features smaller on the mesh, and take longer.

Where the example is transparent, so is the texture. In GLB its alpha cuts, if more
pixels of the example are clear than in between, and else it blends.

On a mesh directions are lines x,y,z,dx,dy,dz (CSV) or [{\"at\": [x,y,z], \"vector\": [dx,dy,dz]}]
(JSON): at a place on the mesh, where the down of the example points. One or a few are
enough; in between they are interpolated.";

/// Grow a texture from an example image: an image or tile of any size, or a texture that covers a mesh (Turk 2001).
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = format!("{EXAMPLES}\n\n{}", surface::endings()))]
pub(crate) struct Args {
    /// Example image, or a textured or vertex-colored mesh whose texture --mesh gets.
    ///
    /// Images of 8 or 16 bits are sRGB unless they declare another color space; floating-point images are linear. Color is
    /// matched in sRGB, gray as it is. Maps of an example mesh are at its texture coordinates; its material goes to --mesh, too.
    #[arg(value_name = "IMAGE|MESH")]
    exemplar: PathBuf,

    /// Additional map of the example, synthesized along with it, such as normal=FILE or roughness=FILE; repeatable.
    ///
    /// It is written next to the output as `NAME_MAP`. The material of a mesh uses `normal`, and in GLB also `roughness`,
    /// `metallic` and `ao`.
    #[arg(long, value_name = "NAME=IMAGE")]
    map: Vec<MapArg>,

    /// Larger version of the example, such as the original photograph, whose detail the texture shows.
    ///
    /// Its size is a whole multiple of the example's. A texture in the plane becomes as much larger; maps have its size.
    #[arg(long, value_name = "IMAGE", conflicts_with = "region")]
    detail: Option<PathBuf>,

    /// Use only this part of the example, in pixels.
    #[arg(long, value_name = "X,Y,W,H", hide_short_help = true)]
    region: Option<Region>,

    /// Use only the pixels of the example where this mask (same size) is white.
    ///
    /// Neighborhoods that contain other pixels are excluded. With several examples, give one mask for each, in order.
    #[arg(long, value_name = "IMAGE", hide_short_help = true)]
    mask: Vec<PathBuf>,

    #[command(flatten)]
    #[serde(flatten)]
    alpha: AlphaArgs,

    #[command(flatten)]
    #[serde(flatten)]
    read: ReadArgs,

    #[command(flatten)]
    plane: PlaneArgs,

    #[command(flatten)]
    surface: SurfaceArgs,

    #[command(flatten)]
    #[serde(flatten)]
    guides: GuideArgs,

    #[command(flatten)]
    matching: MatchArgs,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// Synthesizes a texture.
///
/// # Errors
///
/// If an option, an image, a mesh or another file is invalid.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    args.check_used()?;
    match &args.surface.mesh {
        Some(mesh) => surface::run(args, mesh, context),
        None if example_mesh::is_mesh(&args.exemplar) => repair_mesh::run(args, context),
        None if args.is_along() => along::run(args, context),
        None => plane::run(args, context),
    }
}

impl Args {
    /// Refuses options that have no effect, such as options for a mesh without a mesh.
    fn check_used(&self) -> Result<()> {
        material::check_names(&self.map)?;
        self.check_displacement()?;
        self.check_example()?;
        self.check_method()?;
        self.check_along()?;
        self.matching.check_weights(&self.map_names())?;
        let surface = self.surface.given();
        match (&self.surface.mesh, self.plane.given(), surface) {
            (Some(_), Some(option), _) => Err(usage(format!("--{option} has no effect on a mesh"))),
            (None, _, Some(option)) => {
                let error = usage(format!("--{option} has no effect without a mesh"));
                Err(error.hint("add --mesh FILE"))
            }
            _ if self.detail.is_some() && self.surface.mesh.is_some() && self.matching.paper => {
                let error = usage("--detail has no effect with --paper on a mesh");
                Err(error.hint("leave one of them out"))
            }
            _ => Ok(()),
        }
    }

    /// Returns the output path. If the output is a directory, the file in it is named after `input`.
    fn target(&self, input: &Path, ending: &str) -> Result<Target> {
        let names = self.map_names();
        let parts: Vec<_> = [""].into_iter().chain(names).collect();
        let stem = input.file_stem().unwrap_or_default().to_string_lossy();
        Ok(self.image.files.targets(&stem, &parts, ending)?.main)
    }

    /// Claims a file next to the output for each map: `NAME_MAP.EXTENSION`.
    fn claim_maps(
        &self,
        target: &Target,
        ending: &str,
        job: &mut Job<'_>,
    ) -> Result<Vec<OutputIdx>> {
        let mut outputs = Vec::new();
        for name in self.map_names() {
            outputs.push(job.claim(&target.part(name)?.with_ending(ending))?);
        }
        Ok(outputs)
    }

    /// Returns the names of the maps without duplicates, in the order of the command line.
    fn map_names(&self) -> Vec<&str> {
        let mut names = Vec::new();
        for map in &self.map {
            if !names.contains(&map.name.as_str()) {
                names.push(&map.name);
            }
        }
        names
    }
}

/// Returns a callback that shows the progress of a synthesis.
fn shown(progress: &Progress) -> impl FnMut(Steps) -> ControlFlow<()> + '_ {
    |steps: Steps| {
        // Give each pass an equal part of the bar.
        let part = steps.done as f64 / steps.n_sites.max(1) as f64;
        let done = (steps.pass as f64 + part) / steps.n_passes.max(1) as f64;
        progress.set((done * f64::from(STEPS)) as u64);
        ControlFlow::Continue(())
    }
}

/// The length of the progress bar, in steps.
const STEPS: u32 = 1000;

/// Adds a hint to common errors.
fn advise(error: SynthError) -> Error {
    let hint = match error.kind() {
        SynthErrorKind::Exemplar { .. } => {
            "take a larger example, fewer --levels, or --edges wrap if it repeats"
        }
        SynthErrorKind::Range { what, .. } if what.contains("crosses itself") => {
            "leave out faces inside of others, or simplify the mesh"
        }
        SynthErrorKind::Range { what, .. } if *what == "side of the texture map" => {
            "take a larger --texture-size, a smaller --padding, or a mesh with fewer faces"
        }
        SynthErrorKind::Range { what, .. } if *what == "side of a wrapping texture" => {
            "take another --size, or fewer --levels"
        }
        SynthErrorKind::Range { what, .. } if *what == "side of the exemplar" => {
            "take a larger example, or fewer --levels"
        }
        SynthErrorKind::Period { .. } => "take another --size, fewer --levels, or --method sweep",
        SynthErrorKind::Source { .. } => "give sources in an example of this size",
        SynthErrorKind::Masked { .. } => "let the mask leave larger pieces, or take fewer --levels",
        SynthErrorKind::Direction { .. } => "let directions lie along the surface",
        SynthErrorKind::Range { .. } | SynthErrorKind::Count { .. } => {
            return Error::new(error).wrong_value();
        }
        _ => return error.into(),
    };
    Error::new(error).hint(hint).wrong_value()
}
