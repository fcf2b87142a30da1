//! Formats the results of a run as aligned Markdown tables, and computes the exit code of the program.

use crate::machine::Machine;
use crate::row::{Case, GROUPS, Row};
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

/// Column titles, and whether each column is right-aligned.
const COLUMNS: [(&str, bool); 9] = [
    ("case", false),
    ("peer", false),
    ("unit", false),
    ("ours", true),
    ("theirs", true),
    ("ratio", true),
    ("must", true),
    ("holds", false),
    ("on", false),
];

/// The results page: the machines, and the rows measured on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Page {
    /// Descriptions of the machines. Rows refer to them by number, starting at 1.
    machines: Vec<String>,
    lines: Vec<Line>,
}

/// A row of the results as text.
#[derive(Clone, Debug, PartialEq)]
struct Line {
    group: String,
    cells: [String; 9],
    /// Note below the table; may be empty.
    note: String,
}

impl Line {
    /// Returns whether two rows have the same group, case and peer.
    fn is_same(&self, other: &Self) -> bool {
        self.group == other.group && self.cells[..2] == other.cells[..2]
    }

    fn holds(&self) -> bool {
        self.cells[7] == "yes"
    }
}

impl Page {
    /// Creates the page of rows that were measured on one machine.
    pub(crate) fn new(machine: &Machine, rows: &[Row]) -> Self {
        let lines = rows.iter().map(|row| Line {
            group: row.group.to_owned(),
            cells: cells(row, "1"),
            note: row.note.clone(),
        });
        Self {
            machines: vec![machine.to_string()],
            lines: lines.collect(),
        }
    }

    /// Parses a page that [`markdown`](Self::markdown) has written.
    pub(crate) fn read(text: &str) -> Self {
        let mut page = Self::default();
        let mut group = String::new();
        for line in text.lines() {
            if let Some(name) = line.strip_prefix("## ") {
                name.clone_into(&mut group);
            } else if let Some((number, machine)) = line.split_once(". ")
                && number.parse() == Ok(page.machines.len() + 1)
            {
                page.machines.push(machine.to_owned());
            } else if let Some(note) = line.strip_prefix("* ") {
                for line in page.lines.iter_mut().filter(|line| line.group == group) {
                    let start = format!("{}, {}: ", line.cells[0], line.cells[1]);
                    if let Some(text) = note.strip_prefix(&start) {
                        text.trim_end_matches('.').clone_into(&mut line.note);
                    }
                }
            } else if line.starts_with("| ") && !line.starts_with("| case") {
                let mut texts = line.split('|').skip(1).map(|cell| cell.trim().to_owned());
                page.lines.push(Line {
                    group: group.clone(),
                    cells: std::array::from_fn(|_| texts.next().unwrap_or_default()),
                    note: String::new(),
                });
            }
        }
        page.lines.retain(|line| !line.cells[0].starts_with('-'));
        page
    }

    /// Returns whether the page has a row for a case.
    pub(crate) fn has(&self, case: &Case) -> bool {
        let mut lines = self.lines.iter();
        lines.any(|line| {
            line.group == case.group && line.cells[0] == case.case && line.cells[1] == case.peer
        })
    }

    /// Adds the rows of another page, replacing rows with the same case and peer.
    pub(crate) fn merged(mut self, newer: Self) -> Self {
        for mut line in newer.lines {
            let machine = line.cells[8].parse::<usize>().unwrap_or(1) - 1;
            let machine = newer.machines.get(machine).cloned().unwrap_or_default();
            let at = self.machines.iter().position(|known| *known == machine);
            let at = at.unwrap_or_else(|| {
                self.machines.push(machine);
                self.machines.len() - 1
            });
            line.cells[8] = (at + 1).to_string();
            match self.lines.iter_mut().find(|old| old.is_same(&line)) {
                Some(old) => *old = line,
                None => self.lines.push(line),
            }
        }
        self
    }

    /// Returns the page as Markdown: the machines, then one table for each group with its notes below.
    pub(crate) fn markdown(&self) -> String {
        let mut page = String::from("# Results\n\n");
        let _ = writeln!(page, "Rows of `cargo xtask bench`, measured on:\n");
        for (number, machine) in (1..).zip(&self.machines) {
            let _ = writeln!(page, "{number}. {machine}");
        }
        let _ = writeln!(page, "\n{EXPLANATION}\n");
        let failed = self.lines.iter().filter(|line| !line.holds()).count();
        let _ = writeln!(
            page,
            "{} rows, {failed} of them below their bar.",
            self.lines.len()
        );
        for group in GROUPS {
            let lines = self.lines.iter().filter(|line| line.group == group);
            let lines: Vec<&Line> = lines.collect();
            if !lines.is_empty() {
                let _ = write!(page, "\n## {group}\n\n{}", table(&lines));
            }
        }
        page
    }
}

/// The text that explains the tables.
const EXPLANATION: &str = "\
Times are of the processor, not of the wall, medians of interleaved runs on one thread; `src/harness/two_threads.rs`
explains the rows on two; beside what papers took, ours is the wall time on two threads. The ratio of times is theirs over ours where the bar is a `≥`, and ours over theirs where it is a `≤`;
that of distances and angles is always ours over theirs. `on` is the number of the machine.
Every row also confirms that both sides did the work: see the modules of the groups.";

/// Returns the table of one group, followed by the notes of its rows.
fn table(lines: &[&Line]) -> String {
    let heads = COLUMNS.map(|(head, _)| head.to_owned());
    let widths: Vec<usize> = (0..COLUMNS.len())
        .map(|column| {
            lines
                .iter()
                .map(|line| &line.cells)
                .chain([&heads])
                .map(|cells| cells[column].chars().count())
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
    for row in lines {
        text.push_str(&line(&row.cells, &widths));
    }
    let notes: Vec<&&Line> = lines.iter().filter(|line| !line.note.is_empty()).collect();
    if !notes.is_empty() {
        text.push('\n');
    }
    for row in notes {
        let _ = writeln!(text, "* {}, {}: {}.", row.cells[0], row.cells[1], row.note);
    }
    text
}

/// Returns the row's table cells as text. `on` is the number of the machine.
fn cells(row: &Row, on: &str) -> [String; 9] {
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
        on.to_owned(),
    ]
}

/// Returns one line of a table, its cells padded to the widths of the columns.
fn line(cells: &[String; 9], widths: &[usize]) -> String {
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

/// Formats a positive number with three significant digits. Digits before the point are never rounded away.
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

/// Reads the results page. If the file is missing, returns a page without rows.
#[expect(
    clippy::disallowed_methods,
    reason = "the results of other runs are in a file"
)]
pub(crate) fn read(path: &Path) -> Page {
    Page::read(&std::fs::read_to_string(path).unwrap_or_default())
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
    use crate::row::{Goal, Unit};

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
        let page = Page::new(&machine("Fast 9000"), &rows);
        let table = table(&page.lines.iter().collect::<Vec<_>>());
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
        let verdicts: Vec<[String; 9]> = rows.iter().map(|row| cells(row, "1")).collect();
        assert_eq!(
            verdicts[0][5..8],
            ["1.30", "≤ 1.4", "yes"],
            "1.3 is within 1.4"
        );
        assert_eq!(verdicts[1][5..8], ["1.50", "≤ 1.4", "NO"], "1.5 is not");
        assert_eq!(
            verdicts[2][5..8],
            ["70.0", "≥ 65", "yes"],
            "70 is at least 65"
        );
    }

    fn machine(processor: &str) -> Machine {
        Machine {
            processor: processor.to_owned(),
            n_threads: 2,
            vectors: "AVX2",
            compiler: "rustc 1.89.0".to_owned(),
        }
    }

    #[test]
    fn page_names_machine_and_failures() {
        let rows = [Case {
            note: "of 706 points",
            ..CASE
        }
        .row(1.5, 1.0)];
        let page = Page::new(&machine("Fast 9000"), &rows).markdown();
        for part in [
            "1. Fast 9000, 2 threads, AVX2",
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
    fn merged_page_keeps_other_rows_and_names_both_machines() {
        let other = Case {
            case: "periodic, 1 M points",
            note: "of a million points, 3. and last",
            ..CASE
        };
        let third = Case {
            group: "worley",
            case: "F1, F2",
            ..CASE
        };
        let old = Page::new(
            &machine("Fast 9000"),
            &[CASE.row(1.0, 1.0), other.row(1.0, 1.0)],
        );
        assert_eq!(
            Page::read(&old.markdown()),
            old,
            "a page is read as written"
        );
        let new = Page::new(
            &machine("Slow 1"),
            &[CASE.row(9.0, 1.0), third.row(1.0, 2.0)],
        );
        assert!(old.has(&other) && !old.has(&third));
        let merged = Page::read(&old.markdown()).merged(new);
        assert_eq!(merged.machines.len(), 2);
        let on: Vec<&str> = merged.lines.iter().map(|line| &*line.cells[8]).collect();
        assert_eq!(on, ["2", "1", "2"], "replaced, kept, added");
        assert_eq!(merged.lines[0].cells[7], "NO");
        assert_eq!(merged.lines[1], old.lines[1], "with its note");
        assert_eq!(Page::read(&merged.markdown()), merged);
        let again = Page::new(&machine("Fast 9000"), &[CASE.row(1.0, 1.0)]);
        assert_eq!(merged.merged(again).machines.len(), 2, "a known machine");
    }

    #[test]
    fn results_in_the_repository_are_read_in_full() {
        let text = include_str!("../RESULTS.md");
        let page = Page::read(text);
        assert!(page.lines.len() > 100 && !page.machines.is_empty());
        assert_eq!(page.markdown(), text);
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
