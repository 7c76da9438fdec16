//! Linear or rotary: the one place that knows the difference.

/// What the tool moves along. Everything else of the tool is written once, in the words of [`Coordinate::Linear`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Coordinate {
    /// Metres and newtons.
    #[default]
    Linear,
    /// Radians and newton metres.
    Rotary,
}

/// A name that differs between the coordinates: a key of the rig file, a column of a recording, a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word {
    /// In a linear rig.
    pub linear: &'static str,
    /// In a rotary rig.
    pub rotary: &'static str,
}

impl Coordinate {
    /// As the rig file spells it.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.pick(Word::new("linear", "rotary"))
    }

    /// The other one.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Linear => Self::Rotary,
            Self::Rotary => Self::Linear,
        }
    }

    /// `word` as this coordinate says it.
    #[must_use]
    pub fn pick(self, word: Word) -> &'static str {
        match self {
            Self::Linear => word.linear,
            Self::Rotary => word.rotary,
        }
    }

    /// Unit of position.
    #[must_use]
    pub fn position_unit(self) -> &'static str {
        self.pick(Word::new("m", "rad"))
    }

    /// Unit of velocity.
    #[must_use]
    pub fn velocity_unit(self) -> &'static str {
        self.pick(Word::new("m/s", "rad/s"))
    }

    /// Unit of force and effort.
    #[must_use]
    pub fn force_unit(self) -> &'static str {
        self.pick(Word::new("N", "N m"))
    }

    /// Unit of stiffness.
    #[must_use]
    pub fn stiffness_unit(self) -> &'static str {
        self.pick(Word::new("N/m", "N m/rad"))
    }

    /// Unit of damping and viscous friction.
    #[must_use]
    pub fn damping_unit(self) -> &'static str {
        self.pick(Word::new("N s/m", "N m s/rad"))
    }

    /// Unit of inertia.
    #[must_use]
    pub fn inertia_unit(self) -> &'static str {
        self.pick(Word::new("kg", "kg m^2"))
    }
}

impl Word {
    /// A word with a spelling a coordinate.
    #[must_use]
    pub const fn new(linear: &'static str, rotary: &'static str) -> Self {
        Self { linear, rotary }
    }

    /// A word that both coordinates spell alike.
    #[must_use]
    pub const fn same(name: &'static str) -> Self {
        Self::new(name, name)
    }
}
