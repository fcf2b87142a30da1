//! Synthesis of an image along directions and with scales that images say.

use super::guides::read_gray;
use super::surface::Covered;
use super::{Args, STEPS, advise, shown};
use crate::encode::Format;
use crate::error::{Exit, Hint, usage};
use crate::input;
use crate::job::{Context, Job};
use crate::progress::Progress;
use anyhow::Result;
use dapple::mesh::CREASE;
use dapple::raster::Raster;
use dapple::synth::{PlaneAlong, synthesize_plane_along};
use serde_json::Value;
use std::f32::consts::TAU;

/// The scales of black and white where none are given.
const SCALES: [f32; 2] = [1.0, 2.0];

/// Makes the image, and the maps that follow it.
pub(super) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let mut job = Job::new(context, "synth", &args.image.files);
    let target = args.target(&args.exemplar, args.image.ending())?;
    let format = Format::choose(args.image.format, &target, Format::Png16)?;
    let output = job.claim(&target)?;
    let map_outputs = args.claim_maps(&target, format.ending(), &mut job)?;
    job.claim_sidecar(&target)?;
    let input = args.read()?;
    let [directions, scales] = args.planes()?;
    let progress = Progress::bar("synthesizing", STEPS.into(), context);
    let options = args.matching.options(&args.surface);
    let exemplar = &input.exemplar;
    let along = synthesize_plane_along(exemplar, &directions, &scales, &options, shown(&progress));
    let PlaneAlong {
        synthesizer,
        texture,
        atlas,
    } = along.map_err(advise)?;
    drop(progress);
    let covered = Covered {
        shading: synthesizer.surface().mesh().corner_normals(CREASE),
        synthesizer,
        texture,
        atlas: Some(atlas),
        double_sided: false,
        input,
    };
    let (base, alpha) = covered.bake_base()?;
    let is_deep = covered.input.base.is_deep;
    job.write_with_alpha(output, base, alpha.as_ref(), is_deep, &args.image)?;
    for (output, (_, example)) in map_outputs.into_iter().zip(&covered.input.maps) {
        let map = covered.bake(&example.map)?;
        job.write_with_alpha(output, map, None, example.is_deep, &args.image)?;
    }
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}

impl Args {
    /// Whether a texture in the plane follows images of directions or scales.
    pub(super) fn is_along(&self) -> bool {
        self.surface.mesh.is_none()
            && (self.surface.directions.is_some() || self.plane.scale.is_some())
    }

    /// Refuses options that have no effect on a texture along directions and scales.
    pub(super) fn check_along(&self) -> Result<()> {
        let other = self.plane.given().filter(|&option| option != "scale");
        let detail = self.detail.as_ref().map(|_| "detail");
        match other.or(detail).or(self.guides.given()) {
            Some(option) if self.is_along() => {
                let message =
                    format!("--{option} has no effect with --directions and --scale in the plane");
                Err(usage(message).hint("leave one of them out"))
            }
            _ => Ok(()),
        }
    }

    /// The angles of directions, and scales, of all pixels.
    fn planes(&self) -> Result<[Raster<f32>; 2]> {
        let directions = self.surface.directions.as_deref();
        let turns = directions.map(|path| read_gray(path, None)).transpose()?;
        let scale = self.plane.scale.as_deref();
        let shares = scale.map(|path| read_gray(path, None)).transpose()?;
        if let (Some(turns), Some(shares), Some(path), Some(first)) =
            (&turns, &shares, scale, directions)
        {
            input::check_size(path, shares.size(), first, turns.size())
                .hint("--directions and --scale have one size")?;
        }
        let size = [&turns, &shares]
            .into_iter()
            .flatten()
            .map(Raster::size)
            .next();
        let size = size.unwrap_or_default();
        let [black, white] = self.plane.scales.map_or(SCALES, |scales| scales.0);
        let directions = match turns {
            Some(turns) => turns.map(|turn| turn * TAU),
            None => Raster::filled(size, 0.0)?,
        };
        let scales = match shares {
            Some(shares) => shares.map(|share| black + (white - black) * share),
            None => Raster::filled(size, 1.0)?,
        };
        Ok([directions, scales])
    }
}
