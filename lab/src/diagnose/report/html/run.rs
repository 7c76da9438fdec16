//! How the diagnosis was made: enough to make it again.

use super::super::diagnosis::Run;
use maud::{Markup, html};

/// A list; nothing where it is not known.
pub(super) fn section(run: Option<&Run>) -> Markup {
    html! {
        @if let Some(run) = run {
            section #run aria-labelledby="run-title" {
                h2 #run-title { "How this was made" }
                dl.run {
                    div { dt { "date" } dd { (run.date) } }
                    div { dt { "version" } dd { "palpate " (run.version) } }
                    div { dt { "command" } dd { code { (run.command) } } }
                    div { dt { "seed" } dd { (run.seed) } }
                    @for (name, sha256) in &run.inputs { div { dt.file { (name) } dd { "SHA-256 " code { (sha256) } } } }
                }
            }
        }
    }
}
