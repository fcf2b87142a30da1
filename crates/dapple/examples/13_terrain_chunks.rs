//! Generates an infinite world chunk by chunk; heights, biomes and trees match wherever two chunks meet.
//!
//! ```sh
//! cargo run -p dapple --example 13_terrain_chunks
//! ```

mod out;

use dapple::color::{LinearRgb, Palette};
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png};
use dapple::noise::GradientNoise2;
use dapple::points::{EndlessPoint, EndlessPoissonDisk};
use dapple::raster::{Field, FieldExt, FractalShape, Raster, Window, glam::DVec2};
use dapple::worley::Worley2;

/// Side of a chunk, in meters and in pixels.
const CHUNK: u32 = 64;

/// Number of chunks along a side of the image.
const CHUNKS: u32 = 4;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// All inputs for generating a chunk. It stores no chunks and can be shared between threads.
struct World<H, B> {
    /// Height in multiples of 40 meters, with sea level at 0.
    heights: H,
    /// Random number from 0 to 1 for each cell, about 100 meters wide.
    biomes: B,
    /// Positions of trees, at least 3 meters apart.
    trees: EndlessPoissonDisk,
    /// Pixels of the chunk at the origin. All other chunks are windows of the same grid.
    grid: Window,
}

/// A part of the world.
struct Chunk {
    heights: Raster<f32>,
    biomes: Raster<f32>,
    trees: Vec<EndlessPoint>,
}

fn world(seed: Seed) -> Result<World<impl Field, impl Field>> {
    let noise = GradientNoise2::new(seed.child("height", 0));
    let cells = Worley2::new(seed.child("biome", 0));
    Ok(World {
        heights: noise
            .fractal(5, 0.5, 2.0, FractalShape::Sum)?
            .frequency(1.0 / 150.0),
        biomes: cells.cell_values().frequency(1.0 / 100.0),
        trees: EndlessPoissonDisk::new(3.0, seed.child("tree", 0))?,
        grid: Window::new(DVec2::ZERO, DVec2::splat(CHUNK.into()), [CHUNK; 2])?,
    })
}

impl<H: Field, B: Field> World<H, B> {
    /// Returns a square of `size` × `size` chunks as a single chunk. `[column, row]` is its first chunk.
    fn chunk(&self, [column, row]: [i64; 2], size: u32) -> Result<Chunk> {
        let side = i64::from(CHUNK);
        let window = self
            .grid
            .crop([column * side, row * side], [size * CHUNK; 2])?;
        let [x, y] = [column, row].map(|chunk| (chunk * side) as f64);
        let length = f64::from(size * CHUNK);
        let mut trees = self.trees.points([x, y], [x + length, y + length])?;
        // Each tree evaluates the world at its position, so the adjacent chunks need not exist.
        trees.retain(|tree| {
            let is_forest = self.biomes.sample(tree.position) > 0.5;
            let height = self.heights.sample(tree.position);
            is_forest && (0.02..0.3).contains(&height)
        });
        Ok(Chunk {
            heights: self.heights.to_raster(&window)?,
            biomes: self.biomes.to_raster(&window)?,
            trees,
        })
    }
}

/// Renders an image of several chunks, each generated separately.
fn draw(seed: Seed) -> Result<Raster<LinearRgb>> {
    let world = world(seed)?;
    let side = CHUNK * CHUNKS;
    let mut picture = Raster::filled([side; 2], LinearRgb::default())?;
    let ground = Palette::Terrain.ramp();
    let mut trees = Vec::new();
    for (row, column) in (0..CHUNKS).flat_map(|row| (0..CHUNKS).map(move |column| (row, column))) {
        let chunk = world.chunk([column.into(), row.into()], 1)?;
        for (at, (&height, &biome)) in
            (0..).zip(chunk.heights.pixels().iter().zip(chunk.biomes.pixels()))
        {
            let [x, y] = [column * CHUNK + at % CHUNK, row * CHUNK + at / CHUNK];
            picture.pixels_mut()[(y * side + x) as usize] =
                // Biomes differ slightly in brightness.
                ground.at(0.5 + 0.8 * height) * (0.8 + 0.3 * biome);
        }
        trees.extend(chunk.trees);
    }
    for tree in trees {
        // The id of a tree determines its brightness.
        let shade = 0.02 + 0.06 * (tree.id >> 40) as f32 / (1 << 24) as f32;
        let [x, y] = tree.position.to_array().map(|at| at as u32);
        picture.pixels_mut()[(y * side + x) as usize] =
            LinearRgb::new(0.2 * shade, shade, 0.2 * shade);
    }
    Ok(picture)
}

fn main() -> Result<()> {
    let path = out::path("13_terrain_chunks.png")?;
    write_color_png(&path, &draw(Seed(7))?, Depth::Eight)?;
    out::wrote(&path);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{CHUNK, CHUNKS, draw, world};
    use dapple::hash::Seed;
    use dapple::raster::Raster;

    #[test]
    fn chunks_are_crops_of_a_larger_piece_of_the_world() {
        let world = world(Seed(7)).unwrap();
        // Test around the origin, and a hundred thousand kilometers away from it.
        for corner in [-1, 1_562_500] {
            let whole = world.chunk([corner, -1], 2).unwrap();
            let mut n_trees = 0;
            for [x, y] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                let part = world
                    .chunk([corner + i64::from(x), i64::from(y) - 1], 1)
                    .unwrap();
                let at = [x * CHUNK, y * CHUNK];
                let crop = |raster: &Raster<f32>| raster.crop(at, [CHUNK; 2]).unwrap();
                assert_eq!(part.heights, crop(&whole.heights));
                assert_eq!(part.biomes, crop(&whole.biomes));
                assert!(part.trees.iter().all(|tree| whole.trees.contains(tree)));
                n_trees += part.trees.len();
            }
            assert_eq!(n_trees, whole.trees.len());
        }
    }

    #[test]
    fn the_picture_has_land_and_sea_and_a_forest() {
        let seed = Seed(7);
        let whole = world(seed).unwrap().chunk([0, 0], CHUNKS).unwrap();
        let heights = whole.heights.pixels();
        assert!(heights.iter().any(|&height| height < -0.1));
        assert!(heights.iter().any(|&height| height > 0.1));
        assert!(whole.trees.len() > 300);
        let picture = draw(seed).unwrap();
        assert_eq!(picture.size(), whole.heights.size());
    }
}
