//! Synthesis of an image.

use super::{Args, Input, STEPS, advise, shown};
use crate::encode::{Format, map_raster};
use crate::error::Exit;
use crate::job::{Context, Job};
use crate::progress::Progress;
use anyhow::Result;
use dapple::synth::{PlaneTexture, synthesize_plane_with};
use dapple::tile::Map;
use serde_json::Value;

/// The default size of a texture.
const SIZE: [u32; 2] = [512; 2];

/// Makes the image, and the maps that follow it.
pub(super) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let mut job = Job::new(context, "synth", &args.image.files);
    let target = args.target(&args.exemplar, args.image.ending())?;
    let format = Format::choose(args.image.format, &target, Format::Png16)?;
    let output = job.claim(&target)?;
    let map_outputs = args.claim_maps(&target, format.ending(), &mut job)?;
    job.claim_sidecar(&target)?;
    let Input {
        base,
        maps,
        exemplar,
    } = args.read()?;
    let progress = Progress::bar("synthesizing", STEPS.into(), context);
    let texture = synthesize_plane_with(
        &exemplar,
        args.plane.size.map_or(SIZE, |size| size.0),
        args.plane.edges(),
        &args.matching.options(&args.surface),
        shown(&progress),
    );
    let texture = texture.map_err(advise)?;
    drop(progress);
    let examples = [&base].into_iter().chain(maps.iter().map(|(_, map)| map));
    for (output, example) in [output].into_iter().chain(map_outputs).zip(examples) {
        let map = follow(&texture, &example.map)?;
        let alpha = example.alpha.as_ref().map(|alpha| texture.transfer(alpha));
        let alpha = alpha.transpose()?;
        job.write_with_alpha(output, map, alpha.as_ref(), example.is_deep, &args.image)?;
    }
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}

/// A map of the example, transferred to the texture.
fn follow(texture: &PlaneTexture, example: &Map) -> Result<Map> {
    Ok(map_raster!(example, raster => texture.transfer(raster)?))
}
