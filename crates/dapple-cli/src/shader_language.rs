//! Shaders in other languages than WGSL, translated by `naga`.

use anyhow::Result;

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
        }
    }

    /// Translates functions without bindings and entry points from WGSL.
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
        }
    }
}

#[cfg(feature = "shader-languages")]
mod translation {
    use anyhow::{Context as _, Result};
    use naga::back::{glsl, hlsl};
    use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

    /// An entry point, which GLSL needs, and its text there.
    const ENTRY: [&str; 2] = [
        "\n@compute @workgroup_size(1) fn entry() {}\n",
        "void main() {",
    ];

    /// Lines of GLSL that belong to a whole shader: the version, precisions, and the size of a workgroup.
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

    fn parsed(wgsl: &str) -> Result<(naga::Module, ModuleInfo)> {
        let module = naga::front::wgsl::parse_str(wgsl)?;
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        let info = validator
            .validate(&module)
            .context("the shader is not valid")?;
        Ok((module, info))
    }
}
