//! Tests of textured meshes: hard edges, and surfaces that are visible from both sides.

use crate::support::{Folder, assert_done, stdout};
use dapple::mesh::{CREASE, FaceIdx, Mesh, Model};
use dapple::mesh_io::{read_model, write_model};
use dapple::points::glam::DVec3;

/// Returns a cube that extends from 0 to 1 along each axis.
fn cube() -> Mesh {
    let corner = |bits: u32| {
        DVec3::new(
            (bits & 1).into(),
            (bits >> 1 & 1).into(),
            (bits >> 2).into(),
        )
    };
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let faces = sides.map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).concat();
    Mesh::new((0..8).map(corner).collect(), &faces).unwrap()
}

/// Synthesizes a texture on `hard.obj`, and returns the written model. `extra` are more arguments.
fn cover(folder: &Folder, extra: &[&str], output: &str) -> Model {
    let arguments = [
        "synth",
        "checker.png",
        "--mesh",
        "hard.obj",
        "--sites",
        "500",
    ];
    let sizes = ["--texture-size", "128", "-o", output];
    let run = folder.run(&[&arguments[..], &sizes, extra].concat());
    assert_done(&run, output);
    read_model(folder.path(output)).unwrap()
}

/// Returns the maximum distance between a corner normal and the normal of its face. Both are unit vectors.
fn most_off(model: &Model) -> f64 {
    let normals = model.normals_of_corners().unwrap();
    let faces = (0..).map(FaceIdx).zip(&normals);
    let off = faces.map(|(face, corners)| {
        let [a, b, c] = model.mesh.corners(face);
        let flat = (b - a).cross(c - a).normalize();
        let off = corners.iter().map(|corner| corner.distance(flat));
        off.fold(0.0, f64::max)
    });
    off.fold(0.0, f64::max)
}

#[test]
fn hard_edges_of_a_mesh_stay_hard() {
    let folder = Folder::with_inputs("hard");
    write_model(folder.path("hard.obj"), &cube().into()).unwrap();
    for output in ["out.glb", "out.obj"] {
        let flat = most_off(&cover(&folder, &[], output));
        assert!(flat < 1e-6, "{output} is off by {flat}");
    }
    let smooth = most_off(&cover(&folder, &["--crease", "100"], "smooth.glb"));
    assert!(smooth > 0.5, "off by {smooth}");

    // Its own normals take precedence over creases: here the upper side is bent up at its rim.
    let mut bent = Model::from(cube());
    let mut normals = bent.mesh.corner_normals(CREASE);
    let middle = DVec3::new(0.5, 0.5, 0.0);
    for (face, normals) in bent.mesh.faces().iter().zip(&mut normals) {
        for (vertex, normal) in face.iter().zip(normals) {
            if *normal == DVec3::Z {
                *normal =
                    (DVec3::Z + 0.5 * (bent.mesh.positions()[vertex.index()] - middle)).normalize();
            }
        }
    }
    bent.corner_normals = Some(normals.clone());
    write_model(folder.path("hard.obj"), &bent).unwrap();
    for output in ["bent.glb", "bent.obj"] {
        let kept = cover(&folder, &[], output).normals_of_corners().unwrap();
        for (kept, own) in kept.iter().flatten().zip(normals.iter().flatten()) {
            // GLB has single precision.
            assert!(kept.distance(*own) < 1e-6, "{output}: {kept} for {own}");
        }
    }
    let flat = most_off(&cover(&folder, &["--crease", "30"], "flat.glb"));
    assert!(flat < 1e-6, "off by {flat}");
}

#[test]
fn a_symmetry_lets_a_texture_turn() {
    let folder = Folder::with_inputs("symmetry");
    write_model(folder.path("hard.obj"), &cube().into()).unwrap();
    let texture = |extra: &[&str]| {
        let output = "out.png";
        let arguments = [
            "synth",
            "checker.png",
            "--mesh",
            "hard.obj",
            "--sites",
            "500",
            "--texture-size",
            "128",
        ];
        let run = folder.run(&[&arguments[..], &["--force", "-o", output], extra].concat());
        assert_done(&run, output);
        std::fs::read(folder.path(output)).unwrap()
    };
    let plain = texture(&[]);
    assert!(plain == texture(&["--symmetry", "1"]), "the default");
    let [two, four] = ["2", "4"].map(|symmetry| texture(&["--symmetry", symmetry]));
    assert!(
        plain != two && plain != four && two != four,
        "fields differ"
    );
    let run = folder.run(&["synth", "checker.png", "--symmetry", "2", "-o", "none.png"]);
    assert_eq!(run.status.code(), Some(2), "without a mesh");
    let run = folder.run(&[
        "synth",
        "checker.png",
        "--mesh",
        "hard.obj",
        "--symmetry",
        "3",
        "-o",
        "none.glb",
    ]);
    assert_eq!(run.status.code(), Some(2), "of three");
}

#[test]
fn appearance_is_compared_by_default_and_colors_as_in_the_paper() {
    let folder = Folder::with_inputs("matching");
    write_model(folder.path("hard.obj"), &cube().into()).unwrap();
    let covered = |extra: &[&str]| {
        cover(&folder, &[&["--force"], extra].concat(), "covered.ply");
        std::fs::read(folder.path("covered.ply")).unwrap()
    };
    let (plain, colors) = (covered(&[]), covered(&["--matching", "colors"]));
    assert!(plain == covered(&["--matching", "appearance"]));
    assert!(plain != colors);
    assert!(covered(&["--paper"]) == covered(&["--paper", "--matching", "colors"]));
}

#[test]
fn both_sides_of_a_sheet_get_one_texture_and_are_seen() {
    let folder = Folder::with_inputs("sides");
    let cube = cube();
    let corners = cube.faces().iter().map(|face| face.map(|vertex| vertex.0));
    let outside: Vec<[u32; 3]> = corners.collect();
    // The inside has vertices of its own.
    let inside = outside.iter().map(|[a, b, c]| [a + 8, c + 8, b + 8]);
    let positions = [cube.positions(), cube.positions()].concat();
    let faces: Vec<[u32; 3]> = outside.iter().copied().chain(inside).collect();
    let both = Mesh::new(positions, &faces).unwrap();
    write_model(folder.path("hard.obj"), &both.into()).unwrap();
    let info = stdout(&folder.run(&["info", "hard.obj"]));
    assert!(
        info.contains("12 faces back to back with another"),
        "{info}"
    );
    assert!(info.contains("a material with two sides"), "{info}");
    let model = cover(&folder, &[], "out.glb");
    assert_eq!(model.mesh.faces().len(), 12, "one sheet");
    assert!(model.material.double_sided);
    let info = stdout(&folder.run(&["info", "out.glb"]));
    assert!(info.contains("two sides"), "{info}");

    write_model(folder.path("hard.obj"), &cube.into()).unwrap();
    assert!(!cover(&folder, &[], "closed.glb").material.double_sided);
}

#[test]
fn charts_are_the_default_and_share_vertices_and_the_report_tells_their_stretch() {
    let folder = Folder::with_inputs("charts");
    write_model(folder.path("hard.obj"), &cube().into()).unwrap();
    let report = |name: &str| {
        let text = std::fs::read_to_string(folder.path(name)).unwrap();
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        report["report"]["atlas"].clone()
    };
    for output in ["out.glb", "out.obj"] {
        let model = cover(&folder, &["--json"], output);
        assert!(model.material.mipmaps, "{output} is shown with mipmaps");
        let uvs = model.uvs.unwrap();
        let mut places: Vec<_> = uvs
            .iter()
            .flatten()
            .map(|uv| uv.to_array().map(f64::to_bits))
            .collect();
        places.sort_unstable();
        places.dedup();
        assert_eq!(places.len(), 24, "{output}: the corners of six squares");
        let report = report("out.json");
        assert_eq!(report["pieces"], 6, "{report}");
        assert!(
            (report["stretch"].as_f64().unwrap() - 1.0).abs() < 1e-6,
            "{report}"
        );
        assert!(report["texels_used"].as_f64().unwrap() > 0.5, "{report}");
        std::fs::remove_file(folder.path("out.json")).unwrap();
    }
    cover(&folder, &["--json", "--atlas", "uniform"], "tiles.glb");
    assert_eq!(report("tiles.json")["pieces"], 12, "loose triangles");
}
