//! Bakes normal maps: rotates the exemplar's normals into the tangent frames of a texture map.
//!
//! A normal of the exemplar has three components: right, up or down (see [`NormalY`]), and outward. On the surface
//! these directions are P, O (which points down) and n of the site that copies the normal. Between sites, the
//! tangential vectors are interpolated in space, not by component: near a singularity of the field, where frames rotate
//! fast, components of adjacent sites would not match.
//!
//! The frame of a texel follows glTF 2.0. N is the interpolated shading normal of the face's corners. T is the tangent
//! along +u, perpendicular to N. B = ± N × T points to the top of the map; the sign depends on whether the face is
//! mirrored there. T equals the tangent that other programs compute if a file has no tangents. Sites have the normals
//! of the smooth surface. Where the shading normal differs, as next to a crease, tangential vectors rotate with it.
//!
//! Reference: Morten S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", master's thesis, University of
//! Copenhagen, 2008.

use crate::atlas::{self, Tangents};
use crate::detail::Detail;
use crate::display::check_shading;
use crate::lift::{LiftedDetail, Origin};
use crate::magnify::magnify;
use crate::maps::{check_column, check_finite};
use crate::{Atlas, SurfaceTexture, SynthError, Synthesizer, bake, orientation};
use core::iter::repeat;
use dapple_color::{Normal, NormalY};
use dapple_mesh::{CREASE, Walk};
use dapple_raster::Raster;
use glam::DVec3;

/// Bakes the exemplar's normal map. `map` is the same size as the exemplar, or an integer multiple of it.
///
/// `y` is the direction of the green channel, in `map` and in the result. `shading` has the normal of every corner of
/// every face, as in [`textured_model`](crate::textured_model). Texels without a face get the flat normal.
///
/// Codes adjacent to the middle code of an image count as 0 (see [`Normal::centered`]), because their slope, rotated
/// into the frames of charts, would show at seams in flat regions.
///
/// # Errors
///
/// Same as [`bake_colors`](crate::bake_colors), and [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) unless
/// `shading` has a normal for each corner.
///
/// # Examples
///
/// ```
/// use dapple_color::{Normal, NormalY};
/// use dapple_raster::Raster;
/// use dapple_synth::mesh::{CREASE, Mesh, glam::DVec3};
/// use dapple_synth::{Atlas, Edges, Exemplar, HierarchyOptions, Options, bake_normals, synthesize};
///
/// let height = Raster::from_fn([16, 16], |x, y| f32::from((x / 4 + y / 4) % 2 == 0))?;
/// let exemplar = Exemplar::from_planes(&[(&height, 1.0)], Edges::Wrap)?;
/// let sites = HierarchyOptions { n_sites: 500, ..Default::default() };
/// // A tetrahedron; `dapple_mesh_io::read_model` reads yours.
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = Mesh::new(corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let (covered, texture) = synthesize(mesh, &exemplar, &[], &sites, &Options::default())?;
/// let atlas = Atlas::uniform(covered.surface(), 128)?;
/// let shading = covered.surface().mesh().corner_normals(CREASE);
/// let normals = Raster::filled([16, 16], Normal::FLAT)?;
/// let map = bake_normals(&covered, &texture, &normals, NormalY::OpenGl, &atlas, &shading)?;
/// assert!(map.pixels().iter().all(|&normal| normal == Normal::FLAT));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bake_normals(
    synthesizer: &Synthesizer,
    texture: &SurfaceTexture,
    map: &Raster<Normal>,
    y: NormalY,
    atlas: &Atlas,
    shading: &[[DVec3; 3]],
) -> Result<Raster<Normal>, SynthError> {
    let surface = synthesizer.surface();
    check_shading(surface, shading)?;
    check_column(synthesizer, "sites of the texture", texture.n_sites())?;
    for part in map.pixels().iter().flat_map(|normal| normal.to_array()) {
        check_finite("part of a normal", part)?;
    }
    let map = match y {
        NormalY::OpenGl => map.par_map(|normal| normal.centered().to_array()),
        NormalY::DirectX => map.par_map(|&normal| turned_over(normal.centered()).to_array()),
    };
    // Bake the normals in space, then express each in the frame of its texel.
    let values = in_space(synthesizer, texture, map, atlas)?;
    let tangents = Tangents::new(surface, atlas, shading);
    let map = Raster::from_rows(atlas.size(), |row| {
        let (values, tangents) = (&values, &tangents);
        (0..atlas.size()[0]).map(move |column| {
            let texel = [column, row];
            let (Some(face), Some(point)) = (atlas.face(texel), atlas.point(surface, texel)) else {
                return Normal::FLAT;
            };
            // Rotate the tangential part from the smooth normal to the shading normal.
            let out = atlas::mixed(atlas, face, texel, shading[face.index()]);
            let out = out.normalize_or(surface.face_normal(face));
            let frame = tangents.frame(atlas, texel, out);
            let [x, y, z, rest] = values.row(row)[column as usize];
            let along = DVec3::new(x.into(), y.into(), z.into());
            in_frame(
                turned(along, surface.normal(point), out),
                rest.into(),
                frame,
            )
        })
    })?;
    Ok(match y {
        NormalY::OpenGl => map,
        NormalY::DirectX => map.par_map(|&normal| turned_over(normal)),
    })
}

/// Returns, for each texel, the tangential part of its normal as a vector in space, and the outward component.
fn in_space(
    synthesizer: &Synthesizer,
    texture: &SurfaceTexture,
    map: Raster<[f32; 3]>,
    atlas: &Atlas,
) -> Result<Raster<[f32; 4]>, SynthError> {
    let flat = [0.0, 0.0, 0.0, 1.0];
    let turn = |[x, y, z]: [f32; 3], right: DVec3, down: DVec3| {
        let along = right * f64::from(x) - down * f64::from(y);
        [along.x as f32, along.y as f32, along.z as f32, z]
    };
    // Source is a surface: take the normals from its map.
    if let Some(places) = texture.lifted_between() {
        let relief = Relief::new(&places.origin, map.size())?;
        let detail = LiftedDetail::new(map, &places.origin)?;
        return magnify(
            synthesizer,
            places,
            &texture.quarters,
            atlas,
            flat,
            |spot| {
                let walk = places.origin.walk(spot.place);
                let normal = relief.turned(detail.sample(walk.point, spot.footprint), &walk);
                turn(normal, spot.right.as_dvec3(), spot.down.as_dvec3())
            },
        );
    }
    // Source is an image, with subpixel positions.
    if let Some(places) = &texture.places {
        let detail = Detail::new(map, places.size, places.edges)?;
        return magnify(
            synthesizer,
            places,
            &texture.quarters,
            atlas,
            flat,
            |spot| {
                let normal = detail.sample(spot.place, spot.footprint);
                turn(normal, spot.right.as_dvec3(), spot.down.as_dvec3())
            },
        );
    }
    // Otherwise interpolate values between sites.
    let (surface, hierarchy) = (synthesizer.surface(), synthesizer.hierarchy());
    let (outs, downs) = (
        hierarchy.sites().normals(),
        synthesizer.orientation().vectors(),
    );
    let mut normals = texture.transfer(&map)?;
    if let Some(places) = &texture.lifted {
        let relief = Relief::new(&places.origin, map.size())?;
        for (normal, &place) in normals.iter_mut().zip(&places.of_site) {
            *normal = relief.turned(*normal, &places.origin.walk(place));
        }
    }
    let quarters = texture.quarters.iter().copied().chain(repeat(0));
    let sites = normals.into_iter().zip(outs).zip(downs).zip(quarters);
    let column: Vec<f32> = sites
        .flat_map(|(((normal, &out), &down), quarters)| {
            let down = orientation::turned(down, out, quarters);
            turn(normal, out.cross(down), down)
        })
        .collect();
    bake::<4>(surface, hierarchy, &column, atlas, flat)
}

/// Tangent frames of a source surface, from its texture coordinates. Its shading normals are smooth between creases.
struct Relief<'a> {
    origin: &'a Origin,
    shading: Vec<[DVec3; 3]>,
    tangents: Tangents,
}

impl<'a> Relief<'a> {
    fn new(origin: &'a Origin, size: [u32; 2]) -> Result<Self, SynthError> {
        let surface = origin.synthesizer.surface();
        let atlas = Atlas::from_uvs(surface, &origin.uvs, size, 0)?;
        let shading = surface.mesh().corner_normals(CREASE);
        Ok(Self {
            tangents: Tangents::new(surface, &atlas, &shading),
            origin,
            shading,
        })
    }

    /// Converts a normal from the tangent frame at the end of `walk` to the texture's axes there. Components are right,
    /// up and outward.
    fn turned(&self, [x, y, z]: [f32; 3], walk: &Walk) -> [f32; 3] {
        let surface = self.origin.synthesizer.surface();
        let face = walk.point.face;
        let weights = surface.weights(walk.point);
        let shaded = atlas::sum(self.shading[face.index()], weights);
        let out = shaded.normalize_or(surface.face_normal(face));
        let [tangent, up] = self.tangents.frame_of(face, weights, out);
        let along = tangent * f64::from(x) + up * f64::from(y);
        let along = turned(along, out, surface.face_normal(face));
        let [right, down] = [walk.direction.perp(), walk.direction]
            .map(|direction| along.dot(surface.lift(face, direction)) as f32);
        [right, -down, z]
    }
}

/// Rotates `vector` by the shortest rotation that takes the unit vector `from` to the unit vector `to`.
pub(crate) fn turned(vector: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let (sum, cos) = (from + to, from.dot(to));
    if cos <= -1.0 + 1e-9 {
        // Opposite vectors have no shortest rotation.
        return vector;
    }
    vector - sum * (sum.dot(vector) / (1.0 + cos)) + to * (2.0 * from.dot(vector))
}

/// Returns the unit normal with the tangential part `along` and the outward component `out`. The tangential part is
/// expressed in the frame of `tangent` and `bitangent`.
fn in_frame(along: DVec3, out: f64, [tangent, bitangent]: [DVec3; 2]) -> Normal {
    let normal = DVec3::new(along.dot(tangent), along.dot(bitangent), out);
    // The interpolated normals may cancel where they are opposite.
    let [x, y, z] = normal.normalize_or(DVec3::Z).as_vec3().to_array();
    Normal { x, y, z }
}

/// Returns `normal` with the green channel inverted.
fn turned_over(normal: Normal) -> Normal {
    // Subtract instead of negating: 0 does not become -0.
    let y = 0.0 - normal.y;
    Normal { y, ..normal }
}

#[cfg(test)]
mod tests;
