//! What is known of the recordings by those who made them: the concealed answers.

use super::held_out::OwnToTrial;

/// How the recordings of a set become specimens, and which of their rows no diagnosis sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Split {
    /// All files are trials of one specimen, which has this name: every other one by name is trained on, the others are scored.
    Trials(&'static str),
    /// Each file is a specimen: its strokes up to the turn nearest the middle are trained on, those after it are scored.
    Strokes,
    /// Each file is a specimen, and cannot be parted, for this reason.
    Whole(&'static str),
}

/// Recordings of one kind.
#[derive(Debug)]
pub struct RecordingSet {
    /// Below the folder of recordings.
    pub folder: &'static str,
    /// Below `lab/rigs`, without its ending.
    pub rig: &'static str,
    /// File names begin so.
    pub files: &'static [&'static str],
    /// What is shown to the diagnosis of it.
    pub split: Split,
    /// What belongs to each trial: pieces and spots differ where a README says so.
    pub own_to_trial: OwnToTrial,
    /// Effects of the list that the README states.
    pub stated: &'static [&'static str],
    /// Names that its words allow as well: what it states may be called so, or these data do not refute it.
    pub allowed: &'static [&'static str],
    /// Whether the README states physics that the list does not hold: an unknown is then right.
    pub has_unlisted_physics: bool,
    /// Whether these data cannot tell dry friction from damping: to name one as if it were decided is wrong.
    pub friction_is_open: bool,
    /// The README in a few words.
    pub description: &'static str,
}

const ONE_PRESS: Split = Split::Whole("one press down and up");
const ONE_CURVE: Split = Split::Whole("one approach and one retraction");

const ARM: RecordingSet = RecordingSet {
    folder: "dfki_pendulum",
    rig: "dfki_pendulum",
    files: &[],
    split: Split::Strokes,
    own_to_trial: OwnToTrial::Place,
    stated: &["gravity_load", "coulomb_friction"],
    allowed: &[],
    has_unlisted_physics: false,
    friction_is_open: false,
    description: "gravity, Coulomb friction, an offset of the torque",
};
const SWITCH: RecordingSet = RecordingSet {
    folder: "keyswitch_press",
    rig: "keyswitch",
    files: &[],
    split: ONE_PRESS,
    own_to_trial: OwnToTrial::Place,
    stated: &["layered_stiffness", "hysteresis", "lost_motion"],
    allowed: &["force_bias", "nonlinear_stiffness"],
    has_unlisted_physics: true,
    friction_is_open: true,
    description: "preload, a soft spring, a hard stop, hysteresis, lost motion",
};
const DIAMOND: RecordingSet = RecordingSet {
    folder: "nanoindentation",
    rig: "nanoindenter",
    files: &[],
    split: Split::Trials("fused_silica_cycles"),
    own_to_trial: OwnToTrial::Place,
    stated: &["plastic_set", "nonlinear_stiffness", "stress_relaxation"],
    allowed: &["surface_motion"],
    has_unlisted_physics: false,
    friction_is_open: false,
    description: "plastic depth, power law, creep in the hold, slow drift of the depth",
};
const TISSUE: RecordingSet = RecordingSet {
    folder: "tissue_indentation",
    rig: "tissue_meat",
    files: &[],
    split: Split::Whole(""),
    own_to_trial: OwnToTrial::PlaceAndScale,
    stated: &["stress_relaxation", "nonlinear_stiffness"],
    allowed: &[],
    has_unlisted_physics: false,
    friction_is_open: false,
    description: "relaxation at two time scales, progressive stiffness",
};
const AFM: RecordingSet = RecordingSet {
    folder: "afm_soft_contact",
    rig: "afm_cell",
    files: &[],
    split: ONE_CURVE,
    own_to_trial: OwnToTrial::Place,
    stated: &["nonlinear_stiffness", "adhesion"],
    allowed: &["hysteresis", "stress_relaxation", "force_drift", "force_bias"],
    has_unlisted_physics: false,
    friction_is_open: false,
    description: "power law, adhesion, hysteresis or relaxation; a baseline that drifts",
};

const AXIS: RecordingSet = RecordingSet {
    folder: "",
    rig: "",
    files: &[""],
    split: ONE_CURVE,
    own_to_trial: OwnToTrial::Place,
    stated: &["coulomb_friction"],
    allowed: &["gravity_load"],
    has_unlisted_physics: false,
    friction_is_open: false,
    description: "Coulomb friction and an offset of the torque",
};
const ROBOT_AXIS: RecordingSet = RecordingSet {
    // The READMEs: either is right, the slow share is too short to tell.
    stated: &["coulomb_friction", "stribeck_friction"],
    description: "Coulomb or Stribeck friction, not distinguished, and an offset",
    ..AXIS
};

/// All of them.
pub const RECORDING_SETS: [RecordingSet; 32] = [
    RecordingSet { files: &["ddp", "dircol"], split: Split::Trials("swing_up"), ..ARM },
    RecordingSet { files: &["pd_sysid"], split: Split::Whole("one swing-up"), ..ARM },
    RecordingSet {
        files: &["energy_shaping", "gravity_comp_hand", "ilqr_mpc", "pd_torque_limited", "sac"],
        has_unlisted_physics: true,
        description: "gravity, Coulomb friction, an offset; and a hand that pushes the arm",
        ..ARM
    },
    RecordingSet {
        folder: "pneumatic_seal_friction",
        rig: "pneumatic_seal",
        files: &[""],
        split: Split::Strokes,
        own_to_trial: OwnToTrial::Place,
        stated: &["hysteresis"],
        allowed: &["force_bias"],
        has_unlisted_physics: true,
        friction_is_open: true,
        description: "pressure times area, which differs by stroke; friction of the seal with presliding, not distinguished from viscous",
    },
    RecordingSet { files: &["Cherry-MX-Red", "Gateron", "JWK"], ..SWITCH },
    RecordingSet {
        files: &["Akko", "Cherry-MX-Blue", "Cherry-MX-Hyper", "Gazzew", "NK-Kailh", "Outemu", "TG3"],
        description: "as the others, and a bump or click: negative stiffness, another path back",
        ..SWITCH
    },
    RecordingSet { files: &["fused_silica"], ..DIAMOND },
    RecordingSet { files: &["tungsten_cycles"], split: Split::Trials("tungsten_cycles"), ..DIAMOND },
    RecordingSet {
        files: &["tungsten_popin"],
        split: Split::Trials("tungsten_popin"),
        has_unlisted_physics: true,
        description: "plastic depth, power law, and a sudden jump of 40 nm",
        ..DIAMOND
    },
    // Each piece was pressed on two days: the first is trained on.
    RecordingSet { files: &["meat_230327_FF1", "meat_230331_FF1"], split: Split::Trials("meat_FF1"), ..TISSUE },
    RecordingSet { files: &["meat_230327_FF2", "meat_230331_FF2"], split: Split::Trials("meat_FF2"), ..TISSUE },
    RecordingSet { files: &["meat_230327_RDG1", "meat_230331_RDG1"], split: Split::Trials("meat_RDG1"), ..TISSUE },
    RecordingSet { files: &["meat_230327_RDG2", "meat_230331_RDG2"], split: Split::Trials("meat_RDG2"), ..TISSUE },
    RecordingSet {
        rig: "tissue_s230515",
        files: &["s230515_P002_1", "s230515_P002_3", "s230515_P002_4", "s230515_P002_7", "s230515_P002_9"],
        split: Split::Trials("soft_P002"),
        stated: &["stress_relaxation", "nonlinear_stiffness", "hysteresis"],
        allowed: &["plastic_set"],
        description: "relaxation, progressive stiffness, hysteresis, a residual depth that recovers",
        ..TISSUE
    },
    soft("soft_P002_laser", &["s230515_P002_laser"]),
    soft("soft_P011_laser", &["s230515_P011_laser"]),
    RecordingSet { files: &["fd_cell_2016a"], ..AFM },
    afm("afm_creep_brain", &["creep_brain"]),
    afm("afm_creep_gel", &["creep_polymergel"]),
    afm("afm_stiff", &["fd_qi_stiff_fast"]),
    afm("afm_mfp3d", &["fd_MFP3D_U3"]),
    afm("afm_flipsign", &["fd_2015_flipsign"]),
    afm("afm_spot", &["fd_spot3_2016"]),
    afm("afm_chiaro", &["chiaro_AEBP1_002"]),
    RecordingSet {
        folder: "emps_linear_drive",
        rig: "emps",
        files: &["track"],
        split: Split::Trials("tracks"),
        description: "Coulomb friction, asymmetric by a constant force",
        ..AXIS
    },
    RecordingSet {
        folder: "emps_linear_drive",
        rig: "emps",
        files: &["pulses"],
        split: Split::Trials("pulses"),
        description: "Coulomb friction, asymmetric by a constant force",
        ..AXIS
    },
    RecordingSet { folder: "kuka_kr300_joints/joint1", rig: "kuka_joint1", split: Split::Trials("axis"), ..ROBOT_AXIS },
    RecordingSet { folder: "kuka_kr300_joints/joint6", rig: "kuka_joint6", split: Split::Trials("axis"), ..ROBOT_AXIS },
    // The README's own figure: a power of 0.7 to 0.8 of the speed beside the dry friction leaves a fifth to a tenth less.
    RecordingSet {
        folder: "staubli_tx40_joints/joint1",
        rig: "tx40_joint1",
        split: Split::Trials("axis"),
        allowed: &["sublinear_friction"],
        description: "Coulomb friction, and viscous friction that grows less than the speed",
        ..AXIS
    },
    RecordingSet {
        folder: "staubli_tx40_joints/joint4",
        rig: "tx40_joint4",
        split: Split::Trials("axis"),
        allowed: &["gravity_load", "sublinear_friction"],
        description: "Coulomb friction, and viscous friction that grows less than the speed",
        ..AXIS
    },
    RecordingSet {
        folder: "laas_motor_cogging",
        rig: "laas_motor",
        split: Split::Whole("one run at one speed"),
        stated: &["cogging"],
        allowed: &["coulomb_friction", "stribeck_friction", "gravity_load"],
        description: "cogging of several periods a turn, dry friction",
        ..AXIS
    },
    RecordingSet {
        folder: "silverbox_duffing",
        rig: "silverbox",
        files: &["arrow", "multisine"],
        split: Split::Trials("circuit"),
        stated: &["environment_mass", "tool_inertia", "nonlinear_stiffness"],
        allowed: &["force_bias"],
        description: "a mass that moves along, a cubic hardening spring, an offset of the force",
        ..AXIS
    },
];

const fn afm(rig: &'static str, files: &'static [&'static str]) -> RecordingSet {
    RecordingSet { rig, files, ..AFM }
}

const fn soft(specimen: &'static str, files: &'static [&'static str]) -> RecordingSet {
    RecordingSet {
        rig: "tissue_s230515",
        files,
        split: Split::Trials(specimen),
        description: "relaxation, progressive stiffness",
        ..TISSUE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects;

    #[test]
    fn every_answer_is_of_the_list_and_no_name_is_both_stated_and_allowed() {
        let listed: Vec<&str> = effects::ALL.iter().map(|effect| effect.spec().name).collect();
        for set in &RECORDING_SETS {
            for name in set.stated.iter().chain(set.allowed) {
                assert!(listed.contains(name), "{}: {name}", set.folder);
            }
            assert!(
                !set.stated.is_empty() && set.stated.iter().all(|name| !set.allowed.contains(name)),
                "{}",
                set.folder
            );
        }
    }
}
