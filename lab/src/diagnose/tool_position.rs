//! The contact behind a link: seen by the tool's position, where the encoder sits on the motor.
//!
//! What gives or plays between motor and tool lies between encoder and contact, too. The drive's model of two bodies tells by how much the
//! motor is ahead of its load at each row; what is left of the encoder's reading is where the tool was.

use anyhow::Result;

use super::acting_force::{as_the_rig_file_has_it, sensor_effects};
use super::channels::{Channels, Recorded};
use super::check::Finding;
use super::contact;
use super::drive::filter::innovations;
use super::drive::held_out::rms;
use super::drive::identification::identify;
use super::drive::law::Side;
use super::drive::outcome::Outcome;
use super::drive::prepare;
use super::verdict::Verdict;
use crate::effects;
use crate::recording::Recording;
use crate::recording::assemble::interpolated;

/// `channels` with the contact as it is told by the tool's position, where the drive found that to be another than the encoder's and less is
/// left by it; and that it was. A contact in which nothing is missing by the encoder's position stays so.
///
/// # Errors
/// Effects in the rig file that cannot be.
pub fn told_at_the_tool(recorded: &Recorded<'_>, channels: Channels) -> Result<(Channels, Option<Finding>)> {
    let (Some(contact), Some(drive)) = (&channels.contact, &channels.drive) else { return Ok((channels, None)) };
    if !is_behind_a_link(drive) {
        return Ok((channels, None));
    }
    // What the contact said of the force sensor it said by another position: the drive feels the force as it is shown.
    let as_shown = if sensor_effects(contact).is_empty() { None } else { drive_as_shown(recorded, contact)? };
    let told = as_shown.as_ref().unwrap_or(drive);
    if !is_behind_a_link(told) {
        return Ok((channels, None));
    }
    (recorded.say)("the contact: at the tool, behind the link");
    let trials = at_the_tool(told, recorded.trials);
    let anew =
        Recorded { trials: &trials, circumstances: recorded.circumstances.clone(), ..*recorded }.identified()?.contact;
    let left = |contact: &contact::outcome::Outcome| rms(&contact.residuals[2]);
    let is_whole =
        |contact: &contact::outcome::Outcome| matches!(contact.verdict, Verdict::NoMismatch | Verdict::Parameters);
    Ok(match anew.filter(|anew| left(anew) < left(contact) && (is_whole(anew) || !is_whole(contact))) {
        None => (channels, None),
        Some(anew) => {
            let drive = as_shown.or(channels.drive);
            (Channels { contact: Some(anew), drive, ..channels }, Some(finding()))
        }
    })
}

fn finding() -> Finding {
    let text = "The encoder sits on the motor's side of what gives there. The contact is told by the position of the tool, which follows from \
                the drive's model.";
    Finding { code: "tool_behind_link", grave: false, place: "position".to_owned(), text: text.to_owned() }
}

/// Whether the tool lies behind a link of which the encoder measures the motor's side.
fn is_behind_a_link(drive: &Outcome) -> bool {
    drive.chosen.model.terms.iter().any(|term| term.encoder() == Some(Side::Motor))
}

/// The drive under the force as it was shown, but for what the rig file states of the sensor.
fn drive_as_shown(recorded: &Recorded<'_>, contact: &contact::outcome::Outcome) -> Result<Option<Outcome>> {
    let known = effects::resolve_all(recorded.rig, recorded.origin)?;
    let trials = prepare::trials(recorded.rig, &as_the_rig_file_has_it(contact, recorded.trials));
    let nominal = prepare::nominal(recorded.rig, recorded.trials, known);
    Ok(nominal.and_then(|nominal| identify(trials, &nominal, recorded.seed, recorded.say)))
}

/// `recordings` with the position of the tool in the place of the encoder's, and without the effort, which moved the motor.
fn at_the_tool(drive: &Outcome, recordings: &[Recording]) -> Vec<Recording> {
    let law = drive.chosen.model.law(&drive.chosen.values);
    let moved = |(recording, trial): (&Recording, &super::drive::trial::DriveTrial)| {
        let lead = innovations(trial, &law, &drive.chosen.noise, true).stretch;
        // Encoder rows can be fewer than recorded ones.
        let (first, last) = (trial.time[0], trial.time[trial.len() - 1]);
        let clock: Vec<f64> = recording.time.iter().map(|time| time.clamp(first, last)).collect();
        let lead = interpolated(&trial.time, &lead, &clock);
        let position = recording.position.iter().zip(lead).map(|(position, lead)| position - lead).collect();
        Recording { position, velocity: None, effort: None, load: None, ..recording.clone() }
    };
    recordings.iter().zip(&drive.trials).map(moved).collect()
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;
    use rand_distr::{Distribution as _, StandardNormal};

    use super::*;
    use crate::rig::Rig;

    /// N/m, N s/m: of what is touched, and of the belt before it.
    const CONTACT: [f64; 2] = [300.0, 5.0];
    const BELT: [f64; 2] = [2500.0, 3.0];

    const RIG: &str = "[rig]\nname = \"belt\"\ncoordinate = \"linear\"\n\
                       [drive]\nmass_kg = 0.8\nviscous_n_s_m = 4.0\nencoder = \"motor\"\n\
                       [contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = 280.0\ndamping_n_s_m = 6.0\n";

    /// A motor of 0.5 kg, which has the encoder, and a tool of 0.3 kg on a belt, by small steps of its own with nothing of the model's.
    fn recording(seed: u64) -> Recording {
        const STEPS: usize = 25;
        let mut rng = rand_chacha::ChaCha12Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let step = 1e-3 / STEPS as f64;
        let wanted = |t: f64| -0.001 + 0.006 * (4.0 * t + seed as f64).sin() + 0.001 * (31.0 * t).sin();
        let ([mut x, mut v], [mut tool, mut pace]) = ([wanted(0.0), 0.0], [wanted(0.0), 0.0]);
        let answer = |tool: f64, pace: f64| {
            if tool > 0.0 { (CONTACT[0] * tool + CONTACT[1] * pace).max(0.0) } else { 0.0 }
        };
        let [mut time, mut position, mut force, mut effort] = [(); 4].map(|()| Vec::new());
        for row in 0..8000 {
            let t = 1e-3 * f64::from(row);
            let rate = (wanted(t) - wanted(t - 1e-3)) / 1e-3;
            let drives = 900.0 * (wanted(t) - x) + 25.0 * (rate - v);
            time.push(t);
            position.push(x + 2e-6 * normal());
            force.push(answer(tool, pace) + 0.01 * normal());
            effort.push(drives);
            for _ in 0..STEPS {
                let passed = BELT[0] * (x - tool) + BELT[1] * (v - pace);
                v += step * (drives - passed - 4.0 * v) / 0.5;
                pace += step * (passed - answer(tool, pace)) / 0.3;
                (x, tool) = (x + step * v, tool + step * pace);
            }
        }
        let [force, effort] = [force, effort].map(Some);
        Recording { name: format!("trial-{seed}.csv"), time, position, force, effort, ..Recording::default() }
    }

    #[test]
    fn a_contact_behind_a_belt_is_told_at_the_tool() {
        let rig = Rig::parse(RIG, "belt.toml").unwrap();
        let trials = [1, 2].map(recording);
        let found = crate::diagnose::diagnose(&rig, "belt.toml", &trials, &[], 1, &|_| {}).unwrap();
        let names: Vec<&str> = found.answer.physics.iter().map(|physics| physics.name.as_str()).collect();
        assert_eq!(names, ["transmission_compliance"]);
        assert!(found.answer.findings.iter().any(|finding| finding.code == "tool_behind_link"));
        let contact = found.improved.contact.unwrap();
        // In series with the belt it would be 268 N/m.
        assert!((contact.stiffness / CONTACT[0] - 1.0).abs() < 0.01, "{contact:?}");
        assert!((contact.damping / CONTACT[1] - 1.0).abs() < 0.05, "{contact:?}");
    }
}
