//! Entry points that ensure that the code for two, three and four dimensions is compiled in this crate only.
//!
//! A function that is generic over the number of axes is compiled again in every crate that calls it. The public
//! functions are therefore thin, and call all heavy code through the functions of this module, which are not generic.

use crate::fixed::Place;
use crate::lattice::Lattice;
use crate::many::Group;
use crate::render::Basis;
use crate::search::{Hit, within};
use crate::{Dimensions, Metric, Worley, one, search};
use fearless_simd::Level;

/// The functions that are compiled separately for each number of axes. [`Dimensions`] implements them for 2, 3 and 4.
pub trait DimensionDispatch<const N: usize>: Sized {
    /// Returns the basis as a trait object for rendering, independent of the number of axes.
    fn basis(worley: &Worley<N>) -> &dyn Basis;

    /// Finds the points nearest to `place`, nearest first; at most four.
    fn nearest(metric: Metric, lattice: &Lattice, place: &Place<N>, hits: &mut [Hit<N>]);

    /// Finds all points whose keys are at most the key of `distance`, unordered.
    fn within(metric: Metric, lattice: &Lattice, place: &Place<N>, distance: f32) -> Vec<Hit<N>>;

    /// Finds the nearest points of each position in a group. Returns a bit mask of the positions for which the result
    /// is known to be exact; the others must be searched individually.
    fn search_group(worley: &Worley<N>, level: Level, group: &mut Group<N>) -> u64;
}

macro_rules! compiled_for {
    ($($n:literal $nearest:path),*) => {$(
        impl DimensionDispatch<$n> for Dimensions {
            // If this conversion were inlined into another crate, all code of rendering would be compiled there again.
            #[inline(never)]
            fn basis(worley: &Worley<$n>) -> &dyn Basis {
                worley
            }

            fn nearest(
                metric: Metric,
                lattice: &Lattice,
                place: &Place<$n>,
                hits: &mut [Hit<$n>],
            ) {
                $nearest(lattice, metric, place, hits);
            }

            fn within(
                metric: Metric,
                lattice: &Lattice,
                place: &Place<$n>,
                distance: f32,
            ) -> Vec<Hit<$n>> {
                within(lattice, metric, place, distance)
            }

            fn search_group(worley: &Worley<$n>, level: Level, group: &mut Group<$n>) -> u64 {
                group.search(worley, level)
            }
        }
    )*};
}

compiled_for!(2 one::nearest, 3 one::nearest, 4 search::nearest);
