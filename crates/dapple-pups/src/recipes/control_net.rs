//! Exposes the control points of a texture to editors: positions, values and connections. Also converts a texture to
//! an explicit list of control points that gives the same image.

use super::Octave;
use crate::{
    Cells, ControlPoint, ControlPoints, LabelTexture, Layers, NetOptions, Orientations, Pups,
    PupsError, PupsField, PupsOptions, ShaderLayers, Texture, VectorTexture,
};
use dapple_graph::{Graph, delaunay};
use dapple_points::Domain;
use dapple_raster::Field;
use glam::{DVec2, DVec3};

/// The control points of a texture or of one of its layers, with their values.
#[derive(Clone, Debug)]
pub struct ControlNet {
    /// The control net: points, graph and weights.
    pub pups: Pups,
    /// Values, labels or colors of the points.
    pub values: NetValues,
}

/// The values, labels or colors of control points.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NetValues {
    /// One value for each point, which the texture interpolates.
    Numbers(Vec<f32>),
    /// One label for each point. A position has the value of the label of its strongest point.
    Labels {
        /// Label of each point.
        labels: Vec<u32>,
        /// Value of each label.
        values: Vec<f32>,
    },
    /// One color for each point, which the texture interpolates.
    Colors(Vec<[f32; 3]>),
}

/// A scalar texture with accessible control points.
pub trait NetField: Field {
    /// Returns the nets of the texture's layers, coarsest first. A texture without layers has a single net.
    fn nets(&self) -> Vec<ControlNet>;

    /// Returns the texture as data for the shaders of `dapple-wgsl`.
    fn shader_layers(&self) -> ShaderLayers;

    /// Converts the texture to an explicit list of control points; see [`PupsField::to_points`].
    fn to_points(&self, tile: Domain) -> Option<ControlPoints> {
        let _ = tile;
        None
    }
}

impl ControlNet {
    /// Returns the Delaunay graph of the points, whose edges are the texture's axes.
    ///
    /// # Errors
    ///
    /// [`Graph`](crate::PupsErrorKind::Graph) if the triangulation fails, which does not happen for a recipe's
    /// textures.
    pub fn graph(&self) -> Result<Graph, PupsError> {
        Ok(delaunay(self.pups.points())?)
    }

    /// Returns the orientation of each point; `None` without orientations.
    #[must_use]
    pub fn orientations(&self) -> Option<Vec<DVec3>> {
        let vectors = &self.pups.options().orientation.as_ref()?.vectors;
        let of_point = |index: usize| vectors[if vectors.len() == 1 { 0 } else { index }];
        Some((0..self.pups.n_points()).map(of_point).collect())
    }

    /// Returns the value of each point (for labeled points, the label's value); `None` for colors.
    #[must_use]
    pub fn numbers(&self) -> Option<Vec<f32>> {
        match &self.values {
            NetValues::Numbers(numbers) => Some(numbers.clone()),
            NetValues::Labels { labels, values } => {
                let value = |&label: &u32| values[label as usize];
                Some(labels.iter().map(value).collect())
            }
            NetValues::Colors(_) => None,
        }
    }

    /// Returns the label of each point and the value of each label. `None` without labels, or if every point has a
    /// separate label.
    #[must_use]
    pub fn shared_labels(&self) -> Option<(&[u32], &[f32])> {
        match &self.values {
            NetValues::Labels { labels, values } => {
                // If every point has its own label, labels are only indices of values.
                let is_own = labels.iter().zip(0..).all(|(&label, index)| label == index);
                (!is_own).then_some((labels, values))
            }
            _ => None,
        }
    }

    /// Converts the net to options of [`control_points`](crate::control_points) with the domain `tile`. Returns `None`
    /// for colors, and if the texture's period differs from the tile's.
    fn to_points(&self, tile: Domain) -> Option<ControlPoints> {
        let (domain, numbers) = (self.pups.domain(), self.numbers()?);
        // The net's domain must be the tile, extended by a margin along the axes on which the net does not wrap.
        let wraps_within = |axis: usize| !domain.wrap[axis] || tile.wrap[axis];
        let margin = (tile.origin - domain.origin).max(DVec2::ZERO);
        let covered = Domain {
            wrap: domain.wrap,
            ..tile
        };
        if !wraps_within(0) || !wraps_within(1) || covered.grown(margin) != *domain {
            return None;
        }
        let orientations = self.orientations();
        let shared = self.shared_labels();
        // Points of a texture with shared labels are described by their labels, other points by their values.
        let points = self.pups.points().iter().zip(numbers);
        let points = points.map(|((point, at), value)| ControlPoint {
            x: at.x,
            y: at.y,
            value: shared.is_none().then_some(value),
            label: shared.map(|(labels, _)| labels[point.index()]),
            orientation: orientations.as_ref().map(|vectors| vectors[point.index()]),
        });
        Some(ControlPoints {
            domain: tile,
            points: points.collect(),
            values: shared.map_or(Vec::new(), |(_, values)| values.to_vec()),
            net: net_options(self.pups.options()),
            cells: match self.values {
                NetValues::Labels { .. } => Cells::Hard,
                _ => Cells::Mixed,
            },
            wrap: [0, 1].map(|axis| domain.wrap[axis] || !tile.wrap[axis]),
            margin: margin.to_array(),
        })
    }
}

/// Returns net options for points that have individual orientations: like `options`, but without orientations.
fn net_options(options: &PupsOptions) -> NetOptions {
    let usual = NetOptions::default();
    NetOptions {
        axis_scale: options.axis_scale,
        weight: options.weight,
        orientations: Orientations::None,
        strength: options
            .orientation
            .as_ref()
            .map_or(usual.strength, |orientation| orientation.strength),
        fade: options.fade,
        ..usual
    }
}

impl PupsField {
    /// Returns the control nets of the texture's layers, coarsest first.
    #[must_use]
    pub fn nets(&self) -> Vec<ControlNet> {
        match self {
            Self::Numbers(field) => field.nets(),
            Self::Colors(texture) => vec![ControlNet::from(&**texture)],
        }
    }

    /// Converts the texture to an explicit list of control points on the domain `tile`, which gives the same image,
    /// bit for bit. Moving points retain their current positions.
    ///
    /// Returns `None` for a texture with several layers (octaves, turbulence, cellular noise) and for colors, which
    /// [`control_points`](crate::control_points) does not support.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_pups::{CowOptions, PupsRecipe, control_points, hash::Seed};
    ///
    /// let cow = CowOptions::default();
    /// let mut points = cow.build(&(), Seed(7))?.to_points(cow.domain).expect("a cow is one net of numbers");
    /// points.points[3].label = Some(1);
    /// let edited = control_points(&points, Seed(7))?;
    /// # Ok::<(), dapple_pups::PupsError>(())
    /// ```
    #[must_use]
    pub fn to_points(&self, tile: Domain) -> Option<ControlPoints> {
        match self {
            Self::Numbers(field) => field.to_points(tile),
            Self::Colors(_) => None,
        }
    }
}

impl From<&Texture> for ControlNet {
    fn from(texture: &Texture) -> Self {
        Self {
            pups: texture.pups().clone(),
            values: NetValues::Numbers(texture.values().to_vec()),
        }
    }
}

impl From<&LabelTexture> for ControlNet {
    fn from(texture: &LabelTexture) -> Self {
        Self {
            pups: texture.pups().clone(),
            values: NetValues::Labels {
                labels: texture.labels().to_vec(),
                values: texture.values().to_vec(),
            },
        }
    }
}

impl From<&VectorTexture<3>> for ControlNet {
    fn from(texture: &VectorTexture<3>) -> Self {
        Self {
            pups: texture.pups().clone(),
            values: NetValues::Colors(texture.values().to_vec()),
        }
    }
}

impl NetField for Texture {
    fn nets(&self) -> Vec<ControlNet> {
        vec![self.into()]
    }

    fn shader_layers(&self) -> ShaderLayers {
        ShaderLayers::single(self.into())
    }

    fn to_points(&self, tile: Domain) -> Option<ControlPoints> {
        ControlNet::from(self).to_points(tile)
    }
}

impl NetField for LabelTexture {
    fn nets(&self) -> Vec<ControlNet> {
        vec![self.into()]
    }

    fn shader_layers(&self) -> ShaderLayers {
        ShaderLayers::single(self.into())
    }

    fn to_points(&self, tile: Domain) -> Option<ControlPoints> {
        ControlNet::from(self).to_points(tile)
    }
}

impl NetField for Layers<Octave> {
    /// Returns the nets of the octaves. Rescaled octaves share one net, which is returned once.
    fn nets(&self) -> Vec<ControlNet> {
        let octaves = self.layers().iter().filter(|octave| octave.scale() == 1.0);
        octaves.map(|octave| octave.texture().into()).collect()
    }

    fn shader_layers(&self) -> ShaderLayers {
        self.into()
    }
}

impl NetField for Layers<LabelTexture> {
    fn nets(&self) -> Vec<ControlNet> {
        self.layers().iter().map(ControlNet::from).collect()
    }

    fn shader_layers(&self) -> ShaderLayers {
        self.into()
    }
}
