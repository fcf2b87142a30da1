//! Tests of the table of ranges of the named combinations.

use dapple_hash::Seed;
use dapple_worley::{
    Combination, Dimensions, Metric, Scatter, Space, Worley, Worley2, WorleyError, WorleyErrorKind,
};

/// Returns the combinations whose range in the table differs from a new measurement.
fn measured_otherwise<const N: usize>() -> Vec<String>
where
    Dimensions: Space<N>,
{
    let mut other = Vec::new();
    for scatter in [Scatter::default(), Scatter::Jittered { jitter: 1.0 }] {
        for (_, metric) in Metric::NAMED {
            let worley = Worley::<N>::new(Seed(0)).with_metric(metric).unwrap();
            let worley = worley.with_scatter(scatter).unwrap();
            for (name, combination) in Combination::NAMED {
                let texture = worley.combine(combination);
                let range = texture.measure_range(Seed(1), 20_000).unwrap();
                // All that makes the values, with all digits.
                let measured = format!("{:?}", texture.clone().with_range(range));
                if format!("{:?}", texture.normalized()) != measured {
                    other.push(format!("{scatter:?} {metric:?} {N} {name}: {range:?}"));
                }
            }
        }
    }
    other
}

#[test]
fn table_is_what_is_measured() {
    let other = [
        measured_otherwise::<2>(),
        measured_otherwise::<3>(),
        measured_otherwise::<4>(),
    ];
    let other = other.concat();
    assert!(
        other.is_empty(),
        "measured otherwise:\n{}",
        other.join("\n")
    );
}

#[test]
fn normalized_values_fill_zero_to_one_and_others_are_refused() {
    let worley = Worley::<3>::new(Seed(9));
    let texture = worley
        .combine(Combination::F3_MINUS_F2)
        .normalized()
        .unwrap();
    let [low, high] = texture.measure_range(Seed(2), 20_000).unwrap();
    // The ends are quantiles of samples: 20 of 20000 values lie beyond each.
    assert!(
        low.abs() < 0.02 && (high - 1.0).abs() < 0.1,
        "{low} to {high}"
    );
}

#[test]
fn textures_without_a_range_say_what_is_in_the_way() {
    let plain = Worley2::new(Seed(9));
    let f1 = |worley: Worley2| worley.combine(Combination::F1).normalized();
    let causes = [
        (
            plain
                .combine(Combination::new([0.5, 0.0, 0.0, 0.0]))
                .normalized(),
            "have a name",
        ),
        (f1(plain.clone().with_density(5.0).unwrap()), "scatter"),
        (f1(plain.clone().with_varying_density(|_| 3.0)), "vary"),
        (
            f1(plain.clone().with_metric(Metric::Minkowski(3.0)).unwrap()),
            "Chebyshev",
        ),
        (f1(plain).and_then(|texture| texture.normalized()), "yet"),
    ];
    for (result, cause) in causes {
        let error: WorleyError = result.unwrap_err();
        let WorleyErrorKind::NoRange { measured } = *error.kind() else {
            panic!("{error}");
        };
        assert!(measured.contains(cause), "{measured}");
    }
}
