//! Data inside a page, as elements that the browser neither shows nor runs.

use base64::{engine::general_purpose::STANDARD, write::EncoderWriter};
use serde::Serialize;
use std::io::{self, Write};

/// What a script must know before it reads the columns.
pub(crate) fn description(described: &impl Serialize, out: &mut impl Write) -> io::Result<()> {
    let json = serde_json::to_string(described)?;
    // A name may hold "</script>", and only "<" can end a script element.
    let json = json.replace('<', "\\u003c");
    writeln!(out, r#"<script type="application/json" id="description">{json}</script>"#)
}

/// The numbers of `rows` in little-endian bytes, as base64.
pub(crate) fn write<const N: usize>(
    out: &mut impl Write,
    id: &str,
    rows: &[usize],
    bytes: impl Fn(usize) -> [u8; N],
) -> io::Result<()> {
    write!(out, r#"<script type="application/octet-stream" id="{id}">"#)?;
    let mut encoder = EncoderWriter::new(&mut *out, &STANDARD);
    for &row in rows {
        encoder.write_all(&bytes(row))?;
    }
    encoder.finish()?;
    drop(encoder);
    writeln!(out, "</script>")
}
