//! Tests of materials.

use super::*;

#[test]
fn further_materials_of_faces_are_listed() {
    let left_out = |materials: [Value; 2]| {
        let mut document = square();
        let primitive = document["meshes"][0]["primitives"][0].clone();
        document["materials"] = json!([{}, {}]);
        document["meshes"][0]["primitives"] = json!([primitive, primitive]);
        for (at, material) in materials.into_iter().enumerate() {
            document["meshes"][0]["primitives"][at]["material"] = material;
        }
        read_json(&document).expect("it is valid").left_out
    };
    assert!(left_out([1.into(), 1.into()]).is_empty());
    assert_eq!(left_out([1.into(), 0.into()]), [Model::FURTHER_MATERIALS]);
}

#[test]
fn open_meshes_have_two_sides_and_matter_is_not_metal() {
    let bytes = write(&Model::from(plane(1, 1))).expect("it is valid");
    let gltf = ::gltf::Gltf::from_slice(&bytes).expect("it is valid");
    let material = gltf.materials().next().expect("it has one");
    assert!(material.double_sided(), "a plane is open");
    let pbr = material.pbr_metallic_roughness();
    assert_eq!((pbr.metallic_factor(), pbr.roughness_factor()), (0.0, 1.0));
}

#[test]
fn material_says_whether_it_has_two_sides_and_mipmaps() {
    for said in [false, true] {
        let mut model = full();
        model.mesh = tetrahedron();
        (model.colors, model.normals) = (None, None);
        model.uvs = Some(vec![[DVec2::ZERO, DVec2::X, DVec2::Y]; 4]);
        model.material.double_sided = said;
        model.material.mipmaps = said;
        let bytes = write(&model).expect("it is valid");
        let gltf = ::gltf::Gltf::from_slice(&bytes).expect("it is valid");
        let material = gltf.materials().next().expect("it has one");
        assert_eq!(material.double_sided(), said);
        let sampler = gltf.samplers().next().expect("it has one");
        let filter = match said {
            true => ::gltf::texture::MinFilter::LinearMipmapLinear,
            false => ::gltf::texture::MinFilter::Linear,
        };
        assert_eq!(sampler.min_filter(), Some(filter));
        let back = read(&bytes).expect("it is valid");
        assert_eq!(back.material.double_sided, said, "it is read");
    }
}
