//! Generates points that are a minimum distance apart, also across the edges of a tile, for example as positions for
//! trees, stars or rivets.
//!
//! ```sh
//! cargo run -p dapple --example 03_poisson_disk
//! ```

mod out;

use dapple::hash::Seed;
use dapple::image::{Depth, write_gray_png};
use dapple::points::{Domain, poisson_disk};
use dapple::raster::{Raster, Window, glam::DVec2};

/// Number of pixels along a side of the image.
const SIDE: u32 = 512;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Points at least 0.04 apart on a unit square whose opposite sides are joined. There is no room for another
    // point.
    let domain = Domain::torus(DVec2::ZERO, DVec2::ONE);
    let points = poisson_disk(domain, 0.04, Seed(7))?;
    let closest = points.minimum_distance().unwrap_or(f64::INFINITY);
    assert!(closest >= 0.04, "two points are {closest} apart");

    // Draw a dot for each point. `delta` is the shortest offset, so a dot on an edge continues at the opposite edge.
    let window = Window::unit([SIDE, SIDE])?;
    let mut picture = Raster::filled(window.size, 1.0)?;
    for &point in points.positions() {
        let [column, row] = (point * f64::from(SIDE)).to_array().map(|at| at as i64);
        for [dx, dy] in (-4..=4).flat_map(|dy| (-4..=4).map(move |dx| [dx, dy])) {
            let wrapped = [column + dx, row + dy].map(|at| at.rem_euclid(SIDE.into()) as u32);
            let [x, y] = wrapped;
            let from_point = domain.delta(point, window.position(x, y).into()) * f64::from(SIDE);
            let ink = (4.0 - from_point.length()).clamp(0.0, 1.0) as f32;
            let at = (y * SIDE + x) as usize;
            picture.pixels_mut()[at] = f32::min(picture.pixels()[at], 1.0 - ink);
        }
    }

    let path = out::path("03_poisson_disk.png")?;
    write_gray_png(&path, &picture, Depth::Eight)?;
    out::wrote(&path);
    Ok(())
}
