//! `palpate challenge`: a blind test of the diagnosis on recordings whose missing effect is concealed from it.
//!
//! Cases are drawn from a seed and written as plain recordings, each in a folder of its own. A SHA-256 over the true answers is
//! published before the first diagnosis; each case is diagnosed by the command that a user runs; then the answers are checked
//! against the commitment and scored. The case generator shares no code of an effect with the diagnosis, and half of the
//! list is simulated by MuJoCo, Drake and Exudyn. Real recordings pass through the same protocol: what their makers report of
//! them is the concealed answer.

pub mod baselines;
pub mod bic;
pub mod binomial;
pub mod case_counts;
pub mod case_files;
pub mod case_list;
pub mod case_result;
pub mod case_score;
pub mod case_source;
pub mod challenge_score;
mod command;
pub mod commitment;
pub mod diagnosed_answer;
pub mod diagnosis_json;
pub mod drawn_answer;
pub mod external_cases;
pub mod external_score;
pub mod generate;
pub mod page;
pub mod parameter_score;
mod protocol;
pub mod recordings;
pub mod run_diagnosis;
pub mod score_run;
pub mod scored_case;
pub mod single_effect_counts;
pub mod statistics;
pub mod summary;
pub mod targets;
pub mod work_folder;

pub use command::{ChallengeArgs, run};
