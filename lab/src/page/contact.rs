//! How long a recording is in contact, and how often it touches.

/// Break between two stretches of contact, over the longer of them, below which the tool bounced and they are one touch.
const MAX_BOUNCE_GAP_RATIO: f64 = 0.1;

/// Times of a whole recording.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactSpan {
    /// From the first to the last row, in seconds.
    pub duration: f64,
    /// Seconds in contact.
    pub seconds: f64,
    /// Touches as a person counts them: the bounces of one are no touches of their own.
    pub touches: usize,
}

/// Counts the [`ContactSpan`] row by row.
#[derive(Debug, Clone, Default)]
pub(super) struct Contact {
    start: Option<f64>,
    before: Option<(f64, bool)>,
    seconds: f64,
    /// Beginning and end of the stretch of contact that is under way.
    stretch: Option<[f64; 2]>,
    /// The touch before it.
    touch: Option<[f64; 2]>,
    touches: usize,
}

impl Contact {
    /// The next row.
    pub(super) fn take(&mut self, time: f64, contact: bool) {
        self.start.get_or_insert(time);
        if let Some((before, true)) = self.before {
            self.seconds += time - before;
        }
        match &mut self.stretch {
            Some(stretch) if contact => stretch[1] = time,
            None if contact => self.stretch = Some([time, time]),
            _ => self.end_of_stretch(),
        }
        self.before = Some((time, contact));
    }

    /// After the last row.
    pub(super) fn finish(mut self) -> ContactSpan {
        self.end_of_stretch();
        let duration = self.before.map_or(0.0, |(end, _)| end - self.start.unwrap_or(end));
        ContactSpan { duration, seconds: self.seconds, touches: self.touches }
    }

    fn end_of_stretch(&mut self) {
        let Some(stretch) = self.stretch.take() else { return };
        let length = |[start, end]: [f64; 2]| end - start;
        match &mut self.touch {
            Some(touch) if stretch[0] - touch[1] < MAX_BOUNCE_GAP_RATIO * length(*touch).max(length(stretch)) => {
                touch[1] = stretch[1];
            }
            _ => {
                self.touch = Some(stretch);
                self.touches += 1;
            }
        }
    }
}
