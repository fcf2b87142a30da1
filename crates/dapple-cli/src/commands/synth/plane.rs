//! Synthesizes an image in the plane by all methods except along directions.

use super::options::{MethodName, PlaneArgs};
use super::reading::Input;
use super::{Args, STEPS, advise, inspect, shown};
use crate::encode::{Clear, Cover, Format, map_raster};
use crate::error::{Exit, Hint, usage};
use crate::input;
use crate::job::{Context, Job};
use crate::output::{OutputIdx, Target};
use crate::progress::Progress;
use anyhow::{Context as _, Result};
use dapple::color::LinearRgb;
use dapple::image::Image;
use dapple::raster::Raster;
use dapple::synth::{
    Edges, Endless, Exemplar, Options, PlaneTexture, SynthError, SynthErrorKind,
    synthesize_plane_guided, synthesize_plane_with,
};
use dapple::tile::Map;
use serde_json::Value;
use std::path::Path;

/// The default size of a texture, in pixels.
const SIZE: [u32; 2] = [512; 2];

/// Largest integer up to which `f32` represents all integers: 2^24.
const MOST: f32 = 16_777_216.0;

/// Synthesizes the image. Applies its source positions to the other maps of the example.
pub(super) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let mut job = Job::new(context, "synth", &args.image.files);
    let target = args.target(&args.exemplar, args.image.ending())?;
    let format = Format::choose(args.image.format, &target, Format::Png16)?;
    let output = job.claim(&target)?;
    let map_outputs = args.claim_maps(&target, format.ending(), &mut job)?;
    let sources = claim_sources(args.plane.sources.as_deref(), &mut job)?;
    let inspections = inspect::claim(&args.plane, &mut job)?;
    job.claim_sidecar(&target)?;
    let input = args.read()?;
    let Input {
        base,
        maps,
        exemplar,
        guides,
        ..
    } = &input;
    // Synthesize the texture from sources of another texture, in a hole, with guides, or freely.
    let progress = Progress::bar("synthesizing", STEPS.into(), context);
    let options = args.matching.options(&args.surface);
    let edges = args.plane.edges();
    let texture = match (&args.plane.replay, &input.hole) {
        (Some(path), _) => {
            let sources = read_sources(path)?;
            let example = exemplar.size();
            PlaneTexture::from_sources(sources, edges, example, exemplar.edges())
        }
        (None, Some(hole)) => {
            // Each pixel of the first example is its own source, since that example begins at the first pixel.
            let sources = Raster::from_fn(hole.size(), |column, row| [column, row])?;
            let edges = [exemplar.edges(); 2];
            let options = Options {
                n_levels: args.matching.repair_levels(hole),
                ..options
            };
            PlaneTexture::from_sources(sources, edges, exemplar.size(), exemplar.edges())
                .and_then(|whole| whole.repair(exemplar, hole, &options, shown(&progress)))
        }
        (None, None) if !guides.is_empty() => {
            let targets: Vec<_> = guides.iter().map(|guide| guide.target.raster()).collect();
            synthesize_plane_guided(exemplar, &targets, edges, &options, shown(&progress))
        }
        (None, None) => grow(args, exemplar, &progress),
    };
    let texture = texture.map_err(advise)?;
    drop(progress);
    // Keep the bits of the pixels around a hole.
    let clear = match input.hole {
        Some(_) => Clear::Keep,
        None => Clear::Bleed {
            wraps: edges.map(|edges| edges == Edges::Wrap),
        },
    };
    // Transfer the example and its maps, and write them.
    let examples = [base].into_iter().chain(maps.iter().map(|(_, map)| map));
    for (output, example) in [output].into_iter().chain(map_outputs).zip(examples) {
        let map = follow(&texture, &example.map)?;
        let alpha = example.alpha.as_ref().map(|alpha| texture.transfer(alpha));
        let alpha = alpha.transpose()?;
        let cover = Cover::of(alpha.as_ref(), example.is_associated, clear);
        job.write_with_alpha(output, map, cover, example.is_deep, &args.image)?;
    }
    if let Some(output) = sources {
        let place = |&[column, row]: &[u32; 2]| LinearRgb::new(column as f32, row as f32, 0.0);
        let places = Map::Color(texture.sources().map(place));
        job.write_map(output, &places, Format::Exr)?;
    }
    for inspection in inspections {
        inspection.write(&texture, &input, args.guides.examples.len(), &mut job)?;
    }
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}

/// Synthesizes a texture by the requested method. The default is endless synthesis; it is a sweep if an option needs
/// one, or if endless synthesis does not support the period.
fn grow(args: &Args, exemplar: &Exemplar, progress: &Progress) -> Result<PlaneTexture, SynthError> {
    let size = args.plane.size.map_or(SIZE, |size| size.0);
    let edges = args.plane.edges();
    if !args.is_swept() {
        let period = [0, 1].map(|axis| (edges[axis] == Edges::Wrap).then_some(size[axis]));
        match Endless::new(exemplar, &args.matching.endless(period)) {
            Ok(texture) => {
                let first = args.plane.at.map_or([0, 0], |at| at.0);
                return texture.window(first, size, shown(progress));
            }
            Err(error)
                if !args.plane.is_endless()
                    && matches!(error.kind(), SynthErrorKind::Period { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    let options = args.matching.options(&args.surface);
    synthesize_plane_with(exemplar, size, edges, &options, shown(progress))
}

impl PlaneArgs {
    /// Returns whether endless synthesis was requested.
    pub(super) fn is_endless(&self) -> bool {
        self.method == Some(MethodName::Endless) || self.at.is_some()
    }
}

impl Args {
    /// Returns the name of a given option that has no effect on an endless texture; `None` if there is none.
    fn given_for_sweeps(&self) -> Option<&'static str> {
        self.matching.given_for_sweeps().or(self.guides.given())
    }

    /// Returns whether a sweep was requested, or is needed by an option.
    fn is_swept(&self) -> bool {
        self.plane.method == Some(MethodName::Sweep) || self.given_for_sweeps().is_some()
    }

    /// Refuses options that have no effect with the method.
    pub(super) fn check_method(&self) -> Result<()> {
        let PlaneArgs { method, at, .. } = &self.plane;
        if at.is_some() && *method == Some(MethodName::Sweep) {
            let error = usage("--at has no effect with --method sweep");
            return Err(error.hint("leave one of them out"));
        }
        match self.given_for_sweeps() {
            Some(option) if self.plane.is_endless() => {
                let error = usage(format!("--{option} has no effect on an endless texture"));
                Err(error.hint(format!(
                    "leave out --{option}, or --method endless and --at"
                )))
            }
            _ => Ok(()),
        }
    }
}

/// Returns the texture's version of another map of the example, by copying the map's pixels from the texture's source
/// positions.
fn follow(texture: &PlaneTexture, example: &Map) -> Result<Map> {
    Ok(map_raster!(example, raster => texture.transfer(raster)?))
}

/// Claims the file for the texture's source positions, if it was requested.
fn claim_sources(path: Option<&Path>, job: &mut Job<'_>) -> Result<Option<OutputIdx>> {
    let Some(path) = path else {
        return Ok(None);
    };
    let target = Target::from(path);
    if target.ending() != "exr" {
        let error = usage(format!(
            "--sources {}: sources are OpenEXR",
            input::name(path)
        ));
        return Err(error.hint("let the name end in .exr"));
    }
    job.claim(&target).map(Some)
}

/// Reads source positions from a file that was written by `--sources`.
fn read_sources(path: &Path) -> Result<Raster<[u32; 2]>> {
    let image = input::image(path)?;
    let places = image.color().with_context(|| input::name(path))?;
    let is_place = |value: f32| (0.0..=MOST).contains(&value) && value.fract() == 0.0;
    let is_source = |color: &LinearRgb| is_place(color.r) && is_place(color.g);
    if !matches!(image, Image::Planes(..)) || !places.pixels().iter().all(is_source) {
        let error = usage(format!("{} has no sources of pixels", input::name(path)));
        return Err(error.hint("give a file that synth --sources wrote"));
    }
    Ok(places.map(|color| [color.r as u32, color.g as u32]))
}
