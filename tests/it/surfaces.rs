//! Textures on surfaces: features follow the orientation, nothing jumps where faces meet, and real meshes and photographs
//! go through the whole chain.

use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_image::{Limits, read_image};
use dapple_mesh::{FaceEdge, FaceIdx, HierarchyOptions, Mesh, SiteIdx, Surface, io, models};
use dapple_raster::Raster;
use dapple_synth::{Atlas, Edges, Exemplar, Options, SurfaceTexture, Synthesizer, bake};
use std::path::{Path, PathBuf};

/// Upright stripes, seven in 56 pixels: the texture changes along P only.
fn stripes() -> Exemplar {
    let image = Raster::from_fn([56, 56], |x, _| {
        let turns = f64::from(x % 8) / 8.0;
        let wave = 1.0 - (2.0 * turns - 1.0).abs();
        LinearRgb::gray((0.1 + 0.8 * wave) as f32)
    });
    Exemplar::new(&image.unwrap(), Edges::Wrap).unwrap()
}

/// The middle of the angles between the field and what the texture itself says: the direction of least change of the
/// structure tensor (Bigün and Granlund 1987) of each site's neighborhood, in degrees.
fn median_turn(synthesizer: &Synthesizer, texture: &SurfaceTexture) -> f64 {
    let hierarchy = synthesizer.hierarchy();
    let (sites, level) = (hierarchy.sites(), &hierarchy.levels()[0]);
    let value = |site: SiteIdx| f64::from(texture.values(0)[3 * site.index()]);
    let mut turns: Vec<f64> = sites
        .iter()
        .map(|site| {
            let normal = sites.normals()[site.index()];
            let down = synthesizer.orientation().vectors()[site.index()];
            let right = normal.cross(down);
            let center = sites.positions()[site.index()];
            let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
            // The tensor of the gradients of a ball as wide as a stripe and its gap: those of the edges in it.
            level.grid().visit(center, 4.0 * level.spacing(), |near| {
                for &other in level.graph().neighbors(near) {
                    let step = sites.positions()[other.index()] - sites.positions()[near.index()];
                    let change = value(other) - value(near);
                    let (x, y) = (step.dot(right), step.dot(down));
                    let length_sq = x * x + y * y;
                    let (x, y) = (x * change / length_sq, y * change / length_sq);
                    xx += x * x;
                    xy += x * y;
                    yy += y * y;
                }
            });
            // The direction of most change is P where the texture follows the field.
            (0.5 * libm::atan2(2.0 * xy, xx - yy)).abs().to_degrees()
        })
        .collect();
    turns.sort_by(f64::total_cmp);
    turns[turns.len() / 2]
}

fn sites(n_sites: usize, n_levels: usize) -> HierarchyOptions {
    HierarchyOptions {
        n_sites,
        n_levels,
        seed: Seed(3),
        ..HierarchyOptions::default()
    }
}

#[test]
fn stripes_follow_the_field_within_five_degrees() {
    let surface = Surface::new(models::bunny(4000).unwrap()).unwrap();
    let synthesizer = Synthesizer::new(surface, &[], &sites(40_000, 3)).unwrap();
    let texture = synthesizer
        .synthesize(&stripes(), &Options::default())
        .unwrap();
    let turn = median_turn(&synthesizer, &texture);
    assert!(turn < 5.0, "the stripes are turned by {turn} degrees");
}

#[test]
fn nothing_jumps_across_the_edges_of_the_mesh() {
    let mesh = models::octopus(3000).unwrap();
    let surface = Surface::new(mesh).unwrap();
    let synthesizer = Synthesizer::new(surface, &[], &sites(40_000, 3)).unwrap();
    let texture = synthesizer
        .synthesize(&stripes(), &Options::default())
        .unwrap();
    let (surface, hierarchy) = (synthesizer.surface(), synthesizer.hierarchy());
    let values: Vec<f32> = texture.values(0).chunks(3).map(|color| color[0]).collect();
    let mut n_edges = 0;
    for face in (0..surface.mesh().faces().len() as u32).map(FaceIdx) {
        for edge in 0..3 {
            let Some(other) = surface.adjacency().across(FaceEdge { face, edge }) else {
                continue;
            };
            let corners = surface.mesh().corners(face);
            let at = corners[usize::from(edge)].lerp(corners[(usize::from(edge) + 1) % 3], 0.4);
            // What a texture map shows: the smooth normal counts, which both faces have in common.
            let [here, there] = [face, other.face].map(|face| {
                let normal = surface.normal(surface.project(face, at));
                let value = hierarchy.interpolate(0, &values, at, normal);
                value.unwrap().unwrap()
            });
            // The same sites count on both sides, so the colors are the same bits.
            assert_eq!(here, there, "{face:?}, edge {edge}");
            n_edges += 1;
        }
    }
    assert_eq!(n_edges, 9000, "all edges from both sides");
}

/// Real data beside the workspace; nothing where there is none.
fn data(file: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let path = path.join(file);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: there is no {file}");
    None
}

/// From files to a texture map.
fn texture_map(mesh: Mesh, exemplar: &Path, n_sites: usize) -> Raster<[f32; 3]> {
    let image = read_image(exemplar, &Limits::default())
        .unwrap()
        .color()
        .unwrap();
    let (mesh, _) = mesh.repair();
    let synthesizer =
        Synthesizer::new(Surface::new(mesh).unwrap(), &[], &sites(n_sites, 3)).unwrap();
    let exemplar = Exemplar::new(&image, Edges::Cut).unwrap();
    let texture = synthesizer
        .synthesize(&exemplar, &Options::default())
        .unwrap();
    let atlas = Atlas::uniform(synthesizer.surface(), 512).unwrap();
    let (surface, hierarchy) = (synthesizer.surface(), synthesizer.hierarchy());
    bake::<3>(surface, hierarchy, texture.values(0), &atlas, [-1.0; 3]).unwrap()
}

#[test]
fn real_meshes_and_photographs_get_their_textures() {
    let meshes = [
        "spot",
        "degenerate/gazebo",
        "degenerate/cube",
        "degenerate/double_sided",
    ];
    let exemplars = ["leaves", "rock023", "ground037"];
    for (number, mesh) in meshes.iter().enumerate() {
        let exemplar = exemplars[number % exemplars.len()];
        let mesh = data(&format!("meshes/{mesh}.obj"));
        let exemplar = data(&format!("exemplars/{exemplar}_cc0_64.png"));
        let (Some(mesh), Some(exemplar)) = (mesh, exemplar) else {
            return;
        };
        let map = texture_map(io::read_model(&mesh).unwrap().mesh, &exemplar, 5000);
        let shown = map.pixels().iter().filter(|color| color[0] >= 0.0);
        let colors: Vec<_> = shown.copied().collect();
        let in_range = |color: &[f32; 3]| color.iter().all(|code| (0.0..=1.0).contains(code));
        assert!(
            colors.len() > 100_000,
            "{} texels of {}",
            colors.len(),
            mesh.display()
        );
        assert!(colors.iter().all(in_range), "codes of {}", mesh.display());
        assert!(
            colors.iter().any(|color| *color != colors[0]),
            "{} is flat",
            mesh.display()
        );
    }
}
