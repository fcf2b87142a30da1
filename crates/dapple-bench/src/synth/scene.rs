//! Inputs of the synth group: a model, photographs (or drawings that stand in for them), and common options.

use super::drawings::{self, Drawing, draw};
use anyhow::{Result, ensure};
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_image::{Limits, read_image};
use dapple_mesh::Surface;
use dapple_models::bunny;
use dapple_raster::Raster;
use dapple_synth::{
    Coherence, Direction, Edges, Endless, EndlessOptions, Exemplar, HierarchyOptions, Matching,
    Options, PlaneTexture, SurfaceTexture, SynthError, Synthesizer,
};
use glam::DVec3;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Width and height of flat images in pixels.
pub(super) const SIDE: u32 = 512;

/// Number of sites in most rows, equal to the flat image's number of pixels.
pub(super) const N_SITES: usize = 512 * 512;

/// A model's file in memory.
pub(super) struct Model {
    pub(super) obj: Vec<u8>,
    pub(super) directions: Vec<Direction>,
    /// Note that says which model was used.
    pub(super) note: &'static str,
}

/// An exemplar image.
pub(super) struct Picture {
    pub(super) image: Raster<LinearRgb>,
    /// Whether the image is the photograph (true) or the drawing that replaces it.
    pub(super) is_photograph: bool,
}

/// Synthesizes a window of an endless texture, including its setup.
pub(super) fn endless(exemplar: &Exemplar) -> Result<PlaneTexture, SynthError> {
    let texture = Endless::new(exemplar, &EndlessOptions::default())?;
    texture.window([0; 2], [SIDE; 2], |_| ControlFlow::Continue(()))
}

/// Returns the real model if its file exists; otherwise a procedural one.
pub(super) fn model() -> Result<Model> {
    let path = data("meshes/spot.obj");
    #[expect(clippy::disallowed_methods, reason = "the model is not of the library")]
    let found = std::fs::read(&path);
    let direction = |at, vector| Direction { at, vector };
    if let Ok(obj) = found {
        let back = direction(DVec3::new(0.0, 0.3, -0.4), DVec3::NEG_Z);
        return Ok(Model {
            obj,
            directions: vec![back, direction(DVec3::new(0.4, 0.0, 0.3), DVec3::NEG_Y)],
            note: "the model is `spot`, with 5856 triangles",
        });
    }
    let mesh = bunny(6000)?;
    let mut text = String::new();
    for position in mesh.positions() {
        let _ = writeln!(text, "v {} {} {}", position.x, position.y, position.z);
    }
    for face in mesh.faces() {
        let [a, b, c] = face.map(|vertex| vertex.index() + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    Ok(Model {
        obj: text.into_bytes(),
        directions: vec![
            direction(bunny::LEFT_EAR, DVec3::NEG_Y),
            direction(bunny::TAIL, DVec3::NEG_Y),
        ],
        note: "the model is a procedural animal with 6000 triangles",
    })
}

/// Returns the photograph of leaves if its file exists; otherwise a drawing. `side` is its width, 64 or 256 pixels.
pub(super) fn leaves(side: u32) -> Result<Picture> {
    picture(
        &format!("exemplars/leaves_cc0_{side}.png"),
        drawings::scales,
        side,
    )
}

/// Returns a photograph if its file exists; otherwise a drawing of `side` pixels.
pub(super) fn picture(file: &str, drawing: Drawing, side: u32) -> Result<Picture> {
    let path = data(file);
    if !path.is_file() {
        if !file.is_empty() {
            eprintln!("synth: a drawing stands in for {file}, which is skipped");
        }
        return Ok(Picture {
            image: draw(drawing, side)?,
            is_photograph: false,
        });
    }
    let image = read_image(&path, &Limits::default())?.color()?;
    ensure!(
        image.size() == [side; 2],
        "{file} has {:?} pixels",
        image.size()
    );
    Ok(Picture {
        image,
        is_photograph: true,
    })
}

impl Picture {
    /// Returns the exemplar for matching. Its edges are cut: it does not repeat.
    pub(super) fn exemplar(&self) -> Result<Exemplar> {
        Ok(Exemplar::new(&self.image, Edges::Cut)?)
    }

    /// Returns a note that says which exemplar a row uses.
    pub(super) fn note(&self) -> &'static str {
        if self.is_photograph {
            "the exemplar is a photograph of leaves"
        } else {
            "the exemplar is a drawing of scales"
        }
    }
}

/// Returns options for the paper's search: an exact search that compares colors and takes the minimum distance.
pub(super) fn exact(n_levels: usize) -> Options {
    Options {
        n_levels,
        matching: Matching::Colors,
        coherence: Coherence::Factor(0.0),
        evenness: 0.0,
        ..Options::default()
    }
}

/// Returns a synthesizer for the model, with its sites, their directions and their order.
pub(super) fn synthesizer(model: &Model, n_sites: usize, n_levels: usize) -> Result<Synthesizer> {
    let surface = Surface::new(super::whole::read_obj(&model.obj)?)?;
    let sites = HierarchyOptions {
        n_sites,
        n_levels,
        ..HierarchyOptions::default()
    };
    Ok(Synthesizer::new(surface, &model.directions, &sites)?)
}

/// Returns the number of sites of a texture. Fails if a site has no color, or if the texture uses too few pixels of
/// the exemplar.
pub(super) fn count(texture: &SurfaceTexture) -> Result<usize> {
    let mut sources: Vec<[u32; 2]> = texture.sources(0).collect();
    let n_sites = sources.len();
    sources.sort_unstable();
    sources.dedup();
    ensure!(sources.len() > 400, "all is of {} pixels", sources.len());
    let values = texture.values(0);
    ensure!(values.len() == 3 * n_sites, "a site has no color");
    ensure!(
        values.iter().all(|value| (0.0..=1.0).contains(value)),
        "a color is none"
    );
    Ok(n_sites)
}

/// Returns the path of a data file next to the workspace. The file may not exist.
fn data(file: &str) -> PathBuf {
    let crate_dir = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    crate_dir.join("../../../shared/data").join(file)
}
