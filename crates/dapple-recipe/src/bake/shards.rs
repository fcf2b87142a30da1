//! Divides a map into shards: regions that can be baked independently, on any number of machines.

use crate::{RecipeError, Region};

/// The shards of a map, regions of equal size, row by row from the top. The last column and row of shards are cropped
/// at the border of the map.
///
/// Only sizes are stored, so even a long list takes no memory. A shard baked as the
/// [`region`](crate::BakeOptions::region) of a bake is, bit for bit, a crop of the whole map.
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
    overlap: u32,
}

impl Shards {
    /// Divides a map into shards. Both sizes are columns and rows, in pixels.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::RecipeErrorKind::Range) if a side of the map or of a shard is zero.
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
        Ok(Self {
            size,
            shard,
            overlap: 0,
        })
    }

    /// Sets the overlap, the number of columns and rows that neighboring shards share; 0 by default. They count as part
    /// of a shard's size. Terrain tiles have an overlap of 1.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::RecipeErrorKind::Range) unless the overlap is less than both of a shard's sides.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_recipe::{Region, Shards};
    ///
    /// let tiles = Shards::new([2017, 2017], [1009, 1009])?.with_overlap(1)?;
    /// assert_eq!(tiles.grid(), [2, 2]);
    /// assert_eq!(tiles.get(1), Some(Region { first: [1008, 0], size: [1009, 1009] }));
    /// # Ok::<(), dapple_recipe::RecipeError>(())
    /// ```
    pub fn with_overlap(self, overlap: u32) -> Result<Self, RecipeError> {
        let [width, height] = self.shard;
        RecipeError::check(
            overlap < width.min(height),
            "overlap of shards",
            overlap.into(),
            "less than the sides of a shard",
        )?;
        Ok(Self { overlap, ..self })
    }

    /// Returns the columns and rows of the map.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the columns and rows of a shard, before cropping at the border.
    #[must_use]
    pub fn shard(&self) -> [u32; 2] {
        self.shard
    }

    /// Returns the columns and rows of the grid of shards.
    #[must_use]
    pub fn grid(&self) -> [u32; 2] {
        let steps = self.steps();
        [0, 1].map(|axis| {
            let shared = self.size[axis].saturating_sub(self.overlap).max(1);
            shared.div_ceil(steps[axis])
        })
    }

    /// Returns the distance from a shard to the next one along each axis, in pixels. It is the shard size minus the
    /// overlap.
    #[must_use]
    pub fn steps(&self) -> [u32; 2] {
        self.shard.map(|side| side - self.overlap)
    }

    /// Returns the number of shards, at least 1.
    #[must_use]
    #[expect(
        clippy::len_without_is_empty,
        reason = "a picture has a pixel, and so a shard"
    )]
    pub fn len(&self) -> u64 {
        let [columns, rows] = self.grid();
        u64::from(columns) * u64::from(rows)
    }

    /// Returns the shard at `index`, or `None` past the last one. Its column in the [`grid`](Self::grid) is the index
    /// modulo the columns of the grid; its row is the quotient.
    #[must_use]
    pub fn get(&self, index: u64) -> Option<Region> {
        let columns = u64::from(self.grid()[0]);
        (index < self.len()).then(|| self.at([index % columns, index / columns]))
    }

    /// Returns all shards, in the order of their indices.
    pub fn iter(&self) -> impl Iterator<Item = Region> + use<> {
        let shards = *self;
        (0..shards.len()).map_while(move |index| shards.get(index))
    }

    /// Returns the shard at `place`, a column and row of the grid of shards.
    fn at(&self, place: [u64; 2]) -> Region {
        // Positions within the map fit in 32 bits.
        let steps = self.steps();
        let first = [0, 1].map(|axis| (place[axis] * u64::from(steps[axis])) as u32);
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
    fn neighbors_share_their_overlap_and_nothing_else() {
        for (size, shard, overlap) in [
            ([2017, 2017], [1009, 1009], 1),
            ([100, 70], [33, 9], 1),
            ([64, 64], [17, 20], 5),
            ([7, 3], [100, 2], 1),
            ([3, 2], [5, 5], 4),
        ] {
            let shards = Shards::new(size, shard).unwrap();
            let shards = shards.with_overlap(overlap).unwrap();
            let [columns, rows] = shards.grid();
            let at = |column: u32, row: u32| {
                let index = u64::from(row) * u64::from(columns) + u64::from(column);
                shards.get(index).unwrap()
            };
            for axis in 0..2 {
                let count = [columns, rows][axis];
                let along = |place: u32| match axis {
                    0 => at(place, 0),
                    _ => at(0, place),
                };
                let end = |region: &Region| region.first[axis] + region.size[axis];
                assert_eq!(along(0).first[axis], 0);
                assert_eq!(end(&along(count - 1)), size[axis], "{size:?} {shard:?}");
                for place in 1..count {
                    let [before, this] = [along(place - 1), along(place)];
                    assert_eq!(end(&before), this.first[axis] + overlap);
                    assert_eq!(before.size[axis], shard[axis], "only the last is cropped");
                    assert!(this.size[axis] > overlap, "it adds something");
                }
            }
        }
        let error = Shards::new([9, 9], [4, 5]).unwrap().with_overlap(4);
        assert!(error.unwrap_err().to_string().contains("overlap"));
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
