//! Connected regions of a mask.
//!
//! Regions are found by a union of runs: each row is cut into runs of pixels inside the mask, and runs that touch in
//! adjacent rows are united (Azriel Rosenfeld and John Pfaltz, "Sequential operations in digital picture processing",
//! Journal of the ACM 13(4), 1966). Regions are numbered in the order of their first pixels, row by row.

/// A run of consecutive pixels of a row inside the mask.
#[derive(Clone, Copy)]
struct Run {
    row: usize,
    first: usize,
    end: usize,
}

/// Returns the connected region of each pixel, counted from 1, and 0 where `mask` is not above ½.
///
/// `width` is the number of columns of the mask, and `repeats` says whether it wraps along x and y. Pixels are
/// connected to their neighbors in the same row and column (4-connectivity). Regions are numbered in the order of
/// their first pixels, row by row.
#[must_use]
pub fn regions(mask: &[f32], width: usize, repeats: [bool; 2]) -> Vec<u32> {
    // Cut the rows into runs.
    let mut runs = Vec::new();
    let mut first_of_row = vec![0];
    for (row, pixels) in mask.chunks(width.max(1)).enumerate() {
        let mut first = None;
        for column in 0..=pixels.len() {
            let is_inside = pixels.get(column).is_some_and(|&value| value > 0.5);
            match (first, is_inside) {
                (None, true) => first = Some(column),
                (Some(start), false) => {
                    runs.push(Run {
                        row,
                        first: start,
                        end: column,
                    });
                    first = None;
                }
                _ => {}
            }
        }
        first_of_row.push(runs.len());
    }
    let height = first_of_row.len() - 1;
    let mut unions = Unions::new(runs.len());
    // Unite the runs that touch in adjacent rows.
    for row in 0..height {
        let below = match row + 1 < height {
            true => row + 1,
            false if repeats[1] => 0,
            false => continue,
        };
        let [mut a, mut b] = [first_of_row[row], first_of_row[below]];
        while a < first_of_row[row + 1] && b < first_of_row[below + 1] {
            if runs[a].first < runs[b].end && runs[b].first < runs[a].end {
                unions.unite(a, b);
            }
            // Go on with the run that ends first.
            if runs[a].end <= runs[b].end {
                a += 1;
            } else {
                b += 1;
            }
        }
    }
    // Unite the first and the last run of a row across the sides.
    for row in (0..height).filter(|_| repeats[0]) {
        let [first, end] = [first_of_row[row], first_of_row[row + 1]];
        if end > first && runs[first].first == 0 && runs[end - 1].end == width {
            unions.unite(first, end - 1);
        }
    }
    // Number the regions in the order of their first runs, and fill the runs.
    let mut numbers = vec![0; runs.len()];
    let mut regions = vec![0; mask.len()];
    let mut count = 0;
    for (index, run) in runs.iter().enumerate() {
        let root = unions.root(index);
        if numbers[root] == 0 {
            count += 1;
            numbers[root] = count;
        }
        regions[run.row * width + run.first..run.row * width + run.end].fill(numbers[root]);
    }
    regions
}

/// Disjoint sets of runs; the smallest index of a set is its root.
struct Unions {
    parents: Vec<usize>,
}

impl Unions {
    fn new(count: usize) -> Self {
        Self {
            parents: (0..count).collect(),
        }
    }

    fn root(&mut self, mut index: usize) -> usize {
        while self.parents[index] != index {
            // Halve the path.
            self.parents[index] = self.parents[self.parents[index]];
            index = self.parents[index];
        }
        index
    }

    fn unite(&mut self, a: usize, b: usize) {
        let [a, b] = [self.root(a), self.root(b)];
        self.parents[a.max(b)] = a.min(b);
    }
}
