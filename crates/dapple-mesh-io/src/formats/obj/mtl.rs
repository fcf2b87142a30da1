//! MTL: the materials of an OBJ file.

use super::{joined_words, name};
use crate::Beside;
use crate::MeshIoError;
use crate::line::{Line, lines};
use crate::text::parse;
use dapple_color::{LinearRgb, LinearRgba};
use dapple_mesh::{EncodedImage, Material};
use glam::DVec3;

#[derive(Default)]
struct Entry {
    name: String,
    diffuse: Option<LinearRgb>,
    alpha: Option<f32>,
    diffuse_map: Option<String>,
    normal_map: Option<String>,
}

/// The material with a name, or without a name the first, in the available libraries.
///
/// Fails for a color that single precision cannot hold, in any material of the libraries.
pub(super) fn material(
    libraries: &[String],
    name: Option<&str>,
    beside: &mut Beside<'_>,
) -> Result<Material, MeshIoError> {
    let mut entries = Vec::new();
    for library in libraries {
        // A name may contain spaces, and a line may have several names.
        let found = beside(library).map(|bytes| vec![bytes]);
        let found = found.unwrap_or_else(|| library.split(' ').filter_map(&mut *beside).collect());
        for bytes in found {
            read(&bytes, &mut entries)?;
        }
    }
    let entry = match name {
        Some(name) => entries.iter().find(|entry| entry.name == name),
        None => entries.first(),
    };
    Ok(entry
        .map(|entry| entry.material(beside))
        .unwrap_or_default())
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
            b"map_Kd" => self.diffuse_map = file_name(line),
            b"norm" => self.normal_map = file_name(line),
            _ => {}
        }
        Ok(())
    }

    fn material(&self, beside: &mut Beside<'_>) -> Material {
        let mut image = |name: &Option<String>| {
            let bytes = beside(name.as_deref()?)?;
            EncodedImage::new(bytes).ok()
        };
        let base_color = image(&self.diffuse_map);
        let normal = image(&self.normal_map);
        let color = self.diffuse.filter(|_| self.diffuse_map.is_none());
        let base_color_factor = LinearRgba {
            color: color.unwrap_or(LinearRgb::WHITE),
            alpha: self.alpha.unwrap_or(1.0),
        };
        Material {
            base_color_factor,
            base_color,
            normal,
            ..Material::default()
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

/// The name of the file after the options of a texture, each of which is a word with a dash and its arguments.
fn file_name(line: &Line<'_>) -> Option<String> {
    let words = line.name_words();
    let mut words = words.as_slice();
    while let Some((option, rest)) = words
        .split_first()
        .filter(|(word, _)| word.starts_with(b"-"))
    {
        let n_values = match *option {
            // One to three numbers.
            b"-o" | b"-s" | b"-t" => rest
                .iter()
                .take(3)
                .take_while(|word| parse::<f64>(word).is_some())
                .count(),
            b"-mm" => 2,
            _ => 1,
        };
        words = rest.get(n_values..)?;
    }
    (!words.is_empty()).then(|| joined_words(words).replace('\\', "/"))
}
