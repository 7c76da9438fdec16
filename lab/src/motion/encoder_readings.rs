//! What an encoder says of a path: its readings, and the instants at which they change.
//!
//! A reading that nothing shakes is the same for as long as the path stays between two lines, and all its rows repeat one error; where it changes, the path is on
//! the line between both readings, as exactly as it moves between two rows (R. J. E. Merry, M. J. G. van de Molengraft, M. Steinbuch, *Velocity and
//! acceleration estimation for optical incremental encoders*, Mechatronics 20 (2010) 20). So the rows of one reading share one error, and each
//! change by one step is a row of its own, in the middle of the time in which it happened. Of a reading that stands for one row the change tells what the two rows tell,
//! and is none. Where noise carries the reading over its steps, rounding is white noise (B. Widrow, I. Kollár, *Quantization Noise*, 2008, ch. 5), and the rows stand
//! as they are.

use crate::sensors::Channel;

/// Readings and line crossings in the order of time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EncoderReadings {
    /// s.
    pub time: Vec<f64>,
    /// m or rad.
    pub position: Vec<f64>,
    /// Variance of the position, of a row by itself.
    pub variance: Vec<f64>,
    /// Rows in sequence, this one among them, that have one error; one where it is its own.
    pub sharing: Vec<f64>,
    /// Whether it is a row of the recording, and not a crossing.
    pub is_row: Vec<bool>,
    /// Usual time between rows of the recording, s.
    pub step_s: f64,
}

/// Part of a step by which a reading may be off the encoder's grid, as far as a file's last digit takes it, and the share of rows that may be farther, as
/// interpolated ones are. Of ten rigs behind 0.1 mm no error changes at ten times it; at a tenth of it files of few digits lose their crossings, and the position's
/// errors grow by 7 %.
const OFF_GRID: f64 = 0.01;

/// Part of a step to which the place of an encoder's line is known at the best: no line is where it should be. On the same rigs no error changes from a tenth of it
/// to ten times it, and at a hundred times it none of position or velocity by more than a hundredth.
const LINE_PLACE: f64 = 1e-3;

/// Deviation of the noise, in steps, from which rows stand as they are: each time that noise carries the reading over a line would be taken for a crossing. Of sums of four
/// sines, up to 25 Hz and of 2.5 to 250 steps, rows at 1 kHz: with crossings the errors of velocity and acceleration are 0.5 to 1.09 of those without at 0.15 of a step of
/// noise, 0.86 to 1.25 at 0.2, and 1.05 to 1.2 from 0.3 on.
const SHAKEN: f64 = 0.2;

/// Usual times between rows that may lie between two readings of which the change is taken for a crossing: between one, of rows that follow each other, and two, of
/// which a row is lost.
const LONGEST_CROSSING: f64 = 1.5;

impl EncoderReadings {
    /// Rows `position` at the instants `time`, whose errors are white of `variance`.
    #[must_use]
    pub fn white(time: &[f64], position: &[f64], variance: f64) -> Self {
        Self {
            time: time.to_vec(),
            position: position.to_vec(),
            variance: vec![variance; time.len()],
            sharing: vec![1.0; time.len()],
            is_row: vec![true; time.len()],
            step_s: usual_step(time),
        }
    }

    /// Rows `position` of `encoder` at the instants `time`.
    #[must_use]
    pub fn of(time: &[f64], position: &[f64], encoder: Channel) -> Self {
        let rounding = encoder.resolution.powi(2) / 12.0;
        let shake = (encoder.noise.powi(2) - rounding).max(0.0);
        let is_shaken = shake.sqrt() > SHAKEN * encoder.resolution;
        if encoder.resolution <= 0.0 || is_shaken || !is_on_grid(position, encoder.resolution) {
            return Self::white(time, position, shake + rounding);
        }
        let runs = runs(position, encoder.resolution);
        let mut readings = Self { step_s: usual_step(time), ..Self::default() };
        for row in 0..time.len() {
            // Rows that the quicker of both readings stood: between two rows it moves by a step over so many.
            let stood = if row > 0 { runs[row - 1].min(runs[row]) } else { 1.0 };
            if stood > 1.0 && readings.is_crossing(&time[row - 1..=row], &position[row - 1..=row], encoder.resolution) {
                let moved = encoder.resolution * stood.recip().max(LINE_PLACE);
                let line = position[row - 1].midpoint(position[row]);
                let crossed = time[row - 1].midpoint(time[row]);
                readings.push([crossed, line, moved * moved / 12.0 + shake, 1.0], false);
            }
            readings.push([time[row], position[row], rounding + shake, runs[row]], true);
        }
        readings
    }

    /// Whether neighbouring rows share the rounding of a reading that nothing shakes.
    #[must_use]
    pub fn goes_in_steps(&self) -> bool {
        self.sharing.iter().any(|rows| *rows > 1.0)
    }

    fn push(&mut self, [time, position, variance, sharing]: [f64; 4], is_row: bool) {
        self.time.push(time);
        self.position.push(position);
        self.variance.push(variance);
        self.sharing.push(sharing);
        self.is_row.push(is_row);
    }

    /// Whether from the first to the second of two rows the reading changes by one `resolution`.
    fn is_crossing(&self, time: &[f64], position: &[f64], resolution: f64) -> bool {
        let steps = (position[1] - position[0]) / resolution;
        steps.abs().round() == 1.0 && time[1] - time[0] < LONGEST_CROSSING * self.step_s
    }
}

/// The middle of the times between rows; zero of fewer than two.
fn usual_step(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Whether `position` goes in steps of `resolution`.
fn is_on_grid(position: &[f64], resolution: f64) -> bool {
    let is_off = |pair: &&[f64]| {
        let steps = (pair[1] - pair[0]) / resolution;
        (steps - steps.round()).abs() > OFF_GRID
    };
    let off = position.windows(2).filter(is_off).count();
    off as f64 <= OFF_GRID * position.len() as f64
}

/// Of each row, how many rows in sequence have its reading.
fn runs(position: &[f64], resolution: f64) -> Vec<f64> {
    let is_same = |a: &f64, b: &f64| ((a - b) / resolution).abs() < 0.5;
    position.chunk_by(is_same).flat_map(|run| std::iter::repeat_n(run.len() as f64, run.len())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const COARSE: Channel = Channel { resolution: 1.0, noise: 0.289 };

    /// By hand: a reading that stands for three rows has one error in all of them, and its change to one that stands for two is a crossing between them, known to the
    /// twelfth of the square of half a step.
    #[test]
    fn a_change_of_a_reading_is_a_row_of_its_own() {
        let time: Vec<f64> = (0..10).map(f64::from).collect();
        let read = EncoderReadings::of(&time, &[0.0, 0.0, 0.0, 1.0, 1.0, 3.0, 3.0, 2.0, 2.0, 1.0], COARSE);
        let crossings: Vec<usize> = (0..read.time.len()).filter(|at| !read.is_row[*at]).collect();
        let told: Vec<(f64, f64)> = crossings.iter().map(|at| (read.time[*at], read.position[*at])).collect();
        // From one to three two lines are crossed, at instants that are not known; the last reading stands for one row.
        assert_eq!(told, [(2.5, 0.5), (6.5, 2.5)]);
        let shake = COARSE.noise.powi(2) - 1.0 / 12.0;
        assert!((read.variance[crossings[0]] - (0.25 / 12.0 + shake)).abs() < 1e-12);
        assert!((read.variance[0] - (1.0 / 12.0 + shake)).abs() < 1e-12);
        assert_eq!(read.sharing, [3.0, 3.0, 3.0, 1.0, 2.0, 2.0, 2.0, 2.0, 1.0, 2.0, 2.0, 1.0]);
    }

    /// A pause in which a reading changed tells no instant; noise of a fifth of a step or more makes rounding white; readings between the steps are none of them.
    #[test]
    fn only_what_goes_in_steps_row_by_row_crosses_lines() {
        let (time, position) = ([0.0, 1.0, 2.0, 9.0, 10.0, 11.0], [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
        assert!(EncoderReadings::of(&time, &position, COARSE).is_row.iter().all(|is_row| *is_row));
        let steady = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        let shaken = |noise: f64| {
            EncoderReadings::of(&steady, &position, Channel { noise: noise.hypot(COARSE.noise), ..COARSE })
        };
        assert!(shaken(0.15).is_row.iter().any(|is_row| !is_row));
        let white = shaken(0.25);
        assert!(white.is_row.iter().all(|is_row| *is_row));
        // The root and the square cost the last digit.
        let both = 0.0625 + COARSE.noise.powi(2);
        assert!(white.variance.iter().all(|variance| (variance - both).abs() < 1e-15));
        let (time, between) = ([0.0, 1.0, 2.0, 3.0, 4.0, 5.0], position.map(|place| 1.3 * place));
        let white = EncoderReadings::white(&time, &between, COARSE.noise.powi(2).max(1.0 / 12.0));
        let read = EncoderReadings::of(&time, &between, COARSE);
        assert_eq!((read.is_row, read.position), (white.is_row, white.position));
    }
}
