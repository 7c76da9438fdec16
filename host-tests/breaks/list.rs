//! Breaks of `list.toml`, made one at a time in a copy of the project.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// One break, as `list.toml` has it.
struct Break {
    what: String,
    file: String,
    find: String,
    replace: String,
    package: String,
    /// `lib` for the tests of the library, else the name of a test target.
    target: String,
    test: String,
    sample: bool,
}

fn project() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn breaks() -> Vec<Break> {
    let list: toml::Table = include_str!("list.toml").parse().expect("TOML");
    let entries = list["break"].as_array().expect("entries");
    let entry = |value: &toml::Value| {
        let text = |key: &str| value.get(key).and_then(toml::Value::as_str).expect(key).to_owned();
        Break {
            what: text("what"),
            file: text("file"),
            find: text("find"),
            replace: text("replace"),
            package: text("package"),
            target: text("target"),
            test: text("test"),
            sample: value.get("sample").is_some_and(|sample| sample.as_bool() == Some(true)),
        }
    };
    entries.iter().map(entry).collect()
}

impl Break {
    /// The source file in which the test stands: in the library that of its module or of the module's tests, else below the target's folder.
    fn test_file(&self) -> PathBuf {
        let mut module: Vec<&str> = self.test.split("::").collect();
        module.pop();
        let folder = match self.package.as_str() {
            "palpate" => project().to_path_buf(),
            package => project().join(package.strip_prefix("palpate-").expect("a package of this workspace")),
        };
        if self.target == "lib" {
            assert_eq!(module.pop(), Some("tests"), "{}", self.test);
            let of_module = folder.join("src").join(module.join("/"));
            let of_tests = of_module.join("tests.rs");
            if of_tests.exists() { of_tests } else { of_module.with_extension("rs") }
        } else {
            // The modules lie in a folder of the target's name, whether one of that name holds them all or none does.
            let within = module.strip_prefix(&[self.target.as_str()]).unwrap_or(&module);
            folder.join("tests").join(&self.target).join(within.join("/")).with_extension("rs")
        }
    }

    /// Makes the break in the copy at `folder`, runs its test there, and mends it; what cargo said where the test does not
    /// fail.
    fn run(&self, folder: &Path, profile: &str, artifacts: &Path) -> Result<(), String> {
        let path = folder.join(&self.file);
        let whole = fs::read_to_string(&path).expect("a source file");
        fs::write(&path, whole.replacen(&self.find, &self.replace, 1)).expect("a writable copy");
        let output = self.cargo(folder, profile, artifacts);
        fs::write(&path, whole).expect("a writable copy");
        let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        // A break that does not compile is no break.
        if !output.status.success() && said.contains(&format!("test {} ... FAILED", self.test)) {
            Ok(())
        } else {
            Err(said)
        }
    }

    fn cargo(&self, folder: &Path, profile: &str, artifacts: &Path) -> std::process::Output {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["test", "--offline", "--profile", if profile == "debug" { "test" } else { profile }]);
        // Dependencies are shared with the project's own builds; what is broken is kept apart from it by a setting of its own,
        // for cargo tells packages of two copies of a workspace apart by nothing else.
        let named = if profile == "debug" { "test" } else { profile };
        for package in ["palpate", "palpate-drive", "palpate-lab"] {
            cargo.arg("--config").arg(format!("profile.{named}.package.{package}.codegen-units=9"));
        }
        cargo.args(["--package", &self.package]);
        match self.target.as_str() {
            "lib" => cargo.arg("--lib"),
            target => cargo.args(["--test", target]),
        };
        cargo.args(["--", "--exact", &self.test]).env("CARGO_TARGET_DIR", artifacts).current_dir(folder);
        cargo.output().expect("cargo runs")
    }
}

/// A copy of what is compiled, without what is generated.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a listing").map(|entry| entry.expect("an entry")) {
        let (name, path) = (entry.file_name(), entry.path());
        if [".git", "target", "out", "results", "docs"].iter().any(|skipped| name == *skipped) {
            continue;
        }
        if path.is_dir() {
            copy(&path, &to.join(name));
        } else {
            fs::copy(&path, to.join(name)).expect("a copy");
        }
    }
}

/// Makes the breaks of `chosen`, and names those that nothing noticed.
fn try_all(folder: &str, chosen: impl Fn(&Break) -> bool) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    // What an earlier run has left would be compiled with it.
    let _ = fs::remove_dir_all(&folder);
    copy(project(), &folder);
    // The documentation is part of some libraries.
    copy(&project().join("docs"), &folder.join("docs"));
    let program = std::env::current_exe().expect("a program");
    let profile = program.ancestors().nth(2).expect("a folder of artifacts");
    let artifacts = profile.parent().expect("a target folder");
    let profile = profile.file_name().and_then(|name| name.to_str()).expect("a profile");
    let mut unnoticed = Vec::new();
    for one in breaks().into_iter().filter(chosen) {
        let noticed = one.run(&folder, profile, artifacts);
        eprintln!("{}: {}", if noticed.is_ok() { "noticed" } else { "UNNOTICED" }, one.what);
        unnoticed.extend(noticed.err().map(|said| format!("{}: {}\n{said}", one.file, one.what)));
    }
    fs::remove_dir_all(&folder).expect("a folder that can be removed");
    assert!(unnoticed.is_empty(), "{}", unnoticed.join("\n"));
}

#[test]
fn every_break_can_be_made_and_its_test_is_there() {
    for one in breaks() {
        let source = fs::read_to_string(project().join(&one.file)).expect(&one.file);
        assert_eq!(source.matches(&one.find).count(), 1, "{}: {:?}", one.file, one.find);
        assert_ne!(one.find, one.replace, "{}", one.what);
        let tests = one.test_file();
        let name = one.test.rsplit("::").next().expect("a name");
        let text = fs::read_to_string(&tests).unwrap_or_else(|error| panic!("{}: {error}", tests.display()));
        assert_eq!(text.matches(&format!("fn {name}()")).count(), 1, "{}: {name}", tests.display());
    }
}

#[test]
fn a_sample_of_the_breaks_is_noticed() {
    try_all("breaks-sample", |one| one.sample);
}

/// With PALPATE_BREAKS=PACKAGE those of one package.
#[test]
#[ignore = "compiles the libraries once for each break: minutes, the host tool's being the longest"]
fn every_break_is_noticed() {
    let package = std::env::var("PALPATE_BREAKS").ok();
    try_all("breaks-all", |one| package.as_ref().is_none_or(|package| one.package == *package));
}
