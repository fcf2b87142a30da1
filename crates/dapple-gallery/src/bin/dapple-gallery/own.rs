//! A mesh and an exemplar of the user's own.
#![expect(clippy::disallowed_methods, reason = "files are read and written here")]

use crate::say;
use anyhow::{Context, Result};
use clap::Args;
use dapple_gallery::{Own, Picture};
use dapple_image::{Depth, Limits, read_image, write_color_png};
use dapple_synth::mesh::HierarchyOptions;
use dapple_synth::mesh::io::{read_model, write_model};
use dapple_synth::{Coherence, Direction, Edges};
use std::fs;
use std::path::{Path, PathBuf};

/// What is put on what.
#[derive(Debug, Args)]
pub(crate) struct OwnArguments {
    /// Renders a mesh of your own (OBJ, PLY, GLB, OFF) with the texture of `--exemplar`.
    #[arg(long, value_name = "FILE", requires = "exemplar")]
    pub(crate) mesh: Option<PathBuf>,

    /// The image (PNG, JPEG) that the texture is synthesized from.
    #[arg(long, value_name = "FILE", requires = "mesh")]
    exemplar: Option<PathBuf>,

    /// The exemplar tiles.
    #[arg(long, requires = "mesh")]
    tiles: bool,

    /// Directions of the texture's down, as lines `x,y,z,dx,dy,dz`; without any it runs along -y.
    #[arg(long, value_name = "FILE", requires = "mesh")]
    directions: Option<PathBuf>,

    /// How many points get a color.
    #[arg(long, value_name = "N", default_value_t = 262_144, requires = "mesh")]
    points: usize,

    /// How many levels the points have: 4 for large features.
    #[arg(long, value_name = "N", default_value_t = 3, requires = "mesh")]
    levels: usize,

    /// How much worse a match may be that continues its neighbors; 0 as in the paper.
    #[arg(long, value_name = "auto|K", default_value = "auto", requires = "mesh")]
    coherence: Coherence,
}

/// Renders the mesh from four sides and writes it with its texture map.
pub(crate) fn run(arguments: &OwnArguments, size: u32, out: &Path) -> Result<()> {
    let path = |path: &Option<PathBuf>| path.clone().context("the file is not named");
    let (mesh, exemplar) = (path(&arguments.mesh)?, path(&arguments.exemplar)?);
    let text = arguments.directions.as_ref().map(fs::read_to_string);
    let directions = text.transpose()?.unwrap_or_default();
    let own = Own {
        mesh: read_model(mesh)?.mesh,
        image: read_image(exemplar, &Limits::default())?.color()?,
        edges: if arguments.tiles {
            Edges::Wrap
        } else {
            Edges::Cut
        },
        directions: Direction::parse_csv(&directions)?,
        sites: HierarchyOptions {
            n_sites: arguments.points,
            n_levels: arguments.levels,
            ..HierarchyOptions::default()
        },
        coherence: arguments.coherence,
        map_side: 2048,
    };
    let textured = own.render(size)?;
    if !textured.mended.is_empty() {
        say(&format!("the mesh was mended\n{}", textured.mended));
    }
    fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    for panel in &textured.panels {
        if let Picture::Color(picture) = &panel.picture {
            let file = out.join(format!("own-{}.png", panel.label));
            write_color_png(file, picture, Depth::Eight)?;
        }
    }
    let file = out.join("own.glb");
    write_model(&file, &textured.model)?;
    say(&format!("four pictures and own.glb in {}", out.display()));
    Ok(())
}
