//! Bootstrap: the same statistic of samples drawn from the samples with replacement (Efron 1979).

/// Number of resamples.
pub(crate) const RESAMPLES: usize = 200;
/// Largest number of blocks in which samples are drawn. More samples are drawn in blocks of several, which
/// bounds the cost.
const BLOCKS: usize = 1000;

/// First sample of each block, followed by the number of samples.
pub(crate) fn blocks(samples: usize) -> Vec<usize> {
    let count = samples.min(BLOCKS);
    (0..=count).map(|block| block * samples / count.max(1)).collect()
}

/// Number of times that each of `count` blocks is drawn in each resample, the same in every run.
pub(crate) fn draws(count: usize) -> impl Iterator<Item = Vec<u32>> {
    let mut state = 0u64;
    // SplitMix64 (Steele, Lea and Flood 2014).
    let mut random = move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    (0..RESAMPLES).map(move |_| {
        let mut times = vec![0; count];
        (0..count).for_each(|_| times[((u128::from(random()) * count as u128) >> 64) as usize] += 1);
        times
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_resample_draws_as_many_blocks_as_there_are() {
        assert_eq!(blocks(3), [0, 1, 2, 3]);
        assert_eq!((blocks(100_000).len(), blocks(100_000)[1]), (1001, 100));
        let all: Vec<_> = draws(50).collect();
        assert!(all.len() == RESAMPLES && all.iter().all(|times| times.iter().sum::<u32>() == 50));
        let of_one: u32 = all.iter().map(|times| times[7]).sum();
        assert!((120..280).contains(&of_one), "{of_one}");
    }
}
