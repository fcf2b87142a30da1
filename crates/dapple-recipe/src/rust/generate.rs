//! The code of generators: what makes them, and how they are asked.

use super::Printer;
use super::literal::{literal, struct_literal};
use crate::plan::Generator;
use crate::{
    Fractal, FractalBasis, Images, Node, Ramped, RecipeError, WaveletNode, WorleyNode, WorleyValue,
};
use dapple_color::{ColorStop, Interpolation, Outside, RampSpace};
use dapple_worley::{Combination, Metric, Octaves, Scatter};

impl<'a> Printer<'a> {
    /// The value of a node that makes something of nothing but a seed.
    pub(super) fn generator(&mut self, name: &'a str) -> Result<String, RecipeError> {
        let recipe = self.recipe;
        let object = format!("{}_field", self.variables[name].trim_end_matches('_'));
        let is_new = self.made.insert(name);
        let (setup, value) = match &recipe.nodes[name] {
            Node::Worley(node) => self.worley(name, node, &object)?,
            Node::Wavelet(node) => self.wavelet(name, node, &object)?,
            Node::Noise(node) => self.noise(name, node, &object)?,
            Node::Pups(node) => self.pups(name, node, &object)?,
            Node::Coordinate(node) => {
                let [center, along] =
                    [node.center, node.along].map(|part| literal(&glam::DVec2::from(part)));
                return Ok(format!("recipe::coordinate(at, {center}, {along})"));
            }
            Node::Distance(node) => {
                let [center, extent] =
                    [node.center, recipe.extent].map(|part| literal(&glam::DVec2::from(part)));
                return Ok(format!(
                    "recipe::distance(at, {center}, {extent}, {})",
                    literal(&recipe.wrap)
                ));
            }
            _ => return Ok("f32::NAN".to_owned()),
        };
        // Wavelet noise, distances to edges and colors are asked directly.
        let is_direct = [".edge_distance(", "LinearRgb::from("]
            .iter()
            .any(|call| value.contains(call));
        self.needs_field |=
            !is_direct && !setup.starts_with("wavelet::") && !setup.contains("Worley4");
        if is_new {
            self.object(&object, &setup);
        }
        Ok(value)
    }

    fn plan(&self) -> Generator<'a> {
        /// Code needs no images: recipes with some are baked.
        static NONE: Images = Images::new();
        Generator {
            recipe: self.recipe,
            images: &NONE,
            time: 0.0,
        }
    }

    /// The expression of the seed of a node.
    pub(super) fn seed(&self, name: &str, other: Option<&crate::NodeSeed>) -> String {
        match other {
            None => format!("seed.child({name:?}, 0)"),
            Some(crate::NodeSeed::Name(name)) => format!("seed.child({name:?}, 0)"),
            Some(crate::NodeSeed::Seed(seed)) => literal(seed),
        }
    }

    fn worley(
        &self,
        name: &str,
        node: &WorleyNode,
        object: &str,
    ) -> Result<(String, String), RecipeError> {
        let [x, y] = self.plan().periods(node.frequency.0)?;
        let seed = self.seed(name, node.seed.as_ref());
        let mut code = match node.motion {
            None => format!(
                "worley::Worley2::new({seed}).with_period({})?",
                literal(&[x, y])
            ),
            Some(motion) => {
                format!(
                    "worley::Worley4::new({seed}).with_period({})?",
                    literal(&[x, y, None, Some(motion.cells)])
                )
            }
        };
        if node.metric != Metric::default() {
            code += &format!(".with_metric(worley::Metric::{:?})?", node.metric);
        }
        if node.scatter != Scatter::default() {
            code += &format!(".with_scatter(worley::Scatter::{:?})?", node.scatter);
        }
        let at = scaled(node.frequency.0);
        let at = match node.motion {
            None => at,
            Some(motion) => {
                let value = format!("[p.x, p.y, {:?}, 0.0]", motion.z);
                return Ok(self.moving(node, code, object, &at, &value));
            }
        };
        let value = match node.value {
            WorleyValue::Combination(combination) => {
                code += &combined(node, combination);
                format!("{object}.sample({at})")
            }
            WorleyValue::CellValue => {
                code += ".cell_values()";
                format!("{object}.sample({at})")
            }
            WorleyValue::EdgeDistance => format!("{object}.edge_distance({at})"),
        };
        Ok((code, value))
    }

    /// The code of a slice through four dimensions, at the beginning of its loop.
    fn moving(
        &self,
        node: &WorleyNode,
        mut code: String,
        object: &str,
        at: &str,
        place: &str,
    ) -> (String, String) {
        let value = match node.value {
            WorleyValue::Combination(combination) => {
                code += &combined(node, combination);
                format!("{object}.value({place})")
            }
            WorleyValue::CellValue => format!("{object}.sample::<1>({place})[0].cell_value()"),
            WorleyValue::EdgeDistance => format!("{object}.edge_distance({place})"),
        };
        (code, format!("{{ let p: DVec2 = {at}; {value} }}"))
    }

    fn wavelet(
        &self,
        name: &str,
        node: &WaveletNode,
        object: &str,
    ) -> Result<(String, String), RecipeError> {
        let seed = self.seed(name, node.seed.as_ref());
        let code = self.wavelet_noise(&seed, node.frequency, &node.weights)?;
        Ok((
            code,
            format!("{object}.sample({})", scaled([node.frequency; 2])),
        ))
    }

    fn wavelet_noise(
        &self,
        seed: &str,
        frequency: f64,
        weights: &[f32],
    ) -> Result<String, RecipeError> {
        let [width, height] = self.plan().wavelet_cells(frequency)?;
        let new = if width == height {
            format!("new({width}, {seed})")
        } else {
            format!("of_size([{width}, {height}], {seed})")
        };
        Ok(format!(
            "wavelet::WaveletNoise2::{new}?.with_weights(&{})?",
            literal(&weights.to_vec()).replace("vec!", "")
        ))
    }

    fn noise(
        &self,
        name: &str,
        node: &Fractal,
        object: &str,
    ) -> Result<(String, String), RecipeError> {
        let seed = self.seed(name, node.seed.as_ref());
        match node.basis {
            FractalBasis::Pups => {
                let options = self.plan().fractal_options(node);
                let code = format!(
                    "pups::octaves(&{}, {seed})?.normalized()",
                    super::pups::octaves(&options)
                );
                Ok((code, format!("{object}.sample(at)")))
            }
            FractalBasis::Wavelet => {
                let code =
                    self.wavelet_noise(&seed, node.frequency, &Generator::fractal_weights(node))?;
                let at = scaled([node.frequency; 2]);
                Ok((
                    code,
                    format!("(0.5 + {object}.sample({at})).clamp(0.0, 1.0)"),
                ))
            }
        }
    }
}

/// The position times a frequency.
fn scaled(frequency: [f64; 2]) -> String {
    if frequency == [1.0; 2] {
        return "at".to_owned();
    }
    format!("at * {}", literal(&glam::DVec2::from(frequency)))
}

/// The calls that make a scalar texture of a basis.
fn combined(node: &WorleyNode, combination: Combination) -> String {
    let mut code = format!(".combine({})", combination_literal(combination));
    if let Some(octaves) = node.octaves {
        code += &format!(".fractal({})?", octaves_literal(&octaves));
    }
    if let Some(range) = node.range {
        code += &format!(".with_range({})?", literal(&range));
    }
    code
}

fn combination_literal(combination: Combination) -> String {
    const CONSTANTS: [&str; 11] = [
        "F1",
        "F2",
        "F3",
        "F4",
        "F2_MINUS_F1",
        "F1_PLUS_F2",
        "F3_MINUS_F1",
        "F3_MINUS_F2",
        "F4_MINUS_F1",
        "F4_MINUS_F3",
        "TWO_F3_MINUS_F2_MINUS_F1",
    ];
    let named = Combination::NAMED
        .iter()
        .position(|&(_, named)| named == combination);
    match named {
        Some(index) => format!("worley::Combination::{}", CONSTANTS[index]),
        None => format!(
            "worley::Combination::new({})",
            literal(&combination.coefficients())
        ),
    }
}

fn octaves_literal(octaves: &Octaves) -> String {
    let mut code = struct_literal!(
        "worley::Octaves",
        octaves,
        Octaves::default(),
        [count, lacunarity, gain]
    );
    if octaves.seeds != Octaves::default().seeds {
        let seeds = format!("seeds: worley::OctaveSeeds::{:?}", octaves.seeds);
        code = match code.strip_suffix("::default()") {
            Some(name) if !code.contains('{') => {
                format!("{name} {{ {seeds}, ..{name}::default() }}")
            }
            _ => code.replacen("{ ", &format!("{{ {seeds}, "), 1),
        };
    }
    code
}

/// The code of a ramp.
pub(super) fn ramp(node: &Ramped) -> String {
    let mut code = match node.palette {
        Some(palette) => format!("color::Palette::{palette:?}.ramp()"),
        None if node.positions.is_empty() => {
            format!(
                "color::ColorRamp::even(&{})?",
                literal(&node.colors).replacen("vec!", "", 1)
            )
        }
        None => {
            let stop = |(&position, &color): (&f32, &dapple_color::LinearRgb)| {
                let ColorStop { position, color } = ColorStop { position, color };
                format!(
                    "color::ColorStop {{ position: {position:?}, color: {} }}",
                    literal(&color)
                )
            };
            let stops: Vec<_> = node.positions.iter().zip(&node.colors).map(stop).collect();
            format!("color::ColorRamp::new([{}])?", stops.join(", "))
        }
    };
    if node.space != RampSpace::default() {
        code += &format!(".with_space(color::RampSpace::{:?})", node.space);
    }
    if node.interpolation != Interpolation::Linear {
        code += &format!(
            ".with_interpolation(color::Interpolation::{:?})",
            node.interpolation
        );
    }
    if node.outside != Outside::Clamp {
        code += &format!(".with_outside(color::Outside::{:?})", node.outside);
    }
    code
}
