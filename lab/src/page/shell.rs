//! What every page is wrapped in: its head, and the scripts that draw.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::io::{self, Write};

const STYLE: &str = concat!(include_str!("../../assets/uplot/uPlot.min.css"), include_str!("../../assets/page.css"));
const PLOTTING_LICENSE: &str = include_str!("../../assets/uplot/LICENSE");
const PLOTTING: &str = include_str!("../../assets/uplot/uPlot.iife.min.js");
const SCRIPTS: [&str; 3] = [
    include_str!("../../assets/numbers.js"),
    include_str!("../../assets/words.js"),
    include_str!("../../assets/chart.js"),
];

/// The page is a file that people pass on: the browser itself shall refuse whatever it might want from a network.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

/// Everything up to the first word of the page; `style` is its own beside what all pages share.
pub(crate) fn open(title: &str, style: &str, out: &mut impl Write) -> io::Result<()> {
    let head = html! {
        meta charset="utf-8";
        meta http-equiv="Content-Security-Policy" content=(POLICY);
        meta name="viewport" content="width=device-width, initial-scale=1";
        meta name="color-scheme" content="light dark";
        title { (title) }
        style { (PreEscaped(STYLE)) (PreEscaped(style)) }
    };
    writeln!(out, r#"{}<html lang="en"><head>{}</head><body><main>"#, DOCTYPE.into_string(), head.into_string())
}

/// Everything after the data: what the scripts copy from, and the scripts.
pub(crate) fn close(templates: &Markup, script: &str, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "</main>{}", templates.0)?;
    writeln!(out, "<script>/*\n{PLOTTING_LICENSE}\n*/\n{PLOTTING}</script>")?;
    for script in SCRIPTS.into_iter().chain([script]) {
        writeln!(out, "<script>\n{script}</script>")?;
    }
    writeln!(out, "</body></html>")
}
