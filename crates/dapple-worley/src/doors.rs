//! Where the code for two, three and four axes is compiled: here, and in no crate that uses it.
//!
//! A function with the number of axes as a parameter is compiled again in every crate that calls it. So the public ones
//! are thin, and what takes long goes through these functions, which have no parameter.

use crate::fixed::Place;
use crate::lattice::Lattice;
use crate::many::Group;
use crate::one::nearest;
use crate::render::Basis;
use crate::search::{Hit, within};
use crate::{Axes, Metric, Worley};
use fearless_simd::Level;

/// What is compiled for a number of axes. [`Axes`] has it for 2, 3 and 4.
pub trait Doors<const N: usize>: Sized {
    /// The basis as pictures see it.
    fn basis(worley: &Worley<N>) -> &dyn Basis;

    /// The nearest points of a place, nearest first; at most four.
    fn nearest(
        metric: Metric,
        lattice: &Lattice<N>,
        level: Level,
        place: &Place<N>,
        hits: &mut [Hit<N>],
    );

    /// All points of a place with keys of at most that of `distance`, in no particular order.
    fn within(metric: Metric, lattice: &Lattice<N>, place: &Place<N>, distance: f32)
    -> Vec<Hit<N>>;

    /// Finds the nearest points of the positions of a group, and tells for which of them they hold, as bits.
    fn search_group(worley: &Worley<N>, level: Level, group: &mut Group<N>) -> u64;
}

macro_rules! doors {
    ($($n:literal)*) => {$(
        impl Doors<$n> for Axes {
            fn basis(worley: &Worley<$n>) -> &dyn Basis {
                worley
            }

            fn nearest(
                metric: Metric,
                lattice: &Lattice<$n>,
                level: Level,
                place: &Place<$n>,
                hits: &mut [Hit<$n>],
            ) {
                nearest(metric, lattice, level, place, hits);
            }

            fn within(
                metric: Metric,
                lattice: &Lattice<$n>,
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

doors!(2 3 4);
