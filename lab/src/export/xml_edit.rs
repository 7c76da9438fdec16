//! Changes to the text of an XML file that leave everything else as it stands: order, comments, blanks.

use std::ops::Range;

use roxmltree::{Document, Node};

use crate::error::InputError;

/// Reads the XML `text` of `place`.
///
/// # Errors
/// It is no XML, with the line.
pub fn parse<'t>(place: &str, text: &'t str) -> Result<Document<'t>, InputError> {
    Document::parse(text).map_err(|error| {
        let at = error.pos();
        InputError::new(format!("{place}:{}", at.row), error, "XML")
    })
}

/// Changes, collected by where they act.
#[derive(Default)]
pub struct Changes {
    changes: Vec<(Range<usize>, String)>,
}

impl Changes {
    /// Sets an attribute, whether the element has it or not.
    pub fn set_attribute(&mut self, node: Node<'_, '_>, name: &str, value: &str) {
        match node.attribute_node(name) {
            Some(attribute) => self.changes.push((attribute.range_value(), value.to_owned())),
            None => {
                let start = node.range().start + 1;
                let after_name = || start + tag_name_length(&node.document().input_text()[start..]);
                let at = node.attributes().map(|attribute| attribute.range().end).max().unwrap_or_else(after_name);
                self.changes.push((at..at, format!(" {name}=\"{value}\"")));
            }
        }
    }

    /// Replaces what an element holds by `text`.
    pub fn set_text(&mut self, node: Node<'_, '_>, text: &str) {
        let range = node.range();
        let element = &node.document().input_text()[range.clone()];
        if let (Some(open), Some(close)) = (element.find('>'), element.rfind("</")) {
            self.changes.push((range.start + open + 1..range.start + close, text.to_owned()));
        }
    }

    /// Gives an element another name.
    pub fn rename(&mut self, node: Node<'_, '_>, name: &str) {
        let text = node.document().input_text();
        let range = node.range();
        let length = tag_name_length(&text[range.start + 1..]);
        self.changes.push((range.start + 1..range.start + 1 + length, name.to_owned()));
        let element = &text[range.clone()];
        if !element.ends_with("/>")
            && let Some(close) = element.rfind("</")
        {
            let start = range.start + close + 2;
            self.changes.push((start..start + length, name.to_owned()));
        }
    }

    /// Puts `line` on a line of its own before the element, as far in as it.
    pub fn line_before(&mut self, node: Node<'_, '_>, line: &str) {
        let at = node.range().start;
        self.changes.push((at..at, format!("{line}\n{}", indent(node))));
    }

    /// Puts `line` on a line of its own after the element, as far in as it.
    pub fn line_after(&mut self, node: Node<'_, '_>, line: &str) {
        let at = node.range().end;
        self.changes.push((at..at, format!("\n{}{line}", indent(node))));
    }

    /// Puts `lines` at the end of the element's content, a step further in.
    pub fn append(&mut self, node: Node<'_, '_>, lines: &[String]) {
        let text = node.document().input_text();
        let outer = indent(node);
        let inner = node.first_element_child().map_or_else(|| format!("{outer}  "), indent);
        let content: String = lines.iter().map(|line| format!("\n{inner}{line}")).collect();
        let range = node.range();
        let element = &text[range.clone()];
        if element.ends_with("/>") {
            let name = &element[1..1 + tag_name_length(&element[1..])];
            self.changes.push((range.end - 2..range.end, format!(">{content}\n{outer}</{name}>")));
            return;
        }
        let close = range.start + element.rfind("</").unwrap_or(element.len());
        // After the last thing that is there, before the blanks in front of the closing tag.
        let at = close - (text[..close].len() - text[..close].trim_end().len());
        let tail = if text[at..close].contains('\n') { String::new() } else { format!("\n{outer}") };
        self.changes.push((at..at, content + &tail));
    }

    /// `text` with the changes.
    pub fn apply(mut self, text: &str) -> String {
        // Of several at one place, in the order in which they were asked for.
        self.changes.sort_by_key(|(range, _)| range.start);
        let mut changed = String::with_capacity(text.len() + 1024);
        let mut done = 0;
        for (range, new) in self.changes {
            changed += &text[done..range.start];
            changed += &new;
            done = range.end;
        }
        changed + &text[done..]
    }
}

/// A text inside of a comment: two hyphens would end it.
pub fn comment(text: &str) -> String {
    format!("<!-- {} -->", text.replace("--", "- -"))
}

fn tag_name_length(text: &str) -> usize {
    text.find(|letter: char| letter.is_whitespace() || matches!(letter, '/' | '>')).unwrap_or(text.len())
}

/// The blanks before an element on its line.
fn indent(node: Node<'_, '_>) -> String {
    let text = node.document().input_text();
    let start = node.range().start;
    let line = text[..start].rfind('\n').map_or(0, |end| end + 1);
    text[line..start].chars().take_while(|letter| letter.is_whitespace()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_asked_for_changes() {
        let text = "<a>\n  <!-- kept -->\n  <b  x = '1'\n     y=\"2\"/><!-- too -->\n  <c></c><d/>\n</a>\n";
        let document = parse("m.xml", text).unwrap();
        let node = |name: &str| document.descendants().find(|node| node.has_tag_name(name)).unwrap();
        let mut changes = Changes::default();
        changes.set_attribute(node("b"), "y", "3");
        changes.set_attribute(node("b"), "z", "4");
        changes.set_attribute(node("d"), "w", "5");
        changes.line_before(node("b"), "<!-- new -->");
        changes.line_after(node("b"), "<e/>");
        changes.rename(node("c"), "general");
        changes.append(node("a"), &["<f/>".to_owned()]);
        let wanted = "<a>\n  <!-- kept -->\n  <!-- new -->\n  <b  x = '1'\n     y=\"3\" z=\"4\"/>\n  <e/><!-- too -->\n  \
                      <general></general><d w=\"5\"/>\n  <f/>\n</a>\n";
        assert_eq!(changes.apply(text), wanted);
        assert_eq!(Changes::default().apply(text), text);
    }

    #[test]
    fn an_empty_element_is_opened_to_take_something_in() {
        let document = parse("m.xml", "<a>\n  <b/>\n</a>").unwrap();
        let mut changes = Changes::default();
        changes.append(document.root_element().first_element_child().unwrap(), &["<c/>".to_owned()]);
        assert_eq!(changes.apply("<a>\n  <b/>\n</a>"), "<a>\n  <b>\n    <c/>\n  </b>\n</a>");
    }
}
