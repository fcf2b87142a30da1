//! What is read: images, meshes and text, with errors that say what to do.

#![expect(
    clippy::disallowed_methods,
    reason = "this module is where the command reads files"
)]

use crate::args::Region;
use crate::error::Hint;
use anyhow::{Context, Error, Result, anyhow};
use dapple::color::{Code, Normal};
use dapple::image::{
    Image, ImageError, ImageErrorKind, Limits, PngPixels, decode_image, read_image,
};
use dapple::mesh::{MeshErrorKind, Model, io::read_model};
use dapple::raster::Raster;
use dapple::tile::Map;
use std::fs;
use std::io::{self, Read};
use std::path::Path;

/// The most bytes of a text that is read.
const TEXT_MAX: u64 = 1 << 28;
/// How alike two names are, from 0 to 1, for one to be a slip of the other.
const ALIKE: f64 = 0.6;
/// How many similar names are told.
const NAMES_MAX: usize = 3;

/// How the numbers of an image are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Gray images are values as they are, others are color.
    ByChannels,
    /// Color, also if it is gray.
    Colors,
    /// Normals: `2 code / max - 1`.
    Normals,
}

/// An image that was read.
#[derive(Clone, Debug)]
pub(crate) struct Loaded {
    /// Its pixels.
    pub(crate) map: Map,
    /// Whether the file has more than 8 bits per channel.
    pub(crate) is_deep: bool,
}

/// Reads an image; `-` is standard input.
///
/// # Errors
///
/// If there is no such file, or it is none, is empty or damaged.
pub(crate) fn image(path: &Path) -> Result<Image> {
    let limits = Limits::default();
    if path == Path::new("-") {
        let mut bytes = Vec::new();
        let mut stdin = io::stdin().lock().take(limits.bytes);
        stdin.read_to_end(&mut bytes).context("standard input")?;
        return decode_image(&bytes, &limits)
            .map_err(advise)
            .context("standard input");
    }
    check_file(path, "an image")?;
    read_image(path, &limits).map_err(advise)
}

/// Reads an image as a map, or a part of it.
///
/// # Errors
///
/// As [`image`]; and if its channels cannot be meant so, or the part is not inside of it.
pub(crate) fn map(path: &Path, kind: Kind, region: Option<Region>) -> Result<Loaded> {
    let image = image(path)?;
    let map = match kind {
        Kind::Normals => normals(&image).map(Map::Normal),
        Kind::Colors => image.color().map(Map::Color).map_err(advise),
        Kind::ByChannels => match image.gray() {
            Ok(values) => Ok(Map::Value(values)),
            Err(_) => image.color().map(Map::Color).map_err(advise),
        },
    };
    let map = map.with_context(|| name(path))?;
    let map = match region {
        Some(region) => {
            let part = crop(&map, region).wrong_value();
            part.with_context(|| name(path))?
        }
        None => map,
    };
    let is_deep = image.bits() > 8;
    Ok(Loaded { map, is_deep })
}

/// Refuses an image that has not the size of the first one.
///
/// # Errors
///
/// If it has another.
pub(crate) fn check_size(path: &Path, size: [u32; 2], first: [u32; 2]) -> Result<()> {
    if size == first {
        return Ok(());
    }
    let ([w, h], [first_w, first_h]) = (size, first);
    Err(anyhow!(
        "{} has {w} × {h} pixels, but the first image has {first_w} × {first_h}",
        name(path)
    ))
}

/// What an input is called in messages.
pub(crate) fn name(path: &Path) -> String {
    if path == Path::new("-") {
        "standard input".to_owned()
    } else {
        path.display().to_string()
    }
}

/// Reads a mesh.
///
/// # Errors
///
/// If there is no such file, or it is none, is empty or damaged.
pub(crate) fn model(path: &Path) -> Result<Model> {
    check_file(path, "a mesh")?;
    read_model(path).map_err(|error| {
        let is_unknown = matches!(error.kind(), MeshErrorKind::Format { .. });
        let error = Error::new(error).context(format!("{}: no mesh was read", path.display()));
        if is_unknown {
            error.hint("a mesh is a file in .obj, .ply, .glb, .gltf or .off")
        } else {
            error
        }
    })
}

/// Reads a text; `-` is standard input.
///
/// # Errors
///
/// If there is no such file, or it is too long or no UTF-8.
pub(crate) fn text(path: &Path) -> Result<String> {
    let mut bytes = Vec::new();
    let read = if path == Path::new("-") {
        io::stdin()
            .lock()
            .take(TEXT_MAX + 1)
            .read_to_end(&mut bytes)
    } else {
        check_file(path, "a text")?;
        fs::File::open(path).and_then(|file| file.take(TEXT_MAX + 1).read_to_end(&mut bytes))
    };
    read.with_context(|| format!("{} cannot be read", path.display()))?;
    if bytes.len() as u64 > TEXT_MAX {
        return Err(anyhow!("{} has more than {TEXT_MAX} bytes", path.display()));
    }
    String::from_utf8(bytes).map_err(|_| anyhow!("{} is no text in UTF-8", path.display()))
}

/// A part of a map.
fn crop(map: &Map, region: Region) -> Result<Map> {
    let Region { first, size } = region;
    Ok(match map {
        Map::Value(raster) => Map::Value(raster.crop(first, size)?),
        Map::Color(raster) => Map::Color(raster.crop(first, size)?),
        Map::Normal(raster) => Map::Normal(raster.crop(first, size)?),
    })
}

/// The normals that the channels of an image stand for.
fn normals(image: &Image) -> Result<Raster<Normal>> {
    match image {
        Image::Png(png) | Image::Jpeg(png) => match &png.pixels {
            PngPixels::Rgb8(raster) => Ok(raster.map(|&codes| Normal::from_codes(codes))),
            PngPixels::Rgb16(raster) => Ok(raster.map(|&codes| Normal::from_codes(codes))),
            PngPixels::Rgba8(raster) => {
                Ok(raster.map(|&[x, y, z, _]| Normal::from_codes([x, y, z])))
            }
            PngPixels::Rgba16(raster) => {
                Ok(raster.map(|&[x, y, z, _]| Normal::from_codes([x, y, z])))
            }
            _ => Err(anyhow!(
                "normals have three channels, and the image is gray"
            )),
        },
        image => {
            // The parts are the numbers of the file as they are, from 0 to 1.
            let parts = image.color()?;
            Ok(parts.map(|parts| normal(parts.to_array())))
        }
    }
}

/// The unit vector of three parts from 0 to 1.
fn normal(parts: [f32; 3]) -> Normal {
    // As exact as 16-bit codes are, and normalized by the same rule.
    Normal::from_codes(parts.map(u16::from_unit))
}

/// Adds a hint to what often goes wrong.
fn advise(error: ImageError) -> Error {
    let hint = match error.kind() {
        ImageErrorKind::UnknownFormat => {
            Some("PNG, JPEG and OpenEXR images are read; convert it first")
        }
        ImageErrorKind::Channels { found, .. } if found.contains("transparent") => {
            Some("lay it over a background first: alpha is not kept")
        }
        ImageErrorKind::MissingPlane { .. } => {
            Some("the planes of an EXR image are R, G and B, or a single one")
        }
        _ => None,
    };
    match hint {
        Some(hint) => Error::new(error).hint(hint),
        None => error.into(),
    }
}

/// Refuses what is not there, is a folder, or is empty.
fn check_file(path: &Path, what: &str) -> Result<()> {
    let found = match fs::metadata(path) {
        Ok(found) => found,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let error = anyhow!("{}: there is no such file", path.display());
            return Err(match similar_names(path).as_slice() {
                [] => error,
                names => error.hint(format!("there is {}", names.join(", "))),
            });
        }
        Err(error) => {
            return Err(error).with_context(|| format!("{} cannot be read", path.display()));
        }
    };
    if found.is_dir() {
        return Err(anyhow!("{} is a folder, and not {what}", path.display()));
    }
    if found.is_file() && found.len() == 0 {
        return Err(anyhow!("{} is empty, and not {what}", path.display()));
    }
    Ok(())
}

/// The names in the same folder that may have been meant, the most alike first.
fn similar_names(path: &Path) -> Vec<String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    let listed = if folder.as_os_str().is_empty() {
        fs::read_dir(".")
    } else {
        fs::read_dir(folder)
    };
    let entries = listed.into_iter().flatten().flatten();
    let mut names: Vec<(f64, String)> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .map(|other| (strsim::normalized_damerau_levenshtein(&name, &other), other))
        .filter(|&(alike, _)| alike >= ALIKE)
        .collect();
    names.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let names = names.into_iter().take(NAMES_MAX);
    names
        .map(|(_, name)| folder.join(name).display().to_string())
        .collect()
}
