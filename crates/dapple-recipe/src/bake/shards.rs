//! Shards: the parts of a picture for independent bakes on any number of machines.

use crate::{RecipeError, Region};

/// The shards of a picture: regions of equal size, row by row from the top; the last ones are cropped at the border.
///
/// Only the two sizes are stored, so that a list may have any length. A shard baked as the
/// [`region`](crate::BakeOptions::region) of a bake is, bit for bit, that part of the whole picture.
///
/// # Examples
///
/// ```
/// use dapple_recipe::{Region, Shards};
///
/// let shards = Shards::new([200_000, 200_000], [2048, 2048])?;
/// assert_eq!(shards.grid(), [98, 98]);
/// assert_eq!(shards.len(), 9604);
/// assert_eq!(shards.get(99), Some(Region { first: [2048, 2048], size: [2048, 2048] }));
/// assert_eq!(shards.get(9603), Some(Region { first: [198_656; 2], size: [1344; 2] }));
/// assert_eq!(shards.iter().count(), 9604);
/// # Ok::<(), dapple_recipe::RecipeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shards {
    size: [u32; 2],
    shard: [u32; 2],
}

impl Shards {
    /// The shards of a picture of `size` columns and rows, with `shard` columns and rows each.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::RecipeErrorKind::Range) if a side of the picture or of the shard has no pixel.
    pub fn new(size: [u32; 2], shard: [u32; 2]) -> Result<Self, RecipeError> {
        let names = [
            "number of pixels along a side of the picture",
            "number of pixels along a side of a shard",
        ];
        for (sides, what) in [size, shard].into_iter().zip(names) {
            for side in sides {
                RecipeError::check(side > 0, what, side.into(), "at least 1")?;
            }
        }
        Ok(Self { size, shard })
    }

    /// Columns and rows of the picture.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Columns and rows of a shard.
    #[must_use]
    pub fn shard(&self) -> [u32; 2] {
        self.shard
    }

    /// The numbers of shards side by side, and one below the other.
    #[must_use]
    pub fn grid(&self) -> [u32; 2] {
        [0, 1].map(|axis| self.size[axis].div_ceil(self.shard[axis]))
    }

    /// The number of shards, at least 1.
    #[must_use]
    #[expect(
        clippy::len_without_is_empty,
        reason = "a picture has a pixel, and so a shard"
    )]
    pub fn len(&self) -> u64 {
        let [columns, rows] = self.grid();
        u64::from(columns) * u64::from(rows)
    }

    /// The shard with an index, or `None` past the last one. Its column among the shards is the index modulo the
    /// columns of the [`grid`](Self::grid).
    #[must_use]
    pub fn get(&self, index: u64) -> Option<Region> {
        let columns = u64::from(self.grid()[0]);
        (index < self.len()).then(|| self.at([index % columns, index / columns]))
    }

    /// All shards in the order of their indices.
    pub fn iter(&self) -> impl Iterator<Item = Region> + use<> {
        let shards = *self;
        (0..shards.len()).map_while(move |index| shards.get(index))
    }

    /// The shard in this column and row of the grid.
    fn at(&self, place: [u64; 2]) -> Region {
        // Both fit, since they are within the picture.
        let first = [0, 1].map(|axis| (place[axis] * u64::from(self.shard[axis])) as u32);
        let size = [0, 1].map(|axis| self.shard[axis].min(self.size[axis] - first[axis]));
        Region { first, size }
    }
}

#[cfg(test)]
mod tests {
    use super::Shards;
    use crate::{RecipeErrorKind, Region};

    #[test]
    fn shards_cover_every_pixel_once_and_go_row_by_row() {
        for (size, shard) in [
            ([256, 256], [64, 64]),
            ([100, 70], [64, 32]),
            ([7, 5], [100, 2]),
            ([1, 1], [1, 1]),
        ] {
            let shards = Shards::new(size, shard).unwrap();
            let mut covered = vec![0; size[0] as usize * size[1] as usize];
            let mut places = Vec::new();
            for Region { first, size: part } in shards.iter() {
                places.push([first[1], first[0]]);
                for y in first[1]..first[1] + part[1] {
                    for x in first[0]..first[0] + part[0] {
                        covered[(y * size[0] + x) as usize] += 1;
                    }
                }
            }
            assert!(
                covered.iter().all(|&count| count == 1),
                "{size:?} {shard:?}"
            );
            assert!(places.is_sorted(), "{places:?}");
            assert_eq!(places.len() as u64, shards.len());
        }
    }

    #[test]
    fn the_longest_list_of_shards_needs_no_memory() {
        let shards = Shards::new([u32::MAX; 2], [1; 2]).unwrap();
        let last = shards.len() - 1;
        let corner = [u32::MAX - 1; 2];
        let region = Region {
            first: corner,
            size: [1; 2],
        };
        assert_eq!(shards.get(last), Some(region));
        assert_eq!(shards.get(last + 1), None);
        assert_eq!(shards.get(u64::MAX), None);
    }

    #[test]
    fn shards_without_pixels_are_refused_by_name() {
        for (size, shard, part) in [([0, 4], [1, 1], "picture"), ([4, 4], [1, 0], "shard")] {
            let error = Shards::new(size, shard).unwrap_err();
            assert!(matches!(error.kind(), RecipeErrorKind::Range { .. }));
            assert!(error.to_string().contains(part), "{error}");
        }
    }
}
