//! What is said of adhesion, and its forms.

use crate::effects::{EffectSpec, Form, Limit, Parameter, Place, Stage};
use crate::rig::Word;

const PULL: Parameter = Parameter::new("pull_off_force", Word::new("N", "N m"), "the pull", 0.0, f64::INFINITY);
const PEAK_HEIGHT: Parameter = Parameter::new(
    "peak_height",
    Word::new("m", "rad"),
    "height above the surface at which the pull is greatest",
    0.0,
    f64::INFINITY,
);
const RELEASE_HEIGHT: Parameter =
    Parameter::new("release_height", Word::new("m", "rad"), "height at which it ends", 0.0, f64::INFINITY);

pub static SPEC: EffectSpec = EffectSpec {
    name: "adhesion",
    place: Place::Contact,
    stage: Stage::Limit,
    max_instances: 1,
    statement: "On leaving, the surface holds on to the tool and pulls before it lets go",
    forms: &[
        Form {
            name: "neck",
            equation: "leaving, F falls below zero down to -pull_off_force and lets go at a height of release_height",
            parameters: &[
                Parameter::new("pull_off_force", Word::new("N", "N m"), "greatest pull", 0.0, f64::INFINITY),
                Parameter::new(
                    "release_height",
                    Word::new("m", "rad"),
                    "height above the surface at which it ends",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
        Form {
            name: "attraction",
            equation: "once touched, F is less by pull_off_force until the tool is release_height above the surface",
            parameters: &[PULL, RELEASE_HEIGHT],
        },
        Form {
            name: "cohesive",
            equation: "as neck, the pull falling from pull_off_force in a straight line that would end after softening_length, until release_height",
            parameters: &[
                Parameter::new("pull_off_force", Word::new("N", "N m"), "greatest pull", 0.0, f64::INFINITY),
                RELEASE_HEIGHT,
                Parameter::new(
                    "softening_length",
                    Word::new("m", "rad"),
                    "way over which the pull would fall to nothing",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
        Form {
            name: "bridge",
            equation: "leaving, F falls no lower than -pull_off_force, and is -pull_off_force (1 - height / release_height) above the surface",
            parameters: &[
                Parameter::new("pull_off_force", Word::new("N", "N m"), "greatest pull", 0.0, f64::INFINITY),
                RELEASE_HEIGHT,
            ],
        },
        Form {
            name: "capillary",
            equation: "once touched, F is less by pull_off_force in contact, and -pull_off_force (1 - height / release_height) above the surface",
            parameters: &[PULL, RELEASE_HEIGHT],
        },
        Form {
            name: "sphere",
            equation: "with Hertz's law F = c x^1.5 beneath: once touched, x = h - b h^(1/4), F = c (h^1.5 - 1.5 b h^(3/4)), b = 4/3 sqrt(pull_off_force / c), until x is least",
            parameters: &[Parameter::new(
                "pull_off_force",
                Word::new("N", "N m"),
                "greatest pull under a given force; under a given motion it lets go at 5/9 of it",
                0.0,
                f64::INFINITY,
            )],
        },
        Form {
            name: "bond",
            equation: "once touched, F is -pull_off_force height / release_height above the surface until it breaks at release_height",
            parameters: &[PULL, RELEASE_HEIGHT],
        },
        Form {
            name: "bilinear",
            equation: "once touched, F above the surface is -pull_off_force height / peak_height up to peak_height, which is no more than pull_off_force / K, and from there on falls in a straight line to nothing at release_height",
            parameters: &[PULL, RELEASE_HEIGHT, PEAK_HEIGHT],
        },
        Form {
            name: "exponential",
            equation: "once touched, F above the surface is -pull_off_force x exp(1 - x), x = height / peak_height, until it lets go at release_height",
            parameters: &[PULL, RELEASE_HEIGHT.within(Limit::HeightOfJump), PEAK_HEIGHT],
        },
        Form {
            name: "softening",
            equation: "as bilinear, from peak_height on -pull_off_force ((release_height - height) / (release_height - peak_height))^softening_exponent",
            parameters: &[
                PULL,
                RELEASE_HEIGHT,
                PEAK_HEIGHT,
                Parameter::new(
                    "softening_exponent",
                    Word::new("1", "1"),
                    "one where the pull falls in a straight line, less where it falls late",
                    0.1,
                    10.0,
                ),
            ],
        },
    ],
    excited_by: "leaving the surface, slowly and often",
    resembles: &["force_bias", "lost_motion"],
    source: "a liquid bridge; D. S. Dugdale, J. Mech. Phys. Solids 8 (1960) 100; a pull that softens: A. Hillerborg et al., Cem. Concr. Res. 6 (1976) 773; one that rises first: P. H. Geubelle, J. S. Baylor, Compos. B 29 (1998) 589; one that falls by a power: K. Park, G. H. Paulino, J. R. Roesler, J. Mech. Phys. Solids 57 (2009) 891; one that falls off exponentially: J. H. Rose, J. R. Smith, J. Ferrante, Phys. Rev. B 28 (1983) 1835, X.-P. Xu, A. Needleman, J. Mech. Phys. Solids 42 (1994) 1397; K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301; B. V. Derjaguin et al., J. Colloid Interface Sci. 53 (1975) 314",
};

/// Indices of the forms.
pub mod form {
    pub const ATTRACTION: usize = 1;
    pub const COHESIVE: usize = 2;
    pub const BRIDGE: usize = 3;
    pub const CAPILLARY: usize = 4;
    pub const SPHERE: usize = 5;
    pub const BOND: usize = 6;
    pub const BILINEAR: usize = 7;
    pub const EXPONENTIAL: usize = 8;
    pub const SOFTENING: usize = 9;
}
