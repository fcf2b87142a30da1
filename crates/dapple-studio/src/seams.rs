//! Seam reports, which measure how seamlessly a recipe's maps tile.

use crate::StudioError;
use crate::message::MapSeams;
use crate::render::{MAX_SIDE, planned};
use dapple::raster::Raster;
use dapple::recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Recipe};
use dapple::tile::{SeamOptions, SeamReport, TileError};

/// The measured maps. All other maps are derived from these.
const MAPS: [MapKind; 4] = [
    MapKind::Height,
    MapKind::Normal,
    MapKind::Albedo,
    MapKind::Roughness,
];

/// Returns a seam report for each map of a recipe. It covers only the channel of the map with the largest seam ratio.
pub(crate) fn report(
    recipe: &Recipe,
    images: &Images,
    size: [u32; 2],
) -> Result<Vec<MapSeams>, StudioError> {
    if size.iter().any(|&side| side == 0 || side > MAX_SIDE) {
        return Err(StudioError::new(format!(
            "a side of a picture is from 1 to {MAX_SIDE} pixels"
        )));
    }
    // Bake the maps of the whole tile.
    let plan = planned(recipe, images, 0.0)?;
    let options = BakeOptions {
        size,
        maps: MAPS.to_vec(),
        ..BakeOptions::default()
    };
    let maps = Bake::new(&plan, &options)?.whole_maps()?;
    // Measure the seams along the wrapping axes only.
    let axes = SeamOptions {
        axes: recipe.wrap,
        ..SeamOptions::default()
    };
    let report = |(kind, rows): &(MapKind, MapRows)| {
        // Measure every channel and keep the report with the largest ratio.
        let worst = channels(rows)?
            .into_iter()
            .map(|channel| SeamReport::of(&channel, &axes));
        let reports = worst.collect::<Result<Vec<_>, _>>()?;
        let ratio = |report: &SeamReport| {
            let sides = [&report.seams[0].x, &report.seams[0].y];
            sides
                .into_iter()
                .flatten()
                .fold(0.0, |worst: f64, seam| worst.max(seam.ratio))
        };
        let worst = reports.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
        Ok(worst.map(|report| map_seams(*kind, report)))
    };
    let maps = maps
        .iter()
        .map(report)
        .collect::<Result<Vec<_>, TileError>>();
    let maps = maps.map_err(|error| StudioError::new(error.to_string()))?;
    Ok(maps.into_iter().flatten().collect())
}

fn map_seams(kind: MapKind, report: &SeamReport) -> MapSeams {
    MapSeams {
        name: kind.name().to_owned(),
        text: report.to_string(),
    }
}

/// Splits a map into one raster per channel.
fn channels(rows: &MapRows) -> Result<Vec<Raster<f32>>, TileError> {
    Ok(match rows {
        MapRows::Gray(raster) => vec![raster.clone()],
        MapRows::Color(raster) => split(raster, |color| color.to_array()),
        MapRows::Normal(raster) => split(raster, |normal| normal.to_array()),
        MapRows::Packed(raster) => split(raster, |parts| *parts),
    })
}

fn split<T: Sync>(
    raster: &Raster<T>,
    parts: impl Fn(&T) -> [f32; 3] + Copy + Sync,
) -> Vec<Raster<f32>> {
    (0..3)
        .map(|index| raster.map(|pixel| parts(pixel)[index]))
        .collect()
}
