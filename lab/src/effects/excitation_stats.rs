//! The measures of a set of recordings, from which every search takes its scale: nothing is absolute.

/// What the recordings and the nominal model fitted to them measure.
#[derive(Debug, Clone, Default)]
pub struct ExcitationStats {
    /// Greatest depth in contact, m or rad; zero without contact.
    pub depth: f64,
    /// Root mean square of the speed in contact, or of all the motion where nothing is touched.
    pub speed: f64,
    /// Root mean square of the acceleration.
    pub acceleration: f64,
    /// Greatest measured force in size.
    pub force: f64,
    /// Greatest pull that was measured, in size; zero where there is none.
    pub pull: f64,
    /// Greatest height above the surface at which half of that pull was measured or more.
    pub half_pull_height: f64,
    /// Greatest effort in size; zero where none is recorded.
    pub effort: f64,
    /// Least and greatest position.
    pub travel: (f64, f64),
    /// Length of the longest trial, s.
    pub duration: f64,
    /// Step of the analysis, s.
    pub step: f64,
    /// Seconds of one raw sample.
    pub sample: f64,
    /// Fitted stiffness.
    pub stiffness: f64,
    /// Fitted inertia.
    pub inertia: f64,
    /// How often the tool went in: passes inwards of a fifth of the depth or more, over all trials.
    pub visits: usize,
    /// How often the tool left the surface, over all trials.
    pub releases: usize,
    /// Farthest way back out in contact, over all the way in.
    pub way_back: f64,
    /// Share of the time between the first and the last moment without contact.
    pub free_span: f64,
    /// Share of a trial in the longest stretch without a free moment, of all trials.
    pub longest_contact: f64,
    /// Whether there is a force channel.
    pub has_force: bool,
    /// Whether there is an effort channel.
    pub has_effort: bool,
    /// Whether the rig turns.
    pub is_rotary: bool,
    /// Whether the contact pulls as well.
    pub is_bilateral: bool,
}

impl ExcitationStats {
    /// The slowest swing of a link that can be identified, rad/s, the whole moved mass on it: the corner of the filter through which the
    /// drive is analysed. Motor against tool swings at twice that at the least; a link that is softer smooths the balance of its
    /// noise, and seems to explain it.
    #[must_use]
    pub fn min_link_rate(&self) -> f64 {
        std::f64::consts::TAU * 0.2 / self.step
    }

    /// Whether the tool came back far enough for what differs between in and out to show.
    #[must_use]
    pub fn has_unloading(&self) -> bool {
        self.way_back > 0.02
    }

    /// Whether the tool was free for so long that what the sensor shows then is seen behind the filter.
    #[must_use]
    pub fn shows_sensor_zero(&self) -> bool {
        self.free_span * self.duration > 10.0 * self.step
    }

    /// Greatest pull in `forces`, in size; zero where none pulls.
    #[must_use]
    pub fn greatest_pull<'a>(forces: impl Iterator<Item = &'a f64>) -> f64 {
        forces.fold(0.0, |most, force| most.max(-force))
    }

    /// Greatest height, m or rad, in `rows` of force and height above the surface at which the force pulls by half of `pull` or more; zero where none does.
    #[must_use]
    pub fn half_pull_height(pull: f64, rows: impl Iterator<Item = (f64, f64)>) -> f64 {
        let pulled = rows.filter(|(force, _)| pull > 0.0 && *force <= -0.5 * pull);
        pulled.map(|(_, height)| height).fold(0.0, f64::max)
    }

    /// Whether the effect of time can be separated from that of depth: only where the same depth was visited again.
    #[must_use]
    pub fn separates_time_from_depth(&self) -> bool {
        self.visits >= 3
    }
}

/// Where a search starts.
///
/// Where `linear_parameters` is not empty, the effect is linear in the parameters of those indices: it is tried with each of them
/// alone at its value here, and their true values follow by linear least squares. Where it is empty, the values are one
/// point of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// One value a parameter.
    pub values: Vec<f64>,
    /// Indices of the linear ones.
    pub linear_parameters: Vec<usize>,
}

impl Start {
    /// A point of a grid.
    #[must_use]
    pub fn at(values: &[f64]) -> Self {
        Self { values: values.to_vec(), linear_parameters: Vec::new() }
    }

    /// A point that is linear in the parameters `linear_parameters`.
    #[must_use]
    pub fn sized(values: &[f64], linear: &[usize]) -> Self {
        Self { values: values.to_vec(), linear_parameters: linear.to_vec() }
    }
}

/// Where a form that repeats shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToneWeight {
    /// Everywhere.
    Even,
    /// In contact.
    Inside,
    /// In contact, the more the deeper.
    Depth,
}

/// The frequencies among which a form that repeats is searched: the residual's own spectrum says which are worth a trial.
#[derive(Debug, Clone)]
pub struct FrequencySearch {
    /// Where it shows.
    pub weight: ToneWeight,
    /// Equally spaced, Hz: first, spacing, count.
    pub frequencies: Vec<(f64, f64, usize)>,
    /// Size of each part of the wave.
    pub size: f64,
    /// How many multiples of a frequency, itself the first, the form has.
    pub harmonics: usize,
}

impl FrequencySearch {
    /// Where the search starts at `frequency`.
    #[must_use]
    pub fn start(&self, frequency: f64) -> Start {
        let parts = 2 * self.harmonics;
        let mut values = vec![self.size; parts];
        values.push(frequency);
        Start::sized(&values, &(0..parts).collect::<Vec<_>>())
    }
}

/// `count` values from `low` to `high`, each the same factor above the last; none where the range is empty.
#[must_use]
pub fn geometric(low: f64, high: f64, count: usize) -> Vec<f64> {
    if !(low > 0.0 && high >= low) {
        return Vec::new();
    }
    let ratio = high / low;
    (0..count).map(|at| low * ratio.powf(at as f64 / (count.max(2) - 1) as f64)).collect()
}

/// `count` values from `low` to `high` in equal steps.
#[must_use]
pub fn linear(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|at| low + (high - low) * at as f64 / (count.max(2) - 1) as f64).collect()
}
