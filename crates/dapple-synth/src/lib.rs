//! Texture synthesis: more of an example image, as a flat image, a tile, an endless plane, or over a triangle mesh.
//!
//! A small image, the *exemplar*, and a few directions become a texture that covers a mesh without seams and follows
//! the directions. After Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001,
//! <https://doi.org/10.1145/383259.383297>: all of it.
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
//! | a part of an image again | [`PlaneTexture::repair`] | 0.03 s for 39 × 39 pixels |
//! | the texture of one mesh on another | [`MeshExemplar`], [`Synthesizer::lift`] | |
//! | texture maps of colors, heights, normals | [`bake_colors`], [`bake_values`], [`bake_normals`] | |
//! | a file of the covered mesh | [`textured_model`], [`site_model`] | |
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
//! * A texture in the plane, or a window of an endless one, has at most 2^26 pixels. While it is made, a pixel takes
//!   about 200 bytes.
//! * A whole run over a mesh with 1,048,576 sites took 541 MB of memory.
//! * Each level of the exemplar must be larger than a neighborhood. There are at most 16 levels.
//! * A side that wraps must be divisible by 2 once for each level but the last. The period of an endless texture is a
//!   multiple of 2 to the number of levels.
//! * A mesh may be open and in pieces, with any number of holes. Faces need an area and a consistent winding: call
//!   [`Mesh::repair`](dapple_mesh::Mesh::repair) first.
//! * Where a field of directions turns around a point, the texture has a tear.
//! * No model is trained, and nothing is downloaded: all pixels are from the exemplar.
//! * A result is a function of the inputs. Two of them are seeds: one of the sites, and one in [`Options`]. Results
//!   have the same bits on every machine, with every SIMD level and any number of threads.
//!
//! # Without std
//!
//! Not possible today. Sites that wait for others yield their thread with a function of std, `floor` and `sqrt` of
//! `f64` are methods of std, and `dapple-raster`, `dapple-color`, `dapple-mesh` and `uvunwrap` need std.
//!
//! # How it works
//!
//! Even points, the *sites*, are scattered over the surface on several levels, each four times as dense as the next
//! coarser one; they are the pixels of the texture ([`Hierarchy`]). The directions are interpolated to a unit vector at
//! every site ([`Orientation`]), which is the "down" of the texture there, and sites are put in an order that runs
//! along it ([`Sweep`]). Then, from the coarsest level to the finest, every site looks at the colors around it, as they
//! lie to the right of it and below it, and takes the color of that pixel of the exemplar around which it looks most
//! alike ([`Schedule`], [`Matcher`]). A [`SurfaceTexture`] has the color and, more than that, the pixel that each site
//! took.
//!
//! That is the paper's way, [`Matching::Colors`]. By default only the coarsest level is made so
//! ([`Matching::Appearance`]). On all levels the sites are then corrected by what the exemplar looks like around the
//! pixels that the sites around them took. It takes a quarter of the time, and what is connected in the exemplar, as
//! strands and letters are, is more often whole.
//!
//! So other maps of the exemplar can follow: [`bake_values`] and [`bake_normals`] write heights, roughness and normals
//! to texture maps with the same [`Atlas`] as [`bake_colors`] does colors. What is to be matched and what only follows
//! is the caller's choice: see [`Exemplar::from_planes`], [`Exemplar::with_channels`] and the example of
//! [`bake_values`]. [`textured_model`] and [`site_model`] make what file formats take, [`displaced_sites`] moves the
//! mesh itself.
//!
//! [`Synthesizer`] keeps all that does not depend on the exemplar; it can be used again, reports its progress and can
//! be stopped. The same passes on pixels, for plain images and for tiles, are [`synthesize_plane`];
//! [`PlaneTexture::repair`] makes a part of an image again, and [`tile_plane`] a tile of a photograph that does not
//! repeat.
//!
//! [`Endless`] textures are made in the plane in another way, after Lefebvre and Hoppe: all pixels of a level at once,
//! from what is near them. So any window of a texture without ends can be made on its own, in a tenth of the time, and
//! what is large or regular in an exemplar, such as courses of bricks, goes on.
//!
//! The example may be another textured surface ([`MeshExemplar`]): [`Synthesizer::lift`] puts its texture and relief
//! onto this one, and [`MeshExemplar::repair`] makes a part of its own texture again.
//!
//! Bricks look alike upside down, and a checker lying on its side. Fields of two or four directions
//! ([`Orientation::symmetric`]) turn around fewer and gentler singularities, and textures go on across the places at
//! which they turn. In the plane, [`synthesize_plane_along`] takes directions and sizes of features from images.
//!
//! Where directions spread, rows of features of one size begin, and where they meet, rows end. Features may grow and
//! shrink there instead: [`Synthesizer::with_conformal_scales`] finds the sizes with which they go on.
//!
//! Guides ([`Exemplar::with_guides`]) say where in a texture which part of the exemplar goes: how light it is, so that
//! the texture shows an image; or which of several images, which lie [`SideBySide`]. There each may lie [`Turned`],
//! too.
//!
//! # The paper's sections
//!
//! | section | what it says | here |
//! |---|---|---|
//! | 3.1 | points on several levels, by repulsion, and their neighbors | [`Hierarchy`] |
//! | 3.2 | interpolation, low-pass filter, down- and upsampling | [`Hierarchy::interpolate`] and beside it |
//! | 4.1 | vector fields from a few directions, by pull and push | [`Orientation`], [`Direction`] |
//! | 4.2, eq. 4, 5 | how far downstream a site is, and the order | [`Sweep`] |
//! | 5.1 | one level | [`Schedule::single_level`] |
//! | 5.2 | several levels; figure 4 | [`Schedule::paper`], [`Part`], [`Shape`] |
//! | 5 | the pixel whose neighborhood matches best | [`Candidates`], [`Matcher`] |
//! | 6 | the finest points with colors, as a mesh | [`site_model`], [`point_model`] |
//! | 6 | a texture map of right triangles, or of charts | [`Atlas`], [`bake()`], [`textured_model`] |
//! | 8 | patterns from other surfaces, their colors, bumps and ridges | [`MeshExemplar`] |
//!
//! # What the paper leaves open
//!
//! [`Options::paper`] takes the paper at its word, and says where even it departs; the default takes what turned out
//! better:
//!
//! * The neighborhood on the coarser level is centered at exactly half of the coordinates ([`CoarserCenter`]). Rounded
//!   down, four pixels have the same one, and the first of them always wins.
//! * A match may be worse if it goes on with what a neighbor took ([`Coherence`]). The least difference alone tends to
//!   repeat smooth parts of the exemplar and to blur away structure like bricks.
//! * Pixels that were used cost more on the coarsest level, and those near an edge of the exemplar are used, too
//!   ([`Options::evenness`]). The least difference alone leaves out a third of the exemplar and most colors that are
//!   rare.
//! * Sites are from places between the pixels of the exemplar, and texels read the exemplar there ([`Sources`]). Means
//!   of the colors of sites are softer than it, and edges in them are as jagged as the sites lie. A larger version of
//!   the exemplar, such as the photograph that it was made from, can be read instead, and gives all its detail.
//! * On surfaces, where neighborhoods are read between sites, the exemplar is blurred as much before it is compared.
//!   Otherwise smooth parts of it match best.
//! * The rows and columns of a neighborhood turn as the field around its site does ([`Axes`]). Straight on, features
//!   that bend seem to come from one side: stripes around a torus are then off by 3.7 degrees instead of 1.5.
//!
//! For both:
//!
//! * P = n × O points to the right, so that nothing is mirrored. Neighborhoods are laid out by walking over the faces
//!   of the input, with both directions carried along over its edges, and not over the graph of sites.
//! * Sites farther than 1.1 spacings have no part in a color between sites, and neither have those on another sheet,
//!   whose normals are more than a right angle apart. At 2 spacings colors blur away.
//! * H(n, 0) has the rows above the center only ([`Shape::Half`]); the row of the center is half random at that time.
//! * Neighborhoods that cross an edge of the exemplar are left out as long as enough remain; it wraps if it says so.
//! * A pass changes colors in place, in the order of the sweep. Of equally good pixels the first wins.
//! * Colors are compared in their sRGB codes, and the pyramid is not rounded to codes.
//! * Where no direction is given, texture runs down an axis. Every piece of the surface has an anchor of its own.
//! * Where the field turns around a point, or order and field do not fit, the texture has a tear; no method has none.
//!
//! Sites are worked on at the same time only if they do not read each other, so that the number of threads changes
//! nothing.

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
mod endless;
mod engine;
mod error;
mod exemplar;
mod grid;
mod ground;
mod guides;
mod kept;
mod lift;
mod likeness;
mod links;
mod magnify;
mod maps;
mod matcher;
mod mesh_ground;
mod neighborhood;
mod options;
mod orientation;
mod parents;
mod places;
mod plane;
mod plane_along;
mod regularity;
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
mod turns;
mod usage;
mod visit;

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
pub use plane::{PlaneTexture, synthesize_plane_guided, synthesize_plane_with, tile_plane};
pub use plane_along::{PlaneAlong, PlaneScales, synthesize_plane_along};
pub use side_by_side::SideBySide;
pub use sites::{
    Blend, Connected, Evenness, Hierarchy, HierarchyOptions, Level, SiteGraph, SiteGrid, SiteIdx,
    SiteTriangles, Sites, evenness, hexagonal_spacing, nested_points, repeats_of_sites, repel,
    scatter, sites_for_repeats,
};
pub use surface_texture::SurfaceTexture;
pub use sweep::Sweep;
pub use synthesizer::{Synthesizer, synthesize};
pub use table::{TableRow, parse_table};
pub use turned::Turned;

// For the benches and tests of the workspace alone.
#[doc(hidden)]
pub use candidates::{Candidates, CoarserCenter};
#[doc(hidden)]
pub use matcher::{Match, Matcher, MatcherMemory, distance_sq};
#[doc(hidden)]
pub use sites::{DOWNSAMPLE_STEPS, DOWNSAMPLE_T, INTERPOLATION_RADIUS, LowPass, STAR_RADIUS};
