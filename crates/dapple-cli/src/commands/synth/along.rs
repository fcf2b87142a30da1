//! Synthesizes an image along an orientation field and with varying scales, both given as images.

use super::guides::Values;
use super::surface::{Covered, Layouts};
use super::{Args, STEPS, advise, shown};
use crate::encode::{Clear, Cover, Format};
use crate::error::{Exit, Hint, usage};
use crate::input;
use crate::job::{Context, Job};
use crate::progress::Progress;
use anyhow::Result;
use dapple::mesh::CREASE;
use dapple::raster::Raster;
use dapple::synth::{PlaneAlong, PlaneScales, synthesize_plane_along};
use serde_json::Value;
use std::f32::consts::TAU;

/// Synthesizes the image. Applies its source positions to the other maps of the example.
pub(super) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let mut job = Job::new(context, "synth", &args.image.files);
    let target = args.target(&args.exemplar, args.image.ending())?;
    let format = Format::choose(args.image.format, &target, Format::Png16)?;
    let output = job.claim(&target)?;
    let map_outputs = args.claim_maps(&target, format.ending(), &mut job)?;
    job.claim_sidecar(&target)?;
    let input = args.read()?;
    let (directions, scales) = args.planes()?;
    let scales = match (&scales, args.guides.scales) {
        (Some(scales), _) => PlaneScales::Plane(scales),
        (None, bounds) => PlaneScales::Conformal(bounds.map_or([1.0; 2], |bounds| bounds.0)),
    };
    let progress = Progress::bar("synthesizing", STEPS.into(), context);
    let options = args.matching.options(&args.surface);
    let exemplar = &input.exemplar;
    let along = synthesize_plane_along(exemplar, &directions, scales, &options, shown(&progress));
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
        layouts: Layouts::from(atlas),
        double_sided: false,
        input,
    };
    let atlas = &covered.layouts.atlases[0];
    let (base, alpha) = covered.bake_base(atlas)?;
    let is_deep = covered.input.base.is_deep;
    let cover = Cover::of(alpha.as_ref(), false, Clear::NOT_WRAPPED);
    job.write_with_alpha(output, base, cover, is_deep, &args.image)?;
    for (output, (_, example)) in map_outputs.into_iter().zip(&covered.input.maps) {
        let map = covered.bake(&example.map, atlas)?;
        job.write_with_alpha(output, map, None, example.is_deep, &args.image)?;
    }
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}

impl Args {
    /// Returns whether the texture is in the plane and follows an image of directions or scales.
    pub(super) fn is_along(&self) -> bool {
        self.surface.mesh.is_none()
            && (self.surface.directions.is_some() || self.guides.given_for_scales().is_some())
    }

    /// Refuses options that have no effect on a texture along directions or scales. Also refuses `--scales` without an
    /// image of scales.
    pub(super) fn check_along(&self) -> Result<()> {
        if !self.is_along() {
            return Ok(());
        }
        let other = self.plane.given();
        let detail = self.detail.as_ref().map(|_| "detail");
        if let Some(option) = other.or(detail).or(self.guides.given()) {
            let message =
                format!("--{option} has no effect with --directions and --scale in the plane");
            return Err(usage(message).hint("leave one of them out"));
        }
        if self.surface.directions.is_none() && self.guides.scale.is_none() {
            let error = usage("--scales has no effect without --scale or --directions");
            return Err(
                error.hint("give an image of sizes or of directions, of the texture's size")
            );
        }
        Ok(())
    }

    /// Returns two rasters: the angle of the direction at each pixel, in radians, and the scale at each pixel. The
    /// latter is `None` without an image of scales.
    fn planes(&self) -> Result<(Raster<f32>, Option<Raster<f32>>)> {
        let scales = self.read_scale()?.map(Values::into_raster);
        let Some(first) = self.surface.directions.as_deref() else {
            let size = scales.as_ref().map(Raster::size).unwrap_or_default();
            return Ok((Raster::filled(size, 0.0)?, scales));
        };
        let turns = self.read_gray(first, None)?;
        if let (Some(scales), Some(path)) = (&scales, &self.guides.scale) {
            input::check_size(path, scales.size(), first, turns.size())
                .hint("--directions and --scale have one size")?;
        }
        Ok((turns.map(|turn| turn * TAU), scales))
    }
}
