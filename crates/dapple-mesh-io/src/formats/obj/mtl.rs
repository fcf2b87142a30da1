//! MTL: the materials of an OBJ file.

use super::{joined_words, name};
use crate::Beside;
use crate::MeshIoError;
use crate::line::{Line, lines};
use crate::text::parse;
use crate::texture::{shown, texture, unreadable};
use dapple_color::{LinearRgb, LinearRgba};
use dapple_mesh::Material;
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;

/// The keywords of textures that do not begin with `map_`.
const OTHER_MAPS: [&[u8]; 4] = [b"bump", b"decal", b"disp", b"refl"];

#[derive(Default)]
struct Entry {
    name: String,
    diffuse: Option<LinearRgb>,
    alpha: Option<f32>,
    diffuse_map: Option<Texture>,
    normal_map: Option<Texture>,
    /// The keywords of other textures.
    other_maps: BTreeSet<String>,
}

/// A texture with its options.
#[derive(Default)]
struct Texture {
    name: String,
    scale: DVec2,
    offset: DVec2,
    is_clamped: bool,
    other_options: Vec<String>,
}

/// A scale and then an offset of texture coordinates, v up.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct UvMap {
    scale: DVec2,
    offset: DVec2,
}

/// A material as it is read.
#[derive(Default)]
pub(super) struct Found {
    pub(super) material: Material,
    /// The map of the texture coordinates of all corners.
    pub(super) uv_map: Option<UvMap>,
    /// Whether the texture ends at its sides.
    pub(super) is_clamped: bool,
    pub(super) left_out: Vec<String>,
}

/// The material with a name, or without a name the first, in the available libraries.
///
/// Fails for a color that single precision cannot hold, in any material of the libraries.
pub(super) fn material(
    libraries: &[String],
    name: Option<&str>,
    beside: &mut Beside<'_>,
) -> Result<Found, MeshIoError> {
    let (mut entries, mut missing) = (Vec::new(), Vec::new());
    for library in libraries {
        // A name may contain spaces, and a line may have several names.
        let found = beside(library).map(|bytes| vec![bytes]);
        let found = found.unwrap_or_else(|| library.split(' ').filter_map(&mut *beside).collect());
        if found.is_empty() {
            missing.push(unreadable("material library", library));
        }
        for bytes in found {
            read(&bytes, &mut entries)?;
        }
    }
    let entry = match name {
        Some(name) => entries.iter().find(|entry| entry.name == name),
        None => entries.first(),
    };
    let mut found = entry.map(|entry| entry.found(beside)).unwrap_or_default();
    if let (None, Some(name), []) = (entry, name, missing.as_slice())
        && !libraries.is_empty()
    {
        missing.push(format!(
            "the material {}, which no library has",
            shown(name)
        ));
    }
    found.left_out.splice(0..0, missing);
    Ok(found)
}

/// Adds the materials of a library. Unknown lines are skipped.
fn read(bytes: &[u8], entries: &mut Vec<Entry>) -> Result<(), MeshIoError> {
    for line in lines("MTL", bytes)? {
        if line.keyword()? == b"newmtl" {
            let name = name(&line);
            entries.push(Entry {
                name,
                ..Entry::default()
            });
        } else if let Some(entry) = entries.last_mut() {
            entry.add(&line)?;
        }
    }
    Ok(())
}

impl Entry {
    fn add(&mut self, line: &Line<'_>) -> Result<(), MeshIoError> {
        match line.words[0] {
            b"Kd" => {
                let color = line.vector(1).ok().filter(|color| !color.is_nan());
                self.diffuse = color.map(|color| diffuse(color, line)).transpose()?;
            }
            b"d" => {
                let alpha = line.number(1).ok().filter(|alpha| !alpha.is_nan());
                self.alpha = alpha.map(|alpha| alpha.clamp(0.0, 1.0) as f32);
            }
            b"map_Kd" => self.diffuse_map = Texture::new(line),
            b"norm" => self.normal_map = Texture::new(line),
            word if word.starts_with(b"map_") || OTHER_MAPS.contains(&word) => {
                self.other_maps.insert(joined_words(&[word]));
            }
            _ => {}
        }
        Ok(())
    }

    fn found(&self, beside: &mut Beside<'_>) -> Found {
        let mut left_out = Vec::new();
        let first = self.diffuse_map.as_ref().or(self.normal_map.as_ref());
        let uv_map = first.and_then(Texture::map);
        let mut image = |found: &Option<Texture>| {
            let found = found.as_ref()?;
            if found.map() != uv_map {
                let name = shown(&found.name);
                left_out.push(format!(
                    "the texture {name}, which has other texture coordinates"
                ));
                return None;
            }
            let image = texture(&found.name, beside)
                .map_err(|why| left_out.push(why))
                .ok()?;
            for option in &found.other_options {
                left_out.push(format!(
                    "the option {option} of the texture {}",
                    shown(&found.name)
                ));
            }
            Some(image)
        };
        let base_color = image(&self.diffuse_map);
        let normal = image(&self.normal_map);
        let color = self.diffuse.filter(|_| self.diffuse_map.is_none());
        let base_color_factor = LinearRgba {
            color: color.unwrap_or(LinearRgb::WHITE),
            alpha: self.alpha.unwrap_or(1.0),
        };
        if !self.other_maps.is_empty() {
            let names: Vec<_> = self.other_maps.iter().map(|name| shown(name)).collect();
            left_out.push(format!("textures of the material: {}", names.join(", ")));
        }
        Found {
            material: Material {
                base_color_factor,
                base_color,
                normal,
                ..Material::default()
            },
            uv_map,
            is_clamped: first.is_some_and(|first| first.is_clamped),
            left_out,
        }
    }
}

/// The color of a `Kd`, if it fits in single precision.
fn diffuse(color: DVec3, line: &Line<'_>) -> Result<LinearRgb, MeshIoError> {
    let parts = color.as_vec3().to_array();
    match parts.iter().position(|part| !part.is_finite()) {
        None => Ok(parts.into()),
        Some(at) => {
            let (part, limit) = (color[at], f32::MAX);
            Err(line.error(format!(
                "a part of Kd is {part:e}, but the limit is {limit:e}"
            )))
        }
    }
}

impl Texture {
    /// Parses the options of a texture, each of which is a word with a dash and its arguments, and then its name.
    fn new(line: &Line<'_>) -> Option<Self> {
        let words = line.name_words();
        let mut words = words.as_slice();
        let mut texture = Self {
            scale: DVec2::ONE,
            ..Self::default()
        };
        while let Some((option, rest)) = words
            .split_first()
            .filter(|(word, _)| word.starts_with(b"-"))
        {
            let numbers = rest.iter().take(3).map_while(|word| parse::<f64>(word));
            let numbers: Vec<_> = numbers.collect();
            let vector = |missing: f64| {
                DVec2::new(
                    numbers.first().copied().unwrap_or(missing),
                    numbers.get(1).copied().unwrap_or(missing),
                )
            };
            let n_values = match *option {
                b"-s" => {
                    texture.scale = vector(1.0);
                    numbers.len()
                }
                b"-o" => {
                    texture.offset = vector(0.0);
                    numbers.len()
                }
                // One to three numbers.
                b"-t" => numbers.len(),
                b"-mm" => 2,
                b"-clamp" => {
                    texture.is_clamped = rest.first() == Some(&b"on".as_slice());
                    1
                }
                _ => 1,
            };
            if matches!(*option, b"-t" | b"-mm" | b"-cc" | b"-boost" | b"-imfchan") {
                texture.other_options.push(joined_words(&[option]));
            }
            words = rest.get(n_values..)?;
        }
        texture.name = joined_words(words).replace('\\', "/");
        (!words.is_empty()).then_some(texture)
    }

    /// The map of texture coordinates, v down; `None` if it is the identity.
    fn map(&self) -> Option<UvMap> {
        let (scale, offset) = (self.scale, self.offset);
        (scale != DVec2::ONE || offset != DVec2::ZERO).then_some(UvMap { scale, offset })
    }
}

impl UvMap {
    /// The texture coordinates, v down, in a texture; the file says the map for v up.
    pub(super) fn apply(&self, uv: DVec2) -> DVec2 {
        let up = DVec2::new(uv.x, 1.0 - uv.y) * self.scale + self.offset;
        DVec2::new(up.x, 1.0 - up.y)
    }
}
