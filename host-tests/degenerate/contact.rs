//! A contact that is lost and found again, under each policy of what to forget.

use super::{K, excitation};
use crate::rig;
use palpate::{BankEstimates, ContactLoss, Flags, Method, Sample, StreamConfig};

/// The last estimates of a contact, those of the free space after it, and the first ones of the next.
fn lost_and_found(contact_loss: ContactLoss) -> (BankEstimates, Vec<BankEstimates>, BankEstimates) {
    let mut bench = rig::bench(StreamConfig { contact_loss, ..StreamConfig::BENCH });
    let good = |outcomes: Vec<Result<BankEstimates, _>>| -> Vec<BankEstimates> {
        outcomes.into_iter().map(|outcome| outcome.expect("a good sample")).collect()
    };
    let before = good(rig::run(&mut bench, &excitation(3000).collect::<Vec<_>>()));
    let away = [Sample { position: -0.01, force: 0.01, elapsed: 1e-3 }; 200];
    let mut away = good(rig::run(&mut bench, &away));
    // The detector takes five samples to believe it.
    let left = away.split_off(4);
    let again = good(rig::run(&mut bench, &excitation(1).collect::<Vec<_>>()));
    (before[2999], left, again[0])
}

#[test]
fn out_of_contact_everything_reads_zero() {
    for policy in [ContactLoss::Everything, ContactLoss::Memory, ContactLoss::Nothing] {
        for (k, estimates) in lost_and_found(policy).1.iter().enumerate() {
            for e in estimates {
                assert!(e.flags.contains(Flags::NO_CONTACT), "{policy:?}, sample {k}: {:?}", e.flags);
                let numbers =
                    [e.impedance.stiffness, e.impedance.damping, e.half_width.stiffness, e.half_width.damping];
                assert_eq!(numbers, [0.0; 4], "{policy:?}, sample {k}");
            }
        }
    }
}

#[test]
fn forgetting_everything_begins_anew() {
    let (_, _, again) = lost_and_found(ContactLoss::Everything);
    for (method, e) in Method::ALL.iter().zip(&again) {
        // One sample: whoever has it already, has it from this sample alone.
        assert!(e.flags.intersects(Flags::STIFFNESS_UNCERTAIN), "{}: {e:?}", method.name());
        assert!(e.impedance.stiffness.abs() < 0.5 * K as f32, "{}: {e:?}", method.name());
    }
}

#[test]
fn forgetting_the_memory_keeps_the_estimate() {
    let (before, _, again) = lost_and_found(ContactLoss::Memory);
    for (method, (old, e)) in Method::ALL.iter().zip(before.iter().zip(&again)) {
        // The first row after free space comes from filters that are still rising, so it moves a recursive law a little.
        let change = (e.impedance.stiffness - old.impedance.stiffness).abs();
        assert!(change < 0.05 * K as f32, "{}: {e:?} after {old:?}", method.name());
        assert!(e.flags.contains(Flags::FILLING), "{}: {:?}", method.name(), e.flags);
    }
}

#[test]
fn forgetting_nothing_goes_on() {
    let (before, _, again) = lost_and_found(ContactLoss::Nothing);
    for (method, (old, e)) in Method::ALL.iter().zip(before.iter().zip(&again)) {
        let change = (e.impedance.stiffness - old.impedance.stiffness).abs();
        assert!(change < 0.05 * K as f32, "{}: {e:?} after {old:?}", method.name());
        assert!(e.fill >= 0.99 * old.fill, "{}: {} after {}", method.name(), e.fill, old.fill);
    }
}
