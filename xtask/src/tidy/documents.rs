//! Rules about documents that must agree with the crates: ARCHITECTURE.md and figures.lock.

use super::workspace::Workspace;
use std::collections::BTreeSet;

const FIGURES: &str = "crates/dapple-gallery/src/figures/";
const LOCK: &str = "crates/dapple-gallery/figures.lock";

/// Checks that the code map of ARCHITECTURE.md lists every crate.
pub(super) fn architecture(workspace: &Workspace) -> Vec<String> {
    let named = |name: &str| workspace.architecture.contains(&format!("`{name}`"));
    let missing = workspace
        .members
        .iter()
        .filter(|member| !named(&member.name));
    missing
        .map(|member| format!("ARCHITECTURE.md: `{}` is missing", member.name))
        .collect()
}

/// Checks that every figure has a file `figures/<paper>/fig_<number>.rs` and a line `<hash> <paper>-fig-<number>` in
/// figures.lock, that every line has a file, and that lines are sorted.
pub(super) fn figures(workspace: &Workspace) -> Vec<String> {
    let lines = workspace
        .figures_lock
        .lines()
        .filter(|line| !line.starts_with('#'));
    let locked: Vec<&str> = lines
        .map(|line| line.split_once(' ').map_or(line, |(_, name)| name))
        .collect();
    let files = workspace
        .sources
        .iter()
        .filter_map(|source| figure_name(&source.path));
    let files: BTreeSet<String> = files.collect();
    let mut found = Vec::new();
    for name in files.iter().filter(|name| !locked.contains(&name.as_str())) {
        found.push(format!(
            "{LOCK}: the figure `{name}` has no line; is it in its paper's list, and blessed?"
        ));
    }
    for name in locked.iter().filter(|name| !files.contains(**name)) {
        found.push(format!(
            "{LOCK}: the line `{name}` has no figure; bless to drop it"
        ));
    }
    if !locked.is_sorted() {
        found.push(format!("{LOCK}: the lines are not sorted by name"));
    }
    found
}

/// Returns the name of a figure, such as `pups-fig-03a` for `figures/pups/fig_03a.rs`; `None` for other files.
fn figure_name(path: &str) -> Option<String> {
    let (paper, file) = path
        .strip_prefix(FIGURES)?
        .strip_suffix(".rs")?
        .split_once('/')?;
    file.starts_with("fig_")
        .then(|| format!("{paper}-{file}").replace('_', "-"))
}

#[cfg(test)]
mod tests {
    use super::{FIGURES, architecture, figures};
    use crate::tidy::workspace::{Member, Text, Workspace};

    #[test]
    fn architecture_fires_on_a_crate_that_it_does_not_name() {
        let member = |name: &str| Member {
            name: name.into(),
            ..Member::default()
        };
        let broken = Workspace {
            members: vec![member("dapple-a"), member("dapple-b"), member("dapple")],
            architecture: "`dapple-a` is one, dapple-b another".into(),
            ..Workspace::default()
        };
        let expected = [
            "ARCHITECTURE.md: `dapple-b` is missing",
            "ARCHITECTURE.md: `dapple` is missing",
        ];
        assert_eq!(architecture(&broken), expected);
    }

    fn gallery(files: &[&str], lock: &str) -> Vec<String> {
        let source = |file: &&str| Text {
            path: format!("{FIGURES}{file}"),
            text: String::new(),
        };
        figures(&Workspace {
            sources: files.iter().map(source).collect(),
            figures_lock: lock.into(),
            ..Workspace::default()
        })
    }

    #[test]
    fn figures_accepts_a_line_for_each_figure() {
        let files = [
            "pups.rs",
            "pups/fig_01a.rs",
            "pups/fig_02.rs",
            "pups/shared.rs",
        ];
        assert!(
            gallery(&files, "# c\n12 pups-fig-01a\n34 pups-fig-02\n").is_empty(),
            "a sound lock is refused"
        );
    }

    #[test]
    fn figures_fires_on_figures_without_a_line_lines_without_a_figure_and_disorder() {
        for (files, lock, hint) in [
            (&["pups/fig_01.rs"][..], "", "`pups-fig-01` has no line"),
            (&[], "12 pups-fig-01\n", "`pups-fig-01` has no figure"),
            (
                &["pups/fig_01.rs", "pups/fig_02.rs"],
                "1 pups-fig-02\n2 pups-fig-01\n",
                "not sorted",
            ),
        ] {
            let found = gallery(files, lock);
            assert!(found.len() == 1 && found[0].contains(hint), "{found:?}");
        }
    }
}
