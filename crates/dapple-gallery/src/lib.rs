//! Renders the figures of the papers, one file each, and the page that shows them.
//!
//! A [`Figure`] is a small file under `src/figures/<paper>/fig_<number>.rs`. Its header is the caption, and its body
//! renders the images with the public API of the crates, in code short enough to learn from. [`papers`] lists all
//! figures. The library renders figures in memory ([`Figure::render`]), hashes them ([`Figure::hash`]), compares the
//! hashes with `figures.lock` ([`Lock`]) and writes the page as a string ([`page`]). The binary `dapple-gallery`,
//! which `cargo xtask gallery` runs, writes the files for a browser.
//!
//! **Adding a figure** takes three steps:
//!
//! 1. write `src/figures/<paper>/fig_<number>.rs` with `pub(super) const FIGURE: Figure` (copy a neighbor);
//! 2. add its `mod` and its `FIGURE` to `src/figures/<paper>.rs`;
//! 3. run `cargo xtask gallery --bless`, look at the image, and commit both files and `figures.lock`.
//!
//! ```
//! use dapple_gallery::{LOCK_SIZE, figures};
//!
//! let cells = figures().find(|figure| figure.name() == "worley-fig-01").ok_or("no such figure")?;
//! let panels = cells.render(LOCK_SIZE)?;
//! assert_eq!(panels[0].size(), [LOCK_SIZE; 2]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`docs`] renders the small images that the crates show in their documentation and READMEs.
//!
//! Figures are deterministic: they have the same bits on every machine and for any number of threads.

#![forbid(unsafe_code)]

mod figure;
mod figures;
mod panel;

pub mod docs;
pub mod draw;
pub mod lock;
pub mod page;

pub use figure::{Figure, Paper, Source};
pub use figures::{figures, papers, select};
pub use lock::{LOCK_SIZE, Lock};
pub use panel::{Panel, Picture};
