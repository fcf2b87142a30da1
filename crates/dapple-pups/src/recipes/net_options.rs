//! Options for the control points' weights, shared by all recipes.

use super::Orbits;
use crate::options::MOVING_FADE;
#[cfg(feature = "serde")]
use crate::options::is_never;
#[cfg(feature = "schema")]
use crate::options::{AXIS_SCALE, FADE, STRENGTH};
use crate::{AxialWeight, Orientation, Orientations, Pups, PupsError, PupsOptions, Spacing};
use dapple_graph::{Graph, delaunay_cancellable};
use dapple_hash::Seed;
use dapple_points::{Cancel, Domain, PointSet};
use dapple_raster::Parts;
use std::sync::Arc;

/// Connection and weighting of a recipe's control points.
///
/// These are [`PupsOptions`] before the points are known.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct NetOptions {
    /// Length of every axis as a multiple of its edge, above ½ and at most 16.
    ///
    #[cfg_attr(doc, doc = include_str!("../../docs/axis-scale.md"))]
    #[cfg_attr(feature = "schema", schemars(transform = { AXIS_SCALE }))]
    pub axis_scale: f64,
    /// Falloff of the weight along an axis.
    pub weight: AxialWeight,
    /// Orientations of the control points.
    pub orientations: Orientations,
    /// Strength of the orientations (ε of equation 4), at least 0 and below 1.
    ///
    #[cfg_attr(doc, doc = include_str!("../../docs/strength.md"))]
    #[cfg_attr(feature = "schema", schemars(transform = { STRENGTH }))]
    pub strength: f64,
    /// Ratio of border length to edge length below which an axis fades, from 0 (no fading) to 1.
    ///
    /// The border of an axis is the side of its control point's Voronoi cell that crosses the axis. With
    /// [`motion`](Self::motion), the ratio is at least 0.25.
    ///
    /// Without fading, a texture jumps where moving points change their edges; see [`PupsOptions::fade`].
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_never"))]
    #[cfg_attr(feature = "schema", schemars(transform = { FADE }))]
    pub fade: f64,
    /// Looping motion of the control points [default: none].
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub motion: Option<Orbits>,
    /// Time as a fraction of the loop, for moving points. The texture at time 1 equals that at time 0, bit for bit.
    /// Material recipes set the time themselves.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub time: f64,
    /// Cached points, graphs and nets of earlier textures [default: none]. A texture uses those that it would compute
    /// itself, bit for bit.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub parts: Parts,
    /// Callback that returns whether the texture is no longer needed [default: none]. It is called on any thread, once
    /// per few milliseconds of work. If it returns true, building the texture fails with
    /// [`Cancelled`](crate::PupsErrorKind::Cancelled).
    #[cfg_attr(feature = "serde", serde(skip))]
    pub cancel: Cancel,
}

impl Default for NetOptions {
    fn default() -> Self {
        Self {
            axis_scale: 1.0,
            weight: AxialWeight::Cubic,
            orientations: Orientations::None,
            strength: 0.5,
            fade: 0.0,
            motion: None,
            time: 0.0,
            parts: Parts::default(),
            cancel: Cancel::default(),
        }
    }
}

impl NetOptions {
    /// Returns the default options, but with random orientations, for the cells of figure 9.
    #[must_use]
    pub fn randomly_oriented() -> Self {
        Self {
            orientations: Orientations::Random,
            ..Self::default()
        }
    }

    /// Builds the net of the Delaunay triangulation of `points`, or of their positions after motion.
    ///
    /// # Errors
    ///
    /// Same as [`with_graph`](Self::with_graph), and [`Graph`](crate::PupsErrorKind::Graph) if the triangulation fails.
    pub fn pups(&self, points: &PointSet, seed: Seed) -> Result<Pups, PupsError> {
        let graph = self.delaunay(points)?;
        self.of_delaunay(points, &graph, self.orientation(points, seed)?, seed)
    }

    /// Builds the net of `graph`. If the points move, the graph is ignored, and the net is built from the Delaunay
    /// triangulation of the positions after motion. Orientations come from `seed.child("orientation", 0)`, orbits from
    /// `seed.child("orbit", 0)`.
    ///
    /// # Errors
    ///
    /// Same as [`Pups::new`], and [`Range`](crate::PupsErrorKind::Range) if an orientation is not finite or an orbit is
    /// out of its range.
    pub fn with_graph(
        &self,
        points: &PointSet,
        graph: &Graph,
        seed: Seed,
    ) -> Result<Pups, PupsError> {
        let orientation = self.orientation(points, seed)?;
        // The given graph is for points at rest. Moved points are triangulated again.
        match self.moved(points, graph, seed)? {
            Some(moved) => self.net(&moved, &*self.delaunay(&moved)?, orientation),
            None => {
                let options = self.pups_options(orientation);
                Pups::new_cancellable(points, graph, options, &self.is_cancelled())
            }
        }
    }

    /// Builds the net of the Delaunay graph of `points` with the given orientations. If the points move, the graph of
    /// their positions after motion is used.
    pub(crate) fn of_delaunay(
        &self,
        points: &PointSet,
        graph: &Graph,
        orientation: Option<Orientation>,
        seed: Seed,
    ) -> Result<Pups, PupsError> {
        match self.moved(points, graph, seed)? {
            Some(moved) => self.net(&moved, &*self.delaunay(&moved)?, orientation),
            None => self.net(points, graph, orientation),
        }
    }

    /// Generates points with the given spacing in a domain, or returns equal points from the cache `parts`.
    pub(crate) fn points(
        &self,
        spacing: &Spacing,
        domain: Domain,
        seed: Seed,
    ) -> Result<Arc<PointSet>, PupsError> {
        let make = || spacing.points_cancellable(domain, seed, &self.is_cancelled());
        let Some(spacing) = spacing.description() else {
            return Ok(Arc::new(make()?));
        };
        // Numbers are formatted so that equal texts mean equal bits.
        let text = format!("{spacing} {domain:?} {seed:?}");
        let scattered = self.parts.get_or_make(
            |other: &Scattered| other.text == text,
            || {
                let points = Arc::new(make()?);
                let text = text.clone();
                Ok::<_, PupsError>(Scattered { text, points })
            },
        )?;
        Ok(scattered.points.clone())
    }

    /// Returns the caller's cancellation callback.
    pub(crate) fn is_cancelled(&self) -> impl Fn() -> bool + Sync {
        || self.cancel.is_cancelled()
    }

    /// Returns the Delaunay graph of `points`, reusing a graph of equal points from the cache `parts`.
    pub(crate) fn delaunay(&self, points: &PointSet) -> Result<Arc<Graph>, PupsError> {
        let triangulated = self.parts.get_or_make(
            |other: &Triangulated| is_same(&other.points, points),
            || {
                let graph = delaunay_cancellable(points, &self.is_cancelled());
                let graph = Arc::new(graph.map_err(PupsError::of_part)?);
                let points = points.clone();
                Ok::<_, PupsError>(Triangulated { points, graph })
            },
        )?;
        Ok(triangulated.graph.clone())
    }

    /// Builds the net of points that do not move (or have been moved) and their Delaunay graph, reusing an equal net
    /// from the cache `parts`.
    fn net(
        &self,
        points: &PointSet,
        graph: &Graph,
        orientation: Option<Orientation>,
    ) -> Result<Pups, PupsError> {
        let options = self.pups_options(orientation);
        let pups = self.parts.get_or_make(
            |other: &Pups| {
                is_same_options(other.options(), &options) && is_same(other.points(), points)
            },
            || Pups::of_delaunay(points, graph, options.clone(), &self.is_cancelled()),
        )?;
        Ok(Pups::clone(&pups))
    }

    /// Returns the points' orientations, with the strength from the options.
    pub(crate) fn orientation(
        &self,
        points: &PointSet,
        seed: Seed,
    ) -> Result<Option<Orientation>, PupsError> {
        let seed = seed.child("orientation", 0);
        let vectors = self.orientations.vectors(points, seed)?;
        Ok(vectors.map(|vectors| Orientation {
            strength: self.strength,
            vectors,
        }))
    }

    /// Returns the points' positions after motion, given their Delaunay graph; `None` if they do not move.
    pub(crate) fn moved(
        &self,
        points: &PointSet,
        graph: &Graph,
        seed: Seed,
    ) -> Result<Option<PointSet>, PupsError> {
        let moved = |orbits: Orbits| orbits.moved(points, graph, self.time, seed.child("orbit", 0));
        self.motion.map(moved).transpose()
    }

    /// Returns the options of a control net with the given orientations.
    pub(crate) fn pups_options(&self, orientation: Option<Orientation>) -> PupsOptions {
        PupsOptions {
            axis_scale: self.axis_scale,
            weight: self.weight,
            orientation,
            // The edges of moving points change, so their axes always fade.
            fade: match self.motion {
                Some(_) => self.fade.max(MOVING_FADE),
                None => self.fade,
            },
        }
    }

    /// Returns the options for points that have already been moved. Axes fade as for moving points.
    pub(crate) fn after_motion(&self) -> Self {
        // The points have moved already, but their axes still fade.
        let PupsOptions { fade, .. } = self.pups_options(None);
        Self {
            fade,
            motion: None,
            ..self.clone()
        }
    }
}

/// Cached points, with a text that identifies the options and the seed that they were generated from.
struct Scattered {
    text: String,
    points: Arc<PointSet>,
}

/// Cached points with their Delaunay graph.
struct Triangulated {
    points: PointSet,
    graph: Arc<Graph>,
}

/// Returns whether two point sets are equal, bit for bit.
fn is_same(a: &PointSet, b: &PointSet) -> bool {
    // Numbers that are equal may still differ in the sign of zero.
    let pairs = a.positions().iter().zip(b.positions());
    a == b
        && pairs
            .map(|(a, b)| (a.to_array(), b.to_array()))
            .all(|(a, b)| a.map(f64::to_bits) == b.map(f64::to_bits))
}

/// Returns whether two options give nets with the same bits for equal points. The sign of a zero matters only in
/// orientations.
fn is_same_options(a: &PupsOptions, b: &PupsOptions) -> bool {
    a == b && orientation_bits(a).eq(orientation_bits(b))
}

/// Iterates over the bits of the orientations and their strength; empty without orientations.
fn orientation_bits(options: &PupsOptions) -> impl Iterator<Item = u64> {
    let orientation = options.orientation.iter();
    let numbers = orientation.flat_map(|orientation| {
        let vectors = orientation
            .vectors
            .iter()
            .flat_map(|vector| vector.to_array());
        core::iter::once(orientation.strength).chain(vectors)
    });
    numbers.map(f64::to_bits)
}

#[cfg(test)]
mod tests {
    use super::NetOptions;
    use crate::{Cancel, Layers, Octave, OctavesOptions, PupsErrorKind, octaves};
    use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
    use dapple_hash::Seed;
    use dapple_points::Domain;
    use dapple_raster::{Field as _, Parts, Window};
    use glam::DVec2;
    use std::sync::Arc;

    fn made(gain: f64, axis_scale: f64, parts: &Parts) -> Layers<Octave> {
        let net = NetOptions {
            axis_scale,
            parts: parts.clone(),
            ..NetOptions::default()
        };
        let options = OctavesOptions {
            gain,
            net,
            ..OctavesOptions::default()
        };
        octaves(&options, Seed(7)).unwrap()
    }

    #[test]
    fn nets_are_taken_over_where_their_bits_do_not_change() {
        let parts = Parts::keeping();
        let first = made(0.5, 1.0, &parts);
        let window = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [32; 2]).unwrap();
        for (gain, axis_scale, is_kept) in [(0.7, 1.0, true), (0.5, 1.25, false)] {
            let other = made(gain, axis_scale, &parts);
            for (a, b) in first.layers().iter().zip(other.layers()) {
                let [a, b] = [a, b].map(|octave| &octave.texture().pups().net);
                assert_eq!(Arc::ptr_eq(a, b), is_kept);
            }
            let alone = made(gain, axis_scale, &Parts::default());
            let [kept, alone] = [other, alone].map(|octaves| octaves.to_raster(&window).unwrap());
            assert_eq!(kept, alone);
        }
    }

    #[test]
    fn textures_can_be_cancelled_at_every_call() {
        let [torus, plane] = [[true; 2], [false; 2]].map(|wrap| Domain {
            wrap,
            ..Domain::paper_torus()
        });
        for domain in [torus, plane] {
            let make = |last: usize| {
                let n_calls = Arc::new(AtomicUsize::new(0));
                let calls = n_calls.clone();
                let parts = Parts::keeping();
                let net = NetOptions {
                    cancel: Cancel::by(move || calls.fetch_add(1, Relaxed) >= last),
                    parts: parts.clone(),
                    ..NetOptions::default()
                };
                let options = OctavesOptions {
                    domain,
                    net,
                    ..OctavesOptions::default()
                };
                (octaves(&options, Seed(7)), n_calls.load(Relaxed), parts)
            };
            let (whole, n_calls, _) = make(usize::MAX);
            let window = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [32; 2]).unwrap();
            let whole = whole.unwrap().to_raster(&window).unwrap();
            for last in (0..n_calls).step_by(1 + n_calls / 16) {
                let (stopped, _, parts) = make(last);
                let error = stopped.unwrap_err();
                assert_eq!(*error.kind(), PupsErrorKind::Cancelled, "at call {last}");
                // Cache entries from before the cancellation are complete.
                let options = OctavesOptions {
                    domain,
                    net: NetOptions {
                        parts,
                        ..NetOptions::default()
                    },
                    ..OctavesOptions::default()
                };
                let again = octaves(&options, Seed(7)).unwrap();
                assert_eq!(
                    again.to_raster(&window).unwrap(),
                    whole,
                    "after call {last}"
                );
            }
        }
    }
}
