//! Tests of materials.

use super::*;
use dapple_mesh::AlphaMode;

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

#[test]
fn emission_specular_and_clear_coat_are_written_with_their_extensions() {
    let mut model = full();
    let image = model.material.base_color.clone();
    let material = &mut model.material;
    (material.emission, material.specular, material.clearcoat) =
        (image.clone(), image.clone(), image);
    material.emission_strength = 4.0;
    material.clearcoat_roughness = 0.25;
    (material.alpha, material.alpha_cutoff) = (AlphaMode::Mask, 0.25);
    let json = |model: &Model| -> Value {
        let bytes = write(model).expect("it is valid");
        parse(Container::read(&bytes).expect("it is valid").json).expect("it is JSON")
    };
    let document = json(&model);
    let names = [
        "KHR_materials_clearcoat",
        "KHR_materials_emissive_strength",
        "KHR_materials_specular",
    ];
    assert_eq!(document["extensionsUsed"], json!(names));
    let written = &document["materials"][0];
    assert_eq!(written["emissiveFactor"], json!([1.0, 1.0, 1.0]));
    assert_eq!(written["alphaCutoff"], 0.25);
    let extensions = &written["extensions"];
    assert_eq!(extensions[names[0]]["clearcoatRoughnessFactor"], 0.25);
    assert_eq!(extensions[names[1]]["emissiveStrength"], 4.0);
    assert!(extensions[names[2]]["specularTexture"]["index"].is_u64());
    let back = read(&write(&model).expect("it is valid")).expect("it is valid");
    assert_eq!(back.material.alpha_cutoff, 0.25, "the cutoff is read");
    // A strength of at most 1 needs no extension.
    model.material.emission_strength = 0.5;
    let document = json(&model);
    assert_eq!(
        document["materials"][0]["emissiveFactor"],
        json!([0.5, 0.5, 0.5])
    );
    assert_eq!(document["extensionsUsed"], json!([names[0], names[2]]));
    // Without texture coordinates, there is nothing to place the images with.
    model.uvs = None;
    assert!(json(&model).get("extensionsUsed").is_none());
}
