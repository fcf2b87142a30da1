//! Builds documents for a whole material: a textured plane in glTF, a MaterialX document, or a material of Godot.
//!
//! References: Godot Engine documentation, "TSCN file format" and "`BaseMaterial3D`", version 4; The Khronos Group, *glTF 2.0 Specification*, 2021 (ISO/IEC 12113:2022); Smythe, Stone et al., *MaterialX
//! Specification* and *MaterialX Standard Nodes*, version 1.38, 2021. One unit of the plane is one meter in both.

use crate::layers::Layers;
use anyhow::Result;
use dapple::mesh::{AlphaMode, EncodedImage, Material, Mesh, Model};
use dapple::mesh_io::gltf;
use dapple::points::glam::{DVec2, DVec3};
use dapple::recipe::{MapKind, Recipe};

/// The default roughness of a clear coat.
const CLEARCOAT_ROUGHNESS: f64 = 0.03;

/// Builds a GLB file of a horizontal rectangle with the extent of the tile. It faces up (+y), and v points toward +z.
/// `images` are the images of the preset.
pub(super) fn glb(
    recipe: &Recipe,
    images: impl Iterator<Item = (Layers, Vec<u8>)>,
) -> Result<Vec<u8>> {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(DVec2::from);
    let extent = DVec2::from(recipe.extent);
    let position = |uv: DVec2| {
        let at = (uv - 0.5) * extent;
        DVec3::new(at.x, 0.0, at.y)
    };
    let faces = [[0, 2, 1], [1, 2, 3]];
    let mut model = Model::from(Mesh::new(corners.map(position).to_vec(), &faces)?);
    model.uvs = Some(
        faces
            .map(|face| face.map(|corner| corners[corner as usize]))
            .to_vec(),
    );
    let numbers = &recipe.material;
    model.material = Material {
        emission_strength: numbers.emission_strength.unwrap_or(1.0) as f32,
        clearcoat_roughness: numbers.clearcoat_roughness.unwrap_or(CLEARCOAT_ROUGHNESS) as f32,
        alpha: match (numbers.has(MapKind::Opacity), numbers.opacity_cutoff) {
            (false, _) => AlphaMode::Opaque,
            (true, None) => AlphaMode::Blend,
            (true, Some(_)) => AlphaMode::Mask,
        },
        alpha_cutoff: numbers.opacity_cutoff.unwrap_or(0.5) as f32,
        ..Material::default()
    };
    let material = &mut model.material;
    for (layers, bytes) in images {
        let image = Some(EncodedImage::new(bytes)?);
        let kinds = layers.kinds();
        match kinds.as_slice() {
            [MapKind::Albedo, ..] => material.base_color = image,
            [MapKind::Normal] => material.normal = image,
            [MapKind::Orm] => {
                material.occlusion.clone_from(&image);
                material.metallic_roughness = image;
            }
            [MapKind::Emission] => material.emission = image,
            [MapKind::Specular] => material.specular = image,
            [MapKind::Clearcoat] => material.clearcoat = image,
            _ => {}
        }
    }
    Ok(gltf::write(&model)?)
}

/// Connection of a map to an input of the surface shader in MaterialX.
struct Wire {
    kind: MapKind,
    /// The name of the image node.
    name: &'static str,
    /// MaterialX type of the image node and of the input, such as `color3`.
    type_name: &'static str,
    color_space: &'static str,
    /// The input of the surface; `None` for the height, which is connected to the displacement.
    input: Option<&'static str>,
}

const fn wire(
    kind: MapKind,
    name: &'static str,
    type_name: &'static str,
    input: Option<&'static str>,
) -> Wire {
    let color_space = match kind {
        MapKind::Albedo | MapKind::Emission => "srgb_texture",
        _ => "raw",
    };
    Wire {
        kind,
        name,
        type_name,
        color_space,
        input,
    }
}

const WIRES: [Wire; 9] = [
    wire(MapKind::Albedo, "base_color", "color3", Some("base_color")),
    wire(
        MapKind::Roughness,
        "roughness",
        "float",
        Some("specular_roughness"),
    ),
    wire(MapKind::Metallic, "metallic", "float", Some("metalness")),
    wire(MapKind::Normal, "normal", "vector3", Some("normal")),
    wire(MapKind::Height, "height", "float", None),
    wire(
        MapKind::Emission,
        "emission",
        "color3",
        Some("emission_color"),
    ),
    wire(MapKind::Opacity, "opacity", "color3", Some("opacity")),
    wire(MapKind::Specular, "specular", "float", Some("specular")),
    wire(MapKind::Clearcoat, "clearcoat", "float", Some("coat")),
];

/// Builds a MaterialX document: a standard surface with an image for each map, referenced by file name, and a
/// displacement in meters unless the relief is 0.
pub(super) fn mtlx(recipe: &Recipe, files: &[(Layers, String)]) -> String {
    let relief = recipe.material.relief;
    let mut graph = String::new();
    let mut outputs = String::new();
    let mut inputs = String::new();
    for (layers, file) in files {
        let is_of = |wire: &&Wire| *layers == Layers::Map(wire.kind);
        let Some(wire) = WIRES.iter().find(is_of) else {
            continue;
        };
        graph += &image_node(wire, file, recipe.material.opacity_cutoff);
        let Wire {
            name, type_name, ..
        } = wire;
        outputs += &format!(
            "    <output name=\"{name}_output\" type=\"{type_name}\" nodename=\"{name}\" />\n"
        );
        inputs += &constants(wire.kind, recipe);
        if let Some(input) = wire.input {
            inputs += &format!(
                "    <input name=\"{input}\" type=\"{type_name}\" nodegraph=\"maps\" output=\"{name}_output\" />\n"
            );
        }
    }
    let (displacement, shader) = match relief == 0.0 {
        true => (String::new(), ""),
        false => (displacement(relief), DISPLACEMENT_INPUT),
    };
    let name = identifier(&recipe.name);
    format!(
        r#"<?xml version="1.0"?>
<materialx version="1.38" colorspace="lin_rec709">
  <nodegraph name="maps">
{graph}{outputs}  </nodegraph>
  <standard_surface name="surface" type="surfaceshader">
    <input name="base" type="float" value="1" />
{inputs}  </standard_surface>
{displacement}  <surfacematerial name="material_{name}" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="surface" />
{shader}  </surfacematerial>
</materialx>
"#
    )
}

/// XML of the material's displacement input.
const DISPLACEMENT_INPUT: &str = "    <input name=\"displacementshader\" type=\"displacementshader\" nodename=\"displacement\" />\n";

/// Returns the XML of the surface's constant inputs that accompany a map, such as the strength of the emission.
fn constants(kind: MapKind, recipe: &Recipe) -> String {
    let material = &recipe.material;
    let (name, value) = match kind {
        MapKind::Emission => ("emission", material.emission_strength.unwrap_or(1.0)),
        MapKind::Clearcoat => {
            let roughness = material.clearcoat_roughness;
            ("coat_roughness", roughness.unwrap_or(CLEARCOAT_ROUGHNESS))
        }
        _ => return String::new(),
    };
    format!("    <input name=\"{name}\" type=\"float\" value=\"{value}\" />\n")
}

/// Returns the XML of a map's image node. Normals include the node that decodes them. The opacity includes a conversion
/// to a color, since the input of the surface is a color, and a comparison with the cutoff if there is one.
fn image_node(wire: &Wire, file: &str, cutoff: Option<f64>) -> String {
    let Wire {
        name,
        type_name,
        color_space,
        ..
    } = wire;
    let (is_normal, is_opacity) = (wire.kind == MapKind::Normal, wire.kind == MapKind::Opacity);
    let image = match is_normal || is_opacity {
        true => &format!("{name}_image"),
        false => *name,
    };
    let type_name = if is_opacity { "float" } else { type_name };
    let file = escaped(file);
    let mut text = format!(
        r#"    <image name="{image}" type="{type_name}">
      <input name="file" type="filename" value="{file}" colorspace="{color_space}" />
      <input name="uaddressmode" type="string" value="periodic" />
      <input name="vaddressmode" type="string" value="periodic" />
    </image>
"#
    );
    if is_normal {
        text += &format!(
            r#"    <normalmap name="{name}" type="vector3">
      <input name="in" type="vector3" nodename="{image}" />
    </normalmap>
"#
        );
    }
    if is_opacity {
        let mut opacity = image.to_owned();
        if let Some(cutoff) = cutoff {
            opacity = "opacity_mask".to_owned();
            text += &format!(
                r#"    <ifgreatereq name="{opacity}" type="float">
      <input name="value1" type="float" nodename="{image}" />
      <input name="value2" type="float" value="{cutoff}" />
      <input name="in1" type="float" value="1" />
      <input name="in2" type="float" value="0" />
    </ifgreatereq>
"#
            );
        }
        text += &format!(
            r#"    <convert name="{name}" type="color3">
      <input name="in" type="float" nodename="{opacity}" />
    </convert>
"#
        );
    }
    text
}

/// Returns the XML of the displacement node. `relief` is the displacement of a height of 1, in meters.
fn displacement(relief: f64) -> String {
    format!(
        r#"  <displacement name="displacement" type="displacementshader">
    <input name="displacement" type="float" nodegraph="maps" output="height_output" />
    <input name="scale" type="float" value="{relief}" unittype="distance" unit="meter" />
  </displacement>
"#
    )
}

/// Makes a name valid in MaterialX, by replacing characters other than ASCII letters and digits with `_`.
fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    name.chars().map(plain).collect()
}

/// Escapes a text for use as the value of an XML attribute.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('"', "&quot;")
}

/// Builds a material of Godot 4, an `ORMMaterial3D`, with an image for each map, referenced by file name.
///
/// The height is set, and parallax is left off, since it costs time in each frame: `heightmap_enabled` turns it on.
pub(super) fn tres(recipe: &Recipe, files: &[(Layers, String)]) -> String {
    let material = &recipe.material;
    let mut resources = String::new();
    let mut lines = vec![
        format!("resource_name = \"{}\"", quoted(&recipe.name)),
        format!("texture_repeat = {}", recipe.wrap == [true; 2]),
        "metallic = 1.0".to_owned(),
        "roughness = 1.0".to_owned(),
    ];
    if material.has(MapKind::Opacity) {
        match material.opacity_cutoff {
            None => lines.push("transparency = 1".to_owned()),
            Some(cutoff) => {
                lines.push("transparency = 2".to_owned());
                lines.push(format!("alpha_scissor_threshold = {cutoff:?}"));
            }
        }
    }
    for (id, (layers, file)) in (1..).zip(files) {
        let (texture, more) = match layers.kinds().as_slice() {
            [MapKind::Albedo, ..] => ("albedo", vec![]),
            [MapKind::Normal] => (
                "normal",
                vec![
                    "normal_enabled = true".to_owned(),
                    "normal_scale = 1.0".to_owned(),
                ],
            ),
            [MapKind::Orm] => ("orm", vec!["ao_enabled = true".to_owned()]),
            // Godot moves the coordinates by a hundredth of the scale where the height is 1.
            [MapKind::Height] => {
                let scale = 100.0 * material.relief / recipe.extent[0];
                ("heightmap", vec![format!("heightmap_scale = {scale:?}")])
            }
            [MapKind::Emission] => {
                let strength = material.emission_strength.unwrap_or(1.0);
                let enabled = "emission_enabled = true".to_owned();
                let strength = format!("emission_energy_multiplier = {strength:?}");
                ("emission", vec![enabled, strength])
            }
            [MapKind::Clearcoat] => {
                let roughness = material.clearcoat_roughness.unwrap_or(CLEARCOAT_ROUGHNESS);
                let enabled = "clearcoat_enabled = true".to_owned();
                let roughness = format!("clearcoat_roughness = {roughness:?}");
                let full = "clearcoat = 1.0".to_owned();
                ("clearcoat", vec![enabled, full, roughness])
            }
            _ => continue,
        };
        let file = quoted(file);
        resources += &format!("[ext_resource type=\"Texture2D\" path=\"{file}\" id=\"{id}\"]\n");
        lines.extend(more);
        lines.push(format!("{texture}_texture = ExtResource(\"{id}\")"));
    }
    let steps = resources.lines().count() + 1;
    let lines = lines.join("\n");
    format!(
        "[gd_resource type=\"ORMMaterial3D\" load_steps={steps} format=3]\n\n{resources}\n[resource]\n{lines}\n"
    )
}

/// Escapes a text for use in quotes in a resource of Godot.
fn quoted(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"")
}
