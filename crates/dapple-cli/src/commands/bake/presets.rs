//! Presets for other programs, with the images that they import, the maps in their channels, and their formats.
//!
//! References: the documentation of each program, cited at its entry in [`PRESETS`].

use crate::encode::Format;
use crate::layers::{Channel, Image, Layers};
use crate::words::NamedValueParser;
use dapple::color::NormalY;
use dapple::recipe::{MapKind, Material};
use serde::{Serialize, Serializer};
use std::fmt::Write as _;

/// A preset: the images of a material, in the form in which a program imports them.
#[derive(Debug, PartialEq)]
pub(super) struct Preset {
    pub(super) name: &'static str,
    /// The help text.
    about: &'static str,
    /// The prefix of file names in a directory.
    pub(super) prefix: &'static str,
    pub(super) normal_y: NormalY,
    pub(super) images: &'static [PresetImage],
    pub(super) document: Option<Document>,
    /// Whether each image gets a file with Unity's import settings.
    pub(super) has_metas: bool,
}

/// An image of a preset.
#[derive(Debug, PartialEq)]
pub(super) struct PresetImage {
    /// The part of the file name that follows the name of the material: `NAME_PART.png`.
    pub(super) part: &'static str,
    pub(super) image: Image,
}

/// A file that combines the images into a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Document {
    /// A plane in glTF 2.0, with embedded images.
    Glb,
    /// A MaterialX document that references image files.
    Mtlx,
    /// A material of Godot that references image files.
    Tres,
}

impl Document {
    /// Returns the file extension.
    pub(super) fn ending(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Mtlx => "mtlx",
            Self::Tres => "tres",
        }
    }
}

/// Creates an image with 8 bits per channel. `part` is its part of the file name.
const fn eight(part: &'static str, layers: Layers) -> PresetImage {
    let format = Format::Png8;
    PresetImage {
        part,
        image: Image { layers, format },
    }
}

/// Creates an image with 16 bits per channel. `part` is its part of the file name.
const fn sixteen(part: &'static str, layers: Layers) -> PresetImage {
    let format = Format::Png16;
    PresetImage {
        part,
        image: Image { layers, format },
    }
}

/// Unity's mask map: metallic, occlusion, detail mask (1 everywhere) and smoothness.
const MASK: Layers = Layers::Rgba([
    Channel::Of(MapKind::Metallic),
    Channel::Of(MapKind::Occlusion),
    Channel::Always(1.0),
    Channel::OneLess(MapKind::Roughness),
]);

/// Unity's metallic map: metallic in red, green and blue, and smoothness in alpha.
const METALLIC_SMOOTHNESS: Layers = Layers::Rgba([
    Channel::Of(MapKind::Metallic),
    Channel::Of(MapKind::Metallic),
    Channel::Of(MapKind::Metallic),
    Channel::OneLess(MapKind::Roughness),
]);

/// Clear coat map for Unity: the clear coat in red, and 1 in the other channels, including the smoothness in green.
const COAT: Layers = Layers::Rgba([
    Channel::Of(MapKind::Clearcoat),
    Channel::Always(1.0),
    Channel::Always(1.0),
    Channel::Always(1.0),
]);

/// Specular texture of glTF, which has the strength in alpha.
const SPECULAR: Layers = Layers::Rgba([
    Channel::Always(1.0),
    Channel::Always(1.0),
    Channel::Always(1.0),
    Channel::Of(MapKind::Specular),
]);

/// Specular level as in Unreal and in Blender's Principled BSDF, where 0.5 is an index of refraction of 1.5.
const HALF_SPECULAR: Layers = Layers::Gray(Channel::Half(MapKind::Specular));

/// The images of glTF, as separate files or embedded in a document.
const GLTF: &[PresetImage] = &[
    eight("baseColor", Layers::AlbedoOpacity),
    eight("occlusionRoughnessMetallic", Layers::Map(MapKind::Orm)),
    eight("normal", Layers::Map(MapKind::Normal)),
    eight("emissive", Layers::Map(MapKind::Emission)),
    eight("specular", SPECULAR),
    eight("clearcoat", Layers::Map(MapKind::Clearcoat)),
];

/// The default values of a preset: no images, no prefix, no document, and green pointing up in normal maps.
const PLAIN: Preset = Preset {
    name: "",
    about: "",
    prefix: "",
    normal_y: NormalY::OpenGl,
    images: &[],
    document: None,
    has_metas: false,
};

/// All presets, in the order of the help.
pub(super) static PRESETS: [Preset; 7] = [
    // Unity Manual, "Assign a channel-packed texture to a URP material" and "Lit Shader"; High Definition RP, "Mask and
    // detail maps". The built-in pipeline and URP read smoothness from the alpha of the metallic map.
    Preset {
        name: "unity",
        about: "Unity: the mask map of HDRP and URP, metallic with smoothness of the built-in pipeline, and import settings",
        images: &[
            eight("BaseMap", Layers::AlbedoOpacity),
            eight("Normal", Layers::Map(MapKind::Normal)),
            eight("MaskMap", MASK),
            eight("MetallicSmoothness", METALLIC_SMOOTHNESS),
            eight("Occlusion", Layers::Map(MapKind::Occlusion)),
            sixteen("Height", Layers::Map(MapKind::Height)),
            eight("Emission", Layers::Map(MapKind::Emission)),
            eight("ClearCoat", COAT),
        ],
        has_metas: true,
        ..PLAIN
    },
    // Unreal Engine documentation, "Normal Maps" (green points down), "Recommended Asset Naming Conventions" (`T_`).
    Preset {
        name: "unreal",
        about: "Unreal Engine: occlusion, roughness and metallic in one, green of normals down",
        prefix: "T_",
        normal_y: NormalY::DirectX,
        images: &[
            eight("BaseColor", Layers::Map(MapKind::Albedo)),
            eight("Normal", Layers::Map(MapKind::Normal)),
            eight("ORM", Layers::Map(MapKind::Orm)),
            sixteen("Height", Layers::Map(MapKind::Height)),
            eight("Emissive", Layers::Map(MapKind::Emission)),
            eight("Opacity", Layers::Map(MapKind::Opacity)),
            eight("Specular", HALF_SPECULAR),
            eight("ClearCoat", Layers::Map(MapKind::Clearcoat)),
        ],
        ..PLAIN
    },
    // Godot documentation, "Standard Material 3D and ORM Material 3D"; "Importing images" (OpenGL normals).
    Preset {
        name: "godot",
        about: "Godot: an ORMMaterial3D, NAME.tres, and its images; also -o NAME.tres",
        images: &[
            eight("albedo", Layers::AlbedoOpacity),
            eight("normal", Layers::Map(MapKind::Normal)),
            eight("orm", Layers::Map(MapKind::Orm)),
            sixteen("height", Layers::Map(MapKind::Height)),
            eight("emission", Layers::Map(MapKind::Emission)),
            eight("clearcoat", COAT),
        ],
        document: Some(Document::Tres),
        ..PLAIN
    },
    // Khronos Group, "glTF 2.0 Specification", 3.9 "Materials".
    Preset {
        name: "gltf",
        about: "The textures of a glTF material",
        images: GLTF,
        ..PLAIN
    },
    // "glTF 2.0 Specification", 4.4 "Binary glTF".
    Preset {
        name: "glb",
        about: "A plane of glTF with these textures in one file; also -o NAME.glb",
        images: GLTF,
        document: Some(Document::Glb),
        ..PLAIN
    },
    // Blender Manual, "Principled BSDF", "Normal Map Node", and "Node Wrangler", whose Principled Texture Setup finds
    // images by these parts of their names.
    Preset {
        name: "blender",
        about: "Blender: an image for each input, by names that Node Wrangler finds",
        images: &[
            eight("basecolor", Layers::Map(MapKind::Albedo)),
            sixteen("roughness", Layers::Map(MapKind::Roughness)),
            sixteen("metallic", Layers::Map(MapKind::Metallic)),
            sixteen("normal", Layers::Map(MapKind::Normal)),
            sixteen("height", Layers::Map(MapKind::Height)),
            sixteen("ao", Layers::Map(MapKind::Occlusion)),
            eight("emission", Layers::Map(MapKind::Emission)),
            sixteen("alpha", Layers::Map(MapKind::Opacity)),
            sixteen("specular", HALF_SPECULAR),
            sixteen("clearcoat", Layers::Map(MapKind::Clearcoat)),
        ],
        ..PLAIN
    },
    // "MaterialX Specification" and "MaterialX Standard Nodes", 1.38: `standard_surface`, `normalmap`, `displacement`.
    Preset {
        name: "materialx",
        about: "A MaterialX standard_surface, NAME.mtlx, and its images; also -o NAME.mtlx",
        images: &[
            eight("basecolor", Layers::Map(MapKind::Albedo)),
            sixteen("roughness", Layers::Map(MapKind::Roughness)),
            sixteen("metallic", Layers::Map(MapKind::Metallic)),
            sixteen("normal", Layers::Map(MapKind::Normal)),
            sixteen("height", Layers::Map(MapKind::Height)),
            eight("emission", Layers::Map(MapKind::Emission)),
            sixteen("opacity", Layers::Map(MapKind::Opacity)),
            sixteen("specular", Layers::Map(MapKind::Specular)),
            sixteen("clearcoat", Layers::Map(MapKind::Clearcoat)),
        ],
        document: Some(Document::Mtlx),
        ..PLAIN
    },
];

impl Preset {
    /// Returns the description of the preset, one sentence.
    #[cfg(feature = "studio")]
    pub(super) fn about(&self) -> &'static str {
        self.about
    }

    /// Creates a parser that recognizes presets by their names.
    pub(super) fn parser() -> NamedValueParser<&'static Self> {
        let presets = PRESETS.iter();
        presets.fold(NamedValueParser::none(), |words, preset| {
            words.or(preset.name, preset.about, preset)
        })
    }

    /// Returns a note that lists the images that must be imported without sRGB decoding. `None` if the preset writes
    /// import settings, or if the material has no such image.
    pub(super) fn import_note(&self, material: &Material) -> Option<String> {
        if self.has_metas {
            return None;
        }
        let layers = |image: &PresetImage| image.image.layers.of(material);
        let data = self
            .images
            .iter()
            .filter(|image| layers(image).is_some_and(|layers| !layers.is_color()));
        let parts: Vec<_> = data.map(|image| image.part).collect();
        let names = parts.join(", ");
        (!parts.is_empty()).then(|| format!("note: {names} are data: import them without sRGB"))
    }

    /// Returns the preset of a document with this file extension.
    pub(super) fn of_ending(ending: &str) -> Option<&'static Self> {
        let writes = |document: Document| document.ending() == ending;
        PRESETS
            .iter()
            .find(|preset| preset.document.is_some_and(writes))
    }
}

impl Serialize for &'static Preset {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.name.serialize(serializer)
    }
}

/// Returns a table of the images of all presets, for the help text.
pub(super) fn table() -> String {
    let mut text = "Presets (see --preset), with * at images that only some materials have. Images that are not \"in sRGB\" are data: \
        they are imported as linear, without sRGB.\n"
        .to_owned();
    let plain = Material::default();
    for preset in &PRESETS {
        let green = match preset.normal_y {
            NormalY::OpenGl => "up",
            NormalY::DirectX => "down",
        };
        let _ = writeln!(text, "  {}, green of normals {green}", preset.name);
        for PresetImage { part, image } in preset.images {
            let file = match preset.document {
                Some(Document::Glb) => (*part).to_owned(),
                _ => format!("{}NAME_{part}.png", preset.prefix),
            };
            let (_, depth) = image.format.depth();
            let star = match image.layers.of(&plain) {
                Some(_) => "",
                None => " *",
            };
            let _ = writeln!(text, "    {file}: {}, {depth}{star}", image.layers);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{Document, PRESETS, Preset, table};

    #[test]
    fn presets_have_names_and_parts_of_their_own() {
        for (index, preset) in PRESETS.iter().enumerate() {
            let others = &PRESETS[index + 1..];
            assert!(
                others.iter().all(|other| other.name != preset.name),
                "{}",
                preset.name
            );
            for (index, image) in preset.images.iter().enumerate() {
                let others = &preset.images[index + 1..];
                assert!(
                    others.iter().all(|other| other.part != image.part),
                    "{}",
                    image.part
                );
            }
        }
        let of_ending = |ending| Preset::of_ending(ending).and_then(|preset| preset.document);
        assert_eq!(of_ending("glb"), Some(Document::Glb));
        assert_eq!(of_ending("mtlx"), Some(Document::Mtlx));
        assert_eq!(of_ending("tres"), Some(Document::Tres));
        assert_eq!(of_ending("png"), None);
    }

    #[test]
    fn the_readme_has_the_table_of_presets() {
        let readme = include_str!("../../../README.md");
        assert!(readme.contains(&table()), "it should hold:\n{}", table());
    }
}
