//! Guides on surfaces. Guides in the plane are tested with the plane.

use crate::shapes::sphere;
use crate::{
    Edges, Exemplar, HierarchyOptions, Options, SurfaceTexture, SynthError, SynthErrorKind,
    Synthesizer,
};
use core::ops::ControlFlow;
use dapple_mesh::Surface;
use dapple_raster::Raster;

/// An exemplar with stripes of two widths, and a guide that distinguishes them.
fn exemplar() -> Exemplar {
    let stripes = Raster::from_fn([64, 32], |x, y| {
        let width = if x < 32 { 2 } else { 4 };
        f32::from(y / width % 2 == 0)
    });
    let is_wide = Raster::from_fn([64, 32], |x, _| f32::from(x >= 32)).unwrap();
    let exemplar = Exemplar::from_planes(&[(&stripes.unwrap(), 1.0)], Edges::Cut).unwrap();
    exemplar.with_guides(&[(&is_wide, 1.0)]).unwrap()
}

fn synthesizer() -> Synthesizer {
    let sites = HierarchyOptions {
        n_sites: 3000,
        ..HierarchyOptions::default()
    };
    Synthesizer::new(Surface::new(sphere()).unwrap(), &[], &sites).unwrap()
}

fn made(synthesizer: &Synthesizer, guides: &[&[f32]]) -> Result<SurfaceTexture, SynthError> {
    synthesizer.synthesize_guided(&exemplar(), guides, &Options::default(), |_| {
        ControlFlow::Continue(())
    })
}

#[test]
fn guides_say_where_on_a_surface_parts_of_the_exemplar_go() {
    let synthesizer = synthesizer();
    let positions = synthesizer.hierarchy().sites().positions();
    let is_above: Vec<f32> = positions.iter().map(|at| f32::from(at.y > 0.0)).collect();
    let texture = made(&synthesizer, &[&is_above]).unwrap();
    let obeyed = texture
        .sources(0)
        .zip(&is_above)
        .filter(|&([column, _], &is_above)| f32::from(column >= 32) == is_above)
        .count();
    // About 200 sites next to the equator may differ.
    assert!(obeyed > 2800, "{obeyed} of 3000");
}

#[test]
fn bad_guides_of_a_surface_are_refused() {
    let synthesizer = synthesizer();
    let kind = |guides: &[&[f32]]| made(&synthesizer, guides).unwrap_err().kind().clone();
    let good = vec![0.5; 3000];
    let mut bad = good.clone();
    bad[7] = f32::NAN;
    for (guides, count) in [
        (&[][..], 0),
        (&[&good[..], &good], 2),
        (&[&good[1..]], 2999),
    ] {
        let expected =
            matches!(kind(guides), SynthErrorKind::Count { count: found, .. } if found == count);
        assert!(expected, "{count}: {:?}", kind(guides));
    }
    assert!(
        matches!(kind(&[&bad]), SynthErrorKind::Range { .. }),
        "not a number"
    );
}
