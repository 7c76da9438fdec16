//! The paper's own figures, as far as they are at hand: what is not here is shown as a dash, never guessed.
//!
//! The tables are distinguished by what they hold; their numbers in the paper are I: RMSE% by contact, II: RMSE% by window, III: standard
//! deviation of K by window, IV: updates per second.

/// Methods in the order of every table.
pub const METHODS: [&str; 4] = ["EWRLS", "SPRLS", "BLS", "BLMF"];

/// Table I: RMSE% of `METHODS` on the soft, the time-varying and the medium contact, windows of 300.
pub const RMSE_BY_CONTACT: [[f64; 3]; 4] =
    [[12.96, 15.33, 6.29], [16.02, 18.04, 4.24], [9.27, 5.97, 2.79], [8.99, 8.315, 1.72]];

/// Windows of tables II and III.
pub const WINDOWS: [u16; 4] = [50, 100, 200, 300];

/// Table II: RMSE% on the soft contact at the shortest and the longest window, of those of [`METHODS`] that have one.
pub const RMSE_BY_WINDOW: [Option<[f64; 2]>; 4] =
    [Some([11.49, 13.14]), None, Some([10.10, 9.27]), Some([10.32, 9.35])];

/// Table III: standard deviation of K in N/m on the soft contact, in the same way.
pub const STD_BY_WINDOW: [Option<[f64; 2]>; 4] = [Some([11.2, 6.00]), None, Some([28.38, 8.92]), Some([25.01, 8.91])];

/// Table IV: updates per second of MATLAB on a PC of 3.2 GHz, by method and window; where the paper's figure for BLS is 4.2 and
/// 2.5 kHz, the faster one is taken for the shorter window.
pub const RATES: [(&str, Option<u16>, f64); 5] = [
    ("EWRLS", None, 5e3),
    ("BLS", Some(10), 4.2e3),
    ("BLS", Some(300), 2.5e3),
    ("BLMF", Some(10), 2.4e3),
    ("BLMF", Some(300), 200.0),
];

/// The clock of that PC, Hz.
pub const PC_HZ: f64 = 3.2e9;
