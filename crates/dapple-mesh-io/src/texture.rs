//! Reads external textures, and formats messages for textures that cannot be read.

use crate::FileResolver;
use dapple_mesh::{EncodedImage, Model};

/// Tolerance for texture coordinates outside the range 0 to 1. Smaller excesses count as rounding errors.
const OUTSIDE: f64 = 1e-4;

/// Reads the texture called `name`. An error is the text for [`Model::left_out`](dapple_mesh::Model::left_out).
pub(crate) fn texture(name: &str, resolve: &mut FileResolver<'_>) -> Result<EncodedImage, String> {
    let bytes = resolve(name).ok_or_else(|| unreadable("texture", name))?;
    encoded(name, bytes)
}

/// Creates an image from the bytes of a texture file. `name` is used in error messages.
pub(crate) fn encoded(name: &str, bytes: Vec<u8>) -> Result<EncodedImage, String> {
    let wrong = |_| format!("the texture {}, which is neither PNG nor JPEG", shown(name));
    EncodedImage::new(bytes).map_err(wrong)
}

/// Placeholder in a texture name for the number of a unit square.
const UDIM: &str = "<UDIM>";
/// Placeholder for the column and row of a unit square, starting at 1, as in `u2_v1`.
const UVTILE: &str = "<UVTILE>";

/// Returns the texture name of a [unit square](Model::unit_squares), given a name with a placeholder; `None` if the
/// name has no placeholder. The placeholders, in upper or lower case, are `<UDIM>` for the number, and `<UVTILE>` for
/// the column and row.
///
/// # Examples
///
/// ```
/// use dapple_mesh_io::tile_name;
///
/// assert_eq!(tile_name("skin.<UDIM>.png", 1012).as_deref(), Some("skin.1012.png"));
/// assert_eq!(tile_name("skin_<UVTILE>.png", 1012).as_deref(), Some("skin_u2_v2.png"));
/// assert_eq!(tile_name("skin.png", 1012), None);
/// ```
#[must_use]
pub fn tile_name(name: &str, number: u32) -> Option<String> {
    let capitals = name.to_ascii_uppercase();
    let [column, row] = [number.checked_sub(1001)? % 10 + 1, (number - 1001) / 10 + 1];
    let marks = [
        (UDIM, number.to_string()),
        (UVTILE, format!("u{column}_v{row}")),
    ];
    marks.into_iter().find_map(|(mark, text)| {
        let at = capitals.find(mark)?;
        Some(format!("{}{text}{}", &name[..at], &name[at + mark.len()..]))
    })
}

/// Returns a name such as `skin.1001.png` with the placeholder instead of the number of a unit square. `None` if there
/// is only one square, or the name contains no number from `squares`.
pub(crate) fn name_of_all(name: &str, squares: &[u32]) -> Option<String> {
    let is_digit = |letter: Option<char>| letter.is_some_and(|letter| letter.is_ascii_digit());
    let with_mark = |number: &u32| {
        let number = number.to_string();
        let at = name.rfind(&number)?;
        let (before, after) = (&name[..at], &name[at + number.len()..]);
        let is_alone = !is_digit(before.chars().next_back()) && !is_digit(after.chars().next());
        is_alone.then(|| format!("{before}{UDIM}{after}"))
    };
    (squares.len() > 1).then(|| squares.iter().find_map(with_mark))?
}

/// Returns the message for a file that is missing or outside the folder.
pub(crate) fn unreadable(what: &str, name: &str) -> String {
    format!("the {what} {}, which cannot be read", shown(name))
}

/// Returns the file name for display, without control characters.
pub(crate) fn shown(name: &str) -> String {
    let plain = |letter: char| {
        if letter.is_control() {
            char::REPLACEMENT_CHARACTER
        } else {
            letter
        }
    };
    name.chars().map(plain).collect()
}

/// Returns whether a corner has texture coordinates outside the range 0 to 1.
pub(crate) fn is_outside(model: &Model) -> bool {
    let mut parts = model
        .uvs
        .iter()
        .flatten()
        .flatten()
        .flat_map(|uv| uv.to_array());
    parts.any(|part| !(-OUTSIDE..=1.0 + OUTSIDE).contains(&part))
}

#[cfg(test)]
mod tests {
    use crate::{obj, off, ply};
    use dapple_mesh::{EncodedImage, Model};
    use glam::DVec2;

    const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
    const TRIANGLE: &str =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";

    /// Reads a triangle with texture coordinates at the corners of the texture. `material` is the text of its material.
    fn obj_with(material: &str) -> Model {
        let library = format!("newmtl a\n{material}\n");
        let mut resolve = |name: &str| match name {
            "a.mtl" => Some(library.clone().into_bytes()),
            "a.png" => Some(PNG.to_vec()),
            "a.tif" => Some(b"II*\0".to_vec()),
            _ => None,
        };
        let text = format!("mtllib a.mtl\n{TRIANGLE}");
        obj::read_with(text.as_bytes(), &mut resolve).expect("it is valid")
    }

    #[test]
    fn scale_and_offset_of_a_texture_are_applied_to_corners() {
        for (options, want) in [
            ("-s 0.5 0.5 1", [[0.0, 1.0], [0.5, 1.0], [0.0, 0.5]]),
            ("-o 0.25 0.5", [[0.25, 0.5], [1.25, 0.5], [0.25, -0.5]]),
            ("-s 2 4 -o 0 1", [[0.0, 0.0], [2.0, 0.0], [0.0, -4.0]]),
            ("-s 0.5", [[0.0, 1.0], [0.5, 1.0], [0.0, 0.0]]),
        ] {
            let model = obj_with(&format!("map_Kd {options} a.png"));
            assert_eq!(
                model.uvs,
                Some(vec![want.map(DVec2::from_array)]),
                "{options}"
            );
            assert!(
                model.material.base_color.is_some() && model.left_out.is_empty(),
                "{options}"
            );
        }
        let model = obj_with("map_Kd -s 1e30 1e30 a.png");
        assert!(model.check().is_ok(), "at the limit");
        let library = |_: &str| Some(b"newmtl a\nmap_Kd -s 1e31 1 a.png\n".to_vec());
        let text = format!("mtllib a.mtl\n{TRIANGLE}");
        assert!(
            obj::read_with(text.as_bytes(), &mut { library }).is_err(),
            "beyond it"
        );
    }

    #[test]
    fn obj_lists_what_it_leaves_out_of_a_material() {
        for (material, want) in [
            (
                "map_Kd lost.png",
                vec!["the texture lost.png, which cannot be read"],
            ),
            (
                "map_Kd C:\\x\\a.png",
                vec!["the texture C:/x/a.png, which cannot be read"],
            ),
            (
                "map_Kd a.tif",
                vec!["the texture a.tif, which is neither PNG nor JPEG"],
            ),
            ("map_Kd -clamp on a.png", vec![]),
            (
                "map_Kd -clamp on -s 2 2 a.png",
                vec!["the option -clamp of the texture, which repeats here"],
            ),
            (
                "map_Kd -mm 0 2 a.png",
                vec!["the option -mm of the texture a.png"],
            ),
            (
                "map_Kd a.png\nnorm -s 2 2 a.png",
                vec!["the texture a.png, which has other texture coordinates"],
            ),
            (
                "map_Ks a.png\nbump a.png\nmap_Ks a.png",
                vec!["textures of the material: bump, map_Ks"],
            ),
        ] {
            assert_eq!(obj_with(material).left_out, want, "{material}");
        }
        let text = format!("mtllib lost.mtl\n{TRIANGLE}l 1 2\np 1\nsurf 0 1\n");
        let left_out = obj::read(text.as_bytes()).expect("it is valid").left_out;
        let library = "the material library lost.mtl, which cannot be read";
        assert_eq!(left_out, ["free-form surfaces", "lines", "points", library]);
        let library = |_: &str| Some(b"newmtl other\n".to_vec());
        let text = format!("mtllib a.mtl\n{TRIANGLE}");
        let model = obj::read_with(text.as_bytes(), &mut { library }).expect("it is valid");
        assert_eq!(model.left_out, ["the material a, which no library has"]);
    }

    #[test]
    fn ply_reads_the_texture_that_a_comment_names() {
        let text = |comments: &str| {
            format!(
                "ply\nformat ascii 1.0\n{comments}element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nelement edge 1\nproperty int vertex1\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1\n2\n"
            )
        };
        let read = |comments: &str| {
            let mut resolve = |name: &str| (name == "my scan.png").then(|| PNG.to_vec());
            ply::read_with(text(comments).as_bytes(), &mut resolve).expect("it is valid")
        };
        let model = read("comment TextureFile my scan.png\r\n");
        assert_eq!(
            model.material.base_color,
            EncodedImage::new(PNG.to_vec()).ok()
        );
        assert_eq!(model.left_out, ["the element edge"]);
        let lost = read("comment TextureFile lost.png\n");
        assert_eq!(
            lost.left_out,
            [
                "the element edge",
                "the texture lost.png, which cannot be read"
            ]
        );
        let two = read("comment TextureFile my scan.png\ncomment TextureFile b.png\n");
        assert_eq!(two.left_out, ["the element edge", Model::FURTHER_MATERIALS]);
        assert!(read("comment TextureFile\n").material.base_color.is_none());
    }

    #[test]
    fn off_lists_colors_of_faces() {
        let text = |face: &str| format!("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n{face}\n");
        let left_out = |face| {
            off::read(text(face).as_bytes())
                .expect("it is valid")
                .left_out
        };
        assert!(left_out("3 0 1 2").is_empty());
        assert_eq!(left_out("3 0 1 2 255 0 0"), ["colors of faces"]);
    }

    #[test]
    fn names_have_no_control_characters() {
        assert_eq!(super::shown("a\u{1b}[2Jb.png"), "a\u{fffd}[2Jb.png");
    }
}
