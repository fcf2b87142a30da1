//! Tests of models in a folder.

use super::*;
use crate::test_meshes::cube;
use dapple_mesh::EncodedImage;
use glam::DVec2;
use std::fs;
use std::path::PathBuf;

/// Creates an empty folder for a test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("dapple-mesh-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("inside")).expect("a temporary folder can be made");
    folder
}

fn textured() -> Model {
    let mut model = Model::from(cube());
    model.uvs = Some(vec![
        [DVec2::ZERO, DVec2::X, DVec2::Y];
        model.mesh.faces().len()
    ]);
    model.material.base_color = EncodedImage::new(b"\x89PNG\r\n\x1a\n".to_vec()).ok();
    model
}

#[test]
fn models_are_written_and_read_by_extension() {
    let folder = folder("extension");
    let model = textured();
    for name in ["a.obj", "a.PLY", "a.glb"] {
        let path = folder.join("inside").join(name);
        write_model(&path, &model).expect("it is written");
        let back = read_model(&path).expect("it is read");
        assert_eq!(back.mesh.faces().len(), model.mesh.faces().len(), "{name}");
        assert_eq!(back.uvs, model.uvs, "{name}");
        assert_eq!(back.material == model.material, name != "a.PLY", "{name}");
    }
    let mut names: Vec<_> = fs::read_dir(folder.join("inside"))
        .expect("it is there")
        .flatten()
        .map(|entry| entry.file_name())
        .collect();
    names.sort();
    assert_eq!(
        names,
        ["a.PLY", "a.glb", "a.mtl", "a.obj", "a_base_color.png"],
        "and nothing else"
    );
    fs::remove_dir_all(folder).expect("it is there");
}

#[test]
fn the_longest_name_of_a_file_system_can_be_written() {
    let folder = folder("long");
    let path = folder.join(format!("{}.glb", "n".repeat(251)));
    write_model(&path, &textured()).expect("255 bytes");
    assert!(read_model(&path).is_ok(), "it is whole");
    fs::remove_dir_all(folder).expect("it is there");
}

#[cfg(unix)]
#[test]
fn permissions_and_links_are_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder("kept");
    let (file, link) = (folder.join("a.ply"), folder.join("link.ply"));
    fs::write(&file, "old").expect("it is written");
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("it is ours");
    symlink(&file, &link).expect("it is made");
    write_model(&link, &textured()).expect("it is written");
    assert!(link.is_symlink(), "the link stays");
    assert!(read_model(&file).is_ok(), "where it leads to");
    let mode = fs::metadata(&file)
        .expect("it is there")
        .permissions()
        .mode();
    assert_eq!(mode & 0o777, 0o640, "the permissions stay");
    fs::remove_dir_all(folder).expect("it is there");
}

#[test]
fn unknown_extensions_and_missing_files_are_refused() {
    let folder = folder("refused");
    let kind = |result: Result<(), MeshIoError>| result.expect_err("it is refused").kind().clone();
    for name in ["a.nothing", "a", "a.gltf", "a.off"] {
        let kind = kind(write_model(folder.join(name), &textured()));
        assert!(matches!(kind, MeshIoErrorKind::Format { .. }), "{kind:?}");
    }
    for path in [
        folder.join("missing.obj"),
        folder.join("missing").join("a.glb"),
    ] {
        let kind = kind(read_model(&path).map(drop));
        assert!(matches!(kind, MeshIoErrorKind::Io { .. }), "{kind:?}");
    }
    let kind = kind(write_model(
        folder.join("missing").join("a.glb"),
        &textured(),
    ));
    assert!(matches!(kind, MeshIoErrorKind::Io { .. }), "{kind:?}");
    fs::remove_dir_all(folder).expect("it is there");
}

#[test]
fn names_in_a_file_do_not_lead_out_of_its_folder() {
    let folder = folder("inside");
    fs::write(folder.join("secret"), "outside").expect("it is written");
    fs::write(folder.join("inside").join("known"), "beside").expect("it is written");
    let path = folder.join("inside").join("a.obj");
    let mut left = 10;
    assert_eq!(
        resolve(&path, "./known", &mut left).as_deref(),
        Some(b"beside".as_slice())
    );
    assert_eq!(left, 4, "six of ten bytes were read");
    assert_eq!(resolve(&path, "known", &mut left), None, "too much");
    let absolute = folder.join("secret").display().to_string();
    for name in ["../secret", "x/../../secret", absolute.as_str(), "", "."] {
        assert_eq!(resolve(&path, name, &mut 100), None, "{name}");
    }
    fs::remove_dir_all(folder).expect("it is there");
}

#[cfg(unix)]
#[test]
fn only_regular_files_are_read_beside_a_file() {
    let folder = folder("regular");
    let path = folder.join("a.gltf");
    // Opening a pipe without a writer would block.
    let made = std::process::Command::new("mkfifo")
        .arg(folder.join("pipe"))
        .status();
    assert!(made.expect("every Unix has it").success());
    std::os::unix::fs::symlink("/dev/zero", folder.join("zero")).expect("it is made");
    fs::write(folder.join("file"), "beside").expect("it is written");
    std::os::unix::fs::symlink("file", folder.join("link")).expect("it is made");
    for name in ["pipe", "zero", "inside"] {
        assert_eq!(resolve(&path, name, &mut 100), None, "{name}");
    }
    assert!(
        resolve(&path, "link", &mut 100).is_some(),
        "a link to a file"
    );
    let text = r#"{"asset":{"version":"2.0"},"images":[{"uri":"pipe"}],"textures":[{"source":0}],
        "materials":[{"normalTexture":{"index":0}}],"buffers":[{"uri":"zero","byteLength":4}],
        "bufferViews":[{"buffer":0,"byteLength":12}],"nodes":[{"mesh":0}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}]}"#;
    fs::write(&path, text).expect("it is written");
    let error = read_model(&path).expect_err("it is refused").to_string();
    assert!(
        error.contains("the bytes of buffer 0 are missing"),
        "{error}"
    );
    fs::remove_dir_all(folder).expect("it is there");
}
