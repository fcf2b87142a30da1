//! Parses a layer on the command line, such as
//! `grass.png,weight=mask.png,height=grass_height.png,normal=grass_normal.png`.

use crate::args::{Alpha, MapArg, ReadArgs, Size};
use crate::encode::map_raster;
use crate::error::{Hint, usage};
use crate::input::{self, Kind, Loaded};
use crate::words::{slip, with_underscores};
use anyhow::{Context as _, Result};
use dapple::raster::Raster;
use dapple::recipe::MapKind;
use dapple::tile::{Map, TileError, repeat};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The name of the first map of a layer.
const BASE: &str = "base";

/// The name of the map with a layer's height.
pub(in crate::commands) const HEIGHT: &str = "height";

/// A layer as given on the command line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(in crate::commands) struct LayerArg {
    path: PathBuf,
    weight: Option<Weight>,
    /// The maps after the first one, as pairs of name and file, sorted by name. [`HEIGHT`] and `normal` have a special
    /// meaning.
    maps: Vec<(String, PathBuf)>,
}

/// Weight of a layer: a number, or the file of a mask.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
enum Weight {
    Number(f32),
    Mask(PathBuf),
}

/// A layer with its images, as read.
#[derive(Debug)]
pub(in crate::commands) struct Material {
    /// The maps, in the order of their names.
    pub(in crate::commands) maps: Vec<Map>,
    /// The alpha of the first map; `None` if it is not kept.
    pub(in crate::commands) alpha: Option<Raster<f32>>,
    /// Whether the first map has associated alpha, that is, colors multiplied by alpha.
    pub(in crate::commands) is_associated: bool,
    /// The layer's height; `None` if it has no height.
    pub(in crate::commands) height: Option<Raster<f32>>,
    /// Whether any of the images has more than 8 bits per channel.
    pub(in crate::commands) is_deep: bool,
    weight: Option<ReadWeight>,
}

#[derive(Debug)]
enum ReadWeight {
    Number(f32),
    Mask(Raster<f32>),
}

impl FromStr for LayerArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (path, pairs) = split(text);
        if path.is_empty() {
            return Err(format!("{text:?} does not begin with an image"));
        }
        let mut layer = Self {
            path: PathBuf::from(path),
            weight: None,
            maps: Vec::new(),
        };
        for (key, value) in pairs {
            check_key(&key)?;
            if value.is_empty() {
                return Err(format!("nothing follows {key}= in {text:?}"));
            }
            let is_new = if key == "weight" {
                layer.weight.replace(weight(&value)?).is_none()
            } else {
                let is_new = key != BASE && layer.maps.iter().all(|(other, _)| *other != key);
                layer.maps.push((key.clone(), PathBuf::from(value)));
                is_new
            };
            if !is_new {
                return Err(format!("{key}= is there twice in {text:?}"));
            }
        }
        layer.maps.sort();
        Ok(layer)
    }
}

impl LayerArg {
    /// Adds maps to layers. Of the maps with the same name, the first is added to the first layer, the second to the
    /// second, and so on.
    ///
    /// # Errors
    ///
    /// If there are more maps of a name than layers, or a layer has the map already.
    pub(in crate::commands) fn with_maps(layers: &[Self], maps: &[MapArg]) -> Result<Vec<Self>> {
        let mut layers = layers.to_vec();
        for (index, MapArg { name, path }) in maps.iter().enumerate() {
            let is_of_name = |map: &&MapArg| map.name == *name;
            let place = maps[..index].iter().filter(is_of_name).count();
            let n_layers = layers.len();
            let Some(layer) = layers.get_mut(place) else {
                let message = format!(
                    "--map {name} is given {} times, but the number of images is {n_layers}",
                    place + 1
                );
                return Err(
                    usage(message).hint("give it at most once for each image, in their order")
                );
            };
            check_key(name).map_err(usage)?;
            if name == BASE || layer.maps.iter().any(|(other, _)| other == name) {
                let message = format!("{} has {name} twice", layer.path.display());
                return Err(usage(message).hint(format!("leave out --map {name} or {name}=")));
            }
            layer.maps.push((name.clone(), path.clone()));
            layer.maps.sort();
        }
        Ok(layers)
    }

    /// Returns the file of the first map.
    pub(in crate::commands) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns whether the layer has a weight.
    pub(in crate::commands) fn has_weight(&self) -> bool {
        self.weight.is_some()
    }

    /// Returns whether the layer has a height map.
    pub(in crate::commands) fn has_height(&self) -> bool {
        self.maps.iter().any(|(name, _)| name == HEIGHT)
    }

    /// Returns the names of the maps, except the height.
    pub(in crate::commands) fn map_names(&self) -> Vec<&str> {
        let others = self.maps.iter().map(|(name, _)| name.as_str());
        let others: Vec<_> = others.filter(|name| *name != HEIGHT).collect();
        [BASE].into_iter().chain(others).collect()
    }

    /// Reads all images of the layer.
    ///
    /// # Errors
    ///
    /// If an image cannot be read.
    pub(in crate::commands) fn read(&self, reader: &mut Reader<'_>) -> Result<Material> {
        let base = reader.read(&self.path, Kind::ByChannels)?;
        let (mut maps, mut height, mut is_deep) = (vec![base.map], None, base.is_deep);
        for (name, path) in &self.maps {
            let kind = match name.as_str() {
                "normal" => Kind::Normals,
                _ => Kind::ByChannels,
            };
            let loaded = reader.read_opaque(path, kind)?;
            if name == HEIGHT {
                height = Some(values(loaded.map));
            } else {
                maps.push(loaded.map);
                is_deep |= loaded.is_deep;
            }
        }
        let weight = match &self.weight {
            None => None,
            Some(Weight::Number(number)) => Some(ReadWeight::Number(*number)),
            Some(Weight::Mask(path)) => {
                let mask = reader.read_opaque(path, Kind::ByChannels)?;
                Some(ReadWeight::Mask(values(mask.map)))
            }
        };
        Ok(Material {
            maps,
            alpha: base.alpha,
            is_associated: base.is_associated,
            height,
            is_deep,
            weight,
        })
    }

    /// Returns the files of the maps, except the height, in the order of [`map_names`](Self::map_names).
    fn map_paths(&self) -> impl Iterator<Item = &Path> {
        let others = self.maps.iter().filter(|(name, _)| name != HEIGHT);
        let others = others.map(|(_, path)| path.as_path());
        [self.path.as_path()].into_iter().chain(others)
    }
}

/// Reads the images of all layers, and repeats or crops them to the same size.
#[derive(Debug)]
pub(in crate::commands) struct Reader<'a> {
    /// Size to which images are repeated or cropped; `None` to require images of equal size.
    size: Option<Size>,
    /// How to handle alpha.
    alpha: Alpha,
    /// The options for reading images.
    read: &'a ReadArgs,
    /// The path and size of the first image, with which the others are compared.
    first: Option<(PathBuf, [u32; 2])>,
    /// The hint for the error about images of different sizes.
    hint: &'static str,
}

impl<'a> Reader<'a> {
    /// Creates a reader that repeats or crops images to `size`. If `size` is `None`, all images must have the size of
    /// the first one; the error for other sizes has the hint `hint`.
    pub(in crate::commands) fn new(
        size: Option<Size>,
        alpha: Alpha,
        read: &'a ReadArgs,
        hint: &'static str,
    ) -> Self {
        Self {
            size,
            alpha,
            read,
            first: None,
            hint,
        }
    }

    /// Reads an image.
    ///
    /// # Errors
    ///
    /// If the image cannot be read, or differs in size from the first one.
    pub(in crate::commands) fn read(&mut self, path: &Path, kind: Kind) -> Result<Loaded> {
        let mut loaded = input::map_with_alpha(path, kind, None, self.alpha, self.read)?;
        if let Some(size) = self.size {
            loaded.map = repeated(&loaded.map, size)?;
            let alpha = loaded.alpha.map(|alpha| repeat(&alpha, size.0));
            loaded.alpha = alpha.transpose().context("the images cannot be repeated")?;
        }
        let size = loaded.map.size();
        let (first, first_size) = self.first.get_or_insert_with(|| (path.to_owned(), size));
        input::check_size(path, size, first, *first_size).hint(self.hint)?;
        Ok(loaded)
    }

    /// Reads an image that must have no alpha.
    ///
    /// # Errors
    ///
    /// Same as [`read`](Self::read), or if the image is partly transparent and its alpha is kept.
    pub(in crate::commands) fn read_opaque(&mut self, path: &Path, kind: Kind) -> Result<Loaded> {
        let loaded = self.read(path, kind)?;
        if loaded.alpha.is_some() {
            let message = format!(
                "{} is partly transparent, which only the first image of a layer keeps",
                input::name(path)
            );
            return Err(usage(message).hint(input::ALPHA_HINT));
        }
        Ok(loaded)
    }

    /// Makes maps with the same name have the same kind in all layers: a gray map is read again as colors if another
    /// layer's map has colors.
    ///
    /// # Errors
    ///
    /// If an image cannot be read.
    pub(in crate::commands) fn agree(
        &mut self,
        layers: &[LayerArg],
        materials: &mut [Material],
    ) -> Result<()> {
        for map in 0..materials[0].maps.len() {
            let is_color = |material: &Material| matches!(material.maps[map], Map::Color(_));
            if !materials.iter().any(is_color) {
                continue;
            }
            for (layer, material) in layers.iter().zip(&mut *materials) {
                if let (Map::Value(_), Some(path)) =
                    (&material.maps[map], layer.map_paths().nth(map))
                {
                    material.maps[map] = self.read(path, Kind::Colors)?.map;
                }
            }
        }
        Ok(())
    }
}

/// Returns the weight of each layer at every pixel. Layers without a weight equally divide the difference between 1 and
/// the sum of the given weights.
///
/// # Errors
///
/// If a mask differs in size.
pub(in crate::commands) fn weights(
    materials: &[Material],
    size: [u32; 2],
) -> Result<Vec<Raster<f32>>, TileError> {
    let given: Vec<Option<Raster<f32>>> = materials
        .iter()
        .map(|material| match &material.weight {
            None => Ok(None),
            Some(ReadWeight::Number(number)) => Raster::filled(size, *number).map(Some),
            Some(ReadWeight::Mask(mask)) => Ok(Some(mask.clone())),
        })
        .collect::<Result<_, _>>()?;
    let mut left = Raster::filled(size, 1.0_f32)?;
    for weight in given.iter().flatten() {
        left = left.zip_map(weight, |left, weight| left - weight)?;
    }
    let n_without = given.iter().filter(|weight| weight.is_none()).count();
    let rest = left.map(|left| left.max(0.0) / n_without as f32);
    Ok(given
        .into_iter()
        .map(|weight| weight.unwrap_or_else(|| rest.clone()))
        .collect())
}

/// Returns a map as a single number per pixel: the luminance of colors, or the z component of normals.
pub(in crate::commands) fn values(map: Map) -> Raster<f32> {
    match map {
        Map::Value(values) => values,
        Map::Color(colors) => colors.map(|color| color.luminance()),
        Map::Normal(normals) => normals.map(|normal| normal.z),
    }
}

/// Splits a layer's text at each `,key=`. Returns the text before the first key and the pairs of key and value. Other
/// commas are part of file names.
fn split(text: &str) -> (String, Vec<(String, String)>) {
    let mut parts = text.split(',');
    let mut path = parts.next().unwrap_or_default().to_owned();
    let mut pairs: Vec<(String, String)> = Vec::new();
    for part in parts {
        match part.split_once('=') {
            Some((key, value)) if is_key(key) => {
                pairs.push((with_underscores(key), value.to_owned()));
            }
            _ => {
                let before = pairs.last_mut().map_or(&mut path, |(_, value)| value);
                before.push(',');
                before.push_str(part);
            }
        }
    }
    (path, pairs)
}

/// Returns whether `key` consists of the characters allowed in keys: ASCII letters, `_` and `-`.
fn is_key(key: &str) -> bool {
    !key.is_empty()
        && key
            .bytes()
            .all(|byte| byte.is_ascii_alphabetic() || b"_-".contains(&byte))
}

/// Returns an error if a key is a likely misspelling of a known one. Any other key is the name of a map.
fn check_key(key: &str) -> Result<(), String> {
    let maps = MapKind::ALL.into_iter().map(MapKind::name);
    slip("key", key, ["weight"].into_iter().chain(maps)).map_or(Ok(()), Err)
}

/// Parses a weight, which is a number or the file of a mask.
fn weight(text: &str) -> Result<Weight, String> {
    match text.parse::<f32>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(Weight::Number(number)),
        Ok(number) => Err(format!("a weight is at least 0 and finite, not {number}")),
        Err(_) => Ok(Weight::Mask(PathBuf::from(text))),
    }
}

/// Repeats or crops a map to `size`.
fn repeated(map: &Map, size: Size) -> Result<Map> {
    let context = "the images cannot be repeated";
    Ok(map_raster!(map, raster => repeat(raster, size.0).context(context)?))
}

#[cfg(test)]
mod tests {
    use super::{LayerArg, Material, ReadWeight, Weight, weights};
    use dapple::raster::Raster;
    use dapple::tile::Map;
    use std::path::PathBuf;

    #[test]
    fn layers_are_an_image_with_keys() {
        let layer: LayerArg = "a.png,weight=0.5,roughness=r.png,height=h.png"
            .parse()
            .unwrap();
        assert_eq!(layer.weight, Some(Weight::Number(0.5)));
        assert_eq!(layer.map_names(), ["base", "roughness"]);
        let shouted: LayerArg = "a.png,Weight=0.5,HEIGHT=h.png,roughness=r.png"
            .parse()
            .unwrap();
        assert_eq!(shouted, layer, "keys are read in any case");
        let odd: LayerArg = "a,b.png,weight=c,d.png".parse().unwrap();
        assert_eq!(odd.path, PathBuf::from("a,b.png"), "commas of the name");
        assert_eq!(odd.weight, Some(Weight::Mask(PathBuf::from("c,d.png"))));
    }

    #[test]
    fn layers_that_are_none_say_why() {
        for text in [
            "",
            ",weight=1",
            "a,weight=",
            "a,weight=-1",
            "a,weight=1,weight=2",
            "a,base=b",
            "a,weigth=1",
            "a,Normals=b",
        ] {
            assert!(text.parse::<LayerArg>().is_err(), "{text:?} is no layer");
        }
    }

    fn material(weight: Option<ReadWeight>) -> Material {
        Material {
            maps: vec![Map::Value(Raster::filled([2, 1], 0.0).unwrap())],
            alpha: None,
            is_associated: false,
            height: None,
            is_deep: false,
            weight,
        }
    }

    #[test]
    fn the_ground_gets_what_the_others_leave() {
        let mask = Raster::from_vec([2, 1], vec![0.25, 2.0]).unwrap();
        let layers = [material(None), material(Some(ReadWeight::Mask(mask)))];
        let weights = weights(&layers, [2, 1]).unwrap();
        assert_eq!(weights[0].pixels(), [0.75, 0.0]);
        assert_eq!(weights[1].pixels(), [0.25, 2.0]);
    }

    #[test]
    fn layers_without_weights_share_evenly() {
        let layers = [material(None), material(None)];
        let weights = weights(&layers, [2, 1]).unwrap();
        assert_eq!(weights[0].pixels(), [0.5, 0.5]);
        assert_eq!(weights[0], weights[1]);
    }
}
