//! The ranges of the named combinations.
//!
//! As Worley did ("A Cellular Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>), they
//! were measured once, for each number of axes and each metric, at the default density: but for one value in a thousand
//! at either end. `cargo xtask gallery --ranges` measures them again and prints the table.

use crate::{Combination, Metric, Scatter};

/// The metrics with a table, in its order.
const METRICS: [Metric; 3] = [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev];

/// For each metric, for 2, 3 and 4 axes, for each of [`Combination::NAMED`]: the low and the high end.
#[rustfmt::skip]
const RANGES: [[[[f32; 2]; Combination::NAMED.len()]; 3]; METRICS.len()] = [
    [
        [[0.010974076, 0.76229835], [0.065805584, 0.91428345], [0.1417761, 1.0195735], [0.21772087, 1.1010303], [0.00022466481, 0.68405354], [0.10049477, 1.6141443], [0.007353246, 0.8322673], [0.00012877584, 0.5937053], [0.030768067, 0.9054758], [9.557605e-5, 0.5008415], [0.01136148, 1.2969987]],
        [[0.041316748, 0.8015076], [0.15808596, 0.88636553], [0.24387576, 0.95029527], [0.33023053, 0.99278855], [0.00016638637, 0.5972576], [0.24232218, 1.6419287], [0.0071097612, 0.6763977], [0.000101566315, 0.45619264], [0.021424234, 0.74553096], [6.502867e-5, 0.39463115], [0.009961963, 1.0222847]],
        [[0.094674796, 0.81881356], [0.235652, 0.8834719], [0.33885086, 0.9299414], [0.409147, 0.95589477], [0.00016182661, 0.5506015], [0.4033144, 1.658376], [0.0061725974, 0.62724346], [8.7440014e-5, 0.40748304], [0.020547956, 0.6727405], [5.0663948e-5, 0.31546217], [0.007945776, 0.93423104]],
    ],
    [
        [[0.013609409, 0.9794822], [0.08213663, 1.1482148], [0.18081999, 1.2921038], [0.2854538, 1.3819757], [0.00034189224, 0.8556552], [0.12746572, 2.028316], [0.009137154, 1.0265675], [0.00015163422, 0.74365854], [0.036875248, 1.13937], [0.0001411438, 0.6635332], [0.012393475, 1.6417422]],
        [[0.063072205, 1.1797223], [0.23240662, 1.3023558], [0.36329985, 1.3751001], [0.46972036, 1.4561167], [0.0002593994, 0.87789917], [0.36012363, 2.439259], [0.007361412, 0.9847541], [0.00018596649, 0.6721649], [0.02911663, 1.0768628], [0.00013303757, 0.5709877], [0.012070179, 1.5213838]],
        [[0.15354633, 1.3507948], [0.38545752, 1.4530721], [0.5367212, 1.5211997], [0.67656755, 1.5777535], [0.00031471252, 0.8828478], [0.65535545, 2.7670088], [0.008950233, 1.0162811], [0.00012588501, 0.6790142], [0.033291817, 1.1175194], [8.010864e-5, 0.5281668], [0.0114889145, 1.5003796]],
    ],
    [
        [[0.010028362, 0.6921978], [0.056038857, 0.8060365], [0.12267876, 0.9024248], [0.1947174, 0.9839535], [0.00017309189, 0.6066389], [0.08953047, 1.436768], [0.00726223, 0.7227621], [0.00012397766, 0.50661135], [0.022546768, 0.8106618], [0.00010585785, 0.4582038], [0.009923458, 1.1009488]],
        [[0.031024933, 0.6490803], [0.12734938, 0.7128086], [0.20343208, 0.755589], [0.25950813, 0.7967291], [0.0001244545, 0.46716213], [0.20547676, 1.321168], [0.005370617, 0.5564046], [7.915497e-5, 0.40041685], [0.016950607, 0.61677504], [8.583069e-5, 0.3107481], [0.0075092316, 0.8763089]],
        [[0.070058346, 0.6083441], [0.17176294, 0.65333843], [0.25205946, 0.68912554], [0.30065775, 0.7160058], [0.00012874603, 0.41258383], [0.30131435, 1.2411323], [0.0039606094, 0.46114874], [6.246567e-5, 0.29651833], [0.011158943, 0.51060677], [4.8160553e-5, 0.23764038], [0.0055789948, 0.6785641]],
    ],
];

/// The range of a combination, if it is known.
pub(crate) fn range(
    n_axes: usize,
    metric: Metric,
    scatter: Scatter,
    combination: Combination,
) -> Option<[f32; 2]> {
    if scatter != Scatter::default() {
        return None;
    }
    let metric = METRICS.iter().position(|&other| other == metric)?;
    let mut named = Combination::NAMED.iter();
    let named = named.position(|&(_, other)| other == combination)?;
    Some(RANGES[metric][n_axes - 2][named])
}

#[cfg(test)]
mod tests {
    use super::{METRICS, RANGES};
    use crate::{Axes, Combination, Space, Worley, WorleyErrorKind};
    use dapple_hash::Seed;

    fn is_measured<const N: usize>() -> Vec<String>
    where
        Axes: Space<N>,
    {
        let mut other = Vec::new();
        for (index, metric) in METRICS.into_iter().enumerate() {
            let worley = Worley::<N>::new(Seed(0)).with_metric(metric).unwrap();
            for (named, (name, combination)) in Combination::NAMED.into_iter().enumerate() {
                let range = worley
                    .combine(combination)
                    .measure_range(Seed(1), 20_000)
                    .unwrap();
                if range != RANGES[index][N - 2][named] {
                    other.push(format!("{metric:?} {N} {name}: {range:?}"));
                }
            }
        }
        other
    }

    #[test]
    fn table_is_what_is_measured() {
        let other = [is_measured::<2>(), is_measured::<3>(), is_measured::<4>()].concat();
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
        let odd = worley
            .combine(Combination::new([0.5, 0.0, 0.0, 0.0]))
            .normalized();
        assert_eq!(*odd.unwrap_err().kind(), WorleyErrorKind::NoRange);
        let dense = worley
            .with_density(5.0)
            .unwrap()
            .combine(Combination::F1)
            .normalized();
        assert_eq!(*dense.unwrap_err().kind(), WorleyErrorKind::NoRange);
    }
}
