//! Rules about source files: headers, lengths, lint exceptions, ignored tests and references.

use super::workspace::{Text, Workspace};

/// Maximum number of lines per file. Aim for half of it.
const LINES_MAX: usize = 800;

/// The layers of algorithm libraries. Lower layers are foundations, higher layers are programs.
const ALGORITHM_LAYERS: core::ops::RangeInclusive<u64> = 1..=4;

/// Checks that every file begins with a `//!` header.
pub(super) fn headers(workspace: &Workspace) -> Vec<String> {
    let silent = workspace
        .sources
        .iter()
        .filter(|source| !source.text.starts_with("//!"));
    silent
        .map(|source| format!("{}:1: the first line is no `//!` header", source.path))
        .collect()
}

/// Checks that files have at most [`LINES_MAX`] lines. Files of pure data, `tables.rs` and `data.rs`, are exempt.
pub(super) fn lengths(workspace: &Workspace) -> Vec<String> {
    let long = workspace.sources.iter().filter(|source| {
        let is_table = ["/tables.rs", "/data.rs"]
            .iter()
            .any(|name| source.path.ends_with(name));
        !is_table && source.text.lines().count() > LINES_MAX
    });
    long.map(|source| {
        let lines = source.text.lines().count();
        format!(
            "{}: {lines} lines, but {LINES_MAX} is the limit",
            source.path
        )
    })
    .collect()
}

/// Checks that lints are expected with a reason instead of allowed, that no test is ignored, and that no placeholder
/// stands for missing code.
pub(super) fn escapes(workspace: &Workspace) -> Vec<String> {
    let mut found = Vec::new();
    for source in &workspace.sources {
        for (number, line) in (1..).zip(source.text.lines()) {
            if let Some(escape) = escape(line.trim_start()) {
                found.push(format!("{}:{number}: {escape}", source.path));
            }
        }
    }
    found
}

fn escape(line: &str) -> Option<&'static str> {
    if line.starts_with("//") {
        None
    } else if line.starts_with("#[allow") || line.starts_with("#![allow") {
        Some("a lint is allowed; use `#[expect(lint, reason = \"…\")]`")
    } else if line.starts_with("#[ignore") {
        Some("a test is ignored")
    } else if line.starts_with(concat!("to", "do!(")) || line.contains(concat!(" to", "do!(")) {
        Some("something is left to be done")
    } else {
        None
    }
}

/// Checks that algorithms name their source. A library file with a `value_stability_*` test contains an algorithm, and
/// the header of the file or of its module must name the source.
pub(super) fn references(workspace: &Workspace) -> Vec<String> {
    let algorithms = workspace.sources.iter().filter(|source| {
        is_of_library(workspace, source) && source.text.contains("fn value_stability_")
    });
    let silent =
        algorithms.filter(|source| !modules(source).any(|path| has_reference(workspace, &path)));
    silent
        .map(|source| {
            format!(
                "{}: no `Reference:` and no DOI in the header of the file or of its module (if it is all ours, say \
                 `Reference: our own`)",
                source.path
            )
        })
        .collect()
}

fn is_of_library(workspace: &Workspace, source: &Text) -> bool {
    let owner = workspace
        .members
        .iter()
        .find(|member| source.path.starts_with(&format!("{}/src/", member.folder)));
    let layer = owner.and_then(|member| workspace.layers.get(&member.name));
    layer.is_some_and(|layer| ALGORITHM_LAYERS.contains(layer))
}

/// Returns the paths of a file and its parent modules: `src/a/b.rs`, then `src/a.rs`. For tests of a whole crate, also
/// `src/lib.rs`.
fn modules(source: &Text) -> impl Iterator<Item = String> {
    let parent = |path: &String| match path.rsplit_once('/')? {
        (src, "tests.rs") if src.ends_with("/src") => Some(format!("{src}/lib.rs")),
        (src, _) if src.ends_with("/src") => None,
        (folder, _) => Some(format!("{folder}.rs")),
    };
    core::iter::successors(Some(source.path.clone()), parent)
}

fn has_reference(workspace: &Workspace, path: &str) -> bool {
    let source = workspace.sources.iter().find(|source| source.path == path);
    let mut header = source.into_iter().flat_map(|source| {
        source
            .text
            .lines()
            .take_while(|line| line.starts_with("//!"))
    });
    header.any(|line| line.contains("Reference") || line.contains("doi.org"))
}

#[cfg(test)]
mod tests {
    use super::{LINES_MAX, escapes, headers, lengths, references};
    use crate::tidy::workspace::{Member, Text, Workspace};

    fn workspace(sources: &[(&str, &str)]) -> Workspace {
        let member = Member {
            name: "a".into(),
            folder: "crates/a".into(),
            ..Member::default()
        };
        let text = |(path, text): &(&str, &str)| Text {
            path: (*path).into(),
            text: (*text).into(),
        };
        Workspace {
            members: vec![member],
            layers: [("a".to_owned(), 1)].into(),
            sources: sources.iter().map(text).collect(),
            ..Workspace::default()
        }
    }

    #[test]
    fn headers_fires_on_a_file_without_one() {
        let broken = workspace(&[
            ("a.rs", "//! Good.\n"),
            ("b.rs", "use x;\n//! Late.\n"),
            ("c.rs", ""),
        ]);
        assert_eq!(
            headers(&broken),
            [
                "b.rs:1: the first line is no `//!` header",
                "c.rs:1: the first line is no `//!` header"
            ]
        );
    }

    #[test]
    fn lengths_fires_past_the_limit_but_not_on_tables() {
        let (fits, long) = ("x\n".repeat(LINES_MAX), "x\n".repeat(LINES_MAX + 1));
        let broken = workspace(&[
            ("a.rs", &fits),
            ("b.rs", &long),
            ("src/tables.rs", &long),
            ("src/data.rs", &long),
        ]);
        assert_eq!(lengths(&broken), ["b.rs: 801 lines, but 800 is the limit"]);
    }

    #[test]
    fn escapes_fires_on_allowed_lints_ignored_tests_and_work_left() {
        let left = concat!("fn f() { to", "do!() }");
        for line in [
            "#[allow(dead_code)]",
            "    #![allow(dead_code)]",
            "#[ignore]",
            "#[ignore = \"slow\"]",
            left,
        ] {
            let broken = workspace(&[("a.rs", &format!("//! A.\n{line}\n"))]);
            assert_eq!(escapes(&broken).len(), 1, "`{line}` passes");
        }
        let sound = workspace(&[(
            "a.rs",
            "//! #[allow(x)]\n#[expect(x, reason = \"y\")]\n// #[ignore]\n",
        )]);
        assert!(escapes(&sound).is_empty(), "a sound file is refused");
    }

    #[test]
    fn references_fires_on_a_pinned_algorithm_that_cites_nothing() {
        let pinned = "//! Noise.\n\nfn value_stability_noise() {}\n";
        let found = references(&workspace(&[("crates/a/src/noise.rs", pinned)]));
        assert_eq!(found.len(), 1, "no reference, but it passes");
        assert!(
            found[0].starts_with("crates/a/src/noise.rs:"),
            "{}",
            found[0]
        );
    }

    #[test]
    fn references_are_taken_from_the_header_of_the_module() {
        let pinned = "//! Tests.\nfn value_stability_noise() {}\n";
        let cited = "//! Noise.\n//!\n//! Reference: Somebody, 1996, <https://doi.org/10.0/0>.\n";
        let sound = workspace(&[
            ("crates/a/src/noise/tests.rs", pinned),
            ("crates/a/src/noise.rs", cited),
        ]);
        assert!(
            references(&sound).is_empty(),
            "the module's header is not seen"
        );
        let lib = "//! The story.\n//!\n//! Reference: Somebody, 1996.\n";
        let whole = workspace(&[
            ("crates/a/src/tests/bits.rs", pinned),
            ("crates/a/src/lib.rs", lib),
        ]);
        assert!(
            references(&whole).is_empty(),
            "the crate's header is not seen"
        );
        let elsewhere = workspace(&[
            ("crates/b/src/noise.rs", pinned),
            ("crates/a/tests/noise.rs", pinned),
        ]);
        assert!(
            references(&elsewhere).is_empty(),
            "files that are no library's are asked for references"
        );
    }
}
