//! Decodes text files, and parses and formats words and numbers.

use crate::MeshIoError;
use core::fmt::Display;
use core::fmt::Write as _;
use core::str::FromStr;
use dapple_mesh::POSITION_MAX;
use dapple_raster::text::without_mark;

/// Returns the text of a file without a UTF-8 byte order mark. All readers of text formats use this function.
///
/// Fails for UTF-16 and UTF-32, with or without a mark: the first character of every format is ASCII.
pub(crate) fn content<'a>(format: &'static str, bytes: &'a [u8]) -> Result<&'a [u8], MeshIoError> {
    without_mark(bytes).map_err(|error| MeshIoError::file(format, error.to_string()))
}

/// Returns the words of a text, separated by white space.
pub(crate) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// Parses a word as a number.
pub(crate) fn parse<T: FromStr>(word: &[u8]) -> Option<T> {
    core::str::from_utf8(word).ok()?.parse().ok()
}

/// Returns a component of a position, normal or texture coordinate if it is in range; otherwise a message.
pub(crate) fn in_range(part: f64) -> Result<f64, String> {
    if part.abs() <= POSITION_MAX {
        return Ok(part);
    }
    Err(format!(
        "a number is {part:e}, but it must be between -1e30 and 1e30"
    ))
}

/// Returns the message for a corner with a vertex that does not exist.
pub(crate) fn no_vertex(vertex: impl Display, count: impl Display) -> String {
    format!("a corner of a face is vertex {vertex}, but there are {count}")
}

/// Appends the shortest text that reads back as the same number. Numbers with many zeros get an exponent.
pub(crate) fn shortest(text: &mut String, number: f64) {
    let plain = number == 0.0 || (1e-5..1e16).contains(&number.abs());
    // Writing to a string cannot fail.
    let _ = if plain {
        write!(text, "{number}")
    } else {
        write!(text, "{number:e}")
    };
}

#[cfg(test)]
mod tests {
    use crate::{obj, off, ply, stl};
    use dapple_mesh::{EncodedImage, Model};

    const OBJ: &str = "# C:\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n";
    const OFF: &str = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";

    type Encode = fn(&str) -> Vec<u8>;

    fn read_all(mark: &[u8], encode: Encode) -> Vec<Result<Model, String>> {
        let bytes = |text: &str| [mark, &encode(text)].concat();
        let library = |_: &str| Some(bytes("newmtl red\nmap_Kd red.png\n"));
        let mut models = vec![
            obj::read(&bytes(OBJ)),
            off::read(&bytes(OFF)),
            ply::read(&bytes(PLY)),
            stl::read(&bytes(STL)),
            obj::read_with(OBJ.replace('v', "mtllib a.mtl\nv").as_bytes(), &mut {
                library
            }),
        ];
        #[cfg(feature = "gltf")]
        models.push(crate::gltf::read(&bytes(
            r#"{"asset":{"version":"2.0"},"scenes":[{}]}"#,
        )));
        let text = |error: crate::MeshIoError| error.to_string();
        models
            .into_iter()
            .map(|model| model.map_err(text))
            .collect()
    }

    #[test]
    fn a_mark_of_utf_8_changes_nothing() {
        let encode = |text: &str| text.as_bytes().to_vec();
        let plain = read_all(b"", encode);
        assert!(plain.iter().all(Result::is_ok), "{plain:?}");
        assert_eq!(read_all(b"\xef\xbb\xbf", encode), plain);
    }

    #[test]
    fn the_first_lines_of_a_library_and_of_its_model_are_read_after_a_mark() {
        let png = b"\x89PNG\r\n\x1a\n".to_vec();
        let mut resolve = |name: &str| match name {
            "a.mtl" => Some("\u{feff}newmtl red\nmap_Kd red.png\n".into()),
            "red.png" => Some(png.clone()),
            _ => None,
        };
        let text = "\u{feff}mtllib a.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let model = obj::read_with(text.as_bytes(), &mut resolve).expect("it is valid");
        assert_eq!(
            model.material.base_color,
            EncodedImage::new(png.clone()).ok()
        );
    }

    #[test]
    fn other_encodings_are_named() {
        let low16 = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let high16 = |text: &str| text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let low32 = |text: &str| {
            text.chars()
                .flat_map(|at| u32::from(at).to_le_bytes())
                .collect()
        };
        let high32 = |text: &str| {
            text.chars()
                .flat_map(|at| u32::from(at).to_be_bytes())
                .collect()
        };
        let encodings: [(&str, &[u8], Encode); 4] = [
            ("UTF-16", b"\xff\xfe", low16),
            ("UTF-16", b"\xfe\xff", high16),
            ("UTF-32", b"\xff\xfe\0\0", low32),
            ("UTF-32", b"\0\0\xfe\xff", high32),
        ];
        for (name, mark, encode) in encodings {
            for mark in [mark, b""] {
                for model in read_all(mark, encode) {
                    let error = model.expect_err("it is refused");
                    assert!(error.contains(name), "{name}: {error}");
                }
            }
        }
    }

    #[test]
    fn keywords_that_are_not_ascii_are_refused_with_their_line() {
        let text = "# \u{e9}\nv 0 0 0\nv\u{a0}9 9 9\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let error = obj::read(text.as_bytes()).expect_err("it is refused");
        let want = "this is not a valid OBJ file: line 3: the keyword `v\\u{a0}9` is not ASCII";
        assert_eq!(error.to_string(), want);
        let mut library = |_: &str| Some("newmtl a\nmap_Kd\u{a0}a.png\n".into());
        let text = "mtllib a.mtl\no \u{e9}\nv 0 0 0\n";
        let error = obj::read_with(text.as_bytes(), &mut library).expect_err("it is refused");
        assert!(error.to_string().contains("MTL file: line 2"), "{error}");
        let text = PLY.replace("element", "comment \u{e9}\nelement");
        assert!(ply::read(text.as_bytes()).is_ok(), "text of people");
        let text = PLY.replace("property float x", "property\u{a0}float x");
        let error = ply::read(text.as_bytes()).expect_err("it is refused");
        assert!(error.to_string().contains("line 4"), "{error}");
    }
}
