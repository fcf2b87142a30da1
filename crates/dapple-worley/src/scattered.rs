//! The door for many scattered positions, such as the shading points of a renderer.

use crate::fixed::Place;
use crate::many::{LANES, Nearest, Places};
use crate::metric::{Norm, with_norm};
use crate::{Axes, Feature, LIMIT, Space, Vector, Worley, WorleyError, simd};
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
            let (places, has_place) = places(positions);
            let holds = with_norm!(self.metric, norm => dispatch!(level, simd => {
                self.sixteen(simd, norm, &places, features)
            }));
            let mut again = u64::MAX >> (64 - positions.len()) & !(holds & has_place);
            while again != 0 {
                let lane = again.trailing_zeros() as usize;
                features[lane] = self.sample(positions[lane]);
                again &= again - 1;
            }
        }
        Ok(())
    }

    /// Up to sixteen positions; tells for which of them it holds.
    #[inline(always)]
    fn sixteen<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        places: &[Place<N>; LANES],
        features: &mut [[Feature<Vector<N>>; K]],
    ) -> u64 {
        let places = Places::new(simd, &self.lattice, places);
        let nearest: Nearest<S, K> = places.nearest(simd, norm, &self.lattice);
        for rank in 0..K {
            let mut distances = [0.0; LANES];
            norm.distances(nearest.keys[rank]).store_slice(&mut distances);
            let points = places.points(simd, &self.lattice, &nearest, rank);
            for (lane, features) in features.iter_mut().enumerate() {
                let mut vector = [0.0; N];
                for axis in 0..N {
                    vector[axis] = f64::from(points.vector[axis][lane]);
                }
                let [low, high] = [points.id[0][lane], points.id[1][lane]];
                features[rank] = Feature {
                    distance: distances[lane],
                    vector: vector.into(),
                    id: u64::from(high) << 32 | u64::from(low),
                };
            }
        }
        nearest.holds
    }
}

/// The places of up to sixteen positions, and which of them there are.
fn places<const N: usize>(positions: &[Vector<N>]) -> ([Place<N>; LANES], u64)
where
    Axes: Space<N>,
{
    let nowhere = Place {
        cell: [0; N],
        steps: [0; N],
    };
    let mut places = [nowhere; LANES];
    let mut has_place = 0;
    for (lane, &position) in positions.iter().enumerate() {
        if let Some(place) = Place::new(position.into()) {
            places[lane] = place;
            has_place |= 1 << lane;
        }
    }
    (places, has_place)
}
