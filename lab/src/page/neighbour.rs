//! Another page of this tool in the same folder, to link to.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// Bytes that a page's title stands in.
const HEAD: u64 = 4096;

/// The first of `names` beside `page` that is a page of `command`, by its title.
pub(crate) fn beside(page: &Path, names: &[&str], command: &str) -> Option<String> {
    let found = names.iter().find(|name| {
        let path = page.with_file_name(name);
        let mut head = Vec::new();
        let is_read = File::open(&path).and_then(|file| file.take(HEAD).read_to_end(&mut head)).is_ok();
        is_read && path != page && String::from_utf8_lossy(&head).contains(&format!("{command}</title>"))
    });
    found.map(|name| (*name).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_of_the_command_is_linked_to_and_a_stranger_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let page = folder.path().join("replay.html");
        let names = ["report.html", "diagnosis.html"];
        assert_eq!(beside(&page, &names, "palpate diagnose"), None);
        std::fs::write(folder.path().join("report.html"), "<title>minutes</title>").unwrap();
        std::fs::write(folder.path().join("diagnosis.html"), "<title>bench – palpate diagnose</title>").unwrap();
        assert_eq!(beside(&page, &names, "palpate diagnose").as_deref(), Some("diagnosis.html"));
    }
}
