//! The catalogue as a page of text. No colour: it reads the same on a terminal, in a file and in a pipe.

use textwrap::{Options, fill};

use crate::effects::{Effect, Form, Parameter};
use crate::rig::Coordinate;

/// How a rig file says it.
const FOOT: &str = "In a rig file an effect is a table [[effect]] with its name, perhaps its form, and its parameters, each with \
                    its unit in its key: alpha in N s/m^2 is alpha_n_s_m2.";

/// An entry an effect, for who looks for a name, wrapped to `width` columns.
pub fn index(effects: &[&'static dyn Effect], width: usize) -> String {
    let longest = effects.iter().map(|effect| effect.spec().name.len()).max().unwrap_or(0);
    let mut page = Page { text: String::new(), width };
    for effect in effects {
        let spec = effect.spec();
        page.put(0, longest + 11, &format!("{:longest$}  {:7}  {}", spec.name, spec.place.name(), spec.statement));
    }
    page.text.push('\n');
    page.put(0, 0, INDEX_FOOT);
    page.text.push('\n');
    page.text
}

const INDEX_FOOT: &str =
    "`palpate effects NAME` gives one alone; what none of them explains: `palpate effects learned`.";

/// The page, wrapped to `width` columns.
pub fn page(effects: &[&'static dyn Effect], width: usize) -> String {
    let mut page = Page { text: String::new(), width };
    effects.iter().for_each(|effect| page.effect(*effect));
    page.put(0, 0, FOOT);
    page.text
}

struct Page {
    text: String,
    width: usize,
}

impl Page {
    /// A paragraph: its first line `indent` columns in, the others `hang` more.
    fn put(&mut self, indent: usize, hang: usize, text: &str) {
        let (first, rest) = (" ".repeat(indent), " ".repeat(indent + hang));
        // A name or a number of an equation is not broken in two.
        let options = Options::new(self.width)
            .initial_indent(&first)
            .subsequent_indent(&rest)
            .break_words(false)
            .word_splitter(textwrap::WordSplitter::NoHyphenation);
        self.text += &fill(text, options);
        self.text.push('\n');
    }

    fn effect(&mut self, effect: &'static dyn Effect) {
        let spec = effect.spec();
        self.put(0, 2, &format!("{} (acts in the {})", spec.name, spec.place.name()));
        self.put(2, 0, &format!("{}.", spec.statement));
        spec.forms.iter().for_each(|form| self.form(form));
        self.put(2, 4, &format!("shows in: {}", spec.excited_by));
        self.put(2, 4, &format!("resembles: {}", spec.resembles.join(", ")));
        self.put(2, 4, &format!("source: {}", spec.source));
        self.text.push('\n');
    }

    fn form(&mut self, form: &'static Form) {
        self.put(2, 4, &format!("{}: {}", form.name, form.equation));
        for parameter in form.parameters {
            self.put(6, 4, &line(parameter));
        }
    }
}

/// "alpha [N s/m^2; rotary: N m s/rad^2]: growth of the damping with depth; 0 or above".
fn line(parameter: &Parameter) -> String {
    let (linear, rotary) = (Coordinate::Linear.pick(parameter.unit), Coordinate::Rotary.pick(parameter.unit));
    let unit = match (linear, rotary) {
        ("1", _) => "no unit".to_owned(),
        _ if linear == rotary => linear.to_owned(),
        _ => format!("{linear}; rotary: {rotary}"),
    };
    format!("{} [{unit}]: {}; {}", parameter.name, parameter.meaning, bounds(parameter))
}

fn bounds(parameter: &Parameter) -> String {
    match (parameter.low.is_finite(), parameter.high.is_finite()) {
        _ if parameter.fixed => "chosen, not fitted".to_owned(),
        (true, true) => format!("{} to {}", parameter.low, parameter.high),
        (true, false) => format!("{} or above", parameter.low),
        (false, true) => format!("{} or below", parameter.high),
        (false, false) => "of either sign".to_owned(),
    }
}
