//! The broken line that follows a force over depth best, on both ways: where its corners lie.
//!
//! Of all places of so many corners those that leave least, by dynamic programming (R. Bellman, R. Roth, *J. Am. Stat. Assoc.* 64, 1969,
//! 1079). A stop or a preload gets the corners that it needs, and a long straight way none.

use super::trial::ContactTrial;

/// Mean of a column over stretches of the way, in and out.
pub struct DepthProfile {
    /// Where the first stretch begins, and how long each is, m or rad.
    from: f64,
    bin: f64,
    /// Of the way in and of that out, of each stretch: rows, and their mean; without rows, what lies between its neighbours.
    ways: [Vec<[f64; 2]>; 2],
    /// Of each way, before each stretch.
    sums: [Vec<Sums>; 2],
}

/// Stretches of the way.
const BINS: usize = 300;

/// Sums of weights w, w k, w k^2, w y, w k y, w y^2, of means y over the numbers k of the stretches.
type Sums = [f64; 6];

impl DepthProfile {
    /// Of `columns`, one for each of `trials`, between the places `ends`.
    #[must_use]
    pub fn of(trials: &[ContactTrial], columns: &[Vec<f64>], ends: [f64; 2]) -> Self {
        let bin = (ends[1] - ends[0]) / BINS as f64;
        let mut ways = [vec![[0.0; 2]; BINS], vec![[0.0; 2]; BINS]];
        for (trial, column) in trials.iter().zip(columns) {
            for (row, value) in column.iter().enumerate().filter(|(row, _)| trial.counts[*row]) {
                let at = (trial.position[row] - ends[0]) / bin;
                if (0.0..=BINS as f64).contains(&at) {
                    let way = &mut ways[usize::from(trial.velocity[row] < 0.0)];
                    let [rows, mean] = &mut way[(at as usize).min(BINS - 1)];
                    *rows += 1.0;
                    *mean += (value - *mean) / *rows;
                }
            }
        }
        ways.iter_mut().for_each(|way| fill(way));
        let sums = [0, 1].map(|way| sums(&ways[way]));
        Self { from: ends[0], bin, ways, sums }
    }

    /// The places of `count` corners, the two ends among them, of the broken line through the means that leaves least.
    #[must_use]
    pub fn corners(&self, count: usize) -> Vec<f64> {
        let lines = count.clamp(2, BINS) - 1;
        // Of each number of lines and each stretch: what is left up to there, and where the last line began.
        let mut left = vec![vec![(f64::INFINITY, 0); BINS]; lines + 1];
        left[0][0].0 = 0.0;
        for line in 1..=lines {
            for to in line..BINS {
                let from = (line - 1)..to;
                let each = from.map(|from| (left[line - 1][from].0 + self.left_by_line(from, to), from));
                left[line][to] = each.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0));
            }
        }
        let mut corners = vec![BINS - 1];
        for line in (1..=lines).rev() {
            corners.push(left[line][corners[corners.len() - 1]].1);
        }
        let place = |corner: usize| match corner {
            0 => self.from,
            at if at == BINS - 1 => self.from + BINS as f64 * self.bin,
            at => self.from + (at as f64 + 0.5) * self.bin,
        };
        corners.into_iter().rev().map(place).collect()
    }

    /// Slope of the line between the means of both ways at the ends of a stretch of the way.
    #[must_use]
    pub fn slope(&self, ends: [f64; 2]) -> f64 {
        let [low, high] = ends.map(|place| self.ways.iter().map(|way| way[self.stretch(place)][1]).sum::<f64>() / 2.0);
        (high - low) / (ends[1] - ends[0])
    }

    /// By how much the way out lies below the way in between `ends`, mean over the stretches that both passed.
    #[must_use]
    pub fn way_apart(&self, ends: [f64; 2]) -> f64 {
        let stretches = self.stretch(ends[0])..=self.stretch(ends[1]);
        let both = stretches.map(|at| [0, 1].map(|way| self.ways[way][at]));
        let apart: Vec<f64> = both.filter(|[a, b]| a[0] > 0.0 && b[0] > 0.0).map(|[a, b]| a[1] - b[1]).collect();
        apart.iter().sum::<f64>() / apart.len().max(1) as f64
    }

    /// The stretch of the way between `ends` about the place where the way out lies below the way in most, as far as by more than half of
    /// that; `None` where it nowhere does.
    #[must_use]
    pub fn widest(&self, ends: [f64; 2]) -> Option<[f64; 2]> {
        let [first, last] = ends.map(|place| self.stretch(place));
        let apart = |at: usize| self.ways[0][at][1] - self.ways[1][at][1];
        let widest = (first..=last).max_by(|a, b| apart(*a).total_cmp(&apart(*b))).filter(|at| apart(*at) > 0.0)?;
        let is_wide = |at: &usize| apart(*at) > 0.5 * apart(widest);
        let begin = (first..=widest).rev().take_while(is_wide).last()?;
        let end = (widest..=last).take_while(is_wide).last()?;
        Some([begin as f64, end as f64 + 1.0].map(|stretches| self.from + stretches * self.bin))
    }

    fn stretch(&self, place: f64) -> usize {
        (((place - self.from) / self.bin) as usize).min(BINS - 1)
    }

    /// Squares that lines through the means of stretches `from` and `to` leave between these, on both ways.
    fn left_by_line(&self, from: usize, to: usize) -> f64 {
        let each = self.ways.iter().zip(&self.sums).map(|(way, sums)| {
            let slope = (way[to][1] - way[from][1]) / (to - from) as f64;
            let level = way[from][1] - slope * from as f64;
            let [w, k, kk, y, ky, yy]: Sums = std::array::from_fn(|nth| sums[to][nth] - sums[from][nth]);
            yy - 2.0 * (level * y + slope * ky) + level * level * w + 2.0 * level * slope * k + slope * slope * kk
        });
        each.sum::<f64>().max(0.0)
    }
}

/// Gives stretches without rows what lies between their neighbours.
fn fill(way: &mut [[f64; 2]]) {
    let known: Vec<(usize, f64)> =
        way.iter().enumerate().filter(|(_, [rows, _])| *rows > 0.0).map(|(at, [_, mean])| (at, *mean)).collect();
    for (at, [_, mean]) in way.iter_mut().enumerate().filter(|(_, [rows, _])| *rows == 0.0) {
        let after = known.partition_point(|(known, _)| *known < at);
        *mean = match (after.checked_sub(1).map(|before| known[before]), known.get(after)) {
            (Some((before, low)), Some(&(next, high))) => {
                low + (high - low) * (at - before) as f64 / (next - before) as f64
            }
            (Some((_, only)), None) | (None, Some(&(_, only))) => only,
            (None, None) => 0.0,
        };
    }
}

fn sums(way: &[[f64; 2]]) -> Vec<Sums> {
    let mut total = [0.0; 6];
    let mut before = vec![total];
    for (at, [w, y]) in way.iter().enumerate() {
        let k = at as f64;
        for (total, more) in total.iter_mut().zip([*w, w * k, w * k * k, w * y, w * k * y, w * y * y]) {
            *total += more;
        }
        before.push(total);
    }
    before
}

#[cfg(test)]
mod tests {
    use super::super::testing::TestContact;
    use super::*;

    #[test]
    fn corners_lie_where_the_force_bends_or_jumps() {
        let trials = [TestContact::PLAIN.trial(1)];
        // A preload of 0.4 N that is there within a stretch, a soft way, and a stop.
        let force = |x: f64| if x < 0.0 { 0.0 } else { 0.4 + 50.0 * x + 3e3 * (x - 5e-3).max(0.0) };
        let columns = [trials[0].position.iter().map(|x| force(*x)).collect()];
        let ends = [-2e-3, 8e-3];
        let corners = DepthProfile::of(&trials, &columns, ends).corners(5);
        let stretch = (ends[1] - ends[0]) / BINS as f64;
        for (found, place) in corners.iter().zip([-2e-3, 0.0, 0.0, 5e-3, 8e-3]) {
            assert!((found - place).abs() < 1.5 * stretch, "{found} not {place}: {corners:?}");
        }
    }

    #[test]
    fn corners_are_as_many_as_asked_for_and_rise() {
        let trials = [TestContact::PLAIN.trial(1)];
        let profile = DepthProfile::of(&trials, &[trials[0].force.clone()], [-1e-3, 20e-3]);
        let corners = profile.corners(24);
        assert!(corners.len() == 24 && corners.windows(2).all(|pair| pair[0] < pair[1]), "{corners:?}");
    }
}
