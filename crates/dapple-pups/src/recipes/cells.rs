//! Cells (section 3.2). A cell belongs to one control point (figure 9a) or to a few connected ones (figure 9b).

use crate::{
    LabelTexture, NetOptions, PupsError, PupsField, PupsRecipe, Spacing, grouped_labels,
    own_labels, random_values,
};
use dapple_hash::Seed;
use dapple_points::Domain;

/// Options for [`cells`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct CellsOptions {
    /// Domain of the control points, in which the texture repeats [default: the paper's torus `[-1, 1]²`].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Spacing of the control points: minimum distance in units of the plane, density, or number of points.
    pub spacing: Spacing,
    /// Minimum and maximum number of control points per cell, from 1 to 16.
    ///
    /// Figure 9a has one point per cell.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::assign::POINTS_PER_CELL }))]
    pub points_per_cell: [u32; 2],
    /// Weighting of the control points.
    pub net: NetOptions,
}

impl Default for CellsOptions {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            spacing: Spacing::from(0.1),
            points_per_cell: [1, 1],
            net: NetOptions::randomly_oriented(),
        }
    }
}

impl CellsOptions {
    /// Returns the default options, but with cells of three or four points each, as in figure 9b.
    #[must_use]
    pub fn of_three_or_four() -> Self {
        Self {
            points_per_cell: [3, 4],
            ..Self::default()
        }
    }
}

/// Builds cells. Each has a label (starting at 0) and a random value in `[0, 1)`.
///
#[cfg_attr(doc, doc = include_str!("../../docs/cells.md"))]
///
/// # Errors
///
/// [`Points`](crate::PupsErrorKind::Points) if points cannot be placed, [`Range`](crate::PupsErrorKind::Range) if a
/// number of points per cell is out of its range. If net options are invalid, same as
/// [`PupsOptions::check`](crate::PupsOptions::check).
///
/// # Examples
///
/// ```
/// use dapple_pups::{CellsOptions, cells, hash::Seed};
///
/// let texture = cells(&CellsOptions::of_three_or_four(), Seed(7))?;
/// assert!((70..=95).contains(&texture.values().len()));
/// # Ok::<(), dapple_pups::PupsError>(())
/// ```
pub fn cells(options: &CellsOptions, seed: Seed) -> Result<LabelTexture, PupsError> {
    let points = options
        .net
        .points(&options.spacing, options.domain, seed.child("points", 0))?;
    let graph = options.net.delaunay(&points)?;
    // Divide the points into cells of one point or of a few connected ones.
    let labels = if options.points_per_cell == [1, 1] {
        own_labels(points.len())
    } else {
        grouped_labels(&graph, options.points_per_cell, seed.child("label", 0))?
    };
    let n_labels = labels.iter().max().map_or(0, |&label| label as usize + 1);
    // Draw a value for each cell.
    let values = random_values(n_labels, seed.child("value", 0));
    let orientation = options.net.orientation(&points, seed)?;
    let pups = options
        .net
        .of_delaunay(&points, &graph, orientation, seed)?;
    LabelTexture::new(pups, labels, values)
}

impl PupsRecipe for CellsOptions {
    net_of!(points);

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(cells(self, seed)?))
    }
}
