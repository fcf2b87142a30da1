//! Tests of recipes whose points move.

use super::common::{paper_window, reference};
use dapple_hash::Seed;
use dapple_points::Domain;
use dapple_pups::*;
use dapple_raster::{Field, Raster};
use glam::DVec2;

fn moving(time: f64) -> NetOptions {
    NetOptions {
        motion: Some(Orbits { radius: 0.25 }),
        time,
        ..NetOptions::default()
    }
}

/// Renders every recipe at a time, as a scalar image with a name.
fn pictures(time: f64) -> Vec<(&'static str, Raster<f32>)> {
    let mut pictures = Vec::new();
    macro_rules! draw {
        ($(#[$_:meta])* $name:literal Points($options:ty)) => {
            let points = random_values(20, Seed(1)).into_iter().zip(random_values(20, Seed(2)));
            let point = |(x, y): (f32, f32)| ControlPoint { x: x.into(), y: y.into(), value: Some(x), ..ControlPoint::default() };
            let mut options = ControlPoints { points: points.map(point).collect(), ..ControlPoints::default() };
            pictures.push(($name, gray(&mut options, &(), time)));
        };
        ($(#[$_:meta])* $name:literal $variant:ident(Referenced<$options:ty>)) => {
            pictures.push(($name, gray(&mut <$options>::default(), &reference(), time)));
        };
        ($(#[$_:meta])* $name:literal $variant:ident($options:ty)) => {
            pictures.push(($name, gray(&mut <$options>::default(), &(), time)));
        };
        ($($(#[$about:meta])* $name:literal $variant:ident($($options:tt)*),)*) => {
            $(draw!($name $variant($($options)*));)*
        };
    }
    dapple_pups::recipes!(draw);
    pictures
}

fn gray<T: PupsRecipe<Image>, Image>(options: &mut T, image: &Image, time: f64) -> Raster<f32> {
    let orientations = options.net_mut().orientations.clone();
    *options.net_mut() = NetOptions {
        orientations,
        ..moving(time)
    };
    let window = paper_window(48);
    match options.build(image, Seed(3)).unwrap() {
        PupsField::Numbers(field) => field.to_raster(&window).unwrap(),
        PupsField::Colors(colors) => {
            let [first, ..] = [0, 1, 2].map(|channel| {
                colors
                    .to_raster(&window)
                    .unwrap()
                    .map(|color| color[channel])
            });
            first
        }
    }
}

#[test]
fn loops_of_all_recipes_join_and_move() {
    let (start, half, end) = (pictures(0.0), pictures(0.5), pictures(1.0));
    assert_eq!(start.len(), 14, "all recipes");
    for ((start, half), end) in start.iter().zip(&half).zip(&end) {
        assert_eq!(start, end, "the end is the beginning");
        assert!(start.1 != half.1, "{} does not move", start.0);
    }
}

#[test]
fn points_keep_what_they_hold_and_stay_near_their_places() {
    let options = |time| IteratedOptions {
        net: moving(time),
        ..IteratedOptions::default()
    };
    let at = |time| iterated_reference(&reference(), &options(time), Seed(4)).unwrap();
    let (start, later) = (at(0.0), at(0.3));
    for (start, later) in start.iter().zip(&later) {
        assert_eq!(
            start.values(),
            later.values(),
            "labels that change with time flicker"
        );
        let positions = |texture: &Texture| texture.pups().points().positions().to_vec();
        for (before, after) in positions(start).into_iter().zip(positions(later)) {
            let way = start.pups().domain().delta(before, after).length();
            // Twice the radius, of edges that are at most some three times the smallest distance.
            assert!(way > 0.0 && way < 2.0 * 0.25 * 0.3, "{way}");
        }
    }
}

#[test]
fn points_do_not_leave_a_domain_without_wrapping() {
    let domain = Domain::rectangle(DVec2::NEG_ONE, DVec2::splat(2.0));
    for step in 0..16 {
        let net = NetOptions {
            motion: Some(Orbits { radius: 1.0 }),
            ..moving(f64::from(step) / 16.0)
        };
        let options = NoiseOptions {
            domain,
            net,
            ..NoiseOptions::default()
        };
        noise(&options, Seed(5)).unwrap();
    }
}

#[test]
fn spots_that_move_stay_apart() {
    let centers = |options: &SpaceGiraffeOptions| {
        options
            .spacing
            .points(options.domain, Seed(6).child("points", 0))
            .unwrap()
            .len()
    };
    for step in 0..4 {
        let options = SpaceGiraffeOptions {
            net: moving(f64::from(step) / 4.0),
            ..SpaceGiraffeOptions::default()
        };
        let texture = space_giraffe(&options, Seed(6)).unwrap();
        let labels = texture.label_raster(&paper_window(512)).unwrap();
        assert_eq!(n_pieces(&labels), centers(&options), "at step {step}");
    }
}

/// Returns the number of connected components of label 1 on the torus.
fn n_pieces(labels: &Raster<u32>) -> usize {
    let [width, height] = labels.size();
    let mut seen = vec![false; (width * height) as usize];
    let mut n_pieces = 0;
    for start in 0..width * height {
        let mut stack = vec![start];
        let mut size = 0;
        while let Some(at) = stack.pop() {
            let (x, y) = (at % width, at / width);
            if seen[at as usize] || labels.row(y)[x as usize] == 0 {
                continue;
            }
            seen[at as usize] = true;
            size += 1;
            stack.extend([
                (x + 1) % width + y * width,
                (x + width - 1) % width + y * width,
                x + (y + 1) % height * width,
                x + (y + height - 1) % height * width,
            ]);
        }
        n_pieces += usize::from(size > 0);
    }
    n_pieces
}

#[test]
fn a_pixel_of_a_loop_changes_in_proportion_to_the_time() {
    let at = |time: f64| {
        let options = NoiseOptions {
            spacing: 0.2.into(),
            net: moving(time),
            ..NoiseOptions::default()
        };
        noise(&options, Seed(7))
            .unwrap()
            .to_raster(&paper_window(96))
            .unwrap()
    };
    let largest_change = |n_steps: u32| {
        let mut largest = 0.0_f32;
        let mut before = at(0.0);
        for step in 1..=n_steps {
            let after = at(f64::from(step) / f64::from(n_steps));
            let changes = before
                .pixels()
                .iter()
                .zip(after.pixels())
                .map(|(a, b)| (a - b).abs());
            largest = changes.fold(largest, f32::max);
            before = after;
        }
        largest
    };
    let [coarse, fine] = [100, 400].map(largest_change);
    assert!(
        coarse < 0.2 && fine < 0.3 * coarse,
        "{coarse} in a step, {fine} in a quarter of it"
    );
}
