//! Computes nodes of a recipe on a GPU.

use crate::shader::{Nodes, Shader, stride};
use crate::{Gpu, GpuError};
use dapple_recipe::color::LinearRgb;
use dapple_recipe::raster::{Field as _, Raster, Window};
use dapple_recipe::{
    Bake, BakeOptions, Plan, Recipe, RecipeError, Renderer, RendererError, Values,
};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A plan whose nodes a GPU computes.
///
/// Nodes without a shader are computed on the CPU and uploaded. Shaders are compiled when they are first needed.
///
/// # Examples
///
/// ```
/// use dapple_gpu::{Gpu, GpuPlan};
/// use dapple_recipe::{BakeOptions, Images, MapKind, Plan, Recipe};
///
/// // Without an adapter there is nothing to show.
/// let Ok(gpu) = Gpu::headless() else { return Ok(()) };
/// let recipe = Recipe::builtin("giraffe")?;
/// let plan = Plan::new(&recipe, &Images::new(), 0.0)?;
/// let on_gpu = GpuPlan::new(&gpu, &recipe, &plan)?;
/// let maps = vec![MapKind::Height, MapKind::Normal, MapKind::Albedo];
/// let options = BakeOptions { size: [64, 64], maps, ..BakeOptions::default() };
/// let maps = on_gpu.bake(&options)?.whole_maps()?;
/// # let on_cpu = dapple_recipe::Bake::new(&plan, &options)?.whole_maps()?;
/// # assert_eq!(maps[0].1.to_rgba8(), on_cpu[0].1.to_rgba8());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct GpuPlan {
    shaders: Arc<Shaders>,
    /// The plan with the shaders as its renderer.
    plan: Plan,
}

/// The shaders of a plan.
#[derive(Debug)]
struct Shaders {
    gpu: Gpu,
    recipe: Recipe,
    /// The plan without a renderer.
    plan: Plan,
    compiled: Mutex<BTreeMap<Nodes, Arc<Shader>>>,
    /// For each node that was asked for, its inputs; `None` if no shader computes it.
    inputs: Mutex<BTreeMap<String, Option<Vec<String>>>>,
}

impl GpuPlan {
    /// Prepares the nodes of `recipe`, whose plan is `plan`.
    ///
    /// # Errors
    ///
    /// [`NotExact`](crate::GpuErrorKind::NotExact) if the bits of the GPU differ from the CPU, unless
    /// [allowed](Gpu::allow_inexact).
    pub fn new(gpu: &Gpu, recipe: &Recipe, plan: &Plan) -> Result<Self, GpuError> {
        gpu.check_exact()?;
        let shaders = Arc::new(Shaders {
            gpu: gpu.clone(),
            recipe: recipe.clone(),
            plan: plan.clone(),
            compiled: Mutex::default(),
            inputs: Mutex::default(),
        });
        let plan = plan.clone().with_renderer(shaders.clone());
        Ok(Self { shaders, plan })
    }

    /// Returns the plan, whose bakes and images of nodes use the GPU.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Sets up a bake, with the same bytes as on the CPU. Normals, occlusion and curvature are computed from the heights
    /// on the CPU.
    ///
    /// # Errors
    ///
    /// The same errors as [`Bake::new`]. A failure of the GPU is
    /// [`Renderer`](dapple_recipe::RecipeErrorKind::Renderer), whose error is a [`GpuError`].
    pub fn bake(&self, options: &BakeOptions) -> Result<Bake<'_>, RecipeError> {
        Bake::new(&self.plan, options)
    }

    /// Returns the numbers of a node in a window. They equal those of [`Plan::field`] bit for bit.
    ///
    /// # Errors
    ///
    /// [`NotInShader`](crate::GpuErrorKind::NotInShader) if no shader computes the node, the same errors as [`Plan::field`], or
    /// a failure of the GPU.
    pub fn raster(&self, node: &str, window: &Window) -> Result<Raster<f32>, GpuError> {
        // Check the node and the kind of its values.
        self.shaders.plan.field(node)?;
        match self.shaders.node(node, window)? {
            Values::Numbers(numbers) => raster(window, numbers),
            Values::Colors(_) => raster(window, Vec::new()),
        }
    }

    /// Returns the colors of a node in a window. They equal those of [`Plan::colors`] bit for bit; numbers become grays.
    ///
    /// # Errors
    ///
    /// The same errors as [`raster`](Self::raster).
    pub fn colors(&self, node: &str, window: &Window) -> Result<Raster<LinearRgb>, GpuError> {
        self.shaders.plan.colors(node)?;
        match self.shaders.node(node, window)? {
            Values::Numbers(numbers) => {
                raster(window, numbers.into_iter().map(LinearRgb::gray).collect())
            }
            Values::Colors(colors) => raster(window, colors),
        }
    }

    /// Returns the values of a node in a window as a texture, which stays on the GPU. The format is `R32Float` for
    /// numbers and `Rgba32Float` for linear colors, with an alpha of 1. The texture can be bound and copied.
    ///
    /// # Errors
    ///
    /// [`TooLarge`](crate::GpuErrorKind::TooLarge) if the window has more pixels along a side than a texture may have, or the
    /// same errors as [`raster`](Self::raster).
    pub fn texture(&self, node: &str, window: &Window) -> Result<wgpu::Texture, GpuError> {
        self.shaders.plan.colors(node)?;
        self.shaders.texture(node, window)
    }
}

fn raster<T: Copy>(window: &Window, pixels: Vec<T>) -> Result<Raster<T>, GpuError> {
    Ok(Raster::from_vec(window.size, pixels).map_err(RecipeError::from)?)
}

impl Shaders {
    /// Returns the shader of some nodes, which is compiled at the first call.
    fn shader(&self, nodes: &Nodes) -> Result<Arc<Shader>, GpuError> {
        let mut compiled = self.compiled.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(shader) = compiled.get(nodes) {
            return Ok(shader.clone());
        }
        let shader = nodes.compiled(&self.gpu.device, &self.recipe, &self.plan)?;
        let shader = Arc::new(shader);
        compiled.insert(nodes.clone(), shader.clone());
        Ok(shader)
    }

    /// Returns the shader of a node, and the values of its inputs in a window.
    fn prepared(
        &self,
        node: &str,
        window: &Window,
    ) -> Result<(Arc<Shader>, Vec<Values>), GpuError> {
        let mut nodes = Nodes::divided(&self.plan, &[node]);
        let shader = self.shader(&nodes.remove(0))?;
        let input = |input: &String| {
            Ok(match self.plan.is_color(input) {
                true => Values::Colors(self.plan.colors(input)?.to_raster(window)?.into_pixels()),
                false => {
                    let raster = self.plan.field(input)?.to_raster(window);
                    Values::Numbers(raster.map_err(RecipeError::from)?.into_pixels())
                }
            })
        };
        let inputs: Result<_, RecipeError> = shader.inputs.iter().map(input).collect();
        Ok((shader, inputs?))
    }

    /// Computes a node in a window, and reads its values.
    fn node(&self, node: &str, window: &Window) -> Result<Values, GpuError> {
        // Check the size before any values are computed.
        Raster::filled(window.size, 0_u8).map_err(RecipeError::from)?;
        let (shader, inputs) = self.prepared(node, window)?;
        let inputs = named(&shader, &inputs);
        let mut values = self.values(&shader, window, &inputs)?;
        Ok(values.remove(0))
    }

    /// Computes all nodes of a shader in a window, and reads their values.
    fn values(
        &self,
        shader: &Shader,
        window: &Window,
        inputs: &BTreeMap<&str, &Values>,
    ) -> Result<Vec<Values>, GpuError> {
        let device = &self.gpu.device;
        let mut all: Vec<Values> = Vec::new();
        for job in shader.jobs(device, window)? {
            let values = shader.run(device, job, inputs)?;
            if all.is_empty() {
                all = values;
                continue;
            }
            for (all, values) in all.iter_mut().zip(values) {
                match (all, values) {
                    (Values::Numbers(all), Values::Numbers(rows)) => all.extend(rows),
                    (Values::Colors(all), Values::Colors(rows)) => all.extend(rows),
                    // A node has one kind of values.
                    _ => {}
                }
            }
        }
        Ok(all)
    }

    /// Computes a node in a window, into a texture.
    fn texture(&self, node: &str, window: &Window) -> Result<wgpu::Texture, GpuError> {
        let device = &self.gpu.device;
        let limit = device.device.limits().max_texture_dimension_2d;
        let [width, height] = window.size;
        let longer = width.max(height);
        GpuError::check_limit("number of pixels along a side", longer.into(), limit.into())?;
        Raster::filled(window.size, 0_u8).map_err(RecipeError::from)?;
        let (shader, inputs) = self.prepared(node, window)?;
        let inputs = named(&shader, &inputs);
        let (format, bytes) = match self.plan.is_color(node) {
            true => (wgpu::TextureFormat::Rgba32Float, 16),
            false => (wgpu::TextureFormat::R32Float, 4),
        };
        let size = |height| wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        let texture = device.checked("the creation of a texture", || {
            device.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(node),
                size: size(height),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC
                    | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            })
        })?;
        for job in shader.jobs(device, window)? {
            device.checked("a computation", || {
                let mut encoder = device.device.create_command_encoder(&Default::default());
                let out = shader.record(device, &mut encoder, job, &inputs);
                let layout = wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(bytes * stride(width)),
                    rows_per_image: None,
                };
                let from = wgpu::TexelCopyBufferInfo {
                    buffer: &out,
                    layout,
                };
                let mut to = texture.as_image_copy();
                to.origin.y = job.first_row;
                encoder.copy_buffer_to_texture(from, to, size(job.rows));
                device.queue.submit([encoder.finish()]);
            })?;
        }
        Ok(texture)
    }
}

fn named<'a>(shader: &'a Shader, inputs: &'a [Values]) -> BTreeMap<&'a str, &'a Values> {
    let names = shader.inputs.iter().map(String::as_str);
    names.zip(inputs).collect()
}

impl Renderer for Shaders {
    fn inputs(&self, node: &str) -> Option<Vec<String>> {
        let mut all = self.inputs.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(inputs) = all.get(node) {
            return inputs.clone();
        }
        let mut nodes = Nodes::divided(&self.plan, &[node]);
        let nodes = nodes.remove(0);
        let text = nodes.text(&self.gpu.device, &self.recipe, &self.plan).ok();
        let inputs = text.map(|text| text.inputs);
        all.insert(node.to_owned(), inputs.clone());
        inputs
    }

    fn render(
        &self,
        nodes: &[&str],
        window: &Window,
        inputs: &BTreeMap<&str, &Values>,
    ) -> Result<Vec<Values>, RendererError> {
        let mut made = BTreeMap::new();
        for group in Nodes::divided(&self.plan, nodes) {
            let values = self
                .shader(&group)
                .and_then(|shader| self.values(&shader, window, inputs))
                .map_err(RendererError::new)?;
            made.extend(group.names().map(str::to_owned).zip(values));
        }
        Ok(nodes.iter().filter_map(|&node| made.remove(node)).collect())
    }
}
