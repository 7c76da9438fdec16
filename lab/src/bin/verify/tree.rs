//! What may stand in the source tree: no symbolic link, and no path of somebody's machine.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, Result, bail};

/// Folders that hold what was made and not what was written, where there is no git to say so.
const GENERATED: [&str; 3] = [".git", "target", "out"];

/// Refuses symbolic links and paths of a machine among the files of `project`.
///
/// # Errors
/// One of them is there (all are named), or the tree cannot be read.
pub fn check(project: &Path) -> Result<()> {
    let found = refused(project, &files(project)?)?;
    if found.is_empty() { Ok(()) } else { bail!("{}", found.join("\n")) }
}

/// What is refused among `files` of `project`, in words.
fn refused(project: &Path, files: &[PathBuf]) -> Result<Vec<String>> {
    let folders = machine_folders(project);
    let mut found = Vec::new();
    for path in files {
        let shown = path.strip_prefix(project).unwrap_or(path).display();
        // A file that git lists and that was removed since is no concern of this check.
        let Ok(kind) = path.symlink_metadata().map(|about| about.file_type()) else { continue };
        if kind.is_symlink() {
            found.push(format!("{shown} is a symbolic link"));
        } else if kind.is_file() {
            let bytes = std::fs::read(path).with_context(|| format!("cannot read {shown}"))?;
            let text = String::from_utf8_lossy(&bytes);
            let lines = text.lines().enumerate();
            let paths = lines.filter_map(|(at, line)| Some((at + 1, machine_path(line, &folders)?)));
            found.extend(paths.map(|(line, folder)| format!("{shown}:{line}: a path of a machine, {folder}")));
        }
    }
    Ok(found)
}

/// The files that git has or would take; without git, all but what is generated.
fn files(project: &Path) -> Result<Vec<PathBuf>> {
    let listed = Command::new("git")
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .current_dir(project)
        .output();
    match listed {
        Ok(output) if output.status.success() => {
            let names = String::from_utf8(output.stdout).context("git lists a name that is not UTF-8")?;
            Ok(names.split_terminator('\0').map(|name| project.join(name)).collect())
        }
        _ => {
            let mut files = Vec::new();
            walk(project, &mut files)?;
            Ok(files)
        }
    }
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    for entry in std::fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))? {
        let entry = entry?;
        if GENERATED.iter().any(|name| entry.file_name() == *name) {
            continue;
        }
        if entry.file_type()?.is_dir() {
            walk(&entry.path(), files)?;
        } else {
            files.push(entry.path());
        }
    }
    Ok(())
}

/// Beginnings of paths that mean one machine only: homes, scratch folders, this project's folder and this user's home.
/// Written in pieces, so that this file does not hold what it refuses.
fn machine_folders(project: &Path) -> Vec<String> {
    let mut folders: Vec<String> =
        ["home", "Users", "root", "tmp", "var/folders"].iter().map(|name| format!("/{name}/")).collect();
    folders.push(format!("C:{0}Users{0}", '\\'));
    let home = std::env::var_os("HOME").map(PathBuf::from);
    // A home or a project at the root of the file system would refuse every path.
    let known = [Some(project.to_path_buf()), home].into_iter().flatten().filter(|path| path.components().count() > 2);
    folders.extend(known.map(|path| path.display().to_string()));
    folders
}

/// The folder of a machine that `line` names. What goes before it must not be part of a longer path or address.
fn machine_path<'a>(line: &str, folders: &'a [String]) -> Option<&'a str> {
    let starts_path = |at: usize| {
        let before = line.get(..at).and_then(|text| text.chars().next_back());
        before.is_none_or(|c| !c.is_alphanumeric() && !"._-~/".contains(c))
    };
    folders.iter().map(String::as_str).find(|folder| line.match_indices(folder).any(|(at, _)| starts_path(at)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_of_a_machine_are_seen_and_addresses_are_not() {
        let folders = machine_folders(Path::new("/srv/builds/palpate"));
        let found = |line: &str| machine_path(line, &folders);
        assert_eq!(found(&format!("open('/{}/x.csv')", "home/ada")), Some(folders[0].as_str()));
        assert_eq!(found(&format!("/{}/socket", "tmp")), Some(folders[3].as_str()));
        assert_eq!(found("see /srv/builds/palpate/lab"), Some("/srv/builds/palpate"));
        assert_eq!(found("https://example.org/home/ada"), None);
        assert_eq!(found("target/tmp/out"), None);
    }

    #[cfg(unix)]
    #[test]
    fn a_symbolic_link_is_refused_by_its_name() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("a.txt"), "plain").expect("a file");
        std::os::unix::fs::symlink("a.txt", folder.path().join("b.txt")).expect("a link");
        let mut files = Vec::new();
        walk(folder.path(), &mut files).expect("a listing");
        assert_eq!(refused(folder.path(), &files).expect("files"), ["b.txt is a symbolic link"]);
    }

    #[test]
    fn the_tree_of_this_project_is_clean() {
        check(&palpate_lab::qemu_bench::project().expect("sources")).unwrap_or_else(|error| panic!("{error:#}"));
    }
}
