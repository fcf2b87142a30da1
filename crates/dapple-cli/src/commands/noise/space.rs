//! Gradient noise in space on a sphere: an equirectangular image, or the faces of a cube map.

use super::Args;
use crate::args::Size;
use crate::error::{Exit, Hint, usage};
use crate::field::{RangeArg, refused};
use crate::job::{Context, Job};
use anyhow::Result;
use dapple::hash::Seed;
use dapple::noise::{CubeFace, CubeMap, Equirectangular, GradientNoise3};
use dapple::raster::{Field, FractalShape, Named as _, Raster};
use dapple::recipe::{FractalNode, Images, Node, Plan, Recipe, Samples};
use dapple::tile::Map;
use serde_json::json;

/// Draws the noise on a sphere.
///
/// # Errors
///
/// If the size does not fit, an option is out of range, or writing fails.
pub(super) fn draw(args: &Args, node: &FractalNode, context: &Context) -> Result<Exit> {
    check(args, node)?;
    let Size(size) = args.field.size;
    let on_corners = args.field.samples.samples == Samples::Corners;
    let faces = match args.cube {
        true => CubeFace::ALL.iter().copied().map(Some).collect(),
        false => vec![None],
    };
    let mut job = Job::new(context, "noise", &args.image.files);
    let parts: Vec<_> = faces
        .iter()
        .map(|face| face.map_or("", |face| face.name()))
        .collect();
    let targets = args
        .image
        .files
        .targets("noise", &parts, args.image.ending())?;
    let outputs = job.claim_images(&targets, args.image.format)?;
    let seed = Seed(args.field.seed).child("noise", 0);
    let octaves =
        GradientNoise3::new(seed).fractal(node.octaves, node.gain, 2.0, FractalShape::Sum);
    let octaves = octaves.map_err(|error| anyhow::Error::new(error).wrong_value())?;
    // The standard deviation is a sixth, as in the plane.
    let scale = node.weights(GradientNoise3::VARIANCE.into())[0];
    let (radius, range) = (args.cells / 2.0, args.field.range);
    for (face, output) in faces.into_iter().zip(outputs) {
        let row = |row: u32| {
            let place = |direction: [f64; 3]| direction.map(|part| radius * part);
            let places: Vec<_> = match face {
                Some(face) => {
                    let map = CubeMap {
                        side: size[0],
                        on_corners,
                    };
                    map.directions(face, row).map(place).collect()
                }
                None => Equirectangular { size, on_corners }
                    .directions(row)
                    .map(place)
                    .collect(),
            };
            let mut values = vec![0.0; places.len()];
            // Both slices have a row of pixels.
            let _ = octaves.values(&places, &mut values);
            let values = values.into_iter();
            values.map(move |value| mapped((0.5 + scale * value).clamp(0.0, 1.0), range))
        };
        let pixels = Raster::from_rows(size, row);
        let pixels = pixels.map_err(|error| anyhow::Error::new(error).wrong_value())?;
        let map = Map::Value(pixels);
        job.write_image(output, map, false, &args.image)?;
    }
    job.finish(args, json!(null))?;
    Ok(Exit::Done)
}

/// Refuses sizes that do not fit a sphere or cube, and options that noise in the plane refuses, too.
fn check(args: &Args, node: &FractalNode) -> Result<()> {
    let Size(size) = args.field.size;
    args.field.spaces()?;
    let on_corners = args.field.samples.samples == Samples::Corners;
    // Samples on corners have one column and one row more than the spaces between them.
    let width = 2 * u64::from(size[1]) - u64::from(on_corners);
    if args.sphere && u64::from(size[0]) != width {
        let rule = match on_corners {
            true => "one column narrower than twice its rows on corners",
            false => "twice as wide as high",
        };
        let message = format!("an equirectangular image is {rule}");
        return Err(
            usage(format!("{message}, and --size is {}", args.field.size))
                .hint(format!("take --size {width}x{}", size[1])),
        );
    }
    if args.cube && size[0] != size[1] {
        let message = format!(
            "the faces of a cube are square, and --size is {}",
            args.field.size
        );
        return Err(usage(message).hint(format!("take --size {}", size[0])));
    }
    let mut plane = Recipe::of_node("noise", Node::Noise(node.clone()), Seed(args.field.seed));
    (plane.extent, plane.wrap) = ([args.cells; 2], [false; 2]);
    Plan::new(&plane, &Images::new(), 0.0).map_err(refused)?;
    Ok(())
}

/// Maps `value` linearly so that the ends of `range` become 0 and 1. Without a range, the value is unchanged.
fn mapped(value: f32, range: Option<RangeArg>) -> f32 {
    match range {
        Some(RangeArg::Ends([low, high])) => (value - low) / (high - low),
        Some(RangeArg::Raw) | None => value,
    }
}
