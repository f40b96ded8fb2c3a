//! Long computations: the interpreter's lock is released, Ctrl-C stops them, and they report their progress.

use crate::error::OrRaise;
use pyo3::prelude::*;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};
use sunpeak_core::{Control, Result};

/// How often the waiting thread looks for Ctrl-C.
const POLL: Duration = Duration::from_millis(50);
/// How often the progress callback is called.
const REPORT: Duration = Duration::from_millis(200);

/// Run `work` on another thread while this one, with the lock released, looks for Ctrl-C and calls
/// `progress(done, total)`. An exception in the callback or a signal handler stops the work and is raised.
pub fn run_watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Control) -> Result<T> + Send,
) -> PyResult<T> {
    let control = Control::new();
    let (outcome, raised) = py.detach(|| work_and_wait(&control, progress, work));
    match raised {
        Some(exception) => Err(exception),
        None => outcome.or_raise(),
    }
}

fn work_and_wait<T: Send>(
    control: &Control,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Control) -> Result<T> + Send,
) -> (Result<T>, Option<PyErr>) {
    let mut raised = None;
    let mut reported = Instant::now();
    let outcome = thread::scope(|scope| {
        let (finished, waiting) = channel();
        let worker = scope.spawn(move || {
            let outcome = work(control);
            // Nobody waits any more only if the waiting thread panicked.
            let _ = finished.send(());
            outcome
        });
        while waiting.recv_timeout(POLL) == Err(RecvTimeoutError::Timeout) {
            let due = reported.elapsed() >= REPORT;
            if due {
                reported = Instant::now();
            }
            if raised.is_none()
                && let Err(exception) = attend(control, if due { progress } else { None })
            {
                control.stop();
                raised = Some(exception);
            }
        }
        worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    });
    if raised.is_none() && outcome.is_ok() {
        raised = attend(control, progress).err();
    }
    (outcome, raised)
}

/// Let Python see its signals, and tell it how far the work is.
fn attend(control: &Control, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    Python::attach(|py| {
        py.check_signals()?;
        if let Some(callback) = progress {
            callback.call1(py, control.progress())?;
        }
        Ok(())
    })
}
