//! A law that another one builds on.

/// An effect, by one of its forms or by any, that has to be there for another one to act as it says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Foundation {
    /// Name of the effect.
    pub name: &'static str,
    /// Index of its form; `None` where any will do.
    pub form: Option<usize>,
}

impl Foundation {
    /// The effect `name` by any of its forms.
    #[must_use]
    pub const fn any_form(name: &'static str) -> Self {
        Self { name, form: None }
    }

    /// The effect `name` by its form number `form`.
    #[must_use]
    pub const fn of_form(name: &'static str, form: usize) -> Self {
        Self { name, form: Some(form) }
    }

    /// Whether form `form` of the effect `name` is such a law.
    #[must_use]
    pub fn is(&self, name: &str, form: usize) -> bool {
        self.name == name && self.form.is_none_or(|own| own == form)
    }
}
