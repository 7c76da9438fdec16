//! An effect between its table in a rig file and what is done with it.
//!
//! The table holds `name`, `form` where the effect has several laws, and for each parameter its value under
//! [`key_of`] and perhaps its 95 % interval, two numbers, under [`interval_key`].

use super::{ActiveEffect, Effect, Form, Parameter, Place, find, key_of, slug};
use crate::error::InputError;
use crate::rig::{self, Coordinate, Rig, nearest};

/// An effect with a law and its values.
#[derive(Clone)]
pub struct Resolved {
    /// Which one.
    pub effect: &'static dyn Effect,
    /// Index of its form.
    pub form: usize,
    /// In the order of the form's parameters.
    pub values: Vec<f64>,
}

impl Resolved {
    /// What `table` says, its keys as `coordinate` spells them; `origin` names the file in errors.
    ///
    /// # Errors
    /// An effect, a form or a key that is unknown, a parameter that is absent, no number, or out of its physical bounds,
    /// an interval that is none.
    pub fn read(table: &rig::Effect, coordinate: Coordinate, origin: &str) -> Result<Self, InputError> {
        let all = super::ALL.map(|effect| effect.spec().name);
        let effect = find(&table.name).ok_or_else(|| {
            let place = format!("{origin}: [[effect]] name");
            InputError::new(place, format!("the unknown effect \"{}\"", table.name), one_of(&table.name, &all))
        })?;
        let reader = Reader { table, coordinate, origin, forms: effect.spec().forms };
        let form = reader.form()?;
        let values = reader.forms[form].parameters.iter().map(|parameter| reader.value(parameter));
        Ok(Self { effect, form, values: values.collect::<Result<_, _>>()? })
    }

    /// The effect at work.
    #[must_use]
    pub fn active(&self) -> ActiveEffect<'_> {
        ActiveEffect { effect: self.effect, form: self.form, values: &self.values }
    }
}

/// Every effect of `rig`, in the file's order.
///
/// # Errors
/// As [`Resolved::read`], or an effect that acts in something that the rig does not have.
pub fn resolve_all(rig: &Rig, origin: &str) -> Result<Vec<Resolved>, InputError> {
    let resolve = |table: &rig::Effect| {
        let resolved = Resolved::read(table, rig.coordinate, origin)?;
        let (needed, is_there) = match resolved.effect.spec().place {
            Place::Contact | Place::Sensor => ("[contact]", rig.contact.is_some()),
            Place::Drive => ("[drive]", rig.drive.is_some()),
        };
        let place = format!("{origin}: [[effect]] {}", table.name);
        let found = format!("a rig without {needed}");
        if is_there { Ok(resolved) } else { Err(InputError::new(place, found, format!("a table {needed}"))) }
    };
    rig.effects.iter().map(resolve).collect()
}

/// The table of an effect, with the intervals of those parameters whose interval is finite.
#[must_use]
pub fn to_table(
    effect: &'static dyn Effect,
    form: usize,
    coordinate: Coordinate,
    values: &[f64],
    intervals: Option<&[(f64, f64)]>,
) -> rig::Effect {
    let spec = effect.spec();
    let mut table = toml::Table::new();
    let Some(law) = spec.forms.get(form) else { return rig::Effect { name: spec.name.to_owned(), parameters: table } };
    if spec.forms.len() > 1 {
        table.insert("form".to_owned(), law.name.into());
    }
    for (at, (parameter, value)) in law.parameters.iter().zip(values).enumerate() {
        table.insert(key_of(parameter, coordinate), (*value).into());
        let interval = intervals.and_then(|intervals| intervals.get(at)).filter(|_| !parameter.fixed);
        // A rig file holds finite numbers only; an interval that is open says nothing.
        if let Some((low, high)) = interval.filter(|(low, high)| low.is_finite() && high.is_finite()) {
            table.insert(interval_key(parameter, coordinate), vec![*low, *high].into());
        }
    }
    rig::Effect { name: spec.name.to_owned(), parameters: table }
}

/// The key of a parameter's 95 % interval in a rig file: `alpha_ci95_n_s_m2`.
#[must_use]
pub fn interval_key(parameter: &Parameter, coordinate: Coordinate) -> String {
    match slug(coordinate.pick(parameter.unit)).as_str() {
        "" => format!("{}_ci95", parameter.name),
        suffix => format!("{}_ci95_{suffix}", parameter.name),
    }
}

fn one_of(name: &str, among: &[&str]) -> String {
    match nearest(name, among) {
        Some(near) => format!("{near} perhaps, or one of {}", among.join(", ")),
        None => format!("one of {}", among.join(", ")),
    }
}

struct Reader<'a> {
    table: &'a rig::Effect,
    coordinate: Coordinate,
    origin: &'a str,
    forms: &'static [Form],
}

impl Reader<'_> {
    fn error(&self, key: &str, found: impl std::fmt::Display, expected: impl std::fmt::Display) -> InputError {
        InputError::new(format!("{}: [[effect]] {}: {key}", self.origin, self.table.name), found, expected)
    }

    /// The form that is named, or the first that these keys fit.
    fn form(&self) -> Result<usize, InputError> {
        if let Some(given) = self.table.parameters.get("form") {
            let names: Vec<_> = self.forms.iter().map(|form| form.name).collect();
            let named = given.as_str().and_then(|given| names.iter().position(|name| *name == given));
            let expected = || one_of(given.as_str().unwrap_or_default(), &names);
            let form = named.ok_or_else(|| self.error("form", given, expected()))?;
            self.refuse_misfit(form)?;
            return Ok(form);
        }
        let fits = (0..self.forms.len()).find(|form| self.refuse_misfit(*form).is_ok());
        match fits {
            Some(form) => Ok(form),
            None => {
                let form = self.likeliest();
                self.refuse_misfit(form).map(|()| form)
            }
        }
    }

    /// The form that most of the keys belong to.
    fn likeliest(&self) -> usize {
        let held = |form: &Form| form.parameters.iter().filter(|parameter| self.holds(parameter)).count();
        // The first of equals, which is the simplest.
        (0..self.forms.len()).rev().max_by_key(|form| held(&self.forms[*form])).unwrap_or_default()
    }

    fn holds(&self, parameter: &Parameter) -> bool {
        self.table.parameters.contains_key(&key_of(parameter, self.coordinate))
    }

    /// Whether the keys are those of the form: an unknown one first, for it is often the absent one misspelt.
    fn refuse_misfit(&self, form: usize) -> Result<(), InputError> {
        let parameters = self.forms[form].parameters;
        let keys = |coordinate| {
            let all = parameters.iter().flat_map(move |p| [key_of(p, coordinate), interval_key(p, coordinate)]);
            all.collect::<Vec<_>>()
        };
        let known = keys(self.coordinate);
        let mut given = self.table.parameters.keys().filter(|key| *key != "form");
        if let Some(unknown) = given.find(|key| !known.contains(key)) {
            let other = self.coordinate.other();
            if let Some(at) = keys(other).iter().position(|key| key == unknown) {
                let found = format!("a key of a {} rig in a {} one", other.name(), self.coordinate.name());
                return Err(self.error(unknown, found, &known[at]));
            }
            let names: Vec<_> = known.iter().map(String::as_str).collect();
            let found = format!("an unknown key of {}", self.forms[form].name);
            return Err(self.error(unknown, found, one_of(unknown, &names)));
        }
        match parameters.iter().find(|parameter| !self.holds(parameter)) {
            Some(absent) => {
                let expected = format!("{}, {}", absent.meaning, bounds(absent));
                Err(self.error(&key_of(absent, self.coordinate), "nothing", expected))
            }
            None => Ok(()),
        }
    }

    fn value(&self, parameter: &Parameter) -> Result<f64, InputError> {
        let key = key_of(parameter, self.coordinate);
        let given = self.table.parameters.get(&key);
        let is_within = |value: &f64| (parameter.low..=parameter.high).contains(value);
        let Some(value) = given.and_then(number).filter(is_within) else {
            let found = given.map_or_else(|| "nothing".to_owned(), ToString::to_string);
            return Err(self.error(&key, found, bounds(parameter)));
        };
        self.refuse_bad_interval(parameter)?;
        Ok(value)
    }

    fn refuse_bad_interval(&self, parameter: &Parameter) -> Result<(), InputError> {
        let key = interval_key(parameter, self.coordinate);
        let Some(given) = self.table.parameters.get(&key) else { return Ok(()) };
        let ends = given.as_array().map(|ends| ends.iter().map(number).collect::<Vec<_>>());
        match ends.as_deref() {
            Some([Some(low), Some(high)]) if low <= high => Ok(()),
            _ => Err(self.error(&key, given, "the two ends of an interval, the lower first")),
        }
    }
}

fn number(value: &toml::Value) -> Option<f64> {
    let whole = || value.as_integer().map(|whole| whole as f64);
    value.as_float().or_else(whole).filter(|number| number.is_finite())
}

fn bounds(parameter: &Parameter) -> String {
    match (parameter.low.is_finite(), parameter.high.is_finite()) {
        (true, true) => format!("a number from {} to {}", parameter.low, parameter.high),
        (true, false) => format!("a number of {} or above", parameter.low),
        (false, true) => format!("a number of {} or below", parameter.high),
        (false, false) => "a finite number".to_owned(),
    }
}
