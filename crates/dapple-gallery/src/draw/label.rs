//! Colors and shades for labels.

use dapple_color::LinearRgb;

/// A color for a label: neighboring labels get colors far apart, and a label has the same color everywhere.
#[must_use]
pub fn label_color(label: u32) -> LinearRgb {
    // Hues that are a golden section of the circle apart stay far apart, however many there are.
    let hue = fraction(f64::from(label) * 0.618_033_988_749_895) as f32 * 6.0;
    let value = [0.95, 0.70, 0.85][label as usize % 3];
    let channel = |shift: f32| {
        let along = (hue + shift) % 6.0;
        let strength = ((along - 3.0).abs() - 1.0).clamp(0.0, 1.0);
        let display = value * (0.42 + 0.58 * strength);
        display * display
    };
    LinearRgb::new(channel(0.0), channel(4.0), channel(2.0))
}

/// A shade of gray for a label, from 0.25 to 1.
#[must_use]
pub fn label_gray(label: u32) -> f32 {
    let spread = fraction(f64::from(label) * 0.618_033_988_749_895);
    0.25 + 0.75 * spread as f32
}

fn fraction(value: f64) -> f64 {
    value - value.floor()
}

#[cfg(test)]
mod tests {
    use super::{label_color, label_gray};

    #[test]
    fn neighboring_labels_differ_visibly() {
        for label in 0..1000 {
            let [a, b] = [label, label + 1].map(label_color);
            assert!(
                (a - b).to_array().iter().any(|gap| gap.abs() > 0.1),
                "colors of {label}"
            );
            let gap = (label_gray(label) - label_gray(label + 1)).abs();
            assert!(gap > 0.2, "grays of {label}");
        }
    }
}
