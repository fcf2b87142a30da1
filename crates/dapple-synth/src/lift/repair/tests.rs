//! Tests of repairing a stained checker, on a square and around a torus.

use super::*;
use crate::shapes::{square, synthesizer, torus};
use crate::{Atlas, Edges, SynthErrorKind, Synthesizer, bake_values};
use dapple_raster::Raster;
use glam::{DVec2, DVec3};

fn go_on(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Side of textures, in texels.
const SIDE: u32 = 128;

/// A texture with a stain at the texels where the mask is false.
struct Stained {
    clean: Raster<f32>,
    mask: Raster<bool>,
    stained: Raster<f32>,
}

impl Stained {
    fn new(value: impl Fn(u32, u32) -> f32, is_stain: impl Fn(u32, u32) -> bool) -> Self {
        let clean = Raster::from_fn([SIDE; 2], value).unwrap();
        let mask = Raster::from_fn([SIDE; 2], |x, y| !is_stain(x, y)).unwrap();
        let stained = clean.zip_map(
            &mask,
            |&value, &is_clean| if is_clean { value } else { 0.5 },
        );
        Self {
            stained: stained.unwrap(),
            clean,
            mask,
        }
    }

    fn exemplar(&self, source: Synthesizer, uvs: &[[DVec2; 3]]) -> MeshExemplar {
        let texture = Exemplar::from_planes(&[(&self.stained, 1.0)], Edges::Cut).unwrap();
        let texture = texture.with_mask(&self.mask).unwrap();
        MeshExemplar::new(source, uvs, &texture).unwrap()
    }
}

fn options(n_levels: usize) -> Options {
    Options {
        n_levels,
        ..Options::default()
    }
}

#[test]
fn stain_on_a_checker_becomes_checker_and_all_else_stays() {
    let is_stain = |x: u32, y: u32| x.abs_diff(60) < 14 && y.abs_diff(70) < 11;
    let stained = Stained::new(|x, y| f32::from((x / 8 + y / 8) % 2 == 0), is_stain);
    let source = synthesizer(square(), 4000, |_, _| DVec3::NEG_Y);
    let mesh = source.surface().mesh();
    let faces = mesh.faces().iter();
    let uv = |at: DVec3| DVec2::new(at.x, 1.0 - at.y);
    let uvs: Vec<_> = faces
        .map(|face| face.map(|vertex| uv(mesh.positions()[vertex.index()])))
        .collect();
    let atlas = Atlas::from_uvs(source.surface(), &uvs, [SIDE; 2], 0).unwrap();
    let exemplar = stained.exemplar(source, &uvs);
    let repaired = exemplar.repair(&options(2), go_on).unwrap();
    let is_kept = exemplar.pyramid.levels()[0].usable.as_ref().unwrap();
    let mut n_new = 0;
    for (at, [site, _]) in repaired.sources(0).enumerate() {
        assert!(is_kept[site as usize], "{at} is from {site}");
        assert!(!is_kept[at] || site as usize == at, "{at} moved to {site}");
        n_new += usize::from(!is_kept[at]);
    }
    assert!(n_new > 100, "{n_new} sites are made again");
    let baked = bake_values(exemplar.source(), &repaired, &stained.stained, &atlas).unwrap();
    let (mut n, mut n_wrong) = (0, 0);
    let texels = baked.pixels().iter().zip(stained.clean.pixels());
    for ((found, clean), &is_clean) in texels.zip(stained.mask.pixels()) {
        if !is_clean {
            n += 1;
            n_wrong += usize::from((found - clean).abs() > 0.5);
        }
    }
    // Tolerance: sites are two texels apart, and edges of squares are off by a fraction of that.
    assert!(10 * n_wrong < n, "{n_wrong} of {n} texels are wrong");
}

#[test]
fn stripes_around_a_torus_go_on_through_a_stain() {
    let surface = torus(32, 16);
    let atlas = Atlas::charts(&surface, SIDE).unwrap();
    // Stripes in space, along which the field runs.
    let at = |x: u32, y: u32| {
        let point = atlas.point(&surface, [x, y]);
        point.map_or(DVec3::ZERO, |point| surface.position(point))
    };
    let stripe = |x, y| f32::from(libm::sin(24.0 * at(x, y).z) > 0.0);
    let is_stain = |x, y| at(x, y).distance(DVec3::new(1.4, 0.0, 0.0)) < 0.22;
    let stained = Stained::new(stripe, is_stain);
    let field = |at: DVec3, normal: DVec3| normal.cross(DVec3::Z.cross(at).cross(normal));
    let source = synthesizer(surface.mesh().clone(), 6000, field);
    let exemplar = stained.exemplar(source, &atlas.uvs());
    let repaired = exemplar.repair(&options(2), go_on).unwrap();
    let baked = bake_values(exemplar.source(), &repaired, &stained.stained, &atlas).unwrap();
    let (mut n, mut n_right) = (0, 0);
    for y in 0..SIDE {
        for x in (0..SIDE).filter(|&x| is_stain(x, y)) {
            n += 1;
            let value = baked.row(y)[x as usize];
            n_right += usize::from((value > 0.5) == (stripe(x, y) > 0.5));
        }
    }
    assert!(4 * n_right > 3 * n, "{n_right} of {n} texels go on");
}

#[test]
fn nothing_to_repair_is_everything_where_it_is_and_nothing_left_is_refused() {
    let none = Stained::new(|x, _| x as f32 / 128.0, |_, _| false);
    let all = Stained::new(|x, _| x as f32 / 128.0, |_, _| true);
    let surface = torus(16, 8);
    let uvs = Atlas::charts(&surface, SIDE).unwrap().uvs();
    let source = synthesizer(surface.mesh().clone(), 500, |_, _| DVec3::Z);
    let whole = none.exemplar(source.clone(), &uvs);
    let repaired = whole.repair(&options(2), go_on).unwrap();
    let sources = repaired.sources(0).map(|[site, _]| site);
    assert!(sources.eq(0..500));
    let refused = all.exemplar(source, &uvs).repair(&options(2), go_on);
    let refused = refused.unwrap_err();
    assert!(
        matches!(refused.kind(), SynthErrorKind::Masked { .. }),
        "{refused}"
    );
}

#[cfg(feature = "rayon")]
#[test]
fn repair_has_the_same_bits_on_any_number_of_threads() {
    let wave = |x: u32, y: u32| libm::sinf((x + 2 * y) as f32 * 0.3);
    let stained = Stained::new(wave, |x, y| x.abs_diff(60) < 12 && y.abs_diff(60) < 12);
    let [one, two, seven] = crate::shapes::on_threads(|| {
        let surface = torus(16, 8);
        let uvs = Atlas::charts(&surface, SIDE).unwrap().uvs();
        let source = synthesizer(surface.mesh().clone(), 2000, |_, _| DVec3::Z);
        let repaired = stained.exemplar(source, &uvs).repair(&options(2), go_on);
        repaired.unwrap().sources(0).collect::<Vec<_>>()
    });
    assert!(one == two, "2 threads");
    assert!(one == seven, "7 threads");
}
