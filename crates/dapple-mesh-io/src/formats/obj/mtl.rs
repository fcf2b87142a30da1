//! Reads MTL files, which contain the materials of OBJ files.

use super::{joined_words, name};
use crate::FileResolver;
use crate::MeshIoError;
use crate::line::{Line, lines};
use crate::text::parse;
use crate::texture::{is_outside, name_of_all, shown, texture, tile_name, unreadable};
use dapple_color::{LinearRgb, LinearRgba};
use dapple_mesh::{EncodedImage, Material, Model, TileMaterial};
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;

/// Keywords of textures that do not start with `map_`.
const OTHER_MAPS: [&[u8]; 4] = [b"bump", b"decal", b"disp", b"refl"];

#[derive(Default)]
struct Entry {
    name: String,
    diffuse: Option<LinearRgb>,
    alpha: Option<f32>,
    diffuse_map: Option<Texture>,
    normal_map: Option<Texture>,
    /// Keywords of textures that a model cannot represent.
    other_maps: BTreeSet<String>,
}

/// A texture file name with its options.
#[derive(Default)]
struct Texture {
    name: String,
    scale: DVec2,
    offset: DVec2,
    is_clamped: bool,
    other_options: Vec<String>,
}

/// A scale and then an offset of texture coordinates whose v points up.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct UvMap {
    scale: DVec2,
    offset: DVec2,
}

/// Sets a model's material to the one called `name` in the referenced libraries, or to the first one if `name` is
/// `None`. Applies the transform of its textures to the texture coordinates.
///
/// Fails if any material of the libraries has a color outside the range of `f32`.
pub(super) fn add_material(
    model: &mut Model,
    libraries: &[String],
    name: Option<&str>,
    resolve: &mut FileResolver<'_>,
) -> Result<(), MeshIoError> {
    let (mut entries, mut missing) = (Vec::new(), Vec::new());
    for library in libraries {
        // A name may contain spaces, and a line may have several names.
        let found = resolve(library).map(|bytes| vec![bytes]);
        let found = found.unwrap_or_else(|| library.split(' ').filter_map(&mut *resolve).collect());
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
    if let (None, Some(name), []) = (entry, name, missing.as_slice())
        && !libraries.is_empty()
    {
        missing.push(format!(
            "the material {}, which no library has",
            shown(name)
        ));
    }
    model.left_out.extend(missing);
    if let Some(entry) = entry {
        entry.add_to(model, resolve);
    }
    Ok(())
}

/// Reads the materials of a library. Unknown lines are skipped.
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

    /// Assigns this material to a model.
    fn add_to(&self, model: &mut Model, resolve: &mut FileResolver<'_>) {
        let first = self.diffuse_map.as_ref().or(self.normal_map.as_ref());
        let uv_map = first.and_then(Texture::map);
        if let (Some(map), Some(uvs)) = (uv_map, &mut model.uvs) {
            uvs.iter_mut().flatten().for_each(|uv| *uv = map.apply(*uv));
        }
        let mut reading = Reading {
            squares: model.unit_squares(),
            uv_map,
            resolve,
            left_out: &mut model.left_out,
        };
        let mut base_colors = reading.images(self.diffuse_map.as_ref());
        let mut normals = reading.images(self.normal_map.as_ref());
        let is_tiled = base_colors.len().max(normals.len()) > 1;
        for (images, found) in [
            (&mut base_colors, &self.diffuse_map),
            (&mut normals, &self.normal_map),
        ] {
            // A copy per unit square would take far more memory than the file.
            if let (true, 1, Some(found)) = (is_tiled, images.len(), found) {
                images.clear();
                let name = shown(&found.name);
                let what = format!("the texture {name}, which all unit squares share");
                reading.left_out.push(what);
            }
        }
        let color = self.diffuse.filter(|_| self.diffuse_map.is_none());
        let base_color_factor = LinearRgba {
            color: color.unwrap_or(LinearRgb::WHITE),
            alpha: self.alpha.unwrap_or(1.0),
        };
        let material = |at: usize| Material {
            base_color_factor,
            base_color: base_colors.get(at).cloned().flatten(),
            normal: normals.get(at).cloned().flatten(),
            ..Material::default()
        };
        if is_tiled {
            let tile = |(at, &number): (usize, &u32)| TileMaterial {
                number,
                material: material(at),
            };
            model.tiles = reading.squares.iter().enumerate().map(tile).collect();
        }
        model.material = material(0);
        if !self.other_maps.is_empty() {
            let names: Vec<_> = self.other_maps.iter().map(|name| shown(name)).collect();
            let names = names.join(", ");
            model
                .left_out
                .push(format!("textures of the material: {names}"));
        }
        let is_clamped = first.is_some_and(|first| first.is_clamped);
        if is_clamped && model.tiles.is_empty() && is_outside(model) {
            let what = "the option -clamp of the texture, which repeats here";
            model.left_out.push(what.to_owned());
        }
    }
}

/// State while the textures of a material are read.
struct Reading<'a, 'b> {
    /// Numbers of the unit squares of texture coordinates that contain faces.
    squares: Vec<u32>,
    uv_map: Option<UvMap>,
    resolve: &'a mut FileResolver<'b>,
    left_out: &'a mut Vec<String>,
}

impl Reading<'_, '_> {
    /// Returns the images of a texture: one per unit square if the squares have separate textures, otherwise at most
    /// one.
    fn images(&mut self, found: Option<&Texture>) -> Vec<Option<EncodedImage>> {
        let Some(found) = found else {
            return Vec::new();
        };
        let name = shown(&found.name);
        if found.map() != self.uv_map {
            let what = format!("the texture {name}, which has other texture coordinates");
            self.left_out.push(what);
            return Vec::new();
        }
        let images = match self.tiles(found) {
            Some(images) => images,
            None => {
                let image = texture(&found.name, self.resolve);
                vec![image.map_err(|why| self.left_out.push(why)).ok()]
            }
        };
        if images.iter().any(Option::is_some) {
            for option in &found.other_options {
                self.left_out
                    .push(format!("the option {option} of the texture {name}"));
            }
        }
        images
    }

    /// Returns the images of the unit squares if the texture's name is a pattern, or contains the number of a square
    /// and the files of all squares exist. Otherwise returns `None`.
    fn tiles(&mut self, found: &Texture) -> Option<Vec<Option<EncodedImage>>> {
        let name = &found.name;
        if tile_name(name, 1001).is_some() {
            if self.squares.is_empty() {
                let name = shown(name);
                let what = "since faces lie across unit squares or past the tenth column";
                self.left_out.push(format!("the texture {name}, {what}"));
                return Some(Vec::new());
            }
            return Some(self.tiles_of(name));
        }
        let name = name_of_all(name, &self.squares)?;
        let n_before = self.left_out.len();
        let images = self.tiles_of(&name);
        let has_all = images.iter().all(Option::is_some);
        if !has_all {
            // The texture is shared by all squares.
            self.left_out.truncate(n_before);
        }
        has_all.then_some(images)
    }

    /// Returns the image of each unit square. `name` is a pattern with a placeholder for the square.
    fn tiles_of(&mut self, name: &str) -> Vec<Option<EncodedImage>> {
        let mut missing = None;
        let mut n_missing = 0;
        let mut image = |&number: &u32| {
            let name = tile_name(name, number)?;
            let image = texture(&name, self.resolve);
            image
                .map_err(|why| {
                    n_missing += 1;
                    missing.get_or_insert(why);
                })
                .ok()
        };
        let images = self.squares.iter().map(&mut image).collect();
        if let Some(why) = missing {
            self.left_out.push(match n_missing {
                1 => why,
                count => format!("{why}, and {} more of its unit squares", count - 1),
            });
        }
        images
    }
}

/// Converts a `Kd` value to a color. Fails if it is outside the range of `f32`.
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
    /// Parses the options of a texture, which are words that begin with a dash and their arguments, and then its name.
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
                // One to three numbers
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

    /// Returns the transform for texture coordinates; `None` if it is the identity.
    fn map(&self) -> Option<UvMap> {
        let (scale, offset) = (self.scale, self.offset);
        (scale != DVec2::ONE || offset != DVec2::ZERO).then_some(UvMap { scale, offset })
    }
}

impl UvMap {
    /// Transforms texture coordinates whose v points down. The transform itself is for v pointing up, as in the file.
    pub(super) fn apply(&self, uv: DVec2) -> DVec2 {
        let up = DVec2::new(uv.x, 1.0 - uv.y) * self.scale + self.offset;
        DVec2::new(up.x, 1.0 - up.y)
    }
}
