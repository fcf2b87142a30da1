//! The content of a mesh file: a mesh, its vertex and corner attributes, and a material with encoded textures.
//!
//! Colors are in linear light. The v axis of texture coordinates points down: (0, 0) is the top left corner of the
//! first row of the texture, as in glTF. Readers and writers of formats whose v axis points up flip it.

use crate::mesh::POSITION_MAX;
use crate::{Mesh, MeshError, MeshErrorKind};
use dapple_color::{LinearRgb, LinearRgba};
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;

/// Tolerance for rounding errors by which a corner may be outside of its face's unit square, in texture coordinates.
const UV_SLACK: f64 = 1e-4;
/// Signature of PNG files.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Signature of JPEG files.
const JPEG: &[u8] = b"\xff\xd8\xff";

/// A mesh with all the appearance attributes that a file contains.
///
/// The fields may be changed freely; [`check`](Self::check) verifies that they are consistent, and every writer calls
/// it.
///
/// # Examples
///
/// ```
/// use dapple_mesh::{Mesh, Model, glam::{DVec2, DVec3}};
///
/// let mesh = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// let mut model = Model::from(mesh);
/// model.uvs = Some(vec![[DVec2::Y, DVec2::ONE, DVec2::ZERO]]);
/// assert!(model.check().is_ok());
/// # Ok::<(), dapple_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Triangles. A mesh without faces is a point cloud, which may have normals and colors.
    pub mesh: Mesh,
    /// Linear color of each vertex; `None` if the model has no vertex colors.
    pub colors: Option<Vec<LinearRgba>>,
    /// Texture coordinates of each corner of each face, with v pointing down; the range 0 to 1 covers the texture
    /// once. `None` if the model has no texture coordinates.
    pub uvs: Option<Vec<[DVec2; 3]>>,
    /// Normal of each vertex, zero if undefined; `None` if the model has no vertex normals.
    pub normals: Option<Vec<DVec3>>,
    /// Normal of each corner of each face. Corners of a vertex may differ at a crease. Corner normals take precedence
    /// over vertex normals.
    pub corner_normals: Option<Vec<[DVec3; 3]>>,
    /// Material of all faces. If `tiles` is not empty, the material of the first unit square.
    pub material: Material,
    /// Materials of unit squares of texture coordinates, if each square has separate textures (UDIM), ordered by
    /// number. Empty if all faces share one texture.
    pub tiles: Vec<TileMaterial>,
    /// Descriptions of parts of a file that a reader skipped, because the file is contradictory or a model cannot
    /// represent them. Writers ignore this field.
    pub left_out: Vec<String>,
}

/// Material of the faces in a unit square of texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct TileMaterial {
    /// UDIM number of the square, as in [`Model::unit_squares`].
    pub number: u32,
    /// Material whose textures cover the square.
    pub material: Material,
}

/// Appearance of a surface: the metallic-roughness material of glTF 2.0.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Factor multiplied with the base color, linear [default: white].
    pub base_color_factor: LinearRgba,
    /// Base color texture, encoded as sRGB; `None` for a plain color.
    pub base_color: Option<EncodedImage>,
    /// Normal map in the tangent frame of the texture coordinates, with green pointing up.
    pub normal: Option<EncodedImage>,
    /// Texture with roughness in green and metalness in blue.
    pub metallic_roughness: Option<EncodedImage>,
    /// Texture with ambient occlusion in red. It may be the metallic-roughness image, which then packs all three.
    pub occlusion: Option<EncodedImage>,
    /// Texture of the emitted light, encoded as sRGB.
    pub emission: Option<EncodedImage>,
    /// Multiplier of the emission texture [default: 1].
    pub emission_strength: f32,
    /// Texture with the strength of the specular reflection of nonmetals in alpha.
    pub specular: Option<EncodedImage>,
    /// Texture with the strength of a clear coat in red.
    pub clearcoat: Option<EncodedImage>,
    /// Roughness of the clear coat, from 0 to 1 [default: 0].
    pub clearcoat_roughness: f32,
    /// How the base color's alpha is interpreted.
    pub alpha: AlphaMode,
    /// Lowest alpha that is opaque in [`AlphaMode::Mask`], from 0 to 1 [default: ½].
    pub alpha_cutoff: f32,
    /// Whether textures may use coarser mipmap levels [default: true]. Where islands of an atlas are close together,
    /// coarse levels mix islands that are far apart on the mesh.
    pub mipmaps: bool,
    /// Whether faces are visible from the back as well [default: false].
    pub double_sided: bool,
}

/// How alpha is interpreted. Alpha is the base color texture's alpha times the alpha of the base color factor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum AlphaMode {
    /// Alpha is ignored and the surface is opaque. If the base color factor is not opaque, the surface blends.
    #[default]
    Opaque,
    /// Alpha of at least [`Material::alpha_cutoff`] is opaque, and lower alpha is fully transparent.
    Mask,
    /// Alpha blends the surface with the background.
    Blend,
}

/// The bytes of an image file, not decoded; only the signature is inspected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EncodedImage {
    format: ImageFormat,
    bytes: Vec<u8>,
}

/// Format of an [`EncodedImage`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImageFormat {
    /// PNG.
    Png,
    /// JPEG.
    Jpeg,
}

impl Model {
    /// The [`left_out`](Self::left_out) entry for a file whose faces use several materials; a model keeps only the
    /// first.
    pub const FURTHER_MATERIALS: &str = "the materials of faces but the first";

    /// Returns the corner normals of all faces, derived from the vertex normals if necessary; `None` if the model has
    /// no normals.
    #[must_use]
    pub fn normals_of_corners(&self) -> Option<Vec<[DVec3; 3]>> {
        if self.corner_normals.is_some() {
            return self.corner_normals.clone();
        }
        let normals = self.normals.as_ref()?;
        let faces = self.mesh.faces().iter();
        Some(
            faces
                .map(|face| face.map(|vertex| normals[vertex.index()]))
                .collect(),
        )
    }

    /// Returns the UDIM numbers of the unit squares of texture coordinates that contain faces, in ascending order:
    /// 1001 + u + 10 v, with the integer parts of u and v, v up. Empty if a face spans several squares, as with
    /// repeating textures, or is beyond the ten columns of UDIM.
    #[must_use]
    pub fn unit_squares(&self) -> Vec<u32> {
        let mut squares = BTreeSet::new();
        for corners in self.uvs.iter().flatten() {
            // The mean of the corners is inside the square despite rounding.
            let mean = corners.iter().sum::<DVec2>() / 3.0;
            let square = DVec2::new(mean.x.floor(), (1.0 - mean.y).floor());
            let least = DVec2::new(square.x, -square.y);
            let is_inside = |uv: &DVec2| {
                let within =
                    (uv - least).clamp(DVec2::splat(-UV_SLACK), DVec2::splat(1.0 + UV_SLACK));
                within == uv - least
            };
            let is_tile = (0.0..10.0).contains(&square.x) && (0.0..900.0).contains(&square.y);
            if !is_tile || !corners.iter().all(is_inside) {
                return Vec::new();
            }
            squares.insert(1001 + square.x as u32 + 10 * square.y as u32);
        }
        squares.into_iter().collect()
    }

    /// Checks that each attribute is as long as the mesh requires, and contains only numbers that a file can
    /// represent.
    ///
    /// # Errors
    ///
    /// [`MeshErrorKind::Count`] if the length of an attribute does not match the mesh; [`MeshErrorKind::Range`] if a
    /// component of a color or a number of the material is not finite, or a component of a normal or texture coordinate
    /// is not between -1e30 and 1e30.
    pub fn check(&self) -> Result<(), MeshError> {
        let (vertices, faces) = (self.mesh.positions().len(), self.mesh.faces().len());
        if let Some(colors) = &self.colors {
            check_count("colors", colors.len(), vertices, "one for each vertex")?;
            for color in colors {
                check_color("part of a color", *color)?;
            }
        }
        if let Some(normals) = &self.normals {
            check_count("normals", normals.len(), vertices, "one for each vertex")?;
            for part in normals.iter().flat_map(DVec3::to_array) {
                check_part("part of a normal", part)?;
            }
        }
        if let Some(normals) = &self.corner_normals {
            check_count("faces with normals", normals.len(), faces, "all")?;
            for part in normals.iter().flatten().flat_map(DVec3::to_array) {
                check_part("part of a normal", part)?;
            }
        }
        if let Some(uvs) = &self.uvs {
            check_count("faces with texture coordinates", uvs.len(), faces, "all")?;
            for part in uvs.iter().flatten().flat_map(DVec2::to_array) {
                check_part("texture coordinate", part)?;
            }
        }
        let material = &self.material;
        for (what, number) in [
            ("emission strength", material.emission_strength),
            ("clear coat roughness", material.clearcoat_roughness),
            ("alpha cutoff", material.alpha_cutoff),
        ] {
            MeshError::check(number.is_finite(), what, f64::from(number), "finite")?;
        }
        check_color("base color factor", material.base_color_factor)
    }
}

impl From<Mesh> for Model {
    /// Creates a model that has a mesh but no attributes.
    fn from(mesh: Mesh) -> Self {
        Self {
            mesh,
            ..Self::default()
        }
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            base_color_factor: LinearRgba::opaque(LinearRgb::WHITE),
            base_color: None,
            normal: None,
            metallic_roughness: None,
            occlusion: None,
            emission: None,
            emission_strength: 1.0,
            specular: None,
            clearcoat: None,
            clearcoat_roughness: 0.0,
            alpha: AlphaMode::Opaque,
            alpha_cutoff: 0.5,
            mipmaps: true,
            double_sided: false,
        }
    }
}

impl EncodedImage {
    /// Wraps encoded bytes; their signature determines the format.
    ///
    /// # Errors
    ///
    /// [`MeshErrorKind::Image`] if the bytes have neither a PNG nor a JPEG signature.
    pub fn new(bytes: Vec<u8>) -> Result<Self, MeshError> {
        let format = if bytes.starts_with(PNG) {
            ImageFormat::Png
        } else if bytes.starts_with(JPEG) {
            ImageFormat::Jpeg
        } else {
            return Err(MeshError::new(MeshErrorKind::Image));
        };
        Ok(Self { format, bytes })
    }

    /// Returns the format of the image.
    #[must_use]
    pub fn format(&self) -> ImageFormat {
        self.format
    }

    /// Returns the encoded bytes, as stored in a file.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

impl ImageFormat {
    /// Returns the file extension of this format.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpg",
        }
    }

    /// Returns the media type: `image/png` or `image/jpeg`.
    #[must_use]
    pub fn media_type(self) -> &'static str {
        match self {
            Self::Png => "image/png",
            Self::Jpeg => "image/jpeg",
        }
    }
}

fn check_count(
    what: &'static str,
    count: usize,
    wanted: usize,
    needed: &'static str,
) -> Result<(), MeshError> {
    if count == wanted {
        return Ok(());
    }
    Err(MeshError::new(MeshErrorKind::Count {
        what,
        count,
        needed,
    }))
}

fn check_color(what: &'static str, color: LinearRgba) -> Result<(), MeshError> {
    let [r, g, b] = color.color.to_array();
    for part in [r, g, b, color.alpha] {
        MeshError::check(part.is_finite(), what, f64::from(part), "finite")?;
    }
    Ok(())
}

fn check_part(what: &'static str, part: f64) -> Result<(), MeshError> {
    MeshError::check(
        part.abs() <= POSITION_MAX,
        what,
        part,
        "between -1e30 and 1e30",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::tetrahedron;

    fn count(model: &Model) -> usize {
        match model.check().expect_err("it is refused").kind() {
            MeshErrorKind::Count { count, .. } => *count,
            kind => panic!("{kind:?}"),
        }
    }

    #[test]
    fn model_refuses_columns_of_another_length() {
        let plain = Model::from(tetrahedron());
        assert!(plain.check().is_ok(), "no columns");
        let (mut colors, mut uvs, mut normals) = (plain.clone(), plain.clone(), plain.clone());
        let mut corner_normals = plain;
        corner_normals.corner_normals = Some(vec![[DVec3::X; 3]; 2]);
        assert_eq!(count(&corner_normals), 2);
        colors.colors = Some(vec![LinearRgba::default(); 3]);
        uvs.uvs = Some(vec![[DVec2::ZERO; 3]; 5]);
        normals.normals = Some(vec![]);
        assert_eq!((count(&colors), count(&uvs), count(&normals)), (3, 5, 0));
    }

    #[test]
    fn model_refuses_numbers_that_are_not_finite() {
        let plain = Model::from(tetrahedron());
        for value in [f64::NAN, f64::INFINITY, -1.1e39] {
            let mut models = [(); 5].map(|()| plain.clone());
            models[4].corner_normals = Some(vec![[DVec3::new(value, 0.0, 0.0); 3]; 4]);
            let gray = LinearRgba::opaque(LinearRgb::gray(value as f32));
            models[0].colors = Some(vec![gray; 4]);
            models[1].uvs = Some(vec![[DVec2::new(0.0, value); 3]; 4]);
            models[2].normals = Some(vec![DVec3::new(0.0, 0.0, value); 4]);
            models[3].material.base_color_factor = gray;
            for model in models {
                let error = model.check().expect_err("it is refused");
                assert!(
                    matches!(error.kind(), MeshErrorKind::Range { .. }),
                    "{error}"
                );
            }
        }
    }

    #[test]
    fn unit_squares_have_the_numbers_of_udim() {
        let squares = |corners: [[f64; 2]; 4]| {
            let [a, b, c, d] = corners.map(DVec2::from_array);
            let model = Model {
                uvs: Some(vec![[a, b, c], [a, c, d]]),
                ..Model::default()
            };
            model.unit_squares()
        };
        let at = |u: f64, v: f64| [[u, v], [u + 1.0, v], [u + 1.0, v + 1.0], [u, v + 1.0]];
        // The v axis points down here: the square above the first is at -1.
        assert_eq!(squares(at(0.0, 0.0)), [1001]);
        assert_eq!(squares(at(1.0, 0.0)), [1002]);
        assert_eq!(squares(at(0.0, -1.0)), [1011]);
        assert_eq!(squares(at(9.0, -2.0)), [1030]);
        assert_eq!(squares(at(1.0 + 1e-6, 0.0)), [1002], "rounded");
        for far in [
            at(10.0, 0.0),
            at(-1.0, 0.0),
            at(0.0, 1.0),
            at(0.0, -1e6),
            at(0.5, 0.0),
        ] {
            assert!(squares(far).is_empty(), "{far:?}");
        }
        let wide = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]];
        assert!(squares(wide).is_empty(), "a texture that repeats");
        assert!(Model::default().unit_squares().is_empty());
        let mut two = Model::default();
        let face = |u: f64| [[u, 0.0], [u + 1.0, 0.0], [u, 1.0]].map(DVec2::from_array);
        two.uvs = Some(vec![face(1.0), face(0.0), face(1.0)]);
        assert_eq!(two.unit_squares(), [1001, 1002]);
    }

    #[test]
    fn encoded_image_knows_its_format_by_its_first_bytes() {
        let png = EncodedImage::new([PNG, b"rest"].concat()).expect("a beginning of PNG");
        let jpeg = EncodedImage::new([JPEG, b"rest"].concat()).expect("a beginning of JPEG");
        assert_eq!(
            (png.format(), jpeg.format()),
            (ImageFormat::Png, ImageFormat::Jpeg)
        );
        for bytes in [b"".as_slice(), b"\x89PNG", b"RIFF....WEBP"] {
            let error = EncodedImage::new(bytes.to_vec()).expect_err("neither");
            assert!(matches!(error.kind(), MeshErrorKind::Image), "{error}");
        }
    }
}
