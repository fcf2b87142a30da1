//! Reads control points from files, which have CSV lines `x,y,value` or `x,y,value,ox,oy`, or JSON lists of objects.

use crate::input;
use anyhow::{Context as _, Result, bail};
use dapple::pups::glam::DVec3;
use dapple::recipe::ControlPoint;
use dapple::synth::{TableRow, parse_table};
use std::path::Path;

/// Reads control points; `-` is standard input. Text that begins with `[` is JSON.
///
/// # Errors
///
/// If the file does not exist, or has an invalid line. The message names the line.
pub(crate) fn read(path: &Path) -> Result<Vec<ControlPoint>> {
    let text = input::text(path)?;
    let points = if text.trim_start().starts_with('[') {
        serde_json::from_str(&text).context("this is no list of control points in JSON")
    } else {
        csv(&text)
    };
    let points = points.with_context(|| input::name(path))?;
    if points.is_empty() {
        bail!("{} has no control points", input::name(path));
    }
    Ok(points)
}

/// Column names of CSV files, without and with an orientation.
const FORMS: [&[&str]; 2] = [&["x", "y", "value"], &["x", "y", "value", "ox", "oy"]];

/// Parses control points in CSV.
fn csv(text: &str) -> Result<Vec<ControlPoint>> {
    let rows = parse_table(text, &FORMS)?.into_iter();
    rows.map(|row| point(&row)).collect()
}

fn point(row: &TableRow) -> Result<ControlPoint> {
    let TableRow { line, numbers, .. } = row;
    // Refuse numbers that overflow in single precision, in which values are stored.
    if let Some(number) = numbers.iter().find(|&&number| !(number as f32).is_finite()) {
        bail!("line {line}: {number:e} is too large");
    }
    let (x, y, value, orientation) = match numbers[..] {
        [x, y, value] => (x, y, value, None),
        [x, y, value, ox, oy] => (x, y, value, Some(DVec3::new(ox, oy, 0.0))),
        _ => bail!("line {line} has {} numbers", numbers.len()),
    };
    Ok(ControlPoint {
        x,
        y,
        value: Some(value as f32),
        orientation,
        ..ControlPoint::default()
    })
}

#[cfg(test)]
mod tests {
    use super::csv;
    use dapple::pups::glam::DVec3;

    #[test]
    fn control_points_have_three_or_five_numbers() {
        let points = csv("x,y,value\n# a comment\n0.5,1,0.25\n\n1, 2, 3, 0, -1\n").unwrap();
        assert_eq!(
            (points[0].x, points[0].y, points[0].value),
            (0.5, 1.0, Some(0.25))
        );
        assert_eq!(points[1].orientation, Some(DVec3::NEG_Y));
    }

    #[test]
    fn a_line_that_is_no_control_point_is_named() {
        for text in [
            "0,0,0\n1,2\n",
            "0,0,0\n1,2,x\n",
            "0,0,0\n1,2,3,4\n",
            "0,0,0\nnan,2,3\n",
            "0,0,0\n1,2,1e39\n",
        ] {
            let error = csv(text).unwrap_err();
            assert!(
                format!("{error:#}").contains("line 2"),
                "{text:?}: {error:#}"
            );
        }
    }
}
