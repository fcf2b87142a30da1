//! Edits of control points beside the texture of the same points made anew.

use dapple_graph::GraphErrorKind;
use dapple_hash::{Seed, hash1, unit_f64};
use dapple_points::{Domain, PointIdx, poisson_disk, white_noise};
use dapple_pups::{
    Cells, ControlPoint, ControlPoints, EditablePups, NetOptions, Orbits, Orientations,
    PupsErrorKind, PupsField, control_points,
};
use dapple_raster::{Field, Raster, Window};
use glam::{DVec2, DVec3};

/// Options of points in a domain, with random values.
fn options(domain: Domain, positions: &[DVec2], net: NetOptions, cells: Cells) -> ControlPoints {
    let point = |(index, at): (i64, &DVec2)| ControlPoint {
        x: at.x,
        y: at.y,
        value: Some(random(index, 0) as f32),
        ..ControlPoint::default()
    };
    ControlPoints {
        domain,
        points: (0..).zip(positions).map(point).collect(),
        net,
        cells,
        ..ControlPoints::default()
    }
}

fn random(index: i64, lane: u32) -> f64 {
    unit_f64(hash1(Seed(31), [index], lane))
}

/// Bits of the texture of the options, made anew.
fn anew(options: &ControlPoints, picture: &Window) -> Raster<u32> {
    match control_points(options, Seed(1)).unwrap() {
        PupsField::Numbers(field) => field
            .to_raster(picture)
            .unwrap()
            .map(|value| value.to_bits()),
        PupsField::Colors(_) => panic!("these are numbers"),
    }
}

/// Some edit, and what it changed.
fn edit(pups: &mut EditablePups, number: i64) -> Vec<dapple_pups::Changed> {
    let domain = Domain {
        ..pups.options().domain
    };
    let n_points = pups.points().len();
    let point = PointIdx((random(number, 1) * n_points as f64) as u32);
    let anywhere = domain.origin + domain.size * DVec2::new(random(number, 2), random(number, 3));
    let vector = DVec3::new(random(number, 4) - 0.5, random(number, 5) - 0.5, 0.3);
    let orientation = pups.points()[0].orientation.map(|_| vector);
    let value = random(number, 6) as f32;
    match number % 5 {
        0 => pups
            .insert(ControlPoint {
                x: anywhere.x,
                y: anywhere.y,
                value: Some(value),
                label: None,
                orientation,
            })
            .unwrap(),
        1 if n_points > 1 => pups.remove(point).unwrap(),
        2 => pups.set(point, value, orientation).unwrap(),
        3 => pups.move_to(point, anywhere).unwrap(),
        _ => {
            let at = pups.points()[point.index()];
            let inner = (anywhere - domain.origin) * 0.05;
            let moved = DVec2::new(at.x, at.y) * 0.9 + domain.end() * 0.05 + domain.origin * 0.05;
            pups.move_to(point, moved + inner * 0.1).unwrap()
        }
    }
}

/// Edits points, and compares all pixels after each edit: those of the windows that changed are rendered by them, all others
/// stay.
fn check(options: ControlPoints, n_edits: i64, name: &str) -> usize {
    let domain = options.domain;
    let mut pups = EditablePups::new(options, Seed(1)).unwrap();
    // Across the borders of the domain, and past them.
    let picture = Window::new(
        domain.origin - domain.size * 0.2,
        domain.size * 1.5,
        [61, 47],
    )
    .unwrap();
    let mut pixels = anew(pups.options(), &picture);
    let mut n_rendered = 0;
    for number in 0..n_edits {
        let changed = edit(&mut pups, number);
        for changed in &changed {
            for axis in (0..2).filter(|&axis| domain.wrap[axis]) {
                let (min, max) = (changed.min[axis], changed.max[axis]);
                assert!(
                    min >= domain.origin[axis] && min < domain.end()[axis],
                    "{name}: begins at {min}"
                );
                assert!(
                    max <= min + domain.size[axis] * (1.0 + 1e-12),
                    "{name}: ends at {max}"
                );
            }
        }
        for window in pups.windows(&changed, &picture) {
            let mut part = Raster::filled(window.size, 0.0).unwrap();
            pups.render(&window, part.view_mut()).unwrap();
            n_rendered += window.n_pixels();
            let [column, row] =
                [0, 1].map(|axis| (window.first[axis] - picture.first[axis]) as usize);
            for y in 0..window.size[1] {
                for x in 0..window.size[0] as usize {
                    pixels.pixels_mut()[(y as usize + row) * 61 + x + column] =
                        part.row(y)[x].to_bits();
                }
            }
        }
        assert!(
            pixels == anew(pups.options(), &picture),
            "{name}: edit {number}"
        );
    }
    n_rendered
}

#[test]
fn edited_textures_are_textures_made_anew_and_change_nowhere_else() {
    let torus = Domain::torus(DVec2::new(-1.0, 3.0), DVec2::new(2.0, 1.5));
    let nets = [
        ("plain", NetOptions::default(), Cells::Mixed),
        ("hard", NetOptions::default(), Cells::Hard),
        (
            "oriented and long",
            NetOptions {
                orientations: Orientations::Random,
                axis_scale: 1.6,
                ..NetOptions::default()
            },
            Cells::Mixed,
        ),
        (
            "fading",
            NetOptions {
                fade: 0.25,
                ..NetOptions::default()
            },
            Cells::Mixed,
        ),
    ];
    for wrap in [[true, true], [true, false], [false, false]] {
        let domain = Domain { wrap, ..torus };
        let few = white_noise(domain, 4, Seed(3)).unwrap();
        let uneven = white_noise(domain, 300, Seed(4)).unwrap();
        let even = poisson_disk(domain, 0.07, Seed(5)).unwrap();
        for (name, net, cells) in &nets {
            for points in [&few, &uneven, &even] {
                let options = options(domain, points.positions(), net.clone(), *cells);
                let name = format!("{name}, {} points, wrap {wrap:?}", points.len());
                let n_rendered = check(options, 25, &name);
                if wrap == [true, true] && points.len() > 300 {
                    assert!(n_rendered < 25 * 61 * 47 / 4, "{name}: {n_rendered} pixels");
                }
            }
        }
    }
}

#[test]
fn edits_that_are_refused_change_nothing() {
    let domain = Domain {
        wrap: [true, false],
        ..Domain::paper_torus()
    };
    let points = white_noise(domain, 300, Seed(6)).unwrap();
    let net = NetOptions {
        orientations: Orientations::Random,
        ..NetOptions::default()
    };
    let options = options(domain, points.positions(), net, Cells::Mixed);
    let mut pups = EditablePups::new(options.clone(), Seed(1)).unwrap();
    let before = anew(
        pups.options(),
        &Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [32; 2]).unwrap(),
    );
    let (there, up) = (points.position(PointIdx(17)), Some(DVec3::Z));
    let point = |at: DVec2, value, orientation| ControlPoint {
        x: at.x,
        y: at.y,
        value: Some(value),
        label: None,
        orientation,
    };
    let near = there + DVec2::splat(1e-12);
    let free = DVec2::new(0.1234, 0.4321);
    let errors = [
        pups.insert(point(there, 0.0, up)).unwrap_err(),
        pups.move_to(PointIdx(3), DVec2::new(0.0, 1.5)).unwrap_err(),
        pups.remove(PointIdx(300)).unwrap_err(),
        pups.set(PointIdx(300), 0.0, up).unwrap_err(),
        pups.insert(point(near, 0.0, up)).unwrap_err(),
        pups.move_to(PointIdx(3), near).unwrap_err(),
        pups.insert(point(free, f32::NAN, up)).unwrap_err(),
        pups.set(PointIdx(3), 0.5, Some(DVec3::ZERO)).unwrap_err(),
        pups.set(PointIdx(3), 0.5, None).unwrap_err(),
    ];
    for (index, error) in errors.iter().enumerate() {
        let expected = match error.kind() {
            PupsErrorKind::Graph(error) => match error.kind() {
                GraphErrorKind::Coincident { .. } => index == 0,
                GraphErrorKind::Outside { .. } => index == 1,
                GraphErrorKind::NotThere { .. } => index == 2 || index == 3,
                _ => false,
            },
            PupsErrorKind::ShortAxis { point, .. } => [(4, 300), (5, 3)].contains(&(index, *point)),
            PupsErrorKind::Range { .. } => index == 6 || index == 7,
            PupsErrorKind::Conflict { .. } => index == 8,
            _ => false,
        };
        assert!(expected, "error {index}: {error}");
    }
    assert_eq!(pups.points().len(), 300);
    let picture = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [32; 2]).unwrap();
    let mut now = Raster::filled([32; 2], 0.0).unwrap();
    pups.render(&picture, now.view_mut()).unwrap();
    assert!(now.map(|value| value.to_bits()) == before);
}

#[test]
fn the_last_point_stays_and_points_that_move_are_refused() {
    let domain = Domain::paper_torus();
    let options = options(domain, &[DVec2::ZERO], NetOptions::default(), Cells::Mixed);
    let mut one = EditablePups::new(options.clone(), Seed(1)).unwrap();
    assert!(matches!(
        one.remove(PointIdx(0)).unwrap_err().kind(),
        PupsErrorKind::NoPoints
    ));
    let motion = Some(Orbits { radius: 0.1 });
    let net = NetOptions {
        motion,
        ..NetOptions::default()
    };
    let error = EditablePups::new(ControlPoints { net, ..options }, Seed(1)).unwrap_err();
    assert!(
        matches!(error.kind(), PupsErrorKind::Conflict { .. }),
        "{error}"
    );
}
