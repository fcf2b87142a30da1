//! Checks textures on surfaces: features follow the orientation, colors are continuous across the edges between
//! faces, and real meshes and photographs pass through the whole chain.

use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_image::{Limits, read_image};
use dapple_mesh::{FaceEdge, FaceIdx, Mesh, Surface, glam::DVec3};
use dapple_mesh_io::read_model;
use dapple_models as models;
use dapple_raster::Raster;
use dapple_synth::{
    Atlas, Direction, Edges, Exemplar, Hierarchy, HierarchyOptions, Options, Orientation, SiteIdx,
    Synthesizer, bake,
};
use std::path::{Path, PathBuf};

/// Returns an exemplar of vertical stripes with a period of `width` pixels. It changes only along the neighborhood's
/// axis P.
fn stripes(width: u32) -> Exemplar {
    let image = Raster::from_fn([4 * width, 32], |x, _| {
        let turns = f64::from(x % width) / f64::from(width);
        let wave = 1.0 - (2.0 * turns - 1.0).abs();
        LinearRgb::gray((0.1 + 0.8 * wave) as f32)
    });
    Exemplar::new(&image.unwrap(), Edges::Wrap).unwrap()
}

/// Returns the median angle, in degrees, between the orientation field and the direction of the texture. The latter is
/// the direction of least change, from the structure tensor (Bigün and Granlund 1987).
///
/// The tensor is summed over the gradients in a ball whose diameter is the period of the stripes, which is `stripe`
/// site spacings, so that it always contains an edge of a stripe.
fn median_turn(synthesizer: &Synthesizer, values: &[f64], stripe: u32) -> f64 {
    let hierarchy = synthesizer.hierarchy();
    let (sites, level) = (hierarchy.sites(), &hierarchy.levels()[0]);
    let gradients: Vec<DVec3> = sites
        .iter()
        .map(|site| gradient(hierarchy, site, values))
        .collect();
    let mut turns: Vec<f64> = sites
        .iter()
        .map(|site| {
            let normal = sites.normals()[site.index()];
            let down = synthesizer.orientation().vectors()[site.index()];
            let right = normal.cross(down);
            let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
            let center = sites.positions()[site.index()];
            let radius = f64::from(stripe) / 2.0 * level.spacing();
            level.grid().visit(center, radius, |near| {
                let gradient = gradients[near.index()];
                let (x, y) = (gradient.dot(right), gradient.dot(down));
                xx += x * x;
                xy += x * y;
                yy += y * y;
            });
            // The direction of greatest change is P if the texture follows the field.
            (0.5 * libm::atan2(2.0 * xy, xx - yy)).abs().to_degrees()
        })
        .collect();
    turns.sort_by(f64::total_cmp);
    turns[turns.len() / 2]
}

/// Returns the gradient that best fits the differences to the neighbors of a site.
///
/// Summing a tensor over edges, each with its own difference, would be cheaper. But it is biased where neighbors are
/// unevenly distributed: by 3 degrees in the median for a correct texture.
fn gradient(hierarchy: &Hierarchy, site: SiteIdx, values: &[f64]) -> DVec3 {
    let sites = hierarchy.sites();
    let normal = sites.normals()[site.index()];
    let right = normal.any_orthonormal_vector();
    let down = normal.cross(right);
    let (mut xx, mut xy, mut yy, mut of_x, mut of_y) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for &other in hierarchy.levels()[0].graph().neighbors(site) {
        let step = sites.positions()[other.index()] - sites.positions()[site.index()];
        let change = values[other.index()] - values[site.index()];
        let (x, y) = (step.dot(right), step.dot(down));
        xx += x * x;
        xy += x * y;
        yy += y * y;
        of_x += x * change;
        of_y += y * change;
    }
    let determinant = xx * yy - xy * xy;
    if determinant < 1e-6 * (xx + yy) * (xx + yy) {
        return DVec3::ZERO;
    }
    let along_right = (yy * of_x - xy * of_y) / determinant;
    right * along_right + down * ((xx * of_y - xy * of_x) / determinant)
}

/// Returns a synthesizer for each set of directions. All have the same sites on the mesh.
fn with_fields(mesh: Mesh, fields: &[&[[DVec3; 2]]]) -> Vec<Synthesizer> {
    let surface = Surface::new(mesh).unwrap();
    let hierarchy = Hierarchy::new(&surface, &sites(40_000, 3)).unwrap();
    let synthesizer = |directions: &&[[DVec3; 2]]| {
        let directions: Vec<Direction> = directions
            .iter()
            .map(|&[at, vector]| Direction { at, vector })
            .collect();
        let orientation = Orientation::new(&hierarchy, &directions).unwrap();
        Synthesizer::from_parts(surface.clone(), hierarchy.clone(), orientation, None).unwrap()
    };
    fields.iter().map(synthesizer).collect()
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
    let bunny: [&[_]; 2] = [
        &[],
        &[
            [models::bunny::LEFT_EAR, DVec3::NEG_Y],
            [models::bunny::NOSE, DVec3::NEG_Y],
            [models::bunny::TAIL, DVec3::NEG_Y],
        ],
    ];
    let ray: [&[_]; 2] = [
        &[[models::ray::SNOUT, DVec3::NEG_Z]],
        &[
            [models::ray::SNOUT, DVec3::NEG_Z],
            [models::ray::LEFT_WING, DVec3::X],
            [models::ray::TAIL, DVec3::NEG_Z],
        ],
    ];
    let models = [
        ("bunny", models::bunny(4000), bunny),
        ("ray", models::ray(4000), ray),
    ];
    for (model, mesh, fields) in models {
        for (field, synthesizer) in with_fields(mesh.unwrap(), &fields).iter().enumerate() {
            for width in [8, 16] {
                let texture = synthesizer.synthesize(&stripes(width), &Options::default());
                let texture = texture.unwrap();
                let values = texture.values(0).chunks(3);
                let values: Vec<f64> = values.map(|color| f64::from(color[0])).collect();
                let turn = median_turn(synthesizer, &values, width);
                println!("{model}, field {field}, stripes of {width}: {turn:.2} degrees");
                assert!(
                    turn < 5.0,
                    "{model}, field {field}: stripes of {width} pixels are turned by {turn} degrees"
                );
            }
        }
    }
}

#[test]
fn turn_of_a_texture_that_is_right_is_none() {
    let [synthesizer] = &with_fields(models::bunny(4000).unwrap(), &[&[]])[..] else {
        panic!("one field");
    };
    // Rings around the y axis are perpendicular to the field. The stripes are therefore rotated by 90 degrees, less
    // an error due to the curvature of the surface within the tensor's ball.
    let hierarchy = synthesizer.hierarchy();
    let spacing = hierarchy.levels()[0].spacing();
    let heights = hierarchy
        .sites()
        .positions()
        .iter()
        .map(|at| at.y / spacing);
    let values: Vec<f64> = heights
        .map(|height| libm::sin(height * core::f64::consts::TAU / 8.0))
        .collect();
    let turn = median_turn(synthesizer, &values, 8);
    assert!(turn > 89.0, "rings are turned by {turn} degrees");
}

#[test]
fn nothing_jumps_across_the_edges_of_the_mesh() {
    let mesh = models::octopus(3000).unwrap();
    let surface = Surface::new(mesh).unwrap();
    let synthesizer = Synthesizer::new(surface, &[], &sites(40_000, 3)).unwrap();
    let texture = synthesizer
        .synthesize(&stripes(8), &Options::default())
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
            // Interpolate the color as in a texture map, with the smooth normal at the edge, which both faces share.
            let [here, there] = [face, other.face].map(|face| {
                let normal = surface.normal(surface.project(face, at));
                let value = hierarchy.interpolate(0, &values, at, normal);
                value.unwrap().unwrap()
            });
            // The same sites have weights on both sides, so the colors have the same bits.
            assert_eq!(here, there, "{face:?}, edge {edge}");
            n_edges += 1;
        }
    }
    assert_eq!(n_edges, 9000, "all edges from both sides");
}

/// Returns the path of a file in `shared/data`, next to the workspace. If it does not exist, prints a note and returns
/// `None`.
fn data(file: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let path = path.join(file);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: there is no {file}");
    None
}

/// Synthesizes a texture from an exemplar file on a mesh, and bakes it to a texture map.
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
        let map = texture_map(read_model(&mesh).unwrap().mesh, &exemplar, 5000);
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

#[test]
fn charts_of_models_use_most_of_the_map_and_hardly_stretch() {
    let made = |mesh: Result<Mesh, models::ModelError>| Some(mesh.unwrap());
    let spot = data("meshes/spot.obj").map(|path| read_model(path).unwrap().mesh);
    for (name, mesh, used) in [
        ("spot", spot, 0.70),
        ("bunny", made(models::bunny(14_000)), 0.70),
        // Charts of thin arms and tubes use less of the map.
        ("octopus", made(models::octopus(14_000)), 0.54),
        ("tori", made(models::blended_tori(14_000)), 0.60),
    ] {
        let Some(mesh) = mesh else { continue };
        let surface = Surface::new(mesh.repair().0).unwrap();
        let report = Atlas::charts(&surface, 1024).unwrap().report(&surface);
        println!("{name}: {report:?}");
        assert!(report.used >= used, "{name}: {report:?}");
        assert!(report.stretch < 1.001, "{name}: {report:?}");
        let n_faces = surface.mesh().faces().len();
        assert!(report.pieces * 40 < n_faces, "{name}: {report:?}");
    }
}
