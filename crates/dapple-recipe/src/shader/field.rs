//! Writes fields that are composed in Rust as shaders.

use super::writer::Writer;
use super::{Code, NodeShader, Refusal, literal, quotient};
use crate::nodes::{WorleyNode, fractal, noise, pups, wavelet};
use crate::{Images, Plan, Recipe, RecipeError, RecipeErrorKind};
use core::any::Any;
use dapple_noise::GradientNoise2;
use dapple_pups::{LabelTexture, NetField as _, Texture};
use dapple_raster::{Field, FieldParts, PairOperation};
use dapple_wavelet::WaveletNoise2;
use dapple_wgsl::double_value;
use dapple_worley::{CellValues, Cellular, EdgeDistances};

/// A field as a shader.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FieldShader {
    /// A module of WGSL without bindings and entry points. It contains all that it uses.
    pub wgsl: String,
    /// Words of the texture `data`, as in [`MaterialShader::data`](super::MaterialShader::data).
    pub data: Vec<u32>,
}

/// Generates a field as a function of WGSL, with the same bits as on the CPU:
///
/// ```wgsl
/// fn field(place: Place2d, zero: u32) -> f32
/// fn field64(at: Position2d, zero: u32) -> f32
/// ```
///
/// The arguments are those of [`Recipe::to_wgsl`]. Generators are gradient noise, Worley's basis without octaves,
/// wavelet noise and PUPs. Compositions by [`FieldExt`](dapple_raster::FieldExt) have a shader, except for
/// [`map`](dapple_raster::FieldExt::map) with a function, `slice` and `extrude`.
///
/// # Errors
///
/// [`NotInShader`](RecipeErrorKind::NotInShader) if a part of the field has no shader.
///
/// # Examples
///
/// ```
/// use dapple_noise::GradientNoise2;
/// use dapple_raster::{FieldExt, FractalShape};
/// use dapple_recipe::{field_to_wgsl, hash::Seed};
/// use dapple_worley::{Combination, Worley2};
///
/// let hills = GradientNoise2::new(Seed(7)).fractal(5, 0.5, 2.0, FractalShape::Sum)?;
/// let cracks = Worley2::new(Seed(3)).combine(Combination::F2_MINUS_F1);
/// let ground = (&hills).add(cracks.frequency(4.0).warp([&hills, &hills], 0.3)).max(0.0);
/// let shader = field_to_wgsl(&ground)?;
/// assert!(shader.wgsl.contains("fn field(place: Place2d, zero: u32) -> f32"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn field_to_wgsl(field: &dyn Field) -> Result<FieldShader, RecipeError> {
    let recipe = Recipe::from_toml("dapple = 1\nmaterial.height = 0.0")?;
    let images = Images::new();
    let plan = Plan::new(&recipe, &images, 0.0)?;
    let mut writer = Writer::new(&recipe, &images, &plan);
    let wgsl = writer.field(|shader| code(field, shader));
    let wgsl = wgsl.map_err(|refusal| {
        let nodes = vec![("field".to_owned(), refusal.into_reason())];
        RecipeError::new(RecipeErrorKind::NotInShader { nodes })
    })?;
    let data = writer.data();
    Ok(FieldShader { wgsl, data })
}

/// Writes a field at the shader's position.
fn code(field: &dyn Field, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
    let value = match field.parts() {
        FieldParts::Constant(value) if value.is_finite() => literal(value),
        FieldParts::Generator(generator) => return generator_code(generator, shader),
        FieldParts::Linear {
            field,
            from,
            length,
            to: [start, end],
        } => {
            let rise = end - start;
            if !rise.is_finite() {
                return Err(Refusal::new("the length of a range is infinite"));
            }
            let offset = format!(
                "number_sub({}, {}, zero)",
                number(field, shader)?,
                literal(from)
            );
            let part = quotient(&offset, length);
            let rise = format!("number_mul({}, {part}, zero)", literal(rise));
            format!("number_add({}, {rise}, zero)", literal(start))
        }
        FieldParts::Pair(first, second, operation) => {
            let function = match operation {
                PairOperation::Add => "add",
                PairOperation::Subtract => "sub",
                PairOperation::Multiply => "mul",
                PairOperation::Minimum => "min",
                PairOperation::Maximum => "max",
                _ => return Err(Refusal::new("this operation has no shader")),
            };
            let [a, b] = [number(first, shader)?, number(second, shader)?];
            format!("number_{function}({a}, {b}, zero)")
        }
        FieldParts::Mixed([from, to, by]) => {
            let [from, to, by] = [
                number(from, shader)?,
                number(to, shader)?,
                number(by, shader)?,
            ];
            format!("number_mix({from}, {to}, {by}, zero)")
        }
        FieldParts::Fractal(octaves, shape) => {
            fractal::sum_code(shader, shape, octaves, |shader, field, at| {
                shader.at(at, |shader| number(field, shader))
            })?
        }
        parts => return moved_code(parts, shader),
    };
    Ok(Code::number(value))
}

/// Writes a field at the shader's position, and names its value.
fn number(field: &dyn Field, shader: &mut NodeShader<'_, '_>) -> Result<String, Refusal> {
    let code = code(field, shader)?;
    Ok(shader.name("value", code.text))
}

/// Writes a field that is evaluated at other positions.
fn moved_code(parts: FieldParts<'_>, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
    let here = shader.position([1.0; 2]);
    let (field, at) = match parts {
        FieldParts::Scaled(field, frequency) => {
            let at = shader.position(frequency);
            return shader.at(at, |shader| code(field, shader));
        }
        FieldParts::Translated(field, offset) => {
            let [x, y] = offset.map(double_value);
            (field, format!("shifted_2d({here}, {x}, {y})"))
        }
        FieldParts::Rotated(field, direction) => {
            let [cos, sin] = direction.map(double_value);
            (field, format!("rotated_2d({here}, {cos}, {sin})"))
        }
        FieldParts::Warped(field, [x, y], amount) => {
            let shifts = [number(x, shader)?, number(y, shader)?];
            let amount = double_value(amount);
            let [x, y] = shifts.map(|shift| format!("double_mul({amount}, double_from({shift}))"));
            (field, format!("shifted_2d({here}, {x}, {y})"))
        }
        _ => return Err(Refusal::new("a field of this type has no shader")),
    };
    let at = shader.name("position", at);
    shader.at(at, |shader| code(field, shader))
}

/// Writes a generator at the shader's position.
fn generator_code(generator: &dyn Any, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
    if let Some(noise) = generator.downcast_ref::<GradientNoise2>() {
        let at = shader.position([1.0; 2]);
        return Ok(Code::number(noise::gradient_code(shader, noise, &at)?));
    }
    if let Some(noise) = generator.downcast_ref::<WaveletNoise2>() {
        return wavelet::noise_code(shader, noise, [1.0; 2]);
    }
    if let Some(texture) = generator.downcast_ref::<Texture>() {
        return pups::code(shader, &texture.shader_layers());
    }
    if let Some(texture) = generator.downcast_ref::<LabelTexture>() {
        return pups::code(shader, &texture.shader_layers());
    }
    // Positions are in cells.
    let cells = WorleyNode::default();
    if let Some(field) = generator.downcast_ref::<Cellular<2>>() {
        return cells.cellular_code(shader, field, 0.0);
    }
    if let Some(field) = generator.downcast_ref::<CellValues<2>>() {
        return cells.cell_value_code(shader, field.worley(), 0.0);
    }
    if let Some(field) = generator.downcast_ref::<EdgeDistances<2>>() {
        return cells.edge_distance_code(shader, field.worley());
    }
    Err(Refusal::new("a generator of this type has no shader"))
}
