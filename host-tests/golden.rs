//! The double-precision reference, and in places the library itself, against vectors from other people's libraries.

use crate::reference::{self, Prior, RegressionRow, Theta};
use crate::tolerance::{Ledger, close};
use palpate::{
    BlockConfig, BlockLeastSquares, Direction, Ewrls, EwrlsConfig, FrontEnd, FrontEndConfig, FrontEndState, Impedance,
    Observation, Recent, Sample, UpdateLaw, direct,
};
use std::path::Path;

/// A golden file, by column.
struct Table {
    header: Vec<String>,
    records: Vec<Vec<f64>>,
}

impl Table {
    fn read(name: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("host-tests/golden").join(name);
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).expect("a golden file");
        let header = reader.headers().expect("a header").iter().map(str::to_owned).collect();
        // An empty cell is a value that the other library does not define.
        let number = |cell: &str| if cell.is_empty() { f64::NAN } else { cell.parse().expect("a number") };
        let records = reader.records().map(|r| r.expect("a record").iter().map(number).collect()).collect();
        Self { header, records }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let at = self.header.iter().position(|h| h == name).expect("the named column");
        self.records.iter().map(|r| r[at]).collect()
    }

    fn pair(&self, name: &str) -> Vec<Theta> {
        let (k, b) = (self.column(&format!("{name}_k")), self.column(&format!("{name}_b")));
        k.into_iter().zip(b).map(|(k, b)| Theta::new(k, b)).collect()
    }

    fn rows(&self) -> Vec<RegressionRow> {
        let (x, v, force) = (self.column("penetration"), self.column("rate"), self.column("force"));
        (0..x.len()).map(|i| RegressionRow { x: x[i], v: v[i], force: force[i] }).collect()
    }

    fn observations(&self) -> Vec<Observation> {
        let single =
            |r: RegressionRow| Observation { penetration: r.x as f32, rate: r.v as f32, force: r.force as f32 };
        self.rows().into_iter().map(single).collect()
    }
}

fn both_close(what: &str, got: Theta, want: Theta, rel: f64) {
    close(&format!("{what}, K"), got.x, want.x, rel, 0.0);
    close(&format!("{what}, B"), got.y, want.y, rel, 0.0);
}

#[test]
fn batch_least_squares_is_what_others_compute_recursively() {
    let table = Table::read("contact.csv");
    let (rows, prior) = (table.rows(), Prior { at: Theta::zeros(), covariance: 1e3 });
    let wanted = ["expanding", "rolling", "forgetting", "prior"].map(|name| table.pair(name));
    for k in 0..rows.len() {
        let seen = &rows[..=k];
        // A pair of columns with the angle of this dither is conditioned like 10, so 1e-12 is left of a double; the
        // Kalman filter of RecursiveLS starts from a difference of two near-equal rows and keeps 1e-9 after a turn.
        if k >= 100 {
            both_close("expanding", reference::least_squares(seen), wanted[0][k], 1e-9);
        }
        if k >= 49 {
            both_close("rolling", reference::least_squares(&seen[k - 49..]), wanted[1][k], 1e-10);
        }
        both_close("forgetting", reference::weighted(seen, 0.98, Some(prior)), wanted[2][k], 1e-9);
        both_close("prior", reference::weighted(seen, 1.0, Some(prior)), wanted[3][k], 1e-10);
    }
}

#[test]
fn the_library_forgets_like_padasip_and_rolls_like_statsmodels() {
    let table = Table::read("contact.csv");
    let observations = table.observations();
    let ewrls = EwrlsConfig { forgetting_factor: 0.98, initial_covariance: 1e3, ..EwrlsConfig::default() };
    let ewrls = Ewrls::new(ewrls).expect("sound settings");
    let bls = BlockLeastSquares::new(BlockConfig::of(50)).expect("sound settings");
    let (mut recursion, mut block) = (ewrls.initial_state(), bls.initial_state());
    let (forgetting, rolling) = (table.pair("forgetting"), table.pair("rolling"));
    let [mut ewrls_errors, mut bls_errors] = [Ledger::default(), Ledger::default()];
    for k in 0..observations.len() {
        ewrls.update(&mut recursion, Recent::of(&observations[k..=k]));
        bls.update(&mut block, Recent::of(&observations[..=k]));
        // padasip is given 0.98 in double; in single it is 7e-9 more, which moves the estimate by less than rounding.
        for (got, want) in
            [(recursion.estimate.stiffness, forgetting[k].x), (recursion.estimate.damping, forgetting[k].y)]
        {
            ewrls_errors.compare("ewrls", got.into(), want, want.abs(), 1e-5 * want.abs() + 1e-5);
        }
        if k >= 49 {
            for (got, want) in [(block.estimate.stiffness, rolling[k].x), (block.estimate.damping, rolling[k].y)] {
                bls_errors.compare("bls", got.into(), want, want.abs(), 1e-5 * want.abs());
            }
        }
    }
    ewrls_errors.conclude("ewrls in f32 against padasip", 800);
    bls_errors.conclude("bls in f32 against statsmodels", 700);
}

#[test]
fn the_low_pass_is_that_of_scipy() {
    let table = Table::read("front_end.csv");
    let (position, force) = (table.column("position"), table.column("force"));
    let wanted = [table.column("penetration_filtered"), table.column("rate"), table.column("force_filtered")];
    let config = FrontEndConfig::BENCH;
    let mut textbook = reference::FrontEnd::new(&config);
    let library = FrontEnd::new(config).expect("sound settings");
    let mut state = FrontEndState::default();
    let mut errors = Ledger::default();
    for k in 0..position.len() {
        let sample = Sample { position: position[k] as f32, force: force[k] as f32, elapsed: config.period };
        let row = textbook.update(&sample);
        let reading = library.update(&mut state, sample).expect("a good sample").observation;
        let got = [(row.x, reading.penetration), (row.v, reading.rate), (row.force, reading.force)];
        for ((double, single), (want, full)) in got.into_iter().zip(wanted.iter().zip([0.0135, 0.2, 4.0])) {
            // Coefficients and states of order one, poles at 0.91: some ten roundings of the full scale.
            close("textbook filter", double, want[k], 0.0, 1e-13 * full);
            errors.compare("library filter", single.into(), want[k], full, 3e-6 * full);
        }
    }
    errors.conclude("front end in f32 against scipy", 1200);
}

#[test]
fn one_step_of_mean_fourth_is_that_of_numpy_and_scipy() {
    let (search, contact) = (Table::read("line_search.csv"), Table::read("contact.csv"));
    let (rows, observations) = (contact.rows(), contact.observations());
    let law =
        direct::BlockLeastMeanFourth::new(BlockConfig::of(300), Direction::SteepestDescent).expect("sound settings");
    let mut errors = Ledger::default();
    for record in &search.records {
        let &[first, length, k0, b0, u_k, u_b, .., root, minimiser, whole_k, whole_b] = record.as_slice() else {
            panic!("fourteen columns")
        };
        let window = first as usize..(first + length) as usize;
        let (rows, from) = (&rows[window.clone()], Theta::new(k0, b0));
        let direction = reference::steepest_direction(rows, from, 4);
        both_close("direction", direction, Theta::new(u_k, u_b), 1e-9);
        let t = reference::line_minimum(rows, from, direction, 4);
        // The companion matrix of a cubic with one real root keeps 1e-11; scipy's minimiser the root of a double.
        close("root", t, root, 1e-9, 0.0);
        close("minimiser", t, minimiser, 1e-6, 0.0);
        // A simplex stops where J no longer changes: at the root of a double's resolution, 1e-8, on either unknown.
        both_close("whole minimum", reference::whole_minimum(rows), Theta::new(whole_k, whole_b), 1e-6);
        let here = Impedance { stiffness: k0 as f32, damping: b0 as f32 };
        let found = law.line_search(Recent::of(&observations[window]), here).expect("a step");
        errors.compare("length", found.length.into(), root, root, 1e-5 * root);
    }
    errors.conclude("blmf step in f32 against numpy roots", 20);
}

#[test]
fn the_cubic_is_that_of_numpy() {
    let table = Table::read("cubic.csv");
    let mut errors = Ledger::default();
    for record in &table.records {
        let &[p, q, root] = record.as_slice() else { panic!("three columns") };
        let got = palpate::math::cubic::depressed_root(p as f32, q as f32).expect("a root");
        // The companion matrix is known to a few roundings of its norm, its root no better.
        let companion = 4e-15 * (1.0 + 3.0 * p.abs() + q.abs());
        errors.compare("root", got.into(), root, root.abs(), 8.0 * f64::from(f32::EPSILON) * root.abs() + companion);
    }
    errors.conclude("cubic in f32 against numpy roots", 200);
}
