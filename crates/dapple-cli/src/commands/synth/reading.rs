//! Reads the images for a synthesis: examples, their maps, masks and guides.

use super::example_mesh::ExampleMesh;
use super::guides::Guide;
use super::material::is_of;
use super::options::Channel;
use super::tiles::Sheet;
use super::{Args, advise};
use crate::args::{Alpha, MapArg};
use crate::error::{Hint, usage};
use crate::exemplar::exemplar_of;
use crate::input::{self, Kind, Loaded};
use anyhow::{Result, bail};
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::{ImageAlpha, MapKind};
use dapple::synth::{Edges, Exemplar, SideBySide, SynthError};
use dapple::tile::Map;
use std::path::{Path, PathBuf};

/// The input to a synthesis. Several examples are placed side by side in one image.
pub(super) struct Input {
    /// The image that the texture copies its pixels from: the example, or its larger version given by `--detail`.
    pub(super) base: Loaded,
    /// The maps of the example, with their names.
    pub(super) maps: Vec<(String, Loaded)>,
    /// The layout of the examples in one image.
    pub(super) layout: SideBySide,
    pub(super) exemplar: Exemplar,
    /// The pixels to re-synthesize; `None` unless the example is repaired.
    pub(super) hole: Option<Raster<bool>>,
    pub(super) guides: Vec<Guide>,
}

impl Args {
    /// Reads the examples, their maps, masks and guides, and the larger version given by `--detail`. Maps must have the
    /// size of the image from which pixels are copied.
    pub(super) fn read(&self) -> Result<Input> {
        let paths: Vec<_> = [&self.exemplar]
            .into_iter()
            .chain(&self.guides.examples)
            .collect();
        let examples = paths.iter().map(|path| self.load(path, Kind::ByChannels));
        let mut examples: Vec<_> = examples.collect::<Result<_>>()?;
        if self.surface.mesh.is_some() {
            // On a mesh, baking weights colors by their alpha, and textures of models have straight colors.
            examples.iter_mut().try_for_each(Loaded::divide)?;
        }
        let sizes: Vec<_> = examples.iter().map(|example| example.map.size()).collect();
        let layout = SideBySide::new(&sizes)?.with_turned(self.guides.turned)?;
        let hole = self.read_hole(&examples[0], None)?;
        for (image, (path, example)) in paths.iter().zip(&examples).enumerate() {
            self.check_usable(path, example, (path, image), hole.as_ref())?;
        }
        if self.plane.repair_channel == Some(Channel::Alpha) {
            // Re-synthesized pixels are opaque, so the whole result is opaque.
            examples[0].alpha = None;
        }
        // Join the examples, and add the mask and the guides.
        let example = joined(&layout, examples)?;
        let edges = match layout.size() == sizes[0] {
            true => self.matching.edges,
            false => Edges::Cut,
        };
        let mut exemplar = exemplar_of(&example.map, edges).map_err(advise)?;
        if let Some(usable) = self.read_masks(&paths, &layout, (hole.as_ref(), None))? {
            exemplar = exemplar.with_mask(&usable)?;
        }
        exemplar = exemplar.with_layout(&layout)?;
        let guides = self.read_guides(&layout, &example)?;
        let planes: Vec<_> = guides
            .iter()
            .map(|guide| (&guide.example, guide.weight))
            .collect();
        let exemplar = exemplar.with_guides(&planes).map_err(advise)?;
        let base = match &self.detail {
            None => example,
            Some(path) => {
                let detail = self.load_detail(path, exemplar.size())?;
                detail.check_finite(path)?;
                detail
            }
        };
        let shown = self.detail.as_ref().map_or(paths, |path| vec![path]);
        let maps = self.load_maps(&layout, &shown, base.map.size(), hole.as_ref())?;
        Ok(Input {
            exemplar: self.with_weighted(exemplar, &maps).map_err(advise)?,
            base,
            maps,
            layout,
            hole,
            guides,
        })
    }

    /// Reads the input for an example that is a mesh, which consists of its texture, the maps given by `--map`, and the
    /// maps of its material.
    pub(super) fn read_with(&self, example: &ExampleMesh) -> Result<Input> {
        let base = example.base.clone();
        let mut exemplar = exemplar_of(&base.map, self.matching.edges).map_err(advise)?;
        let layout = SideBySide::new(&[exemplar.size()])?;
        let sheet = example.sheet.as_ref();
        let hole = self.read_hole(&base, sheet)?;
        if let Some(usable) = self.read_masks(&[&self.exemplar], &layout, (hole.as_ref(), sheet))? {
            exemplar = exemplar.with_mask(&usable)?;
        }
        let guides = self.read_guides(&layout, &base)?;
        let planes = guides.iter().map(|guide| (&guide.example, guide.weight));
        let planes: Vec<_> = planes.collect();
        let exemplar = exemplar.with_guides(&planes).map_err(advise)?;
        let mut maps = Vec::new();
        for MapArg { name, path } in &self.map {
            if maps.iter().any(|(other, _)| other == name) {
                let error = usage(format!("--map {name} is given twice"));
                return Err(error.hint("leave one of them out"));
            }
            let load = |path: &Path| {
                let map = self.load_map(name, path)?;
                map.check_finite(path)?;
                Ok(map)
            };
            let map = match sheet {
                Some(sheet) => sheet.join(sheet.read(path, &self.exemplar, load)?)?,
                None => load(path)?,
            };
            maps.push((name.clone(), map));
        }
        let exemplar = self.with_weighted(exemplar, &maps).map_err(advise)?;
        maps.extend(example.maps.iter().cloned());
        Ok(Input {
            base,
            maps,
            layout,
            exemplar,
            hole,
            guides,
        })
    }

    /// Reads the maps. For each name, there must be one map per example. They are placed side by side in the same
    /// layout as the examples. `shown` are the images whose sizes the maps must have.
    fn load_maps(
        &self,
        layout: &SideBySide,
        shown: &[&PathBuf],
        size: [u32; 2],
        hole: Option<&Raster<bool>>,
    ) -> Result<Vec<(String, Loaded)>> {
        // Group the maps by name.
        let mut maps: Vec<(String, Vec<&PathBuf>)> = Vec::new();
        for MapArg { name, path } in &self.map {
            match maps.iter_mut().find(|(other, _)| other == name) {
                Some((_, paths)) => paths.push(path),
                None => maps.push((name.clone(), vec![path])),
            }
        }
        let mut loaded = Vec::new();
        for (name, paths) in maps {
            if paths.len() != shown.len() {
                let message = format!(
                    "maps with the name {name}: {}; examples: {}",
                    paths.len(),
                    shown.len()
                );
                let hint = format!("give --map {name}=IMAGE once for each example, in their order");
                return Err(usage(message).hint(hint));
            }
            let mut images = Vec::new();
            for (image, (path, example)) in paths.into_iter().zip(shown).enumerate() {
                let map = self.load_map(&name, path)?;
                let size = if self.detail.is_none() {
                    layout.size_of(image)
                } else {
                    size
                };
                input::check_size(path, map.map.size(), example, size)
                    .hint("the maps of an example have its size")?;
                if self.detail.is_none() {
                    self.check_usable(path, &map, (example, image), hole)?;
                } else {
                    map.check_finite(path)?;
                }
                images.push(map);
            }
            loaded.push((name, joined(layout, images)?));
        }
        Ok(loaded)
    }

    /// Reads a map. The name `normal` means normals.
    fn load_map(&self, name: &str, path: &Path) -> Result<Loaded> {
        let kind = if is_of(name, MapKind::Normal) {
            Kind::Normals
        } else {
            Kind::ByChannels
        };
        let map = self.load(path, kind)?;
        if map.alpha.is_some() && self.surface.mesh.is_some() {
            let message = format!(
                "{} is partly transparent, which maps on a mesh cannot be",
                input::name(path)
            );
            return Err(usage(message).hint(input::ALPHA_HINT));
        }
        Ok(map)
    }

    /// Adds the maps that have a weight to the exemplar, as additional channels for matching.
    fn with_weighted(
        &self,
        mut exemplar: Exemplar,
        maps: &[(String, Loaded)],
    ) -> Result<Exemplar, SynthError> {
        for (name, Loaded { map, .. }) in maps {
            let weight = self.matching.weight_of(name);
            if weight > 0.0 {
                // With `--detail`, maps are as large as the larger example. Reduce them to the size of the exemplar.
                let factor = map.size()[0] / exemplar.size()[0];
                let map = exemplar_of(map, exemplar.edges())?.reduced(factor)?;
                exemplar = exemplar.with_channels(&map, weight)?;
            }
        }
        Ok(exemplar)
    }

    /// Returns an error if an image has a NaN or infinite value at a pixel that is used: one outside of the hole, where
    /// the example's mask is white. `example` and `index` are the path and index of the example.
    fn check_usable(
        &self,
        path: &Path,
        image: &Loaded,
        (example, index): (&Path, usize),
        hole: Option<&Raster<bool>>,
    ) -> Result<()> {
        if image.faults.is_empty() {
            return Ok(());
        }
        let hole = hole.filter(|_| index == 0);
        let mask = self.mask.get(index);
        let mask = mask.map(|mask| self.load_mask(mask, example, image.map.size(), None));
        let mask = mask.transpose()?;
        let is_used = |column: u32, row: u32| {
            let at = |raster: &Raster<bool>| raster.row(row)[column as usize];
            mask.as_ref().is_none_or(at) && !hole.is_some_and(at)
        };
        image.faults.check(&input::name(path), is_used)
    }

    /// Reads the mask of usable pixels: those outside of the hole where the masks of the examples are white. Returns
    /// `None` if all pixels are usable.
    fn read_masks(
        &self,
        paths: &[&PathBuf],
        layout: &SideBySide,
        (hole, sheet): (Option<&Raster<bool>>, Option<&Sheet>),
    ) -> Result<Option<Raster<bool>>> {
        let is_one = layout.size() == layout.size_of(0);
        if self.mask.is_empty() && hole.is_none() && is_one {
            return Ok(None);
        }
        if !self.mask.is_empty() && self.mask.len() != paths.len() {
            let message = format!("masks: {}; examples: {}", self.mask.len(), paths.len());
            return Err(usage(message).hint("give --mask once for each example, in their order"));
        }
        let mut masks = Vec::new();
        for (image, path) in paths.iter().enumerate() {
            let size = layout.size_of(image);
            masks.push(match self.mask.get(image) {
                Some(mask) => self.load_mask(mask, path, size, sheet)?,
                None => Raster::filled(size, true)?,
            });
        }
        if let Some(hole) = hole {
            let is_usable = |&is_usable: &bool, &is_made: &bool| is_usable && !is_made;
            masks[0] = masks[0].zip_map(hole, is_usable)?;
        }
        let masks: Vec<_> = masks.iter().collect();
        Ok(Some(layout.join(&masks, false)?))
    }

    /// Reads the hole, the mask of pixels to re-synthesize in the first example. Returns `None` if the example is not
    /// repaired.
    fn read_hole(&self, example: &Loaded, sheet: Option<&Sheet>) -> Result<Option<Raster<bool>>> {
        if let Some(path) = &self.plane.repair {
            return self
                .load_mask(path, &self.exemplar, example.map.size(), sheet)
                .map(Some);
        }
        let Some(channel) = self.plane.repair_channel else {
            return Ok(None);
        };
        let values = channel.of(example).ok_or_else(|| {
            let name = input::name(&self.exemplar);
            let error = usage(format!("{name} has no channel {channel}"));
            error.hint("give a mask with --repair FILE")
        })?;
        Ok(Some(values.map(|&value| value < 0.5)))
    }

    /// Reads a mask with the size of an example. Pixels are set if their lightness is at least ½.
    fn load_mask(
        &self,
        path: &Path,
        example: &Path,
        size: [u32; 2],
        sheet: Option<&Sheet>,
    ) -> Result<Raster<bool>> {
        if let Some(sheet) = sheet {
            let load = |path: &Path| self.load_mask(path, example, sheet.size(), None);
            return sheet.join_masks(&sheet.read(path, example, load)?);
        }
        let over_black = Alpha::Without(ImageAlpha::Over(LinearRgb::default()));
        let mask =
            input::map_with_alpha(path, Kind::ByChannels, self.region, over_black, &self.read)?.map;
        input::check_size(path, mask.size(), example, size)
            .hint("a mask of an example has its size")?;
        match mask {
            Map::Value(values) => Ok(values.map(|&value| value >= 0.5)),
            Map::Color(colors) => Ok(colors.map(|color| color.luminance() >= 0.5)),
            Map::Normal(_) => bail!("normals are no mask"),
        }
    }

    /// Reads a larger version of the example. Its sides must be the same integer multiple of the example's sides.
    fn load_detail(&self, path: &Path, [width, height]: [u32; 2]) -> Result<Loaded> {
        let detail = self.load(path, Kind::ByChannels)?;
        let size = detail.map.size();
        let factor = size[0] / width;
        if factor > 0 && [width, height].map(|side| side.checked_mul(factor)) == size.map(Some) {
            return Ok(detail);
        }
        let error = usage(format!(
            "{} has {} × {} pixels, which is not the {width} × {height} of {} times a whole number",
            input::name(path),
            size[0],
            size[1],
            input::name(&self.exemplar)
        ));
        Err(error.hint("make the example from it, by a whole number of pixels for one"))
    }

    /// Reads an image. The caller must check it for NaN and infinite values.
    fn load(&self, path: &Path, kind: Kind) -> Result<Loaded> {
        input::map_with_faults(path, kind, self.region, self.alpha.alpha, &self.read)
    }
}

/// Converts an image to the lightness of its pixels, as sRGB codes from 0 to 1. Gray images are unchanged.
pub(super) fn gray(image: &Loaded) -> Result<Raster<f32>> {
    match &image.map {
        Map::Value(values) => Ok(values.clone()),
        Map::Color(colors) => Ok(colors.map(lightness)),
        Map::Normal(_) => bail!("normals are not light or dark"),
    }
}

/// Returns the lightness of a color, which is the sRGB code, from 0 to 1, of the gray with the same luminance.
pub(super) fn lightness(color: &LinearRgb) -> f32 {
    let [code, ..] = LinearRgb::gray(color.luminance()).to_srgb::<u16>();
    f32::from(code) / f32::from(u16::MAX)
}

/// Places images side by side. If some are gray and others in color, all are converted to colors. A single image is
/// unchanged.
pub(super) fn joined(layout: &SideBySide, mut images: Vec<Loaded>) -> Result<Loaded> {
    if layout.size() == layout.size_of(0) {
        return Ok(images.remove(0));
    }
    let is_deep = images.iter().any(|image| image.is_deep);
    if images.iter().any(|image| image.is_associated) {
        images.iter_mut().try_for_each(Loaded::associate)?;
    }
    let is_associated = images.iter().any(|image| image.is_associated);
    let map = if let Some(values) = all(&images, |map| match map {
        Map::Value(values) => Some(values),
        _ => None,
    }) {
        Map::Value(layout.join(&values, 0.0)?)
    } else if let Some(normals) = all(&images, |map| match map {
        Map::Normal(normals) => Some(normals),
        _ => None,
    }) {
        Map::Normal(layout.join_normals(&normals)?)
    } else {
        let colors = images.iter().map(|image| match &image.map {
            Map::Value(values) => values.map(|&value| image.color_of(value)),
            Map::Color(colors) => colors.clone(),
            Map::Normal(normals) => normals.map(|_| LinearRgb::default()),
        });
        let colors: Vec<_> = colors.collect();
        let colors: Vec<_> = colors.iter().collect();
        Map::Color(layout.join(&colors, LinearRgb::default())?)
    };
    let alpha = if images.iter().any(|image| image.alpha.is_some()) {
        let opaque = |image: &Loaded| Raster::filled(image.map.size(), 1.0);
        let alphas = images.iter().map(|image| match &image.alpha {
            Some(alpha) => Ok(alpha.clone()),
            None => opaque(image),
        });
        let alphas: Vec<_> = alphas.collect::<Result<_, _>>()?;
        let alphas: Vec<_> = alphas.iter().collect();
        Some(layout.join(&alphas, 1.0)?)
    } else {
        None
    };
    let mut joined = images.swap_remove(0);
    joined.map = map;
    joined.alpha = alpha;
    joined.is_deep = is_deep;
    joined.is_associated = is_associated;
    Ok(joined)
}

/// Returns the rasters that `part` selects, if it selects one in every image; otherwise `None`.
fn all<'a, T>(images: &'a [Loaded], part: impl Fn(&'a Map) -> Option<&'a T>) -> Option<Vec<&'a T>> {
    images.iter().map(|image| part(&image.map)).collect()
}
