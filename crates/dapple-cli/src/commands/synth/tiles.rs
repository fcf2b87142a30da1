//! UDIM tiles: unit squares of texture coordinates with a texture each. The textures of an example are joined in one
//! image, the sheet.

use super::reading::joined;
use crate::encode::map_raster;
use crate::error::{Hint, usage};
use crate::input::{self, Loaded};
use anyhow::{Result, anyhow};
use dapple::mesh_io::tile_name;
use dapple::points::glam::DVec2;
use dapple::raster::{Raster, Wrap};
use dapple::synth::SideBySide;
use dapple::tile::Map;
use std::path::{Path, PathBuf};

/// The UDIM tiles of a mesh, and the tile of each face.
#[derive(Clone, Debug)]
pub(super) struct Tiles {
    /// The UDIM numbers of the tiles, such as 1001.
    pub(super) numbers: Vec<u32>,
    /// For each face, the index of its tile.
    of_face: Vec<usize>,
    /// The texture coordinates of each face within its tile, from 0 to 1.
    local: Vec<[DVec2; 3]>,
}

/// Layout of the textures of all UDIM tiles in one image. Each texture has a border that repeats its outermost texels,
/// so that interpolation near its sides does not read a neighboring texture.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    pub(super) tiles: Tiles,
    /// Columns and rows of the texture of a tile, without its border.
    size: [u32; 2],
    layout: SideBySide,
}

/// Width of the border of a tile, in texels.
const BORDER: u32 = 1;

impl Tiles {
    /// Assigns each face to one of the tiles `numbers`, by its texture coordinates `uvs`.
    pub(super) fn new(numbers: Vec<u32>, uvs: &[[DVec2; 3]]) -> Result<Self> {
        let (mut of_face, mut local) = (Vec::new(), Vec::new());
        for corners in uvs {
            let mean = corners.iter().sum::<DVec2>() / 3.0;
            let [column, row] = [mean.x.floor(), (1.0 - mean.y).floor()];
            let number = 1001.0 + column + 10.0 * row;
            let found = numbers.iter().position(|&other| f64::from(other) == number);
            of_face.push(found.ok_or_else(|| anyhow!("a face lies in no unit square"))?);
            // Clamp corners, which may exceed the tile by rounding errors.
            let within = |uv: DVec2| (uv - DVec2::new(column, -row)).clamp(DVec2::ZERO, DVec2::ONE);
            local.push(corners.map(within));
        }
        Ok(Self {
            numbers,
            of_face,
            local,
        })
    }

    /// Returns the texture coordinates of all faces within `tile`. Faces of other tiles get NaN, so that an atlas
    /// leaves them out.
    pub(super) fn uvs_of(&self, tile: usize) -> Vec<[DVec2; 3]> {
        let faces = self.of_face.iter().zip(&self.local);
        let corners = |(&of_face, &local): (&usize, &[DVec2; 3])| match of_face == tile {
            true => local,
            false => [DVec2::NAN; 3],
        };
        faces.map(corners).collect()
    }

    /// Returns the files of all tiles, for a name with a placeholder such as `<UDIM>`; `None` for other names.
    fn paths(&self, path: &Path) -> Option<Vec<PathBuf>> {
        let name = path.file_name()?.to_str()?;
        let paths = self.numbers.iter().map(|&number| {
            let name = tile_name(name, number)?;
            Some(path.with_file_name(name))
        });
        paths.collect()
    }
}

impl Sheet {
    /// Creates the layout for tiles with textures of `size` columns and rows.
    pub(super) fn new(tiles: Tiles, size: [u32; 2]) -> Result<Self> {
        let with_border = size.map(|side| side.saturating_add(2 * BORDER));
        let layout = SideBySide::new(&vec![with_border; tiles.numbers.len()])?;
        Ok(Self {
            tiles,
            size,
            layout,
        })
    }

    /// Returns the texture coordinates of all faces as positions in the sheet.
    pub(super) fn uvs(&self) -> Vec<[DVec2; 3]> {
        let all = DVec2::from(self.layout.size().map(f64::from));
        let size = DVec2::from(self.size.map(f64::from));
        let faces = self.tiles.of_face.iter().zip(&self.tiles.local);
        let placed = |(&tile, corners): (&usize, &[DVec2; 3])| {
            let first = DVec2::from(self.first(tile).map(f64::from));
            corners.map(|uv| (first + uv * size) / all)
        };
        faces.map(placed).collect()
    }

    /// Returns the first column and row of a tile's texture within the sheet.
    fn first(&self, tile: usize) -> [u32; 2] {
        // The layout leaves a column between two images.
        let width = self.size[0] + 2 * BORDER + 1;
        [tile as u32 * width + BORDER, BORDER]
    }

    /// Joins the textures of all tiles into one image.
    ///
    /// # Errors
    ///
    /// If the textures differ in size.
    pub(super) fn join(&self, mut tiles: Vec<Loaded>) -> Result<Loaded> {
        for (tile, number) in tiles.iter_mut().zip(&self.tiles.numbers) {
            let [size, here] = [self.size, tile.map.size()];
            if size != here {
                let error = anyhow!(
                    "a texture of unit square {number} has {} × {} pixels, and that of {} {} × {}",
                    here[0],
                    here[1],
                    self.tiles.numbers[0],
                    size[0],
                    size[1]
                );
                return Err(error.hint("scale the textures of all unit squares to one size"));
            }
            tile.map = map_raster!(&tile.map, raster => bordered(raster)?);
            tile.alpha = tile.alpha.as_ref().map(bordered).transpose()?;
        }
        joined(&self.layout, tiles)
    }

    /// Joins the masks of all tiles in one mask, which is black between the tiles.
    pub(super) fn join_masks(&self, masks: &[Raster<bool>]) -> Result<Raster<bool>> {
        let masks = masks.iter().map(bordered).collect::<Result<Vec<_>>>()?;
        Ok(self.layout.join(&masks.iter().collect::<Vec<_>>(), false)?)
    }

    /// Crops a tile's texture from the sheet.
    pub(super) fn part<T: Copy>(&self, sheet: &Raster<T>, tile: usize) -> Result<Raster<T>> {
        Ok(sheet.crop(self.first(tile), self.size)?)
    }

    /// Crops a tile's map, with its alpha, from the sheet.
    pub(super) fn part_of(&self, sheet: &Loaded, tile: usize) -> Result<Loaded> {
        let map = map_raster!(&sheet.map, raster => self.part(raster, tile)?);
        let mut part = sheet.with_map(map);
        let alpha = sheet.alpha.as_ref().map(|alpha| self.part(alpha, tile));
        part.alpha = alpha.transpose()?;
        part.is_associated = sheet.is_associated;
        Ok(part)
    }

    /// Reads the file of each tile with `read`.
    ///
    /// # Errors
    ///
    /// If the file name has no placeholder for the tile number, or `read` fails.
    pub(super) fn read<T>(
        &self,
        path: &Path,
        example: &Path,
        read: impl Fn(&Path) -> Result<T>,
    ) -> Result<Vec<T>> {
        let Some(paths) = self.tiles.paths(path) else {
            let (name, example) = (input::name(path), input::name(example));
            let n_tiles = self.tiles.numbers.len();
            let error = usage(format!(
                "{name} is one image, but {example} has textures in {n_tiles} unit squares"
            ));
            return Err(error.hint("give one for each: its name has <UDIM> in place of the number"));
        };
        paths.iter().map(|path| read(path)).collect()
    }

    /// Returns the columns and rows of the texture of a tile.
    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }
}

/// Adds a border that repeats the outermost texels of a texture.
fn bordered<T: Copy + Send + Sync>(raster: &Raster<T>) -> Result<Raster<T>> {
    let size = raster.size().map(|side| side.saturating_add(2 * BORDER));
    let inside = |at: u32| i64::from(at) - i64::from(BORDER);
    let pixel = |column, row| *raster.at(inside(column), inside(row), [Wrap::Clamp; 2]);
    Ok(Raster::from_fn(size, pixel)?)
}

#[cfg(test)]
mod tests {
    use super::{Sheet, Tiles};
    use crate::input::Loaded;
    use dapple::color::LinearRgb;
    use dapple::points::glam::DVec2;
    use dapple::raster::{Raster, Wrap};
    use dapple::tile::Map;

    #[test]
    fn a_sheet_has_the_texture_of_each_square_up_to_its_sides() {
        let tile = |first: u32| {
            let value = |x, y| LinearRgb::gray((first + x + 7 * y) as f32);
            Raster::from_fn([6, 4], value).unwrap()
        };
        let tiles = [100, 500, 900].map(tile);
        // Include corners on the sides of a tile.
        let local = [[0.0, 0.0], [1.0, 0.0], [0.3, 1.0]].map(DVec2::from_array);
        let firsts = [[0.0, 0.0], [3.0, 0.0], [1.0, -2.0]].map(DVec2::from_array);
        let uvs = firsts.map(|first| local.map(|uv| uv + first));
        let sheet = Tiles::new(vec![1001, 1004, 1022], &uvs).unwrap();
        let sheet = Sheet::new(sheet, [6, 4]).unwrap();
        let joined = sheet.join(tiles.iter().cloned().map(Loaded::of_colors).collect());
        let Map::Color(joined) = joined.unwrap().map else {
            panic!("colors stay colors");
        };
        let clamp = [Wrap::Clamp; 2];
        for (corners, tile) in sheet.uvs().iter().zip(&tiles) {
            for (&there, &here) in corners.iter().zip(&local) {
                let [there, here] = [
                    joined.sample_area(there, DVec2::ZERO, clamp).r,
                    tile.sample_area(here, DVec2::ZERO, clamp).r,
                ];
                // Positions in the sheet are rounded.
                assert!((there - here).abs() < 1e-3, "{there} {here}");
            }
        }
        for (at, tile) in tiles.iter().enumerate() {
            assert_eq!(sheet.part(&joined, at).unwrap(), *tile);
            let uvs = sheet.tiles.uvs_of(at);
            let errors = uvs[at]
                .iter()
                .zip(&local)
                .map(|(uv, want)| uv.distance(*want));
            assert!(errors.fold(0.0, f64::max) < 1e-12, "turns are taken off");
            assert!(uvs[(at + 1) % 3][0].is_nan(), "another square");
        }
        assert!(Tiles::new(vec![1001], &uvs).is_err());
    }
}
