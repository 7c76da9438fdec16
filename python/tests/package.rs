//! `pytest python/tests` on the package, put together of its Python files and the extension module of this build.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use palpate_cases::python;
use palpate_lab::recordings_folder;
use palpate_lab::tools::PYTHON_TESTS;
use tempfile::TempDir;

/// Where Python looks for an extension module.
const MODULE: &str = if cfg!(windows) { "_palpate.pyd" } else { "_palpate.abi3.so" };

fn sources() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder that holds the package `palpate`.
fn package() -> TempDir {
    let home = TempDir::new().expect("a folder");
    let package = home.path().join("palpate");
    fs::create_dir(&package).expect("a folder");
    for entry in fs::read_dir(sources().join("palpate")).expect("sources") {
        let path = entry.expect("an entry").path();
        if path.is_file() {
            fs::copy(&path, package.join(path.file_name().expect("a name"))).expect("a copy");
        }
    }
    let test = std::env::current_exe().expect("this program");
    let built = test.with_file_name(format!("{DLL_PREFIX}_palpate{DLL_SUFFIX}"));
    fs::copy(&built, package.join(MODULE)).unwrap_or_else(|error| panic!("{}: {error}", built.display()));
    home
}

#[test]
fn the_python_package_passes_its_tests() {
    let home =
        std::env::var_os("PALPATE_PYTHON_HOME").map_or_else(|| sources().join("../target/python"), PathBuf::from);
    let python = match python::find(&home, &PYTHON_TESTS) {
        Ok(python) => python,
        Err(missing) => return eprintln!("left out: {missing}"),
    };
    let package = package();
    let mut pytest = Command::new(python.interpreter());
    if let Some(recordings) = recordings_folder::folder() {
        pytest.env("PALPATE_RECORDINGS", recordings);
    }
    let output = pytest
        .args(["-B", "-m", "pytest", "--quiet", "-p", "no:cacheprovider"])
        .arg(sources().join("tests"))
        .env("PYTHONPATH", package.path())
        // Python looks into the current folder first, and this one has the package without its extension module.
        .current_dir(package.path())
        .output()
        .expect("Python runs");
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
    println!("{text}");
}
