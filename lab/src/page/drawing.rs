//! A replay on its way to the page: it passes row by row, as often as is needed, and only what is drawn is kept.

use super::contact::{Contact, ContactSpan};
use super::thin::{self, Search};
use super::{ESTIMATE_COLUMNS, Estimates};

/// Rows that each trial of a page may show, where every one of `trials` has `methods`.
#[must_use]
pub fn budget(trials: usize, methods: usize) -> usize {
    thin::budget(trials * (5 + ESTIMATE_COLUMNS * methods))
}

/// A row of a replay.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a> {
    /// Seconds.
    pub time: f64,
    /// Depth below the rig's surface.
    pub penetration: f32,
    /// Measured contact force.
    pub force: f32,
    /// The contact detection.
    pub contact: bool,
    /// Of each method, in the order of the fields of [`Estimates`].
    pub estimates: &'a [[f32; ESTIMATE_COLUMNS]],
}

/// Chooses and keeps the rows of a trial that the page draws.
///
/// All rows are handed to it in order, again and again until [`Drawing::end_of_pass`] has had enough: a trial of any length costs
/// the kept rows, and a byte a row for the contact.
pub struct Drawing {
    total: usize,
    budget: usize,
    step: Step,
    span: Contact,
    flags: Vec<bool>,
    /// Index of the next row.
    row: usize,
    drawn: Drawn,
}

enum Step {
    Search(Search),
    /// The rows, ascending, and how many of them were taken.
    Collect(Vec<usize>, usize),
}

/// What of a recording is drawn, and what was counted in all of it. All vectors are of equal length.
#[derive(Debug, Clone, Default)]
pub struct Drawn {
    /// Rows of the whole recording.
    pub samples: usize,
    /// Time of the whole recording, and its contact.
    pub span: ContactSpan,
    /// Seconds.
    pub time: Vec<f64>,
    /// Depth below the rig's surface, positive into the environment.
    pub penetration: Vec<f32>,
    /// Measured contact force, positive when the tool pushes.
    pub force: Vec<f32>,
    /// The contact detection.
    pub contact: Vec<bool>,
    /// Of each method.
    pub estimates: Vec<Estimates>,
}

impl Drawing {
    /// For `total` rows of `methods` estimators, of which at most `budget` are drawn.
    #[must_use]
    pub fn new(total: usize, methods: usize, budget: usize) -> Self {
        // Depth, force and the innovation of each method.
        let search = Search::new(total, 2 + methods, budget);
        let step = search.map_or_else(|| Step::Collect((0..total).collect(), 0), Step::Search);
        let drawn = Drawn { samples: total, estimates: vec![Estimates::default(); methods], ..Drawn::default() };
        Self { total, budget, step, span: Contact::default(), flags: Vec::new(), row: 0, drawn }
    }

    /// The next row.
    pub fn take(&mut self, row: Row<'_>) {
        if self.flags.len() < self.total {
            self.flags.push(row.contact);
            self.span.take(row.time, row.contact);
        }
        match &mut self.step {
            Step::Search(search) => {
                let innovations = row.estimates.iter().map(|[.., innovation]| *innovation);
                search.take([row.penetration, row.force].into_iter().chain(innovations));
            }
            Step::Collect(rows, taken) if rows.get(*taken) == Some(&self.row) => {
                *taken += 1;
                self.drawn.push(row);
            }
            Step::Collect(..) => {}
        }
        self.row += 1;
    }

    /// After the last row: whether all that is drawn has been had, or all rows are needed once more.
    pub fn end_of_pass(&mut self) -> bool {
        self.row = 0;
        let Step::Search(search) = &mut self.step else { return true };
        let edges = thin::edges(&self.flags, self.budget / 2);
        if let Some(rows) = search.end_of_pass(&edges) {
            self.step = Step::Collect(rows, 0);
        }
        false
    }

    /// What is drawn.
    #[must_use]
    pub fn finish(self) -> Drawn {
        Drawn { span: self.span.finish(), ..self.drawn }
    }
}

impl Drawn {
    fn push(&mut self, row: Row<'_>) {
        self.time.push(row.time);
        self.penetration.push(row.penetration);
        self.force.push(row.force);
        self.contact.push(row.contact);
        self.estimates.iter_mut().zip(row.estimates).for_each(|(columns, estimate)| columns.push(*estimate));
    }
}
