//! Parses several comma-separated numbers on the command line, such as `3,4`.

use serde::{Serialize, Serializer};
use std::str::FromStr;

/// `N` comma-separated numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Numbers<T, const N: usize>(pub(crate) [T; N]);

/// Parses comma-separated numbers. `count` is the required number of them; any number is accepted if it is `None`.
///
/// # Errors
///
/// If an item is not a number, or the list has another length than `count`.
pub(crate) fn numbers_of<T: FromStr>(text: &str, count: Option<usize>) -> Result<Vec<T>, String> {
    let numbers: Result<Vec<T>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match (numbers, count) {
        (Ok(numbers), None) => Ok(numbers),
        (Ok(numbers), Some(count)) if numbers.len() == count => Ok(numbers),
        (_, None) => Err(format!(
            "{text:?} is not a list of numbers with commas between them"
        )),
        (_, Some(count)) => Err(format!(
            "{text:?} is not {count} numbers with commas between them"
        )),
    }
}

impl<T: FromStr, const N: usize> FromStr for Numbers<T, N> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: [T; N] = numbers_of(text, Some(N))?
            .try_into()
            .map_err(|_| String::new())?;
        Ok(Self(numbers))
    }
}

impl<T: Serialize, const N: usize> Serialize for Numbers<T, N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Numbers;

    #[test]
    fn numbers_are_as_many_as_are_needed() {
        assert_eq!("3, 4".parse(), Ok(Numbers([3_u32, 4])));
        assert_eq!("-1,2.5,0".parse(), Ok(Numbers([-1.0, 2.5, 0.0])));
        for text in ["", "3", "3,4,5", "3,x", "3;4"] {
            assert!(text.parse::<Numbers<f64, 2>>().is_err(), "{text:?}");
        }
    }
}
