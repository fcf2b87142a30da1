//! Tests of what the command reports about files: sizes above the limit, arrays and heights, tables of numbers, loops
//! and clipping.

use crate::support::{Folder, assert_done, assert_refused, stderr, stdout};
use dapple::color::LinearRgb;
use dapple::image::{Depth, Limits, read_image, write_color_exr, write_gray_exr, write_gray_png};
use dapple::raster::Raster;
use std::fs;

/// Returns an image whose pixels all have different values, from 0 to below 1.
fn places(size: [u32; 2]) -> Raster<f32> {
    let n_pixels = (size[0] * size[1]) as f32;
    Raster::from_fn(size, |x, y| (y * size[0] + x) as f32 / n_pixels).unwrap()
}

fn run(folder: &Folder, line: &str) -> std::process::Output {
    folder.run(&line.split(' ').collect::<Vec<_>>())
}

/// Returns the checksum of a PNG chunk: CRC-32 of ISO 3309, computed bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32, bit: u32| (crc >> 1) ^ (0xedb8_8320 * ((crc ^ bit) & 1));
    let byte = |crc, &byte: &u8| (0..8).fold(crc, |crc, at| step(crc, u32::from(byte >> at)));
    !bytes.iter().fold(!0, byte)
}

/// Returns the start of a PNG file of the given size: signature and header, without pixels.
fn png_header(size: [u32; 2]) -> Vec<u8> {
    let mut chunk = b"IHDR".to_vec();
    chunk.extend(size.iter().flat_map(|side| side.to_be_bytes()));
    chunk.extend([16, 0, 0, 0, 0]);
    let crc = crc(&chunk).to_be_bytes();
    [b"\x89PNG\r\n\x1a\n\0\0\0\x0d", &chunk[..], &crc].concat()
}

#[test]
fn images_past_the_limit_are_described_by_their_headers() {
    let folder = Folder::new("headers");
    fs::write(folder.path("huge.png"), png_header([16_400, 16_400])).unwrap();
    let output = run(&folder, "info huge.png");
    assert_done(&output, "a header");
    let text = stdout(&output);
    assert!(
        text.contains("16400 × 16400 pixels, PNG, 16 bits per channel"),
        "{text}"
    );
    assert!(text.contains("more than 268435456"), "{text}");
    write_gray_exr(folder.path("a.exr"), &places([64, 32])).unwrap();
    let output = run(&folder, "info a.exr --max-pixels 2047 --format json");
    assert_done(&output, "a header of EXR");
    let json: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(json[0]["size"], serde_json::json!([64, 32]));
    assert!(json[0]["channels"].is_null(), "{json}");
    // What was not looked at passes no check.
    let output = run(&folder, "info a.exr --max-pixels 2047 --check");
    assert_eq!(output.status.code(), Some(3));
    let output = run(&folder, "info a.exr --max-pixels 2048");
    assert!(stdout(&output).contains("deviation"), "{}", stdout(&output));
}

/// Large numbers, such as light and terrain heights in meters, keep the columns of the table apart and below their titles.
#[test]
fn columns_of_large_numbers_stay_below_their_titles() {
    let folder = Folder::new("columns");
    let values = vec![-123_456.78, 98_765.43, 1.0e7, -1.0e9, 3.0e38, 0.0];
    let heights = Raster::from_vec([3, 2], values).unwrap();
    write_gray_exr(folder.path("a.exr"), &heights).unwrap();
    let text = stdout(&run(&folder, "info a.exr"));
    let mut lines = text.lines().skip(1);
    let (titles, row) = (lines.next().unwrap(), lines.next().unwrap());
    let end = |title: &str| titles.find(title).expect(title) + title.len();
    let mut start = end("min") - " ".len() - 11;
    for title in ["min", "max", "mean", "deviation"] {
        let number = row[start..end(title)].trim();
        assert!(
            number.parse::<f64>().is_ok(),
            "{title}: {number:?} in\n{text}"
        );
        assert_eq!(row.as_bytes()[start], b' ', "{title} in\n{text}");
        start = end(title);
    }
}

/// Returns small files of the formats that are only read, each with its name and its description.
fn read_only() -> [(&'static str, Vec<u8>, &'static str); 3] {
    let tga = [
        0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 24, 32, 0, 0, 255, 0, 255, 0,
    ];
    let start = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    let hdr = [start.as_slice(), &[128, 64, 0, 137, 1, 2, 3, 136]].concat();
    // The entries of width, height, bits, interpretation, offset, rows and bytes of one strip.
    let entries: [[u16; 2]; 7] = [
        [256, 2],
        [257, 1],
        [258, 16],
        [262, 1],
        [273, 98],
        [278, 1],
        [279, 4],
    ];
    let entry = |[tag, value]: [u16; 2]| [tag, 3, 1, 0, value, 0].map(u16::to_le_bytes).concat();
    let start = b"II*\0\x08\0\0\0\x07\0".as_slice();
    let tiff = [
        start,
        &entries.map(entry).concat(),
        &[0; 4],
        &[0, 128, 255, 255],
    ]
    .concat();
    [
        (
            "a.tga",
            tga.to_vec(),
            "2 × 1 pixels, TGA, 8 bits per channel\n",
        ),
        (
            "a.hdr",
            hdr,
            "2 × 1 pixels, Radiance HDR, read as 32-bit floating point\n",
        ),
        ("a.tif", tiff, "2 × 1 pixels, TIFF, 16 bits per channel\n"),
    ]
}

#[test]
fn formats_that_are_only_read_are_described_and_baked() {
    let folder = Folder::new("formats");
    for (name, bytes, description) in read_only() {
        fs::write(folder.path(name), bytes).unwrap();
        let text = stdout(&run(&folder, &format!("info {name}")));
        assert!(
            text.starts_with(&format!("{name}: {description}")),
            "{text}"
        );
        let text = stdout(&run(&folder, &format!("info {name} --max-pixels 1")));
        let format = description.split([',', '\n']).nth(1).unwrap();
        assert!(
            text.contains(&format!("{name}: 2 × 1 pixels,{format}\n")),
            "{text}"
        );
        let text = stdout(&run(&folder, &format!("info {name} --region 1,0,1,1")));
        assert!(text.starts_with(&format!("{name}: 1 × 1 pixels")), "{text}");
        let recipe = format!(
            "dapple = 1\nname = \"r\"\n[nodes.a.image]\nfile = \"{name}\"\n[material]\nalbedo = \"a\"\n"
        );
        fs::write(folder.path("r.toml"), recipe).unwrap();
        let line = format!("bake r.toml --size 2x1 --maps albedo -o {name}.exr");
        assert_done(&run(&folder, &line), &line);
        let file = read_image(folder.path(name), &Limits::default()).unwrap();
        let baked = read_image(folder.path(&format!("{name}.exr")), &Limits::default()).unwrap();
        // A gray image is data.
        let expected = match file.gray() {
            Ok(values) => values.map(|&value| LinearRgb::gray(value)),
            Err(_) => file.color().unwrap(),
        };
        assert_eq!(baked.color().unwrap(), expected, "{name}");
    }
    fs::write(folder.path("a.gif"), b"GIF89a").unwrap();
    let line = "info a.gif";
    assert_refused(
        &run(&folder, line),
        1,
        "TIFF, WebP, TGA and Radiance HDR images are read",
        line,
    );
}

#[test]
fn regions_of_images_past_the_limit_are_read_by_rows() {
    let folder = Folder::new("rows");
    for (name, depth) in [("a.png", Depth::Eight), ("b.png", Depth::Sixteen)] {
        write_gray_png(folder.path(name), &places([64, 48]), depth).unwrap();
        let whole = read_image(folder.path(name), &Limits::default()).unwrap();
        let expected = whole.gray().unwrap().crop([40, 30], [24, 18]).unwrap();
        let line = format!("tile {name} --method mirror --region 40,30,24,18 -o out-{name}");
        assert_done(&run(&folder, &line), "as a whole");
        let line = format!(
            "tile {name} --method mirror --region 40,30,24,18 --max-pixels 500 -o rows-{name}"
        );
        assert_done(&run(&folder, &line), "by rows");
        let [out, rows] =
            ["out", "rows"].map(|of| fs::read(folder.path(&format!("{of}-{name}"))).unwrap());
        assert_eq!(out, rows, "{name}");
        let output = run(
            &folder,
            &format!("info {name} --region 40,30,24,18 --max-pixels 500 --format json"),
        );
        let json: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!(json[0]["size"], serde_json::json!([24, 18]));
        let max = expected.statistics().max;
        assert_eq!(
            json[0]["channels"][0]["max"],
            serde_json::json!(max),
            "{json}"
        );
    }
    write_gray_exr(folder.path("c.exr"), &places([64, 48])).unwrap();
    for (name, options) in [("out-c.exr", "--quiet"), ("rows-c.exr", "--max-pixels 500")] {
        let line = format!("tile c.exr --method mirror --region 40,30,24,18 {options} -o {name}");
        assert_done(&run(&folder, &line), &line);
    }
    let [out, rows] =
        ["out", "rows"].map(|of| fs::read(folder.path(&format!("{of}-c.exr"))).unwrap());
    assert_eq!(out, rows, "blocks of OpenEXR");
    let line = "tile a.png --normal n.exr --method mirror --region 0,0,9,9 --max-pixels 500 -o d/";
    let codes = places([64, 48]).map(|&value| LinearRgb::gray(value));
    write_color_exr(folder.path("n.exr"), &codes).unwrap();
    assert_refused(&run(&folder, line), 2, "follows from all pixels", line);
    let line = "info a.png --region 40,30,25,18 --max-pixels 500";
    assert_refused(
        &run(&folder, line),
        2,
        "reaches out of the image of 64 × 48",
        line,
    );
    let line = "tile a.png -o c.png --max-pixels 500";
    assert_refused(&run(&folder, line), 1, "hint: add --max-pixels N", line);
    let line = "info a.png --region 0,0,40,40 --max-pixels 500";
    assert_refused(&run(&folder, line), 1, "limit of 500 pixels", line);
}

#[test]
fn arrays_and_heights_of_the_command_are_described() {
    let folder = Folder::new("arrays");
    let size = "--size 48";
    for name in ["h.exr", "h.npy", "h.r16", "h.png"] {
        let line = format!("worley {size} -o {name}");
        assert_done(&run(&folder, &line), &line);
    }
    let channel = |name: &str| {
        let output = run(&folder, &format!("info {name} --format json"));
        assert_done(&output, name);
        let json: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!(json[0]["size"], serde_json::json!([48, 48]), "{name}");
        json[0]["channels"][0].clone()
    };
    let exr = channel("h.exr");
    let npy = channel("h.npy");
    for key in ["min", "max", "mean", "deviation"] {
        assert_eq!(npy[key], exr[key], "{key} of the same numbers");
    }
    assert_eq!(
        channel("h.r16")["mean"],
        channel("h.png")["mean"],
        "the same codes"
    );
    fs::remove_file(folder.path("h.json")).unwrap();
    let output = run(&folder, "info h.r16");
    assert_refused(
        &output,
        1,
        "the size of h.r16 is not known",
        "without its size",
    );
    fs::write(folder.path("h.json"), r#"{"width": 48, "height": 49}"#).unwrap();
    let output = run(&folder, "info h.r16");
    assert_refused(
        &output,
        1,
        "4608 bytes, and 48 × 49 heights have 4704",
        "another size",
    );
    let bytes = fs::read(folder.path("h.npy")).unwrap();
    for end in [5, 40, 127, bytes.len() - 1] {
        fs::write(folder.path("cut.npy"), &bytes[..end]).unwrap();
        assert_refused(&run(&folder, "info cut.npy"), 1, "cut.npy", "cut off");
    }
}

#[test]
fn columns_of_tables_go_by_their_names() {
    let folder = Folder::with_inputs("columns");
    let draw = |text: &str| {
        fs::write(folder.path("p.csv"), text).unwrap();
        run(
            &folder,
            "pups control --points p.csv --size 16 --force -o p.png",
        )
    };
    let plain = draw("x,y,value\n0.25,0.5,0.1\n0.75,0.25,0.9\n");
    assert_done(&plain, "plain");
    let expected = fs::read(folder.path("p.png")).unwrap();
    for text in [
        "value,y,x\n0.1,0.5,0.25\n0.9,0.25,0.75\n",
        "\u{feff}x,y,value\n0.25,0.5,0.1\n0.75,0.25,0.9\n",
        "\u{feff}[{\"x\": 0.25, \"y\": 0.5, \"value\": 0.1}, {\"x\": 0.75, \"y\": 0.25, \"value\": 0.9}]",
    ] {
        assert_done(&draw(text), text);
        assert_eq!(fs::read(folder.path("p.png")).unwrap(), expected, "{text}");
    }
    for (text, part) in [
        (
            "x,y,level\n1,2,3\n",
            "x,y,value or x,y,value,ox,oy are needed",
        ),
        (
            "0,25;0,25;0,1\n",
            "semicolons, but commas are needed, and decimals are written with a point",
        ),
        ("1\t2\t3\n", "tabs"),
        ("\"1\",2,3\n", "quotes"),
    ] {
        assert_refused(&draw(text), 1, part, text);
    }
    let wide: Vec<u8> = "x,y,value\n1,2,3\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let wide = [&[0xff, 0xfe], &wide[..]].concat();
    fs::write(folder.path("p.csv"), &wide).unwrap();
    let output = run(&folder, "pups control --points p.csv --size 16 -o q.png");
    assert_refused(
        &output,
        1,
        "the text is UTF-16, but must be UTF-8",
        "UTF-16",
    );
    let recipe = run(&folder, "recipe flagstone -o plain.json");
    assert_done(&recipe, "a recipe in JSON");
    let text = fs::read_to_string(folder.path("plain.json")).unwrap();
    fs::write(folder.path("marked.json"), format!("\u{feff}{text}")).unwrap();
    let output = run(&folder, "bake marked.json --size 8 --maps height -o m.png");
    assert_done(&output, "a recipe with a mark");
}

#[test]
fn a_loop_in_which_nothing_moves_is_named() {
    let folder = Folder::new("still");
    let line = "bake flagstone --size 8 --maps height --frames 3 -o a/";
    let output = run(&folder, line);
    assert_done(&output, line);
    let text = stderr(&output);
    assert_eq!(
        text.matches("nothing in this recipe moves").count(),
        1,
        "{text}"
    );
    let frame =
        |number| fs::read(folder.path(&format!("a/flagstone_height_00{number}.png"))).unwrap();
    assert!(
        frame(1) == frame(2) && frame(1) == frame(3),
        "all are equal"
    );
    let moving = "dapple = 1\nname = \"m\"\n[nodes.a.worley]\nmotion = { cells = 1 }\n[material]\nheight = \"a\"\n";
    fs::write(folder.path("m.toml"), moving).unwrap();
    let line = "bake m.toml --size 8 --maps height --frames 2 -o b/";
    let output = run(&folder, line);
    assert_done(&output, line);
    assert!(!stderr(&output).contains("moves"), "{}", stderr(&output));
}

#[test]
fn heavy_clipping_is_said_with_its_share() {
    let folder = Folder::new("clipping");
    // Three of four values are above 1.
    let values = Raster::from_fn([16, 16], |x, _| x as f32 / 4.0 + 0.001).unwrap();
    write_gray_exr(folder.path("h.exr"), &values).unwrap();
    let recipe =
        "dapple = 1\nname = \"c\"\n[nodes.a.image]\nfile = \"h.exr\"\n[material]\nheight = \"a\"\n";
    fs::write(folder.path("c.toml"), recipe).unwrap();
    for (output, is_said) in [
        ("c.r16", true),
        ("c.png", true),
        ("c.exr", false),
        ("c.npy", false),
    ] {
        for line in [
            format!("bake c.toml --size 16 --maps height --force -o {output}"),
            format!("blend h.exr --force -o {output}"),
        ] {
            let run = run(&folder, &line);
            assert_done(&run, &line);
            let text = stderr(&run);
            assert_eq!(text.contains("75.0 % of them"), is_said, "{line}: {text}");
        }
    }
}
