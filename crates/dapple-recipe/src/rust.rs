//! Recipes as Rust code: what makes the same numbers without the recipe.
//!
//! The code makes each generator once and then evaluates the nodes one after the other at a position, as a plan does, with
//! the same operations in the same order, so that it has the same bits. A warp is a block in which the position is another.
//! Recipes with images, or with nodes that see the whole tile, have no value at a single position; their code holds the
//! recipe and bakes it.

mod fallback;
mod generate;
mod literal;
mod pups;

use crate::plan::order;
use crate::{Input, Node, Recipe, RecipeError, Warp};
use literal::literal;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

impl Recipe {
    /// Rust code that gives the same material, bit for bit, with the crate `dapple` alone.
    ///
    /// It has a function `material`, whose result is a function of the position: the height, the color, the roughness and
    /// the metalness there. Where a node needs images or sees the whole tile, it has a function `bake` instead.
    ///
    /// # Errors
    ///
    /// What is wrong with names and circles, as [`Plan::new`](crate::Plan::new) tells it.
    pub fn to_rust(&self) -> Result<String, RecipeError> {
        let order = order(self)?;
        if !order.iter().all(|name| is_local(&self.nodes[*name])) {
            return fallback::code(self);
        }
        let mut printer = Printer::new(self, &order);
        let body = printer.body()?;
        Ok(printer.file(&body))
    }
}

/// Whether a node has a value at a single position, without an image.
fn is_local(node: &Node) -> bool {
    let is_whole = matches!(
        node,
        Node::Tile(_)
            | Node::Disturb(_)
            | Node::MatchBorders(_)
            | Node::CornerTiles(_)
            | Node::BlendMap(_)
            | Node::Blend(_)
    );
    node.image_file().is_none() && !is_whole
}

/// What is known while code is printed.
struct Printer<'a> {
    recipe: &'a Recipe,
    /// The variables of the nodes.
    variables: BTreeMap<&'a str, String>,
    colors: BTreeSet<&'a str>,
    /// The statements that make generators, and the nodes that have one.
    setup: String,
    made: BTreeSet<&'a str>,
    /// Whether a generator is asked through the trait `Field`.
    needs_field: bool,
    /// How many ramps were made.
    n_ramps: u32,
}

/// Statements at one position.
struct Scope<'a> {
    code: String,
    indent: usize,
    known: BTreeSet<&'a str>,
}

impl<'a> Printer<'a> {
    fn new(recipe: &'a Recipe, order: &[&'a str]) -> Self {
        let mut printer = Self {
            recipe,
            variables: BTreeMap::new(),
            colors: BTreeSet::new(),
            setup: String::new(),
            made: BTreeSet::new(),
            needs_field: false,
            n_ramps: 0,
        };
        for &name in order {
            let variable = printer.variable(name);
            printer.variables.insert(name, variable);
            if printer.makes_color(&recipe.nodes[name]) {
                printer.colors.insert(name);
            }
        }
        printer
    }

    /// A variable for a node, unlike all others.
    fn variable(&self, name: &str) -> String {
        let mut variable = name.replace('-', "_").to_ascii_lowercase();
        let taken = ["at", "seed"];
        while KEYWORDS.contains(&variable.as_str())
            || taken.contains(&variable.as_str())
            || self.variables.values().any(|other| *other == variable)
        {
            variable.push('_');
        }
        variable
    }

    fn makes_color(&self, node: &Node) -> bool {
        match node {
            Node::Color(_) | Node::Ramp(_) | Node::Pups(crate::PupsNode::ColorNoise(_)) => true,
            Node::Warp(warp) => self.is_color(&warp.input),
            Node::Add(_) | Node::Multiply(_) | Node::Mix(_) => {
                node.inputs().into_iter().any(|input| self.is_color(input))
            }
            _ => false,
        }
    }

    fn is_color(&self, input: &Input) -> bool {
        match input {
            Input::Number(_) => false,
            Input::Color(_) => true,
            Input::Node(name) => self.colors.contains(name.as_str()),
        }
    }

    /// The statements of the function of a position, and its result.
    fn body(&mut self) -> Result<String, RecipeError> {
        let recipe = self.recipe;
        let material = &recipe.material;
        let mut scope = Scope {
            code: String::new(),
            indent: 2,
            known: BTreeSet::new(),
        };
        let height = self.number(&material.height, &mut scope)?;
        let albedo = self.color(
            material.albedo.as_ref().unwrap_or(&material.height),
            &mut scope,
        )?;
        let roughness = self.number(&material.roughness, &mut scope)?;
        let metallic = self.number(&material.metallic, &mut scope)?;
        scope.line("Surface {");
        for (field, value) in [
            ("height", height),
            ("albedo", albedo),
            ("roughness", roughness),
            ("metallic", metallic),
        ] {
            // As a field of the same name is written.
            let is_short = field == value;
            scope.line(&if is_short {
                format!("    {field},")
            } else {
                format!("    {field}: {value},")
            });
        }
        scope.line("}");
        Ok(scope.code)
    }

    /// The expression of an input that is a number.
    fn number(&mut self, input: &'a Input, scope: &mut Scope<'a>) -> Result<String, RecipeError> {
        if self.is_color(input) {
            return Err(crate::plan::not_a_number(input));
        }
        self.any(input, scope)
    }

    /// The expression of an input as a color; a number is a gray.
    fn color(&mut self, input: &'a Input, scope: &mut Scope<'a>) -> Result<String, RecipeError> {
        let any = self.any(input, scope)?;
        Ok(if self.is_color(input) {
            any
        } else {
            format!("LinearRgb::gray({any})")
        })
    }

    /// The expression of an input, after the statements that it needs.
    fn any(&mut self, input: &'a Input, scope: &mut Scope<'a>) -> Result<String, RecipeError> {
        match input {
            Input::Number(number) => Ok(literal(&(*number as f32))),
            Input::Color(color) => Ok(literal(color)),
            Input::Node(name) => {
                if !self.recipe.nodes.contains_key(name) {
                    return Err(crate::plan::unknown(self.recipe, name));
                }
                if scope.known.insert(name) {
                    self.statement(name, scope)?;
                }
                Ok(self.variables[name.as_str()].clone())
            }
        }
    }

    /// The statement that gives a node its value.
    fn statement(&mut self, name: &'a str, scope: &mut Scope<'a>) -> Result<(), RecipeError> {
        let value = self.value(name, scope)?;
        let variable = &self.variables[name];
        let kind = if self.colors.contains(name) {
            "LinearRgb"
        } else {
            "f32"
        };
        scope.line(&format!("let {variable}: {kind} = {value};"));
        Ok(())
    }

    /// The expression of a node's value, after the statements that it needs.
    fn value(&mut self, name: &'a str, scope: &mut Scope<'a>) -> Result<String, RecipeError> {
        let recipe = self.recipe;
        match &recipe.nodes[name] {
            Node::Warp(warp) => self.warp(warp, scope),
            Node::Color(color) => Ok(literal(color)),
            node => match self.operation(node, scope)? {
                Some(value) => Ok(value),
                None => self.generator(name),
            },
        }
    }

    /// A block in which the position is another.
    fn warp(&mut self, warp: &'a Warp, scope: &mut Scope<'a>) -> Result<String, RecipeError> {
        let [x, y] = [self.shift(&warp.x, scope)?, self.shift(&warp.y, scope)?];
        let mut inner = Scope {
            code: String::new(),
            indent: scope.indent + 1,
            known: BTreeSet::new(),
        };
        let shift = format!("DVec2::new({x}, {y})");
        inner.line(&format!(
            "let at = at + {} * {shift};",
            literal(&warp.amount)
        ));
        let last = match &warp.input {
            Input::Node(input) if self.recipe.nodes.contains_key(input) => {
                self.value(input, &mut inner)?
            }
            input => self.any(input, &mut inner)?,
        };
        inner.line(&last);
        Ok(format!(
            "{{\n{}{}}}",
            inner.code,
            "    ".repeat(scope.indent)
        ))
    }

    /// The expression of a part of a shift, in double precision.
    fn shift(&mut self, input: &'a Input, scope: &mut Scope<'a>) -> Result<String, RecipeError> {
        match input {
            Input::Number(number) => Ok(literal(&f64::from(*number as f32))),
            input => Ok(format!("f64::from({})", self.number(input, scope)?)),
        }
    }

    /// The value of a node that works on each position alone; none for generators.
    fn operation(
        &mut self,
        node: &'a Node,
        scope: &mut Scope<'a>,
    ) -> Result<Option<String>, RecipeError> {
        let is_color = self.makes_color(node);
        let mut inputs = Vec::new();
        for (index, input) in node.inputs().into_iter().enumerate() {
            let may_be_color = matches!(node, Node::Add(_) | Node::Multiply(_))
                || (matches!(node, Node::Mix(_)) && index < 2);
            inputs.push(if is_color && may_be_color {
                self.color(input, scope)?
            } else {
                self.number(input, scope)?
            });
        }
        let call = |function: &str| format!("{function}({})", inputs.join(", "));
        let folded = |function: &str| {
            let first = inputs.first().cloned().unwrap_or_default();
            inputs.iter().skip(1).fold(first, |all, next| {
                format!("recipe::{function}({all}, {next})")
            })
        };
        Ok(Some(match node {
            Node::Add(_) => inputs.join(" + "),
            Node::Subtract(_) => inputs.join(" - "),
            Node::Multiply(_) if is_color => folded("multiply_colors"),
            Node::Multiply(_) => inputs.join(" * "),
            Node::Divide(_) => call("recipe::quotient"),
            Node::Minimum(_) => folded("minimum"),
            Node::Maximum(_) => folded("maximum"),
            Node::Absolute(_) => format!("{}.abs()", inputs[0]),
            Node::Power(power) => {
                format!("recipe::power({}, {})", inputs[0], literal(&power.exponent))
            }
            Node::Wave(wave) => format!(
                "recipe::wave({}, {}, {}, recipe::Waveform::{:?})",
                inputs[0],
                literal(&wave.frequency),
                literal(&wave.phase),
                wave.form
            ),
            Node::Levels(levels) => format!(
                "recipe::levels({}, {}, {}, recipe::LevelsCurve::{:?})",
                inputs[0],
                literal(&levels.from),
                literal(&levels.to),
                levels.curve
            ),
            Node::Profile(profile) => {
                format!("worley::Profile::{:?}.height({})", profile.shape, inputs[0])
            }
            Node::Mix(_) if is_color => call("recipe::mix_colors"),
            Node::Mix(_) => call("recipe::mix"),
            Node::Ramp(ramp) => {
                self.n_ramps += 1;
                let object = format!("ramp_{}", self.n_ramps);
                self.object(&object, &generate::ramp(ramp));
                format!("{object}.at({})", inputs[0])
            }
            _ => return Ok(None),
        }))
    }

    /// Puts a statement that makes something before the function of a position.
    fn object(&mut self, variable: &str, value: &str) {
        let _ = writeln!(self.setup, "    let {variable} = {value};");
    }

    /// The whole file.
    fn file(&self, body: &str) -> String {
        let recipe = self.recipe;
        let code = format!("{}{body}", self.setup);
        let mut uses = String::from("use dapple::color::{self, LinearRgb};\n");
        for module in ["graph", "points", "pups", "recipe", "wavelet", "worley"] {
            if code.contains(&format!("{module}::")) {
                let _ = writeln!(uses, "use dapple::{module};");
            }
        }
        if !code.contains("color::") {
            uses = uses.replace("color::{self, LinearRgb}", "color::LinearRgb");
        }
        if code.contains("Seed(") || code.contains("seed.") {
            uses += "use dapple::hash::Seed;\n";
        }
        if self.needs_field {
            uses += "use dapple::raster::Field as _;\n";
        }
        uses += "use dapple::raster::glam::DVec2;\n";
        let seed = if code.contains("seed.") {
            format!("    let seed = {};\n", literal(&recipe.seed))
        } else {
            String::new()
        };
        let at = if code.contains("(at") || code.contains("at +") || code.contains("at *") {
            "at"
        } else {
            "_at"
        };
        let [width, height] = recipe.extent;
        let title = if recipe.name.is_empty() {
            "A material"
        } else {
            &recipe.name
        };
        let about = if recipe.about.is_empty() {
            String::new()
        } else {
            format!("//! {}\n//!\n", recipe.about.replace('\n', " "))
        };
        format!(
            "//! {title}.\n//!\n{about}//! The tile is {width} × {height} units of the plane. Made from a recipe; needs the crate `dapple`.\n\n{uses}\n{SURFACE}\n/// The material at every position of the plane.\n///\n/// # Errors\n///\n/// If a number of the recipe is out of its range.\npub fn material()\n-> Result<impl Fn(DVec2) -> Surface + Send + Sync, Box<dyn std::error::Error + Send + Sync>> {{\n{seed}{}    Ok(move |{at}: DVec2| {{\n{body}    }})\n}}\n",
            self.setup
        )
    }
}

const SURFACE: &str = "\
/// What a material is at a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The height, from 0 to 1 where the recipe keeps to it.
    pub height: f32,
    /// The color, linear.
    pub albedo: LinearRgb,
    /// From 0, a mirror, to 1, chalk.
    pub roughness: f32,
    /// From 0, no metal, to 1, all metal.
    pub metallic: f32,
}
";

/// Words that are no variables.
const KEYWORDS: [&str; 44] = [
    "as", "async", "await", "box", "break", "const", "continue", "crate", "do", "dyn", "else",
    "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop",
    "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return", "self",
    "static", "struct", "super", "trait", "true", "try", "type", "unsafe", "use", "where",
];

impl<'a> Scope<'a> {
    fn line(&mut self, line: &str) {
        let _ = writeln!(self.code, "{}{line}", "    ".repeat(self.indent));
    }
}

#[cfg(test)]
mod tests;
