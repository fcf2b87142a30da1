//! How the recipes weight their control points.

#[cfg(feature = "schema")]
use crate::options::{AXIS_SCALE, STRENGTH};
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
}

impl Default for NetOptions {
    fn default() -> Self {
        Self {
            axis_scale: 1.0,
            weight: AxialWeight::Cubic,
            orientations: Orientations::None,
            strength: 0.5,
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

    /// The net of the Delaunay triangulation of `points`.
    ///
    /// # Errors
    ///
    /// Those of [`with_graph`](Self::with_graph), and [`Graph`](crate::PupsErrorKind::Graph) if there is no triangulation.
    pub fn pups(&self, points: &PointSet, seed: Seed) -> Result<Pups, PupsError> {
        self.with_graph(points, &delaunay(points)?, seed)
    }

    /// The net of any graph over `points`. Orientations come from `seed.child("orientation", 0)`.
    ///
    /// # Errors
    ///
    /// Those of [`Pups::new`], and [`Range`](crate::PupsErrorKind::Range) for orientations that are not finite.
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
        let options = PupsOptions {
            axis_scale: self.axis_scale,
            weight: self.weight,
            orientation,
        };
        Pups::new(points, graph, options)
    }
}
