//! The steps of CI. `.ci/run` installs missing tools and then runs these steps.

mod exchange;
mod fuzz;
mod page;
mod python;
mod web;

use crate::tidy;
use crate::tidy::workspace::{Member, Workspace};
use anyhow::{Context, bail};
use xshell::{Cmd, Shell, cmd};

/// A step of the CI checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// All tests, as run by the command in the README.
    Test,
    /// The formatting check.
    Fmt,
    /// The lints, with warnings as errors.
    Clippy,
    /// The documentation, with warnings as errors.
    Doc,
    /// The project rules, as in `cargo xtask tidy`.
    Tidy,
    /// The license texts of third-party crates, as in `cargo xtask licenses --check`.
    Licenses,
    /// The shaders on a GPU, or on a processor that emulates one, compared with the CPU.
    Shaders,
    /// Each published crate built alone, without features and with each of its features, and its tests without `rayon`.
    Features,
    /// The package of each published crate, as uploaded to a registry.
    Package,
    /// Baked materials, checked with other programs if these are installed.
    Exchange,
    /// The page of the studio, if Node is installed.
    Page,
    /// The studio without a server, if the compiler supports WebAssembly.
    Web,
    /// The Python package, if Python is installed.
    Python,
    /// Each fuzz target for 10 seconds, if nightly Rust and cargo-fuzz are installed.
    Fuzz,
}

impl Step {
    /// All steps, in the order in which CI runs them.
    pub(crate) const ALL: [Self; 14] = [
        Self::Test,
        Self::Fmt,
        Self::Clippy,
        Self::Doc,
        Self::Tidy,
        Self::Licenses,
        Self::Shaders,
        Self::Features,
        Self::Package,
        Self::Exchange,
        Self::Page,
        Self::Web,
        Self::Python,
        Self::Fuzz,
    ];

    /// Returns the name of the step on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Test => "test",
            Self::Fmt => "fmt",
            Self::Clippy => "clippy",
            Self::Doc => "doc",
            Self::Tidy => "tidy",
            Self::Licenses => "licenses",
            Self::Shaders => "shaders",
            Self::Features => "features",
            Self::Package => "package",
            Self::Exchange => "exchange",
            Self::Page => "page",
            Self::Web => "web",
            Self::Python => "python",
            Self::Fuzz => "fuzz",
        }
    }

    /// Returns the names of all steps, for a message.
    pub(crate) fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }
}

/// Runs `steps` in order and stops at the first failure.
pub(crate) fn ci(shell: &Shell, steps: &[Step]) -> anyhow::Result<()> {
    for &step in steps {
        crate::say(&format!("== {}", step.name()));
        run(shell, step).with_context(|| format!("the step `{}` failed", step.name()))?;
    }
    Ok(())
}

fn run(shell: &Shell, step: Step) -> anyhow::Result<()> {
    let command = match step {
        Step::Test => cmd!(shell, "cargo test --workspace"),
        Step::Fmt => cmd!(shell, "cargo fmt --all --check"),
        Step::Clippy => cmd!(
            shell,
            "cargo clippy --workspace --all-targets --features dapple-bench/peers,dapple-wgsl-tests/gpu -- -D warnings"
        ),
        Step::Doc => return doc(shell),
        Step::Tidy => return tidy::tidy(shell),
        Step::Licenses => return crate::licenses::licenses(shell, true),
        // With the features of the whole workspace, so that no crate is compiled again. The tests skip themselves without a
        // graphics adapter.
        Step::Shaders => cmd!(
            shell,
            "cargo test --workspace --features dapple-wgsl-tests/gpu,dapple-cli/gpu --test gpu --test radv --test on_gpu"
        ),
        Step::Features => return features(shell),
        Step::Package => return package(shell),
        Step::Exchange => return exchange::exchange(shell),
        Step::Page => return page::page(shell),
        Step::Web => return web::web(shell),
        Step::Python => return python::python(shell),
        Step::Fuzz => return fuzz::fuzz(shell),
    };
    Ok(command.run()?)
}

/// Search terms that are not names in the crates. The documentation search must find them; they are aliases of items on
/// the front page of `dapple`.
const LOOKED_FOR: [&str; 23] = [
    "blue noise",
    "cellular noise",
    "chunk",
    "domain warping",
    "fbm",
    "height map",
    "heightmap",
    "inpaint",
    "normal map",
    "perlin",
    "poisson disc",
    "poisson disk",
    "ridged",
    "seamless",
    "signed distance",
    "simplex",
    "splat map",
    "terrain blending",
    "texture synthesis",
    "tileable",
    "turbulence",
    "voronoi",
    "wall",
];

/// Builds the documentation, and checks that its search index contains the search terms. Stable rustdoc drops the
/// aliases of items re-exported from a private module unless they stand at the re-export.
fn doc(shell: &Shell) -> anyhow::Result<()> {
    cmd!(shell, "cargo doc --workspace --no-deps")
        .env("RUSTDOCFLAGS", "-D warnings")
        .run()?;
    let target = shell.var("CARGO_TARGET_DIR").unwrap_or("target".to_owned());
    let mut names = String::new();
    for file in shell.read_dir(format!("{target}/doc/search.index/name"))? {
        names.push_str(&shell.read_file(file)?);
    }
    let lost = LOOKED_FOR.into_iter().filter(|word| !names.contains(word));
    let lost: Vec<_> = lost.collect();
    if !lost.is_empty() {
        bail!(
            "the search of the documentation does not find {}",
            lost.join(", ")
        );
    }
    Ok(())
}

/// Checks every published crate alone, without features and with each of its features. A crate whose own code depends
/// on `rayon` is also tested without it. The code of other crates is the same with and without `rayon`, and their
/// tests compare one thread with several.
fn features(shell: &Shell) -> anyhow::Result<()> {
    let workspace = Workspace::read(shell)?;
    for member in workspace.members.iter().filter(|member| member.published) {
        let package = &member.name;
        for set in feature_sets(member) {
            cmd!(
                shell,
                "cargo clippy --quiet --package {package} --no-default-features --features {set} -- -D warnings"
            )
            .run()?;
        }
        // Test without threads where that is different code.
        let rayon = member.features.get("rayon");
        if rayon.is_some_and(|parts| !is_passed_on(parts)) {
            cmd!(
                shell,
                "cargo test --quiet --package {package} --no-default-features --tests"
            )
            .run()?;
        }
    }
    Ok(())
}

/// Creates the packages of all published crates without building them, since the step `features` builds each crate
/// alone.
fn package(shell: &Shell) -> anyhow::Result<()> {
    let workspace = Workspace::read(shell)?;
    let published = workspace.members.iter().filter(|member| member.published);
    let packages = published.flat_map(|member| ["--package", member.name.as_str()]);
    cmd!(shell, "cargo package --no-verify --allow-dirty --quiet")
        .args(packages)
        .run()?;
    Ok(())
}

/// Returns the feature sets to build: no feature, each feature that affects the crate's own code, and all features.
fn feature_sets(member: &Member) -> Vec<String> {
    let features = member.features.iter();
    let features: Vec<_> = features.filter(|(name, _)| *name != "default").collect();
    let own = features.iter().filter(|(_, parts)| !is_passed_on(parts));
    let mut sets = vec![String::new()];
    sets.extend(own.map(|(name, _)| (*name).clone()));
    let names: Vec<&str> = features.iter().map(|(name, _)| name.as_str()).collect();
    let all = names.join(",");
    if sets.last() != Some(&all) {
        sets.push(all);
    }
    sets
}

/// Returns whether a feature only enables features of other crates. Such a feature does not affect the crate's own
/// code.
fn is_passed_on(parts: &[String]) -> bool {
    parts.iter().all(|part| part.contains('/'))
}

/// Reports a skipped step, or fails if `DAPPLE_NO_SKIP=1` is set.
fn skip(reason: &str) -> anyhow::Result<()> {
    if std::env::var_os("DAPPLE_NO_SKIP").is_some_and(|value| value == "1") {
        bail!("{reason}; DAPPLE_NO_SKIP=1 lets nothing be skipped");
    }
    crate::say(&format!("skipped: {reason}"));
    Ok(())
}

/// Returns whether a command succeeds.
fn works(command: Cmd<'_>) -> bool {
    command.quiet().ignore_stderr().run().is_ok()
}
