//! Comparison that fails on NaN, and a ledger of how close the comparisons were.

/// Fails unless `|got - want| <= rel |want| + abs`; a NaN on either side makes that false.
#[track_caller]
pub fn close(what: &str, got: f64, want: f64, rel: f64, abs: f64) {
    let error = (got - want).abs();
    let allowed = rel * want.abs() + abs;
    assert!(error <= allowed, "{what}: got {got:e}, want {want:e}, error {error:e} above {allowed:e}");
}

/// The errors of one quantity over many comparisons.
#[derive(Debug, Clone, Default)]
pub struct Ledger {
    /// How many comparisons.
    pub count: usize,
    /// How many of them agreed to the last bit.
    pub exact: usize,
    /// The largest error over its scale.
    pub worst: f64,
    /// The largest error over its tolerance.
    pub used: f64,
}

impl Ledger {
    /// One comparison: its error is judged against `tolerance` and reported over `scale`.
    #[track_caller]
    pub fn compare(&mut self, what: &str, got: f64, want: f64, scale: f64, tolerance: f64) {
        close(what, got, want, 0.0, tolerance);
        let error = (got - want).abs();
        self.count += 1;
        self.exact += usize::from(error == 0.0);
        self.worst = self.worst.max(error / scale);
        self.used = self.used.max(error / tolerance);
    }

    /// Prints one line, and fails where single precision pretends to be exact: then nothing was compared with anything.
    #[track_caller]
    pub fn conclude(&self, what: &str, at_least: usize) {
        println!(
            "{what:<44} {:>7} compared, worst {:9.2e} of the value, {:6.3} of the tolerance",
            self.count, self.worst, self.used
        );
        assert!(self.count >= at_least, "{what}: {} comparisons, expected at least {at_least}", self.count);
        assert!(self.exact < self.count, "{what}: all {} are exact, in single precision", self.count);
    }

    /// Of two ledgers the sum and the worse.
    pub fn join(&mut self, other: &Self) {
        self.count += other.count;
        self.exact += other.exact;
        self.worst = self.worst.max(other.worst);
        self.used = self.used.max(other.used);
    }
}

#[test]
#[should_panic(expected = "NaN")]
fn nan_is_not_close_to_anything() {
    close("NaN", f64::NAN, 0.0, 1.0, f64::INFINITY);
}

#[test]
#[should_panic(expected = "all 2 are exact")]
fn agreement_to_the_last_bit_everywhere_is_suspicious() {
    let mut ledger = Ledger::default();
    ledger.compare("same", 1.0, 1.0, 1.0, 1e-3);
    ledger.compare("same", 2.0, 2.0, 1.0, 1e-3);
    ledger.conclude("same", 1);
}
