//! Bakes the files of an export. They have the same bytes as the files of `dapple bake` with the same options.

use dapple_image::{Depth, Encoding, RowWriter};
use dapple_recipe::{Bake, BakeOptions, Images, MapKind, Plan, Recipe};
use dapple_studio::{Export, FileSize, MAX_SIDE, StudioError, map_kinds};
use std::io::Cursor;

/// Renders the files of an export. Returns the name, length and content of each.
pub(crate) fn files(
    recipe: &Recipe,
    export: &Export,
) -> Result<Vec<(FileSize, Vec<u8>)>, StudioError> {
    let (encoding, ending) = encoding(export)?;
    let size = export.size.unwrap_or([1024; 2]);
    if size.iter().any(|&side| side > MAX_SIDE) {
        let message = format!("a side of a picture is at most {MAX_SIDE} pixels");
        return Err(StudioError::new(message));
    }
    let maps = map_kinds(export.maps.as_deref().unwrap_or_default())?;
    let plan = Plan::new(recipe, &Images::new(), 0.0)?;
    let options = BakeOptions {
        size,
        maps: maps.clone(),
        ..BakeOptions::default()
    };
    // Write the maps band by band, each to a buffer.
    let writer = |kind: &MapKind| {
        RowWriter::new(Cursor::new(Vec::new()), size, kind.content(), encoding).map_err(told)
    };
    let mut writers = maps.iter().map(writer).collect::<Result<Vec<_>, _>>()?;
    for band in Bake::new(&plan, &options)? {
        for ((_, rows), writer) in band?.maps.iter().zip(&mut writers) {
            rows.write(writer).map_err(told)?;
        }
    }
    let stem = match recipe.name.as_str() {
        "" => "recipe",
        name => name,
    };
    let file = |(kind, writer): (&MapKind, RowWriter<Cursor<Vec<u8>>>)| {
        let contents = writer.finish().map_err(told)?.into_inner();
        let name = format!("{stem}_{}.{ending}", kind.name());
        let bytes = contents.len();
        Ok((FileSize { name, bytes }, contents))
    };
    maps.iter().zip(writers).map(file).collect()
}

/// Returns the encoding of the files and their extension.
fn encoding(export: &Export) -> Result<(Encoding, &'static str), StudioError> {
    let Export {
        preset: None,
        normal_y: None,
        frame: None,
        frames: None,
        folder: None,
        ..
    } = export
    else {
        let error = StudioError::new("presets, directions of normals and loops are not made here");
        return Err(
            error.with_hint("copy the recipe as a command, and let `dapple bake` make them")
        );
    };
    Ok(match export.format.as_deref().unwrap_or("png16") {
        "png8" => (Encoding::Png(Depth::Eight), "png"),
        "png" | "png16" => (Encoding::Png(Depth::Sixteen), "png"),
        "npy" => (Encoding::Npy, "npy"),
        other => {
            let message = format!("the format `{other}` is not made here");
            return Err(StudioError::new(message).with_hint("ask for png8, png16 or npy"));
        }
    })
}

fn told(error: dapple_image::ImageError) -> StudioError {
    StudioError::new(error.to_string())
}
