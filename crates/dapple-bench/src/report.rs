//! Formats the results of a run as aligned Markdown tables, and computes the exit code of the program.

use crate::machine::Machine;
use crate::row::{GROUPS, Row};
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

/// Column titles, and whether each column is right-aligned.
const COLUMNS: [(&str, bool); 8] = [
    ("case", false),
    ("peer", false),
    ("unit", false),
    ("ours", true),
    ("theirs", true),
    ("ratio", true),
    ("must", true),
    ("holds", false),
];

/// Returns the page: the machine, then one table for each group with its notes below.
pub(crate) fn markdown(machine: &Machine, filters: &[String], rows: &[Row]) -> String {
    let mut page = String::from("# Results\n\n");
    let command = ["cargo xtask bench".to_owned()]
        .iter()
        .chain(filters)
        .cloned()
        .collect::<Vec<_>>()
        .join(" ");
    let failed = rows.iter().filter(|row| !row.holds).count();
    let _ = writeln!(page, "The last run of `{command}`, on {machine}.\n");
    let _ = writeln!(page, "{EXPLANATION}\n");
    let _ = writeln!(
        page,
        "{} rows, {failed} of them below their bar.",
        rows.len()
    );
    for group in GROUPS {
        let rows: Vec<&Row> = rows.iter().filter(|row| row.group == group).collect();
        if !rows.is_empty() {
            let _ = write!(page, "\n## {group}\n\n{}", table(&rows));
        }
    }
    page
}

/// The text that explains the tables.
const EXPLANATION: &str = "\
Times are of the processor, not of the wall, medians of interleaved runs on one thread; `src/harness/two_threads.rs`
explains the rows on two; beside what papers took, ours is the wall time on two threads. The ratio of times is theirs over ours where the bar is a `≥`, and ours over theirs where it is a `≤`;
that of distances and angles is always ours over theirs.
Every row also confirms that both sides did the work: see the modules of the groups.";

/// Returns one group as a table, followed by the notes of its rows.
fn table(rows: &[&Row]) -> String {
    let heads = COLUMNS.map(|(head, _)| head.to_owned());
    let lines: Vec<[String; 8]> = rows.iter().map(|row| cells(row)).collect();
    let widths: Vec<usize> = (0..COLUMNS.len())
        .map(|column| {
            lines
                .iter()
                .chain([&heads])
                .map(|line| line[column].chars().count())
                .max()
                .unwrap_or(0)
                .max(3)
        })
        .collect();
    let mut text = line(&heads, &widths);
    for ((_, right), &width) in COLUMNS.iter().zip(&widths) {
        let dashes = "-".repeat(width - 1);
        let _ = if *right {
            write!(text, "| {dashes}: ")
        } else {
            write!(text, "| {dashes}- ")
        };
    }
    text.push_str("|\n");
    lines
        .iter()
        .for_each(|cells| text.push_str(&line(cells, &widths)));
    let notes: Vec<&&Row> = rows.iter().filter(|row| !row.note.is_empty()).collect();
    if !notes.is_empty() {
        text.push('\n');
    }
    for row in notes {
        let _ = writeln!(text, "* {}, {}: {}.", row.case, row.peer, row.note);
    }
    text
}

/// Returns the row's table cells as text.
fn cells(row: &Row) -> [String; 8] {
    let sign = if row.at == "most" { '≤' } else { '≥' };
    let must = format!("{sign} {}", row.must);
    let holds = if row.holds { "yes" } else { "NO" };
    [
        row.case.to_owned(),
        row.peer.to_owned(),
        row.unit.to_owned(),
        three_digits(row.ours),
        three_digits(row.theirs),
        three_digits(row.ratio),
        must,
        holds.to_owned(),
    ]
}

/// Returns one line of a table, its cells padded to the widths of the columns.
fn line(cells: &[String; 8], widths: &[usize]) -> String {
    let mut text = String::new();
    for ((cell, &width), (_, right)) in cells.iter().zip(widths).zip(COLUMNS) {
        let _ = if right {
            write!(text, "| {cell:>width$} ")
        } else {
            write!(text, "| {cell:<width$} ")
        };
    }
    text.push_str("|\n");
    text
}

/// Formats a positive number with three significant digits, or with all digits before the point.
pub(crate) fn three_digits(value: f64) -> String {
    let decimals = match value {
        value if value < 10.0 => 2,
        value if value < 100.0 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}")
}

/// Returns failure if `check` is set and a row does not hold.
pub(crate) fn exit_code(rows: &[Row], check: bool) -> ExitCode {
    if check && rows.iter().any(|row| !row.holds) {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    }
}

/// Prints the page.
#[expect(clippy::print_stdout, reason = "the table is what this program is for")]
pub(crate) fn print(page: &str) {
    print!("{page}");
}

/// Writes a results file.
#[expect(
    clippy::disallowed_methods,
    reason = "the caller asked for results in a file"
)]
pub(crate) fn write(path: &Path, text: &str) -> std::io::Result<()> {
    std::fs::write(path, text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::{Case, Goal, Unit};

    const CASE: Case = Case {
        group: "graph",
        case: "periodic, 700 points",
        peer: "spade",
        unit: Unit::NsPerPoint,
        must: Goal::CostAtMost(1.4),
        note: "",
    };

    #[test]
    fn table_lines_are_aligned() {
        let rows = [
            CASE.row(1e-7, 1e-7),
            CASE.row(123.4, 0.5),
            Case {
                must: Goal::Faster(65.0),
                ..CASE
            }
            .row(1.0, 2.0),
        ];
        let table = table(&rows.iter().collect::<Vec<_>>());
        let lengths: Vec<usize> = table.lines().map(|line| line.chars().count()).collect();
        assert!(
            lengths.iter().all(|&length| length == lengths[0]),
            "lines have lengths {lengths:?}:\n{table}"
        );
    }

    #[test]
    fn table_shows_bar_and_verdict() {
        let faster = Case {
            must: Goal::Faster(65.0),
            ..CASE
        };
        let rows = [
            CASE.row(1.3, 1.0),
            CASE.row(1.5, 1.0),
            faster.row(1.0, 70.0),
        ];
        let verdicts: Vec<[String; 8]> = rows.iter().map(cells).collect();
        assert_eq!(
            verdicts[0][5..],
            ["1.30", "≤ 1.4", "yes"],
            "1.3 is within 1.4"
        );
        assert_eq!(verdicts[1][5..], ["1.50", "≤ 1.4", "NO"], "1.5 is not");
        assert_eq!(
            verdicts[2][5..],
            ["70.0", "≥ 65", "yes"],
            "70 is at least 65"
        );
    }

    #[test]
    fn page_names_machine_command_and_failures() {
        let machine = Machine {
            processor: "Fast 9000".to_owned(),
            n_threads: 2,
            vectors: "AVX2",
            compiler: "rustc 1.89.0".to_owned(),
        };
        let rows = [Case {
            note: "of 706 points",
            ..CASE
        }
        .row(1.5, 1.0)];
        let page = markdown(&machine, &["graph".to_owned()], &rows);
        for part in [
            "`cargo xtask bench graph`",
            "Fast 9000, 2 threads, AVX2",
            "1 of them below",
            "## graph",
            "spade: of 706 points.",
        ] {
            assert!(page.contains(part), "the page lacks {part:?}:\n{page}");
        }
        assert!(
            !page.contains("## pups"),
            "a group without rows has no heading"
        );
    }

    #[test]
    fn numbers_have_three_digits() {
        let texts = [0.034, 3.899, 38.99, 389.9, 3899.0].map(three_digits);
        assert_eq!(
            texts,
            ["0.03", "3.90", "39.0", "390", "3899"],
            "three digits, or two decimals below ten"
        );
    }

    #[test]
    fn exit_code_fails_only_under_check_and_below_a_bar() {
        let (good, bad) = (CASE.row(1.0, 1.0), CASE.row(2.0, 1.0));
        let code = |rows: &[Row], check| format!("{:?}", exit_code(rows, check));
        let (success, failure) = (
            format!("{:?}", ExitCode::SUCCESS),
            format!("{:?}", ExitCode::FAILURE),
        );
        assert_eq!(
            code(&[good.clone(), bad.clone()], true),
            failure,
            "one row below its bar fails the check"
        );
        assert_eq!(
            code(&[good.clone(), bad], false),
            success,
            "without --check the table only tells"
        );
        assert_eq!(code(&[good], true), success, "all rows hold");
    }
}
