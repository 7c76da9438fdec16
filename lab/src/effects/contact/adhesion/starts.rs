//! Values from which adhesion is fitted.

use super::spec::form;
use crate::effects::{ExcitationStats, Start};

/// Height of the greatest pull of a neck of its own stiffness, over that of its end, where nothing is known of it.
const USUAL_PEAK: f64 = 0.2;

/// How a pull falls to its end: late, or at once and then slowly.
const SOFTENING_EXPONENTS: [f64; 2] = [0.6, 1.8];

/// Heights at which a surface may let go of a pull that falls off exponentially, over that of its peak: a fifth of the pull is left there, and a hundredth.
const EXPONENTIAL_ENDS: [f64; 2] = [4.0, 8.0];

/// Height at which half of a pull that falls off exponentially is left, over that of its peak: the greater root of x exp(1 - x) = 1/2.
const HALF_OF_EXPONENTIAL: f64 = 2.678;

/// The height at which a pull ends by `form`, or that of its peak where it falls off exponentially. Half of the pull was measured last at a height above the surface; it is
/// greatest at `stretched`. `None` where it was not measured above that.
fn seen_end(form: usize, scene: &ExcitationStats, stretched: f64) -> Option<f64> {
    let half = scene.half_pull_height;
    let end = match form {
        form::COHESIVE => 2.0 * half - stretched,
        form::BILINEAR => 2.0 * half / (1.0 + USUAL_PEAK),
        form::EXPONENTIAL => half / HALF_OF_EXPONENTIAL,
        form::BRIDGE | form::CAPILLARY => 2.0 * half,
        _ => half,
    };
    (half > stretched).then_some(end)
}

/// Values of `form` from which it is fitted to what `scene` tells.
pub fn starts(form: usize, scene: &ExcitationStats) -> Vec<Start> {
    if scene.releases == 0 {
        return Vec::new();
    }
    let force = 0.05 * scene.force;
    let height = force / scene.stiffness.max(f64::MIN_POSITIVE);
    let away = (scene.travel.1 - scene.travel.0 - scene.depth).max(0.3 * scene.depth);
    if form == form::SPHERE {
        let measured = Some(scene.pull).filter(|pull| *pull > 0.0);
        return [0.2 * force, force, 4.0 * force].into_iter().chain(measured).map(|pull| Start::at(&[pull])).collect();
    }
    let near = [0.3, 1.0, 3.0, 10.0].iter().map(|factor| (factor * height).min(away));
    let heights = near.chain([0.05, 0.2, 0.5].iter().map(|part| part * away));
    // A small pull grows in proportion until the spring cannot pull as much: one that was measured is tried at its own size.
    let stretched = (scene.pull / scene.stiffness.max(f64::MIN_POSITIVE)).min(away);
    let measured = [0.5, 1.0, 2.0].iter().map(|times| times * stretched).filter(|height| *height > 0.0);
    // Where the pull was seen to end: beyond the end by softening a release says nothing, and before it hides the rest.
    let seen = seen_end(form, scene, stretched).into_iter();
    if form == form::COHESIVE {
        let small = heights.map(|height| Start::sized(&[force, height, 1.5 * height], &[0]));
        let measured = measured.map(|height| Start::at(&[scene.pull, height, 1.5 * height]));
        return small.chain(measured).chain(seen.map(|end| Start::at(&[scene.pull, end, end - stretched]))).collect();
    }
    if form == form::SOFTENING {
        let straight = starts(form::BILINEAR, scene).into_iter();
        let bent = straight.flat_map(|Start { values, linear_parameters }| {
            SOFTENING_EXPONENTS.map(|exponent| Start {
                values: [&values[..], &[exponent]].concat(),
                linear_parameters: linear_parameters.clone(),
            })
        });
        return bent.collect();
    }
    if form == form::BILINEAR && scene.pull > 0.0 {
        let own = measured.chain(seen).map(|height| Start::at(&[scene.pull, height, USUAL_PEAK * height]));
        return own.filter(|start| start.values[2] * scene.stiffness < scene.pull).collect();
    }
    if form == form::BILINEAR {
        return heights.map(|height| Start::sized(&[force, height, USUAL_PEAK * height], &[0])).collect();
    }
    if form == form::EXPONENTIAL {
        let (peaks, pull): (Vec<f64>, f64) =
            if scene.pull > 0.0 { (measured.chain(seen).collect(), scene.pull) } else { (heights.collect(), force) };
        let ends = peaks.into_iter().flat_map(|peak| EXPONENTIAL_ENDS.map(|end| [pull, end * peak, peak]));
        return ends
            .map(|values| if scene.pull > 0.0 { Start::at(&values) } else { Start::sized(&values, &[0]) })
            .collect();
    }
    let small = heights.map(|height| Start::sized(&[force, height], &[0]));
    small.chain(measured.chain(seen).map(|height| Start::at(&[scene.pull, height]))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tip of 4 N/m that pulls by 80 nN on its way out and pushes by 250 nN: small pulls, which grow in proportion, end where the spring pulls as
    /// much, 12 nN at 3 nm.
    #[test]
    fn a_pull_that_was_measured_is_tried_at_its_own_size() {
        let scene = ExcitationStats {
            depth: 6e-8,
            force: 2.5e-7,
            pull: 8e-8,
            travel: (-5e-8, 7e-8),
            stiffness: 4.0,
            releases: 3,
            ..ExcitationStats::default()
        };
        for form in [
            0,
            form::ATTRACTION,
            form::COHESIVE,
            form::BRIDGE,
            form::CAPILLARY,
            form::SPHERE,
            form::BOND,
            form::BILINEAR,
            form::EXPONENTIAL,
            form::SOFTENING,
        ] {
            let whole = |start: &Start| start.linear_parameters.is_empty() && start.values[0] == scene.pull;
            let found: Vec<Start> = starts(form, &scene).into_iter().filter(whole).collect();
            assert!(!found.is_empty(), "form {form}");
            let height = if form == form::EXPONENTIAL { 2 } else { 1 };
            let is_near = |start: &Start| (start.values[height] / 2e-8).ln().abs() < 0.1;
            assert!(form == form::SPHERE || found.iter().any(is_near), "form {form}: {found:?}");
        }
        let none = ExcitationStats { pull: 0.0, ..scene };
        assert!(starts(0, &none).iter().all(|start| !start.linear_parameters.is_empty()));
    }

    /// A tape that pulls by 1.6 N at 0.4 mm and softens to nothing at 1.5 mm: half of it is seen at 0.95 mm, and a bridge that ends at 1.5 mm has half at 0.75 mm.
    #[test]
    fn a_pull_is_tried_to_the_height_where_it_was_seen_to_end() {
        let scene = |half_pull_height: f64| ExcitationStats {
            depth: 1.2e-3,
            force: 4.8,
            pull: 1.6,
            half_pull_height,
            travel: (-3e-3, 1.2e-3),
            stiffness: 4000.0,
            releases: 3,
            ..ExcitationStats::default()
        };
        let is_tried = |form: usize, half: f64, values: &[f64]| {
            let is_it = |start: &Start| start.values.iter().zip(values).all(|(a, b)| (a / b - 1.0).abs() < 1e-9);
            starts(form, &scene(half)).iter().any(is_it)
        };
        assert!(is_tried(form::COHESIVE, 0.95e-3, &[1.6, 1.5e-3, 1.1e-3]));
        assert!(is_tried(form::BRIDGE, 0.75e-3, &[1.6, 1.5e-3]) && is_tried(form::BOND, 0.75e-3, &[1.6, 0.75e-3]));
        assert!(is_tried(form::EXPONENTIAL, 2.678e-3, &[1.6, 4e-3, 1e-3]));
        assert!(starts(form::COHESIVE, &scene(0.0)).iter().all(|start| start.values[2] > start.values[1]));
    }
}
