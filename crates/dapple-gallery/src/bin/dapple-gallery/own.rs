//! Renders a mesh and an exemplar provided by the user (`--mesh`).
#![expect(clippy::disallowed_methods, reason = "files are read and written here")]

use crate::say;
use anyhow::{Context, Result};
use dapple_gallery::{Own, Picture};
use dapple_image::{Depth, Limits, read_image, write_color_png};
use dapple_mesh_io::{read_model, write_model};
use dapple_synth::{Coherence, Direction, Edges, HierarchyOptions};
use std::fs;
use std::path::{Path, PathBuf};

/// The arguments for `--mesh`: a mesh, the exemplar for its texture, and the synthesis options.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OwnArguments {
    /// Path of the mesh file, in any supported format.
    pub(crate) mesh: PathBuf,
    /// Path of the exemplar image (PNG, JPEG) that the texture is synthesized from.
    pub(crate) exemplar: PathBuf,
    /// Whether the exemplar tiles.
    pub(crate) tiles: bool,
    /// Path of a file with the directions in which the exemplar's downward axis points, as lines `x,y,z,dx,dy,dz`. If
    /// it is `None`, the direction is -y everywhere.
    pub(crate) directions: Option<PathBuf>,
    /// Number of points on the mesh that get a color.
    pub(crate) points: usize,
    /// Number of levels of points; 4 suits large features.
    pub(crate) levels: usize,
    /// Tolerance for worse matches that continue their neighbors. The paper uses 0.
    pub(crate) coherence: Coherence,
}

/// Renders the mesh from four sides and writes it with its texture map.
pub(crate) fn run(arguments: &OwnArguments, size: u32, out: &Path) -> Result<()> {
    let text = arguments.directions.as_ref().map(fs::read_to_string);
    let directions = text.transpose()?.unwrap_or_default();
    let own = Own {
        mesh: read_model(&arguments.mesh)?.mesh,
        image: read_image(&arguments.exemplar, &Limits::default())?.color()?,
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
