//! Targets for OBJ, PLY, glTF, OFF and STL.

use super::accepted;
use dapple::color::{LinearRgb, LinearRgba};
use dapple::mesh::glam::{DVec2, DVec3};
use dapple::mesh::{EncodedImage, Mesh, Model, Surface};
use dapple::mesh_io::{self as io, MeshIoError};

/// Reads an OBJ file. The model must be rejected, or be repairable, usable as a surface, and equal after it is written
/// and read again.
pub fn obj(bytes: &[u8]) {
    // The file also serves as its own material library and texture.
    check(
        io::obj::read_with(bytes, &mut |_| Some(bytes.to_vec())),
        |model| {
            let files = io::obj::write_files(model, "a")?;
            let main = files.last().map_or(&[][..], |file| &file.bytes);
            io::obj::read_with(main, &mut |name| {
                let named = files.iter().find(|file| file.name == name)?;
                Some(named.bytes.clone())
            })
        },
    );
}

/// Reads a PLY file. The model must be rejected, or be repairable, usable as a surface, and equal after it is written,
/// in binary and as text, and read again.
pub fn ply(bytes: &[u8]) {
    check(io::ply::read(bytes), |model| {
        io::ply::read(&io::ply::write(model)?)
    });
    check(io::ply::read(bytes), |model| {
        io::ply::read(&io::ply::write_text(model)?)
    });
}

/// Reads a glTF or GLB file. The model must be rejected, or be repairable, usable as a surface, and equal after it is
/// written and read again.
pub fn gltf(bytes: &[u8]) {
    check(
        io::gltf::read_with(bytes, &mut |_| Some(bytes.to_vec())),
        |model| io::gltf::read(&io::gltf::write(model)?),
    );
}

/// Reads an OFF file. The model must be rejected, or be repairable and usable as a surface. OFF cannot be written.
pub fn off(bytes: &[u8]) {
    check(io::off::read(bytes), |model| Ok(model.clone()));
}

/// Reads an STL file. The model must be rejected, or be repairable, usable as a surface, and equal after it is written
/// and read again.
pub fn stl(bytes: &[u8]) {
    check(io::stl::read(bytes), |model| {
        io::stl::read(&io::stl::write(model)?)
    });
}

fn check(read: Result<Model, MeshIoError>, again: impl Fn(&Model) -> Result<Model, MeshIoError>) {
    let Some(model) = accepted(read) else {
        return;
    };
    model.check().expect("what is read is valid");
    check_mesh(&model.mesh);
    // The first writing may lose data that the format cannot represent. The second must not lose any.
    let once = again(&model).expect("what was read can be written and read");
    let twice = again(&once).expect("it can be written and read again");
    assert_eq!(once, twice, "written and read again");
    assert_eq!(
        model.mesh.faces().len(),
        once.mesh.faces().len(),
        "no face is lost"
    );
}

fn check_mesh(mesh: &Mesh) {
    let (mended, repair) = mesh.repair();
    assert_eq!(
        mended.report(),
        repair.after,
        "the report of the repaired mesh"
    );
    assert_eq!(mended.repair().0, mended, "repaired again");
    if mended.faces().is_empty() {
        return;
    }
    let surface = Surface::new(mended).expect("a repaired mesh can be laid out");
    assert!(surface.area() > 0.0, "the area is {}", surface.area());
}

/// Returns a cube with every kind of data that a model may have.
fn model() -> Model {
    let corner = |index: u32| DVec3::from([0, 1, 2].map(|axis| f64::from(index >> axis & 1)));
    let faces = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    let mesh = Mesh::new((0..8).map(corner).collect(), &faces).expect("a cube");
    let mut model = Model::from(mesh);
    model.colors = Some(vec![LinearRgba::opaque(LinearRgb::gray(0.5)); 8]);
    model.normals = Some(vec![DVec3::Z; 8]);
    model.uvs = Some(vec![[DVec2::ZERO, DVec2::X, DVec2::Y]; 12]);
    model.material.base_color = EncodedImage::new(b"\x89PNG\r\n\x1a\n".to_vec()).ok();
    model
}

pub(super) fn obj_seeds() -> Vec<Vec<u8>> {
    let written = io::obj::write_files(&model(), "a").expect("it is valid");
    let by_hand = "mtllib a.mtl\nnewmtl a\nKd .5 .25 1\nd 0.5\nmap_Kd -s 2 2 b.png\nusemtl a\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/1/1 \\\n 3/1/1 -1/-1/-1\nf 1//1 2//1 3//1\nf 3 2 1\n";
    let mut seeds: Vec<_> = written.into_iter().map(|file| file.bytes).collect();
    seeds.push(by_hand.into());
    seeds.push(
        b"v 0 0 0\nv 1e-30 0 0\nv 1 1e-9 0\nv 1e30 0 0\nf 1 2 3\nf 1 3 4\nf 2 1 4 3\n".to_vec(),
    );
    seeds
}

pub(super) fn ply_seeds() -> Vec<Vec<u8>> {
    let written = [io::ply::write(&model()), io::ply::write_text(&model())];
    let big = b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n".to_vec();
    let corners: Vec<u8> = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
        .into_iter()
        .flat_map(f32::to_be_bytes)
        .collect();
    let face = [3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2];
    let mut seeds: Vec<_> = written.map(|bytes| bytes.expect("it is valid")).into();
    seeds.push([&big[..], &corners, &face].concat());
    seeds
}

pub(super) fn gltf_seeds() -> Vec<Vec<u8>> {
    let text = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[2,-1,1],"children":[1]},{"mesh":0,"rotation":[0,0,0.6,0.8]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    vec![
        io::gltf::write(&model()).expect("it is valid"),
        io::gltf::write(&Model::from(model().mesh)).expect("it is valid"),
        text.into(),
    ]
}

pub(super) fn stl_seeds() -> Vec<Vec<u8>> {
    let by_hand = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 .5\nendloop\nendfacet\nendsolid a\n";
    vec![
        io::stl::write(&model()).expect("it is valid"),
        by_hand.into(),
    ]
}

pub(super) fn off_seeds() -> Vec<Vec<u8>> {
    vec![
        b"OFF\n4 2 5 # counts\n0 0 0\n1 0 0\n1 1 0\n0 1 .5\n4 0 1 2 3 255 0 0\n3 0 2 1\n".to_vec(),
        b"STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 188 128 0 0.25\n1 0 0 0 1 0 1.0 0 0.5 0 1 1\n0 1 0 1 0 0 0 0 0 .5 .5\n3 0 1 2\n".to_vec(),
    ]
}
