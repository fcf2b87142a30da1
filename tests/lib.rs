//! Workspace-wide tests. They live in the test binary `it`; this library tests the code in the READMEs.

#![forbid(unsafe_code)]

/// Tests the code of a README.
#[cfg(doctest)]
macro_rules! readmes {
    ($($name:ident: $path:literal),* $(,)?) => {
        $(
            #[doc = include_str!($path)]
            mod $name {}
        )*
    };
}

#[cfg(doctest)]
readmes! {
    top: "../README.md",
    dapple: "../crates/dapple/README.md",
    hash: "../crates/dapple-hash/README.md",
    noise: "../crates/dapple-noise/README.md",
    pattern: "../crates/dapple-pattern/README.md",
    graph: "../crates/dapple-graph/README.md",
    points: "../crates/dapple-points/README.md",
    pups: "../crates/dapple-pups/README.md",
    raster: "../crates/dapple-raster/README.md",
    recipe: "../crates/dapple-recipe/README.md",
    wgsl: "../crates/dapple-wgsl/README.md",
    chunks: "../docs/terrain-chunks.md",
    others: "../docs/from-other-noise-libraries.md",
}
