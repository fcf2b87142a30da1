//! Search for misspelled words.

/// The smallest similarity of two words, from 0 to 1, at which one may be a misspelling of the other.
const ALIKE: f64 = 0.6;

/// The valid words of which the written one may be a misspelling, the most similar first.
///
/// Insertions, omissions, changes and swaps of neighboring letters are counted (the distance of Damerau and Levenshtein), and
/// related to the length of the longer word; case does not matter.
///
/// # Examples
///
/// ```
/// use dapple_recipe::similar_words;
///
/// assert_eq!(similar_words("hieght", ["weight", "normal", "height"]), ["height", "weight"]);
/// ```
#[must_use]
pub fn similar_words<'a>(written: &str, valid: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let written = written.to_lowercase();
    let alike = |word: &str| strsim::normalized_damerau_levenshtein(&written, &word.to_lowercase());
    let words = valid.into_iter().map(|word| (alike(word), word));
    let mut words: Vec<_> = words.filter(|&(alike, _)| alike >= ALIKE).collect();
    words.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    words.into_iter().map(|(_, word)| word).collect()
}
