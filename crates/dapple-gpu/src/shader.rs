//! A compute shader for a few nodes of a recipe, and its jobs.

use crate::device::{Device, Program, WORKGROUP};
use crate::{GpuError, GpuErrorKind};
use dapple_recipe::color::LinearRgb;
use dapple_recipe::raster::Window;
use dapple_recipe::{Input, Material, MaterialShader, Plan, Recipe, ShaderOptions, Values};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Largest number of nodes with numbers that a shader computes: the height, roughness and metalness of a material.
const MAX_NUMBERS: usize = 3;

/// Members of the structure `Material` with numbers, in the order of the nodes.
const MEMBERS: [&str; MAX_NUMBERS] = ["height", "roughness", "metallic"];

/// Maximum number of words of a uniform buffer, which every device supports. Shaders with more numbers are compiled for
/// each value.
const MAX_WORDS: usize = 1 << 14;

/// Maximum number of pixels of a job. Drivers reset a GPU whose job takes seconds.
const MAX_PIXELS: u64 = 1 << 22;

/// Nodes that one shader computes: up to three with numbers, and one with colors.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Nodes {
    numbers: Vec<String>,
    color: Option<String>,
}

/// The text of a shader, and the nodes whose values it reads.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    pub(crate) inputs: Vec<String>,
    wgsl: String,
    /// Words of the texture that it looks up.
    data: Vec<u32>,
    /// Numbers of the nodes.
    numbers: Vec<u32>,
}

/// A compiled shader.
#[derive(Clone, Debug)]
pub(crate) struct Shader {
    program: Program,
    pub(crate) inputs: Vec<String>,
    /// Number of words that the shader reads for a pixel.
    n_inputs: u64,
    n_numbers: u64,
    has_color: bool,
}

/// Rows of a window that are computed at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Job<'a> {
    pub(crate) window: &'a Window,
    pub(crate) first_row: u32,
    pub(crate) rows: u32,
}

impl Nodes {
    /// Divides nodes between as few shaders as possible.
    pub(crate) fn divided(plan: &Plan, nodes: &[&str]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for &node in nodes {
            let is_color = plan.is_color(node);
            let has_room = |nodes: &Self| match is_color {
                true => nodes.color.is_none(),
                false => nodes.numbers.len() < MAX_NUMBERS,
            };
            let at = all.iter().position(has_room).unwrap_or(all.len());
            if at == all.len() {
                all.push(Self::default());
            }
            match is_color {
                true => all[at].color = Some(node.to_owned()),
                false => all[at].numbers.push(node.to_owned()),
            }
        }
        all
    }

    /// Returns the nodes in the order of the results.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.numbers.iter().chain(&self.color).map(String::as_str)
    }

    /// Generates the shader that computes the nodes as a material. Fails if no shader computes one of them.
    pub(crate) fn text(
        &self,
        device: &Device,
        recipe: &Recipe,
        plan: &Plan,
    ) -> Result<Text, GpuError> {
        let number = |at: usize| match self.numbers.get(at) {
            Some(node) => Input::from(node.as_str()),
            None => Input::Number(0.0),
        };
        let color = self.color.as_deref().map(Input::from);
        let recipe = Recipe {
            material: Material {
                height: number(0),
                roughness: number(1),
                metallic: number(2),
                albedo: Some(color.unwrap_or(Input::Number(0.0))),
                emission: None,
                opacity: None,
                specular: None,
                clearcoat: None,
                ..recipe.material.clone()
            },
            ..recipe.clone()
        };
        let shader = recipe.to_wgsl_with(plan, &ShaderOptions { textures: true })?;
        let shared = device.uploads_values;
        let shared = shared.then(|| shader.clone().with_numbers());
        let shared = shared.filter(|shared| shared.numbers.len() <= MAX_WORDS);
        let shader = shared.unwrap_or(shader);
        // A node without a shader is its own input.
        if let Some(node) = self
            .names()
            .find(|node| shader.textures.iter().any(|input| input == node))
        {
            let node = node.to_owned();
            return Err(GpuError::new(GpuErrorKind::NotInShader { node }));
        }
        let wgsl = shader.wgsl.clone() + &self.entry_point(plan, &shader);
        Ok(Text {
            inputs: shader.textures,
            wgsl,
            data: shader.data,
            numbers: shader.numbers,
        })
    }

    /// Writes the entry point. The job is `zero`, the numbers of columns and rows, and the length of a row of results.
    /// Every channel of an input is a separate block, and so are the results of a node.
    fn entry_point(&self, plan: &Plan, shader: &MaterialShader) -> String {
        let mut textures = Vec::new();
        let mut block = 0;
        let mut channel = || {
            block += 1;
            format!("gpu_inputs[{}u * pixels + pixel]", block - 1)
        };
        for input in &shader.textures {
            textures.push(match plan.is_color(input) {
                true => format!("vec3({}, {}, {})", channel(), channel(), channel()),
                false => channel(),
            });
        }
        let textures = match textures.is_empty() {
            true => String::new(),
            false => format!("Textures({}), ", textures.join(", ")),
        };
        let [declared, data] = match shader.data.is_empty() {
            false => [
                "@group(0) @binding(4) var gpu_data: texture_2d<u32>;",
                "gpu_data, ",
            ],
            true => [""; 2],
        };
        let numbers = match shader.numbers.len() {
            0 => String::new(),
            n => format!(
                "@group(0) @binding(5) var<uniform> shader_numbers: array<vec4<u32>, {}>;",
                n / 4
            ),
        };
        let mut out = format!(
            "
{declared}
{numbers}
@group(0) @binding(0) var<storage> gpu_job: array<u32>;
@group(0) @binding(1) var<storage> gpu_positions: array<vec2<u32>>;
@group(0) @binding(2) var<storage> gpu_inputs: array<f32>;
@group(0) @binding(3) var<storage, read_write> gpu_out: array<f32>;
@compute @workgroup_size({WORKGROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let columns = gpu_job[1];
    if id.x >= columns {{ return; }}
    let at = Position2d(gpu_positions[id.x], gpu_positions[columns + id.y]);
    let pixels = columns * gpu_job[2];
    let pixel = columns * id.y + id.x;
    let result = material64(at, {data}{textures}gpu_job[0]);
    let block = gpu_job[3] * gpu_job[2];
    let result_at = gpu_job[3] * id.y + id.x;
"
        );
        let n_numbers = self.numbers.len();
        for (at, member) in MEMBERS.iter().enumerate().take(n_numbers) {
            let _ = writeln!(
                out,
                "    gpu_out[{at}u * block + result_at] = result.{member};"
            );
        }
        if self.color.is_some() {
            let _ = writeln!(
                out,
                "    let color = {n_numbers}u * block + 4u * result_at;"
            );
            for (at, axis) in ["x", "y", "z"].iter().enumerate() {
                let _ = writeln!(out, "    gpu_out[color + {at}u] = result.albedo.{axis};");
            }
            out += "    gpu_out[color + 3u] = 1.0;\n";
        }
        out + "}\n"
    }

    /// Compiles the shader.
    pub(crate) fn compiled(
        &self,
        device: &Device,
        recipe: &Recipe,
        plan: &Plan,
    ) -> Result<Shader, GpuError> {
        let text = self.text(device, recipe, plan)?;
        let channels = |input: &String| if plan.is_color(input) { 3 } else { 1 };
        Ok(Shader {
            program: Program::new(device, &text.wgsl, [&text.data, &text.numbers])?,
            n_inputs: text.inputs.iter().map(channels).sum(),
            inputs: text.inputs,
            n_numbers: self.numbers.len() as u64,
            has_color: self.color.is_some(),
        })
    }
}

impl Shader {
    /// Divides a window into jobs whose buffers are within the limits of the device.
    pub(crate) fn jobs<'a>(
        &self,
        device: &Device,
        window: &'a Window,
    ) -> Result<impl Iterator<Item = Job<'a>> + use<'a>, GpuError> {
        let limits = device.device.limits();
        let [columns, height] = window.size;
        let words = self.words(1).max(self.n_inputs).max(2);
        let row = 4 * words * u64::from(stride(columns));
        let limit = limits.max_buffer_size;
        let limit = limit.min(limits.max_storage_buffer_binding_size);
        GpuError::check_limit("number of bytes of a row", row, limit)?;
        let groups = limits.max_compute_workgroups_per_dimension;
        let what = "number of workgroups of a row";
        let needed = columns.div_ceil(WORKGROUP);
        GpuError::check_limit(what, needed.into(), groups.into())?;
        // Columns and rows share one buffer of positions.
        let most = (limit / row)
            .min((limit / 8).saturating_sub(columns.into()))
            .min((MAX_PIXELS / u64::from(columns)).max(1))
            .clamp(1, groups.into()) as u32;
        Ok((0..height)
            .step_by(most as usize)
            .map(move |first_row| Job {
                window,
                first_row,
                rows: most.min(height - first_row),
            }))
    }

    /// Returns the number of words of results for `pixels` pixels.
    fn words(&self, pixels: u64) -> u64 {
        pixels * (self.n_numbers + 4 * u64::from(self.has_color))
    }

    /// Records a job, and returns the buffer of its results. `inputs` are the values of all rows of the window.
    pub(crate) fn record(
        &self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        job: Job<'_>,
        inputs: &BTreeMap<&str, &Values>,
    ) -> wgpu::Buffer {
        let columns = job.window.size[0];
        let words = [0, columns, job.rows, stride(columns)];
        let buffers = [
            &words,
            &job.positions()[..],
            &self.words_of_inputs(job, inputs),
        ];
        let [job_words, positions, inputs] = buffers.map(|words| device.filled(words));
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let pixels = u64::from(stride(columns)) * u64::from(job.rows);
        let out = device.buffer(4 * self.words(pixels), usage);
        let buffers = [&job_words, &positions, &inputs, &out];
        self.program
            .record(device, encoder, buffers, [columns, job.rows]);
        out
    }

    /// Runs a job, and reads the values of all nodes.
    pub(crate) fn run(
        &self,
        device: &Device,
        job: Job<'_>,
        inputs: &BTreeMap<&str, &Values>,
    ) -> Result<Vec<Values>, GpuError> {
        let read = device.checked("a computation", || {
            let mut encoder = device.device.create_command_encoder(&Default::default());
            let out = self.record(device, &mut encoder, job, inputs);
            let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
            let read = device.buffer(out.size(), usage);
            encoder.copy_buffer_to_buffer(&out, 0, &read, 0, None);
            device.queue.submit([encoder.finish()]);
            read
        })?;
        let words = device.read(&read)?;
        let columns = job.window.size[0] as usize;
        let stride = stride(columns as u32) as usize;
        let block = stride * job.rows as usize;
        let (numbers, colors) = words.split_at(self.n_numbers as usize * block);
        let mut values: Vec<_> = numbers
            .chunks_exact(block)
            .map(|block| {
                let rows = block.chunks_exact(stride).map(|row| &row[..columns]);
                Values::Numbers(rows.flatten().map(|word| f32::from_bits(*word)).collect())
            })
            .collect();
        if self.has_color {
            let rows = colors.chunks_exact(4 * stride);
            let pixels = rows.flat_map(|row| row[..4 * columns].as_chunks::<4>().0);
            let color = |&[r, g, b, _]: &[u32; 4]| LinearRgb::from([r, g, b].map(f32::from_bits));
            values.push(Values::Colors(pixels.map(color).collect()));
        }
        Ok(values)
    }

    /// Returns the words of the inputs in the rows of a job, one channel after the other.
    fn words_of_inputs(&self, job: Job<'_>, inputs: &BTreeMap<&str, &Values>) -> Vec<u32> {
        let columns = job.window.size[0] as usize;
        let first = job.first_row as usize * columns;
        let pixels = first..first + job.rows as usize * columns;
        let mut words = Vec::new();
        for input in &self.inputs {
            match inputs.get(input.as_str()) {
                Some(Values::Numbers(numbers)) => {
                    words.extend(numbers[pixels.clone()].iter().map(|x| x.to_bits()));
                }
                Some(Values::Colors(colors)) => {
                    for axis in 0..3 {
                        let colors = colors[pixels.clone()].iter();
                        words.extend(colors.map(|color| color.to_array()[axis].to_bits()));
                    }
                }
                // The caller passes the values of all inputs.
                None => {}
            }
        }
        words
    }
}

impl Job<'_> {
    /// Returns the coordinates of the columns and the rows, in numbers of 64 bits: first the upper word.
    fn positions(&self) -> Vec<u32> {
        let columns = (0..self.window.size[0]).map(|column| self.window.column_x(column));
        let rows = self.first_row..self.first_row + self.rows;
        let rows = rows.map(|row| self.window.row_y(row));
        let words = |at: f64| [(at.to_bits() >> 32) as u32, at.to_bits() as u32];
        columns.chain(rows).flat_map(words).collect()
    }
}

/// Returns the number of pixels of a row of results, which is a multiple of 64: `wgpu` copies rows of 256 bytes to
/// textures.
pub(crate) fn stride(columns: u32) -> u32 {
    columns.div_ceil(64).saturating_mul(64)
}
