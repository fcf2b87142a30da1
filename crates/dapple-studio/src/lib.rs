//! The back end of the recipe editor: the messages between a page and the studio, a page's session and renderer, and
//! the local server.
//!
//! The document is the text of a recipe, in TOML. A [`Document`] holds this text together with the parsed recipe or its
//! errors. An [`Op`] is a small edit to the recipe, and [`apply`] carries it out as a small edit to the text. A
//! [`Graph`] lists the nodes and the inputs of each. A [`Session`] holds the state of one page, and a [`Renderer`]
//! renders the images that the page shows. None of these uses files, sockets or threads. Only [`serve`] does, behind
//! the feature `server`.
//!
//! ```
//! use dapple_studio::{Document, Op, apply};
//!
//! let text = "dapple = 1 # the first\nseed = 7\n\n[material]\nheight = 0.25 # low\n";
//! let op = Op::Set { path: vec!["material".into(), "height".into()], value: 0.75.into() };
//! let text = apply(text, &[op])?;
//! assert_eq!(text, "dapple = 1 # the first\nseed = 7\n\n[material]\nheight = 0.75 # low\n");
//! assert!(Document::new(text).recipe().is_ok());
//! # Ok::<(), dapple_studio::StudioError>(())
//! ```
#![forbid(unsafe_code)]

mod change;
mod code;
mod data;
mod diagnose;
mod document;
mod error;
mod graph;
mod message;
mod patch;
mod picture;
mod points;
mod render;
mod sample;
mod schema;
mod seams;
#[cfg(feature = "server")]
mod server;
mod session;
mod strip;
mod task;
mod utf16;

pub use change::Change;
pub use diagnose::Diagnostic;
pub use document::Document;
pub use error::StudioError;
pub use graph::Graph;
pub use message::{
    Area, CodeKind, Exact, Export, FileSize, Hello, MapSeams, Mode, Named, NodeTime, Output, Reply,
    Request, Shape, View,
};
pub use patch::{Op, Part, apply};
pub use picture::{Picture, Shown, rgba};
pub use render::{Job, Lit, MAX_SIDE, RenderHost, Renderer, map_kinds};
pub use sample::sample;
#[cfg(feature = "server")]
pub use server::{ExportedFile, Host, ServeOptions, has_page, page_licenses, serve};
pub use session::{ImagesOf, Session};
pub use strip::Variant;
pub use task::{ExportOf, Task};
