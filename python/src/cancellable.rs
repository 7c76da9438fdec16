//! Long work on a thread of its own, so that Ctrl-C reaches Python meanwhile.

use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::python_error;

/// How long a Ctrl-C may wait.
const POLL: Duration = Duration::from_millis(50);

/// Unwinds a worker that nobody waits for any more.
struct Cancelled;

/// Runs `work`, which receives a function to report progress with. On a signal, or an error of `progress`, that error is returned and the
/// work ends when it next says something.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&dyn Fn(&str)) -> anyhow::Result<T> + Send + 'static,
) -> PyResult<T> {
    let is_cancelled = Arc::new(AtomicBool::new(false));
    let (steps, mut received) = mpsc::channel::<String>();
    let worker_cancelled = Arc::clone(&is_cancelled);
    let worker = std::thread::spawn(move || {
        let say = |step: &str| {
            if worker_cancelled.load(Ordering::Relaxed) {
                // No message of a panic: this is no fault.
                panic::resume_unwind(Box::new(Cancelled));
            }
            // The receiver is gone only where nobody waits.
            let _ = steps.send(step.to_owned());
        };
        panic::catch_unwind(AssertUnwindSafe(|| work(&say)))
    });
    loop {
        let step;
        // A receiver is for one thread at a time: it is handed over and back.
        (received, step) = py.detach(move || {
            let step = received.recv_timeout(POLL);
            (received, step)
        });
        let reported = match (&step, &progress) {
            (Ok(step), Some(progress)) => progress.call1(py, (step.as_str(),)).map(|_| ()),
            _ => Ok(()),
        };
        if let Err(error) = reported.and_then(|()| py.check_signals()) {
            is_cancelled.store(true, Ordering::Relaxed);
            return Err(error);
        }
        if matches!(step, Err(RecvTimeoutError::Disconnected)) {
            break;
        }
    }
    let outcome = py.detach(|| worker.join());
    match outcome {
        Ok(Ok(done)) => done.map_err(python_error),
        Ok(Err(_)) | Err(_) => Err(PyRuntimeError::new_err("an internal error of palpate: please report it")),
    }
}
