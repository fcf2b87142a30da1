//! Tests of groups against a stable sort.

use super::Groups;

#[test]
fn groups_equal_a_stable_sort() {
    for n_groups in [1, 2, 7, 40] {
        let groups: Vec<u32> = (0..30).map(|item| item * item * 7 % n_groups).collect();
        let sorted = Groups::sort(n_groups as usize, &groups);
        let mut items: Vec<u32> = (0..30).collect();
        items.sort_by_key(|&item| groups[item as usize]);
        assert_eq!(sorted.items, items);
        for group in 0..n_groups {
            let of_group = items.iter().filter(|&&item| groups[item as usize] == group);
            assert!(sorted.of(group as usize).iter().eq(of_group), "{group}");
        }
    }
    assert_eq!(Groups::sort(2, &[]).starts, [0; 3]);
    assert!(Groups::sort(0, &[]).items.is_empty());
}
