//! Messages between a page and the studio. Messages are JSON objects with a `type`; images are sent as bytes.

use crate::render::{MAX_SIDE, MAX_TILE};
use crate::schema::Kind;
use crate::{Change, Diagnostic, Graph, Op, Picture, StudioError};
use dapple::recipe::{MapKind, Material};
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
use std::sync::OnceLock;

/// A message from a page.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Request {
    /// Opens another recipe. Exactly one of the three fields must be set.
    Open {
        /// The name of a built-in recipe.
        builtin: Option<String>,
        /// The name of a file in the folder.
        file: Option<String>,
        /// The text of a recipe.
        text: Option<String>,
    },
    /// The whole text after a change.
    Doc {
        /// The text's revision number, counted by the page.
        rev: u64,
        /// The whole text of the recipe.
        text: String,
    },
    /// A small edit to the recipe.
    Patch {
        /// Revision of the text that the edit applies to.
        rev: u64,
        /// The edits, applied in order.
        ops: Vec<Op>,
        /// Whether the edit is part of a drag gesture, such as moving a slider.
        #[serde(default)]
        drag: bool,
    },
    /// The images that the page shows.
    View(View),
    /// Acknowledges an image, which releases the next image of the map.
    Ack {
        /// Generation of the image, as in [`Picture::generation`](crate::Picture::generation).
        generation: u32,
        /// The code of the map, see [`Shown::code`](crate::Shown::code).
        map: u16,
    },
    /// Requests seam reports of the maps.
    Seams {
        /// Columns and rows of the tile.
        size: [u32; 2],
    },
    /// Requests thumbnails of the built-in recipes and of the recipes in the folder, rendered at low priority.
    Gallery {
        /// A thumbnail's longer side, in pixels.
        size: u32,
    },
    /// Requests a strip of thumbnails that show the effect of edits, rendered at low priority. A new strip replaces
    /// the previous one.
    Strip {
        /// The node to show. Default: the lit material.
        node: Option<String>,
        /// The edits of each thumbnail.
        changes: Vec<Vec<Op>>,
        /// A thumbnail's longer side, in pixels.
        size: u32,
    },
    /// Requests the control points of a node.
    Points {
        /// Name of the node.
        node: String,
    },
    /// Requests the recipe as a program or as text.
    Code {
        /// The language of the program or text.
        kind: CodeKind,
        /// Columns and rows of the tile.
        size: Option<[u32; 2]>,
        /// The names of the maps.
        maps: Option<Vec<String>>,
    },
    /// Requests an export: the files of a bake.
    Export(Export),
    /// Stops all exports of the page.
    Stop,
    /// Writes the recipe into its folder.
    Save {
        /// Text of the recipe.
        text: String,
        /// Name of the file in the recipe's folder.
        file: String,
        /// Whether to replace a file that has changed on disk.
        #[serde(default)]
        overwrite: bool,
        /// The file's hash when it was read; `None` for a new file.
        seen: Option<String>,
    },
}

/// The images that a page shows.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct View {
    /// Columns and rows of the whole tile.
    pub size: [u32; 2],
    /// The names of the maps.
    pub maps: Vec<String>,
    /// The visible part of the tile. Default: the whole tile.
    pub region: Option<Area>,
    /// The node to show instead of maps.
    pub node: Option<String>,
    /// Phase of the looping animation, from 0 to 1.
    pub time: f64,
    /// Whether to send a draft (a smaller image) first.
    pub draft: bool,
    /// Whether to send a thumbnail of each node.
    pub thumbnails: bool,
    /// Whether rendering is paused.
    pub paused: bool,
    /// The lit preview to render on the CPU, if any.
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

/// A rectangle of an image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Area {
    /// The first column and row.
    pub first: [u32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

/// A lit preview, rendered on the CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exact {
    /// The shape that carries the material.
    pub shape: Shape,
}

/// A shape that carries a material in a lit preview.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A plane of 2 x 2 tiles.
    Plane,
    /// A sphere.
    Sphere,
    /// A torus.
    Torus,
}

/// The languages in which a recipe can be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CodeKind {
    /// TOML, the text itself.
    Toml,
    /// JSON.
    Json,
    /// A Rust program.
    Rust,
    /// A Python program.
    Python,
    /// A command line of `dapple bake`.
    Command,
    /// The material as a function of WGSL.
    Wgsl,
}

/// Options for an export, which bakes the recipe to files.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Export {
    /// Columns and rows of the tile.
    pub size: Option<[u32; 2]>,
    /// The names of the maps. Not allowed together with `preset`.
    pub maps: Option<Vec<String>>,
    /// The program that will read the files.
    pub preset: Option<String>,
    /// The format, such as `png8`. Not allowed together with `preset`.
    pub format: Option<String>,
    /// The direction of the green channel of normal maps.
    pub normal_y: Option<String>,
    /// The frame of a looping animation to export, as its number, starting at 1, and the number of frames.
    pub frame: Option<[u32; 2]>,
    /// Number of frames of a looping animation; all of them are exported.
    pub frames: Option<u32>,
    /// Subfolder of the recipe's folder, to which the files are written. By default, they are only offered for
    /// download.
    pub folder: Option<String>,
    /// Whether to replace existing files in the folder.
    pub overwrite: bool,
}

/// A message from the studio.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Reply {
    /// The first message: the recipes, nodes and maps that this program offers.
    Hello(Box<Hello>),
    /// A recipe that was opened.
    Document {
        /// Revision of the text, always 0.
        rev: u64,
        /// Text of the recipe.
        text: String,
        /// The name of the recipe.
        name: String,
        /// The name of the file, if the recipe was opened from one.
        file: Option<String>,
        /// The hash of the file.
        hash: Option<String>,
    },
    /// An edit to the text.
    Edits {
        /// The revision of the text after the edit.
        rev: u64,
        /// The changes, sorted by position in the text before the edit.
        changes: Vec<Change>,
        /// Whether the edit is part of a drag gesture, such as moving a slider.
        drag: bool,
    },
    /// An edit was rejected because the text is at another revision.
    Stale {
        /// The current revision of the text.
        rev: u64,
    },
    /// The errors in the recipe. The list is empty for a valid recipe.
    Diagnostics {
        /// Revision of the text.
        rev: u64,
        /// The errors; empty if the recipe is valid.
        items: Vec<Diagnostic>,
    },
    /// The nodes of a recipe.
    Graph {
        /// Revision of the text.
        rev: u64,
        /// The nodes and their inputs.
        #[serde(flatten)]
        graph: Graph,
    },
    /// The data of a recipe as written.
    Values {
        /// Revision of the text.
        rev: u64,
        /// The recipe as JSON.
        recipe: Json,
        /// The names of the parameters, in the order of the text.
        parameters: Vec<String>,
    },
    /// Announces that the images of a new generation follow.
    Began {
        /// Number of the generation, counted by the session.
        generation: u32,
        /// Columns and rows of the whole tile.
        size: [u32; 2],
        /// The rectangle that is rendered; `None` for the whole tile.
        region: Option<Area>,
        /// The node that is rendered; `None` for maps.
        node: Option<String>,
        /// Phase of the looping animation, from 0 to 1.
        time: f64,
        /// Whether drafts may precede the images.
        draft: bool,
    },
    /// All images of a generation, or all drafts of it, have been sent.
    Rendered {
        /// Number of the generation.
        generation: u32,
        /// Revision of the text.
        rev: u64,
        /// Rendering time, in milliseconds.
        ms: f64,
        /// Whether images of full size follow.
        draft: bool,
        /// The nodes with the rendering times of their thumbnails; `None` if no thumbnails were requested.
        nodes: Option<Vec<NodeTime>>,
    },
    /// Seam reports of the maps.
    Seams {
        /// The reports, one per map.
        maps: Vec<MapSeams>,
    },
    /// The control points of a node.
    Points(Box<Points>),
    /// The recipe as a program or as text.
    Code {
        /// The language of the program or text.
        kind: CodeKind,
        /// The program or text.
        text: String,
    },
    /// The files of a finished export.
    Exported {
        /// The id of the export, the first part of the download addresses.
        id: String,
        /// Names and lengths of the files.
        files: Vec<FileSize>,
    },
    /// A recipe was written.
    Saved {
        /// Name of the file.
        file: String,
        /// The hash of the file.
        hash: String,
    },
    /// The open file has changed on disk.
    Disk {
        /// Its new text.
        text: String,
        /// The hash of the file.
        hash: String,
        /// Name of the file.
        file: String,
    },
    /// A request was refused.
    Refused {
        /// The type of the refused request, such as `save`.
        what: String,
        /// The reason, as a sentence.
        message: String,
        /// How to avoid the error.
        hint: Option<String>,
        /// A reason code for programs, such as `changed_on_disk`.
        reason: Option<&'static str>,
    },
}

impl Reply {
    /// Creates the refusal for a request of type `what`.
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

/// The recipes, node kinds, maps and presets that this program offers.
#[derive(Clone, Debug, Serialize)]
pub struct Hello {
    version: &'static str,
    /// The rights of the page.
    pub mode: Mode,
    builtins: Vec<Builtin>,
    /// The names of the recipes in the folder.
    pub(crate) files: Vec<String>,
    schema: &'static Json,
    kinds: Vec<Kind>,
    maps: Vec<Named>,
    /// The names of the maps that a material may lack.
    optional_maps: Vec<&'static str>,
    pub(crate) presets: Vec<Named>,
    limits: Limits,
    pub(crate) open: Option<String>,
}

/// The rights of a page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// All requests are allowed.
    #[default]
    Studio,
    /// The page shows a file that is edited elsewhere and cannot save.
    Watch,
    /// The page has no access to files.
    Static,
}

/// A name with a one-sentence description.
#[derive(Clone, Debug, Serialize)]
pub struct Named {
    /// The name of the recipe, map or preset.
    pub name: String,
    /// The description, one sentence.
    pub about: String,
}

/// A built-in recipe. Its tags are words for searching.
#[derive(Clone, Debug, Serialize)]
struct Builtin {
    #[serde(flatten)]
    named: Named,
    tags: Vec<String>,
}

/// Limits on the requests of a page.
#[derive(Clone, Debug, Serialize)]
struct Limits {
    /// Maximum side of an image, in pixels.
    size: u32,
    /// Maximum side of a tile that is shown in part, in pixels.
    whole: u32,
}

impl Hello {
    /// Returns the greeting of this program, which is built once and cached.
    #[must_use]
    pub fn new() -> Self {
        static HELLO: OnceLock<Hello> = OnceLock::new();
        HELLO.get_or_init(Self::made).clone()
    }

    fn made() -> Self {
        let builtin = |name: &'static str| {
            let recipe = dapple::recipe::Recipe::builtin(name);
            let (about, tags) = recipe
                .map(|recipe| (recipe.about, recipe.tags))
                .unwrap_or_default();
            let name = name.to_owned();
            Builtin {
                named: Named { name, about },
                tags,
            }
        };
        let map = |kind: &MapKind| Named {
            name: kind.name().to_owned(),
            about: about(*kind).to_owned(),
        };
        let material = Material::default();
        let optional = MapKind::ALL.iter().filter(|kind| !material.has(**kind));
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
            optional_maps: optional.map(|kind| kind.name()).collect(),
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

/// Returns a one-sentence description of a map.
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
        MapKind::Emission => "The light that it emits",
        MapKind::Opacity => "Black is transparent, white is opaque",
        MapKind::Specular => "How much nonmetals reflect",
        MapKind::Clearcoat => "White has a clear coat, such as varnish",
        _ => "",
    }
}

/// The rendering time of a node's thumbnail.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NodeTime {
    /// Name of the node.
    pub name: String,
    /// Rendering time of the thumbnail in milliseconds, without the node's inputs.
    pub ms: f64,
    /// The values shown as black and white; `None` for colors.
    pub range: Option<[f32; 2]>,
}

/// The seam report of a map.
#[derive(Clone, Debug, Serialize)]
pub struct MapSeams {
    /// Name of the map.
    pub name: String,
    /// The report as a table.
    pub text: String,
}

/// The control points of a node.
#[derive(Clone, Debug, Serialize)]
pub struct Points {
    pub(crate) node: String,
    /// Whether the points are part of the text.
    pub(crate) editable: bool,
    /// Whether the edit [`Op::MakePoints`] can write the points into the text.
    pub(crate) can_be_editable: bool,
    /// Number of layers of points in the texture. `points` belong to the coarsest layer.
    pub(crate) layers: usize,
    pub(crate) extent: [f64; 2],
    pub(crate) wrap: [bool; 2],
    /// The points with their values, and their labels if they have any.
    pub(crate) points: Vec<dapple::recipe::ControlPoint>,
    /// The values of the labels. Empty if the points have no labels.
    pub(crate) values: Vec<f32>,
    /// The edges, each listed once: the indices of two points, and the vector from the first to the second.
    pub(crate) edges: Vec<(u32, u32, f64, f64)>,
}

/// A file and its length.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FileSize {
    /// Name of the file.
    pub name: String,
    /// Length of the file, in bytes.
    pub bytes: usize,
}

/// A message or an image for a page.
#[derive(Clone, Debug)]
pub enum Output {
    /// A message.
    Reply(Reply),
    /// An image.
    Picture(Picture),
}

impl From<Reply> for Output {
    fn from(reply: Reply) -> Self {
        Self::Reply(reply)
    }
}
