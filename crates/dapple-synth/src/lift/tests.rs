//! Tests of lifting against the paper's pseudo-code on two surfaces, and against synthesis from an image.

use super::*;
use crate::domain::{LevelState, Rows, Samples, Square, SynthesisDomain};
use crate::shapes::{geodesic_sphere, square, synthesizer, torus};
use crate::{
    Atlas, Coherence, HierarchyOptions, Reads, Schedule, bake_colors, bake_normals, bake_values,
    distance_sq,
};
use core::sync::atomic::AtomicU32;
use dapple_color::{LinearRgb, Normal, NormalY};
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_mesh::{CREASE, Surface};
use dapple_raster::Raster;
use glam::DVec3;

/// Returns a surface with sites on two levels.
fn sites(surface: Surface, n_sites: usize) -> Synthesizer {
    let options = HierarchyOptions {
        n_sites,
        n_levels: 2,
        seed: Seed(3),
        ..HierarchyOptions::default()
    };
    Synthesizer::new(surface, &[], &options).unwrap()
}

/// Returns blurred noise, identical in every run.
fn noise(side: u32, blur: f32) -> Raster<f32> {
    let at = |x: u32, y: u32| unit_f32((hash2(Seed(5), [x.into(), y.into()], 0) >> 32) as u32);
    let image = Raster::from_fn([side; 2], at).unwrap();
    let exemplar = Exemplar::from_planes(&[(&image, 1.0)], Edges::Wrap).unwrap();
    let blurred = exemplar.pyramid(1).unwrap().blurred(blur);
    Raster::from_vec([side; 2], blurred.levels()[0].pixels().to_vec()).unwrap()
}

/// Returns the texture coordinates that map the unit square to a whole map, with y up and v down.
fn flat_uvs(surface: &Surface) -> Vec<[DVec2; 3]> {
    let mesh = surface.mesh();
    let uv = |at: DVec3| DVec2::new(at.x, 1.0 - at.y);
    let faces = mesh.faces().iter();
    faces
        .map(|face| face.map(|vertex| uv(mesh.positions()[vertex.index()])))
        .collect()
}

/// Returns an exemplar that is a torus with noise.
fn noisy_torus(n_sites: usize) -> MeshExemplar {
    let source = sites(torus(24, 12), n_sites);
    let uvs = Atlas::uniform(source.surface(), 256).unwrap().uvs();
    let image = noise(256, 0.3);
    let texture = Exemplar::from_planes(&[(&image, 1.0)], Edges::Cut).unwrap();
    MeshExemplar::new(source, &uvs, &texture).unwrap()
}

fn go_on(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn options(n_levels: usize) -> Options {
    Options {
        n_levels,
        ..Options::default()
    }
}

/// Returns the neighborhood of `site`, part by part, on a surface whose sites have the sources `levels`.
fn neighborhood(
    domain: &MeshDomain<'_>,
    pass: &Pass,
    site: u32,
    pyramid: &Pyramid,
    levels: &[Sources],
) -> Vec<f32> {
    let mut values = Vec::new();
    for part in &pass.parts {
        let half = part.side as i32 / 2;
        let square = Square {
            site,
            level: pass.level,
            reads: pass.level + part.reads.step(),
            half,
            rows: Rows::All,
        };
        let halves = match part.reads {
            Reads::Same => [Some(half), None],
            Reads::Coarser => [None, Some(half)],
        };
        let prepared = domain.prepare(pass.level, halves[0], halves[1]);
        let colors = LevelState {
            pixels: pyramid.levels()[square.reads].plain(),
            sources: &levels[square.reads],
        };
        let mut samples = Samples::default();
        samples.make_room(square.side(), 1);
        let mut memory = Default::default();
        domain.read(square, &prepared, colors, &mut samples, &mut memory);
        for [i, j] in part.offsets() {
            let sample = (j + half) * (2 * half + 1) + i + half;
            values.push(samples.values[sample as usize] * part.weight.sqrt());
        }
    }
    values
}

/// Returns sources that make every site its own source.
fn own_pixels(exemplar: &MeshExemplar) -> Vec<Sources> {
    let levels = exemplar.pyramid.levels().iter();
    let numbers = levels.map(|level| Sources {
        pixels: (0..level.size[0]).map(AtomicU32::new).collect(),
        quarters: Vec::new(),
    });
    numbers.collect()
}

#[test]
fn lifting_is_the_pseudo_code_with_neighborhoods_of_the_source() {
    let exemplar = noisy_torus(700);
    let target = sites(geodesic_sphere(3), 400);
    let options = Options {
        coherence: Coherence::Factor(0.0),
        evenness: 0.0,
        // With followed axes, the center of a larger square, which a pass reuses from the one before, may rotate less.
        axes: crate::Axes::Carried,
        ..options(2)
    };
    let source_domain = exemplar.source().domain(options.axes, false);
    let domain = target.domain(options.axes, false);
    let own = own_pixels(&exemplar);
    let found = target.lift(&exemplar, &[], &options, go_on).unwrap();
    // The initial sources of the coarsest level are not public: take the result of its last visit instead.
    let mut levels = [Sources::default(), Sources::default()];
    levels[1].pixels = found
        .sources(1)
        .map(|[site, _]| AtomicU32::new(site))
        .collect();
    for pass in &Schedule::paper(2).passes[1..] {
        let n_sites = domain.n_sites(0);
        levels[0].pixels.resize_with(n_sites, AtomicU32::default);
        let n_rows = exemplar.source().hierarchy().levels()[0].n_sites() as u32;
        let rows: Vec<Vec<f32>> = (0..n_rows)
            .map(|site| neighborhood(&source_domain, pass, site, &exemplar.pyramid, &own))
            .collect();
        for site in domain.order(0) {
            let query = neighborhood(&domain, pass, site, &exemplar.pyramid, &levels);
            let (mut smallest, mut best) = (f32::INFINITY, 0);
            for (row, values) in (0..).zip(&rows) {
                let distance = distance_sq(&query, values);
                if distance < smallest {
                    (smallest, best) = (distance, row);
                }
            }
            levels[0].pixels[site as usize] = AtomicU32::new(best);
        }
    }
    let (expected, _) = Sources::pixels_and_quarters(levels.into());

    let found: Vec<u32> = found.sources(0).map(|[site, _]| site).collect();
    assert!(found == expected[0], "other sites than the pseudo-code's");
}

/// Returns the quantiles of values and of gradient lengths.
fn looks(map: &Raster<f32>) -> [[f32; 5]; 2] {
    let quantiles = |mut values: Vec<f32>| {
        values.sort_unstable_by(f32::total_cmp);
        [0.05, 0.25, 0.5, 0.75, 0.95].map(|part| values[(part * values.len() as f32) as usize])
    };
    let [width, height] = map.size();
    let lengths = (0..height - 1).flat_map(|y| {
        (0..width as usize - 1).map(move |x| {
            let across = map.row(y)[x + 1] - map.row(y)[x];
            let down = map.row(y + 1)[x] - map.row(y)[x];
            (across * across + down * down).sqrt()
        })
    });
    [
        quantiles(map.pixels().to_vec()),
        quantiles(lengths.collect()),
    ]
}

#[test]
fn square_with_a_picture_gives_about_what_the_picture_gives() {
    let n_sites = 4000;
    let target = synthesizer(square(), n_sites, |_, _| DVec3::NEG_Y);
    let source = synthesizer(square(), n_sites, |_, _| DVec3::NEG_Y);
    let uvs = flat_uvs(target.surface());
    // Choose pixels with the size of the spacing of sites.
    let side = (1.0 / target.hierarchy().levels()[0].spacing()).round() as u32;
    let picture = noise(side, 0.3);
    let texture = Exemplar::from_planes(&[(&picture, 1.0)], Edges::Cut).unwrap();
    let atlas = Atlas::from_uvs(target.surface(), &uvs, [side; 2], 0).unwrap();
    let exemplar = MeshExemplar::new(source, &uvs, &texture).unwrap();
    let lifted = target.lift(&exemplar, &[], &options(2), go_on).unwrap();
    let plain = target.synthesize(&texture, &options(2)).unwrap();
    let [lifted, plain] =
        [&lifted, &plain].map(|texture| bake_values(&target, texture, &picture, &atlas).unwrap());
    let [expected, lifted, plain] = [&picture, &lifted, &plain].map(looks);
    for part in 0..2 {
        let range = expected[part][4] - expected[part][0];
        for at in 0..5 {
            let [of_lifted, of_plain] =
                [lifted, plain].map(|found| (found[part][at] - expected[part][at]).abs() / range);
            assert!(
                of_lifted < 0.1,
                "{part} {at}: off by {of_lifted} beside {of_plain}: {expected:?} {lifted:?} {plain:?}"
            );
        }
    }
}

/// Returns the identity texture of a surface, in which every site is its own source.
fn identity(exemplar: &MeshExemplar, between: crate::Sources) -> SurfaceTexture {
    let source = exemplar.source();
    let n_sites = source.hierarchy().sites().len() as u32;
    let own: Vec<u32> = (0..n_sites).collect();
    let levels = exemplar.levels(1).unwrap().to_vec();
    let pyramid = Pyramid { levels };
    let mut texture = SurfaceTexture::new(&pyramid, vec![own.clone()], None);
    let options = Options {
        sources: between,
        ..Options::default()
    };
    let frames = Frames::new(source, &[]);
    let places = LiftedPlaces::new(
        source.hierarchy(),
        &frames,
        &exemplar.origin,
        &own,
        &options,
    );
    texture.lifted = Some(places);
    texture
}

#[test]
fn texture_of_the_source_itself_is_as_sharp_as_it_is() {
    for (source, least) in [
        (synthesizer(square(), 800, |_, _| DVec3::NEG_Y), 1e-3),
        // Frames rotate from site to site, and steps are longer than their chords: at four texels per spacing, texels
        // are off by one.
        (sites(torus(24, 12), 3000), 0.045),
    ] {
        let is_flat = least < 0.01;
        let surface = source.surface().clone();
        let uvs = if is_flat {
            flat_uvs(&surface)
        } else {
            Atlas::charts(&surface, 256).unwrap().uvs()
        };
        let atlas = Atlas::from_uvs(&surface, &uvs, [256; 2], 2).unwrap();
        let map = noise(256, 0.3);
        let texture = Exemplar::from_planes(&[(&map, 1.0)], Edges::Cut).unwrap();
        let exemplar = MeshExemplar::new(source, &uvs, &texture).unwrap();
        let texture = identity(&exemplar, crate::Sources::SubPixel);
        let baked = bake_values(exemplar.source(), &texture, &map, &atlas).unwrap();
        let texels = (0..256 * 256).map(|at: u32| [at % 256, at / 256]);
        let shown: Vec<f32> = texels
            .filter(|&texel| {
                let face = atlas.face(texel);
                face.is_some_and(|face| {
                    let point = atlas.point(&surface, texel).unwrap();
                    point.face == face
                })
            })
            .map(|[x, y]| (baked.row(y)[x as usize] - map.row(y)[x as usize]).abs())
            .collect();
        let off = shown.iter().sum::<f32>() / shown.len() as f32;
        assert!(off < least, "flat {is_flat}: off by {off}");
    }
}

#[test]
fn colors_of_sites_follow_the_texture() {
    let exemplar = noisy_torus(3000);
    let map = noise(256, 0.3);
    let texture = identity(&exemplar, crate::Sources::Pixel);
    // Tolerance: a site is the mean over about a pixel and a half of the texture, whose blur is wider.
    let read = texture.transfer(&map).unwrap();
    let off = read.iter().zip(texture.values(0));
    let off = off.map(|(a, b)| (a - b).abs()).sum::<f32>() / read.len() as f32;
    assert!(off < 0.06, "off by {off}");
}

#[test]
fn sites_beside_masked_texels_are_not_used() {
    let source = synthesizer(square(), 1500, |_, _| DVec3::NEG_Y);
    let uvs = flat_uvs(source.surface());
    let map = noise(64, 0.2);
    let clean = Raster::from_fn([64; 2], |x, _| x < 40).unwrap();
    let texture = Exemplar::from_planes(&[(&map, 1.0)], Edges::Cut).unwrap();
    let texture = texture.with_mask(&clean).unwrap();
    let exemplar = MeshExemplar::new(source, &uvs, &texture).unwrap();
    let target = sites(geodesic_sphere(3), 600);
    let lifted = target.lift(&exemplar, &[], &options(2), go_on).unwrap();
    let positions = exemplar.source().hierarchy().sites().positions();
    for [site, row] in lifted.sources(0) {
        assert_eq!(row, 0);
        assert!(positions[site as usize].x < 40.0 / 64.0, "{site}");
    }
    let nothing = Raster::filled([64; 2], false).unwrap();
    let texture = Exemplar::from_planes(&[(&map, 1.0)], Edges::Cut).unwrap();
    let texture = texture.with_mask(&nothing).unwrap();
    let source = exemplar.source().clone();
    let exemplar = MeshExemplar::new(source, &uvs, &texture).unwrap();
    let refused = target.lift(&exemplar, &[], &options(2), go_on).unwrap_err();
    assert!(
        matches!(refused.kind(), SynthErrorKind::Masked { level: 1 }),
        "{refused}"
    );
}

#[test]
fn guides_of_the_source_say_what_goes_where() {
    let source = synthesizer(square(), 1500, |_, _| DVec3::NEG_Y);
    let uvs = flat_uvs(source.surface());
    let map = noise(64, 0.2);
    let side = Raster::from_fn([64; 2], |x, _| f32::from(x >= 32)).unwrap();
    let texture = Exemplar::from_planes(&[(&map, 1.0)], Edges::Cut).unwrap();
    let texture = texture.with_guides(&[(&side, 4.0)]).unwrap();
    let exemplar = MeshExemplar::new(source, &uvs, &texture).unwrap();
    let target = sites(geodesic_sphere(3), 600);
    let positions = target.hierarchy().sites().positions();
    let guide: Vec<f32> = positions.iter().map(|at| f32::from(at.x > 0.0)).collect();
    let lifted = target
        .lift(&exemplar, &[&guide], &options(2), go_on)
        .unwrap();
    let sides = lifted.transfer(&side).unwrap();
    let n_obeyed = sides.iter().zip(&guide).filter(|(a, b)| a == b).count();
    assert!(n_obeyed > 570, "{n_obeyed} of 600");
    let refused = target.lift(&exemplar, &[], &options(2), go_on).unwrap_err();
    assert!(matches!(refused.kind(), SynthErrorKind::Count { .. }));
}

#[test]
fn normals_keep_their_lean_in_the_frames_of_both_surfaces() {
    // The source's texture coordinates are rotated: +u points up on the square. The relief leans that way, against the
    // texture's down.
    let source = synthesizer(square(), 400, |_, _| DVec3::NEG_Y);
    let turned: Vec<[DVec2; 3]> = flat_uvs(source.surface())
        .iter()
        .map(|face| face.map(|uv| DVec2::new(1.0 - uv.y, uv.x)))
        .collect();
    let map = noise(64, 0.2);
    let texture = Exemplar::from_planes(&[(&map, 1.0)], Edges::Cut).unwrap();
    let exemplar = MeshExemplar::new(source, &turned, &texture).unwrap();
    let normal = Normal {
        x: 0.6,
        y: 0.0,
        z: 0.8,
    };
    let relief = Raster::filled([32; 2], normal).unwrap();
    // On the target the texture's down points right, so the source's up points left: -u.
    let target = synthesizer(square(), 400, |_, _| DVec3::X);
    let uvs = flat_uvs(target.surface());
    let atlas = Atlas::from_uvs(target.surface(), &uvs, [48; 2], 0).unwrap();
    let shading = target.surface().mesh().corner_normals(CREASE);
    for sources in [crate::Sources::SubPixel, crate::Sources::Pixel] {
        let options = Options {
            sources,
            ..options(2)
        };
        let lifted = target.lift(&exemplar, &[], &options, go_on).unwrap();
        let y = NormalY::OpenGl;
        let baked = bake_normals(&target, &lifted, &relief, y, &atlas, &shading).unwrap();
        for found in baked.pixels() {
            let off = [found.x + 0.6, found.y, found.z - 0.8];
            assert!(off.iter().all(|off| off.abs() < 1e-4), "{found:?}");
        }
    }
}

#[test]
fn bad_coordinates_and_too_many_levels_are_refused() {
    let source = synthesizer(square(), 300, |_, _| DVec3::NEG_Y);
    let mut uvs = flat_uvs(source.surface());
    let texture = Exemplar::from_planes(&[(&noise(16, 0.0), 1.0)], Edges::Wrap).unwrap();
    let refusal = |uvs: &[[DVec2; 3]]| {
        let refused = MeshExemplar::new(source.clone(), uvs, &texture);
        refused.unwrap_err().to_string()
    };
    assert_eq!(
        refusal(&uvs[1..]),
        "there are 31 faces with uv, but as many as the mesh has are needed"
    );
    uvs[3][1].y = f64::NAN;
    assert_eq!(
        refusal(&uvs),
        "the texture coordinate is NaN, but it must be from -1e6 to 1e6"
    );
    let exemplar = MeshExemplar::new(source.clone(), &flat_uvs(source.surface()), &texture);
    let exemplar = exemplar.unwrap();
    let surface = Surface::new(square()).unwrap();
    let sites = HierarchyOptions {
        n_sites: 300,
        ..HierarchyOptions::default()
    };
    let target = Synthesizer::new(surface, &[], &sites).unwrap();
    let refused = target.lift(&exemplar, &[], &options(3), go_on).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "there are 3 levels, but at most those of the example's sites are needed"
    );
}

#[test]
fn sources_of_a_few_sites_and_of_odd_coordinates_are_no_panic() {
    let target = sites(geodesic_sphere(2), 200);
    let atlas = Atlas::uniform(target.surface(), 128).unwrap();
    let map = Raster::filled([4; 2], LinearRgb::gray(0.25)).unwrap();
    let texture = Exemplar::new(&map, Edges::Cut).unwrap();
    let uvs = flat_uvs(&Surface::new(square()).unwrap());
    // Collapsed, huge and negative texture coordinates, and a map with far more texels than sites.
    for change in [
        |_: DVec2| DVec2::ZERO,
        |uv: DVec2| uv * 1e6,
        |uv: DVec2| uv - 7.5,
        |uv: DVec2| DVec2::new(uv.x, 0.5),
    ] {
        for n_sites in [1, 2, 30] {
            let uvs: Vec<_> = uvs.iter().map(|face| face.map(change)).collect();
            let source = synthesizer(square(), n_sites, |_, _| DVec3::X);
            let exemplar = MeshExemplar::new(source, &uvs, &texture).unwrap();
            let lifted = target.lift(&exemplar, &[], &options(2), go_on).unwrap();
            let baked = bake_colors(&target, &lifted, &map, &atlas).unwrap();
            for color in baked.pixels() {
                assert!((color.r - 0.25).abs() < 1e-4, "{n_sites}: {color:?}");
            }
        }
    }
}

#[cfg(feature = "rayon")]
#[test]
fn lifted_texture_has_the_same_bits_on_any_number_of_threads() {
    let map = noise(256, 0.3);
    let [one, two, seven] = crate::shapes::on_threads(|| {
        let exemplar = noisy_torus(1500);
        let target = sites(geodesic_sphere(3), 1200);
        let atlas = Atlas::uniform(target.surface(), 256).unwrap();
        let lifted = target.lift(&exemplar, &[], &options(2), go_on).unwrap();
        let sources: Vec<_> = lifted.sources(0).collect();
        (
            sources,
            bake_values(&target, &lifted, &map, &atlas).unwrap(),
        )
    });
    assert!(one == two, "2 threads");
    assert!(one == seven, "7 threads");
}

#[test]
fn value_stability_lift() {
    let exemplar = noisy_torus(1500);
    let target = sites(geodesic_sphere(3), 1200);
    let atlas = Atlas::uniform(target.surface(), 256).unwrap();
    let lifted = target.lift(&exemplar, &[], &options(2), go_on).unwrap();
    let baked = bake_values(&target, &lifted, &noise(256, 0.3), &atlas).unwrap();
    let texels = [[30, 50], [140, 41], [188, 230]].map(|[x, y]: [u32; 2]| baked.row(y)[x as usize]);
    assert_eq!(
        texels.map(f32::to_bits),
        [1_052_806_043, 1_060_585_153, 1_055_088_185]
    );
}
