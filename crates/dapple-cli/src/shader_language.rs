//! Shaders in other languages than WGSL, translated by `naga`.
//!
//! Godot's language is GLSL with fewer functions and stricter types; its shaders are written from GLSL.

use anyhow::Result;
use dapple::recipe::{MaterialShader, Recipe};

/// A language of shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ShaderLanguage {
    /// WGSL, for wgpu, Bevy and browsers.
    #[default]
    Wgsl,
    /// GLSL ES 3.10 without `main`, which is also valid in GLSL 4.50.
    #[cfg(feature = "shader-languages")]
    Glsl,
    /// HLSL of shader model 5.1, for Unity and Unreal Engine.
    #[cfg(feature = "shader-languages")]
    Hlsl,
    /// Godot's shading language, from version 4.4 on.
    #[cfg(feature = "shader-languages")]
    Godot,
}

impl ShaderLanguage {
    /// Returns the usual extension of files in this language.
    pub(crate) fn extension(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            #[cfg(feature = "shader-languages")]
            Self::Glsl => "glsl",
            #[cfg(feature = "shader-languages")]
            Self::Hlsl => "hlsl",
            #[cfg(feature = "shader-languages")]
            Self::Godot => "gdshader",
        }
    }

    /// Translates functions without bindings and entry points from WGSL to this language.
    ///
    /// # Errors
    ///
    /// If the text is not valid WGSL.
    pub(crate) fn translate(self, wgsl: String) -> Result<String> {
        match self {
            Self::Wgsl => Ok(wgsl),
            #[cfg(feature = "shader-languages")]
            Self::Glsl => translation::glsl(&wgsl),
            #[cfg(feature = "shader-languages")]
            Self::Hlsl => translation::hlsl(&wgsl),
            #[cfg(feature = "shader-languages")]
            Self::Godot => translation::godot(&wgsl),
        }
    }

    /// Translates the material of a recipe. For Godot, the result is an entire surface shader, whose texture
    /// coordinates from 0 to 1 cover the tile once.
    ///
    /// # Errors
    ///
    /// If the material reads textures, which a shader for Godot does not do.
    pub(crate) fn material(self, shader: MaterialShader, recipe: &Recipe) -> Result<String> {
        #[cfg(feature = "shader-languages")]
        if self == Self::Godot {
            return translation::godot_material(shader, recipe);
        }
        let _ = recipe;
        self.translate(shader.wgsl)
    }
}

#[cfg(feature = "shader-languages")]
mod translation {
    use crate::error::{Hint as _, usage};
    use anyhow::{Context as _, Result};
    use dapple::recipe::{MaterialShader, Recipe};
    use naga::back::{glsl, hlsl};
    use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

    /// An entry point, which the translation to GLSL requires, as WGSL and as the start of its GLSL. It is removed from
    /// the result.
    const ENTRY: [&str; 2] = [
        "\n@compute @workgroup_size(1) fn entry() {}\n",
        "void main() {",
    ];

    /// Prefixes of the lines of GLSL that only an entire shader needs, and that are removed: the version, precisions,
    /// and the workgroup size.
    const HEAD: [&str; 3] = ["#version ", "precision ", "layout(local_size_x"];

    pub(super) fn glsl(wgsl: &str) -> Result<String> {
        let (module, info) = parsed(&(wgsl.to_owned() + ENTRY[0]))?;
        let options = glsl::Options {
            version: glsl::Version::new_gles(310),
            ..glsl::Options::default()
        };
        let pipeline = glsl::PipelineOptions {
            shader_stage: naga::ShaderStage::Compute,
            entry_point: "entry".to_owned(),
            multiview: None,
        };
        let mut text = String::new();
        let bounds = naga::proc::BoundsCheckPolicies::default();
        glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, bounds)?.write()?;
        // Keep the functions: the entry point is the last one.
        let end = text.rfind(ENTRY[1]).unwrap_or(text.len());
        let is_part = |line: &&str| !HEAD.iter().any(|head| line.starts_with(head));
        let lines: Vec<_> = text[..end].lines().filter(is_part).collect();
        Ok(lines.join("\n").trim().to_owned() + "\n")
    }

    pub(super) fn hlsl(wgsl: &str) -> Result<String> {
        let (module, info) = parsed(wgsl)?;
        let options = hlsl::Options::default();
        let pipeline = hlsl::PipelineOptions::default();
        let mut text = String::new();
        hlsl::Writer::new(&mut text, &options, &pipeline).write(&module, &info, None)?;
        Ok(text)
    }

    /// Vector types, each with its boolean vector type and the names of its components.
    const VECTORS: [[&str; 3]; 3] = [
        ["vec2", "bvec2", "xy"],
        ["vec3", "bvec3", "xyz"],
        ["vec4", "bvec4", "xyzw"],
    ];

    pub(super) fn godot(wgsl: &str) -> Result<String> {
        let mut text = String::new();
        // Godot's `mix` takes no vectors of integers.
        for kind in ["", "i", "u"] {
            for [vector, conditions, axes] in VECTORS {
                let parts = axes
                    .chars()
                    .map(|axis| format!("c.{axis} ? b.{axis} : a.{axis}"));
                let parts = parts.collect::<Vec<_>>().join(", ");
                let vector = format!("{kind}{vector}");
                text += &format!(
                    "{vector} mixed({vector} a, {vector} b, {conditions} c) {{ return {vector}({parts}); }}\n"
                );
            }
        }
        let mut signed = Vec::new();
        for line in glsl(wgsl)?.lines() {
            // Constants of structures with arrays become macros.
            if let Some((kind, value)) = line
                .strip_prefix("const ")
                .and_then(|line| line.strip_suffix(';')?.split_once(" = "))
            {
                let name = kind.split(' ').nth(1).unwrap_or_default();
                let name = name.split('[').next().unwrap_or_default();
                text += &format!("#define {name} {value}\n");
                continue;
            }
            let mut line = line.to_owned();
            for [vector, ..] in VECTORS {
                // Both operands of a shift have one type.
                let declared = line.trim_start().strip_prefix(&format!("i{vector} "));
                signed.extend(declared.and_then(|rest| Some(rest.split_once(" = ")?.0.to_owned())));
                for name in &signed {
                    let shift = format!("({name} >> u{vector}(");
                    if let Some((before, after)) = line.split_once(&shift)
                        && let Some((number, after)) = after.split_once("u)")
                    {
                        line = format!("{before}({name} >> i{vector}({number}){after}");
                    }
                }
            }
            text += &with_mixed(&line);
            text.push('\n');
        }
        Ok(text)
    }

    /// Replaces calls of `mix` with calls of `mixed`, which also accepts integer vectors.
    fn with_mixed(line: &str) -> String {
        let mut text = String::new();
        let mut rest = line;
        while let Some((before, after)) = rest.split_once("mix(") {
            let is_part = before.ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
            text += before;
            text += if is_part { "mix(" } else { "mixed(" };
            rest = after;
        }
        text + rest
    }

    pub(super) fn godot_material(shader: MaterialShader, recipe: &Recipe) -> Result<String> {
        if !shader.textures.is_empty() || !shader.data.is_empty() {
            let message =
                "a shader for Godot reads no textures, but nodes of this recipe need them";
            return Err(usage(message).hint("bake the recipe, or take --language glsl"));
        }
        let functions = godot(&shader.wgsl)?;
        let [width, height] = recipe.extent;
        Ok(format!(
            "shader_type spatial;

// Keep this 0: it prevents optimizations that change values.
uniform uint always_zero = 0u;

{functions}
void fragment() {{
    vec2 at = UV * vec2({width:?}, {height:?});
    Material surface = material(place_2d(at), always_zero);
    ALBEDO = surface.albedo;
    ROUGHNESS = surface.roughness;
    METALLIC = surface.metallic;
}}
"
        ))
    }

    fn parsed(wgsl: &str) -> Result<(naga::Module, ModuleInfo)> {
        let module = naga::front::wgsl::parse_str(wgsl)?;
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        let info = validator
            .validate(&module)
            .context("the shader is not valid")?;
        Ok((module, info))
    }
}
