//! Extends lines beyond their ends, and computes the lengths of coarse lines.

use crate::{Border, Phase, SplineFilter, WaveletError, WaveletErrorKind};

/// A line of finite length, and the rule for values beyond its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    /// Number of stored values.
    pub(crate) len: usize,
    ends: Ends,
}

/// Extension of the line at its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ends {
    /// The line repeats.
    Repeat,
    /// The line is mirrored at both ends. `twice` says, for the start and the end, whether the mirror repeats the end
    /// value.
    Mirror { twice: [bool; 2] },
}

/// A fine line, and the coarse line that halving produces from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Halving {
    pub(crate) fine: Line,
    pub(crate) coarse: Line,
    /// Index of the first stored coarse coefficient in the numbering of [`Phase`](crate::Phase): 0 or 1.
    pub(crate) offset: i64,
}

/// Maximum length of a line. No memory can store a longer line, and up to this length no index overflows.
const LONGEST: u64 = 1 << 40;

impl Line {
    /// Creates a line of `len` coefficients, at least one.
    ///
    /// # Errors
    ///
    /// `TooShort` for a length below 1, or below 2 if the line is mirrored; `Range` for a length above 2^40.
    pub(crate) fn new(
        filter: SplineFilter,
        len: usize,
        border: Border,
    ) -> Result<Self, WaveletError> {
        let twice = filter.degree.order() % 2 == 0;
        let (ends, least) = match border {
            Border::Periodic => (Ends::Repeat, 1),
            Border::Mirror => (Ends::Mirror { twice: [twice; 2] }, 2),
        };
        if len < least {
            return Err(WaveletError::new(WaveletErrorKind::TooShort {
                length: len,
                least,
            }));
        }
        if len as u64 > LONGEST {
            return Err(WaveletError::new(WaveletErrorKind::Range {
                what: "length of the line",
                value: len as f64,
                range: "at most 2^40",
            }));
        }
        Ok(Self { len, ends })
    }

    /// Maps `index`, which may be beyond the ends, to the index of a stored value.
    pub(crate) fn index(&self, index: i64) -> usize {
        let len = self.len as i64;
        let inside = match self.ends {
            Ends::Repeat => index.rem_euclid(len),
            Ends::Mirror { twice } => {
                // Mirrors at `low / 2` and `high / 2` map an index to `low - index` and `high - index`.
                let low = -i64::from(twice[0]);
                let high = 2 * (len - 1) + i64::from(twice[1]);
                // A single value that occurs once has a period of 0; all indices map to it.
                let index = index.rem_euclid((high - low).max(1));
                if index < len { index } else { high - index }
            }
        };
        inside as usize
    }
}

impl Halving {
    /// Computes the coarse line of a fine line of `len` coefficients.
    ///
    /// # Errors
    ///
    /// `NotDivisible` for an odd periodic length, `TooShort` for a line that would not get shorter; `Range` for a
    /// length above 2^40.
    pub(crate) fn new(
        filter: SplineFilter,
        len: usize,
        border: Border,
    ) -> Result<Self, WaveletError> {
        let least = shortest(filter, border);
        if len < least {
            return Err(WaveletError::new(WaveletErrorKind::TooShort {
                length: len,
                least,
            }));
        }
        let fine = Line::new(filter, len, border)?;
        let Ends::Mirror { twice } = fine.ends else {
            if len % 2 == 1 {
                return Err(WaveletError::new(WaveletErrorKind::NotDivisible {
                    length: len,
                    levels: 1,
                }));
            }
            let coarse = Line {
                len: len / 2,
                ends: Ends::Repeat,
            };
            return Ok(Self {
                fine,
                coarse,
                offset: 0,
            });
        };
        // Coarse coefficient j is centered at (4 j + first + last) / 2. A mirror of the fine line at s / 2, which maps
        // x to s - x, therefore maps j to (s - first - last) / 2 - j, an integer for both degrees and phases.
        let first_and_last = 2 * filter.first_tap() + filter.degree.order() + 1;
        let low = (-i64::from(twice[0]) - first_and_last).div_euclid(2);
        let high = (2 * (len as i64 - 1) + i64::from(twice[1]) - first_and_last).div_euclid(2);
        // The stored coefficients are between the two mirrors.
        let [first, last] = [low.div_euclid(2) + low.rem_euclid(2), high.div_euclid(2)];
        let ends = Ends::Mirror {
            twice: [low.rem_euclid(2) == 1, high.rem_euclid(2) == 1],
        };
        let coarse = Line {
            len: (last - first + 1) as usize,
            ends,
        };
        Ok(Self {
            fine,
            coarse,
            offset: first,
        })
    }
}

/// Returns the minimum length of a line that halving makes shorter.
///
/// A mirrored line of length 2 keeps its length if its coarse coefficients are on both mirrors. With repeated
/// halving, its variation would grow without bound.
pub(crate) fn shortest(filter: SplineFilter, border: Border) -> usize {
    let is_even = filter.degree.order() % 2 == 0;
    if border == Border::Mirror && filter.phase == Phase::CookDeRose && is_even {
        3
    } else {
        2
    }
}

/// Returns the lengths of a line that is halved `levels` times, from the first to the last.
///
/// # Errors
///
/// Same as [`Halving::new`], `NotDivisible` with the whole length and all levels; `Range` for too many levels.
pub(crate) fn lengths(
    filter: SplineFilter,
    len: usize,
    levels: u32,
    border: Border,
) -> Result<Vec<usize>, WaveletError> {
    if levels > MOST_LEVELS {
        return Err(WaveletError::new(WaveletErrorKind::Range {
            what: "number of levels",
            value: levels.into(),
            range: "at most 32",
        }));
    }
    if border == Border::Periodic && len > 1 && len.trailing_zeros() < levels {
        return Err(WaveletError::new(WaveletErrorKind::NotDivisible {
            length: len,
            levels,
        }));
    }
    let mut lengths = vec![len];
    let mut len = len;
    for _ in 0..levels {
        len = Halving::new(filter, len, border)?.coarse.len;
        lengths.push(len);
    }
    Ok(lengths)
}

/// Maximum number of levels: more than any raster needs, whose sides are below 2^32.
const MOST_LEVELS: u32 = 32;

#[cfg(test)]
mod tests;
