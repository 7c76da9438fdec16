//! One table of a rig file, read key by key so that what is left over can be refused.

use std::cell::RefCell;
use std::fmt::Display;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::coordinate::{Coordinate, Word};
use crate::error::InputError;

/// Which numbers a key may hold.
#[derive(Debug, Clone, Copy)]
pub enum Range {
    /// Above zero.
    Positive,
    /// Zero or above.
    NotNegative,
    /// Any finite number.
    Finite,
}

impl Range {
    fn holds(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Positive => value > 0.0,
                Self::NotNegative => value >= 0.0,
                Self::Finite => true,
            }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Positive => "a number above zero",
            Self::NotNegative => "a number of zero or above",
            Self::Finite => "a finite number",
        }
    }
}

/// A table and the file it stands in.
pub struct Table<'a> {
    /// Path of the file, for messages.
    origin: &'a str,
    text: &'a str,
    /// "drive", or nothing for the file itself.
    name: &'a str,
    /// Byte where the table begins.
    start: usize,
    entries: Option<&'a DeTable<'a>>,
    coordinate: Coordinate,
    known: RefCell<Vec<Word>>,
}

/// Line of byte `at`, counted from one.
pub fn line_of(text: &str, at: usize) -> usize {
    1 + text.as_bytes()[..at.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
}

impl<'a> Table<'a> {
    /// The whole file.
    pub fn root(origin: &'a str, text: &'a str, entries: &'a DeTable<'a>) -> Self {
        let known = RefCell::default();
        Self { origin, text, name: "", start: 0, entries: Some(entries), coordinate: Coordinate::Linear, known }
    }

    /// The table `name` within this one, empty where the file has none.
    ///
    /// # Errors
    /// `name` is there and no table.
    pub fn table(&self, name: &'static str, coordinate: Coordinate) -> Result<Self, InputError> {
        let (start, entries) = match self.value(Word::same(name)) {
            None => (0, None),
            Some((_, value)) => match value.get_ref() {
                DeValue::Table(entries) => (value.span().start, Some(entries)),
                other => return Err(self.error(name, value.span().start, shown(other), format!("a table [{name}]"))),
            },
        };
        let known = RefCell::default();
        Ok(Self { origin: self.origin, text: self.text, name, start, entries, coordinate, known })
    }

    /// Whether the file has this table.
    pub fn is_there(&self) -> bool {
        self.entries.is_some()
    }

    /// A number, `None` where it is absent.
    ///
    /// # Errors
    /// Text, or a number outside of `range`.
    pub fn number(&self, key: Word, range: Range) -> Result<Option<f64>, InputError> {
        let Some((name, value)) = self.value(key) else {
            self.refuse_other_coordinate(key)?;
            return Ok(None);
        };
        let number = match value.get_ref() {
            DeValue::Float(text) => text.as_str().parse().ok(),
            DeValue::Integer(text) => i64::from_str_radix(text.as_str(), text.radix()).ok().map(|whole| whole as f64),
            _ => None,
        };
        match number {
            Some(number) if range.holds(number) => Ok(Some(number)),
            _ => Err(self.error(name, value.span().start, shown(value.get_ref()), range.words())),
        }
    }

    /// A number that has to be there.
    ///
    /// # Errors
    /// As [`Table::number`], or it is absent.
    pub fn needed(&self, key: Word, range: Range) -> Result<f64, InputError> {
        match self.number(key, range)? {
            Some(number) => Ok(number),
            None => Err(self.missing(key, range.words())),
        }
    }

    /// A text, `None` where it is absent.
    ///
    /// # Errors
    /// Something else than a non-empty text.
    pub fn text(&self, key: Word) -> Result<Option<String>, InputError> {
        let Some((name, value)) = self.value(key) else { return Ok(None) };
        match value.get_ref() {
            DeValue::String(text) if !text.trim().is_empty() => Ok(Some(text.to_string())),
            other => Err(self.error(name, value.span().start, shown(other), "a text in quotes")),
        }
    }

    /// Yes or no, `None` where it is absent.
    ///
    /// # Errors
    /// Something else than `true` or `false`.
    pub fn switch(&self, key: Word) -> Result<Option<bool>, InputError> {
        let Some((name, value)) = self.value(key) else { return Ok(None) };
        match value.get_ref() {
            DeValue::Boolean(on) => Ok(Some(*on)),
            other => Err(self.error(name, value.span().start, shown(other), "true or false")),
        }
    }

    /// Marks `key` as known without reading it here.
    pub fn know(&self, key: Word) {
        self.known.borrow_mut().push(key);
    }

    /// Refuses every key that was never asked for.
    ///
    /// # Errors
    /// The first unknown key, with the nearest known one or the right name for this coordinate.
    pub fn done(self) -> Result<(), InputError> {
        let known = self.known.borrow();
        let mut unknown: Vec<_> = self
            .entries
            .into_iter()
            .flat_map(|entries| entries.iter())
            .filter(|(key, _)| !known.iter().any(|word| self.coordinate.pick(*word) == key.get_ref()))
            .map(|(key, _)| (key.span().start, key.get_ref().as_ref()))
            .collect();
        unknown.sort_unstable();
        let Some(&(at, name)) = unknown.first() else { return Ok(()) };
        let names: Vec<_> = known.iter().map(|word| self.coordinate.pick(*word)).collect();
        let expected = match nearest(name, &names) {
            Some(near) => format!("{near} perhaps, or one of {}", names.join(", ")),
            None => format!("one of {}", names.join(", ")),
        };
        Err(self.error(name, at, "an unknown key", expected))
    }

    /// The error that `key` is absent.
    pub fn missing(&self, key: Word, expected: impl Display) -> InputError {
        let key = self.coordinate.pick(key);
        let name = if self.name.is_empty() { String::new() } else { format!("[{}] ", self.name) };
        let place = format!("{}:{}: {name}{key}", self.origin, line_of(self.text, self.start));
        InputError::new(place, "nothing", expected)
    }

    /// An error at the value of `key`.
    pub fn at(&self, key: Word, found: impl Display, expected: impl Display) -> InputError {
        let name = self.coordinate.pick(key);
        let start = self.value(key).map_or(self.start, |(_, value)| value.span().start);
        self.error(name, start, found, expected)
    }

    fn value(&self, key: Word) -> Option<(&'static str, &'a Spanned<DeValue<'a>>)> {
        self.know(key);
        let name = self.coordinate.pick(key);
        self.entries?.iter().find(|(found, _)| found.get_ref() == name).map(|(_, value)| (name, value))
    }

    /// `mass_kg` in a rotary rig: say the right name instead of calling the right one absent.
    fn refuse_other_coordinate(&self, key: Word) -> Result<(), InputError> {
        let (right, wrong) = (self.coordinate.pick(key), self.coordinate.other().pick(key));
        let Some(entries) = self.entries.filter(|_| right != wrong) else { return Ok(()) };
        match entries.keys().find(|found| found.get_ref() == wrong) {
            None => Ok(()),
            Some(found) => {
                let what =
                    format!("a key of a {} rig in a {} one", self.coordinate.other().name(), self.coordinate.name());
                Err(self.error(wrong, found.span().start, what, right))
            }
        }
    }

    fn error(&self, key: &str, at: usize, found: impl Display, expected: impl Display) -> InputError {
        let key = if self.name.is_empty() { key.to_owned() } else { format!("[{}] {key}", self.name) };
        InputError::new(format!("{}:{}: {key}", self.origin, line_of(self.text, at)), found, expected)
    }
}

/// The name most like `name`, if any is like it at all.
pub fn nearest<'n>(name: &str, among: &[&'n str]) -> Option<&'n str> {
    let likeness = |other: &str| strsim::jaro_winkler(&name.to_lowercase(), &other.to_lowercase());
    among
        .iter()
        .map(|other| (likeness(other), *other))
        .filter(|(score, _)| *score > 0.8)
        .max_by(|one, two| one.0.total_cmp(&two.0))
        .map(|(_, other)| other)
}

fn shown(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text \"{text}\""),
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.to_string(),
        DeValue::Boolean(on) => on.to_string(),
        DeValue::Datetime(date) => date.to_string(),
        DeValue::Array(_) => "an array".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
