//! Reads numbers as they are stored, for `dapple info`.

use super::files::{check_file, name};
use super::{advise, image_or_region, limits, text, whole};
use crate::args::Region;
use crate::error::Hint;
use anyhow::{Context, Result};
use dapple::image::{Image, decode_npy, decode_r16};
use dapple::raster::Raster;
use serde::Deserialize;
use std::path::Path;

/// The content of an input of `dapple info`.
#[derive(Debug)]
pub(crate) enum Content {
    /// An image.
    Image(Image),
    /// The channels of a NumPy array.
    Array(Vec<Raster<f32>>),
    /// Raw heights.
    Raw(Raster<u16>),
}

/// Numbers as they are stored in a file.
#[derive(Debug)]
pub(crate) struct Numbers {
    pub(crate) content: Content,
    /// Whether only the requested region was read.
    pub(crate) is_part: bool,
}

/// Reads an image, a NumPy array, or raw heights, whose size is in their sidecar. If an image has too many pixels and
/// its format allows it, reads only the region.
///
/// # Errors
///
/// Same as [`image`](super::image), or if the size of raw heights is unknown.
pub(crate) fn numbers(path: &Path, region: Option<Region>) -> Result<Numbers> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let content = match ending.to_ascii_lowercase().as_str() {
        "npy" => {
            let bytes = whole(path, "an array")?;
            let channels = decode_npy(&bytes, &limits()).map_err(advise);
            Content::Array(channels.with_context(|| name(path))?)
        }
        "r16" => {
            let size = raw_size(path)?;
            let bytes = whole(path, "raw heights")?;
            let codes = decode_r16(&bytes, size, &limits()).map_err(advise);
            Content::Raw(codes.with_context(|| name(path))?)
        }
        _ => {
            let (image, is_part) = image_or_region(path, region)?;
            let content = Content::Image(image);
            return Ok(Numbers { content, is_part });
        }
    };
    let is_part = false;
    Ok(Numbers { content, is_part })
}

/// Reads the size of raw heights from their sidecar, the file with the same name and the extension `.json`.
fn raw_size(path: &Path) -> Result<[u32; 2]> {
    #[derive(Deserialize)]
    struct Size {
        width: u32,
        height: u32,
    }
    check_file(path, "raw heights")?;
    let beside = path.with_extension("json");
    let size = text(&beside).and_then(|text| Ok(serde_json::from_str::<Size>(&text)?));
    let Size { width, height } = size
        .with_context(|| format!("the size of {} is not known", path.display()))
        .hint(format!(
            "{} beside it says it: {{\"width\": …, \"height\": …}}",
            beside.display()
        ))?;
    Ok([width, height])
}
