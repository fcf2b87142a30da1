//! Tests for textures in the plane with guides.

use super::naive::naive_guided;
use super::{exemplar, paper};
use crate::{
    CoarserCenter, Edges, Exemplar, Options, PlaneTexture, SynthErrorKind, synthesize_plane,
    synthesize_plane_guided,
};
use core::ops::ControlFlow;
use dapple_raster::Raster;

/// Returns guides whose values are exact in `f32`, on coarser levels too.
fn guides(size: [u32; 2]) -> [Raster<f32>; 2] {
    let left = Raster::from_fn(size, |x, _| f32::from(x < size[0] / 2)).unwrap();
    let rows = Raster::from_fn(size, |_, y| f32::from(y as u8 / 4 % 4) / 4.0).unwrap();
    [left, rows]
}

/// Returns an exemplar with [`guides`], each with weight 1.
fn guided_exemplar(size: [u32; 2], edges: Edges) -> Exemplar {
    let [left, rows] = guides(size);
    let guides = [(&left, 1.0), (&rows, 1.0)];
    exemplar(size, edges).with_guides(&guides).unwrap()
}

#[test]
fn guided_textures_equal_the_pseudo_code() {
    for (edges, size) in [
        ([Edges::Cut; 2], [21, 26]),
        ([Edges::Wrap, Edges::Cut], [24, 17]),
    ] {
        let exemplar = guided_exemplar([30, 28], Edges::Cut);
        let [left, rows] = guides(size);
        let targets = [&left, &rows];
        for options in [
            paper(2, CoarserCenter::Exact),
            paper(3, CoarserCenter::Floor),
        ] {
            let made = synthesize_plane_guided(&exemplar, &targets, edges, &options, |_| {
                ControlFlow::Continue(())
            });
            let sources = made.unwrap().sources().map(|[x, y]| y * 30 + x);
            assert!(
                sources.pixels() == naive_guided(&exemplar, &targets, size, edges, &options),
                "{edges:?} {size:?}"
            );
        }
    }
}

#[test]
fn guides_say_where_parts_of_the_exemplar_go() {
    let exemplar = guided_exemplar([64, 64], Edges::Wrap);
    // Guides with left and right swapped, and rows unchanged.
    let [left, rows] = guides([64, 64]);
    let right = left.map(|left| 1.0 - left);
    let made = synthesize_plane_guided(
        &exemplar,
        &[&right, &rows],
        [Edges::Wrap; 2],
        &Options::default(),
        |_| ControlFlow::Continue(()),
    );
    let sources = made.unwrap();
    let value = |plane: &Raster<f32>, [x, y]: [u32; 2]| plane.row(y)[x as usize];
    let mut obeyed = [0, 0];
    for ([x, y], &source) in (0..64)
        .flat_map(|y| (0..64).map(move |x| [x, y]))
        .zip(sources.sources().pixels())
    {
        obeyed[0] += u32::from(value(&left, source) == value(&right, [x, y]));
        obeyed[1] += u32::from(value(&rows, source) == value(&rows, [x, y]));
    }
    // Sites next to the borders of guides may differ if a piece continues across the border.
    assert!(obeyed[0] > 64 * 60, "sides: {obeyed:?}");
    assert!(obeyed[1] > 64 * 50, "rows: {obeyed:?}");
}

#[test]
fn bad_guides_are_refused() {
    let exemplar = guided_exemplar([30, 28], Edges::Cut);
    let [left, rows] = guides([20, 20]);
    let kind = |exemplar: &Exemplar, guides: &[&Raster<f32>]| {
        let options = Options::default();
        synthesize_plane_guided(exemplar, guides, [Edges::Cut; 2], &options, |_| {
            ControlFlow::Continue(())
        })
        .unwrap_err()
        .kind()
        .clone()
    };
    for guides in [&[][..], &[&left], &[&left, &rows, &rows]] {
        assert!(
            matches!(kind(&exemplar, guides), SynthErrorKind::Count { count, .. } if count == guides.len()),
            "{} guides",
            guides.len()
        );
    }
    let plain = super::exemplar([30, 28], Edges::Cut);
    assert!(
        matches!(
            kind(&plain, &[&left]),
            SynthErrorKind::Count { count: 1, .. }
        ),
        "an exemplar without guides"
    );
    let small = rows.crop([0; 2], [19, 20]).unwrap();
    assert!(
        matches!(kind(&exemplar, &[&left, &small]), SynthErrorKind::Raster(_)),
        "two sizes"
    );
    let infinite = rows.map(|_| f32::INFINITY);
    assert!(
        matches!(
            kind(&exemplar, &[&left, &infinite]),
            SynthErrorKind::NotFinite { .. }
        ),
        "infinite"
    );
    // No guides for the texture, although the exemplar has some.
    let plain = synthesize_plane(&exemplar, [20; 2], [Edges::Cut; 2], &Options::default());
    assert!(
        matches!(
            plain.unwrap_err().kind(),
            SynthErrorKind::Count { count: 0, .. }
        ),
        "no guides of the texture"
    );
    let identity = PlaneTexture::identity(&exemplar).unwrap();
    let hole = Raster::from_fn([30, 28], |x, y| x == 9 && y == 9).unwrap();
    let options = Options {
        n_levels: 2,
        ..Options::default()
    };
    let repaired = identity.repair(&exemplar, &hole, &options, |_| ControlFlow::Continue(()));
    assert!(
        matches!(
            repaired.unwrap_err().kind(),
            SynthErrorKind::Count { count: 0, .. }
        ),
        "a repair has no guides"
    );
    for weight in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let plane = Raster::filled([30, 28], 0.5).unwrap();
        let refused = super::exemplar([30, 28], Edges::Cut).with_guides(&[(&plane, weight)]);
        assert!(
            matches!(refused.unwrap_err().kind(), SynthErrorKind::Range { .. }),
            "{weight}"
        );
    }
}
