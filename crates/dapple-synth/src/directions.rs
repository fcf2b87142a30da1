//! Directions as text: lines of numbers (CSV), and JSON behind the feature `json`. No file is touched here.

use crate::{Direction, SynthError, SynthErrorKind};
use glam::DVec3;

/// The numbers of a line: a position and a vector.
const N_FIELDS: usize = 6;

impl Direction {
    /// Reads directions from lines `x,y,z,dx,dy,dz`: a position and a vector.
    ///
    /// Blank lines and lines that begin with `#` are left out, and so is the first other line if none of its fields is a
    /// number.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Text`] with the number of the line that does not have six finite numbers.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_synth::Direction;
    ///
    /// let directions = Direction::parse_csv("x,y,z,dx,dy,dz\n# the nose\n0, 1, 2,  0, 0, -1\n")?;
    /// assert_eq!(directions[0].vector.z, -1.0);
    /// # Ok::<(), dapple_synth::SynthError>(())
    /// ```
    pub fn parse_csv(text: &str) -> Result<Vec<Self>, SynthError> {
        let mut directions = Vec::new();
        let mut may_be_header = true;
        // Some editors put a byte order mark before the first line.
        let text = text.trim_start_matches('\u{feff}');
        for (line, row) in (1..).zip(text.lines()) {
            let row = row.trim();
            if row.is_empty() || row.starts_with('#') {
                continue;
            }
            let is_header = row
                .split(',')
                .all(|field| field.trim().parse::<f64>().is_err());
            if may_be_header && is_header {
                may_be_header = false;
                continue;
            }
            may_be_header = false;
            directions.push(parse_row(row, line)?);
        }
        Ok(directions)
    }

    /// Reads directions from a JSON array of objects such as `{"at": [0, 1, 2], "vector": [0, 0, -1]}`.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Text`] with the number of the line that is not as it should be.
    #[cfg(feature = "json")]
    pub fn parse_json(text: &str) -> Result<Vec<Self>, SynthError> {
        serde_json::from_str(text).map_err(|error| refused("JSON", error.line(), error.to_string()))
    }
}

fn parse_row(row: &str, line: usize) -> Result<Direction, SynthError> {
    let mut numbers = [0.0; N_FIELDS];
    let mut count = 0;
    for field in row.split(',').map(str::trim) {
        let Some(number) = field
            .parse::<f64>()
            .ok()
            .filter(|number| number.is_finite())
        else {
            return Err(refused(
                "CSV",
                line,
                format!("{field:?} is not a finite number"),
            ));
        };
        if let Some(place) = numbers.get_mut(count) {
            *place = number;
        }
        count += 1;
    }
    if count != N_FIELDS {
        return Err(refused(
            "CSV",
            line,
            format!("there are {count} numbers, but 6 are needed"),
        ));
    }
    let [x, y, z, dx, dy, dz] = numbers;
    Ok(Direction {
        at: DVec3::new(x, y, z),
        vector: DVec3::new(dx, dy, dz),
    })
}

fn refused(format: &'static str, line: usize, why: String) -> SynthError {
    SynthError::new(SynthErrorKind::Text { format, line, why })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line_of(error: &SynthError) -> usize {
        match error.kind() {
            SynthErrorKind::Text { line, .. } => *line,
            kind => panic!("{kind:?}"),
        }
    }

    #[test]
    fn csv_gives_positions_and_vectors_with_and_without_a_header() {
        let rows = "# made by hand\n1,2,3,4,5,6\n\n  # more\n -1e2 , 0.5,0, 0,0,1 \r\n";
        let plain = Direction::parse_csv(rows).unwrap();
        let headed = Direction::parse_csv(&format!("\u{feff}x,y,z,dx,dy,dz\n{rows}")).unwrap();
        assert_eq!(plain, headed);
        assert_eq!(plain.len(), 2);
        assert_eq!(plain[0].vector, DVec3::new(4.0, 5.0, 6.0));
        assert_eq!(plain[1].at, DVec3::new(-100.0, 0.5, 0.0));
    }

    #[test]
    fn csv_of_nothing_has_no_directions() {
        for text in ["", "\n\n", "# only words", "x,y,z,dx,dy,dz"] {
            assert_eq!(Direction::parse_csv(text), Ok(vec![]), "{text:?}");
        }
    }

    #[test]
    fn csv_errors_name_the_line() {
        for (text, line) in [
            ("x,y\nx,y\n", 2),
            ("1,2,3,4,5", 1),
            ("# a\n1,2,3,4,5,6,7", 2),
            ("1,2,3,4,5,6\n1,2,3,4,5,\n", 2),
            ("1,2,3,4,5,NaN", 1),
            ("1,2,3,4,5,6\n\n1,2,inf,4,5,6", 3),
            ("x,y,3", 1),
            ("1;2;3;4;5;6\n7;8;9;1;2;3", 2),
        ] {
            let error = Direction::parse_csv(text).unwrap_err();
            assert_eq!(line_of(&error), line, "{text:?}: {error}");
        }
        let error = Direction::parse_csv("1,2,3,4,5,six").unwrap_err();
        assert_eq!(
            error.to_string(),
            "line 1 of the CSV: \"six\" is not a finite number"
        );
    }

    #[cfg(feature = "json")]
    #[test]
    fn json_gives_positions_and_vectors_and_errors_name_the_line() {
        let text = r#"[{"at": [1, 2, 3], "vector": [0, 0.5, -1e1]}]"#;
        let directions = Direction::parse_json(text).unwrap();
        assert_eq!(directions[0].at, DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(directions[0].vector, DVec3::new(0.0, 0.5, -10.0));
        assert_eq!(Direction::parse_json("[]"), Ok(vec![]));
        for (text, line) in [
            ("[\n{\"at\": [1, 2], \"vector\": [0, 0, 1]}]", 2),
            ("[\n\n{\"at\": [1, 2, 3]}]", 3),
            ("[1e999]", 1),
            ("{}", 1),
            ("[", 1),
        ] {
            let error = Direction::parse_json(text).unwrap_err();
            assert_eq!(line_of(&error), line, "{text:?}: {error}");
        }
    }
}
