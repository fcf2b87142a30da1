//! Bakes magnified textures: texels sample the exemplar itself, at the positions that the sites around them predict.
//!
//! Each site near a texel predicts a position in the exemplar: its own source plus the offset to the texel in the
//! site's frame. Sites whose predictions agree form a piece, which predicts their weighted mean. Where several pieces
//! meet, the texel shows the piece whose sites have the largest sum of weights. The others fade out over a seam that is
//! too narrow to cause visible blur.
//!
//! Reference: our own, based on the magnification in Sylvain Lefebvre and Hugues Hoppe, "Parallel Controllable Texture
//! Synthesis", SIGGRAPH 2005, DOI 10.1145/1186822.1073261, section 5.

use crate::bake::{Group, Paint, bake_with};
use crate::places::{AGREEMENT, Frames, Sourced};
use crate::{Atlas, SynthError, Synthesizer};
use dapple_mesh::FaceIdx;
use dapple_raster::{Raster, simd};
use glam::{DVec2, Vec2, Vec3};
use reach::{Reach, Reaching};

mod reach;

/// Radius within which sites have weight, in multiples of the spacing. It is 1.5 times the radius for means of values,
/// so that seams are smooth and a single site between others is outvoted.
const RADIUS: f32 = 1.5;

/// Minimum weight of a piece, relative to the largest; pieces below it are not shown.
const SHARE_LEAST: f32 = 1.0 / 256.0;

/// Position and frame at which a texel samples the exemplar.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot<P> {
    /// Position in the exemplar.
    pub(crate) place: P,
    /// Side of the texel, in pixels of the exemplar: the square root of its area.
    pub(crate) footprint: f32,
    /// Directions in space of the exemplar's rows (`right`) and columns (`down`); unit vectors up to rounding.
    pub(crate) right: Vec3,
    pub(crate) down: Vec3,
}

/// Renders the values of an exemplar's map at every texel of an atlas. Texels without a face get `background`.
pub(crate) fn magnify<const N: usize, P: Sourced>(
    synthesizer: &Synthesizer,
    places: &P,
    quarters: &[u8],
    atlas: &Atlas,
    background: [f32; N],
    value: impl Fn(&Spot<P::Place>) -> [f32; N] + Sync,
) -> Result<Raster<[f32; N]>, SynthError> {
    let (surface, hierarchy) = (synthesizer.surface(), synthesizer.hierarchy());
    let spacing = hierarchy.levels()[0].spacing();
    let magnified = Magnified {
        places,
        frames: Frames::new(synthesizer, quarters),
        footprints: footprints(synthesizer, &atlas.uvs(), atlas.size()),
        spacing: spacing as f32,
        value: &|spot: &Spot<P::Place>, channels: &mut [f32]| {
            channels.copy_from_slice(&value(spot));
        },
    };
    bake_with(surface, hierarchy, atlas, background, &|| {
        Box::new(Magnifier {
            input: &magnified,
            reach: Reach::default(),
            pieces: Pieces {
                pieces: Vec::new(),
                channels: Vec::new(),
            },
        })
    })
}

/// Returns the side of a texel on every face, as the square root of its area, in multiples of the spacing. It is 0 for
/// a face without area in the atlas.
pub(crate) fn footprints(
    synthesizer: &Synthesizer,
    uvs: &[[DVec2; 3]],
    size: [u32; 2],
) -> Vec<f32> {
    let spacing = synthesizer.hierarchy().levels()[0].spacing();
    let size = DVec2::from(size.map(f64::from));
    let mesh = synthesizer.surface().mesh();
    let side = |(face, uvs): (FaceIdx, &[DVec2; 3])| {
        let [a, b, c] = mesh.corners(face);
        let [ua, ub, uc] = uvs.map(|uv| uv * size);
        let texels = (ub - ua).perp_dot(uc - ua).abs();
        let area = (b - a).cross(c - a).length();
        // The ratio of the areas is the area of a texel on the surface.
        let side = (area / texels).sqrt() / spacing;
        // The side is not finite if the face has no area in the atlas; no texel shows such a face.
        if side.is_finite() { side as f32 } else { 0.0 }
    };
    (0..).map(FaceIdx).zip(uvs).map(side).collect()
}

/// Function that writes the channels of a spot.
type ValueOf<'a, P> = dyn Fn(&Spot<P>, &mut [f32]) + Sync + 'a;

/// Input shared by all texels.
struct Magnified<'a, P: Sourced> {
    places: &'a P,
    frames: Frames,
    footprints: Vec<f32>,
    spacing: f32,
    value: &'a ValueOf<'a, P::Place>,
}

/// Sites that predict about the same position, summed by weight.
#[derive(Clone, Copy, Debug)]
struct Piece<P> {
    /// Prediction of the first site, which has the largest weight.
    place: P,
    /// Weighted sums over the sites: offsets of the predictions from `place`, directions, and scales; then the sum of
    /// weights.
    off: Vec2,
    right: Vec3,
    down: Vec3,
    scale: f32,
    weight: f32,
}

/// Scratch memory of a thread.
#[derive(Debug)]
struct Pieces<P> {
    pieces: Vec<Piece<P>>,
    /// Channels of one piece.
    channels: Vec<f32>,
}

/// Input shared by all texels, with the scratch memory of a thread.
struct Magnifier<'a, P: Sourced> {
    input: &'a Magnified<'a, P>,
    reach: Reach,
    pieces: Pieces<P::Place>,
}

impl<P: Sourced> Paint for Magnifier<'_, P> {
    fn paint(&mut self, group: &Group<'_>, values: &mut [f32]) {
        let (input, memory) = (self.input, &mut self.pieces);
        let footprint = input.footprints[group.face.index()];
        let n_channels = values.len() / group.points.len();
        // Find the sites within reach of each point, largest weight first.
        self.reach
            .find(simd::level(), group, RADIUS * input.spacing);
        let values = values.chunks_exact_mut(n_channels);
        for (value, reaching) in values.zip(self.reach.of_points()) {
            input.gather(reaching, &mut memory.pieces);
            input.mix(memory, footprint, value);
        }
    }
}

impl<P: Sourced> Magnified<'_, P> {
    /// Groups the sites within reach into pieces whose predictions agree.
    fn gather(&self, reaching: &[Reaching], pieces: &mut Vec<Piece<P::Place>>) {
        pieces.clear();
        for &Reaching { site, way, weight } in reaching {
            // Predict the position at the texel.
            let frame = &self.frames.of_site[site as usize];
            let own = self.places.of_site(site as usize);
            let place = self.places.moved(own, frame.flat(way));
            let agrees = |piece: &&mut Piece<P::Place>| {
                let off = self.places.difference(place, piece.place);
                let is_near = off.length_squared() < AGREEMENT * AGREEMENT;
                is_near && !self.frames.differ(piece.down, frame)
            };
            // Add the site to the first piece that agrees, or start a new one.
            if let Some(piece) = pieces.iter_mut().find(agrees) {
                piece.off += self.places.difference(place, piece.place) * weight;
                // Axes have the length 1 / (spacing · scale). Times the scale, the axes of all sites are equally long.
                piece.right += frame.right * (weight * frame.scale);
                piece.down += frame.down * (weight * frame.scale);
                piece.scale += weight * frame.scale;
                piece.weight += weight;
            } else {
                pieces.push(Piece {
                    place,
                    off: Vec2::ZERO,
                    right: frame.right * (weight * frame.scale),
                    down: frame.down * (weight * frame.scale),
                    scale: weight * frame.scale,
                    weight,
                });
            }
        }
    }

    /// Writes the channels of the piece with the largest weight, or a mixture of several pieces at a seam.
    fn mix(&self, memory: &mut Pieces<P::Place>, footprint: f32, mixed: &mut [f32]) {
        // Shares are relative to the heaviest piece, so at least one piece has a share of 1.
        let most = memory
            .pieces
            .iter()
            .fold(0.0, |most: f32, piece| most.max(piece.weight));
        memory.channels.resize(mixed.len(), 0.0);
        mixed.fill(0.0);
        let mut shares = 0.0;
        for piece in &memory.pieces {
            // The eighth power of the relative weight keeps seams narrow.
            let part = piece.weight / most;
            let square = part * part;
            let fourth = square * square;
            let share = fourth * fourth;
            if share < SHARE_LEAST {
                continue;
            }
            let spot = Spot {
                place: self.places.moved(piece.place, piece.off / piece.weight),
                footprint: footprint * (piece.weight / piece.scale),
                right: piece.right * (self.spacing / piece.weight),
                down: piece.down * (self.spacing / piece.weight),
            };
            (self.value)(&spot, &mut memory.channels);
            for (sum, channel) in mixed.iter_mut().zip(&memory.channels) {
                *sum += share * channel;
            }
            shares += share;
        }
        // Normalize the shares.
        mixed.iter_mut().for_each(|sum| *sum /= shares);
    }
}

#[cfg(test)]
mod tests;
