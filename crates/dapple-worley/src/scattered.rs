//! The door for many scattered positions, such as the shading points of a renderer.

use crate::fixed::FARTHEST;
use crate::many::{LANES, Nearest, Places};
use crate::metric::{Chebyshev, Euclidean, Manhattan, Norm};
use crate::{Axes, Feature, LIMIT, Metric, Space, Vector, Worley, WorleyError, simd};
use fearless_simd::{Level, dispatch, prelude::*};

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
        let chunks = positions.chunks(LANES).zip(features.chunks_mut(LANES));
        for (positions, features) in chunks {
            let holds = match self.metric {
                // One at a time it would be, in any case.
                _ if self.lattice.density.is_some() => 0,
                Metric::Minkowski(_) => 0,
                Metric::Euclidean => self.sixteen(level, Euclidean, positions, features),
                Metric::Manhattan => self.sixteen(level, Manhattan, positions, features),
                Metric::Chebyshev => self.sixteen(level, Chebyshev, positions, features),
            };
            let mut again = u64::MAX >> (64 - positions.len()) & !holds;
            while again != 0 {
                let lane = again.trailing_zeros() as usize;
                features[lane] = self.sample(positions[lane]);
                again &= again - 1;
            }
        }
        Ok(())
    }

    /// Up to sixteen positions; tells for which of them it holds.
    fn sixteen<M: Norm, const K: usize>(
        &self,
        level: Level,
        norm: M,
        positions: &[Vector<N>],
        features: &mut [[Feature<Vector<N>>; K]],
    ) -> u64 {
        let mut coordinates = [[0.0; LANES]; N];
        let mut is_finite = 0;
        for (lane, &position) in positions.iter().enumerate() {
            let position: [f64; N] = position.into();
            let mut has_place = true;
            for axis in 0..N {
                coordinates[axis][lane] = position[axis];
                has_place &= position[axis].abs() <= FARTHEST;
            }
            is_finite |= u64::from(has_place) << lane;
        }
        is_finite & dispatch!(level, simd => self.fill(simd, norm, &coordinates, features))
    }

    #[inline(always)]
    fn fill<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        coordinates: &[[f64; LANES]; N],
        features: &mut [[Feature<Vector<N>>; K]],
    ) -> u64 {
        let places = Places::new(simd, &self.lattice, coordinates);
        let nearest: Nearest<S, K> = places.nearest(simd, norm, &self.lattice);
        for rank in 0..K {
            let points = places.points(simd, &self.lattice, &nearest, rank);
            let mut distances = [0.0; LANES];
            norm.distances(norm.keys(points.vectors))
                .store_slice(&mut distances);
            let mut vectors = [[0.0; LANES]; N];
            for axis in 0..N {
                points.vectors[axis].store_slice(&mut vectors[axis]);
            }
            let mut ids = [[0; LANES]; 2];
            for half in 0..2 {
                points.ids[half].store_slice(&mut ids[half]);
            }
            for (lane, features) in features.iter_mut().enumerate() {
                let mut vector = [0.0; N];
                for axis in 0..N {
                    vector[axis] = f64::from(vectors[axis][lane]);
                }
                features[rank] = Feature {
                    distance: distances[lane],
                    vector: vector.into(),
                    id: u64::from(ids[1][lane]) << 32 | u64::from(ids[0][lane]),
                };
            }
        }
        nearest.holds
    }
}
