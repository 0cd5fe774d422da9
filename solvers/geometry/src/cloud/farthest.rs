//! Farthest-point sampling: repeatedly chooses the candidate farthest from all points chosen so far.

use crate::Point3;

/// Candidates with the distance to the nearest chosen point, measured in local target spacings.
///
/// Candidates are sorted by bucket, and each bucket stores its largest gap. A choice skips every bucket that
/// is farther from the new point than that gap. So `n` choices from `C` candidates cost about `C log n`
/// distances rather than `C n`.
pub(super) struct Farthest {
    candidates: Vec<Candidate>,
    buckets: Vec<Bucket>,
}

struct Candidate {
    at: Point3,
    /// `1 / size^2` of the target spacing, up to a common factor; at least 1.
    scale: f64,
    /// Squared scaled distance to the nearest chosen point.
    gap: f64,
}

struct Bucket {
    end: usize,
    low: Point3,
    high: Point3,
    /// Largest gap in the bucket, and the index of the first candidate with this gap.
    largest: (f64, usize),
}

impl Farthest {
    /// Sorts the candidates into buckets. Each has its target spacing up to a common factor, at most 1.
    /// `side` (m) is the bucket width, about the final distance between chosen points.
    pub(super) fn new(candidates: impl Iterator<Item = (Point3, f64)>, side: f64) -> Farthest {
        let mut keyed: Vec<([i64; 3], Candidate)> = candidates
            .map(|(at, size)| {
                let scale = size.powi(-2);
                (
                    [at.x, at.y, at.z].map(|c| (c / side).floor() as i64),
                    Candidate { at, scale, gap: f64::INFINITY },
                )
            })
            .collect();
        // The sort is stable: equal keys keep the order in which the candidates were drawn.
        keyed.sort_by_key(|(key, _)| *key);
        let mut buckets: Vec<Bucket> = Vec::new();
        let mut last = None;
        for (index, (key, c)) in keyed.iter().enumerate() {
            if last != Some(*key) {
                last = Some(*key);
                buckets.push(Bucket { end: index, low: c.at, high: c.at, largest: (f64::INFINITY, index) });
            }
            if let Some(bucket) = buckets.last_mut() {
                bucket.end = index + 1;
                (bucket.low, bucket.high) = (bucket.low.inf(&c.at), bucket.high.sup(&c.at));
            }
        }
        Farthest { candidates: keyed.into_iter().map(|(_, c)| c).collect(), buckets }
    }

    /// Returns the candidate with the largest gap and that gap (in target spacings), or `None` without
    /// candidates.
    pub(super) fn farthest(&self) -> Option<(Point3, f64)> {
        let first = self.buckets.first()?.largest;
        let best =
            self.buckets.iter().fold(first, |best, b| if b.largest.0 > best.0 { b.largest } else { best });
        Some((self.candidates[best.1].at, best.0.sqrt()))
    }

    /// Chooses `p`, which need not be a candidate, and updates the gaps.
    pub(super) fn choose(&mut self, p: &Point3) {
        let mut start = 0;
        for bucket in &mut self.buckets {
            let range = start..bucket.end;
            start = bucket.end;
            // Scales are at least 1, so the unscaled distance to the bucket's box is a lower bound of every
            // scaled distance.
            let away = (bucket.low - p).sup(&(p - bucket.high)).map(|c| c.max(0.0)).norm_squared();
            if away >= bucket.largest.0 {
                continue;
            }
            bucket.largest = (f64::NEG_INFINITY, range.start);
            for index in range {
                let c = &mut self.candidates[index];
                c.gap = c.gap.min((c.at - p).norm_squared() * c.scale);
                if c.gap > bucket.largest.0 {
                    bucket.largest = (c.gap, index);
                }
            }
        }
    }
}
