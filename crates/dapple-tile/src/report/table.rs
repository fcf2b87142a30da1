//! Formats a report as a text table.

use super::{DetailKept, SeamRatio, SeamReport};
use core::fmt;

/// Width of a cell, which fits `1.02 ± 0.05` and the largest ratio.
const CELL: usize = 16;

/// Entry for a quantity that was not measured.
const NOTHING: &str = "-";

impl fmt::Display for SeamReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(
            f,
            "a tile of {width} × {height} pixels: {}",
            if self.passes() {
                "passes"
            } else {
                "does not pass"
            }
        )?;
        for fault in self.faults() {
            writeln!(f, "  ({fault})")?;
        }
        self.write_table(f)
    }
}

impl SeamReport {
    /// Writes the measurements without the verdict.
    pub(super) fn write_table(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<22}", "seam ratio")?;
        for axis in ["x", "y", "both"] {
            write!(f, "{axis:>CELL$}")?;
        }
        for seam in &self.seams {
            write!(f, "\n{:<22}", format!("  at {} px", seam.width))?;
            for ratio in [seam.x, seam.y, seam.both] {
                write!(f, "{:>CELL$}", cell(ratio))?;
            }
        }
        write!(f, "\n{:<22}", "seam stands out by")?;
        for seam in &self.seams {
            let by = seam.stands_out.map_or_else(|| NOTHING.to_owned(), number);
            write!(f, "{:>12}", format!("{} px: {by}", seam.width))?;
        }
        write!(f, "\n{:<22}", "lowest local detail")?;
        write!(f, "{:>CELL$.3}", self.lowest_local_detail)?;
        self.kept.as_ref().map_or(Ok(()), |kept| kept.write(f))
    }
}

impl DetailKept {
    /// Writes the measurements relative to the source. The first one continues the line with the tile's lowest local
    /// detail.
    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let source = format!("of the source {:.3}", self.source_lowest_local_detail);
        write!(f, "  ({source})\n{:<22}", "detail kept")?;
        if self.octaves.is_empty() {
            write!(f, "{NOTHING:>CELL$}")?;
        }
        for (index, kept) in self.octaves.iter().enumerate() {
            // Write three octaves per line, aligned with the columns of the ratios.
            if index > 0 && index % 3 == 0 {
                write!(f, "\n{:<22}", "")?;
            }
            let octave = format!("1/{}: {}", 2_u64 << index, number(*kept));
            write!(f, "{octave:>CELL$}")?;
        }
        let contrast = number(self.contrast);
        write!(f, "\n{:<22}{contrast:>CELL$}", "contrast kept")?;
        let [fine, coarse] = [self.strangeness, self.coarse_strangeness]
            .map(|of| of.map_or_else(|| NOTHING.to_owned(), number));
        write!(
            f,
            "\n{:<22}{fine:>CELL$}  (of 16 px {coarse})",
            "strangeness"
        )?;
        let clipped = format!("{:.1} %", 100.0 * self.clipped);
        write!(f, "\n{:<22}{clipped:>CELL$}", "clipped")
    }
}

fn cell(ratio: Option<SeamRatio>) -> String {
    let Some(SeamRatio { ratio, spread }) = ratio else {
        return NOTHING.to_owned();
    };
    match spread {
        Some(spread) => format!("{} ± {}", number(ratio), number(spread)),
        None => number(ratio),
    }
}

/// Formats a number in at most six characters.
fn number(value: f64) -> String {
    if value < 100.0 {
        format!("{value:.2}")
    } else if value < 1e5 {
        format!("{value:.0}")
    } else {
        format!("{value:.0e}")
    }
}
