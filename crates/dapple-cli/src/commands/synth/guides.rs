//! Reads guides: images that control which part of the example is used where in the texture.

use super::Args;
use super::corners::own_uvs;
use super::example_mesh::is_mesh;
use super::options::first_given;
use super::reading::{gray, lightness};
use crate::args::{Numbers, Region};
use crate::error::Hint;
use crate::input::{self, Kind, Loaded};
use crate::words::NamedValueParser;
use anyhow::{Result, anyhow};
use dapple::mesh::{Model, Repair, SurfacePoint};
use dapple::points::glam::DVec2;
use dapple::raster::{Raster, Wrap};
use dapple::synth::{SideBySide, Synthesizer, Turned};
use dapple::tile::blur;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What goes where.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(next_help_heading = "Guides")]
pub(super) struct GuideArgs {
    /// Another example image; repeatable.
    ///
    /// Every `--map` is then given once for each example, in the same order.
    #[arg(long = "example", value_name = "IMAGE", conflicts_with_all = ["detail", "region"])]
    pub(super) examples: Vec<PathBuf>,

    /// Also use mirrored or rotated copies of the examples, for features in any direction, such as leaves or gravel.
    ///
    /// Maps and guides turn with them; normals have green up.
    #[arg(long, value_name = "HOW", value_parser = NamedValueParser::<Turned>::all(), default_value_t, conflicts_with = "detail")]
    pub(super) turned: Turned,

    /// Which example goes where: black is the first, white the last.
    ///
    /// Grays select the examples between. A texture in the plane has the size of this image. On a mesh it is read at
    /// the mesh's own texture coordinates, or it is the mesh with vertex colors.
    #[arg(long, value_name = "IMAGE|MESH", requires = "examples", conflicts_with_all = ["size", "repair", "replay"])]
    which: Option<PathBuf>,

    /// Image that the texture resembles from afar: bright pixels of the example go where it is bright.
    ///
    /// A texture in the plane has its size. On a mesh it is read at the mesh's own texture coordinates, or it is the
    /// mesh with vertex colors.
    #[arg(long, value_name = "IMAGE|MESH", conflicts_with_all = ["size", "repair", "replay"])]
    guide: Option<PathBuf>,

    /// Values of the example that correspond to --guide, such as heights; one image per example [default: brightness].
    ///
    /// By default the brightness and contrast of --guide are matched to those of the example.
    #[arg(long, hide_short_help = true, value_name = "IMAGE", requires = "guide")]
    guide_of: Vec<PathBuf>,

    /// Radius in pixels for averaging brightness; smaller follows finer lines and loses more of the example [default:
    /// 2, or 0 with --guide-of].
    #[arg(long, hide_short_help = true, value_name = "PX", requires = "guide", value_parser = blur_range)]
    guide_blur: Option<f64>,

    /// Weight of --guide relative to one color channel.
    #[arg(
        long,
        hide_short_help = true,
        value_name = "N",
        requires = "guide",
        default_value_t = 1.0
    )]
    guide_weight: f32,

    /// Feature size as an image: black is small, white is large.
    ///
    /// A texture in the plane has its size. On a mesh it is read at the mesh's own texture coordinates, or it is the
    /// mesh with vertex colors.
    #[arg(long, value_name = "IMAGE|MESH")]
    pub(super) scale: Option<PathBuf>,

    /// Feature sizes at black and at white of --scale, from 1/8 to 8 [default: 1,2].
    ///
    /// Units are pixels of the texture, or distances of sites on a mesh. Without --scale, sizes follow the directions
    /// within these bounds: features grow where directions diverge and shrink where they converge, so that no rows
    /// begin or end.
    #[arg(long, hide_short_help = true, value_name = "A,B")]
    pub(super) scales: Option<Numbers<f32, 2>>,
}

/// Default scales at black and at white in an image of scales.
const SCALES: [f32; 2] = [1.0, 2.0];

impl GuideArgs {
    /// Returns the name of an option that sets scales, if one was given.
    pub(super) fn given_for_scales(&self) -> Option<&'static str> {
        first_given(&[
            ("scale", self.scale.is_some()),
            ("scales", self.scales.is_some()),
        ])
    }

    /// Returns the name of an option that requests a guide, if one was given.
    pub(super) fn given(&self) -> Option<&'static str> {
        first_given(&[
            ("which", self.which.is_some()),
            ("guide", self.guide.is_some()),
        ])
    }
}

/// Weight of the guide that selects among examples, relative to one color channel.
const CHOICE_WEIGHT: f32 = 3.0;

/// Default blur of lightness, as a standard deviation in pixels. It removes the grain of an example and preserves its
/// shapes.
const LIGHTNESS_BLUR: f64 = 2.0;

/// A guide channel. Synthesis compares its values in the example with those in the texture.
pub(super) struct Guide {
    /// The guide's values at the pixels of the example.
    pub(super) example: Raster<f32>,
    /// The guide's values in the texture, which the example's values are compared with.
    pub(super) target: Values,
    pub(super) weight: f32,
}

/// Values that vary over a texture or a mesh.
pub(super) enum Values {
    /// Values at the pixels of a texture in the plane, or in the texture coordinates of a mesh.
    Image(Raster<f32>),
    /// Values at the vertices of a mesh, as a raster of one row.
    Vertices(Raster<f32>),
}

impl Values {
    /// Returns the values as a raster, which is an image or one row of vertices.
    pub(super) fn raster(&self) -> &Raster<f32> {
        match self {
            Self::Image(values) | Self::Vertices(values) => values,
        }
    }

    /// Converts the values to a raster, which is an image or one row of vertices.
    pub(super) fn into_raster(self) -> Raster<f32> {
        match self {
            Self::Image(values) | Self::Vertices(values) => values,
        }
    }

    /// Applies a function to all values.
    fn map(&self, change: impl FnMut(&f32) -> f32) -> Self {
        match self {
            Self::Image(values) => Self::Image(values.map(change)),
            Self::Vertices(values) => Self::Vertices(values.map(change)),
        }
    }
}

impl Args {
    /// Reads values from the lightness of an image or, for a texture on a mesh, from the lightness of vertex colors.
    fn read_values(&self, path: &Path) -> Result<Values> {
        if !is_mesh(path) {
            return Ok(Values::Image(self.read_gray(path, None)?));
        }
        let name = input::name(path);
        if self.surface.mesh.is_none() {
            let error = anyhow!("{name} is a mesh, and the texture an image");
            return Err(error.hint("give an image of the texture's size, or --mesh"));
        }
        let Some(colors) = input::model(path)?.colors else {
            let error = anyhow!("{name} has no colors of vertices");
            return Err(
                error.hint("give the mesh with a color for each vertex, such as a PLY file")
            );
        };
        let lightness = colors.iter().map(|color| lightness(&color.color)).collect();
        let row = Raster::from_vec([colors.len() as u32, 1], lightness)?;
        Ok(Values::Vertices(row))
    }

    /// Reads the scales from the image of `--scale`, if it was given.
    pub(super) fn read_scale(&self) -> Result<Option<Values>> {
        let Some(path) = &self.guides.scale else {
            return Ok(None);
        };
        let [black, white] = self.guides.scales.map_or(SCALES, |scales| scales.0);
        let shares = self.read_values(path)?;
        Ok(Some(shares.map(|share| black + (white - black) * share)))
    }

    /// Reads the guides. `layout` places several examples side by side in one image.
    pub(super) fn read_guides(&self, layout: &SideBySide, example: &Loaded) -> Result<Vec<Guide>> {
        let mut guides = Vec::new();
        let args = &self.guides;
        // `--which`: one guide per example, which is 1 where this example is selected.
        if let Some(path) = &args.which {
            let last = args.examples.len();
            let values = self.read_values(path)?;
            for image in 0..=last {
                let is_chosen =
                    |&value: &f32| f32::from((value * last as f32).round() == image as f32);
                guides.push(Guide {
                    example: layout.membership(image)?,
                    target: values.map(is_chosen),
                    weight: CHOICE_WEIGHT,
                });
            }
        }
        // `--guide`: lightness, or the values of `--guide-of`.
        if let Some(path) = &args.guide {
            let guide = self.read_values(path)?;
            if let (Some(which), Values::Image(guide)) = (&args.which, &guide)
                && let Values::Image(target) = &guides[0].target
            {
                input::check_size(path, guide.size(), which, target.size())
                    .hint("--guide and --which have one size")?;
            }
            let sigma = args.guide_blur.unwrap_or(match args.guide_of.len() {
                0 => LIGHTNESS_BLUR,
                _ => 0.0,
            });
            let blurred = |image: &Raster<f32>| blur(image, sigma, [Wrap::Mirror; 2]);
            let guide = match guide {
                Values::Image(image) => Values::Image(blurred(&image)?),
                vertices => vertices,
            };
            let (example, target) = if args.guide_of.is_empty() {
                let lightness = blurred(&gray(example)?)?;
                let guide = like(&guide, &lightness, &layout.mask()?);
                (lightness, guide)
            } else {
                let images = args.guide_of.iter();
                let images = images.map(|path| self.read_gray(path, self.region));
                let images: Vec<_> = images.collect::<Result<_>>()?;
                let images: Vec<_> = images.iter().collect();
                let joined = layout.join(&images, 0.0);
                let hint = "give one --guide-of for each example, of its size";
                (blurred(&joined.wrong_value().hint(hint)?)?, guide)
            };
            guides.push(Guide {
                example,
                target,
                weight: args.guide_weight,
            });
        }
        Ok(guides)
    }
}

/// Parses a blur from 0 to 64 pixels.
fn blur_range(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(sigma) if (0.0..=64.0).contains(&sigma) => Ok(sigma),
        _ => Err(format!("{text:?} is not a number from 0 to 64")),
    }
}

impl Args {
    /// Reads an image as gray values. Colors are converted to their lightness.
    pub(super) fn read_gray(&self, path: &Path, region: Option<Region>) -> Result<Raster<f32>> {
        gray(&input::map(
            path,
            Kind::ByChannels,
            region,
            None,
            &self.read,
            input::ALPHA_HINT,
        )?)
    }
}

/// Returns the guide, scaled and shifted so that its mean and standard deviation are those of the example within
/// `mask`.
fn like(guide: &Values, example: &Raster<f32>, mask: &Raster<bool>) -> Values {
    let pixels = example.pixels().iter().zip(mask.pixels());
    let used = pixels.filter_map(|(&value, &is_used)| is_used.then_some(value));
    let [mean, deviation] = moments(used);
    let [own_mean, own_deviation] = moments(guide.raster().pixels().iter().copied());
    let scale = if own_deviation > 0.0 {
        deviation / own_deviation
    } else {
        0.0
    };
    guide.map(|&value| (mean + (f64::from(value) - own_mean) * scale) as f32)
}

/// Returns the mean and the standard deviation of `values`.
fn moments(values: impl Iterator<Item = f32> + Clone) -> [f64; 2] {
    let n = values.clone().count().max(1) as f64;
    let mean = values.clone().map(f64::from).sum::<f64>() / n;
    let square = |value: f32| (f64::from(value) - mean) * (f64::from(value) - mean);
    [mean, (values.map(square).sum::<f64>() / n).sqrt()]
}

/// Samples values at all sites of a mesh. The result has a column for each element of `values`. Images repeat, and are
/// read at the texture coordinates in the mesh file. Values at vertices are interpolated.
pub(super) fn at_sites(
    values: &[&Values],
    synthesizer: &Synthesizer,
    model: &Model,
    repair: &Repair,
) -> Result<Vec<Vec<f32>>> {
    let surface = synthesizer.surface();
    let points = synthesizer.hierarchy().sites().points();
    let has_images = values
        .iter()
        .any(|values| matches!(values, Values::Image(_)));
    let uvs = has_images
        .then(|| own_uvs(surface, model, repair))
        .transpose();
    let uvs = uvs.hint("guides and --scale are read at texture coordinates: give the mesh some")?;
    let uvs = uvs.unwrap_or_default();
    let column = |values: &&Values| match values {
        Values::Image(image) => {
            let size = image.size().map(f64::from);
            let value = |&point: &SurfacePoint| {
                let weights = surface.weights(point);
                let corners = uvs[point.face.index()].iter().zip(weights);
                let uv = corners.map(|(&uv, weight)| uv * weight).sum::<DVec2>();
                let [column, row] = [uv.x * size[0], uv.y * size[1]].map(|at| at.floor() as i64);
                *image.at(column, row, [Wrap::Repeat; 2])
            };
            Ok(points.iter().map(value).collect())
        }
        Values::Vertices(row) => {
            let (count, needed) = (row.pixels().len(), model.mesh.positions().len());
            if count != needed {
                let error =
                    anyhow!("the colors are of {count} vertices, but the mesh has {needed}");
                return Err(error.hint("give the mesh itself, with colors"));
            }
            let faces = surface.mesh().faces();
            let value = |&point: &SurfacePoint| {
                let corners = faces[point.face.index()].iter();
                let parts = corners.zip(surface.weights(point)).map(|(vertex, weight)| {
                    let before = repair.vertex_before[vertex.index()];
                    f64::from(row.pixels()[before.index()]) * weight
                });
                parts.sum::<f64>() as f32
            };
            Ok(points.iter().map(value).collect())
        }
    };
    values.iter().map(column).collect()
}
