//! `cargo xtask tidy`: checks the project rules that the compiler does not check.
//!
//! A rule is a function from the [`Workspace`] to a list of violations. Each rule has a test that shows it firing on
//! a broken sample. `cargo test` runs all rules on the real workspace.

mod documents;
mod layers;
mod sources;
pub(crate) mod workspace;

use anyhow::bail;
use workspace::Workspace;
use xshell::Shell;

/// A rule: its statement, and the function that returns all violations.
type Rule = (&'static str, fn(&Workspace) -> Vec<String>);

/// All rules.
const RULES: [Rule; 11] = [
    ("a crate lies in the folder of its name", layers::folders),
    (
        "a crate has a layer, and uses only strictly lower ones",
        layers::layers,
    ),
    ("xtask uses no crate of ours", layers::xtask_alone),
    ("a crate takes the lints of the workspace", layers::lints),
    (
        "a published crate has all that a registry shows, and its licenses",
        layers::packages,
    ),
    ("a source file begins with `//!`", sources::headers),
    ("a source file has at most 800 lines", sources::lengths),
    (
        "no lint and no test is switched off in passing",
        sources::escapes,
    ),
    ("an algorithm says where it comes from", sources::references),
    ("ARCHITECTURE.md names every crate", documents::architecture),
    (
        "figures.lock and the figure files agree",
        documents::figures,
    ),
];

/// Checks every rule and reports all violations.
pub(crate) fn tidy(shell: &Shell) -> anyhow::Result<()> {
    let problems = problems(&Workspace::read(shell)?);
    if problems.is_empty() {
        crate::say(&format!("{} rules hold", RULES.len()));
        return Ok(());
    }
    problems.iter().for_each(|problem| crate::say(problem));
    bail!("the house is not tidy: {} found", problems.len())
}

fn problems(workspace: &Workspace) -> Vec<String> {
    let broken = |(rule, find): &Rule| {
        let rule = *rule;
        find(workspace)
            .into_iter()
            .map(move |found| format!("{found}\n    rule: {rule}"))
    };
    RULES.iter().flat_map(broken).collect()
}

#[cfg(test)]
mod tests {
    use super::problems;
    use super::workspace::Workspace;
    use xshell::Shell;

    #[test]
    fn the_workspace_is_tidy() {
        let shell = Shell::new().unwrap();
        shell.change_dir(crate::root());
        let problems = problems(&Workspace::read(&shell).unwrap());
        assert!(
            problems.is_empty(),
            "the house is not tidy:\n{}",
            problems.join("\n")
        );
    }
}
