//! Parses tables of numbers with named columns (CSV), for directions and control points.
//!
//! Numbers use a decimal point, and columns are separated by commas. With a header, the columns may be in any order.

use crate::{SynthError, SynthErrorKind};
use dapple_raster::text::decode;

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TableRow {
    /// Line number in the text, from 1.
    pub line: usize,
    /// The numbers, in the order of the form's column names.
    pub numbers: Vec<f64>,
}

/// Parses rows of numbers separated by commas. Each row must match one of the `forms`, which are lists of column names.
///
/// A byte order mark, blank lines, and lines that begin with `#` are ignored. If no field of the first remaining line
/// is a number, that line is a header. It must have the names of one form, in any order and in upper or lower case, and
/// determines the order of the columns. Without a header, or if the header is in the order of its form, each row may
/// have the columns of any form.
///
/// # Errors
///
/// [`SynthErrorKind::Text`], with the line number, if a header is invalid or a row does not consist of finite numbers.
/// The reason points out semicolons, tabs, quotes and decimal commas.
///
/// # Examples
///
/// ```
/// let text = "value,y,x\n0.5, 2, 1\n";
/// let rows = dapple_synth::parse_table(text, &[&["x", "y", "value"]])?;
/// assert_eq!(rows[0].numbers, [1.0, 2.0, 0.5]);
/// # Ok::<(), dapple_synth::SynthError>(())
/// ```
pub fn parse_table(text: &str, forms: &[&[&str]]) -> Result<Vec<TableRow>, SynthError> {
    let text = decode(text.as_bytes()).map_err(|error| refused(1, error.to_string()))?;
    let lines = (1..).zip(text.lines().map(str::trim));
    let mut lines = lines.filter(|(_, row)| !row.is_empty() && !row.starts_with('#'));
    let mut order = None;
    let mut rows = Vec::new();
    let Some((line, first)) = lines.next() else {
        return Ok(rows);
    };
    if fields(first).all(|field| field.parse::<f64>().is_err()) {
        let columns = header(first, forms).map_err(|why| refused(line, why))?;
        // A header in the order of its form has no effect; rows may then have the columns of another form.
        order = (!columns.is_sorted()).then_some(columns);
    } else {
        let numbers = numbers(first, None, forms).map_err(|why| refused(line, why))?;
        rows.push(TableRow { line, numbers });
    }
    for (line, row) in lines {
        let numbers = numbers(row, order.as_deref(), forms).map_err(|why| refused(line, why))?;
        rows.push(TableRow { line, numbers });
    }
    Ok(rows)
}

fn fields(row: &str) -> impl Iterator<Item = &str> {
    row.split(',').map(str::trim)
}

/// Returns, for each name of the matching form, its column in the header.
fn header(row: &str, forms: &[&[&str]]) -> Result<Vec<usize>, String> {
    let names: Vec<_> = fields(row).collect();
    let place = |name: &&str| {
        let mut found = names.iter().enumerate();
        let (place, _) = found.find(|(_, other)| other.eq_ignore_ascii_case(name))?;
        Some(place)
    };
    let mut orders = forms.iter().filter(|form| form.len() == names.len());
    let order = orders.find_map(|form| form.iter().map(place).collect());
    order.ok_or_else(|| match odd_separator(row) {
        Some(why) => why,
        None => format!("the columns are {row}, but {} are needed", list(forms)),
    })
}

/// Returns the numbers of a row, reordered according to the header if there is one.
fn numbers(row: &str, order: Option<&[usize]>, forms: &[&[&str]]) -> Result<Vec<f64>, String> {
    let mut numbers = Vec::new();
    for field in fields(row) {
        let number = field
            .parse::<f64>()
            .ok()
            .filter(|number| number.is_finite());
        let Some(number) = number else {
            let odd = odd_separator(row);
            return Err(odd.unwrap_or_else(|| format!("{field:?} is not a finite number")));
        };
        numbers.push(number);
    }
    // Check the number of columns.
    let count = numbers.len();
    let is_known = match order {
        Some(order) => order.len() == count,
        None => forms.iter().any(|form| form.len() == count),
    };
    if !is_known {
        let needed = match order {
            Some(order) => format!("the header has {}", order.len()),
            None => format!("{} are needed", list(forms)),
        };
        // Decimal commas double the number of fields.
        let is_double = forms.iter().any(|form| 2 * form.len() == count);
        let cure = if is_double {
            "; decimals are written with a point, and not with a comma"
        } else {
            ""
        };
        return Err(format!("there are {count} numbers, but {needed}{cure}"));
    }
    Ok(match order {
        Some(order) => order.iter().map(|&place| numbers[place]).collect(),
        None => numbers,
    })
}

/// Returns the reason that a line is not separated by commas, if it contains another separator or quotes.
fn odd_separator(row: &str) -> Option<String> {
    let found = match row.chars().find(|c| ";\t\"'|".contains(*c))? {
        ';' => "semicolons",
        '\t' => "tabs",
        '|' => "bars",
        _ => return Some("there are quotes, but numbers and names have none".to_owned()),
    };
    let decimals = if row.contains(',') {
        ", and decimals are written with a point, and not with a comma"
    } else {
        ""
    };
    Some(format!(
        "the columns are separated by {found}, but commas are needed{decimals}"
    ))
}

/// Returns a list of the columns of all forms, formatted as headers.
fn list(forms: &[&[&str]]) -> String {
    let forms: Vec<_> = forms.iter().map(|form| form.join(",")).collect();
    forms.join(" or ")
}

fn refused(line: usize, why: String) -> SynthError {
    let format = "CSV";
    SynthError::new(SynthErrorKind::Text { format, line, why })
}

#[cfg(test)]
mod tests {
    use super::parse_table;

    const FORMS: [&[&str]; 2] = [&["x", "y", "value"], &["x", "y", "value", "ox", "oy"]];

    fn numbers(text: &str) -> Vec<Vec<f64>> {
        let rows = parse_table(text, &FORMS).unwrap();
        rows.into_iter().map(|row| row.numbers).collect()
    }

    #[test]
    fn columns_have_the_order_of_the_header() {
        let plain = numbers("x,y,value\n0.25,0.5,1\n3,4,5\n");
        assert_eq!(plain, [[0.25, 0.5, 1.0], [3.0, 4.0, 5.0]]);
        for permuted in [
            "value,y,x\n1,0.5,0.25\n5,4,3\n",
            "# by hand\n\n Y , VALUE , X\n0.5,1,0.25\n# more\n4,5,3",
            "0.25,0.5,1\n3,4,5",
            "\u{feff}value,x,y\r\n1,0.25,0.5\r\n5,3,4\r\n",
            "\u{feff}0.25,0.5,1\n3,4,5",
        ] {
            assert_eq!(numbers(permuted), plain, "{permuted:?}");
        }
        assert_eq!(numbers("x,y,value\n1,2,3,4,5"), [[1.0, 2.0, 3.0, 4.0, 5.0]]);
        assert_eq!(
            numbers("ox,oy,x,y,value\n4,5,1,2,3"),
            [[1.0, 2.0, 3.0, 4.0, 5.0]]
        );
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, line, part) in [
            (
                "x,y,level\n1,2,3",
                1,
                "the columns are x,y,level, but x,y,value or x,y,value,ox,oy are needed",
            ),
            ("x,y\n1,2", 1, "the columns are x,y, but"),
            ("x,x,value\n1,2,3", 1, "the columns are x,x,value"),
            ("x;y;value\n1;2;3", 1, "semicolons"),
            ("1;2;3", 1, "semicolons"),
            (
                "# a\n0,25;0,25;0,1",
                2,
                "semicolons, but commas are needed, and decimals are written with a point",
            ),
            ("x,y,value\n1\t2\t3", 2, "tabs"),
            ("0,25\t0,25\t0,1", 1, "decimals are written with a point"),
            ("\"x\",\"y\",\"value\"\n1,2,3", 1, "quotes"),
            ("1,2,\"3\"", 1, "quotes"),
            (
                "0,25,0,25,0,1",
                1,
                "there are 6 numbers, but x,y,value or x,y,value,ox,oy are needed; decimals are written with a point",
            ),
            (
                "y,x,value\n1,2,3,4,5",
                2,
                "there are 5 numbers, but the header has 3",
            ),
            ("1,2", 1, "there are 2 numbers"),
            ("1,2,3\nx,y,value", 2, "\"x\" is not a finite number"),
            ("1,2,", 1, "\"\" is not a finite number"),
            ("nan,1,2", 1, "not a finite number"),
        ] {
            let error = parse_table(text, &FORMS).unwrap_err().to_string();
            let (place, why) = error.split_once(": ").unwrap();
            assert_eq!(
                place,
                format!("line {line} of the CSV"),
                "{text:?}: {error}"
            );
            assert!(why.contains(part), "{text:?} names {part:?}: {error}");
        }
    }
}
