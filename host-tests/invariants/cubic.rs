//! The line search of mean fourth has exactly one root, and the cubic keeps single precision.

use super::runner;
use crate::reference::{self, RegressionRow, Theta};
use crate::tolerance::close;
use palpate::math::cubic::depressed_root;
use palpate::{BlockConfig, Direction, Impedance, Observation, Recent, direct};
use proptest::collection::vec;

const EPS: f64 = f32::EPSILON as f64;

/// Coefficients of the derivative of `sum (e - t p)^4 / 4`, in double precision.
fn coefficients(rows: &[RegressionRow], from: Theta, u: Theta) -> [f64; 4] {
    rows.iter().fold([0.0; 4], |[a, b, c, d], row| {
        let (p, e) = (row.regressor().dot(&u), row.residual(from));
        [a + p.powi(4), b - 3.0 * p.powi(3) * e, c + 3.0 * p * p * e * e, d - p * e.powi(3)]
    })
}

#[test]
fn the_line_search_goes_down_and_has_exactly_one_real_root() {
    let row = (-0.02_f32..0.02, -0.2_f32..0.2, -5.0_f32..5.0);
    let input = (vec(row, 2..80), -900.0_f32..900.0, -20.0_f32..20.0);
    let law =
        direct::BlockLeastMeanFourth::new(BlockConfig::of(300), Direction::SteepestDescent).expect("sound settings");
    runner(500)
        .run(&input, |(rows, stiffness, damping)| {
            let single = |&(penetration, rate, force): &(f32, f32, f32)| Observation { penetration, rate, force };
            let observations: Vec<_> = rows.iter().map(single).collect();
            let from = Impedance { stiffness, damping };
            let Some(found) = law.line_search(Recent::of(&observations), from) else {
                panic!("no step from {from:?}");
            };
            let (rows, from) = (reference::rows(&observations), reference::theta(from));
            let u = reference::theta(found.direction);
            close("length of u", u.norm(), 1.0, 4.0 * EPS, 0.0);

            let largest = |size: &dyn Fn(&RegressionRow) -> f64| rows.iter().map(|r| size(r).abs()).fold(0.0, f64::max);
            let residual = largest(&|r| r.residual(from));
            let reach = u.x.abs() * largest(&|r| r.x) + u.y.abs() * largest(&|r| r.v);
            let gradient: Theta = rows.iter().map(|r| r.regressor() * r.residual(from).powi(3)).sum();
            let [a, b, c, d] = coefficients(&rows, from, u);
            // u is minus the gradient over its length, so D is minus that length: it is known to the rounding of the
            // terms that cancel in it, each at most reach times the cube of the largest residual.
            let terms = rows.len() as f64 * reach * residual.powi(3);
            close("D in double", d, -gradient.norm(), 1e-6, 8.0 * EPS * terms);
            close("D", f64::from(found.d) * reach * residual.powi(3), d, 1e-5, 8.0 * EPS * terms);
            close("A", f64::from(found.a) * reach.powi(4), a, 1e-4, 0.0);
            let terms = rows.len() as f64 * reach.powi(3) * residual;
            close("B", f64::from(found.b) * reach.powi(3) * residual, b, 1e-5, 24.0 * EPS * terms);
            close("C", f64::from(found.c) * (reach * residual).powi(2), c, 1e-4, 0.0);

            // J'' = 3 A t^2 + 2 B t + C has no real zero, so J' has one.
            assert!(b * b <= 3.0 * a * c * (1.0 + 1e-12), "J'' has two zeros: {a} {b} {c}");
            let roots = 18.0 * a * b * c * d - 4.0 * b.powi(3) * d + (b * c).powi(2)
                - 4.0 * a * c.powi(3)
                - 27.0 * (a * d).powi(2);
            assert!(roots <= 0.0, "a discriminant of {roots}: three real roots");
            let cost = |t: f64| rows.iter().map(|r| r.residual(from + u * t).powi(4)).sum::<f64>();
            let length = f64::from(found.length);
            assert!(length > 0.0, "the way down is forward, not {length}");
            assert!(cost(length) <= cost(0.0) * (1.0 + 1e-12), "{} from {}", cost(length), cost(0.0));
            assert!(cost(length) <= cost(1.01 * length) && cost(length) <= cost(0.99 * length), "not the minimum");
            Ok(())
        })
        .unwrap();
}

/// By bisection in double precision: the cubic rises everywhere.
fn bisected(p: f64, q: f64) -> f64 {
    let (mut low, mut high) = if q > 0.0 { (-q.cbrt(), 0.0) } else { (0.0, -q.cbrt()) };
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle * (middle * middle + 3.0 * p) + q > 0.0 { high = middle } else { low = middle }
    }
    // Bisection halves the distance to the other end, not to zero, so a root far below the bracket wants one polish.
    let t = 0.5 * (low + high);
    t - (t * (t * t + 3.0 * p) + q) / (3.0 * (t * t + p))
}

/// Cardano as it is printed, in single precision.
fn naive(p: f32, q: f32) -> f32 {
    let root = (0.25 * q * q + p * p * p).sqrt();
    (-0.5 * q + root).cbrt() + (-0.5 * q - root).cbrt()
}

#[test]
fn the_cubic_keeps_a_few_last_digits_where_the_printed_formula_loses_all() {
    let (mut ours, mut printed) = (Vec::new(), Vec::new());
    let mut noise = crate::simulator::Noise::new(11);
    for _ in 0..200_000 {
        let p = 10_f64.powf(24.0 * noise.uniform() - 12.0) as f32;
        let q = 10_f64.powf(36.0 * noise.uniform() - 18.0) as f32 * if noise.uniform() < 0.5 { -1.0 } else { 1.0 };
        let want = bisected(p.into(), q.into());
        let error = |got: f32| ((f64::from(got) - want) / want).abs() / EPS;
        ours.push(error(depressed_root(p, q).expect("a root")));
        printed.push(error(naive(p, q)));
    }
    let [ours, printed] = [ours, printed].map(|mut errors| {
        errors.sort_by(f64::total_cmp);
        (errors[errors.len() / 2], errors[errors.len() * 99 / 100], errors[errors.len() - 1])
    });
    println!("cubic, errors in units of 2^-23 (median, 99 %, worst): ours {ours:.3?}, as printed {printed:.3?}");
    // Ten operations of half a unit each, two roots of one; and less than half a unit would be no measurement.
    assert!((0.4..=8.0).contains(&ours.2), "{ours:?}");
    assert!(printed.1 > 1e3 * ours.2, "the printed formula was no worse: {printed:?}");
}
