//! What is known of the recordings by those who made them: the concealed answers.

/// How the recordings of a set become specimens, and which of their rows no diagnosis sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parted {
    /// All files are trials of one specimen, which has this name: every other one by name teaches, the others are scored.
    Trials(&'static str),
    /// Each file is a specimen: its strokes up to the turn nearest the middle teach, those after it are scored.
    Strokes,
    /// Each file is a specimen, and cannot be parted, for this reason.
    Whole(&'static str),
}

/// Recordings of one kind.
#[derive(Debug)]
pub struct Set {
    /// Below the folder of recordings.
    pub folder: &'static str,
    /// Below `lab/rigs`, without its ending.
    pub rig: &'static str,
    /// File names begin so.
    pub files: &'static [&'static str],
    /// What is shown to the diagnosis of it.
    pub parted: Parted,
    /// Effects of the list that the README states.
    pub has: &'static [&'static str],
    /// Names that its words allow as well: what it states may be called so, or these data do not refute it.
    pub may: &'static [&'static str],
    /// Whether the README states physics that the list does not hold: an unknown is then right.
    pub beyond: bool,
    /// Whether these data cannot tell dry friction from damping: to name one as if it were decided is wrong.
    pub friction_is_open: bool,
    /// The README in a few words.
    pub says: &'static str,
}

const ONE_PRESS: Parted = Parted::Whole("one press down and up");
const ONE_CURVE: Parted = Parted::Whole("one approach and one retraction");

const ARM: Set = Set {
    folder: "dfki_pendulum",
    rig: "dfki_pendulum",
    files: &[],
    parted: Parted::Strokes,
    has: &["gravity_load", "coulomb_friction"],
    may: &[],
    beyond: false,
    friction_is_open: false,
    says: "gravity, Coulomb friction, an offset of the torque",
};
const SWITCH: Set = Set {
    folder: "keyswitch_press",
    rig: "keyswitch",
    files: &[],
    parted: ONE_PRESS,
    has: &["layered_stiffness", "hysteresis", "lost_motion"],
    may: &["force_bias", "nonlinear_stiffness"],
    beyond: true,
    friction_is_open: true,
    says: "preload, a soft spring, a hard stop, hysteresis, lost motion",
};
const DIAMOND: Set = Set {
    folder: "nanoindentation",
    rig: "nanoindenter",
    files: &[],
    parted: Parted::Trials("fused_silica_cycles"),
    has: &["plastic_set", "nonlinear_stiffness", "stress_relaxation"],
    may: &["surface_motion"],
    beyond: false,
    friction_is_open: false,
    says: "plastic depth, power law, creep in the hold, slow drift of the depth",
};
const TISSUE: Set = Set {
    folder: "tissue_indentation",
    rig: "tissue_meat",
    files: &[],
    parted: Parted::Whole(""),
    has: &["stress_relaxation", "nonlinear_stiffness"],
    may: &[],
    beyond: false,
    friction_is_open: false,
    says: "relaxation at two time scales, progressive stiffness",
};
const AFM: Set = Set {
    folder: "afm_soft_contact",
    rig: "afm_cell",
    files: &[],
    parted: ONE_CURVE,
    has: &["nonlinear_stiffness", "adhesion"],
    may: &["hysteresis", "stress_relaxation", "force_drift", "force_bias"],
    beyond: false,
    friction_is_open: false,
    says: "power law, adhesion, hysteresis or relaxation; a baseline that drifts",
};

/// All of them.
pub const SETS: [Set; 24] = [
    Set { files: &["ddp", "dircol"], parted: Parted::Trials("swing_up"), ..ARM },
    Set { files: &["pd_sysid"], parted: Parted::Whole("one swing-up"), ..ARM },
    Set {
        files: &["energy_shaping", "gravity_comp_hand", "ilqr_mpc", "pd_torque_limited", "sac"],
        beyond: true,
        says: "gravity, Coulomb friction, an offset; and a hand that pushes the arm",
        ..ARM
    },
    Set {
        folder: "pneumatic_seal_friction",
        rig: "pneumatic_seal",
        files: &[""],
        parted: Parted::Strokes,
        has: &["hysteresis"],
        may: &["force_bias"],
        beyond: true,
        friction_is_open: true,
        says: "pressure times area, which differs by stroke; friction of the seal with presliding, not told from viscous",
    },
    Set { files: &["Cherry-MX-Red", "Gateron", "JWK"], ..SWITCH },
    Set {
        files: &["Akko", "Cherry-MX-Blue", "Cherry-MX-Hyper", "Gazzew", "NK-Kailh", "Outemu", "TG3"],
        says: "as the others, and a bump or click: negative stiffness, another path back",
        ..SWITCH
    },
    Set { files: &["fused_silica"], ..DIAMOND },
    Set { files: &["tungsten_cycles"], parted: Parted::Trials("tungsten_cycles"), ..DIAMOND },
    Set {
        files: &["tungsten_popin"],
        parted: Parted::Trials("tungsten_popin"),
        beyond: true,
        says: "plastic depth, power law, and a sudden jump of 40 nm",
        ..DIAMOND
    },
    // Each piece was pressed on two days: the first teaches.
    Set { files: &["meat_230327_FF1", "meat_230331_FF1"], parted: Parted::Trials("meat_FF1"), ..TISSUE },
    Set { files: &["meat_230327_FF2", "meat_230331_FF2"], parted: Parted::Trials("meat_FF2"), ..TISSUE },
    Set { files: &["meat_230327_RDG1", "meat_230331_RDG1"], parted: Parted::Trials("meat_RDG1"), ..TISSUE },
    Set { files: &["meat_230327_RDG2", "meat_230331_RDG2"], parted: Parted::Trials("meat_RDG2"), ..TISSUE },
    Set {
        rig: "tissue_s230515",
        files: &["s230515_P002_1", "s230515_P002_3", "s230515_P002_4", "s230515_P002_7", "s230515_P002_9"],
        parted: Parted::Trials("soft_P002"),
        has: &["stress_relaxation", "nonlinear_stiffness", "hysteresis"],
        may: &["plastic_set"],
        says: "relaxation, progressive stiffness, hysteresis, a residual depth that recovers",
        ..TISSUE
    },
    soft("soft_P002_laser", &["s230515_P002_laser"]),
    soft("soft_P011_laser", &["s230515_P011_laser"]),
    Set { files: &["fd_cell_2016a"], ..AFM },
    afm("afm_creep_brain", &["creep_brain"]),
    afm("afm_creep_gel", &["creep_polymergel"]),
    afm("afm_stiff", &["fd_qi_stiff_fast"]),
    afm("afm_mfp3d", &["fd_MFP3D_U3"]),
    afm("afm_flipsign", &["fd_2015_flipsign"]),
    afm("afm_spot", &["fd_spot3_2016"]),
    afm("afm_chiaro", &["chiaro_AEBP1_002"]),
];

const fn afm(rig: &'static str, files: &'static [&'static str]) -> Set {
    Set { rig, files, ..AFM }
}

const fn soft(specimen: &'static str, files: &'static [&'static str]) -> Set {
    Set {
        rig: "tissue_s230515",
        files,
        parted: Parted::Trials(specimen),
        says: "relaxation, progressive stiffness",
        ..TISSUE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects;

    #[test]
    fn every_answer_is_of_the_list_and_no_name_is_both_stated_and_allowed() {
        let listed: Vec<&str> = effects::ALL.iter().map(|effect| effect.card().name).collect();
        for set in &SETS {
            for name in set.has.iter().chain(set.may) {
                assert!(listed.contains(name), "{}: {name}", set.folder);
            }
            assert!(!set.has.is_empty() && set.has.iter().all(|name| !set.may.contains(name)), "{}", set.folder);
        }
    }
}
