//! The page of a fleet: what changed, which rigs stand out, and every answer.

mod changes;
mod effects;
mod quantities;
mod rigs;
mod standing_out;

use std::collections::BTreeMap;
use std::io::{self, Write};

use maud::{Markup, html};

use super::changes::Comparison;
use super::outliers;
use super::table::{Rig, Table};
use crate::page::shell;

const STYLE: &str = include_str!("../../assets/fleet.css");

/// Everything that the page shows.
#[derive(Debug, Clone, Copy)]
pub struct FleetPage<'a> {
    /// The folder or manifest, as the command line names it.
    pub source: &'a str,
    /// The answers.
    pub table: &'a Table,
    /// The folder of the earlier run, and what changed since.
    pub comparison: Option<(&'a str, &'a Comparison)>,
}

impl FleetPage<'_> {
    /// Writes the page. It needs nothing but itself, and leads to the reports of the rigs beside it. The same answers give the
    /// same bytes.
    ///
    /// # Errors
    /// Whatever `out` reports.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let quantities = outliers::quantities(self.table);
        let outliers = outliers::outliers(self.table, &quantities);
        shell::open(&format!("{} – palpate diagnose-all", self.source), STYLE, out)?;
        let body = html! {
            (self.opening(outliers.len()))
            @if let Some((against, comparison)) = self.comparison { (changes::section(against, comparison)) }
            (standing_out::section(self.table, &outliers))
            (effects::section(self.table))
            (quantities::section(&quantities))
            (rigs::section(self.table))
        };
        out.write_all(body.0.as_bytes())?;
        shell::close(&html! {}, "", out)
    }

    fn opening(&self, outliers: usize) -> Markup {
        let rigs: Vec<Rig<'_>> = self.table.rigs().collect();
        let failed = rigs.iter().filter(|rig| rig.is_failed()).count();
        html! {
            p.eyebrow { "palpate diagnose-all " code { (self.source) } }
            h1 { (headline(rigs.len(), outliers, self.comparison.map(|(_, comparison)| comparison.rigs.len()))) }
            p.lead {
                (rigs.len() - failed) " of " (counted(rigs.len(), "rig")) " diagnosed" @if failed > 0 { ", " strong { (failed) " failed" } } ". "
                (verdicts(&rigs))
            }
            p.fine {
                "Every answer is also in " a href="table.csv" { "table.csv" } " and " a href="table.parquet" { "table.parquet" }
                ", a row for each value. The name of a rig leads to its report."
            }
        }
    }
}

fn headline(rigs: usize, outliers: usize, changed: Option<usize>) -> String {
    let stand = if outliers == 1 { "stands" } else { "stand" };
    let since = changed.map(|changed| format!(", {changed} changed")).unwrap_or_default();
    format!("{}: {outliers} {stand} out{since}", counted(rigs, "rig"))
}

/// How many rigs have which verdict.
fn verdicts(rigs: &[Rig<'_>]) -> String {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for rig in rigs.iter().filter(|rig| !rig.is_failed()) {
        *counts.entry(&rig.head().verdict).or_default() += 1;
    }
    let verdicts: Vec<String> =
        counts.iter().map(|(verdict, count)| format!("{} {count}", verdict.replace('_', " "))).collect();
    if verdicts.is_empty() { String::new() } else { format!("Verdicts: {}.", verdicts.join(", ")) }
}

/// "1 rig", "2 rigs".
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// The name of a rig as a link to its report.
fn link(name: &str) -> Markup {
    html! { a href={ "rigs/" (percent_encoded(name)) "/report.html" } { (name) } }
}

/// A name as a segment of a relative address (RFC 3986).
fn percent_encoded(name: &str) -> String {
    let encode = |byte: u8| match byte {
        b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => char::from(byte).to_string(),
        _ => format!("%{byte:02X}"),
    };
    name.bytes().map(encode).collect()
}

/// A few names, and how many more there are.
fn some_of(names: &[&str], most: usize) -> Markup {
    html! {
        @for (at, name) in names.iter().take(most).enumerate() { @if at > 0 { ", " } (link(name)) }
        @if names.len() > most { " and " (names.len() - most) " more" }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::changes::compare;
    use crate::fleet::table::tests::{failed, result};

    fn page(table: &Table, comparison: Option<(&str, &Comparison)>) -> String {
        let mut out = Vec::new();
        FleetPage { source: "press hall", table, comparison }.write(&mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn names_are_links_that_no_character_breaks_and_text_that_no_markup_enters() {
        assert_eq!(percent_encoded("a b/ü#?<%"), "a%20b%2F%C3%BC%23%3F%3C%25");
        let html = page(&Table::of(&[failed("<b>", "found <i>, expected &")]), None);
        assert!(html.contains("&lt;b&gt;") && html.contains("found &lt;i&gt;, expected &amp;"));
        assert!(!html.contains("<b>") && !html.contains("<i>"));
        assert!(!html.contains("report.html"), "a rig that failed has no report");
        assert!(page(&Table::of(&[result("a b", &[], 300.0)]), None).contains("href=\"rigs/a%20b/report.html\""));
    }

    #[test]
    fn the_page_opens_with_how_many_rigs_stand_out_and_changed() {
        let before = Table::of(&[result("a", &[], 300.0), result("b", &[], 300.0)]);
        let after = Table::of(&[result("a", &[], 310.0), failed("b", "no such file")]);
        let comparison = compare(&before, &after);
        let html = page(&after, Some(("last night", &comparison)));
        assert!(html.contains("2 rigs: 1 stands out, 2 changed"));
        assert!(html.contains("last night") && html.contains("no such file") && html.contains("299.0 to 301.0"));
        assert!(!page(&after, None).contains("changed"));
    }
}
