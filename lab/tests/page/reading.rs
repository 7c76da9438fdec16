//! What a page says, read back.

use base64::{Engine, engine::general_purpose::STANDARD};

pub fn bytes(html: &str, id: &str) -> Vec<u8> {
    let tag = format!(r#"id="{id}">"#);
    let start = html.find(&tag).unwrap_or_else(|| panic!("no column {id}")) + tag.len();
    let end = start + html[start..].find("</script>").expect("the element ends");
    STANDARD.decode(&html[start..end]).expect("base64")
}

pub fn floats(html: &str, id: &str) -> Vec<f32> {
    bytes(html, id).as_chunks().0.iter().map(|chunk| f32::from_le_bytes(*chunk)).collect()
}

pub fn doubles(html: &str, id: &str) -> Vec<f64> {
    bytes(html, id).as_chunks().0.iter().map(|chunk| f64::from_le_bytes(*chunk)).collect()
}

/// What a reader sees without scripts, on one line.
pub fn prose(html: &str) -> String {
    let body =
        &html[html.find("<main>").expect("a body")..html.find(r#"<script type="application/json""#).expect("data")];
    let mut text = String::new();
    let mut inside = false;
    for letter in body.chars() {
        match letter {
            '<' => inside = true,
            '>' => inside = false,
            '\u{a0}' => text.push(' '),
            _ if !inside => text.push(letter),
            _ => {}
        }
    }
    text
}
