//! What a replay holds of a recording, counted by the allocator: a long one is gone through and not kept.

use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use palpate_lab::recording::Recording;
use palpate_lab::replay::{Options, Outputs, Place, Plan, Runner, replay};
use palpate_lab::rig::Rig;

/// Time, position and force in double precision are 24 bytes; while the sensors' noise is found, one more column is sorted.
const MOST_BYTES_A_ROW_READ: f64 = 34.0;
/// The columns, a byte for the contact, and a bit of room.
const MOST_BYTES_A_ROW_REPLAYED: f64 = 28.0;

static HELD: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

/// The system's allocator, which counts the bytes that are held and the most that ever were.
struct Counting;

// SAFETY: every call is handed on to the system's allocator as it came; the counts touch none of its memory.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let held = HELD.fetch_add(layout.size(), Relaxed) + layout.size();
        MOST.fetch_max(held, Relaxed);
        // SAFETY: as the caller guarantees.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as the caller guarantees.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// The most bytes that `work` holds at once, beyond what was held before it.
fn most_held(work: impl FnOnce()) -> usize {
    let before = HELD.load(Relaxed);
    MOST.store(before, Relaxed);
    work();
    MOST.load(Relaxed) - before
}

/// A recording of `rows` with columns that a replay does not need.
fn write_trial(path: &Path, rows: u32) {
    let mut text = String::from("t_s,position_m,force_N,effort_N,reference_m\n");
    for k in 0..rows {
        let t = f64::from(k) * 1e-3;
        let phase = 62.831_853 * t;
        let x = 0.004 + 0.006 * (0.37 * phase).sin() + 0.003 * phase.sin();
        let force = (300.0 * x).max(0.0) + 1e-2 * f64::from(k.wrapping_mul(2_654_435_761) >> 16) / 65_536.0;
        writeln!(text, "{t:.3},{x:.7},{force:.4},{force:.4},{x:.7}").expect("a string takes it");
    }
    fs::write(path, text).expect("a file");
}

/// The bytes that `work` on a recording holds for each row of it; what does not grow with the rows is not counted.
fn bytes_a_row(work: impl Fn(&Path)) -> f64 {
    let folder = tempfile::tempdir().expect("a folder");
    let held = |rows: u32| {
        let trial = folder.path().join(format!("{rows}.csv"));
        write_trial(&trial, rows);
        most_held(|| work(&trial))
    };
    let (few, many) = (100_000, 300_000);
    let bytes = held(many).saturating_sub(held(few)) as f64 / f64::from(many - few);
    assert!(bytes > 8.0, "{bytes:.1} bytes a row, where a column alone has 8: nothing was counted");
    bytes
}

/// One test: what others hold at the same time would be counted too.
#[test]
fn a_replay_holds_a_few_bytes_a_row_however_many_estimators_and_columns_there_are() {
    let rig_path = Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs").join("bench.toml");
    let rig = Rig::read(&rig_path).expect("a rig");
    let options = Options::default();
    let planned = |trial: &Path| {
        let recording = Recording::read_contact(trial, &rig).expect("a recording");
        let plan = Plan::new(&rig, &rig_path, &recording, &options).expect("a plan");
        (recording, plan)
    };
    let read = bytes_a_row(|trial| drop(planned(trial)));
    let replayed = bytes_a_row(|trial| {
        let mut outputs = Outputs::open(&trial.with_extension("out"), &rig_path, &[trial.to_owned()]).expect("a place");
        let (recording, plan) = planned(trial);
        let sink = outputs.sinks(rig.coordinate).pop();
        let replayed = replay(&Runner::Host, &plan, &recording, sink).expect("a replay");
        assert!(replayed.summaries.iter().all(|(_, summary)| summary.is_some()), "all found the wall");
        outputs.write(&rig, vec![replayed], &options, Place::Host).expect("the files");
    });
    println!("{read:.1} bytes a row to read and plan, {replayed:.1} to replay");
    assert!(read < MOST_BYTES_A_ROW_READ, "{read:.1} bytes a row to read and plan");
    assert!(replayed < MOST_BYTES_A_ROW_REPLAYED, "{replayed:.1} bytes a row to replay");
}
