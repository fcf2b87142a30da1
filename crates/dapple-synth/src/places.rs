//! Subpixel sources: positions in the exemplar, between its pixels, from which sites take their color.
//!
//! A matched site takes a whole pixel, but is at an arbitrary offset from the sites whose piece it continues. So its
//! source is off by up to half a pixel, and edges in the texture jump from site to site. Here the source of a site is
//! repeatedly moved to the mean of itself and the predictions of its neighbors. A neighbor predicts its own source plus
//! the offset from the neighbor to the site, in the frame of the texture. A neighbor that continues another piece of
//! the exemplar predicts a distant position, and is ignored.
//!
//! References: the averaging is our own. Prediction of sources by neighbors is from Michael Ashikhmin, "Synthesizing
//! Natural Textures", I3D 2001, DOI 10.1145/364338.364405.
//!
//! Units: positions are in pixels of the exemplar; the center of the first pixel is at 0, x points right and y down.

use crate::columns;
use crate::orientation::turned;
use crate::{Edges, Exemplar, Hierarchy, SiteIdx, Symmetry, Synthesizer};
use glam::{DVec2, Vec2, Vec3};

/// Maximum distance between two predictions of the same source, in pixels of the exemplar.
pub(crate) const AGREEMENT: f32 = 1.5;

/// Minimum cosine of the angle between the directions of two neighbors that belong to the same piece: 45°, which is
/// half of a quarter turn.
const SAME_TURN: f32 = 0.707;

/// Number of averaging steps.
pub(crate) const N_STEPS: usize = 8;

/// Sources of the finest sites in an exemplar.
pub(crate) trait Sourced: Sync {
    /// A position in the exemplar.
    type Place: Copy + Send + Sync;

    /// Returns the source of a site.
    fn of_site(&self, site: usize) -> Self::Place;

    /// Returns the shortest offset to the position `to` from the position `from`, in pixels; infinite if no path
    /// connects them.
    fn difference(&self, to: Self::Place, from: Self::Place) -> Vec2;

    /// Returns the position at offset `by` from another position.
    fn moved(&self, place: Self::Place, by: Vec2) -> Self::Place;
}

/// Subpixel sources of the finest sites in an image.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Places {
    pub(crate) of_site: Vec<Vec2>,
    pub(crate) size: [u32; 2],
    pub(crate) edges: Edges,
}

/// Frame of the texture at a site: its directions on the surface, in pixels of the exemplar per unit length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) right: Vec3,
    pub(crate) down: Vec3,
    /// Size of a pixel of the exemplar, in multiples of the spacing.
    pub(crate) scale: f32,
}

/// Frames of the finest sites.
#[derive(Clone, Debug)]
pub(crate) struct Frames {
    pub(crate) of_site: Vec<Frame>,
    /// Symmetry of the orientation field: frames of neighbors may differ by its rotations.
    symmetry: Symmetry,
}

impl Places {
    /// Computes the subpixel sources of sites from the pixels that were matched.
    pub(crate) fn new(
        hierarchy: &Hierarchy,
        frames: &Frames,
        exemplar: &Exemplar,
        sources: &[u32],
    ) -> Self {
        let [width, _] = exemplar.size;
        let place = |&pixel: &u32| Vec2::new((pixel % width) as f32, (pixel / width) as f32);
        let mut places = Self {
            of_site: sources.iter().map(place).collect(),
            size: exemplar.size,
            edges: exemplar.edges,
        };
        for _ in 0..N_STEPS {
            let averaged = |site: usize| averaged(&places, hierarchy, frames, site);
            let next = columns::column(places.of_site.len(), averaged);
            places.of_site = next;
        }
        places
    }
}

impl Sourced for Places {
    type Place = Vec2;

    #[inline]
    fn of_site(&self, site: usize) -> Vec2 {
        self.of_site[site]
    }

    #[inline]
    fn difference(&self, to: Vec2, from: Vec2) -> Vec2 {
        let way = to - from;
        let size = Vec2::new(self.size[0] as f32, self.size[1] as f32);
        // Most offsets need no wrapping, and rounding is slow on processors without an instruction for it.
        if self.edges == Edges::Cut || way.abs().cmplt(0.5 * size).all() {
            return way;
        }
        // On a torus, take the shortest of the equivalent offsets.
        way - (way / size).round() * size
    }

    #[inline]
    fn moved(&self, place: Vec2, by: Vec2) -> Vec2 {
        place + by
    }
}

/// Returns the mean of a site's source and those predictions of its neighbors that agree with it.
pub(crate) fn averaged<P: Sourced>(
    places: &P,
    hierarchy: &Hierarchy,
    frames: &Frames,
    site: usize,
) -> P::Place {
    let positions = hierarchy.sites().positions();
    let (own, frame) = (places.of_site(site), &frames.of_site[site]);
    let (mut sum, mut count) = (Vec2::ZERO, 1.0);
    let graph = hierarchy.levels()[0].graph();
    for &neighbor in graph.neighbors(SiteIdx(site as u32)) {
        let way = (positions[site] - positions[neighbor.index()]).as_vec3();
        let other = &frames.of_site[neighbor.index()];
        // This neighbor shows the exemplar under another rotation, and cannot predict the source.
        if frames.differ(frame.down, other) {
            continue;
        }
        // The frame changes along the offset; average the offsets in the frames of both ends.
        let way = 0.5 * (frame.flat(way) + other.flat(way));
        // Add the prediction if it agrees.
        let predicted = places.moved(places.of_site(neighbor.index()), way);
        let off = places.difference(predicted, own);
        if off.length_squared() < AGREEMENT * AGREEMENT {
            sum += off;
            count += 1.0;
        }
    }
    // The source itself counts as one prediction, so a site without agreeing neighbors stays.
    places.moved(own, sum / count)
}

impl Frame {
    /// Converts an offset in space to an offset in the exemplar.
    #[inline]
    pub(crate) fn flat(&self, way: Vec3) -> Vec2 {
        Vec2::new(way.dot(self.right), way.dot(self.down))
    }
}

impl Frames {
    /// Computes the frames of sites. `quarters` is the rotation of the exemplar at each site, in quarter turns; if it
    /// is empty, all rotations are 0.
    pub(crate) fn new(synthesizer: &Synthesizer, quarters: &[u8]) -> Self {
        let (hierarchy, orientation) = (synthesizer.hierarchy(), synthesizer.orientation());
        let spacing = hierarchy.levels()[0].spacing();
        let normals = hierarchy.sites().normals();
        let frame = |site: usize| {
            let quarters = quarters.get(site).copied().unwrap_or(0);
            let scale = synthesizer.scale(site);
            // Pixels per unit length.
            let pixels = 1.0 / (spacing * f64::from(scale));
            let down = turned(orientation.vectors()[site], normals[site], quarters);
            Frame {
                right: (normals[site].cross(down) * pixels).as_vec3(),
                down: (down * pixels).as_vec3(),
                scale,
            }
        };
        Self {
            of_site: (0..normals.len()).map(frame).collect(),
            symmetry: orientation.symmetry(),
        }
    }

    /// Returns the area of the surface, in pixels of the exemplar.
    pub(crate) fn n_pixels(&self) -> f64 {
        let scales = self.of_site.iter().map(|frame| f64::from(frame.scale));
        scales.map(|scale| 1.0 / (scale * scale)).sum()
    }

    /// Returns the relative rotation of the exemplar between two sites, in quarter turns.
    #[inline]
    pub(crate) fn quarters_between(&self, from: usize, to: usize) -> u8 {
        let (own, other) = (&self.of_site[from], self.of_site[to].down);
        let along = |axis: Vec3| f64::from(other.dot(axis));
        self.symmetry
            .quarters_to(DVec2::new(along(own.down), along(own.right)))
    }

    /// Returns whether the exemplar is rotated in the frame `other`, relative to a direction `down` of any length.
    #[inline]
    pub(crate) fn differ(&self, down: Vec3, other: &Frame) -> bool {
        let lengths = down.length_squared() * other.down.length_squared();
        self.symmetry != Symmetry::One && down.dot(other.down) < SAME_TURN * lengths.sqrt()
    }
}
