//! Writes the functions of a shader.

use super::MaterialShader;
use crate::plan::{Builder, Watch, seed_of};
use crate::{Images, Input, Material, Node, NodeSeed, Plan, PlanLimits, Recipe, RecipeError};
use core::fmt::{self, Write as _};
use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_pattern::PatternError;
use dapple_raster::RasterError;
use dapple_wgsl::{Module, double_value, number_value, source};
use dapple_worley::WorleyError;
use indexmap::IndexMap;
use std::collections::BTreeMap;

/// An expression: a number (`f32`), or a linear color (`vec4<f32>`, whose last component is not used).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Code {
    pub(crate) text: String,
    pub(crate) is_color: bool,
}

/// Why no shader computes a node, as a phrase.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Refusal(String);

/// A node whose values the caller reads from a texture.
#[derive(Clone, Debug)]
pub(super) struct Texture {
    pub(super) reason: String,
    is_color: bool,
    /// Name of the member of the structure `Textures`.
    member: String,
}

/// The parts of a shader.
pub(super) struct Writer<'a> {
    recipe: &'a Recipe,
    images: &'a Images,
    plan: &'a Plan,
    /// For each node, its name in identifiers.
    identifiers: BTreeMap<&'a str, String>,
    modules: Vec<Module>,
    /// Names of the shader's constants, by value, so that equal values share a constant.
    constants: IndexMap<String, String>,
    functions: Vec<String>,
    /// For each node that is evaluated at other positions, its function.
    moved: BTreeMap<&'a str, Result<Code, Refusal>>,
    textures: IndexMap<String, Texture>,
    /// Words of the texture `data`.
    data: Vec<u32>,
}

/// The body of a function.
#[derive(Default)]
struct Scope<'a> {
    lines: String,
    /// For each expression that has a name, the name.
    names: BTreeMap<String, String>,
    nodes: BTreeMap<&'a str, Code>,
    /// Whether nodes without a shader may be read from textures.
    has_textures: bool,
    /// Expression of the position, if it is not the argument of the function.
    at: Option<String>,
}

/// Access of a node to the shader that it is written to.
pub(crate) struct NodeShader<'w, 'a> {
    writer: &'w mut Writer<'a>,
    scope: &'w mut Scope<'a>,
    node: &'a str,
}

impl Code {
    pub(crate) fn number(text: impl Into<String>) -> Self {
        let (text, is_color) = (text.into(), false);
        Self { text, is_color }
    }

    pub(crate) fn color(text: impl Into<String>) -> Self {
        let (text, is_color) = (text.into(), true);
        Self { text, is_color }
    }

    /// Returns the expression as a color. A number becomes a gray.
    pub(crate) fn to_color(&self) -> String {
        match self.is_color {
            true => self.text.clone(),
            false => format!("vec4({})", self.text),
        }
    }

    fn kind(&self) -> &'static str {
        if self.is_color { "vec4<f32>" } else { "f32" }
    }
}

impl Refusal {
    /// Returns the reason.
    pub(super) fn into_reason(self) -> String {
        self.0
    }

    pub(crate) fn new(reason: impl fmt::Display) -> Self {
        Self(reason.to_string())
    }
}

/// Implements the conversion from the errors of parameters that a shader does not have.
macro_rules! from {
    ($($error:ident),*) => {
        $(impl From<$error> for Refusal {
            fn from(error: $error) -> Self {
                Self::new(error)
            }
        })*
    };
}

from!(RecipeError, WorleyError, RasterError, PatternError);

/// Returns a number as a literal. A compiler that knows a zero may leave out a sum, and with it the sign of the result.
pub(crate) fn literal(number: f32) -> String {
    match number == 0.0 {
        true => "number(0.0, zero)".to_owned(),
        false => number_value(number),
    }
}

/// Returns a linear color as a literal.
pub(crate) fn color_literal(color: LinearRgb) -> String {
    let [r, g, b] = color.to_array().map(number_value);
    format!("vec4({r}, {g}, {b}, 0.0)")
}

/// Returns an expression that mixes two colors linearly: `from * (1 - by) + to * by`.
pub(crate) fn lerp(from: &str, to: &str, by: &str) -> String {
    let rest = format!("exact_sub(vec4(1.0), vec4({by}), zero)");
    let [from, to] = [(from, rest), (to, format!("vec4({by})"))]
        .map(|(color, part)| format!("exact_mul({color}, {part}, zero)"));
    format!("exact_add({from}, {to}, zero)")
}

/// Returns the quotient of an expression and a constant.
pub(crate) fn quotient(text: &str, divisor: f32) -> String {
    let is_power_of_two = divisor.to_bits() & 0x7f_ffff == 0 && divisor.recip().is_normal();
    if divisor == 1.0 {
        text.to_owned()
    } else if is_power_of_two {
        format!("number_mul({text}, {}, zero)", literal(divisor.recip()))
    } else {
        format!("number_div({text}, {}, zero)", literal(divisor))
    }
}

impl<'a> NodeShader<'_, 'a> {
    /// Returns the seed of the node, which is derived from its name unless `other` is given.
    pub(crate) fn seed(&self, other: Option<&NodeSeed>) -> Seed {
        seed_of(self.writer.recipe, self.node, other)
    }

    /// Returns, for each axis that repeats, the number of cells across the tile. The plan has checked the frequency.
    pub(crate) fn periods(&self, frequency: [f64; 2]) -> [Option<u32>; 2] {
        let Recipe { extent, wrap, .. } = self.writer.recipe;
        [0, 1].map(|axis| wrap[axis].then(|| (extent[axis] * frequency[axis]) as u32))
    }

    /// Returns the size of the tile, and along which axes it repeats.
    pub(crate) fn tile(&self) -> ([f64; 2], [bool; 2]) {
        (self.writer.recipe.extent, self.writer.recipe.wrap)
    }

    /// Returns the node that an input names, and its name.
    pub(crate) fn node_of(&self, input: &Input) -> Option<(&'a str, &'a Node)> {
        let recipe: &'a Recipe = self.writer.recipe;
        let (name, node) = recipe.nodes.get_key_value(input.node()?)?;
        Some((name, node))
    }

    /// Writes as if the node called `node` were the current one, with its seed.
    pub(crate) fn as_node(&mut self, node: &'a str) -> NodeShader<'_, 'a> {
        NodeShader {
            writer: self.writer,
            scope: self.scope,
            node,
        }
    }

    /// Returns the refusal of a kind of node that has no shader.
    pub(crate) fn no_shader(&self) -> Refusal {
        if self.writer.plan.is_global(self.node) {
            return Refusal::new("it depends on the whole tile");
        }
        let kind = self.writer.recipe.nodes[self.node].kind_name();
        Refusal::new(format!("`{kind}` has no shader"))
    }

    /// Returns the expression of an input, which may be a number or a color.
    pub(crate) fn any(&mut self, input: &Input) -> Result<Code, Refusal> {
        self.writer.input(self.scope, input)
    }

    /// Returns the expression of an input that is a number.
    pub(crate) fn number(&mut self, input: &Input) -> Result<String, Refusal> {
        Ok(self.any(input)?.text)
    }

    /// Returns the expressions of inputs. All of them are colors if any input is.
    pub(crate) fn alike(&mut self, inputs: &[Input]) -> Result<(Vec<String>, bool), Refusal> {
        let inputs = inputs.iter().map(|input| self.any(input));
        let inputs = inputs.collect::<Result<Vec<_>, _>>()?;
        let is_color = inputs.iter().any(|input| input.is_color);
        let text = |code: &Code| match is_color {
            true => code.to_color(),
            false => code.text.clone(),
        };
        Ok((inputs.iter().map(text).collect(), is_color))
    }

    /// Adds a module with all modules that it uses.
    pub(crate) fn needs(&mut self, module: Module) {
        self.writer.needs(module);
    }

    /// Names an expression, so that it is computed once.
    pub(crate) fn name(&mut self, kind: &str, expression: String) -> String {
        if let Some(name) = self.scope.names.get(&expression) {
            return name.clone();
        }
        let name = format!("{kind}_{}", self.scope.names.len());
        let _ = writeln!(self.scope.lines, "    let {name} = {expression};");
        self.scope.names.insert(expression, name.clone());
        name
    }

    /// Names a constant of the module.
    pub(crate) fn constant(&mut self, kind: &str, value: String) -> String {
        let constants = &mut self.writer.constants;
        let name = format!("{kind}_{}", constants.len());
        constants.entry(value).or_insert(name).clone()
    }

    /// Adds a function of the node, and returns its name. `parameters` and the rest follow the name.
    pub(crate) fn function(&mut self, kind: &str, rest: &str) -> String {
        let name = format!("{}_{kind}", self.writer.identifiers[self.node]);
        let text = format!("fn {name}{rest}");
        if !self.writer.functions.contains(&text) {
            self.writer.functions.push(text);
        }
        name
    }

    /// Adds words to the texture `data`, and returns the number of the texel at which they start. Code that reads the
    /// texture has `data` as its first argument.
    pub(crate) fn data(&mut self, words: &[u32]) -> Result<usize, Refusal> {
        const TEXEL: usize = MaterialShader::DATA_TEXEL;
        self.needs(Module::Data);
        let data = &mut self.writer.data;
        // A node that is also evaluated at other positions has its words already.
        let mut texels = (0..data.len()).step_by(TEXEL);
        if let Some(first) = texels.find(|&first| data[first..].starts_with(words)) {
            return Ok(first / TEXEL);
        }
        let first = data.len();
        if first + words.len() > MaterialShader::DATA_LIMIT {
            let limit = MaterialShader::DATA_LIMIT;
            let message = format!("its data exceed the limit of {limit} words of all nodes");
            return Err(Refusal::new(message));
        }
        data.extend_from_slice(words);
        data.resize(data.len().next_multiple_of(TEXEL), 0);
        Ok(first / TEXEL)
    }

    /// Builds a part of the node's step, from the parts that the plan has built.
    pub(crate) fn build<T>(
        &self,
        build: impl FnOnce(&mut Builder<'_>) -> Result<T, RecipeError>,
    ) -> Result<T, Refusal> {
        let Writer {
            recipe,
            images,
            plan,
            ..
        } = *self.writer;
        let (limits, watch) = (PlanLimits::default(), Watch::default());
        let builder = Builder::new(recipe, images, 0.0, &limits, None, &watch);
        let mut builder = builder.with_parts_of(plan);
        builder.enter(self.node, &recipe.nodes[self.node])?;
        Ok(build(&mut builder)?)
    }

    /// Returns the position, or the position times a frequency for each axis.
    pub(crate) fn position(&mut self, frequency: [f64; 2]) -> String {
        self.needs(Module::Position2d);
        let at = self.scope.at.clone();
        self.scaled(at.as_deref().unwrap_or("at"), frequency)
    }

    /// Writes with another position.
    pub(crate) fn at<T>(&mut self, position: String, write: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.scope.at.replace(position);
        let written = write(self);
        self.scope.at = before;
        written
    }

    /// Returns a position times a frequency for each axis.
    pub(crate) fn scaled(&mut self, position: &str, frequency: [f64; 2]) -> String {
        if frequency == [1.0; 2] {
            return position.to_owned();
        }
        let [x, y] = frequency.map(double_value);
        self.name("position", format!("scaled_2d({position}, {x}, {y})"))
    }

    /// Returns a node at a position. Fails if no shader computes the node.
    pub(crate) fn moved(
        &mut self,
        input: &Input,
    ) -> Result<impl Fn(&str) -> Code + use<>, Refusal> {
        let code = self.writer.moved(input)?;
        Ok(move |position: &str| Code {
            text: code.text.replace(POSITION, position),
            is_color: code.is_color,
        })
    }
}

/// The position in the code of a node at any position.
const POSITION: &str = "{position}";

/// The parameter of functions that read the texture `data`.
const DATA: &str = "data: texture_2d<u32>, ";

/// The argument for this parameter.
const DATA_PASSED: &str = "data, ";

impl<'a> Writer<'a> {
    pub(super) fn new(recipe: &'a Recipe, images: &'a Images, plan: &'a Plan) -> Self {
        Self {
            recipe,
            images,
            plan,
            identifiers: identifiers(recipe),
            modules: vec![Module::Number, Module::Exact, Module::Position2d],
            constants: IndexMap::new(),
            functions: Vec::new(),
            moved: BTreeMap::new(),
            textures: IndexMap::new(),
            data: Vec::new(),
        }
    }

    /// Returns the words of the texture `data` in whole rows.
    pub(super) fn data(&self) -> Vec<u32> {
        let mut data = self.data.clone();
        data.resize(data.len().next_multiple_of(MaterialShader::DATA_ROW), 0);
        data
    }

    /// Returns the nodes without a shader.
    pub(super) fn textures(&self) -> &IndexMap<String, Texture> {
        &self.textures
    }

    fn needs(&mut self, module: Module) {
        if !self.modules.contains(&module) {
            self.modules.push(module);
        }
    }

    /// Returns the expression of an input.
    fn input(&mut self, scope: &mut Scope<'a>, input: &Input) -> Result<Code, Refusal> {
        match input {
            Input::Number(number) => Ok(Code::number(literal(*number as f32))),
            Input::Color(color) => Ok(Code::color(color_literal(*color))),
            Input::Node(name) => self.node(scope, name),
        }
    }

    /// Returns the name of a node's value, and writes the node unless the scope has it already.
    fn node(&mut self, scope: &mut Scope<'a>, name: &str) -> Result<Code, Refusal> {
        if let Some(code) = scope.nodes.get(name) {
            return Ok(code.clone());
        }
        let recipe: &'a Recipe = self.recipe;
        let known = recipe.nodes.get_key_value(name);
        let (name, node) =
            known.ok_or_else(|| Refusal::new(format!("there is no node `{name}`")))?;
        let written = match self.plan.has_moved(name) {
            true => Err(Refusal::new("it moves, and shaders have the time 0")),
            false => node.kind().shader(&mut NodeShader {
                writer: self,
                scope,
                node: name,
            }),
        };
        let code = match written {
            Ok(code) => code,
            Err(refusal) if scope.has_textures => self.texture(name, refusal),
            Err(Refusal(reason)) => return Err(Refusal(format!("`{name}`: {reason}"))),
        };
        let variable = format!("node_{}", self.identifiers[name.as_str()]);
        let _ = writeln!(scope.lines, "    let {variable} = {};", code.text);
        let code = Code {
            text: variable,
            is_color: code.is_color,
        };
        scope.nodes.insert(name, code.clone());
        Ok(code)
    }

    /// Adds a texture for a node without a shader.
    fn texture(&mut self, name: &str, Refusal(reason): Refusal) -> Code {
        let is_color = self.plan.is_color(name);
        let kind = if is_color { "color" } else { "value" };
        let member = format!("{}_{kind}", self.identifiers[name]);
        let text = format!("textures.{member}");
        self.textures.insert(
            name.to_owned(),
            Texture {
                reason,
                is_color,
                member,
            },
        );
        match is_color {
            true => Code::color(format!("vec4({text}, 0.0)")),
            false => Code::number(text),
        }
    }

    /// Returns the call of an input's function, with [`POSITION`] in the place of the position.
    fn moved(&mut self, input: &Input) -> Result<Code, Refusal> {
        let Input::Node(name) = input else {
            return self.input(&mut Scope::default(), input);
        };
        let recipe: &'a Recipe = self.recipe;
        let Some((name, _)) = recipe.nodes.get_key_value(name) else {
            return Err(Refusal::new(format!("there is no node `{name}`")));
        };
        if let Some(known) = self.moved.get(name.as_str()) {
            return known.clone();
        }
        // A function that is not finished leaves nothing behind.
        let before = [
            self.modules.len(),
            self.constants.len(),
            self.functions.len(),
            self.data.len(),
        ];
        let mut scope = Scope::default();
        let made = self.node(&mut scope, name).map(|code| {
            let (kind, lines, value) = (code.kind(), scope.lines, code.text);
            let function = format!("{}_at", self.identifiers[name.as_str()]);
            // Pass the texture on to functions that read it.
            let reads_data = [&lines, &value].iter().any(|part| part.contains("(data, "));
            let [parameter, argument] = match reads_data {
                true => [DATA, DATA_PASSED],
                false => [""; 2],
            };
            self.functions.push(format!(
                "fn {function}({parameter}at: Position2d, zero: u32) -> {kind} {{\n{lines}    return {value};\n}}"
            ));
            Code {
                text: format!("{function}({argument}{POSITION}, zero)"),
                is_color: code.is_color,
            }
        });
        match made {
            Ok(_) => self.needs(Module::Position2d),
            Err(_) => {
                let [modules, constants, functions, data] = before;
                self.data.truncate(data);
                self.modules.truncate(modules);
                self.constants.truncate(constants);
                self.functions.truncate(functions);
            }
        }
        self.moved.insert(name, made.clone());
        made
    }

    /// Writes the function of the material, without its head.
    pub(super) fn material(&mut self) -> String {
        let material = &self.recipe.material;
        let mut scope = Scope {
            has_textures: true,
            ..Scope::default()
        };
        let mut members = Vec::new();
        for (_, is_color, input) in material_members(material) {
            // The plan has found all nodes, and those without a shader are textures.
            let code = self.input(&mut scope, &input);
            let code = code.unwrap_or_else(|_| Code::number(literal(0.0)));
            members.push(match is_color {
                true => format!("{}.xyz", code.to_color()),
                false => code.text,
            });
        }
        let members = members.join(", ");
        format!("{}    return Material({members});\n", scope.lines)
    }

    /// Joins all parts to a module, without the [library](Self::library).
    pub(super) fn assemble(&self, material: &str) -> String {
        let mut out = self.head();
        out += "\n";
        out += "struct Material {\n";
        for (name, is_color, _) in material_members(&self.recipe.material) {
            let kind = if is_color { "vec3<f32>" } else { "f32" };
            let _ = writeln!(out, "    {name}: {kind},");
        }
        out += "}\n\n";
        if !self.textures.is_empty() {
            out += "// Values of nodes that no shader computes, from textures of the whole tile\nstruct Textures {\n";
            for (name, texture) in &self.textures {
                let kind = if texture.is_color { "vec3<f32>" } else { "f32" };
                let (member, reason) = (&texture.member, &texture.reason);
                let _ = writeln!(out, "    // {reason}: dapple bake RECIPE --node {name}");
                let _ = writeln!(out, "    {member}: {kind},");
            }
            out += "}\n\n";
        }
        let [data, data_passed] = match self.data.is_empty() {
            true => [""; 2],
            false => [DATA, DATA_PASSED],
        };
        let [textures, textures_passed] = match self.textures.is_empty() {
            true => [""; 2],
            false => ["textures: Textures, ", "textures, "],
        };
        let _ = writeln!(
            out,
            "fn material(place: Place2d, {data}{textures}zero: u32) -> Material {{\n    \
             return material64(position_2d(place), {data_passed}{textures_passed}zero);\n}}\n\n\
             // At a position in numbers of 64 bits\n\
             fn material64(at: Position2d, {data}{textures}zero: u32) -> Material {{"
        );
        out += material;
        out += "}\n\n";
        out + &self.parts()
    }

    /// Writes a field as a function of the position, named `field`.
    pub(super) fn field(
        &mut self,
        write: impl FnOnce(&mut NodeShader<'_, 'a>) -> Result<Code, Refusal>,
    ) -> Result<String, Refusal> {
        let mut scope = Scope::default();
        let value = write(&mut NodeShader {
            writer: self,
            scope: &mut scope,
            node: "field",
        })?;
        let [data, data_passed] = match self.data.is_empty() {
            true => [""; 2],
            false => [DATA, DATA_PASSED],
        };
        let text = format!(
            "// A field of dapple, without bindings and entry points: call `field`.\n//\n\
             // place: position; `place_2d(position)` makes it from a `vec2<f32>`\n\
             // zero: 0, read from a buffer; with a constant, compilers change the last bits\n\n\
             fn field(place: Place2d, {data}zero: u32) -> f32 {{\n    \
             return field64(position_2d(place), {data_passed}zero);\n}}\n\n\
             // At a position in numbers of 64 bits\n\
             fn field64(at: Position2d, {data}zero: u32) -> f32 {{\n{}    return {};\n}}\n\n",
            scope.lines, value.text
        );
        Ok(text + &self.parts() + &self.library())
    }

    /// Returns the modules that the functions use.
    pub(super) fn library(&self) -> String {
        source(&self.modules)
    }

    /// Joins functions and constants.
    fn parts(&self) -> String {
        let mut out = String::new();
        for function in &self.functions {
            out += function;
            out += "\n\n";
        }
        for (value, name) in &self.constants {
            let _ = writeln!(out, "const {name} = {value};");
        }
        if !self.constants.is_empty() {
            out += "\n";
        }
        out
    }

    /// Writes the comment at the beginning.
    fn head(&self) -> String {
        let Recipe {
            name,
            extent,
            wrap,
            material,
            ..
        } = self.recipe;
        let mut out = format!(
            "// Material `{name}` of dapple, without bindings and entry points: call `material`.\n//\n\
             // place: position in units of the plane; `place_2d(position)` makes it from a `vec2<f32>`\n"
        );
        for (axis, axis_name) in ["x", "y"].into_iter().enumerate() {
            if wrap[axis] {
                let period = extent[axis];
                let _ = writeln!(out, "//     repeats every {period} units along {axis_name}");
            }
        }
        if !self.data.is_empty() {
            let rows = self.data.len().div_ceil(MaterialShader::DATA_ROW);
            let _ = writeln!(
                out,
                "// data: texture of the format rgba32uint with 1024 x {rows} texels: `MaterialShader::data`, or the file that\n\
                 //     `dapple recipe NAME --wgsl -o NAME.wgsl` writes as NAME.bin"
            );
        }
        if !self.textures.is_empty() {
            out += "// textures: values of nodes at this position, which a shader reads from baked textures\n";
        }
        out +=
            "// zero: 0, read from a buffer; with a constant, compilers change the last bits\n//\n";
        let relief = material.relief;
        let _ = writeln!(
            out,
            "// A height of 1 is {relief} units of the plane. Colors are linear."
        );
        if let Some(strength) = material.emission_strength {
            let _ = writeln!(out, "// Emitted light is {strength} times the emission.");
        }
        out += "// Values have the bits of the CPU at the position `cell + fraction`.\n";
        out
    }
}

/// Returns the members of the structure `Material`: the name, whether it is a color, and its input.
fn material_members(material: &Material) -> [(&'static str, bool, Input); 8] {
    let or = |input: &Option<Input>, default: Input| input.clone().unwrap_or(default);
    [
        ("height", false, material.height.clone()),
        (
            "albedo",
            true,
            or(&material.albedo, material.height.clone()),
        ),
        ("roughness", false, material.roughness.clone()),
        ("metallic", false, material.metallic.clone()),
        (
            "emission",
            true,
            or(&material.emission, Input::Color(LinearRgb::BLACK)),
        ),
        ("opacity", false, or(&material.opacity, Input::Number(1.0))),
        (
            "specular",
            false,
            or(&material.specular, Input::Number(1.0)),
        ),
        (
            "clearcoat",
            false,
            or(&material.clearcoat, Input::Number(0.0)),
        ),
    ]
}

/// Returns, for each node, its name as a part of identifiers.
fn identifiers(recipe: &Recipe) -> BTreeMap<&str, String> {
    let mut identifiers: BTreeMap<&str, String> = BTreeMap::new();
    for name in recipe.nodes.keys() {
        // Shaders have no hyphens. `a-b` and `a_b` become different names.
        let mut identifier = name.replace('-', "_");
        while identifiers.values().any(|other| *other == identifier) {
            identifier.push('_');
        }
        identifiers.insert(name, identifier);
    }
    identifiers
}
