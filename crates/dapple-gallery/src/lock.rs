//! The file `figures.lock`: a hash of every figure at one small size, which detects any change to a figure.
//!
//! A line is `<hash> <name>`, lines are sorted by name, and `#` begins a comment. The hash is FNV-1a in 64 bits (Glenn
//! Fowler, Landon Curt Noll and Kiem-Phong Vo; <https://www.rfc-editor.org/rfc/rfc9923>). It covers for each panel: its
//! label in UTF-8 and a zero byte, its width and height (`u32`, little-endian), its number of channels (one byte), and
//! its pixels as in the 8-bit file.

use crate::Panel;
use core::fmt;
use std::collections::BTreeMap;

/// Size at which figures are hashed, in pixels along the longer side of an image.
pub const LOCK_SIZE: u32 = 128;

const COMMENT: &str = "# FNV-1a of every figure's 8-bit pixels at 128 px. Accept changes with `cargo xtask gallery --bless`.";

/// Hash of a figure's images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hash(pub u64);

/// The hashes in `figures.lock`, keyed by figure name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lock {
    hashes: BTreeMap<String, Hash>,
}

/// A difference between a lock and the current figures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Change {
    /// The figure is not in the lock.
    New(String),
    /// The hash of the figure differs from the lock.
    Changed(String),
    /// The lock has a line for a figure that does not exist.
    Gone(String),
}

impl Lock {
    /// Parses the text of a lock.
    ///
    /// # Errors
    ///
    /// If a line is not a hash of 16 hexadecimal digits and a name, or if a name occurs twice.
    pub fn parse(text: &str) -> anyhow::Result<Self> {
        let mut hashes = BTreeMap::new();
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            let (hash, name) = parse_line(line).ok_or_else(|| {
                anyhow::anyhow!("figures.lock has the line `{line}`, which is not `<hash> <name>`")
            })?;
            anyhow::ensure!(
                hashes.insert(name.to_owned(), hash).is_none(),
                "figures.lock names `{name}` twice"
            );
        }
        Ok(Self { hashes })
    }

    /// Records a figure's hash, replacing an older one.
    pub fn insert(&mut self, name: String, hash: Hash) {
        self.hashes.insert(name, hash);
    }

    /// Removes every figure for whose name `keep` returns false.
    pub fn retain(&mut self, mut keep: impl FnMut(&str) -> bool) {
        self.hashes.retain(|name, _| keep(name));
    }

    /// Returns the recorded hash of the figure called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<Hash> {
        self.hashes.get(name).copied()
    }

    /// Returns the changes from `self` to `now`, sorted by name.
    #[must_use]
    pub fn changes(&self, now: &Self) -> Vec<Change> {
        let gone = self.hashes.keys().filter(|name| now.get(name).is_none());
        let mut changes: Vec<_> = gone.cloned().map(Change::Gone).collect();
        for (name, &hash) in &now.hashes {
            match self.get(name) {
                None => changes.push(Change::New(name.clone())),
                Some(old) if old != hash => changes.push(Change::Changed(name.clone())),
                Some(_) => {}
            }
        }
        changes.sort_by(|a, b| a.name().cmp(b.name()));
        changes
    }
}

impl Change {
    /// Returns the name of the figure.
    #[must_use]
    pub fn name(&self) -> &str {
        let (Self::New(name) | Self::Changed(name) | Self::Gone(name)) = self;
        name
    }
}

/// Formats the lock as the text of `figures.lock`.
impl fmt::Display for Lock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{COMMENT}")?;
        self.hashes
            .iter()
            .try_for_each(|(name, hash)| writeln!(f, "{hash} {name}"))
    }
}

impl fmt::Display for Hash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::New(name) => write!(f, "new      {name}"),
            Self::Changed(name) => write!(f, "changed  {name}"),
            Self::Gone(name) => write!(f, "gone     {name}"),
        }
    }
}

/// Returns the hash of a sequence of images.
#[must_use]
pub fn hash_panels(panels: &[Panel]) -> Hash {
    let mut hash = Fnv::default();
    for panel in panels {
        hash.write(panel.label.as_bytes());
        hash.write(&[0]);
        panel
            .size()
            .iter()
            .for_each(|side| hash.write(&side.to_le_bytes()));
        hash.write(&[panel.n_channels()]);
        hash.write(&panel.bytes());
    }
    Hash(hash.0)
}

fn parse_line(line: &str) -> Option<(Hash, &str)> {
    let (hash, name) = line.split_once(' ')?;
    let digits = hash.len() == 16 && hash.bytes().all(|digit| digit.is_ascii_hexdigit());
    let value = u64::from_str_radix(hash, 16)
        .ok()
        .filter(|_| digits && !name.is_empty())?;
    Some((Hash(value), name))
}

/// A hasher for FNV-1a in 64 bits.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Change, Fnv, Hash, Lock, hash_panels};
    use crate::Panel;
    use dapple_raster::Raster;

    #[test]
    fn fnv_gives_the_published_values() {
        // Test vectors from RFC 9923 and its reference code.
        for (text, value) in [
            ("", 0xcbf2_9ce4_8422_2325),
            ("a", 0xaf63_dc4c_8601_ec8c),
            ("foobar", 0x8594_4171_f739_67e8),
        ] {
            let mut hash = Fnv::default();
            hash.write(text.as_bytes());
            assert_eq!(hash.0, value, "{text}");
        }
    }

    #[test]
    fn lock_text_is_read_back_sorted() {
        let text = "# comment\n00000000000000ff b\n0123456789abcdef a\n";
        let lock = Lock::parse(text).unwrap();
        assert_eq!(lock.get("b"), Some(Hash(255)));
        let written = lock.to_string();
        assert!(
            written.ends_with("\n0123456789abcdef a\n00000000000000ff b\n"),
            "{written}"
        );
        assert_eq!(Lock::parse(&written).unwrap(), lock);
    }

    #[test]
    fn lock_refuses_lines_that_are_no_hash_and_name() {
        for bad in [
            "ff a",
            "0123456789abcdef",
            "0123456789abcdef ",
            "+123456789abcdef a",
            "",
        ] {
            assert!(
                Lock::parse(&format!("{bad}\n")).is_err(),
                "`{bad}` was taken"
            );
        }
        let twice = "0123456789abcdef a\n0123456789abcdef a\n";
        assert!(Lock::parse(twice).is_err(), "a name came twice");
    }

    #[test]
    fn changes_name_new_changed_and_gone_figures() {
        let [mut old, mut new] = [Lock::default(), Lock::default()];
        for (name, hash) in [("same", 1), ("other", 2), ("lost", 3)] {
            old.insert(name.into(), Hash(hash));
        }
        for (name, hash) in [("same", 1), ("other", 4), ("fresh", 5)] {
            new.insert(name.into(), Hash(hash));
        }
        let changes = old.changes(&new);
        let expected = [
            Change::New("fresh".into()),
            Change::Gone("lost".into()),
            Change::Changed("other".into()),
        ];
        assert_eq!(changes, expected);
    }

    #[test]
    fn hash_sees_label_size_and_pixels() {
        let panel = |label, size, value| {
            hash_panels(&[Panel::gray(label, Raster::filled(size, value).unwrap())])
        };
        let plain = panel("", [2, 3], 0.5);
        assert_eq!(plain, panel("", [2, 3], 0.5));
        for other in [
            panel("x", [2, 3], 0.5),
            panel("", [3, 2], 0.5),
            panel("", [2, 3], 0.6),
        ] {
            assert_ne!(plain, other);
        }
    }
}
