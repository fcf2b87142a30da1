//! Measures the ranges of the named combinations of Worley's basis, for the table in `dapple-worley`.

use dapple_worley::{
    Combination, Dimensions, Metric, Scatter, Space, Worley, WorleyError, hash::Seed,
};
use std::fmt::Write as _;

/// Returns the table in the form of `crates/dapple-worley/src/ranges.rs`, nested by scatter, metric, number of axes
/// and combination.
pub(crate) fn table() -> anyhow::Result<String> {
    let mut text = String::from("[\n");
    for scatter in [Scatter::default(), Scatter::Jittered { jitter: 1.0 }] {
        text.push_str("    [\n");
        for (_, metric) in Metric::NAMED {
            let rows = [
                row::<2>(scatter, metric)?,
                row::<3>(scatter, metric)?,
                row::<4>(scatter, metric)?,
            ];
            writeln!(text, "        [\n{}        ],", rows.concat())?;
        }
        text.push_str("    ],\n");
    }
    text.push(']');
    Ok(text)
}

/// Returns the table row for a scatter and a metric: the ranges of all combinations with `N` axes.
fn row<const N: usize>(scatter: Scatter, metric: Metric) -> Result<String, WorleyError>
where
    Dimensions: Space<N>,
{
    let worley = Worley::<N>::new(Seed(0))
        .with_scatter(scatter)?
        .with_metric(metric)?;
    let ranges = Combination::NAMED.map(|(_, combination)| {
        let range = worley.combine(combination).measure_range(Seed(1), 20_000);
        range.map(|range| format!("{range:?}"))
    });
    let ranges: Result<Vec<_>, _> = ranges.into_iter().collect();
    Ok(format!("            [{}],\n", ranges?.join(", ")))
}
