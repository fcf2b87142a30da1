//! The door for many scattered positions, such as the shading points of a renderer.

use crate::many::{GROUP, Group, Points, Search};
use crate::metric::{Chebyshev, Euclidean, Manhattan, Norm};
use crate::{Axes, Feature, LIMIT, Metric, Space, Vector, Worley, WorleyError};
use dapple_raster::simd;
use fearless_simd::{Level, dispatch};

impl<const N: usize> Worley<N>
where
    Axes: Space<N>,
{
    /// The `K` nearest feature points of each of many positions: what [`sample`](Self::sample) gives for each, bit for
    /// bit, several times as fast. Positions may lie anywhere and come in any order.
    ///
    /// # Errors
    ///
    /// [`Length`](crate::WorleyErrorKind::Length) if there are not as many `features` as `positions`.
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
        positions: &[Vector<N>],
        features: &mut [[Feature<Vector<N>>; K]],
    ) -> Result<(), WorleyError> {
        self.sample_many_at(simd::level(), positions, features)
    }

    /// As [`sample_many`](Self::sample_many), at a given SIMD level.
    pub(crate) fn sample_many_at<const K: usize>(
        &self,
        level: Level,
        positions: &[Vector<N>],
        features: &mut [[Feature<Vector<N>>; K]],
    ) -> Result<(), WorleyError> {
        const { assert!(K >= 1 && K <= LIMIT, "F1 to F4 are there to be asked for") };
        WorleyError::check_length(features.len(), positions.len())?;
        match K {
            1 => self.fill_groups::<1, K>(level, positions, features),
            2 => self.fill_groups::<2, K>(level, positions, features),
            // Hardly faster for three than for four, but as much to compile.
            _ => self.fill_groups::<4, K>(level, positions, features),
        }
        Ok(())
    }

    /// From the `D` nearest, at least as many as are asked for.
    fn fill_groups<const D: usize, const K: usize>(
        &self,
        level: Level,
        positions: &[Vector<N>],
        features: &mut [[Feature<Vector<N>>; K]],
    ) {
        let mut group = Group::<N, D>::new();
        let groups = positions.chunks(GROUP).zip(features.chunks_mut(GROUP));
        for (positions, features) in groups {
            let holds = match self.metric {
                // One at a time it would be, in any case.
                _ if self.lattice.density.is_some() => 0,
                Metric::Minkowski(_) => 0,
                Metric::Euclidean => self.search(level, Euclidean, positions, &mut group),
                Metric::Manhattan => self.search(level, Manhattan, positions, &mut group),
                Metric::Chebyshev => self.search(level, Chebyshev, positions, &mut group),
            };
            if holds != 0 {
                put(group.points(), features);
            }
            let mut again = u64::MAX >> (64 - positions.len()) & !holds;
            while again != 0 {
                let place = again.trailing_zeros() as usize;
                features[place] = self.sample(positions[place]);
                again &= again - 1;
            }
        }
    }

    /// Up to a group of positions; tells for which of them it holds.
    fn search<M: Norm, const D: usize>(
        &self,
        level: Level,
        norm: M,
        positions: &[Vector<N>],
        group: &mut Group<N, D>,
    ) -> u64 {
        let search = Search::new(norm, &self.lattice);
        dispatch!(level, simd => group.search(simd, search, positions))
    }
}

/// Writes what was found, place by place.
fn put<const N: usize, const D: usize, const K: usize>(
    points: &[Points<N>; D],
    features: &mut [[Feature<Vector<N>>; K]],
) where
    Axes: Space<N>,
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
