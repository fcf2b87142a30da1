//! Computes the difference between two texts as a list of small changes.

use crate::utf16::Positions;
use serde::{Deserialize, Serialize};

/// A replacement in a text. Positions are UTF-16 code units in the text before all changes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Change {
    /// Start of the replaced part.
    pub from: usize,
    /// End of the replaced part, exclusive.
    pub to: usize,
    /// Text that is inserted instead.
    pub insert: String,
}

/// Returns the changes that turn `old` into `new`. There is one per changed line if both texts have the same number of
/// lines; otherwise there is a single change.
pub(crate) fn changes(old: &str, new: &str) -> Vec<Change> {
    let positions = Positions::new(old);
    let change = |start: usize, old_part: &str, new_part: &str| {
        let (before, after) = ends_in_common(old_part, new_part);
        let [from, to] = positions.span(old, start + before..start + old_part.len() - after);
        let insert = new_part[before..new_part.len() - after].to_owned();
        Change { from, to, insert }
    };
    // Trim the common prefix and suffix of the whole texts.
    let (before, after) = ends_in_common(old, new);
    if before == old.len() && old.len() == new.len() {
        return Vec::new();
    }
    let [old_middle, new_middle] = [old, new].map(|text| &text[before..text.len() - after]);
    // With different numbers of lines, replace the rest in one piece.
    if old_middle.matches('\n').count() != new_middle.matches('\n').count() {
        return vec![change(before, old_middle, new_middle)];
    }
    let mut start = before;
    let mut changes = Vec::new();
    let lines = old_middle
        .split_inclusive('\n')
        .zip(new_middle.split_inclusive('\n'));
    let is_in_pairs =
        old_middle.split_inclusive('\n').count() == new_middle.split_inclusive('\n').count();
    if !is_in_pairs {
        return vec![change(before, old_middle, new_middle)];
    }
    // Otherwise, compare the texts line by line.
    for (old_line, new_line) in lines {
        if old_line != new_line {
            changes.push(change(start, old_line, new_line));
        }
        start += old_line.len();
    }
    changes
}

/// Returns the lengths of the common prefix and the common suffix of two texts, in bytes. The prefix and suffix do not
/// overlap.
fn ends_in_common(old: &str, new: &str) -> (usize, usize) {
    let pairs = old.chars().zip(new.chars());
    let before = pairs
        .take_while(|(a, b)| a == b)
        .map(|(a, _)| a.len_utf8())
        .sum();
    let pairs = old[before..].chars().rev().zip(new[before..].chars().rev());
    let after = pairs
        .take_while(|(a, b)| a == b)
        .map(|(a, _)| a.len_utf8())
        .sum();
    (before, after)
}

#[cfg(test)]
mod tests {
    use super::{Change, changes};
    use proptest::prelude::*;

    fn applied(old: &str, changes: &[Change]) -> String {
        let units: Vec<u16> = old.encode_utf16().collect();
        let mut new = Vec::new();
        let mut at = 0;
        for change in changes {
            assert!(
                at <= change.from && change.from <= change.to,
                "sorted: {changes:?}"
            );
            new.extend_from_slice(&units[at..change.from]);
            new.extend(change.insert.encode_utf16());
            at = change.to;
        }
        new.extend_from_slice(&units[at..]);
        String::from_utf16(&new).unwrap()
    }

    proptest! {
        #[test]
        fn changes_make_the_new_text(old in "[abé𝄞\n]{0,40}", new in "[abé𝄞\n]{0,40}") {
            prop_assert_eq!(applied(&old, &changes(&old, &new)), new);
        }
    }

    #[test]
    fn a_number_is_the_only_thing_that_changes() {
        let change = Change {
            from: 6,
            to: 7,
            insert: "1".to_owned(),
        };
        assert_eq!(
            changes("x = 0.2 # é\ny = 1\n", "x = 0.1 # é\ny = 1\n"),
            [change]
        );
    }

    #[test]
    fn lines_change_apart() {
        let changed = changes("a = 1\nb = 2\nc = 3\n", "a = 9\nb = 2\nc = 7\n");
        assert_eq!(changed.len(), 2);
    }
}
