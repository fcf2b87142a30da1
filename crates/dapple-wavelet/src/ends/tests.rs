//! Tests of extensions against written-out lines.

use super::*;
use crate::oracle::all_filters;
use crate::{Degree, Phase};

fn line(len: usize, ends: Ends) -> Vec<usize> {
    let line = Line { len, ends };
    (-4..len as i64 + 4)
        .map(|index| line.index(index))
        .collect()
}

#[test]
fn index_of_a_repeating_line_wraps() {
    assert_eq!(
        line(3, Ends::Repeat),
        [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0],
        "three"
    );
    assert_eq!(line(1, Ends::Repeat), [0; 9], "one");
}

#[test]
fn index_of_a_mirrored_line_turns_at_its_ends() {
    let mirror = |twice| Ends::Mirror { twice };
    assert_eq!(
        line(3, mirror([true; 2])),
        [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0],
        "twice"
    );
    assert_eq!(
        line(3, mirror([false; 2])),
        [0, 1, 2, 1, 0, 1, 2, 1, 0, 1, 2],
        "once"
    );
    assert_eq!(
        line(3, mirror([true, false])),
        [1, 2, 1, 0, 0, 1, 2, 1, 0, 0, 1],
        "twice, once"
    );
    assert_eq!(
        line(3, mirror([false, true])),
        [1, 2, 2, 1, 0, 1, 2, 2, 1, 0, 1],
        "once, twice"
    );
    assert_eq!(line(1, mirror([false; 2])), [0; 9], "one, once");
    assert_eq!(line(1, mirror([true; 2])), [0; 9], "one, twice");
}

#[test]
fn coarse_lengths_are_those_of_the_table() {
    for filter in all_filters() {
        let even = matches!(filter.degree, Degree::Constant | Degree::Quadratic);
        let least = shortest(filter, Border::Mirror);
        for len in least..20_usize {
            let needed = match (filter.phase, even) {
                (Phase::Centered, _) => len.div_ceil(2),
                (Phase::CookDeRose, true) => len / 2 + 1,
                (Phase::CookDeRose, false) => len / 2,
            };
            let coarse = filter.coarse_len(len, Border::Mirror);
            assert_eq!(coarse, Ok(needed), "{filter:?}, {len}");
            let halving = Halving::new(filter, len, Border::Mirror).expect("long enough");
            let offset = i64::from(filter.phase == Phase::CookDeRose && !even);
            assert_eq!(halving.offset, offset, "{filter:?}, {len}");
        }
    }
}

#[test]
fn lengths_name_the_whole_length_and_all_levels() {
    let filter = SplineFilter::default();
    let error = lengths(filter, 12, 3, Border::Periodic).expect_err("12 is not a multiple of 8");
    let kind = WaveletErrorKind::NotDivisible {
        length: 12,
        levels: 3,
    };
    assert_eq!(*error.kind(), kind, "{error}");
    assert_eq!(
        lengths(filter, 12, 2, Border::Periodic),
        Ok(vec![12, 6, 3]),
        "12 is a multiple of 4"
    );
}

#[test]
fn lengths_refuse_more_levels_than_there_can_be() {
    for filter in all_filters() {
        let error = lengths(filter, 5, u32::MAX, Border::Mirror).expect_err("too many levels");
        assert!(
            matches!(error.kind(), WaveletErrorKind::Range { .. }),
            "{error}"
        );
    }
}

#[test]
fn halving_always_shortens_the_line() {
    for filter in all_filters() {
        let even = matches!(filter.degree, Degree::Constant | Degree::Quadratic);
        for border in [Border::Periodic, Border::Mirror] {
            let stays = even && filter.phase == Phase::CookDeRose && border == Border::Mirror;
            let least = if stays { 3 } else { 2 };
            for length in 0..least {
                let error = Halving::new(filter, length, border).expect_err("too short");
                let kind = WaveletErrorKind::TooShort { length, least };
                assert_eq!(*error.kind(), kind, "{filter:?}, {border:?}");
            }
            for len in (least..40).chain([1000, 1001]) {
                match filter.coarse_len(len, border) {
                    Ok(coarse) => assert!(coarse < len, "{filter:?}, {len}, {border:?}: {coarse}"),
                    Err(error) => assert_eq!((border, len % 2), (Border::Periodic, 1), "{error}"),
                }
            }
        }
    }
}

#[test]
fn lengths_end_where_the_line_cannot_become_shorter() {
    let filter = SplineFilter {
        phase: Phase::CookDeRose,
        ..SplineFilter::default()
    };
    assert_eq!(
        lengths(filter, 5, 2, Border::Mirror),
        Ok(vec![5, 3, 2]),
        "two levels"
    );
    let error = lengths(filter, 5, 3, Border::Mirror).expect_err("two would stay two");
    let kind = WaveletErrorKind::TooShort {
        length: 2,
        least: 3,
    };
    assert_eq!(*error.kind(), kind, "three levels");
}

#[cfg(target_pointer_width = "64")]
#[test]
fn huge_lengths_are_refused_without_a_panic() {
    let refused = |result: Result<usize, WaveletError>| {
        let error = result.expect_err("a length that no memory holds");
        matches!(error.kind(), WaveletErrorKind::Range { .. })
    };
    for filter in all_filters() {
        for border in [Border::Periodic, Border::Mirror] {
            // Even lengths around the powers of two where sums of twice the length overflow.
            for len in [(1 << 40) + 2, (1 << 62) + 2, (1 << 63) + 4, usize::MAX - 1] {
                assert!(refused(filter.coarse_len(len, border)), "{filter:?}, {len}");
                for coarse in [&[][..], &[1.0, 2.0]] {
                    let fine = filter.up_line(coarse, len, border).map(|line| line.len());
                    assert!(refused(fine), "{filter:?}, {len}, {border:?}");
                }
            }
            let most = filter.coarse_len(1 << 40, border);
            assert!(most.is_ok(), "{filter:?}, {border:?}: {most:?}");
        }
        assert!(
            refused(filter.coarse_len(usize::MAX, Border::Mirror)),
            "{filter:?}"
        );
    }
}
