//! Reference image (section 3.2, figure 13): the control points' labels come from an image.

use crate::{
    LabelTexture, NetOptions, PupsError, PupsField, PupsRecipe, ReferenceImage, Spacing,
    reference_labels,
};
use dapple_hash::Seed;
use dapple_points::Domain;

/// Options for [`reference_texture`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ReferenceOptions {
    /// Domain of the control points, which the image covers [default: the paper's torus `[-1, 1]²`].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Spacing of the control points: minimum distance in units of the plane, density, or number of points.
    pub spacing: Spacing,
    /// Values of the black and the white group.
    pub values: [f32; 2],
    /// Weighting of the control points.
    pub net: NetOptions,
}

impl Default for ReferenceOptions {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            spacing: Spacing::from(0.05),
            values: [0.0, 1.0],
            net: NetOptions::default(),
        }
    }
}

/// Builds black and white cells from an image. A control point is white with a probability equal to the intensity
/// there.
///
#[cfg_attr(doc, doc = include_str!("../../docs/reference-texture.md"))]
///
/// # Errors
///
/// [`Points`](crate::PupsErrorKind::Points) if points cannot be placed. If net options are invalid, same as
/// [`PupsOptions::check`](crate::PupsOptions::check).
///
/// # Examples
///
/// ```
/// use dapple_pups::{ReferenceImage, ReferenceOptions, hash::Seed, raster::Raster, reference_texture};
///
/// let disc = |x, y| if (x - 8) * (x - 8) + (y - 8) * (y - 8) < 25 { 1.0 } else { 0.0 };
/// let image = Raster::from_fn([17, 17], |x, y| disc(x as i32, y as i32))?;
/// let texture = reference_texture(&ReferenceImage::new(image)?, &ReferenceOptions::default(), Seed(7))?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn reference_texture(
    image: &ReferenceImage,
    options: &ReferenceOptions,
    seed: Seed,
) -> Result<LabelTexture, PupsError> {
    let points = options
        .net
        .points(&options.spacing, options.domain, seed.child("points", 0))?;
    let labels = reference_labels(&points, image, seed.child("label", 0));
    let pups = options.net.pups(&points, seed)?;
    LabelTexture::new(pups, labels, options.values.to_vec())
}

impl PupsRecipe<ReferenceImage> for ReferenceOptions {
    net_of!(points);

    fn build(&self, image: &ReferenceImage, seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(reference_texture(image, self, seed)?))
    }
}
