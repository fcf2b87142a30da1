//! Moves the numbers of a material's shader to an array, so that recipes that differ in numbers alone share a text.
//!
//! The nodes write literals. This pass reads their text once more and replaces each literal that stands for a value of
//! the recipe by a word of the array. Numbers that belong to the structure stay: lengths of arrays, and numbers of octaves,
//! sectors and layers.

use std::collections::BTreeMap;

/// Name of the array.
const ARRAY: &str = "shader_numbers";

/// A zero as nodes write it. Zero is a value as any other in the array.
const ZERO: &str = "number(0.0, zero)";

/// Returns code without its numbers, and the words of the array, in whole vectors of four.
pub(super) fn moved(code: &str) -> (String, Vec<u32>) {
    let mut numbers = Numbers::default();
    let mut rest = String::new();
    // A constant cannot read the array, so its value replaces its name.
    for line in code.lines() {
        match constant(line) {
            Some((name, value)) => {
                let value = numbers.code(value, true);
                numbers.constants.insert(name, value);
            }
            None => {
                rest += line;
                rest.push('\n');
            }
        }
    }
    let code = numbers.code(&rest, false);
    let mut words = numbers.words;
    words.resize(words.len().next_multiple_of(4), 0);
    (code, words)
}

/// Splits the declaration of a constant of the module into its name and its value.
fn constant(line: &str) -> Option<(&str, &str)> {
    let declaration = line.strip_prefix("const ")?;
    declaration.strip_suffix(';')?.split_once(" = ")
}

#[derive(Default)]
struct Numbers<'a> {
    words: Vec<u32>,
    /// Values of constants, by name.
    constants: BTreeMap<&'a str, String>,
}

impl Numbers<'_> {
    /// Returns code without its numbers and comments. In the value of a constant, integers are numbers, too.
    fn code(&mut self, code: &str, is_constant: bool) -> String {
        let mut out = String::new();
        // Whether an integer is the index of a texel, which depends on the data of other nodes: the arguments after `data`
        let mut is_index = false;
        let mut rest = code;
        while !rest.is_empty() {
            let (token, after) = rest.split_at(length(rest, &out));
            rest = after;
            if token.starts_with("//") {
                continue;
            }
            let value = match token {
                ZERO => Some(self.number(0.0)),
                _ => self.literal(token, is_constant || is_index),
            };
            is_index = match token {
                "data" => true,
                "," | " " | "(" | "vec2" | "0u" => is_index,
                _ => is_index && value.is_some(),
            };
            let value = value.or_else(|| self.constants.get(token).cloned());
            out += value.as_deref().unwrap_or(token);
        }
        out
    }

    /// Returns the expression of a literal in the array; `None` if the token stays.
    fn literal(&mut self, token: &str, has_integers: bool) -> Option<String> {
        let digits = token.strip_prefix('-').unwrap_or(token);
        if !digits.starts_with(|c: char| c.is_ascii_digit()) {
            return None;
        }
        if let Some(integer) = token.strip_suffix('u') {
            return match integer.strip_prefix("0x") {
                Some(hexadecimal) => Some(self.word(u32::from_str_radix(hexadecimal, 16).ok()?)),
                // Zeros stay. They mean none, such as no period, and save compilers a division.
                None => {
                    let word = integer.parse().ok().filter(|&word| word != 0)?;
                    has_integers.then(|| self.word(word))
                }
            };
        }
        if token.starts_with("0x") || !token.contains(['.', 'e']) {
            return None;
        }
        // Compilers read decimals as numbers of 64 bits, and round these.
        let number = token.parse::<f64>().ok()?;
        Some(self.number(number as f32))
    }

    fn number(&mut self, number: f32) -> String {
        format!("bitcast<f32>({})", self.word(number.to_bits()))
    }

    fn word(&mut self, word: u32) -> String {
        let at = self.words.len();
        self.words.push(word);
        format!("{ARRAY}[{}].{}", at / 4, ["x", "y", "z", "w"][at % 4])
    }
}

/// Returns the length of the first token of `code`: a comment, a word, a number with its sign, [`ZERO`], or a single
/// character. `before` is the code before it.
fn length(code: &str, before: &str) -> usize {
    if code.starts_with(ZERO) {
        return ZERO.len();
    }
    if code.starts_with("//") {
        return code.find('\n').unwrap_or(code.len());
    }
    // A minus after an operand is a difference.
    let before = before.trim_end();
    let is_sign = before.ends_with(['(', ',', '=', '<', '>', '{']) || before.ends_with("return");
    let sign = usize::from(is_sign && code.starts_with('-'));
    let digits = &code[sign..];
    if !digits.starts_with(|c: char| c.is_ascii_digit()) {
        let end = code.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
        let first = code.chars().next().map_or(0, char::len_utf8);
        return end.unwrap_or(code.len()).max(first);
    }
    let mut last = ' ';
    let is_hexadecimal = digits.starts_with("0x");
    let end = digits.find(|c: char| {
        let is_exponent = last == 'e' && !is_hexadecimal && (c == '-' || c == '+');
        last = c;
        !(c.is_ascii_alphanumeric() || c == '.' || is_exponent)
    });
    sign + end.unwrap_or(digits.len())
}

#[cfg(test)]
mod tests {
    use super::moved;

    #[test]
    fn values_become_words_and_structure_stays() {
        let code = "\
            // A height of 0.25
            fn f(x: f32, data: texture_2d<u32>) -> f32 {\n\
            let a = g(data, 12u, 3u, x - 1.5, -2e-7, number(0.0, zero)); // 9.5\n\
            let b = h(data, vec2(0u, 8u), NOISE_0, 5u, vec2(0x3ff00000u, 0x0u));\n\
            var parts: array<f32, 3>; return -0.5; }\n\
            const NOISE_0 = Noise(vec4(96u, 0u), 1.0);\n";
        let (text, words) = moved(code);
        let numbers = [1.5, -2e-7, 0.0].map(f32::to_bits);
        let expected = [
            &[96, 1.0_f32.to_bits(), 12, 3][..],
            &numbers,
            &[8, 0x3ff0_0000, 0, (-0.5_f32).to_bits(), 0],
        ];
        assert_eq!(words, expected.concat());
        let axes = ["x", "y", "z", "w"];
        let w = |at: usize| format!("shader_numbers[{}].{}", at / 4, axes[at % 4]);
        let n = |at: usize| format!("bitcast<f32>({})", w(at));
        let expected = [
            format!(
                "let a = g(data, {}, {}, x - {}, {}, {});",
                w(2),
                w(3),
                n(4),
                n(5),
                n(6)
            ),
            format!(
                "let b = h(data, vec2(0u, {}), Noise(vec4({}, 0u), {}), 5u, vec2({}, {}));",
                w(7),
                w(0),
                n(1),
                w(8),
                w(9)
            ),
            format!("var parts: array<f32, 3>; return {}; }}", n(10)),
        ];
        let lines: Vec<_> = text.lines().map(str::trim).collect();
        assert_eq!(lines[2..], expected, "{text}");
    }
}
