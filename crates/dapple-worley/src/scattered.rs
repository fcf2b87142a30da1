//! Samples many scattered positions, such as the shading points of a renderer.

use crate::dispatch::DimensionDispatch as _;
use crate::fixed::Place;
use crate::many::{GROUP, Group, Points};
use crate::sink::Tone;
use crate::{Dimensions, Feature, MAX_NEAREST, Space, Vector, Worley, WorleyError};
use core::ops::Range;
use dapple_raster::simd;

impl<const N: usize> Worley<N>
where
    Dimensions: Space<N>,
{
    /// Finds the `K` nearest feature points of each of many positions, in any order. The results equal those of
    /// [`sample`](Self::sample), bit for bit, and take a fraction of the time.
    ///
    /// # Errors
    ///
    /// [`Length`](crate::WorleyErrorKind::Length) if the lengths of `features` and `positions` differ.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_worley::{Worley3, hash::Seed, raster::glam::DVec3};
    ///
    /// let worley = Worley3::new(Seed(7));
    /// let positions = [DVec3::new(0.5, 0.25, 3.0), DVec3::splat(-1e6)];
    /// let mut features = [worley.sample::<2>(DVec3::ZERO); 2];
    /// worley.sample_many(&positions, &mut features)?;
    /// assert_eq!(features[1], worley.sample(positions[1]));
    /// # Ok::<(), dapple_worley::WorleyError>(())
    /// ```
    pub fn sample_many<const K: usize>(
        &self,
        positions: &[impl Copy + Into<[f64; N]>],
        features: &mut [[Feature<Vector<N>>; K]],
    ) -> Result<(), WorleyError> {
        const {
            assert!(
                K >= 1 && K <= MAX_NEAREST,
                "F1 to F4 are there to be asked for"
            );
        };
        WorleyError::check_length(features.len(), positions.len())?;
        // A loop for three points is hardly faster than the one for four, but takes as long to compile.
        let depth = if K == 3 { MAX_NEAREST } else { K };
        self.each_group(depth, positions, |range, holds, points| {
            let positions = &positions[range.clone()];
            let features = &mut features[range];
            if holds != 0 {
                put(points, features);
            }
            // Search the remaining positions on their own.
            let mut again = u64::MAX >> (64 - positions.len()) & !holds;
            while again != 0 {
                let place = again.trailing_zeros() as usize;
                features[place] = self.sample(positions[place]);
                again &= again - 1;
            }
        });
        Ok(())
    }

    /// Computes the values of a combination at many positions.
    pub(crate) fn tones(
        &self,
        tone: &Tone,
        positions: &[impl Copy + Into<[f64; N]>],
        values: &mut [f32],
    ) {
        // Combinations share two loops, for two and for four points, since each takes long to compile.
        let depth = if tone.depth() <= 2 { 2 } else { MAX_NEAREST };
        self.each_group(depth, positions, |range, holds, points| {
            for (place, index) in range.enumerate() {
                values[index] = if holds >> place & 1 != 0 {
                    let mut distances = [0.0; MAX_NEAREST];
                    for (distance, points) in distances.iter_mut().zip(points) {
                        *distance = points.distances[place];
                    }
                    tone.of(&distances)
                } else {
                    let place = Place::new(positions[index].into());
                    place.map_or(f32::NAN, |place| tone.at(self, &place))
                };
            }
        });
    }

    /// Calls `put` with the index of each position, and the distance and the id of its nearest point.
    pub(crate) fn nearest_of_many(
        &self,
        positions: &[impl Copy + Into<[f64; N]>],
        mut put: impl FnMut(usize, f32, u64),
    ) {
        self.each_group(2, positions, |range, holds, points| {
            let nearest = &points[0];
            for (place, index) in range.enumerate() {
                if holds >> place & 1 != 0 {
                    put(index, nearest.distances[place], nearest.ids[place]);
                } else {
                    let [Feature { distance, id, .. }] = self.sample(positions[index]);
                    put(index, distance, id);
                }
            }
        });
    }

    /// Calls `found` for each group of positions. Its arguments are the range of the positions' indices, a bit mask of
    /// the positions for which the result is known to be exact, and the nearest points: 1, 2 or 4 for each position.
    fn each_group(
        &self,
        depth: usize,
        positions: &[impl Copy + Into<[f64; N]>],
        mut found: impl FnMut(Range<usize>, u64, &[Points<N>]),
    ) {
        let mut group = Group::new(depth);
        for (index, positions) in positions.chunks(GROUP).enumerate() {
            group.len = positions.len();
            // Transpose the positions to one array for each axis.
            for (place, &position) in positions.iter().enumerate() {
                let position: [f64; N] = position.into();
                for axis in 0..N {
                    group.positions[axis][place] = position[axis];
                }
            }
            let holds = Dimensions::search_group(self, simd::level(), &mut group);
            let first = index * GROUP;
            found(first..first + positions.len(), holds, group.points());
        }
    }
}

/// Writes the nearest points of each position to `features`.
fn put<const N: usize, const K: usize>(
    points: &[Points<N>],
    features: &mut [[Feature<Vector<N>>; K]],
) where
    Dimensions: Space<N>,
{
    for (place, features) in features.iter_mut().enumerate() {
        for (feature, points) in features.iter_mut().zip(points) {
            let mut vector = [0.0; N];
            for axis in 0..N {
                vector[axis] = points.vectors[axis][place];
            }
            *feature = Feature {
                distance: points.distances[place],
                vector: vector.into(),
                id: points.ids[place],
            };
        }
    }
}
