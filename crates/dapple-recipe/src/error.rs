//! Errors from reading, planning and baking recipes.

use crate::RendererError;
use crate::words::similar_words;
use core::fmt;
use dapple_color::ColorError;
use dapple_pattern::PatternError;
use dapple_pups::PupsError;
use dapple_raster::{Range, RasterError};
use dapple_synth::SynthError;
use dapple_tile::TileError;
use dapple_wavelet::WaveletError;
use dapple_worley::WorleyError;

/// An error in a recipe, with its position in the text or its node, and the nearest valid word.
///
/// Programs match on [`kind`](Self::kind); the message is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct RecipeError {
    /// Boxed, so that results are small.
    content: Box<Content>,
}

#[derive(Clone, Debug, PartialEq)]
struct Content {
    kind: RecipeErrorKind,
    place: Option<Place>,
    node: Option<String>,
    nearest: Option<String>,
}

/// A position in the text of a recipe. Line and column count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Line number, starting at 1.
    pub line: usize,
    /// Position in the line, in characters, starting at 1.
    pub column: usize,
}

/// The cause of a [`RecipeError`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RecipeErrorKind {
    /// The text is not valid TOML or JSON, or contains a key or value that recipes do not have.
    Text {
        /// The message of the parser.
        message: String,
    },
    /// The recipe has a schema version that this crate does not read.
    Schema {
        /// The recipe's schema version.
        version: u32,
    },
    /// No built-in recipe has this name.
    UnknownRecipe {
        /// The requested name of a recipe.
        name: String,
    },
    /// An option refers to a parameter that the recipe does not have.
    UnknownParameter {
        /// The name of the parameter.
        name: String,
        /// The path of the option, such as `nodes.cells.worley.frequency`.
        option: String,
    },
    /// No option refers to a parameter.
    UnusedParameter {
        /// The name of the parameter.
        name: String,
    },
    /// The value of a parameter does not fit an option.
    Parameter {
        /// The name of the parameter.
        name: String,
        /// The path of the option.
        option: String,
        /// The reason why the value does not fit.
        message: String,
    },
    /// No node has this name.
    UnknownNode {
        /// The unknown name.
        name: String,
    },
    /// The name of a node or a parameter does not begin with a letter, or has characters other than letters, digits, `_` and `-`.
    Name {
        /// The invalid name.
        name: String,
    },
    /// A node depends on itself, directly or through other nodes.
    Cycle {
        /// The names of the nodes on the cycle.
        names: Vec<String>,
    },
    /// The number of nodes or other items is out of range.
    Count {
        /// Name of the counted items, for the message.
        what: &'static str,
        /// The actual number of items.
        count: usize,
        /// The allowed number, as text.
        needed: &'static str,
    },
    /// An input is a color, but a number is needed.
    NotANumber {
        /// The input as written in the recipe.
        input: String,
    },
    /// A number is out of range.
    Range {
        /// Name of the quantity, for the message.
        what: &'static str,
        /// The value that is out of range.
        value: f64,
        /// The allowed range, as text.
        range: &'static str,
    },
    /// The recipe, up to this node, exceeds a limit on work: see [`PlanLimits`](crate::PlanLimits).
    TooMuch {
        /// Name of the counted items, for the message.
        what: &'static str,
        /// The estimated number of items.
        value: f64,
        /// The largest allowed number.
        limit: u64,
    },
    /// Two options exclude each other, or one option requires another.
    Conflict {
        /// The rule, as a sentence without a full stop.
        rule: &'static str,
    },
    /// A node has no value of this name.
    UnknownOutput {
        /// The unknown name of a value.
        value: String,
        /// The names of the node's values.
        outputs: &'static [&'static str],
    },
    /// An `output` node needs a node with several values.
    SingleOutput {
        /// The node with a single value, as written in the recipe.
        node: String,
        /// The kinds of nodes with several values.
        kinds: Vec<&'static str>,
    },
    /// An image was not passed with the recipe.
    NoImage {
        /// The name of the file.
        file: String,
    },
    /// A node depends on the whole tile, but only a part of it is available.
    Global {
        /// The operation that has only a part of the tile, as the end of a sentence.
        during: &'static str,
    },
    /// No shader computes some nodes.
    NotInShader {
        /// For each node, its name and the reason as a phrase.
        nodes: Vec<(String, String)>,
    },
    /// The caller's progress callback asked to stop.
    Cancelled,
    /// An error from the cellular basis.
    Worley(WorleyError),
    /// An error from a partition-of-unity texture.
    Pups(PupsError),
    /// An error from wavelet noise.
    Wavelet(WaveletError),
    /// An error from a pattern.
    Pattern(PatternError),
    /// An error from a tiling or blending method.
    Tile(TileError),
    /// An error from a synthesis.
    Synth(SynthError),
    /// An error from a color ramp or a map.
    Color(ColorError),
    /// An error from a raster or a window.
    Raster(RasterError),
    /// An error from the plan's renderer.
    Renderer(RendererError),
}

impl RecipeError {
    pub(crate) fn new(kind: RecipeErrorKind) -> Self {
        let content = Content {
            kind,
            place: None,
            node: None,
            nearest: None,
        };
        Self {
            content: Box::new(content),
        }
    }

    /// Returns a [`Range`](RecipeErrorKind::Range) error unless `holds`.
    pub(crate) fn check(
        holds: bool,
        what: &'static str,
        value: f64,
        range: &'static str,
    ) -> Result<(), Self> {
        if holds {
            Ok(())
        } else {
            Err(Self::new(RecipeErrorKind::Range { what, value, range }))
        }
    }

    /// Returns a [`Range`](RecipeErrorKind::Range) error if `value` is out of range.
    pub(crate) fn check_in(range: Range, what: &'static str, value: f64) -> Result<(), Self> {
        Self::check(range.holds(value), what, value, range.text)
    }

    /// Sets the error's position in the text.
    pub(crate) fn at(mut self, place: Option<Place>) -> Self {
        self.content.place = place;
        self
    }

    /// Sets the name of the node that contains the error, unless one is set already.
    pub(crate) fn within(mut self, node: &str) -> Self {
        self.content.node.get_or_insert_with(|| node.to_owned());
        self
    }

    /// Sets the suggestion: the word of `valid` that is nearest to `written`, if one is similar enough.
    pub(crate) fn meant<'a>(
        mut self,
        written: &str,
        valid: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let near = similar_words(written, valid).into_iter().next();
        self.content.nearest = near.map(str::to_owned);
        self
    }

    /// Returns the cause of the error.
    #[must_use]
    pub fn kind(&self) -> &RecipeErrorKind {
        &self.content.kind
    }

    /// Returns the position in the text, if known.
    #[must_use]
    pub fn place(&self) -> Option<Place> {
        self.content.place
    }

    /// Returns the name of the node that contains the error, if any.
    #[must_use]
    pub fn node(&self) -> Option<&str> {
        self.content.node.as_deref()
    }

    /// Returns the valid word that is nearest to the written word, if one is similar.
    #[must_use]
    pub fn nearest(&self) -> Option<&str> {
        self.content.nearest.as_deref()
    }
}

impl fmt::Display for RecipeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(Place { line, column }) = self.content.place {
            write!(f, "line {line}, column {column}: ")?;
        }
        if let Some(node) = &self.content.node {
            write!(f, "in the node `{node}`: ")?;
        }
        write!(f, "{}", self.content.kind)?;
        if let Some(nearest) = &self.content.nearest {
            write!(f, "; did you mean `{nearest}`?")?;
        }
        Ok(())
    }
}

impl fmt::Display for RecipeErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text { message } => f.write_str(message),
            Self::Schema { version } => write!(
                f,
                "the recipe is written in version {version} of the schema, but this program knows version {}",
                crate::SCHEMA
            ),
            Self::UnknownRecipe { name } => write!(f, "there is no built-in recipe `{name}`"),
            Self::UnknownParameter { .. }
            | Self::UnusedParameter { .. }
            | Self::Parameter { .. } => of_parameter(self, f),
            Self::UnknownNode { name } => write!(f, "there is no node `{name}`"),
            Self::Name { name } => {
                write!(
                    f,
                    "the name `{name}` is not made of letters, digits, `_` and `-`, beginning with a letter"
                )
            }
            Self::Cycle { names } => {
                write!(f, "nodes are made of themselves: {}", names.join(" of "))
            }
            Self::Count {
                what,
                count,
                needed,
            } => write!(f, "there are {count} {what}, but {needed} are needed"),
            Self::NotANumber { input } => write!(f, "{input} is a color, but a number is needed"),
            Self::Range { what, value, range } => {
                write!(f, "the {what} is {value}, but it must be {range}")
            }
            // Write large numbers in exponential form, which is shorter.
            Self::TooMuch { what, value, limit } if *value >= 1e15 => {
                write!(
                    f,
                    "there would be about {value:.1e} {what}, but the limit is {limit}"
                )
            }
            Self::TooMuch { what, value, limit } => {
                write!(
                    f,
                    "there would be about {value:.0} {what}, but the limit is {limit}"
                )
            }
            Self::Conflict { rule } => f.write_str(rule),
            Self::UnknownOutput { value, outputs } => {
                let outputs = outputs.join(", ");
                write!(f, "the node has no value `{value}`, but {outputs}")
            }
            Self::SingleOutput { node, kinds } => {
                let kinds = kinds.join(", ");
                write!(
                    f,
                    "{node} has a single value; nodes with several are {kinds}"
                )
            }
            Self::NoImage { file } => write!(f, "there is no image `{file}`"),
            Self::Global { during } => {
                write!(f, "it sees the whole tile, which is not at hand {during}")
            }
            Self::NotInShader { nodes } => not_in_shader(nodes, f),
            Self::Cancelled => f.write_str("the callback asked to stop"),
            Self::Worley(error) => error.fmt(f),
            Self::Pups(error) => error.fmt(f),
            Self::Wavelet(error) => error.fmt(f),
            Self::Pattern(error) => error.fmt(f),
            Self::Tile(error) => error.fmt(f),
            Self::Synth(error) => error.fmt(f),
            Self::Color(error) => error.fmt(f),
            Self::Raster(error) => error.fmt(f),
            Self::Renderer(error) => error.fmt(f),
        }
    }
}

/// Formats an error of the kinds that name a parameter.
fn of_parameter(kind: &RecipeErrorKind, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    match kind {
        RecipeErrorKind::UnknownParameter { name, option } => {
            write!(
                f,
                "there is no parameter `{name}`, which `{option}` refers to"
            )
        }
        RecipeErrorKind::UnusedParameter { name } => {
            write!(
                f,
                "no option refers to the parameter `{name}`, written as \"${name}\""
            )
        }
        RecipeErrorKind::Parameter {
            name,
            option,
            message,
        } => write!(
            f,
            "the parameter `{name}` does not fit `{option}`: {message}"
        ),
        _ => Ok(()),
    }
}

/// Lists the nodes without a shader, one on each line.
fn not_in_shader(nodes: &[(String, String)], f: &mut fmt::Formatter<'_>) -> fmt::Result {
    f.write_str("no shader computes these nodes, which can be baked to textures:")?;
    for (name, reason) in nodes {
        write!(f, "\n  `{name}`: {reason}")?;
    }
    Ok(())
}

impl core::error::Error for RecipeError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self.kind() {
            RecipeErrorKind::Worley(error) => Some(error),
            RecipeErrorKind::Pups(error) => Some(error),
            RecipeErrorKind::Wavelet(error) => Some(error),
            RecipeErrorKind::Pattern(error) => Some(error),
            RecipeErrorKind::Tile(error) => Some(error),
            RecipeErrorKind::Synth(error) => Some(error),
            RecipeErrorKind::Color(error) => Some(error),
            RecipeErrorKind::Raster(error) => Some(error),
            RecipeErrorKind::Renderer(error) => Some(error.get_ref()),
            _ => None,
        }
    }
}

/// Implements the conversion from errors of other crates.
macro_rules! from {
    ($($error:ident => $kind:ident),*) => {
        $(impl From<$error> for RecipeError {
            fn from(error: $error) -> Self {
                Self::new(RecipeErrorKind::$kind(error))
            }
        })*
    };
}

from!(WorleyError => Worley, PatternError => Pattern, PupsError => Pups, WaveletError => Wavelet, TileError => Tile, SynthError => Synth, ColorError => Color, RasterError => Raster, RendererError => Renderer);
