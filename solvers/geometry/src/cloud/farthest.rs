//! Farthest-point sampling: from many candidates, again and again the one farthest from all chosen so far.

use crate::Point3;

/// Candidates with the distance to the nearest chosen point, measured in local target spacings.
///
/// Candidates lie sorted by bucket, and each bucket knows its largest gap: a choice skips every bucket that is
/// farther from the new point than that, so `n` choices from `C` candidates cost about `C log n` distances rather
/// than `C n`.
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
    /// Largest gap in the bucket and the first candidate that has it.
    largest: (f64, usize),
}

impl Farthest {
    /// `size`: target spacing of each candidate up to a common factor, at most 1. `side` (m): bucket width, about
    /// the final distance between chosen points.
    pub(super) fn new(
        points: impl Iterator<Item = Point3>,
        size: impl Fn(&Point3) -> f64,
        side: f64,
    ) -> Farthest {
        let mut keyed: Vec<([i64; 3], Candidate)> = points
            .map(|at| {
                let scale = size(&at).powi(-2);
                (
                    [at.x, at.y, at.z].map(|c| (c / side).floor() as i64),
                    Candidate { at, scale, gap: f64::INFINITY },
                )
            })
            .collect();
        // Stable: equal keys keep the order in which the candidates were drawn.
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

    /// The candidate with the largest gap and that gap (in target spacings); `None` without candidates.
    pub(super) fn farthest(&self) -> Option<(Point3, f64)> {
        let first = self.buckets.first()?.largest;
        let best =
            self.buckets.iter().fold(first, |best, b| if b.largest.0 > best.0 { b.largest } else { best });
        Some((self.candidates[best.1].at, best.0.sqrt()))
    }

    /// Chooses `p` (a candidate or not): gaps shrink accordingly.
    pub(super) fn choose(&mut self, p: &Point3) {
        let mut start = 0;
        for bucket in &mut self.buckets {
            let range = start..bucket.end;
            start = bucket.end;
            // Scales are at least 1, so the plain distance to the bucket's box bounds every scaled one from below.
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
