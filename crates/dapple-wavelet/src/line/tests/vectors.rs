//! Test vectors of the filters: exact fractions, and reference numbers computed independently.

use super::*;

fn cook_de_rose() -> SplineFilter {
    SplineFilter {
        phase: Phase::CookDeRose,
        ..SplineFilter::default()
    }
}

fn over(denominator: f64, numerators: &[f64]) -> Vec<f64> {
    numerators
        .iter()
        .map(|numerator| numerator / denominator)
        .collect()
}

fn impulse(len: usize) -> Vec<f64> {
    let mut line = vec![0.0; len];
    line[0] = 1.0;
    line
}

/// Returns a periodic line of `len` coefficients with a unit step in the middle and another at the wrap.
fn step(len: usize) -> Vec<f64> {
    (0..len)
        .map(|i| f64::from(u8::from(i >= len / 2)))
        .collect()
}

#[test]
fn vectors_of_an_impulse_are_exact() {
    let filter = SplineFilter::default();
    let coarse = down(filter, &impulse(8), PERIODIC);
    assert_near(&coarse, &over(512.0, &[343.0, -123.0, 41.0, -5.0]), "down");
    let fine = over(
        1024.0,
        &[512.0, 453.0, -13.0, -164.0, 0.0, 59.0, 13.0, 164.0],
    );
    assert_near(&project(filter, &impulse(8), 1), &fine, "down and up");
    let coarse = down(cook_de_rose(), &impulse(8), PERIODIC);
    assert_near(
        &coarse,
        &over(512.0, &[343.0, -5.0, 41.0, -123.0]),
        "down, Cook and DeRose",
    );
}

#[test]
fn vectors_of_an_impulse_are_exact_for_every_degree() {
    // Dense normal equations of a periodic line of 8, solved in fractions by another program
    let steps = (
        2.0,
        [1.0, 0.0, 0.0, 0.0],
        2.0,
        [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    );
    let tents = (
        16.0,
        [11.0, -2.0, 1.0, -2.0],
        32.0,
        [22.0, 9.0, -4.0, -1.0, 2.0, -1.0, -4.0, 9.0],
    );
    let cubic = (
        4352.0,
        [4221.0, -1632.0, 1219.0, -1632.0],
        17408.0,
        [
            11031.0, 5178.0, -2176.0, -826.0, 2025.0, -826.0, -2176.0, 5178.0,
        ],
    );
    for (degree, (below, coarse, below_fine, fine)) in [
        (Degree::Constant, steps),
        (Degree::Linear, tents),
        (Degree::Cubic, cubic),
    ] {
        let filter = SplineFilter {
            degree,
            ..SplineFilter::default()
        };
        let what = format!("{degree:?}");
        assert_near(
            &down(filter, &impulse(8), PERIODIC),
            &over(below, &coarse),
            &what,
        );
        assert_near(
            &project(filter, &impulse(8), 1),
            &over(below_fine, &fine),
            &what,
        );
    }
}

#[test]
fn vectors_of_a_step_are_exact() {
    let needed = over(
        512.0,
        &[105.0, -46.0, -46.0, 105.0, 407.0, 558.0, 558.0, 407.0],
    );
    assert_near(
        &project(SplineFilter::default(), &step(8), 1),
        &needed,
        "step",
    );
}

#[test]
fn vectors_of_a_cosine_are_exact() {
    // Three periods, each reduced to a range near zero, where the series is exact.
    let turn = |i: i32| f64::from((3 * i + 8) % 16 - 8) / 8.0;
    let cosine = |i: i32| series_of_cosine(turn(i) * std::f64::consts::PI);
    let fine: Vec<f64> = (0..16)
        .map(|i| cosine(i) + 0.25 * f64::from(i % 3))
        .collect();
    let needed = [
        1.467_481_628_145,
        -1.317_156_481_612,
        1.177_445_351_203,
        0.553_922_680_940,
        -1.134_962_096_895,
        1.909_441_637_862,
        -0.697_464_882_453,
        -0.083_707_837_190,
    ];
    assert_near(
        &down(SplineFilter::default(), &fine, PERIODIC),
        &needed,
        "cosine",
    );
}

/// Computes the cosine from its Taylor series, since the bits of the standard library differ between platforms.
fn series_of_cosine(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 0.0;
    for i in 0..40 {
        sum += term;
        let n = f64::from(2 * i + 1);
        term *= -x * x / (n * (n + 1.0));
    }
    sum
}

/// Taps `a_1` to `a_20` of the halving filter: `a_k = a_(1 - k)`.
const TAPS: [f64; 20] = [
    0.655_340_341_7,
    0.033_978_975_0,
    -0.243_780_429_7,
    -0.025_935_977_7,
    0.103_311_248_8,
    0.011_654_616_3,
    -0.044_411_969_9,
    -0.005_039_188_0,
    0.019_119_626_3,
    0.002_170_655_0,
    -0.008_232_307_3,
    -0.000_934_669_5,
    0.003_544_622_9,
    0.000_402_447_3,
    -0.001_526_227_0,
    -0.000_173_284_0,
    0.000_657_155_7,
    0.000_074_611_8,
    -0.000_282_955_0,
    -0.000_032_126_0,
];

#[test]
fn down_has_the_taps_of_the_note() {
    // Coarse coefficient 0 of an impulse at k is tap k; a period of 512 hides the wrap.
    for (tap, k) in TAPS.iter().zip(1..) {
        for index in [k, (513 - k) % 512] {
            let mut line = vec![0.0; 512];
            line[index] = 1.0;
            let value = down(SplineFilter::default(), &line, PERIODIC)[0];
            // The table has ten digits.
            assert!((value - tap).abs() < 1e-10, "tap {k} is {value}, not {tap}");
        }
    }
}

#[test]
fn down_has_rational_taps_for_coefficients() {
    let filter = SplineFilter {
        fit: Fit::Coefficients,
        ..SplineFilter::default()
    };
    for k in 1..12_usize {
        let mut line = vec![0.0; 256];
        line[k] = 1.0;
        let power = (0..k / 2).fold(2.0 / 3.0, |power, _| -power / 3.0);
        let tap = if k % 2 == 1 { power } else { 0.0 };
        let value = down(filter, &line, PERIODIC)[0];
        assert!((value - tap).abs() < 1e-14, "tap {k} is {value}, not {tap}");
    }
}

#[test]
fn project_reproduces_polynomials_up_to_its_degree() {
    let polynomial = |power: u32| -> Vec<f64> {
        (0..256)
            .map(|i| (0..power).fold(1.0, |y, _| y * (f64::from(i) - 128.0) / 64.0))
            .collect()
    };
    // Far from the wrap, where the recursion no longer depends on the jump
    let worst = |power| {
        let line = polynomial(power);
        distance(
            &project(SplineFilter::default(), &line, 1)[100..156],
            &line[100..156],
        )
    };
    for power in 0..=2 {
        assert!(worst(power) < 1e-13, "degree {power}: {}", worst(power));
    }
    // Measured: 2.9e-6 at a spacing of 1/64.
    assert!((worst(3) - 2.9e-6).abs() < 1e-7, "degree 3: {}", worst(3));
}

#[test]
fn step_at_the_wrap_is_left_as_the_note_says() {
    let centered = [0.655_340, 0.353_644, 0.180_294, 0.088_069];
    let early = [0.344_660, 0.234_797, 0.149_519, 0.081_137];
    for (filter, table) in [(SplineFilter::default(), centered), (cook_de_rose(), early)] {
        for (levels, needed) in (1..).zip(table) {
            let line = project(filter, &step(128), levels);
            // The tables are for 128 pixels, where four levels are slightly affected by the step in the middle.
            let left = line[127] - line[0];
            // The table has six digits.
            assert!(
                (left - needed).abs() < 1e-6,
                "{filter:?}, {levels} levels: {left}"
            );
        }
    }
    let coefficients = SplineFilter {
        fit: Fit::Coefficients,
        ..SplineFilter::default()
    };
    let line = project(coefficients, &step(4096), 1);
    assert!(
        (line[4095] - line[0] - 2.0 / 3.0).abs() < 1e-12,
        "the step that coefficients leave"
    );
}

#[test]
fn step_overshoots_as_the_note_says() {
    let centered = [10.3, 10.1, 9.9, 9.9];
    let early = [12.2, 13.7, 13.3, 11.6];
    for (filter, table) in [(SplineFilter::default(), centered), (cook_de_rose(), early)] {
        for (levels, needed) in (1..).zip(table) {
            let line = project(filter, &step(128), levels);
            let over = 100.0 * (line.iter().fold(0.0_f64, |most, &value| most.max(value)) - 1.0);
            // The table has one digit.
            assert!(
                (over - needed).abs() < 0.06,
                "{filter:?}, {levels} levels: {over} %"
            );
        }
    }
}

#[test]
fn residual_of_white_noise_has_the_variance_of_the_note() {
    let fine = noise(1 << 18);
    let kept = project(SplineFilter::default(), &fine, 1);
    let power = |line: &mut dyn Iterator<Item = f64>| line.map(|value| value * value).sum::<f64>();
    let lost = power(&mut fine.iter().zip(&kept).map(|(fine, kept)| fine - kept));
    let ratio = lost / power(&mut fine.iter().copied());
    // 2^18 values estimate a variance to about 0.2 %.
    assert!((ratio / 0.502_813_424_9 - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn value_stability_down_line() {
    let line = [0.0, 1.0, 4.0, 2.0, -1.0, 0.5, 3.0, 8.0];
    let mut bits = Vec::new();
    for degree in [Degree::Linear, Degree::Quadratic, Degree::Cubic] {
        let filter = SplineFilter {
            degree,
            ..SplineFilter::default()
        };
        bits.push(down(filter, &line, PERIODIC)[1].to_bits());
    }
    assert_eq!(
        bits,
        [
            0x400b_c000_0000_0003,
            0x4013_1eff_ffff_fffd,
            0x4014_d207_8787_8785
        ],
        "{bits:#x?}"
    );
}
