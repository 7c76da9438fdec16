//! How much of a motion a picture over its state can show: a hundred loops over each other show nothing.

use std::ops::Range;

/// Ways from one end of the state to the other that are drawn.
const MOST_TRAVERSALS: f64 = 10.0;

/// `rows` where `state` goes to and fro a few times within them; else the rows from `first` on in which it does.
pub(super) fn limited(state: &[f32], rows: Range<usize>, first: usize) -> Range<usize> {
    let Some(within) = state.get(rows.clone()) else { return 0..0 };
    let numbers = || within.iter().filter(|value| value.is_finite()).map(|value| f64::from(*value));
    let (low, high) = numbers().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let most = MOST_TRAVERSALS * (high - low);
    let way = |from: usize| {
        let steps = state[from..rows.end].windows(2).map(|pair| f64::from((pair[1] - pair[0]).abs()));
        steps.scan(0.0, |sum, step| {
            *sum += step;
            Some(*sum)
        })
    };
    if way(rows.start).last().is_none_or(|whole| whole <= most) {
        return rows;
    }
    let first = first.clamp(rows.start, rows.end.saturating_sub(2));
    let count = way(first).take_while(|way| *way <= most).count();
    first..(first + count.max(1) + 1).min(rows.end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_loops_are_drawn_whole_and_many_in_part() {
        let wave = |period: f32| (0..1000).map(|row| (row as f32 / period).sin()).collect::<Vec<f32>>();
        assert_eq!(limited(&wave(100.0), 0..1000, 300), 0..1000);
        // A period of 2 pi 5 = 31 rows has two traversals: ten are five periods, 157 rows.
        let Range { start, end } = limited(&wave(5.0), 0..1000, 300);
        assert_eq!(start, 300);
        assert!((150..165).contains(&(end - start)), "{end}");
        assert_eq!(limited(&wave(5.0), 0..1000, 2000).start, 998);
        assert_eq!(limited(&[], 0..0, 0), 0..0);
    }
}
