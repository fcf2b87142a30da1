//! Tests of the parameters for shaders. `dapple-wgsl-tests` compares the shaders' bits.

use dapple_worley::hash::Seed;
use dapple_worley::{Metric, Scatter, Worley2, Worley3, Worley4};

#[test]
fn shader_words_refuse_what_the_shader_lacks() {
    let worley = Worley2::new(Seed(7));
    let metric = worley.clone().with_metric(Metric::Minkowski(3.0));
    let unclamped = Scatter::Unclamped { density: 2.0 };
    let unclamped = worley.clone().with_scatter(unclamped);
    let period = worley.clone().with_period([Some((1 << 31) + 1), None]);
    let varying = worley.with_varying_density(|_| 2.0);
    let refused = [
        (metric, "Minkowski's metric"),
        (unclamped, "unclamped numbers of points"),
        (period, "periods above 2^31 cells"),
        (Ok(varying), "a density that varies in space"),
    ];
    for (worley, what) in refused {
        let error = worley.expect("a basis").shader_words();
        let error = error.expect_err(what).to_string();
        assert_eq!(error, format!("the shader does not support {what}"));
    }
}

#[test]
fn shader_words_end_with_the_number_of_the_metric() {
    for (metric, word) in [
        (Metric::Euclidean, 0),
        (Metric::Manhattan, 1),
        (Metric::Chebyshev, 2),
    ] {
        let worley = Worley4::new(Seed(7)).with_metric(metric);
        let words = worley.expect("a metric").shader_words().expect("words");
        assert_eq!(words[22..], [word, 0], "{metric:?}");
    }
}

#[test]
fn shader_words_count_the_points_of_a_cell() {
    for density in [0.3, 3.0, 9.0, 64.0] {
        let worley = Worley3::new(Seed(7)).with_scatter(Scatter::Poisson { density });
        let words = worley.expect("a density").shader_words().expect("words");
        // No random bits exceed an unused threshold; the largest give the most points, the smallest the fewest.
        let count = |bits: u32| {
            let above = words[12..20].iter().filter(|&&word| bits > word).count();
            words[20] + above as u32
        };
        let most = if density < 1.0 { 5..=9 } else { 9..=9 };
        assert!(
            most.contains(&count(u32::MAX)),
            "{density}: {}",
            count(u32::MAX)
        );
        assert!(count(0) >= 1, "{density}");
    }
}
