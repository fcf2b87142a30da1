//! Tests that invalid input gives an error with the limit.

use dapple_graph::delaunay;
use dapple_hash::Seed;
use dapple_points::{Domain, PointSet, white_noise};
use dapple_pups::{AxialWeight, Orientation, Pups, PupsErrorKind, PupsOptions};
use dapple_raster::{Field, Raster, Window};
use glam::{DVec2, DVec3};

fn points(count: u32) -> PointSet {
    white_noise(Domain::paper_torus(), count, Seed(1)).unwrap()
}

fn kind(options: PupsOptions) -> PupsErrorKind {
    let points = points(5);
    Pups::new(&points, &delaunay(&points).unwrap(), options)
        .unwrap_err()
        .kind()
        .clone()
}

#[test]
fn options_out_of_range_are_refused() {
    let plain = PupsOptions::default;
    for axis_scale in [0.5, 0.0, -1.0, f64::NAN, f64::INFINITY, 16.5] {
        let kind = kind(PupsOptions {
            axis_scale,
            ..plain()
        });
        assert!(
            matches!(
                kind,
                PupsErrorKind::Range {
                    what: "axis scale",
                    ..
                }
            ),
            "{axis_scale}: {kind:?}"
        );
    }
    for (dips, depth) in [(0, 0.5), (17, 0.5), (3, 1.0), (3, -0.1), (3, f32::NAN)] {
        let kind = kind(PupsOptions {
            weight: AxialWeight::Oscillating { dips, depth },
            ..plain()
        });
        assert!(
            matches!(kind, PupsErrorKind::Range { .. }),
            "{dips} dips of {depth}: {kind:?}"
        );
    }
    for strength in [-0.1, 1.0, f64::NAN] {
        let orientation = Some(Orientation::new(vec![DVec3::X]).with_strength(strength));
        let kind = kind(PupsOptions {
            orientation,
            ..plain()
        });
        assert!(
            matches!(kind, PupsErrorKind::Range { .. }),
            "strength {strength}: {kind:?}"
        );
    }
    for vector in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
        let kind = kind(PupsOptions {
            orientation: Some(Orientation::new(vec![vector; 5])),
            ..plain()
        });
        assert!(
            matches!(kind, PupsErrorKind::Range { .. }),
            "{vector}: {kind:?}"
        );
    }
    let orientation = Some(Orientation::new(vec![DVec3::X; 4]));
    let kind = kind(PupsOptions {
        orientation,
        ..plain()
    });
    assert!(
        matches!(
            kind,
            PupsErrorKind::Count {
                count: 4,
                needed: 5,
                ..
            }
        ),
        "{kind:?}"
    );
}

#[test]
fn columns_of_another_length_are_refused() {
    let five = points(5);
    let pups = Pups::delaunay(&five).unwrap();
    let error = pups.texture(vec![0.0; 4]).unwrap_err();
    assert_eq!(error.to_string(), "there are 4 values, but 5 are needed");
    let error = pups
        .texture(vec![0.0, 1.0, f32::NAN, 0.0, 0.0])
        .unwrap_err();
    assert!(
        matches!(error.kind(), PupsErrorKind::Range { .. }),
        "{error}"
    );
    let error = pups
        .label_raster(&Window::unit([4, 4]).unwrap(), &[1; 6])
        .unwrap_err();
    assert!(
        matches!(
            error.kind(),
            PupsErrorKind::Count {
                count: 6,
                needed: 5,
                ..
            }
        ),
        "{error}"
    );
    let error = Pups::new(
        &points(6),
        &delaunay(&five).unwrap(),
        PupsOptions::default(),
    )
    .unwrap_err();
    assert!(
        matches!(
            error.kind(),
            PupsErrorKind::Count {
                count: 5,
                needed: 6,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn no_points_make_no_texture() {
    let none = PointSet::new(Domain::paper_torus(), Vec::new()).unwrap();
    let error = Pups::delaunay(&none).unwrap_err();
    assert!(matches!(error.kind(), PupsErrorKind::NoPoints), "{error}");
}

#[test]
fn axes_that_are_too_short_are_refused() {
    let close = vec![DVec2::ZERO, DVec2::new(1e-12, 0.0), DVec2::new(0.5, 0.5)];
    let close = PointSet::new(Domain::paper_torus(), close).unwrap();
    let error = Pups::delaunay(&close).unwrap_err();
    assert!(
        matches!(error.kind(), PupsErrorKind::ShortAxis { .. }),
        "{error}"
    );
}

#[test]
fn domains_beyond_single_precision_are_refused() {
    for size in [1e-20, 1e20] {
        let domain = Domain::torus(DVec2::ZERO, DVec2::splat(size));
        let points = white_noise(domain, 5, Seed(1)).unwrap();
        let error = Pups::delaunay(&points).unwrap_err();
        assert!(
            matches!(error.kind(), PupsErrorKind::Range { .. }),
            "{error}"
        );
    }
}

#[test]
fn memory_of_another_size_is_refused() {
    let texture = Pups::delaunay(&points(5))
        .unwrap()
        .texture(vec![0.0; 5])
        .unwrap();
    let mut raster = Raster::filled([4, 5], 0.0).unwrap();
    let window = Window::unit([4, 4]).unwrap();
    assert!(
        texture.render(&window, raster.view_mut()).is_err(),
        "a wrong size was accepted"
    );
}
