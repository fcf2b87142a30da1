//! Tests of `equalize` and `flood_fill`, which depend on the whole tile.

use super::{numbers, random, with_image};
use crate::bakes::plan;
use dapple_raster::Raster;

#[test]
fn equalized_numbers_cover_each_share_of_the_tile() {
    let text = "dapple = 1\n[nodes]\ncells.worley.frequency = 4.0\neven.equalize.input = \"cells\"\n[material]\n";
    let plan = plan(text);
    let [cells, even] = ["cells", "even"].map(|node| numbers(&plan, node, [32, 20]));
    for tenths in 1..10 {
        let below = even
            .pixels()
            .iter()
            .filter(|&&value| value < tenths as f32 / 10.0);
        assert_eq!(below.count(), 64 * tenths);
    }
    let mut pairs: Vec<_> = cells.pixels().iter().zip(even.pixels()).collect();
    pairs.sort_by(|a, b| a.1.total_cmp(b.1));
    assert!(pairs.is_sorted_by(|a, b| a.0 <= b.0), "the order stays");
}

/// Returns the region id of each pixel of a mask, by a separate search from each pixel.
fn searched(mask: &Raster<f32>, wrap: [bool; 2]) -> Vec<u32> {
    let size = mask.size().map(i64::from);
    let index = |[x, y]: [i64; 2]| (y * size[0] + x) as usize;
    let mut regions = vec![0; mask.pixels().len()];
    let mut count = 0;
    for start in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y])) {
        if mask.pixels()[index(start)] <= 0.5 || regions[index(start)] > 0 {
            continue;
        }
        count += 1;
        let mut open = vec![start];
        while let Some(at) = open.pop() {
            if mask.pixels()[index(at)] <= 0.5 || regions[index(at)] > 0 {
                continue;
            }
            regions[index(at)] = count;
            for [dx, dy] in [[1, 0], [-1, 0], [0, 1], [0, -1]] {
                let next = [at[0] + dx, at[1] + dy];
                let is_near =
                    (0..2).all(|axis| wrap[axis] || (0..size[axis]).contains(&next[axis]));
                if is_near {
                    open.push([0, 1].map(|axis| next[axis].rem_euclid(size[axis])));
                }
            }
        }
    }
    regions
}

#[test]
fn flood_fill_numbers_connected_regions_also_across_the_sides() {
    let mask = Raster::from_fn([37, 23], |x, y| f32::from(u8::from(random(x, y) > 0.45))).unwrap();
    for wrap in [[true, true], [true, false], [false, true], [false, false]] {
        let text = format!(
            "dapple = 1\nextent = [3.7, 2.3]\nwrap = {wrap:?}\n[nodes]\na.image = {{ file = \"a.png\" }}\n\
             index.flood_fill = {{ input = \"a\", value = \"index\" }}\n\
             area.flood_fill = {{ input = \"a\", value = \"area\" }}\n\
             random.flood_fill = {{ input = \"a\" }}\nother.flood_fill = {{ input = \"a\", seed = 8 }}\n[material]\n"
        );
        let plan = with_image(&text, mask.clone());
        let [index, area, random, other] =
            ["index", "area", "random", "other"].map(|node| numbers(&plan, node, [37, 23]));
        let right = searched(&mask, wrap);
        assert!(right.iter().max() > Some(&10), "several regions");
        let found: Vec<_> = index.pixels().iter().map(|&region| region as u32).collect();
        assert_eq!(found, right, "{wrap:?}");
        for (pixel, &region) in right.iter().enumerate() {
            let count = right
                .iter()
                .filter(|&&other| other == region && region > 0)
                .count();
            // A pixel is 0.1 × 0.1 units.
            assert!((area.pixels()[pixel] - 0.01 * count as f32).abs() < 1e-5);
            let number = random.pixels()[pixel];
            let first = right.iter().position(|&other| other == region).unwrap();
            assert_eq!(number, random.pixels()[first], "one number for each region");
            assert_eq!(number == 0.0, region == 0);
        }
        assert_ne!(random, other, "another seed");
        // Numbers of regions are all over the range.
        let most = random.pixels().iter().copied().fold(0.0, f32::max);
        assert!((0.5..1.0).contains(&most), "{most}");
    }
    let one = Raster::filled([5, 4], 1.0).unwrap();
    let text = "dapple = 1\n[nodes]\na.image = { file = \"a.png\" }\nindex.flood_fill = { input = \"a\", value = \"index\" }\n[material]\n";
    let all = numbers(&with_image(text, one), "index", [5, 4]);
    assert!(
        all.pixels().iter().all(|&region| region == 1.0),
        "a full mask"
    );
}
