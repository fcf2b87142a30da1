//! Tests of misspelled words and the suggestions for them.

use dapple_recipe::similar_words;

#[test]
fn the_nearest_word_is_that_of_a_slip_and_no_other() {
    let words = ["weight", "height", "normal"];
    for (typed, expected) in [
        ("weigth", Some(&"weight")),
        ("Hight", Some(&"height")),
        ("normals", Some(&"normal")),
        ("roughness", None),
    ] {
        assert_eq!(similar_words(typed, words).first(), expected, "{typed}");
    }
}
