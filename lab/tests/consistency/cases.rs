//! Twenty small rigs with something missing, or nothing.

use std::path::{Path, PathBuf};

use palpate_lab::outfile::OutFile;
use palpate_lab::rig::Rig;
use palpate_lab::simulate::simulate;

/// What is simulated.
#[derive(Debug, Clone, Copy)]
pub enum Bench {
    /// A tool that is led against a pad: millimetres and newtons.
    Led,
    /// The same a thousand times smaller, at nanonewtons.
    Cantilever,
    /// A lever that is led against a stop.
    Lever,
    /// A slide that is driven in free motion.
    Slide,
    /// A driven tool that presses.
    Driven,
    /// A driven arm that swings.
    Arm,
}

/// A diagnosis.
pub struct Case {
    pub name: &'static str,
    pub bench: Bench,
    /// Tables that the real rig has beside those of its file.
    pub missing: &'static str,
    /// Tables that the file has as well.
    pub known: &'static str,
    /// What is added to the recorded force, or to the effort where none is, by time and position.
    pub added: Option<fn(f64, f64) -> f64>,
    /// Stiffness and mass in the file over the real ones.
    pub off: f64,
    /// Whether the file states neither controller nor motion.
    pub bare: bool,
}

const PLAIN: Case = Case { name: "", bench: Bench::Led, missing: "", known: "", added: None, off: 1.0, bare: false };

const FADES: &str = "[[effect]]\nname = \"stress_relaxation\"\nbranch_stiffness_n_m = 60.0\nrelaxation_time_s = 0.3\n";
const DRAGS: &str = "[[effect]]\nname = \"coulomb_friction\"\nlevel_n = 0.8\n";

pub const CASES: &[Case] = &[
    Case { name: "nothing", ..PLAIN },
    Case { name: "another stiffness", off: 0.8, ..PLAIN },
    Case { name: "stress relaxation", missing: FADES, ..PLAIN },
    Case { name: "stress relaxation and another stiffness", missing: FADES, off: 1.2, ..PLAIN },
    Case {
        name: "quadratic damping",
        missing: "[[effect]]\nname = \"quadratic_damping\"\nquadratic_n_s2_m2 = 60.0\n",
        ..PLAIN
    },
    Case {
        name: "adhesion",
        missing: "[[effect]]\nname = \"adhesion\"\npull_off_force_n = 0.3\nrelease_height_m = 0.001\n",
        ..PLAIN
    },
    Case { name: "a bias", missing: "[[effect]]\nname = \"force_bias\"\nbias_n = 0.2\n", ..PLAIN },
    Case { name: "a delay", missing: "[[effect]]\nname = \"channel_delay\"\ndelay_s = 0.006\n", ..PLAIN },
    Case {
        name: "hum",
        missing: "[[effect]]\nname = \"mains_hum\"\nsine_n = 0.1\ncosine_n = 0.0\nfrequency_hz = 50.0\n",
        ..PLAIN
    },
    Case {
        name: "a bias beside relaxation that is known",
        known: FADES,
        missing: "[[effect]]\nname = \"force_bias\"\nbias_n = 0.2\n",
        ..PLAIN
    },
    Case {
        name: "a ripple that no law has",
        added: Some(|_, x| if x > 0.0 { 0.6 * (std::f64::consts::TAU * x / 3e-3).sin() } else { 0.0 }),
        ..PLAIN
    },
    Case { name: "a wandering force", added: Some(|t, _| 0.15 * (2.3 * t * t).sin()), ..PLAIN },
    Case { name: "nothing, by a cantilever", bench: Bench::Cantilever, ..PLAIN },
    Case { name: "another stiffness, by a cantilever", bench: Bench::Cantilever, off: 1.3, ..PLAIN },
    Case { name: "nothing, by a lever", bench: Bench::Lever, ..PLAIN },
    Case { name: "another stiffness, by a lever", bench: Bench::Lever, off: 0.7, ..PLAIN },
    Case {
        name: "another stiffness, by a lever whose motion is not stated",
        bench: Bench::Lever,
        off: 0.8,
        bare: true,
        ..PLAIN
    },
    Case {
        name: "a weight on an arm whose controller is not stated",
        bench: Bench::Arm,
        missing: "[[effect]]\nname = \"gravity_load\"\nform = \"by_angle\"\nsine_n_m = 2.0\ncosine_n_m = 0.0\nload_n_m = 0.0\n",
        bare: true,
        ..PLAIN
    },
    Case { name: "nothing in a drive", bench: Bench::Slide, ..PLAIN },
    Case { name: "another mass", bench: Bench::Slide, off: 1.3, ..PLAIN },
    Case { name: "friction", bench: Bench::Slide, missing: DRAGS, ..PLAIN },
    Case { name: "a wandering effort", bench: Bench::Slide, added: Some(|t, _| 0.8 * (3.1 * t * t).sin()), ..PLAIN },
    Case {
        name: "friction and relaxation",
        bench: Bench::Driven,
        missing: concat!(
            "[[effect]]\nname = \"stress_relaxation\"\nbranch_stiffness_n_m = 60.0\nrelaxation_time_s = 0.3\n",
            "[[effect]]\nname = \"coulomb_friction\"\nlevel_n = 0.8\n"
        ),
        ..PLAIN
    },
];

impl Case {
    /// Writes `rig.toml` and the recordings of two trials, whose places are returned.
    pub fn write(&self, folder: &Path) -> Vec<PathBuf> {
        let given = self.rig(0, self.off);
        let stated = if self.bare {
            given.split("[control]").next().unwrap().split("[reference]").next().unwrap()
        } else {
            &given
        };
        std::fs::write(folder.join("rig.toml"), stated.to_owned() + self.known).unwrap();
        let trials = (0..2).map(|trial| {
            let text = self.rig(trial, 1.0) + self.known + self.missing;
            let rig = Rig::parse(&text, self.name).unwrap_or_else(|error| panic!("{error}"));
            let simulated = simulate(&rig, 1 + trial as u64, self.name).unwrap_or_else(|error| panic!("{error}"));
            let path = folder.join(format!("trial-{}.csv", trial + 1));
            simulated.recording.write_to(OutFile::create(&path).unwrap(), &rig).unwrap();
            std::fs::write(&path, self.changed(&std::fs::read_to_string(&path).unwrap())).unwrap();
            path
        });
        trials.collect()
    }

    /// The recording with what is added to its last column.
    fn changed(&self, csv: &str) -> String {
        let Some(added) = self.added else { return csv.to_owned() };
        let (header, rows) = csv.split_once('\n').unwrap();
        let names: Vec<&str> = header.split(',').collect();
        let at = |wanted: &str| names.iter().position(|name| name.starts_with(wanted));
        let (time, position) = (at("t_s").unwrap(), at("position").unwrap());
        let target = at("force").or(at("effort")).unwrap();
        let mut out = format!("{header}\n");
        for row in rows.lines() {
            let mut values: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            values[target] += added(values[time], values[position]);
            out += &(values.iter().map(f64::to_string).collect::<Vec<_>>().join(",") + "\n");
        }
        out
    }

    fn rig(&self, trial: usize, off: f64) -> String {
        let (depth, contact, sine) = [(0.008, 1.1, 3.0), (0.007, 1.0, 7.3)][trial];
        match self.bench {
            Bench::Led => led(1.0, 1.0, 300.0 * off, (depth, contact, sine)),
            Bench::Cantilever => led(1e-3, 1e-9, 300.0 * off, (depth, contact, sine)),
            Bench::Lever => lever(12.0 * off, contact, sine),
            Bench::Arm => arm(0.15 * off, sine),
            Bench::Slide => driven("", 0.45 * off, (depth, contact, sine)),
            Bench::Driven => driven(
                "[contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = 300.0\ndamping_n_s_m = 5.0\n",
                0.45 * off,
                (depth, contact, sine),
            ),
        }
    }
}

const RATE: &str = "[simulation]\nduration_s = 3.2\nrate_hz = 250\n";

fn led(metre: f64, newton: f64, stiffness: f64, (depth, contact, sine): (f64, f64, f64)) -> String {
    format!(
        "[rig]\nname = \"bench\"\ncoordinate = \"linear\"\n\
         [contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = {:e}\ndamping_n_s_m = {:e}\n\
         [sensors]\nposition_resolution_m = {:e}\nforce_resolution_n = {:e}\nforce_noise_n = {:e}\n\
         [reference]\nfree_depth_m = {:e}\ncontact_depth_m = {:e}\nperiod_s = 1.6\ncontact_s = {contact}\n\
         smoothing_s = 0.05\nsine_amplitude_m = {:e}\nsine_frequency_hz = {sine}\n{RATE}",
        stiffness * newton / metre,
        5.0 * newton / metre,
        5e-6 * metre,
        0.005 * newton,
        0.01 * newton,
        -0.003 * metre,
        depth * metre,
        0.002 * metre,
    )
}

fn lever(stiffness: f64, contact: f64, sine: f64) -> String {
    format!(
        "[rig]\nname = \"lever\"\ncoordinate = \"rotary\"\n\
         [contact]\nmodel = \"kelvin_voigt\"\nsurface_rad = 0.5\nstiffness_n_m_rad = {stiffness}\ndamping_n_m_s_rad = 0.2\n\
         [sensors]\nposition_resolution_rad = 1e-4\ntorque_resolution_n_m = 0.005\ntorque_noise_n_m = 0.01\n\
         [reference]\nfree_depth_rad = -0.1\ncontact_depth_rad = 0.15\nperiod_s = 1.6\ncontact_s = {contact}\n\
         smoothing_s = 0.05\nsine_amplitude_rad = 0.03\nsine_frequency_hz = {sine}\n{RATE}"
    )
}

fn arm(inertia: f64, sine: f64) -> String {
    format!(
        "[rig]\nname = \"arm\"\ncoordinate = \"rotary\"\n[drive]\ninertia_kg_m2 = {inertia}\nviscous_n_m_s_rad = 0.05\n\
         [sensors]\nposition_resolution_rad = 1e-4\n[control]\nproportional_n_m_rad = 60\nderivative_n_m_s_rad = 4\nrate_hz = 1000\n\
         [reference]\nfree_depth_rad = -1.0\ncontact_depth_rad = 1.4\nperiod_s = 1.6\ncontact_s = 0.8\n\
         smoothing_s = 0.1\nsine_amplitude_rad = 0.2\nsine_frequency_hz = {}\n{RATE}",
        0.3 * sine
    )
}

fn driven(contact: &str, mass: f64, (depth, touching, sine): (f64, f64, f64)) -> String {
    let force = if contact.is_empty() { "" } else { "force_resolution_n = 0.005\nforce_noise_n = 0.01\n" };
    format!(
        "[rig]\nname = \"slide\"\ncoordinate = \"linear\"\n{contact}\
         [drive]\nmass_kg = {mass}\nviscous_n_s_m = 2.0\n[sensors]\nposition_resolution_m = 5e-6\n{force}\
         [control]\nproportional_n_m = 775\nderivative_n_s_m = 10\nrate_hz = 1000\n\
         [reference]\nfree_depth_m = -0.003\ncontact_depth_m = {depth}\nperiod_s = 1.6\ncontact_s = {touching}\n\
         smoothing_s = 0.05\nsine_amplitude_m = 0.002\nsine_frequency_hz = {sine}\n{RATE}"
    )
}
