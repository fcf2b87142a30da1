use super::{EXEMPLARS, Edges, Exemplar};
use dapple_color::LinearRgb;
use dapple_raster::Raster;

fn draw(exemplar: &Exemplar, size: u32) -> Raster<LinearRgb> {
    (exemplar.draw)(size).unwrap()
}
