//! Tests of layers, views and vectors of OpenEXR files.

use dapple_color::{LinearRgb, Normal};
use dapple_image::{
    Channels, ExrImage, ExrPlane, Format, Image, ImageErrorKind, Limits, decode_exr, encode_exr,
};
use dapple_raster::Raster;

/// Returns an image of one pixel, with a plane for each pair of name and value.
fn image(planes: &[(&str, f32)]) -> Image {
    let plane =
        |&(name, value): &(&str, f32)| ExrPlane::new(name, Raster::filled([1, 1], value).unwrap());
    let planes: Vec<_> = planes.iter().map(plane).collect();
    let bytes = encode_exr(&planes).unwrap();
    Image::Planes(Format::Exr, decode_exr(&bytes, &Limits::default()).unwrap())
}

/// Returns an image of one pixel with several layers. Each is given as a prefix, the names of its channels, and the
/// value of all channels except alpha, which is 1.
fn layers(layers: &[(&str, &[&str], f32)]) -> Image {
    let mut planes = Vec::new();
    for (prefix, channels, value) in layers {
        for channel in *channels {
            let is_alpha = ["a", "alpha"].contains(&channel.to_lowercase().as_str());
            let value = if is_alpha { 1.0 } else { *value };
            planes.push((format!("{prefix}{channel}"), value));
        }
    }
    let planes: Vec<_> = planes
        .iter()
        .map(|(name, value)| (name.as_str(), *value))
        .collect();
    image(&planes)
}

const RGB: &[&str] = &["R", "G", "B"];
const RGBA: &[&str] = &["R", "G", "B", "A"];

#[test]
fn the_picture_is_chosen_by_the_names_of_layers() {
    // In every file the picture has the value 0.25, and all else is 1.
    let files: &[&[(&str, &[&str], f32)]] = &[
        &[("", RGBA, 0.25), ("diffuse.", RGB, 1.0)],
        &[("", RGB, 0.25), ("beauty.", RGB, 1.0), ("rgba.", RGB, 1.0)],
        &[
            ("ViewLayer.Combined.", RGBA, 0.25),
            ("ViewLayer.DiffCol.", RGB, 1.0),
            ("ViewLayer.Depth.", &["Z"], 1.0),
        ],
        &[("ViewLayer.Combined.", RGB, 0.25), ("rgba.", RGB, 1.0)],
        &[
            ("rgba.", RGB, 0.25),
            ("beauty.", RGB, 1.0),
            ("albedo.", RGB, 1.0),
        ],
        &[
            ("beauty.", RGBA, 0.25),
            ("albedo.", RGB, 1.0),
            ("N.", &["X", "Y", "Z"], 1.0),
        ],
        &[("Beauty.", &["r", "g", "b"], 0.25), ("albedo.", RGB, 1.0)],
        &[("", &["r", "g", "b", "a"], 0.25)],
        &[
            ("", &["red", "green", "blue", "alpha"], 0.25),
            ("depth.", &["Z"], 1.0),
        ],
        &[("left.", RGB, 0.25), ("right.", RGB, 1.0)],
        &[("right.", RGB, 1.0), ("", RGB, 0.25)],
        &[
            ("rgba_left.", RGB, 0.25),
            ("rgba_right.", RGB, 1.0),
            ("depth_left.", &["Z"], 1.0),
        ],
        &[("crypto00.", RGBA, 1.0), ("Combined.", RGB, 0.25)],
        &[
            ("diffuse.", RGB, 0.25),
            ("mask.", &["Y"], 1.0),
            ("Z.", &["Z"], 1.0),
        ],
        &[("", &["Y", "A"], 0.25)],
        &[("", &["Y"], 0.25), ("diffuse.", RGB, 1.0)],
        &[("", &["height"], 0.25)],
    ];
    for file in files {
        let image = layers(file);
        let color = image
            .color()
            .unwrap_or_else(|error| panic!("{file:?}: {error}"));
        assert_eq!(color.pixels(), [LinearRgb::gray(0.25)], "{file:?}");
    }
}

#[test]
fn gray_with_alpha_is_gray_where_it_is_opaque() {
    let opaque = image(&[("A", 1.0), ("Y", 0.5)]);
    assert_eq!(opaque.channels(), Channels::GrayAlpha);
    assert_eq!(opaque.gray().unwrap().pixels(), [0.5]);
    let half = image(&[("A", 0.5), ("Y", 0.25)]);
    assert!(half.gray().is_err(), "partly transparent");
    let pixel = half.color_alpha().unwrap().pixels()[0];
    assert_eq!((pixel.color, pixel.alpha), (LinearRgb::gray(0.5), 0.5));
}

#[test]
fn views_are_in_the_order_of_the_file() {
    let Image::Planes(_, image) = layers(&[("left.", RGB, 1.0), ("right.", RGB, 0.25)]) else {
        panic!("no EXR");
    };
    let image = ExrImage {
        views: vec!["right".to_owned(), "left".to_owned()],
        ..image
    };
    let color = Image::Planes(Format::Exr, image).color().unwrap();
    assert_eq!(color.pixels(), [LinearRgb::gray(0.25)]);
}

#[test]
fn several_layers_that_may_be_meant_are_listed() {
    let two = layers(&[("near.", RGB, 1.0), ("far.", RGB, 1.0)]);
    let error = two.color().unwrap_err();
    let expected = ImageErrorKind::AmbiguousLayer {
        layers: vec!["far".to_owned(), "near".to_owned()],
    };
    assert_eq!(error.kind(), &expected);
    assert!(error.to_string().ends_with("far, near"), "{error}");
    assert_eq!(two.channels(), Channels::Planes);
    let data = image(&[("depth", 1.0), ("id", 2.0)]);
    let expected = ImageErrorKind::AmbiguousLayer {
        layers: vec!["depth".to_owned(), "id".to_owned()],
    };
    assert_eq!(data.gray().unwrap_err().kind(), &expected);
}

#[test]
fn a_layer_is_read_by_its_name() {
    let depth: (&str, &[&str], f32) = ("V.Depth.", &["Z"], 3.0);
    let file = layers(&[
        ("V.Combined.", RGBA, 1.0),
        ("V.DiffCol.", RGB, 2.0),
        depth,
        ("", &["id"], 4.0),
    ]);
    for (name, value) in [
        ("V.Combined", 1.0),
        ("V.DiffCol", 2.0),
        ("v.diffcol", 2.0),
        ("V.Depth", 3.0),
        ("V.Depth.Z", 3.0),
        ("V.DiffCol.G", 2.0),
        ("id", 4.0),
    ] {
        let layer = file.layer(name).unwrap();
        let color = layer.color().unwrap();
        assert_eq!(color.pixels(), [LinearRgb::gray(value)], "{name}");
    }
    let error = file.layer("Diffuse").unwrap_err();
    let expected = ImageErrorKind::MissingLayer {
        name: "Diffuse".to_owned(),
        layers: ["V.Combined", "V.Depth", "V.DiffCol", "id"]
            .map(str::to_owned)
            .to_vec(),
    };
    assert_eq!(error.kind(), &expected);
}

/// Checks that three planes with the values `parts` are read as the unit vector `expected`.
fn assert_normal(names: [&str; 3], parts: [f32; 3], expected: Normal, tolerance: f32) {
    let planes: Vec<_> = names.into_iter().zip(parts).collect();
    let found = image(&planes).normals().unwrap().pixels()[0];
    let pairs = found.to_array().into_iter().zip(expected.to_array());
    for (found_part, part) in pairs {
        let difference = (found_part - part).abs();
        assert!(difference <= tolerance, "{names:?} {parts:?}: {found:?}");
    }
}

#[test]
fn normals_are_vectors_or_codes() {
    let vector = Normal {
        x: -0.6,
        y: 0.0,
        z: 0.8,
    };
    // Vectors are normalized, and so differ by a rounding.
    let rounding = f32::EPSILON;
    assert_normal(["X", "Y", "Z"], [-0.6, 0.0, 0.8], vector, rounding);
    assert_normal(["n.X", "n.Y", "n.Z"], [-1.2, 0.0, 1.6], vector, rounding);
    assert_normal(["R", "G", "B"], [-0.6, 0.0, 0.8], vector, rounding);
    // Codes have 16 bits, which is 1 / 65535 for a part from -1 to 1.
    assert_normal(["R", "G", "B"], [0.2, 0.5, 0.9], vector, 2.0 / 65535.0);
    let up = [0.0, 0.6, 0.8];
    let code_free = Normal {
        x: 0.0,
        y: 0.6,
        z: 0.8,
    };
    assert_normal(["X", "Y", "Z"], up, code_free, rounding);
    assert_normal(["X", "Y", "Z"], [0.0; 3], Normal::FLAT, 0.0);
}

#[test]
fn vectors_are_neither_gray_nor_colors() {
    let vectors = image(&[("X", 0.0), ("Y", 0.0), ("Z", 1.0)]);
    assert_eq!(vectors.channels(), Channels::Vectors);
    assert!(vectors.gray().is_err() && vectors.color().is_err());
    let gray = image(&[("Y", 0.5)]);
    assert!(gray.normals().is_err(), "one number is no vector");
}
