//! Suggests valid words for misspelled ones.

/// Minimum similarity, from 0 to 1, at which a word is suggested for another one.
const ALIKE: f64 = 0.6;

/// Returns the valid words that are similar to a misspelled one, most similar first.
///
/// The similarity is one minus the Damerau–Levenshtein distance (insertions, omissions, changes, and swaps of
/// neighboring letters) divided by the length of the longer word; words of at least 0.6 are returned. Case is ignored.
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
