//! What goes to a terminal: text of files and file names, with nothing in it that a terminal would obey.

use std::fmt::Write as _;

/// `text` with control characters spelt out, `\u{1b}` for an escape; ends of lines and tabs stay.
#[must_use]
pub fn printable(text: &str) -> String {
    let mut printable = String::with_capacity(text.len());
    for letter in text.chars() {
        if letter.is_control() && !matches!(letter, '\n' | '\t') || is_reordering(letter) {
            // Writing to a String cannot fail.
            let _ = write!(printable, "{}", letter.escape_unicode());
        } else {
            printable.push(letter);
        }
    }
    printable
}

/// Marks that make a terminal show letters in another order than they are in.
fn is_reordering(letter: char) -> bool {
    matches!(letter, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_spelt_out_and_all_else_stays() {
        assert_eq!(printable("µ ± 2\n\tü"), "µ ± 2\n\tü");
        assert_eq!(printable("a\u{1b}[31mb\u{7}\r\u{9b}"), "a\\u{1b}[31mb\\u{7}\\u{d}\\u{9b}");
        assert_eq!(printable("\u{202e}gpj"), "\\u{202e}gpj");
    }
}
