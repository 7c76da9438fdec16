//! The median of numbers that are not kept.

/// A median is found by the upper half of a number's bits first, then by the lower half.
const HALF_BITS: u32 = 16;
const HALVES: usize = 1 << HALF_BITS;

/// The lower median, in the order of [`f32::total_cmp`], of numbers that are handed over twice: a million of them take the room of one.
///
/// The first pass counts the numbers by the upper half of their bits, the second those that share the median's upper half by the lower.
pub struct Median {
    counts: Vec<u32>,
    stage: Stage,
}

#[derive(Clone, Copy)]
enum Stage {
    Upper,
    /// The median's upper half, and how many numbers of that half are below the median.
    Lower(usize, usize),
    Known(Option<f32>),
}

impl Default for Median {
    fn default() -> Self {
        Self { counts: vec![0; HALVES], stage: Stage::Upper }
    }
}

impl Median {
    /// Takes the next number of a pass.
    pub fn take(&mut self, value: f32) {
        let key = ordered(value) as usize;
        let (upper, lower) = (key >> HALF_BITS, key % HALVES);
        match self.stage {
            Stage::Upper => self.counts[upper] += 1,
            Stage::Lower(half, _) if half == upper => self.counts[lower] += 1,
            _ => {}
        }
    }

    /// After the last number of a pass.
    pub fn end_of_pass(&mut self) {
        self.stage = match self.stage {
            Stage::Upper => match self.counts.iter().map(|count| *count as usize).sum::<usize>().checked_sub(1) {
                None => Stage::Known(None),
                Some(last) => {
                    let (upper, below) = self.at_rank(last / 2);
                    Stage::Lower(upper, below)
                }
            },
            Stage::Lower(upper, below) => {
                let (lower, _) = self.at_rank(below);
                Stage::Known(Some(number((upper << HALF_BITS | lower) as u32)))
            }
            known @ Stage::Known(_) => known,
        };
        self.counts.fill(0);
    }

    /// The median; `None` before the second pass is over, and where there are no numbers.
    #[must_use]
    pub fn value(&self) -> Option<f32> {
        match self.stage {
            Stage::Known(value) => value,
            _ => None,
        }
    }

    /// The half of the number of `rank`, counted from the least, and how many numbers of this half are below it.
    fn at_rank(&self, rank: usize) -> (usize, usize) {
        let mut below = rank;
        for (half, count) in self.counts.iter().enumerate() {
            match below.checked_sub(*count as usize) {
                None => return (half, below),
                Some(rest) => below = rest,
            }
        }
        // More numbers were counted than `rank`.
        (HALVES - 1, 0)
    }
}

/// Bits that ascend with the number.
fn ordered(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The number of [`ordered`] bits.
fn number(ordered: u32) -> f32 {
    f32::from_bits(if ordered >> 31 == 1 { ordered & !(1 << 31) } else { !ordered })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn median(values: &[f32]) -> Option<f32> {
        let mut median = Median::default();
        for _ in 0..2 {
            values.iter().for_each(|value| median.take(*value));
            median.end_of_pass();
        }
        median.value()
    }

    #[test]
    fn it_is_the_number_in_the_middle_of_the_sorted_ones() {
        let mut random = 1_u32;
        let mut draw = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            random
        };
        for count in [1, 2, 3, 10, 999, 1000] {
            // Any bits, also those of what is no number; and numbers that share their upper half.
            let wild: Vec<f32> = (0..count).map(|_| f32::from_bits(draw())).collect();
            let near: Vec<f32> = (0..count).map(|_| 300.0 + (draw() >> 20) as f32 * 1e-4).collect();
            for values in [wild, near] {
                let mut sorted = values.clone();
                sorted.sort_by(f32::total_cmp);
                let middle = sorted[(count - 1) / 2];
                assert_eq!(median(&values).map(f32::to_bits), Some(middle.to_bits()), "{count} numbers");
            }
        }
    }

    #[test]
    fn a_zero_and_its_negative_are_two_numbers_and_nothing_has_none() {
        assert_eq!(median(&[0.0, -0.0, 1.0, -0.0]).map(f32::to_bits), Some((-0.0_f32).to_bits()));
        assert_eq!(median(&[]), None);
    }
}
