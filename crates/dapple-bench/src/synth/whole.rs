//! The whole run: a model as a file in memory in, its texture map as a file out.

use super::scene::{self, Model, N_SITES};
use anyhow::{Context as _, Result};
use dapple_image::{Transfer, encode_png};
use dapple_mesh::Mesh;
use dapple_synth::{Atlas, Exemplar, Options, bake};
use glam::DVec3;

/// The side of the texture map.
const MAP_SIDE: u32 = 2048;

/// What a whole run makes.
#[derive(Debug, PartialEq)]
pub(super) struct Written {
    /// The file with the texture map.
    pub(super) png: Vec<u8>,
    /// The part of the map that shows a face.
    pub(super) coverage: f64,
}

/// Reads a model, covers it with a texture, bakes that, and writes the map.
pub(super) fn run(model: &Model, exemplar: &Exemplar, options: &Options) -> Result<Written> {
    let synthesizer = scene::synthesizer(model, N_SITES, options.n_levels)?;
    let texture = synthesizer.synthesize(exemplar, options)?;
    let surface = synthesizer.surface();
    let atlas = Atlas::uniform(surface, MAP_SIDE)?;
    let values = texture.values(0);
    let map = bake::<3>(surface, synthesizer.hierarchy(), values, &atlas, [0.0; 3])?;
    let code = |value: f32| (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let codes = map.map(|values| values.map(code));
    Ok(Written {
        png: encode_png(codes.view(), Transfer::Srgb)?,
        coverage: atlas.coverage(),
    })
}

/// The mesh of an OBJ file: its positions, and its faces as fans.
pub(super) fn read_obj(bytes: &[u8]) -> Result<Mesh> {
    let text = str::from_utf8(bytes)?;
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let mut part = || {
                    words
                        .next()
                        .context("a position has three parts")?
                        .parse::<f64>()
                        .context("a part")
                };
                positions.push(DVec3::new(part()?, part()?, part()?));
            }
            Some("f") => {
                let index = |word: &str| word.split('/').next().unwrap_or_default().parse::<u32>();
                let corners: Vec<u32> = words.map(index).collect::<Result<_, _>>()?;
                let corner = |at: usize| corners[at].wrapping_sub(1);
                let fan = 2..corners.len();
                faces.extend(fan.map(|last| [corner(0), corner(last - 1), corner(last)]));
            }
            _ => {}
        }
    }
    let (mesh, _) = Mesh::new(positions, &faces)?.repair();
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::read_obj;

    #[test]
    fn read_obj_makes_fans_of_faces() {
        let text = "# a pyramid\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nvt 0 0\n\
                    f 4/1 3/1 2/1 1/1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
        let mesh = read_obj(text.as_bytes()).unwrap();
        assert_eq!(
            (mesh.positions().len(), mesh.faces().len()),
            (5, 6),
            "the square is two triangles"
        );
        assert_eq!(mesh.report().boundary_edges, 0, "it is closed");
    }

    #[test]
    fn read_obj_refuses_what_is_no_number() {
        for text in [
            "v 0 0",
            "v 0 0 x",
            "v 0 0 0\nf 1 2 3",
            "v 0 0 0\nf 1 0 1",
            "f a b c",
        ] {
            assert!(read_obj(text.as_bytes()).is_err(), "{text}");
        }
    }
}
