//! Example-based texture synthesis: generates more of an example image, as a flat image, a tile, an endless plane, or
//! over a triangle mesh.
//!
//! A small image, the *exemplar*, and a few directions become a texture that covers a mesh without seams and follows
//! the directions. This is a complete implementation of Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001,
//! <https://doi.org/10.1145/383259.383297>.
//!
//! ```
//! use dapple_color::LinearRgb;
//! use dapple_raster::Raster;
//! use dapple_synth::mesh::{Mesh, glam::DVec3};
//! use dapple_synth::{Atlas, Direction, Edges, Exemplar, HierarchyOptions, Options};
//! use dapple_synth::{bake_colors, synthesize, synthesize_plane};
//!
//! let checker = Raster::from_fn([16, 16], |x, y| match (x / 4 + y / 4) % 2 {
//!     0 => LinearRgb::new(0.8, 0.6, 0.2),
//!     _ => LinearRgb::new(0.1, 0.1, 0.3),
//! })?;
//! let exemplar = Exemplar::new(&checker, Edges::Wrap)?;
//!
//! // A tile of 64 × 64 pixels that looks like the exemplar.
//! let tile = synthesize_plane(&exemplar, [64, 64], [Edges::Wrap; 2], &Options::default())?;
//! let image = tile.transfer(&checker)?;
//!
//! // A tetrahedron; `dapple_mesh_io::read_model` reads yours. The pattern runs down from its top.
//! let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let mesh = Mesh::new(corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
//! let down = Direction { at: DVec3::Y, vector: DVec3::NEG_Y };
//! let sites = HierarchyOptions { n_sites: 2000, ..HierarchyOptions::default() };
//! let (covered, texture) = synthesize(mesh, &exemplar, &[down], &sites, &Options::default())?;
//!
//! // The texture as a map of 256 × 256 pixels.
//! let atlas = Atlas::uniform(covered.surface(), 256)?;
//! let map = bake_colors(&covered, &texture, &checker, &atlas)?;
//! assert_eq!(map.size(), [256, 256]);
//! # assert_eq!(image.size(), [64, 64]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ways to use it
//!
//! | to make | call | cost |
//! |---|---|---|
//! | an image or a tile in the plane | [`synthesize_plane`] | 0.91 s for 512 × 512 pixels |
//! | any window of an endless texture | [`Endless`] | 0.56 s for 512 × 512 pixels |
//! | a texture over a mesh | [`synthesize`], or [`Synthesizer`] to use sites again | 1.04 s for 262,144 sites |
//! | a texture that follows an image, or several examples | [`synthesize_plane_guided`], [`SideBySide`] | 0.55 s and 0.38 s for 192 × 192 pixels |
//! | directions and sizes from images | [`synthesize_plane_along`] | |
//! | a tile of a photograph | [`tile_plane`] | |
//! | a repaired part of an image | [`PlaneTexture::repair`] | 0.03 s for 39 × 39 pixels |
//! | the texture of one mesh on another mesh | [`MeshExemplar`], [`Synthesizer::lift`] | |
//! | texture maps of colors, heights, normals | [`bake_colors`], [`bake_values`], [`bake_normals`] | |
//! | a file with the textured mesh | [`textured_model`], [`site_model`] | |
//!
//! Times are from one thread of a server processor (AMD EPYC), with an exemplar of 64 × 64 pixels, three levels and
//! default options; the two for 192 × 192 pixels and the repair are from other exemplars.
//!
//! Functions named `…_with`, and [`Synthesizer::synthesize_with`], take a callback for progress, which can stop the
//! work.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | works on all cores; the bits do not change |
//! | `serde` | off | reads and writes the options as data |
//! | `json` | off | reads directions from JSON; includes `serde` |
//!
//! # Limits
//!
//! * A texture in the plane, or a window of an endless one, has at most 2^26 pixels. During synthesis, each pixel takes
//!   about 200 bytes.
//! * A complete run on a mesh with 1,048,576 sites took 541 MB of memory.
//! * Each level of the exemplar must be larger than a neighborhood. There are at most 16 levels.
//! * A side that wraps must be divisible by 2 once for each level except the last. The period of an endless texture
//!   must be a multiple of 2 to the power of the number of levels.
//! * A mesh may be open, in several pieces, and with any number of holes. Every face must have an area, and the winding
//!   must be consistent; call [`Mesh::repair`](dapple_mesh::Mesh::repair) first.
//! * Where the orientation field rotates around a point, the texture has a tear.
//! * No model is trained, and nothing is downloaded. All pixels are from the exemplar.
//! * A result is a function of the inputs, which include two seeds: one for the sites, and one in [`Options`]. Results
//!   have the same bits on every machine, with every SIMD level and any number of threads.
//!
//! # Without std
//!
//! Not possible today. Sites that wait for others yield their thread with a function of std, `floor` and `sqrt` of
//! `f64` are methods of std, and `dapple-raster`, `dapple-color`, `dapple-mesh` and `uvunwrap` need std.
//!
//! # How it works
//!
//! 1. **Sites.** Evenly spaced points, the *sites*, cover the surface on several levels; each level has four times the
//!    sites of the next coarser one ([`Hierarchy`]). Sites are the pixels of the texture.
//! 2. **Orientation.** The given directions are interpolated to a unit tangent at every site ([`Orientation`]): the
//!    texture's "down". Fields with two or four directions ([`Orientation::symmetric`]) have fewer and weaker
//!    singularities; they suit examples that look similar when rotated, such as bricks or checkers.
//! 3. **Matching.** The coarsest level follows the paper ([`Matching::Colors`]): sites are visited along the
//!    orientation ([`Sweep`]), and each takes the exemplar pixel with the most similar neighborhood ([`Schedule`],
//!    [`Matcher`]).
//! 4. **Correction.** By default ([`Matching::Appearance`]) every level is then corrected by appearance, after Lefebvre
//!    and Hoppe (2006): a site is compared with windows of the exemplar around its neighbors' pixels. This takes a
//!    quarter of the time of full matching, and strands and letters stay connected more often.
//! 5. **Baking.** A [`SurfaceTexture`] stores for each site its exemplar pixel, not only a color. Other maps of the
//!    exemplar (height, roughness, normals) therefore follow: [`bake_colors`], [`bake_values`] and [`bake_normals`]
//!    write texture maps with one [`Atlas`]. [`displaced_sites`] moves the mesh itself.
//!
//! [`Synthesizer`] stores sites and orientation for reuse with other exemplars.
//!
//! The channels of an exemplar determine which values are matched; see [`Exemplar::from_planes`] and
//! [`Exemplar::with_channels`]. Guides ([`Exemplar::with_guides`]) control which part of the exemplar is used where, by
//! brightness or by the index of one of several examples ([`SideBySide`], [`Turned`]).
//!
//! Where directions diverge, new rows of features begin; where they converge, rows end. With
//! [`Synthesizer::with_conformal_scales`] the features grow and shrink instead.
//!
//! [`Endless`] textures run the correction on a plane without bounds. Any window can be computed independently, in a
//! tenth of the time of [`synthesize_plane`], and large or regular features, such as courses of bricks, stay intact.
//!
//! # The paper's sections
//!
//! | section | topic | here |
//! |---|---|---|
//! | 3.1 | points on several levels, by repulsion, and their neighbors | [`Hierarchy`] |
//! | 3.2 | interpolation, low-pass filter, down- and upsampling | [`Hierarchy::interpolate`] and its siblings |
//! | 4.1 | vector fields from a few directions, by pull and push | [`Orientation`], [`Direction`] |
//! | 4.2, eq. 4, 5 | sweep distance along the field, and the order of sites | [`Sweep`] |
//! | 5.1 | one level | [`Schedule::single_level`] |
//! | 5.2 | several levels; figure 4 | [`Schedule::paper`], [`Part`], [`Shape`] |
//! | 5 | the pixel whose neighborhood matches best | [`Candidates`], [`Matcher`] |
//! | 6 | the finest points with colors, as a mesh | [`site_model`], [`point_model`] |
//! | 6 | a texture map of right triangles, or of charts | [`Atlas`], [`bake()`], [`textured_model`] |
//! | 8 | patterns from other surfaces, their colors, bumps and ridges | [`MeshExemplar`] |
//!
//! # Choices that the paper leaves open
//!
//! [`Options::paper`] follows the paper literally and documents its departures. The defaults differ where another
//! choice measured better:
//!
//! * The neighborhood on the coarser level is centered at exactly half of the coordinates ([`CoarserCenter`]). Rounded
//!   down, four pixels share a center, and the first of them always wins.
//! * A worse match is accepted if it extends a neighbor's piece ([`Coherence`]). The smallest difference alone repeats
//!   smooth parts of the exemplar and blurs structure such as bricks.
//! * On the coarsest level, pixels that were used before cost more, and pixels near an edge of the exemplar are
//!   candidates, too ([`Options::evenness`]). The smallest difference alone would leave a third of the exemplar and
//!   most rare colors unused.
//! * Sites store positions between pixels, and texels read the exemplar there ([`Sources`]). Averages of site colors
//!   are softer than the exemplar, with edges as jagged as the sites. A larger version of the exemplar can be read for
//!   detail.
//! * On surfaces the exemplar is blurred as much as interpolated neighborhoods are before both are compared. Otherwise
//!   smooth parts match best.
//! * The rows and columns of a neighborhood rotate with the field around its site ([`Axes`]). With straight axes,
//!   stripes around a torus are off by 3.7 degrees instead of 1.5.
//!
//! [`Options::paper`] and the defaults share these choices:
//!
//! * P = n × O points to the right, so that nothing is mirrored. Neighborhoods are laid out by walking over the input's
//!   faces, with both directions transported over its edges, and not over the graph of sites.
//! * Only sites within 1.1 times the site spacing contribute to an interpolated color. Sites on another sheet, with
//!   normals more than a right angle apart, do not. With a radius of twice the spacing, colors blur.
//! * H(n, 0) has only the rows above the center ([`Shape::Half`]), since half of the center's row is still random.
//! * Neighborhoods that cross an edge of the exemplar are excluded while enough others remain; exemplars may wrap.
//! * A pass changes colors in place, in the order of the sweep. Among equally good pixels the first wins.
//! * Colors are compared as sRGB codes; the pyramid is not rounded to codes.
//! * Without a given direction, the texture is oriented along an axis. Every piece of the surface has its own anchor.
//! * The texture has a tear where the field rotates around a point, or where order and field conflict. No method avoids
//!   this.
//!
//! Sites run in parallel only if they do not read each other, so the number of threads does not change the result.

#![forbid(unsafe_code)]

mod appearance;
mod atlas;
mod bake;
mod bake_normals;
mod candidates;
mod cells;
mod columns;
mod detail;
mod directions;
mod displaced;
mod display;
mod domain;
mod endless;
mod engine;
mod error;
mod exemplar;
mod grid;
mod guides;
mod level_pass;
mod lift;
mod likeness;
mod links;
mod magnify;
mod maps;
mod matcher;
mod mesh_domain;
mod neighborhood;
mod options;
mod orientation;
mod parents;
mod places;
mod plane;
mod plane_along;
mod regularity;
mod sample_cache;
#[cfg(test)]
mod shapes;
mod side_by_side;
mod sites;
mod solve;
mod surface_texture;
mod sweep;
mod synthesizer;
mod table;
mod turned;
mod usage;
mod wavefront;

pub use atlas::{Atlas, AtlasReport};
pub use bake::bake;
pub use bake_normals::bake_normals;
pub use dapple_color as color;
pub use dapple_hash as hash;
pub use dapple_mesh as mesh;
pub use dapple_raster as raster;
pub use displaced::{displaced_mesh, displaced_sites};
pub use display::{point_model, site_model, textured_model};
pub use endless::{Endless, EndlessOptions};
pub use engine::Progress;
pub use error::{SynthError, SynthErrorKind};
pub use exemplar::{Edges, Exemplar, Pyramid};
pub use lift::MeshExemplar;
pub use likeness::Likeness;
pub use maps::{bake_colors, bake_colors_alpha, bake_values};
pub use neighborhood::{Part, Pass, Reads, Schedule, Shape};
pub use options::{Axes, Coherence, Matching, Options, Sources};
pub use orientation::{Direction, Orientation, Symmetry};
#[doc(alias("texture synthesis", "inpaint", "inpainting"))]
pub use plane::synthesize_plane;
pub use plane::{
    PlaneTexture, repair_levels, synthesize_plane_guided, synthesize_plane_with, tile_plane,
};
pub use plane_along::{PlaneAlong, PlaneScales, synthesize_plane_along};
pub use side_by_side::SideBySide;
pub use sites::{
    Blend, Connected, Evenness, Hierarchy, HierarchyOptions, Level, SiteGraph, SiteGrid, SiteIdx,
    SiteTriangles, Sites, evenness, hexagonal_spacing, nested_points, repeats_of_sites, repel,
    scatter, sites_for_exemplar, sites_for_repeats,
};
pub use surface_texture::SurfaceTexture;
pub use sweep::Sweep;
pub use synthesizer::{Synthesizer, synthesize};
pub use table::{TableRow, parse_table};
pub use turned::Turned;

// Only for the benches and tests of the workspace.
#[doc(hidden)]
pub use candidates::{Candidates, CoarserCenter};
#[doc(hidden)]
pub use matcher::{Match, Matcher, MatcherMemory, distance_sq};
#[doc(hidden)]
pub use sites::{DOWNSAMPLE_STEPS, DOWNSAMPLE_T, INTERPOLATION_RADIUS, LowPass, STAR_RADIUS};
