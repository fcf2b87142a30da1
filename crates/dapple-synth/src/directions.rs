//! Parses directions from text: CSV, and JSON with the feature `json`. This module does not access files.

#[cfg(feature = "json")]
use crate::SynthErrorKind;
use crate::{Direction, SynthError, TableRow, parse_table};
#[cfg(feature = "json")]
use dapple_raster::text::decode;
use glam::DVec3;

/// Column names of the CSV: a position and a vector.
const COLUMNS: [&str; 6] = ["x", "y", "z", "dx", "dy", "dz"];

impl Direction {
    /// Parses directions from CSV lines `x,y,z,dx,dy,dz`, each a position and a vector.
    ///
    /// Blank lines and lines that start with `#` are skipped. If no field of the first remaining line is a number, the
    /// line is a header that defines the order of the columns.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Text`](crate::SynthErrorKind::Text), with the line number, if the header is wrong or a line
    /// does not have six finite numbers.
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
        let rows = parse_table(text, &[&COLUMNS])?.into_iter();
        let direction = |row: TableRow| {
            let [x, y, z, dx, dy, dz] = row.numbers[..] else {
                return None;
            };
            Some(Self {
                at: DVec3::new(x, y, z),
                vector: DVec3::new(dx, dy, dz),
            })
        };
        // `parse_table` gives every row six numbers.
        Ok(rows.filter_map(direction).collect())
    }

    /// Parses directions from a JSON array of objects such as `{"at": [0, 1, 2], "vector": [0, 0, -1]}`.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Text`](crate::SynthErrorKind::Text), with the line number, if a line is invalid.
    #[cfg(feature = "json")]
    pub fn parse_json(text: &str) -> Result<Vec<Self>, SynthError> {
        let text = decode(text.as_bytes());
        let text = text.map_err(|error| refused("JSON", 1, error.to_string()))?;
        serde_json::from_str(text).map_err(|error| refused("JSON", error.line(), error.to_string()))
    }
}

#[cfg(feature = "json")]
fn refused(format: &'static str, line: usize, why: String) -> SynthError {
    SynthError::new(SynthErrorKind::Text { format, line, why })
}

#[cfg(test)]
mod tests {
    use super::Direction;
    use crate::{SynthError, SynthErrorKind};
    use glam::DVec3;

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
        let permuted = "dx,dy,dz,x,y,z\n4,5,6,1,2,3\n0,0,1,-1e2,0.5,0\n";
        assert_eq!(Direction::parse_csv(permuted).unwrap(), plain);
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
            ("x,y\nx,y\n", 1),
            ("a,b,c,d,e,f\n1,2,3,4,5,6", 1),
            ("1,2,3,4,5", 1),
            ("# a\n1,2,3,4,5,6,7", 2),
            ("1,2,3,4,5,6\n1,2,3,4,5,\n", 2),
            ("1,2,3,4,5,NaN", 1),
            ("1,2,3,4,5,6\n\n1,2,inf,4,5,6", 3),
            ("x,y,3", 1),
            ("1;2;3;4;5;6\n7;8;9;1;2;3", 1),
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
        let marked = format!("\u{feff}{text}");
        assert_eq!(Direction::parse_json(&marked), Ok(directions));
        let wide: String = text.chars().flat_map(|c| ['\0', c]).collect();
        let error = Direction::parse_json(&wide).unwrap_err().to_string();
        assert!(
            error.contains("the text is UTF-16, but must be UTF-8"),
            "{error}"
        );
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
