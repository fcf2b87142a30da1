//! Messages between a page and the studio. They are JSON objects with a `type`; pictures are bytes.

use crate::render::{MAX_SIDE, MAX_TILE};
use crate::schema::Kind;
use crate::{Change, Diagnostic, Graph, Op, Picture, StudioError};
use dapple::recipe::MapKind;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
use std::sync::OnceLock;

/// A message of a page.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Request {
    /// Another recipe: one of the three.
    Open {
        /// A built-in one.
        builtin: Option<String>,
        /// A file in the folder.
        file: Option<String>,
        /// A text of one's own.
        text: Option<String>,
    },
    /// The whole text after a change.
    Doc {
        /// Counts the states of the text.
        rev: u64,
        /// The text.
        text: String,
    },
    /// A small change of the recipe.
    Patch {
        /// The state of the text that it belongs to.
        rev: u64,
        /// The changes, one after the other.
        ops: Vec<Op>,
        /// Whether it is a part of a drag.
        #[serde(default)]
        drag: bool,
    },
    /// The pictures that the page shows.
    View(View),
    /// A picture has been drawn, so that the next one of the map may come.
    Ack {
        /// The generation of the picture.
        generation: u32,
        /// The number of the map.
        map: u16,
    },
    /// Asks for seam reports of the maps.
    Seams {
        /// Columns and rows of the tile.
        size: [u32; 2],
    },
    /// Small pictures of the built-in recipes and of those in the folder, when there is time.
    Gallery {
        /// The longer side of a picture, in pixels.
        size: u32,
    },
    /// A row of small pictures of what changes would make of the recipe, when there is time; the last one asked for counts.
    Strip {
        /// The node that is shown; the material in light by default.
        node: Option<String>,
        /// The changes of each picture.
        changes: Vec<Vec<Op>>,
        /// The longer side of a picture, in pixels.
        size: u32,
    },
    /// The control points of a node.
    Points {
        /// The node.
        node: String,
    },
    /// The recipe as a program, or as text.
    Code {
        /// The language.
        kind: CodeKind,
        /// Columns and rows of the tile.
        size: Option<[u32; 2]>,
        /// The names of the maps.
        maps: Option<Vec<String>>,
    },
    /// The files that a bake makes.
    Export(Export),
    /// Stops the exports that the page has asked for.
    Stop,
    /// Writes the recipe into its folder.
    Save {
        /// The text.
        text: String,
        /// The name of the file.
        file: String,
        /// Whether a file that has changed is replaced.
        #[serde(default)]
        overwrite: bool,
        /// The hash of the file when it was read; none for a new file.
        seen: Option<String>,
    },
}

/// The pictures that a page shows.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct View {
    /// Columns and rows of the whole tile.
    pub size: [u32; 2],
    /// The names of the maps.
    pub maps: Vec<String>,
    /// The part of the tile; all of it by default.
    pub region: Option<Area>,
    /// The node whose picture is wanted in place of maps.
    pub node: Option<String>,
    /// The part of a loop that has passed, from 0 to 1.
    pub time: f64,
    /// Whether a small picture is wanted first.
    pub draft: bool,
    /// Whether a small picture of each node is wanted.
    pub thumbnails: bool,
    /// Whether nothing is to be drawn.
    pub paused: bool,
    /// A lit preview, made exactly.
    pub exact: Option<Exact>,
}

impl Default for View {
    fn default() -> Self {
        Self {
            size: [512; 2],
            maps: vec![MapKind::Albedo.name().to_owned()],
            region: None,
            node: None,
            time: 0.0,
            draft: true,
            thumbnails: false,
            paused: true,
            exact: None,
        }
    }
}

/// A part of a picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Area {
    /// The first column and row.
    pub first: [u32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

/// A lit preview.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exact {
    /// The shape that the material is on.
    pub shape: Shape,
}

/// The shape that a material is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A plane of 2 x 2 tiles.
    Plane,
    /// A ball.
    Sphere,
    /// A ring.
    Torus,
}

/// The languages in which a recipe can be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CodeKind {
    /// The text itself.
    Toml,
    /// JSON.
    Json,
    /// A Rust program.
    Rust,
    /// A Python program.
    Python,
    /// A command line of `dapple bake`.
    Command,
}

/// The files of a bake.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Export {
    /// Columns and rows of the tile.
    pub size: Option<[u32; 2]>,
    /// The names of the maps; not beside `preset`.
    pub maps: Option<Vec<String>>,
    /// The program that the files are for.
    pub preset: Option<String>,
    /// The format, such as `png8`; not beside `preset`.
    pub format: Option<String>,
    /// Where green points in normal maps.
    pub normal_y: Option<String>,
    /// The number of the picture of a loop, from 1, and how many there are.
    pub frame: Option<[u32; 2]>,
}

/// A message of the studio.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Reply {
    /// The first message: the recipes, nodes and maps that this program has.
    Hello(Box<Hello>),
    /// A recipe that was opened.
    Document {
        /// The state of the text: 0.
        rev: u64,
        /// The text.
        text: String,
        /// The name of the recipe.
        name: String,
        /// The file, if it is one.
        file: Option<String>,
        /// The hash of the file.
        hash: Option<String>,
    },
    /// A change of the text.
    Edits {
        /// The new state of the text.
        rev: u64,
        /// The changes of the text before, sorted.
        changes: Vec<Change>,
        /// Whether it is a part of a drag.
        drag: bool,
    },
    /// A change was not made, since the text is in another state.
    Stale {
        /// The state of the text here.
        rev: u64,
    },
    /// The mistakes of the recipe; none if all is well.
    Diagnostics {
        /// The state of the text.
        rev: u64,
        /// The mistakes.
        items: Vec<Diagnostic>,
    },
    /// The nodes of a recipe.
    Graph {
        /// The state of the text.
        rev: u64,
        /// The graph.
        #[serde(flatten)]
        graph: Graph,
    },
    /// The data of a recipe, as it is written.
    Values {
        /// The state of the text.
        rev: u64,
        /// The data.
        recipe: Json,
    },
    /// Pictures of a generation follow.
    Began {
        /// The generation.
        generation: u32,
        /// Columns and rows of the whole tile.
        size: [u32; 2],
        /// The part of the tile, if it is not all of it.
        region: Option<Area>,
        /// The node, if it is not the maps.
        node: Option<String>,
        /// The part of a loop that has passed.
        time: f64,
        /// Whether a small picture may come first.
        draft: bool,
    },
    /// All pictures of a generation have been made.
    Rendered {
        /// The generation.
        generation: u32,
        /// The state of the text.
        rev: u64,
        /// The time that drawing took, in milliseconds.
        ms: f64,
        /// Whether larger pictures follow.
        draft: bool,
        /// The nodes with how long the thumbnail of each took, if there are any.
        nodes: Option<Vec<NodeTime>>,
    },
    /// Seam reports of the maps.
    Seams {
        /// The reports.
        maps: Vec<MapSeams>,
    },
    /// The control points of a node.
    Points(Box<Points>),
    /// A program or a text.
    Code {
        /// The language.
        kind: CodeKind,
        /// The text.
        text: String,
    },
    /// Files that were made.
    Exported {
        /// The name under which they lie.
        id: String,
        /// The files.
        files: Vec<FileSize>,
    },
    /// A recipe was written.
    Saved {
        /// The file.
        file: String,
        /// Its hash.
        hash: String,
    },
    /// The file has changed.
    Disk {
        /// Its new text.
        text: String,
        /// Its hash.
        hash: String,
        /// Its name.
        file: String,
    },
    /// Something was refused.
    Refused {
        /// The type of the request.
        what: String,
        /// The reason, as a sentence.
        message: String,
        /// A way around it.
        hint: Option<String>,
        /// A word by which a program knows it: `changed_on_disk`.
        reason: Option<&'static str>,
    },
}

impl Reply {
    /// A refusal of a request of this type.
    #[must_use]
    pub fn refused(what: &str, error: &StudioError) -> Self {
        Self::Refused {
            what: what.to_owned(),
            message: error.to_string(),
            hint: error.hint().map(str::to_owned),
            reason: error.reason(),
        }
    }
}

/// The recipes, kinds of nodes, maps and presets that a program has.
#[derive(Clone, Debug, Serialize)]
pub struct Hello {
    version: &'static str,
    /// What the page may do.
    pub mode: Mode,
    builtins: Vec<Named>,
    /// Recipes in the folder.
    pub(crate) files: Vec<String>,
    schema: &'static Json,
    kinds: Vec<Kind>,
    maps: Vec<Named>,
    pub(crate) presets: Vec<Named>,
    limits: Limits,
    pub(crate) open: Option<String>,
}

/// The rights of a page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// Everything.
    #[default]
    Studio,
    /// Look at a file that is changed elsewhere.
    Watch,
    /// Everything but files.
    Static,
}

/// Something with a name and a sentence about it.
#[derive(Clone, Debug, Serialize)]
pub struct Named {
    /// The name.
    pub name: String,
    /// A sentence.
    pub about: String,
}

/// Limits of what a page may ask for.
#[derive(Clone, Debug, Serialize)]
struct Limits {
    /// The longest side of a picture.
    size: u32,
    /// The longest side of a tile of which a part is shown.
    whole: u32,
}

impl Hello {
    /// The greeting of this program, which is made once.
    #[must_use]
    pub fn new() -> Self {
        static HELLO: OnceLock<Hello> = OnceLock::new();
        HELLO.get_or_init(Self::made).clone()
    }

    fn made() -> Self {
        let builtin = |name: &'static str| Named {
            name: name.to_owned(),
            about: dapple::recipe::Recipe::builtin(name)
                .map(|recipe| recipe.about)
                .unwrap_or_default(),
        };
        let map = |kind: &MapKind| Named {
            name: kind.name().to_owned(),
            about: about(*kind).to_owned(),
        };
        Self {
            version: env!("CARGO_PKG_VERSION"),
            mode: Mode::Studio,
            builtins: dapple::recipe::Recipe::builtin_names()
                .map(builtin)
                .collect(),
            files: Vec::new(),
            schema: crate::schema::schema(),
            kinds: crate::schema::kinds(),
            maps: MapKind::ALL.iter().map(map).collect(),
            presets: Vec::new(),
            limits: Limits {
                size: MAX_SIDE,
                whole: MAX_TILE,
            },
            open: None,
        }
    }
}

impl Default for Hello {
    fn default() -> Self {
        Self::new()
    }
}

/// A sentence about a map.
fn about(kind: MapKind) -> &'static str {
    match kind {
        MapKind::Height => "How high the surface is",
        MapKind::Normal => "Where the surface points",
        MapKind::Occlusion => "How much of the sky a place sees: ambient occlusion",
        MapKind::Curvature => "Edges light, grooves dark",
        MapKind::Albedo => "The color",
        MapKind::Roughness => "Black is a mirror, white is chalk",
        MapKind::Metallic => "White is metal",
        MapKind::Orm => "Occlusion, roughness and metallic as red, green and blue",
        _ => "",
    }
}

/// The time that the thumbnail of a node took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NodeTime {
    /// The node.
    pub name: String,
    /// Milliseconds for its thumbnail, without what it is made of.
    pub ms: f64,
    /// The numbers that are black and white in its thumbnail; none for colors.
    pub range: Option<[f32; 2]>,
}

/// The seam report of a map.
#[derive(Clone, Debug, Serialize)]
pub struct MapSeams {
    /// The map.
    pub name: String,
    /// The report as a table.
    pub text: String,
}

/// The control points of a node.
#[derive(Clone, Debug, Serialize)]
pub struct Points {
    pub(crate) node: String,
    /// Whether the points are in the text.
    pub(crate) editable: bool,
    /// Whether the op `make_points` can put them there.
    pub(crate) can_be_editable: bool,
    /// The number of nets of points that the texture has; the points are those of the coarsest.
    pub(crate) layers: usize,
    pub(crate) extent: [f64; 2],
    pub(crate) wrap: [bool; 2],
    /// The points, each with its value, and with its label if it has one.
    pub(crate) points: Vec<dapple::recipe::ControlPoint>,
    /// The values of labels; none where points have no labels.
    pub(crate) values: Vec<f32>,
    /// The indices of two points, and the way from the first to the second, each edge once.
    pub(crate) edges: Vec<(u32, u32, f64, f64)>,
}

/// A file and its length.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FileSize {
    /// Its name.
    pub name: String,
    /// Its bytes.
    pub bytes: usize,
}

/// A message or a picture for a page.
#[derive(Clone, Debug)]
pub enum Output {
    /// A message.
    Reply(Reply),
    /// A picture.
    Picture(Picture),
}

impl From<Reply> for Output {
    fn from(reply: Reply) -> Self {
        Self::Reply(reply)
    }
}
