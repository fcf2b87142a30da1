//! How the recipes weight their control points.

use super::Orbits;
use crate::options::MOVING_FADE;
#[cfg(feature = "serde")]
use crate::options::is_never;
#[cfg(feature = "schema")]
use crate::options::{AXIS_SCALE, FADE, STRENGTH};
use crate::{AxialWeight, Orientation, Orientations, Pups, PupsError, PupsOptions};
use dapple_graph::{Graph, delaunay};
use dapple_hash::Seed;
use dapple_points::PointSet;

/// How a recipe connects and weights its control points: [`PupsOptions`] before the points are known.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct NetOptions {
    /// The length of every axis as a multiple of its edge: above ½, at most 16; 1 by default.
    ///
    #[cfg_attr(doc, doc = include_str!("../../docs/axis-scale.md"))]
    #[cfg_attr(feature = "schema", schemars(transform = { AXIS_SCALE }))]
    pub axis_scale: f64,
    /// How the weight falls off along an axis; equation 1 by default.
    pub weight: AxialWeight,
    /// The orientations of the control points; none by default.
    pub orientations: Orientations,
    /// ε of equation 4, how strongly orientations shift weights, in `[0, 1)`; 0.5 by default.
    ///
    #[cfg_attr(doc, doc = include_str!("../../docs/strength.md"))]
    #[cfg_attr(feature = "schema", schemars(transform = { STRENGTH }))]
    pub strength: f64,
    /// How short the border that an axis leaves on the Voronoi cell of its control point is beside its edge when the axis
    /// begins to fade, from 0 to 1; 0 by default, which is never. With [`motion`](Self::motion) it is at least 0.25.
    ///
    /// Without it, a texture jumps where points that move change their edges: see [`PupsOptions::fade`].
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_never"))]
    #[cfg_attr(feature = "schema", schemars(transform = { FADE }))]
    pub fade: f64,
    /// How the control points move in a loop in time; they do not by default.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub motion: Option<Orbits>,
    /// The part of the loop that has passed, for points that move: at 1 the texture is that at 0, bit for bit. Recipes of
    /// materials set it.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub time: f64,
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
        }
    }
}

impl NetOptions {
    /// Random orientations, else the defaults: the cells of figure 9.
    #[must_use]
    pub fn randomly_oriented() -> Self {
        Self {
            orientations: Orientations::Random,
            ..Self::default()
        }
    }

    /// The net of the Delaunay triangulation of `points`, or of where they have moved to.
    ///
    /// # Errors
    ///
    /// Those of [`with_graph`](Self::with_graph), and [`Graph`](crate::PupsErrorKind::Graph) if there is no triangulation.
    pub fn pups(&self, points: &PointSet, seed: Seed) -> Result<Pups, PupsError> {
        self.with_graph(points, &delaunay(points)?, seed)
    }

    /// The net of any graph over `points`; if they move, that of the Delaunay triangulation of where they have moved to.
    /// Orientations come from `seed.child("orientation", 0)`, orbits from `seed.child("orbit", 0)`.
    ///
    /// # Errors
    ///
    /// Those of [`Pups::new`], and [`Range`](crate::PupsErrorKind::Range) for orientations that are not finite and orbits
    /// outside of their range.
    pub fn with_graph(
        &self,
        points: &PointSet,
        graph: &Graph,
        seed: Seed,
    ) -> Result<Pups, PupsError> {
        let vectors = self
            .orientations
            .vectors(points, seed.child("orientation", 0))?;
        let orientation = vectors.map(|vectors| Orientation {
            strength: self.strength,
            vectors,
        });
        self.oriented(points, graph, orientation, seed)
    }

    /// [`with_graph`](Self::with_graph) with these orientations.
    pub(crate) fn oriented(
        &self,
        points: &PointSet,
        graph: &Graph,
        orientation: Option<Orientation>,
        seed: Seed,
    ) -> Result<Pups, PupsError> {
        let options = self.pups_options(orientation);
        match self.moved(points, graph, seed)? {
            Some(moved) => Pups::new(&moved, &delaunay(&moved)?, options),
            None => Pups::new(points, graph, options),
        }
    }

    /// Where the points have moved to, given their Delaunay graph; nothing if they do not move.
    pub(crate) fn moved(
        &self,
        points: &PointSet,
        graph: &Graph,
        seed: Seed,
    ) -> Result<Option<PointSet>, PupsError> {
        let moved = |orbits: Orbits| orbits.moved(points, graph, self.time, seed.child("orbit", 0));
        self.motion.map(moved).transpose()
    }

    /// The options of a net, with these orientations.
    pub(crate) fn pups_options(&self, orientation: Option<Orientation>) -> PupsOptions {
        PupsOptions {
            axis_scale: self.axis_scale,
            weight: self.weight,
            orientation,
            fade: match self.motion {
                Some(_) => self.fade.max(MOVING_FADE),
                None => self.fade,
            },
        }
    }

    /// The options of points that have been moved already: axes fade as they do while points move.
    pub(crate) fn after_motion(&self) -> Self {
        let PupsOptions { fade, .. } = self.pups_options(None);
        Self {
            fade,
            motion: None,
            ..self.clone()
        }
    }
}
