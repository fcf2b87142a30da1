//! Why a recipe was refused.

use crate::words::similar_words;
use core::fmt;
use dapple_color::ColorError;
use dapple_pups::{PupsError, Range};
use dapple_raster::RasterError;
use dapple_tile::TileError;
use dapple_wavelet::WaveletError;
use dapple_worley::WorleyError;

/// Why a recipe was refused, where in its text, and what was perhaps meant.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct RecipeError {
    /// In a box, so that results are small where all is well.
    content: Box<Content>,
}

#[derive(Clone, Debug, PartialEq)]
struct Content {
    kind: RecipeErrorKind,
    place: Option<Place>,
    node: Option<String>,
    nearest: Option<String>,
}

/// A place in the text of a recipe, both counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The line.
    pub line: usize,
    /// The character in the line.
    pub column: usize,
}

/// The reason why a recipe was refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RecipeErrorKind {
    /// The text is no TOML or JSON, or says something that a recipe does not have.
    Text {
        /// The message of the reader.
        message: String,
    },
    /// The recipe has another version of the schema than this crate.
    Schema {
        /// The version of the recipe.
        version: u32,
    },
    /// No built-in recipe has this name.
    UnknownRecipe {
        /// The name.
        name: String,
    },
    /// No node has this name.
    UnknownNode {
        /// The name.
        name: String,
    },
    /// A name of a node is not made of letters, digits, `_` and `-`.
    Name {
        /// The name.
        name: String,
    },
    /// A node is, in the end, made of itself.
    Cycle {
        /// The names on the way round.
        names: Vec<String>,
    },
    /// There are more nodes than the limit, or more of something else.
    Count {
        /// The things that were counted.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        needed: &'static str,
    },
    /// A color is where a number is needed.
    NotANumber {
        /// The input, as it is written.
        input: String,
    },
    /// A number is outside of its range.
    Range {
        /// The name of the number.
        what: &'static str,
        /// The number.
        value: f64,
        /// The range it must lie in, as text.
        range: &'static str,
    },
    /// The recipe, up to this node, asks for more work than the limits allow: see [`PlanLimits`](crate::PlanLimits).
    TooMuch {
        /// The things of which there would be too many.
        what: &'static str,
        /// About how much there would be.
        value: f64,
        /// How much there may be.
        limit: u64,
    },
    /// Two things that exclude each other, or one that needs another.
    Conflict {
        /// The rule, as a sentence without a full stop.
        rule: &'static str,
    },
    /// An image was not given to the recipe.
    NoImage {
        /// Its name.
        file: String,
    },
    /// A node sees the whole tile, where only a part of it is at hand.
    Global {
        /// The circumstance, as the end of a sentence.
        during: &'static str,
    },
    /// The basis of cells was refused.
    Worley(WorleyError),
    /// A partition of unity was refused.
    Pups(PupsError),
    /// Wavelet noise was refused.
    Wavelet(WaveletError),
    /// A method that makes images repeat, or blends them, refused.
    Tile(TileError),
    /// A ramp or a map was refused.
    Color(ColorError),
    /// A raster or a window was refused.
    Raster(RasterError),
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

    /// Refuses a number outside of its range.
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

    /// Refuses a number outside of a range.
    pub(crate) fn check_in(range: Range, what: &'static str, value: f64) -> Result<(), Self> {
        Self::check(range.holds(value), what, value, range.text)
    }

    /// This error, at a place of the text.
    pub(crate) fn at(mut self, place: Option<Place>) -> Self {
        self.content.place = place;
        self
    }

    /// This error, in a node.
    pub(crate) fn within(mut self, node: &str) -> Self {
        self.content.node.get_or_insert_with(|| node.to_owned());
        self
    }

    /// This error, with the valid word that is nearest to the written one, if one is near.
    pub(crate) fn meant<'a>(
        mut self,
        written: &str,
        valid: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let near = similar_words(written, valid).into_iter().next();
        self.content.nearest = near.map(str::to_owned);
        self
    }

    /// The reason.
    #[must_use]
    pub fn kind(&self) -> &RecipeErrorKind {
        &self.content.kind
    }

    /// Where in the text, if that is known.
    #[must_use]
    pub fn place(&self) -> Option<Place> {
        self.content.place
    }

    /// In which node, if it is in one.
    #[must_use]
    pub fn node(&self) -> Option<&str> {
        self.content.node.as_deref()
    }

    /// The valid word that is nearest to what was written, if one is near.
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
            // Past that, a number would be nothing but digits.
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
            Self::NoImage { file } => write!(f, "there is no image `{file}`"),
            Self::Global { during } => {
                write!(f, "it sees the whole tile, which is not at hand {during}")
            }
            Self::Worley(error) => error.fmt(f),
            Self::Pups(error) => error.fmt(f),
            Self::Wavelet(error) => error.fmt(f),
            Self::Tile(error) => error.fmt(f),
            Self::Color(error) => error.fmt(f),
            Self::Raster(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for RecipeError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self.kind() {
            RecipeErrorKind::Worley(error) => Some(error),
            RecipeErrorKind::Pups(error) => Some(error),
            RecipeErrorKind::Wavelet(error) => Some(error),
            RecipeErrorKind::Tile(error) => Some(error),
            RecipeErrorKind::Color(error) => Some(error),
            RecipeErrorKind::Raster(error) => Some(error),
            _ => None,
        }
    }
}

/// Makes the errors of other crates into recipe errors.
macro_rules! from {
    ($($error:ident => $kind:ident),*) => {
        $(impl From<$error> for RecipeError {
            fn from(error: $error) -> Self {
                Self::new(RecipeErrorKind::$kind(error))
            }
        })*
    };
}

from!(WorleyError => Worley, PupsError => Pups, WaveletError => Wavelet, TileError => Tile, ColorError => Color, RasterError => Raster);
