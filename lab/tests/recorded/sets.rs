//! The recordings: the rig file that each is held against, and what is known of it by those who made it.

/// Recordings of one kind.
pub struct Set {
    /// Below the folder of recordings.
    pub folder: &'static str,
    /// Below `lab/rigs`, without its ending.
    pub rig: &'static str,
    /// File names begin so.
    pub files: &'static [&'static str],
    /// Effects of the list that the README states or that its own words amount to.
    pub known: &'static [&'static str],
    /// Whether the README states physics that the list does not hold: an unknown is then right.
    pub beyond: bool,
    /// Whether the README says that one cannot tell dry friction from damping here.
    pub friction_is_open: bool,
    /// The README in a few words.
    pub says: &'static str,
}

const HAND: &str = "gravity, Coulomb friction, an offset; and a hand that pushes the arm";
const SOFT: &[&str] =
    &["nonlinear_stiffness", "adhesion", "hysteresis", "stress_relaxation", "force_drift", "force_bias"];
const AFM: &str = "power law, adhesion, hysteresis or relaxation; a baseline that drifts";

/// All of them.
pub const SETS: [Set; 17] = [
    Set {
        folder: "dfki_pendulum",
        rig: "dfki_pendulum",
        files: &["ddp", "dircol", "pd_sysid"],
        known: &["gravity_load", "coulomb_friction"],
        beyond: false,
        friction_is_open: false,
        says: "gravity, Coulomb friction, an offset of the torque",
    },
    Set {
        folder: "dfki_pendulum",
        rig: "dfki_pendulum",
        files: &["energy_shaping", "gravity_comp_hand", "ilqr_mpc", "pd_torque_limited", "sac"],
        known: &["gravity_load", "coulomb_friction"],
        beyond: true,
        friction_is_open: false,
        says: HAND,
    },
    Set {
        folder: "pneumatic_seal_friction",
        rig: "pneumatic_seal",
        files: &[""],
        known: &["force_bias", "hysteresis"],
        beyond: true,
        friction_is_open: true,
        says: "pressure times area, which differs by stroke; friction of the seal with presliding, not told from viscous",
    },
    Set {
        folder: "keyswitch_press",
        rig: "keyswitch",
        files: &["Cherry-MX-Red", "Gateron", "JWK"],
        known: &["force_bias", "layered_stiffness", "nonlinear_stiffness", "hysteresis", "lost_motion"],
        beyond: true,
        friction_is_open: true,
        says: "preload, a soft spring, a hard stop, hysteresis, lost motion",
    },
    Set {
        folder: "keyswitch_press",
        rig: "keyswitch",
        files: &["Akko", "Cherry-MX-Blue", "Cherry-MX-Hyper", "Gazzew", "NK-Kailh", "Outemu", "TG3"],
        known: &["force_bias", "layered_stiffness", "nonlinear_stiffness", "hysteresis", "lost_motion"],
        beyond: true,
        friction_is_open: true,
        says: "as the others, and a bump or click: negative stiffness, another path back",
    },
    Set {
        folder: "nanoindentation",
        rig: "nanoindenter",
        files: &["fused", "tungsten_cycles"],
        known: &["plastic_set", "nonlinear_stiffness", "stress_relaxation", "surface_motion"],
        beyond: false,
        friction_is_open: false,
        says: "plastic depth, power law, creep in the hold, slow drift of the depth",
    },
    Set {
        folder: "nanoindentation",
        rig: "nanoindenter",
        files: &["tungsten_popin"],
        known: &["plastic_set", "nonlinear_stiffness", "stress_relaxation", "surface_motion"],
        beyond: true,
        friction_is_open: false,
        says: "plastic depth, power law, and a sudden jump of 40 nm",
    },
    Set {
        folder: "tissue_indentation",
        rig: "tissue_meat",
        files: &["meat"],
        known: &["stress_relaxation", "nonlinear_stiffness"],
        beyond: false,
        friction_is_open: false,
        says: "relaxation at two time scales, progressive stiffness",
    },
    Set {
        folder: "tissue_indentation",
        rig: "tissue_s230515",
        files: &["s230515"],
        known: &["stress_relaxation", "nonlinear_stiffness", "hysteresis", "plastic_set"],
        beyond: false,
        friction_is_open: false,
        says: "relaxation, progressive stiffness; where unloaded, hysteresis and a residual depth",
    },
    afm("afm_cell", &["fd_cell_2016a"]),
    afm("afm_creep_brain", &["creep_brain"]),
    afm("afm_creep_gel", &["creep_polymergel"]),
    afm("afm_stiff", &["fd_qi_stiff_fast"]),
    afm("afm_mfp3d", &["fd_MFP3D_U3"]),
    afm("afm_flipsign", &["fd_2015_flipsign"]),
    afm("afm_spot", &["fd_spot3_2016"]),
    afm("afm_chiaro", &["chiaro_AEBP1_002"]),
];

const fn afm(rig: &'static str, files: &'static [&'static str]) -> Set {
    Set { folder: "afm_soft_contact", rig, files, known: SOFT, beyond: false, friction_is_open: false, says: AFM }
}
