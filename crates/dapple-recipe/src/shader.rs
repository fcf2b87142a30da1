//! Generates the material of a recipe as a shader in WGSL.
//!
//! A node writes an expression of its inputs. The material is one function, in which each node is a constant. A node that
//! is evaluated at other positions, as the input of `warp`, becomes a function of the position. Nodes without a shader
//! become members of a structure, whose values the caller reads from textures.
//!
//! The values have the bits of the plan. Sums and products of `f32` pass through the barrier of `dapple-wgsl`, and
//! positions are computed with the 64 bits of the processor, in `u32`.

mod field;
mod numbers;
mod writer;

pub use field::{FieldShader, field_to_wgsl};

pub(crate) use writer::{Code, NodeShader, Refusal, color_literal, lerp, literal, quotient};

use crate::{Images, Plan, Recipe, RecipeError, RecipeErrorKind};
use writer::Writer;

/// Options of [`Recipe::to_wgsl`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShaderOptions {
    /// Whether the shader takes the values of nodes that no shader computes as arguments, which its caller reads from
    /// textures. Such nodes are an error otherwise.
    ///
    /// The default is false.
    pub textures: bool,
}

/// The material of a recipe as a shader.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MaterialShader {
    /// A module of WGSL without bindings and entry points. It contains all that it uses.
    pub wgsl: String,
    /// Names of the nodes whose values the caller reads from textures, in the order of the members of the structure
    /// `Textures`; empty if the shader computes all nodes.
    pub textures: Vec<String>,
    /// Words of the texture `data`, in whole rows: texels of four words in the format `rgba32uint`, 1024 in a row. They
    /// hold the tiles of wavelet noise, the control points of PUPs, stamps and tables. Empty if the function has no such
    /// argument.
    pub data: Vec<u32>,
    /// Words of the array `shader_numbers`, four for each vector, after [`with_numbers`](Self::with_numbers); empty otherwise.
    pub numbers: Vec<u32>,
    /// Number of bytes of `wgsl` before the modules of the library.
    own: usize,
}

impl MaterialShader {
    /// Number of words of a texel of the texture `data`.
    pub(crate) const DATA_TEXEL: usize = 4;

    /// Number of words of a row of the texture `data`.
    pub const DATA_ROW: usize = 1024 * Self::DATA_TEXEL;

    /// Maximum number of words of the texture `data`: 8192 rows, which every device supports.
    pub const DATA_LIMIT: usize = 8192 * Self::DATA_ROW;

    /// Moves the values of nodes from the text to [`numbers`](Self::numbers). A program that shows a recipe while its values
    /// change then compiles one shader, and uploads the words. The results have the same bits.
    ///
    /// The text reads the words from an array of vectors that the program declares, here of 300 words:
    ///
    /// ```wgsl
    /// @group(0) @binding(0) var<uniform> shader_numbers: array<vec4<u32>, 75>;
    /// ```
    ///
    /// Choices of kinds and numbers of octaves, stops or layers stay in the text. So do simpler expressions for some values,
    /// such as a product in the place of a quotient if the divisor is a power of two, and the sharing of expressions by
    /// nodes with equal values.
    #[must_use]
    pub fn with_numbers(self) -> Self {
        if !self.numbers.is_empty() {
            return self;
        }
        let (own, library) = self.wgsl.split_at(self.own);
        let (own, numbers) = numbers::moved(own);
        Self {
            wgsl: own.clone() + library,
            numbers,
            own: own.len(),
            ..self
        }
    }
}

impl Recipe {
    /// Generates the material as a function of WGSL, with the same bits as on the CPU:
    ///
    /// ```wgsl
    /// struct Material {
    ///     height: f32, albedo: vec3<f32>, roughness: f32, metallic: f32,
    ///     emission: vec3<f32>, opacity: f32, specular: f32, clearcoat: f32,
    /// }
    /// fn material(place: Place2d, zero: u32) -> Material
    /// fn material64(at: Position2d, zero: u32) -> Material
    /// ```
    ///
    /// `place` is a position in units of the plane, as a cell and a fraction; `place_2d` splits a `vec2<f32>`. `at` is a
    /// position in numbers of 64 bits, each as the upper and the lower word of its bits. The number `zero` is 0, and must
    /// come from a buffer: it keeps compilers from changing the results.
    ///
    /// Nodes that look up tiles, control points or stamps, such as wavelet noise, add the argument
    /// `data: texture_2d<u32>` before `zero`: a texture of the words in [`MaterialShader::data`]. Looping motion stands
    /// still at the time 0.
    ///
    /// The emission is without the strength of the material. Maps that the material does not set have their defaults.
    ///
    /// Values have the bits of [`Plan::height`], [`Plan::field`] and [`Plan::colors`] at the position `cell + fraction`, up
    /// to 2^31 cells of each node.
    ///
    /// # Errors
    ///
    /// [`NotInShader`](RecipeErrorKind::NotInShader) if no shader computes a node and
    /// [`textures`](ShaderOptions::textures) is not set, or the same errors as [`Plan::new`].
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_recipe::{Images, Recipe, ShaderOptions};
    ///
    /// let recipe = Recipe::from_toml(
    ///     r#"
    ///     dapple = 1
    ///     [nodes.cracks.worley]
    ///     frequency = 8.0
    ///     value = "f2_minus_f1"
    ///     [material]
    ///     height = "cracks"
    ///     "#,
    /// )?;
    /// let shader = recipe.to_wgsl(&Images::new(), &ShaderOptions::default())?;
    /// assert!(shader.wgsl.contains("fn material(place: Place2d, zero: u32) -> Material"));
    /// # Ok::<(), dapple_recipe::RecipeError>(())
    /// ```
    pub fn to_wgsl(
        &self,
        images: &Images,
        options: &ShaderOptions,
    ) -> Result<MaterialShader, RecipeError> {
        // The plan checks the recipe, and knows which nodes have colors.
        self.assemble(&Plan::new(self, images, 0.0)?, images, options)
    }

    /// Generates the material as [`to_wgsl`](Self::to_wgsl) does, with a plan of the recipe that is built already. The
    /// plan may have another material, so that a shader can compute any nodes. Tables are built without images. Nodes that
    /// move have no shader if the plan has another time than 0.
    ///
    /// # Errors
    ///
    /// [`NotInShader`](RecipeErrorKind::NotInShader) if no shader computes a node and
    /// [`textures`](ShaderOptions::textures) is not set.
    pub fn to_wgsl_with(
        &self,
        plan: &Plan,
        options: &ShaderOptions,
    ) -> Result<MaterialShader, RecipeError> {
        self.assemble(plan, &Images::new(), options)
    }

    fn assemble(
        &self,
        plan: &Plan,
        images: &Images,
        options: &ShaderOptions,
    ) -> Result<MaterialShader, RecipeError> {
        let mut writer = Writer::new(self, images, plan);
        let material = writer.material();
        if !writer.textures().is_empty() && !options.textures {
            let nodes = writer.textures().iter();
            let nodes = nodes.map(|(name, texture)| (name.clone(), texture.reason.clone()));
            return Err(RecipeError::new(RecipeErrorKind::NotInShader {
                nodes: nodes.collect(),
            }));
        }
        let own = writer.assemble(&material);
        Ok(MaterialShader {
            own: own.len(),
            wgsl: own + &writer.library(),
            numbers: Vec::new(),
            textures: writer.textures().keys().cloned().collect(),
            data: writer.data(),
        })
    }
}
