//! A Python with the packages that a purpose needs: found, or set up once in a folder of its own.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result};

/// Set to anything: nothing is installed, only asked for.
pub const NO_INSTALL: &str = "PALPATE_NO_INSTALL";

/// The oldest Python that all pinned packages run on.
const OLDEST: (u32, u32) = (3, 11);

/// Scripts, and the packages that they need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packages {
    /// Names the folder of their environment.
    pub name: &'static str,
    /// What they are for, for messages.
    pub purpose: &'static str,
    /// What the environment takes on the disk once it is set up, MB: measured on 64-bit Linux with Python 3.11.
    pub size_mb: u32,
    /// The pinned versions, as pip reads them.
    pub requirements: &'static str,
    /// File names and texts.
    pub scripts: &'static [(&'static str, &'static str)],
}

/// MuJoCo, Drake and Exudyn.
pub const SIMULATORS: Packages = Packages {
    name: "simulators",
    purpose: "to simulate cases with software of other authors",
    size_mb: 560,
    requirements: include_str!("../simulators/requirements.txt"),
    scripts: &[
        ("protocol.py", include_str!("../simulators/protocol.py")),
        ("mujoco.py", include_str!("../simulators/mujoco.py")),
        ("drake.py", include_str!("../simulators/drake.py")),
        ("exudyn.py", include_str!("../simulators/exudyn.py")),
    ],
};

/// PySINDy and SysIdentPy.
pub const BASELINES: Packages = Packages {
    name: "baselines",
    purpose: "to run published identification packages on the same recordings",
    size_mb: 410,
    requirements: include_str!("../baselines/requirements.txt"),
    scripts: &[
        ("signals.py", include_str!("../baselines/signals.py")),
        ("pysindy.py", include_str!("../baselines/pysindy.py")),
        ("sysidentpy.py", include_str!("../baselines/sysidentpy.py")),
    ],
};

/// An interpreter that has the packages, and the scripts beside it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Python {
    interpreter: PathBuf,
    scripts: PathBuf,
}

/// What is not there and could not be installed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what} missing ({why}); {advice}")]
pub struct Missing {
    /// The tool or the packages, with the verb.
    pub what: String,
    /// Why it was not installed.
    pub why: String,
    /// What a person should do.
    pub advice: String,
}

impl Python {
    /// The interpreter of the environment.
    #[must_use]
    pub fn interpreter(&self) -> &Path {
        &self.interpreter
    }

    /// A command that runs `script`.
    #[must_use]
    pub fn command(&self, script: &Path) -> Command {
        let mut command = Command::new(&self.interpreter);
        // One thread a process: whoever wants more starts more processes.
        command
            .args(["-I", "-B", "-W", "ignore"])
            .arg(script)
            .envs([("OMP_NUM_THREADS", "1"), ("OPENBLAS_NUM_THREADS", "1")]);
        command
    }

    /// The path of the script `name`, without its extension.
    ///
    /// # Errors
    /// There is no such script.
    pub fn script(&self, name: &str) -> Result<PathBuf> {
        let path = self.scripts.join(name).with_extension("py");
        anyhow::ensure!(path.is_file(), "there is no script {}", path.display());
        Ok(path)
    }
}

/// The environment of `packages` under `home`, if it has been set up as it is now pinned.
///
/// # Errors
/// It has not.
pub fn find(home: &Path, packages: &Packages) -> Result<Python, Missing> {
    let place = EnvironmentFolder::new(home, packages);
    place.ready().ok_or_else(|| place.missing("they have not been set up"))
}

/// The environment of `packages` under `home`; set up there, saying so, where it is missing or pinned otherwise.
///
/// # Errors
/// There is no Python, the packages cannot be had, or [`NO_INSTALL`] is set.
pub fn set_up(home: &Path, packages: &Packages) -> Result<Python, Missing> {
    let place = EnvironmentFolder::new(home, packages);
    if let Some(ready) = place.ready() {
        return Ok(ready);
    }
    if std::env::var_os(NO_INSTALL).is_some() {
        return Err(place.missing(&format!("{NO_INSTALL} is set")));
    }
    let system = system().ok_or_else(|| Missing {
        what: format!("Python {}.{} or newer is", OLDEST.0, OLDEST.1),
        why: "no such interpreter is on the PATH".to_owned(),
        advice: "install it by the system's package manager".to_owned(),
    })?;
    place.install(&system).map_err(|error| place.missing(&format!("{error:#}")))
}

/// What [`set_up`] would install under `home`, in words: the packages, their size, what they are for, and how; `None` where it would
/// install nothing.
#[must_use]
pub fn to_install(home: &Path, packages: &Packages) -> Option<String> {
    let place = EnvironmentFolder::new(home, packages);
    let may = std::env::var_os(NO_INSTALL).is_none() && place.ready().is_none();
    may.then(|| place.in_words())
}

/// The environment of `packages` under `home` as what is missing, because whoever was asked said no.
#[must_use]
pub fn declined(home: &Path, packages: &Packages) -> Missing {
    EnvironmentFolder::new(home, packages).missing("you said no")
}

/// Where the environment of some packages is.
struct EnvironmentFolder<'a> {
    packages: &'a Packages,
    folder: PathBuf,
}

impl<'a> EnvironmentFolder<'a> {
    fn new(home: &Path, packages: &'a Packages) -> Self {
        let folder = home.join(packages.name);
        // A child runs in a folder of its own choice.
        Self { packages, folder: std::path::absolute(&folder).unwrap_or(folder) }
    }

    fn marker(&self) -> PathBuf {
        self.folder.join("installed.txt")
    }

    fn python(&self) -> Python {
        let within = if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" };
        Python { interpreter: self.folder.join("environment").join(within), scripts: self.folder.join("scripts") }
    }

    /// The environment, where it holds what is pinned now; the scripts are those of this build.
    fn ready(&self) -> Option<Python> {
        let python = self.python();
        let installed = fs::read_to_string(self.marker()).ok()?;
        (installed == self.packages.requirements && python.interpreter.is_file()).then_some(())?;
        self.write_scripts().ok()?;
        Some(python)
    }

    fn write_scripts(&self) -> Result<()> {
        let folder = self.python().scripts;
        fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
        for (name, text) in self.packages.scripts {
            let path = folder.join(name);
            if fs::read_to_string(&path).is_ok_and(|there| there == *text) {
                continue;
            }
            // Another process may be reading the old one: it sees the whole of either.
            let fresh = folder.join(format!("{name}.{}", std::process::id()));
            fs::write(&fresh, text).with_context(|| format!("cannot write {}", fresh.display()))?;
            fs::rename(&fresh, &path).with_context(|| format!("cannot write {}", path.display()))?;
        }
        Ok(())
    }

    fn install(&self, system: &Path) -> Result<Python> {
        fs::create_dir_all(&self.folder).with_context(|| format!("cannot make {}", self.folder.display()))?;
        let lock = self.folder.join("lock");
        let lock = File::create(&lock).with_context(|| format!("cannot write {}", lock.display()))?;
        lock.lock().context("cannot wait for another set-up")?;
        if let Some(ready) = self.ready() {
            return Ok(ready);
        }
        let python = self.python();
        let environment = self.folder.join("environment");
        eprintln!("installing {}", self.in_words());
        run(Command::new(system).args(["-m", "venv", "--clear"]).arg(&environment))?;
        let list = self.folder.join("requirements.txt");
        fs::write(&list, self.packages.requirements).with_context(|| format!("cannot write {}", list.display()))?;
        let quiet = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--only-binary"];
        run(Command::new(&python.interpreter).args(quiet).args([":all:", "--requirement"]).arg(&list))?;
        self.write_scripts()?;
        fs::write(self.marker(), self.packages.requirements).context("cannot mark the set-up as done")?;
        Ok(python)
    }

    /// What would be installed, how large it is, what for, and how.
    fn in_words(&self) -> String {
        let Packages { size_mb, purpose, .. } = self.packages;
        format!("{} with what they need, {size_mb} MB, {purpose}: {}", self.pinned(), self.advice())
    }

    /// The packages with their versions.
    fn pinned(&self) -> String {
        let lines = self.packages.requirements.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        lines.collect::<Vec<_>>().join(", ")
    }

    fn advice(&self) -> String {
        format!("pip install into {}", self.folder.join("environment").display())
    }

    fn missing(&self, why: &str) -> Missing {
        Missing { what: format!("{} are", self.pinned()), why: why.to_owned(), advice: self.advice() }
    }
}

/// The first interpreter on the path that is new enough.
fn system() -> Option<PathBuf> {
    let question = "import sys; print(*sys.version_info[:2])";
    let new_enough = |name: &&str| {
        let output = Command::new(name).args(["-c", question]).stderr(Stdio::null()).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        let (major, minor) = text.trim().split_once(' ')?;
        ((major.parse().ok()?, minor.parse().ok()?) >= OLDEST).then_some(())
    };
    let names = ["python3", "python3.13", "python3.12", "python3.11", "python"];
    names.into_iter().find(|name| new_enough(name).is_some()).map(PathBuf::from)
}

/// Runs a step of the set-up; the last line of what it complains of becomes the error.
fn run(command: &mut Command) -> Result<()> {
    let text = format!("{command:?}");
    let output = command.stdin(Stdio::null()).output().with_context(|| format!("cannot run {text}"))?;
    let said = String::from_utf8_lossy(&output.stderr);
    let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
    anyhow::ensure!(output.status.success(), "{text} failed: {last}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_never_set_up_is_named_with_its_versions() {
        let home = std::env::temp_dir().join(format!("palpate-no-python-{}", std::process::id()));
        let text = find(&home, &SIMULATORS).unwrap_err().to_string();
        for part in ["mujoco==", "drake==", "exudyn==", "not been set up", "pip install"] {
            assert!(text.contains(part), "{text}");
        }
        assert!(!home.exists());
    }

    #[test]
    fn what_would_be_installed_is_told_with_its_size_unless_nothing_may_be() {
        let home = std::env::temp_dir().join(format!("palpate-size-{}", std::process::id()));
        let told = to_install(&home, &SIMULATORS);
        if std::env::var_os(NO_INSTALL).is_some() {
            assert_eq!(told, None);
        } else {
            let told = told.unwrap();
            assert!(told.contains("drake==") && told.contains("560 MB") && told.contains("pip install into"), "{told}");
        }
        assert!(declined(&home, &SIMULATORS).to_string().contains("you said no"));
    }

    #[test]
    fn what_is_pinned_otherwise_is_not_taken() {
        let home = std::env::temp_dir().join(format!("palpate-old-python-{}", std::process::id()));
        let place = EnvironmentFolder::new(&home, &SIMULATORS);
        fs::create_dir_all(place.python().interpreter.parent().unwrap()).unwrap();
        fs::write(place.python().interpreter, "").unwrap();
        fs::write(place.marker(), "mujoco==1.0.0\n").unwrap();
        assert!(find(&home, &SIMULATORS).is_err());
        fs::write(place.marker(), SIMULATORS.requirements).unwrap();
        assert!(find(&home, &SIMULATORS).unwrap().script("mujoco").is_ok());
        fs::remove_dir_all(&home).unwrap();
    }
}
