//! Renders a map of regions that tiles: Voronoi cells of points on a torus, each colored by its area.
//!
//! ```sh
//! cargo run -p dapple --example 16_voronoi
//! ```

mod out;

use dapple::color::{LinearRgb, Palette};
use dapple::graph::Voronoi;
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png};
use dapple::points::{Domain, PointIdx, poisson_disk};
use dapple::raster::{Raster, Window, glam::DVec2};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Returns the Voronoi regions of the unit square, whose opposite sides are joined.
fn regions(seed: Seed) -> Result<Voronoi> {
    let domain = Domain::torus(DVec2::ZERO, DVec2::ONE);
    Ok(Voronoi::new(&poisson_disk(domain, 0.08, seed)?)?)
}

/// Renders each region with a brightness that depends on its area, and dark borders.
fn draw(regions: &Voronoi, size: u32) -> Result<Raster<LinearRgb>> {
    let n_cells = regions.n_cells() as f64;
    let window = Window::unit([size; 2])?;
    let mut image = Raster::filled([size; 2], LinearRgb::BLACK)?;
    let mut site = PointIdx(0);
    for (row, pixels) in (0..).zip(image.view_mut().rows_mut()) {
        for (column, pixel) in (0..).zip(pixels) {
            // Start the walk at the site of the previous pixel.
            let nearest = regions.locate(window.position(column, row), site)?;
            site = nearest.site;
            let cell = regions.cell(site);
            let area = cell.area().unwrap_or(0.0) * n_cells;
            // The distance to the border: to the line halfway to each neighbor
            let to_border = cell.sides().map(|side| {
                let axis = side.neighbor.vector;
                (0.5 * axis.length_squared() - axis.dot(nearest.offset)) / axis.length()
            });
            let is_border = to_border.fold(1.0, f64::min) < 0.004;
            *pixel = match is_border {
                true => LinearRgb::gray(0.01),
                false => Palette::Terrain.ramp().at((0.6 * area - 0.1) as f32),
            };
        }
    }
    Ok(image)
}

fn main() -> Result<()> {
    let path = out::path("16_voronoi.png")?;
    write_color_png(&path, &draw(&regions(Seed(7))?, 512)?, Depth::Eight)?;
    out::wrote(&path);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{draw, regions};
    use dapple::hash::Seed;
    use dapple::points::PointIdx;

    #[test]
    fn regions_cover_the_torus_with_six_sides_on_average() {
        let regions = regions(Seed(7)).unwrap();
        let cells = (0..regions.n_cells() as u32).map(|site| regions.cell(PointIdx(site)));
        let area: f64 = cells.clone().filter_map(|cell| cell.area()).sum();
        // The sum of about a hundred areas, each rounded.
        assert!((area - 1.0).abs() < 1e-9, "{area}");
        // Euler: on a torus the number of vertices and cells together equals the number of sides, and three sides meet
        // at a vertex.
        let sides: usize = cells.map(|cell| cell.sides().len()).sum();
        assert_eq!(sides, 6 * regions.n_cells());
        draw(&regions, 32).unwrap();
    }
}
