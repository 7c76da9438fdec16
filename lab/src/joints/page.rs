//! The page of an arm: a table of its joints, and below it the report of each.

use std::io::{self, Write};

use maud::{Markup, html};

use super::DiagnosedJoint;
use crate::diagnose::report::html as report;
use crate::page::{quantity, shell};

const STYLE: &str = include_str!("../../assets/joints.css");

/// Writes the page. It needs nothing but itself: the report of each joint is whole and stands in a frame of its own.
///
/// # Errors
/// Whatever `out` reports.
pub fn write(arm: &[DiagnosedJoint], out: &mut impl Write) -> io::Result<()> {
    shell::open("Joints – palpate diagnose-joints", STYLE, out)?;
    let reports: Vec<String> = arm.iter().map(whole_report).collect::<io::Result<_>>()?;
    let body = html! {
        p.eyebrow { "palpate diagnose-joints" }
        h1 { (headline(arm)) }
        (overview(arm))
        @for (at, (joint, report)) in arm.iter().zip(&reports).enumerate() {
            section id=(anchor(at)) {
                h2 { "Joint " (joint.name) }
                iframe title=(format!("Report of joint {}", joint.name)) srcdoc=(report) {}
            }
        }
    };
    out.write_all(body.0.as_bytes())?;
    shell::close(&html! {}, "", out)
}

fn headline(arm: &[DiagnosedJoint]) -> String {
    let lacking = arm.iter().filter(|joint| !joint.found.answer.physics.is_empty()).count();
    format!("{lacking} of {} joints lack physics", arm.len())
}

fn anchor(at: usize) -> String {
    format!("joint-{}", at + 1)
}

fn whole_report(joint: &DiagnosedJoint) -> io::Result<String> {
    let mut page = Vec::new();
    report::write(&joint.found.answer, &joint.found.pictures, &mut page)?;
    String::from_utf8(page).map_err(io::Error::other)
}

fn overview(arm: &[DiagnosedJoint]) -> Markup {
    html! {
        table {
            thead { tr { th { "Joint" } th.text { "What is missing" } th.text { "Values" } th.text { "In words" } } }
            tbody {
                @for (at, joint) in arm.iter().enumerate() {
                    tr {
                        th { a href=(format!("#{}", anchor(at))) { (joint.name) } }
                        td.text { (names(joint)) }
                        td.text { (values(joint)) }
                        td.text { (joint.found.answer.summary) }
                    }
                }
            }
        }
    }
}

fn names(joint: &DiagnosedJoint) -> String {
    let names: Vec<String> = joint.found.answer.physics.iter().map(|physics| physics.name.replace('_', " ")).collect();
    if names.is_empty() { "nothing".to_owned() } else { names.join(", ") }
}

fn values(joint: &DiagnosedJoint) -> Markup {
    html! {
        ul {
            @for value in joint.found.answer.physics.iter().flat_map(|physics| &physics.parameters) {
                li { (value.name.replace('_', " ")) " " (quantity::plain(value.value, &value.unit)) }
            }
        }
    }
}
