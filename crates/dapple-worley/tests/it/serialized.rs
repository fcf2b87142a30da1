//! Tests of serialized options: a round trip preserves them, and their names are the documented ones.

use dapple_worley::{Combination, Metric, Octaves, Profile, RadialCells, Scatter};
use serde::{Serialize, de::DeserializeOwned};

fn is_kept<T: Serialize + DeserializeOwned + PartialEq + core::fmt::Debug>(option: T, text: &str) {
    let written = serde_json::to_string(&option).expect("options can be written");
    assert_eq!(written, text, "{option:?}");
    let read: T = serde_json::from_str(&written).expect("what was written can be read");
    assert_eq!(read, option, "{text}");
}

#[test]
fn options_are_kept_in_files() {
    is_kept(Metric::Euclidean, r#""euclidean""#);
    is_kept(Metric::Manhattan, r#""manhattan""#);
    is_kept(Metric::Chebyshev, r#""chebyshev""#);
    is_kept(Metric::Minkowski(2.5), r#"{"minkowski":2.5}"#);
    is_kept(Scatter::default(), r#"{"poisson":{"density":3.0}}"#);
    is_kept(
        Scatter::Unclamped { density: 0.5 },
        r#"{"unclamped":{"density":0.5}}"#,
    );
    is_kept(
        Scatter::Jittered { jitter: 0.75 },
        r#"{"jittered":{"jitter":0.75}}"#,
    );
    is_kept(Combination::F2_MINUS_F1, "[-1.0,1.0,0.0,0.0]");
    is_kept(
        Octaves::default(),
        r#"{"count":6,"lacunarity":2.0,"gain":0.5,"seeds":"own"}"#,
    );
    is_kept(
        RadialCells {
            around: 24,
            polar: 12.0,
            radial: 0.0,
        },
        r#"{"around":24,"polar":12.0,"radial":0.0}"#,
    );
    is_kept(
        Profile::Spots { radius: 0.5 },
        r#"{"spots":{"radius":0.5}}"#,
    );
    is_kept(
        Profile::Channels { width: 0.25 },
        r#"{"channels":{"width":0.25}}"#,
    );
}

#[test]
fn octaves_that_a_file_leaves_out_are_the_default() {
    let octaves: Octaves =
        serde_json::from_str(r#"{"seeds":"same"}"#).expect("the rest is left out");
    assert_eq!(octaves, Octaves::paper());
}
