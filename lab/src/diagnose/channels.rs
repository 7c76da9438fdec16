//! The contact by its force and the drive by its effort: each is told what the other knows of the force sensor.

use anyhow::Result;

use super::acting_force::{
    CARRIED_BY_THE_DRIVE, LawForce, as_it_acted, as_the_rig_file_has_it, by_the_law, deviations_of_law, sensor_effects,
};
use super::check::Finding;
use super::clipped_force::{Spans, clipped_spans};
use super::contact;
use super::contact::circumstances::Circumstances;
use super::drive;
use super::drive::criteria::LEAST_PART_OF_ALL;
use super::drive::identification::{NominalStanding, nominal_standing};
use super::drive::interval::widen;
use super::drive::named::NamedEffect;
use super::drive::nominal::NominalDrive;
use super::drive::trial::DriveTrial;
use super::report::drive_report;
use super::verdict::Verdict;
use crate::effects::{self, Place};
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;

/// Recordings of a rig, to be identified.
pub struct Recorded<'a> {
    /// What its maker says of it.
    pub rig: &'a Rig,
    /// Where that is written.
    pub origin: &'a str,
    /// What was recorded.
    pub trials: &'a [Recording],
    /// What the sensors leave of each trial.
    pub figures: &'a [Figures],
    /// What the checks found of the motion in contact.
    pub circumstances: Circumstances,
    /// Of the bootstrap's draws.
    pub seed: u64,
    /// Told how it goes.
    pub say: &'a dyn Fn(&str),
}

/// What recordings say, channel by channel; `None` where they hold none of it, or too little.
pub struct Channels {
    /// By the force.
    pub contact: Option<contact::outcome::Outcome>,
    /// By the effort.
    pub drive: Option<drive::outcome::Outcome>,
    /// Effects of the force sensor that the contact would name and the drive speaks against.
    pub refuted: Vec<&'static str>,
}

impl Channels {
    /// Tells the drive the inertia beyond the force sensor that the contact names, unless the drive's law holds it.
    pub fn tell_what_is_beyond_the_sensor(&mut self) {
        let (Some(contact), Some(drive)) = (&self.contact, &mut self.drive) else { return };
        let model = &contact.chosen.model;
        let named = contact.named.iter().find(|named| model.terms[named.at].name() == "tool_inertia");
        let at = named.filter(|_| !drive.chosen.model.has("tool_inertia")).map(|named| model.first_value_of(named.at));
        drive.beyond_the_sensor = at.map(|at| (contact.chosen.values[at], contact.intervals[at]));
    }

    /// That the drive speaks against effects of the force sensor.
    #[must_use]
    pub fn finding(&self) -> Option<Finding> {
        let text = format!(
            "Force and position alone would be told as {}. The drive feels the force as it is shown, though: it is no error of the sensor, \
             but a force on the tool, as that of a weight or a magnet.",
            self.refuted.join(" and ")
        );
        let finding = Finding { code: "force_is_felt", grave: false, place: "force".to_owned(), text };
        (!self.refuted.is_empty()).then_some(finding)
    }
}

impl Recorded<'_> {
    /// What they say of contact and drive.
    ///
    /// # Errors
    /// Effects in the rig file that cannot be.
    pub fn identified(&self) -> Result<Channels> {
        let mut refuted: Vec<&'static str> = Vec::new();
        // Each round refutes an effect that was not refuted yet, and there are few: it ends.
        let mut channels = loop {
            let contact = self.contact(&[], &refuted)?;
            let acted = contact.as_ref().map(|contact| as_it_acted(contact, self.trials));
            let acted = acted.as_deref().unwrap_or(self.trials);
            let by_the_law = contact.as_ref().and_then(|contact| by_the_law(contact, acted));
            let clipped = contact.as_ref().map(|contact| clipped_spans(contact, self.trials)).unwrap_or_default();
            let by_the_law = self.felt(acted, by_the_law, &clipped)?;
            let mut drive = self.drive(by_the_law.as_ref().map_or(acted, |law| &law.trials), &clipped)?;
            if let (Some(contact), Some(drive), Some(law)) = (&contact, &mut drive, &by_the_law) {
                widen(drive, &deviations_of_law(contact, &law.trials));
            }
            let channels = Channels { contact, drive, refuted: refuted.clone() };
            let mut anew = self.refuted_by_the_drive(&channels, acted, &clipped)?;
            anew.retain(|name| !refuted.contains(name));
            if anew.is_empty() {
                break channels;
            }
            refuted.extend(anew);
        };
        let found = channels.drive.as_ref().map(drive_report::found).unwrap_or_default();
        let sensors: Vec<NamedEffect> =
            found.into_iter().filter(|found| CARRIED_BY_THE_DRIVE.contains(&found.name())).collect();
        if !sensors.is_empty() {
            channels.contact = self.contact(&sensors, &refuted)?;
        }
        if let (Some(contact), Some(drive)) = (&channels.contact, &mut channels.drive) {
            drive.leave_to_the_contact(|name| is_told(contact, name));
        }
        Ok(channels)
    }

    /// Effects of the force sensor that the contact names and the drive speaks against: with the force as it was shown nothing is missing
    /// in the drive, and with what they make of it, `acted`, something is. That two errors cancel each other is not believed. Where the drive was not
    /// looked at because the force was `clipped`, it is here.
    fn refuted_by_the_drive(
        &self,
        channels: &Channels,
        acted: &[Recording],
        clipped: &[Spans],
    ) -> Result<Vec<&'static str>> {
        let sensors = channels.contact.as_ref().map(sensor_effects).unwrap_or_default();
        let is_explained = is_complete(channels.drive.as_ref()) && clipped.iter().all(Vec::is_empty);
        if sensors.is_empty() || is_explained || channels.drive.is_none() {
            return Ok(Vec::new());
        }
        let shown = channels.contact.as_ref().map(|contact| as_the_rig_file_has_it(contact, self.trials));
        let shown = shown.as_deref().unwrap_or(self.trials);
        // A search takes long: it is asked where the nominal law fits better already.
        let likelihood = |standing: Option<NominalStanding>| standing.map(|standing| standing.log_likelihood);
        if likelihood(self.standing(shown, &[])?) <= likelihood(self.standing(acted, &[])?) {
            return Ok(Vec::new());
        }
        let as_shown = self.drive(shown, &[])?;
        Ok(if is_complete(as_shown.as_ref()) { sensors } else { Vec::new() })
    }

    /// The force `by_the_law` of the contact where the drive is looked for in that: where its refitted nominal law is likelier under it than with
    /// the force as it `acted`, and where that force's own error is less than any term of the drive is told for.
    fn felt(&self, acted: &[Recording], by_the_law: Option<LawForce>, clipped: &[Spans]) -> Result<Option<LawForce>> {
        let Some(law) = by_the_law else { return Ok(None) };
        let [first, other] = [acted, &law.trials].map(|trials| self.standing(trials, clipped));
        let (Some(first), Some(other)) = (first?, other?) else { return Ok(None) };
        let is_known = law.error < LEAST_PART_OF_ALL.value() * other.unexplained;
        Ok((is_known && other.log_likelihood > first.log_likelihood).then_some(law))
    }

    /// How the drive's refitted nominal law stands before `trials`; `None` where they show no motion of a drive.
    fn standing(&self, trials: &[Recording], clipped: &[Spans]) -> Result<Option<NominalStanding>> {
        Ok(self.prepared(trials, clipped)?.and_then(|(trials, nominal)| nominal_standing(&trials, &nominal)))
    }

    /// The contact, by force and position alone; `sensors` is what the drive found of the force sensor.
    fn contact(&self, sensors: &[NamedEffect], refuted: &[&'static str]) -> Result<Option<contact::outcome::Outcome>> {
        let rig = contact_rig(self.rig, sensors);
        let known = effects::resolve_all(&rig, self.origin)?;
        let is_recorded = contact::prepare::is_recorded(&rig, self.trials);
        let Some(nominal) = contact::prepare::nominal(&rig, known).filter(|_| is_recorded) else { return Ok(None) };
        let [fine, coarse] = contact::prepare::trials(self.trials, self.figures);
        let circumstances = Circumstances { refuted: with_kin(refuted), ..self.circumstances.clone() };
        Ok(contact::identification::identify(fine, &coarse, &nominal, circumstances, self.say))
    }

    /// The drive in `trials`, where their force is not `clipped`.
    fn drive(&self, trials: &[Recording], clipped: &[Spans]) -> Result<Option<drive::outcome::Outcome>> {
        let prepared = self.prepared(trials, clipped)?;
        Ok(prepared
            .and_then(|(trials, nominal)| drive::identification::identify(trials, &nominal, self.seed, self.say)))
    }

    /// `trials` as the drive's model sees them, without the rows in which their force is `clipped`, and what the rig says of it; effects that it already
    /// holds are nominal.
    fn prepared(&self, trials: &[Recording], clipped: &[Spans]) -> Result<Option<(Vec<DriveTrial>, NominalDrive)>> {
        let known = effects::resolve_all(self.rig, self.origin)?;
        let is_recorded = drive::prepare::is_recorded(self.rig, trials);
        let nominal = drive::prepare::nominal(self.rig, trials, known).filter(|_| is_recorded);
        Ok(nominal.map(|nominal| {
            let mut seen = drive::prepare::trials(self.rig, trials);
            for (trial, spans) in seen.iter_mut().zip(clipped).filter(|(_, spans)| !spans.is_empty()) {
                *trial = trial.without(spans);
            }
            (seen, nominal)
        }))
    }
}

/// `refuted`, and what would take its place: a force that is added to the sensor's own is as much felt where it wanders as where it stays. Without
/// that each is told in turn, and the search is made anew for each.
fn with_kin(refuted: &[&'static str]) -> Vec<&'static str> {
    const ADDED: [&str; 2] = ["force_bias", "force_drift"];
    let others: &[&str] = if refuted.iter().any(|name| ADDED.contains(name)) { &ADDED } else { &[] };
    refuted.iter().chain(others.iter().filter(|name| !refuted.contains(name))).copied().collect()
}

/// Whether nothing is missing in the drive.
fn is_complete(drive: Option<&drive::outcome::Outcome>) -> bool {
    drive.is_some_and(|drive| matches!(drive.verdict, Verdict::NoMismatch | Verdict::Parameters))
}

/// The rig without its drive, which has a model of its own; `sensors` is what that found of the force sensor, and known to the contact.
fn contact_rig(rig: &Rig, sensors: &[NamedEffect]) -> Rig {
    let mut contact = rig.clone();
    contact.drive = None;
    contact.effects.retain(|table| effects::find(&table.name).is_none_or(|e| e.spec().place != Place::Drive));
    contact.effects.extend(sensors.iter().map(|effect| drive_report::table(effect, rig.coordinate)));
    contact
}

/// Whether the contact names `name`, or what a slow sensor and a late one have in common.
fn is_told(contact: &contact::outcome::Outcome, name: &str) -> bool {
    let terms = &contact.chosen.model.terms;
    let names = |name: &str| contact.named.iter().any(|named| terms[named.at].name() == name);
    names(name) || (name == "channel_delay" && names("force_lag"))
}

#[cfg(test)]
mod tests {
    use super::{Circumstances, Recorded, with_kin};
    use crate::recording::Recording;
    use crate::rig::Rig;

    /// A drive that is held on a contact of which the sensor shows half: what it did meanwhile is not looked at, and what it did before and behind is.
    #[test]
    fn a_drive_is_looked_at_where_its_force_is_shown() {
        let text = "[rig]\nname = \"a rig\"\ncoordinate = \"linear\"\n[drive]\nmass_kg = 0.8\nviscous_n_s_m = 4.0\n\
                    [contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = 300.0\ndamping_n_s_m = 2.0\n";
        let rig = Rig::parse(text, "rig.toml").unwrap();
        let time: Vec<f64> = (0..3000).map(|row| f64::from(row) * 1e-3).collect();
        let position: Vec<f64> = time.iter().map(|t| 1e-2 * (3.0 * t).sin()).collect();
        let trial = Recording {
            name: "one.csv".to_owned(),
            force: Some(position.iter().map(|x| (300.0 * x).max(0.0)).collect()),
            effort: Some(vec![1.0; time.len()]),
            velocity: None,
            reference: None,
            load: None,
            time,
            position,
        };
        let trials = [trial];
        let figures = [crate::sensors::Figures::of(&rig, &trials[0])];
        let recorded = Recorded {
            rig: &rig,
            origin: "rig.toml",
            trials: &trials,
            figures: &figures,
            circumstances: Circumstances::default(),
            seed: 1,
            say: &|_| {},
        };
        let rows = |clipped: &[Vec<[f64; 2]>]| {
            let (mut seen, _) = recorded.prepared(&trials, clipped).unwrap().expect("a drive");
            let seen = seen.remove(0);
            (seen.len(), seen.time.iter().filter(|time| (0.9995..2.0005).contains(*time)).count())
        };
        assert_eq!(rows(&[]), (3000, 1001));
        assert_eq!(rows(&[vec![[1.0, 2.0]]]), (1999, 0));
    }

    /// A zero that is felt as a force is felt where it wanders, too; a wrong factor is another matter.
    #[test]
    fn what_the_drive_feels_of_a_zero_is_felt_however_it_moves() {
        assert_eq!(with_kin(&["force_bias"]), ["force_bias", "force_drift"]);
        assert_eq!(with_kin(&["force_gain", "force_drift"]), ["force_gain", "force_drift", "force_bias"]);
        assert_eq!(with_kin(&["force_gain"]), ["force_gain"]);
    }
}
