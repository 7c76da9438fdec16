//! Whether something large may be installed: asked where somebody can answer.

use std::io::{BufRead, IsTerminal as _, Write};

/// What was answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// Go on.
    Yes,
    /// Leave it out.
    No,
}

/// Asks on the terminal whether to install `what`; yes where there is none, as a script cannot answer and `PALPATE_NO_INSTALL` is there to
/// say no beforehand.
#[must_use]
pub fn ask(what: &str) -> Answer {
    let (question, answer) = (std::io::stderr(), std::io::stdin());
    if !question.is_terminal() || !answer.is_terminal() {
        return Answer::Yes;
    }
    ask_on(what, &mut question.lock(), &mut answer.lock())
}

/// Nothing but a yes is one; an empty line is no.
fn ask_on(what: &str, question: &mut impl Write, answer: &mut impl BufRead) -> Answer {
    let mut line = String::new();
    let asked =
        write!(question, "This would install {what}.\nInstall it? Without it what needs it is left out. [y/N] ");
    let answered = asked.and_then(|()| question.flush()).and_then(|()| answer.read_line(&mut line));
    let is_yes = answered.is_ok() && matches!(line.trim().to_lowercase().as_str(), "y" | "yes");
    if is_yes { Answer::Yes } else { Answer::No }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_but_a_yes_installs_anything() {
        for (line, expected) in
            [("y\n", Answer::Yes), (" YES \n", Answer::Yes), ("\n", Answer::No), ("", Answer::No), ("n\n", Answer::No)]
        {
            let mut shown = Vec::new();
            assert_eq!(ask_on("drake, 560 MB", &mut shown, &mut line.as_bytes()), expected, "{line:?}");
            let shown = String::from_utf8(shown).unwrap();
            assert!(shown.contains("drake, 560 MB") && shown.contains("left out"), "{shown}");
        }
    }
}
