//! Selects the images that are baked from a recipe.

use super::Args;
use super::presets::{Document, Preset, PresetImage};
use crate::encode::Format;
use crate::error::{Hint, usage};
use crate::layers::Layers;
use anyhow::Result;
use dapple::color::NormalY;
use dapple::recipe::{MapKind, Material, Samples};
use std::path::Path;

impl Args {
    /// Returns the preset, as given by `--preset` or by the extension of the output.
    pub(super) fn preset(&self) -> Option<&'static Preset> {
        let ending = self.files.output.as_deref().and_then(Path::extension);
        let ending = ending.unwrap_or_default().to_string_lossy().to_lowercase();
        let preset = self.preset.first().copied();
        preset.or_else(|| Preset::of_ending(&ending))
    }

    /// Returns the document of the material, if the preset has one. A Godot material is left out if it cannot reference
    /// the images: frames, regions, corner samples, or normals whose green points down.
    pub(super) fn document(&self) -> Option<Document> {
        let document = self.preset()?.document?;
        self.left_out().is_none().then_some(document)
    }

    /// Returns the option for which the Godot material of the preset is left out; `None` if it is not.
    pub(super) fn left_out(&self) -> Option<&'static str> {
        let document = self.preset.first()?.document?;
        self.in_the_way(document)
            .filter(|_| document == Document::Tres)
    }

    /// Returns whether the document embeds the images, so that they have no separate files.
    pub(super) fn has_images_in_it(&self) -> bool {
        self.document() == Some(Document::Glb)
    }

    /// Refuses options that have no effect on a document.
    ///
    /// # Errors
    ///
    /// If such an option is given.
    pub(super) fn check_document(&self) -> Result<()> {
        let Some(document) = self.document() else {
            return Ok(());
        };
        let ending = document.ending();
        match self.in_the_way(document) {
            None => Ok(()),
            Some(option) => Err(usage(format!(
                "a .{ending} is a whole material, without {option}"
            ))
            .hint("leave it out, or write images with --preset gltf or blender")),
        }
    }

    /// Returns the first given option that has no effect on a document.
    fn in_the_way(&self, document: Document) -> Option<&'static str> {
        let is_by_ending = self.preset.is_empty();
        let in_the_way = [
            ("--maps", self.material.maps.is_some()),
            ("--format", self.format.is_some()),
            ("--region", self.region.is_some()),
            ("--shard", self.shard.is_some()),
            ("--frames", self.frames.is_some()),
            ("--flipbook", self.flipbook.is_some()),
            (
                "--sheet",
                self.sheet && (document != Document::Tres || is_by_ending),
            ),
            (
                "--samples corners",
                self.material.samples.samples == Samples::Corners,
            ),
            (
                "--normal-y directx",
                self.material.normal_y == Some(NormalY::DirectX),
            ),
        ];
        let mut in_the_way = in_the_way.into_iter();
        in_the_way.find_map(|(option, is_there)| is_there.then_some(option))
    }

    /// Returns the images to bake for a material. Each comes with its part of the file name (`NAME_PART`), its
    /// channels, and its format if one was chosen. A preset's images of maps that the material lacks are left out.
    pub(super) fn images(
        &self,
        material: &Material,
    ) -> Vec<(&'static str, Layers, Option<Format>)> {
        if let Some(preset) = self.preset() {
            let images = preset.images.iter();
            let of_preset = |PresetImage { part, image }: &PresetImage| {
                Some((*part, image.layers.of(material)?, Some(image.format)))
            };
            return images.filter_map(of_preset).collect();
        }
        let of_map = |kind: MapKind| (kind.name(), Layers::Map(kind), self.format);
        let kinds = self.material.map_kinds(material).into_iter();
        kinds.map(of_map).collect()
    }
}
