//! How a long computation reports its progress and is stopped.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Shared between the thread that waits and the threads that work.
#[derive(Debug, Default)]
pub struct Control {
    stop: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
}

impl Control {
    /// A fresh control: nothing done, not stopped.
    pub fn new() -> Self {
        Self::default()
    }

    /// Ask the computation to stop; it returns [`crate::Error::Interrupted`].
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Has somebody asked to stop?
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// `Err(Interrupted)` once somebody asked to stop.
    pub fn check(&self) -> crate::Result<()> {
        if self.is_stopped() { Err(crate::Error::Interrupted) } else { Ok(()) }
    }

    /// Say how many units of work there are.
    pub fn set_total(&self, units: u64) {
        self.done.store(0, Ordering::Relaxed);
        self.total.store(units, Ordering::Relaxed);
    }

    /// Count finished units of work.
    pub fn advance(&self, units: u64) {
        self.done.fetch_add(units, Ordering::Relaxed);
    }

    /// Units done and units in all.
    pub fn progress(&self) -> (u64, u64) {
        (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }
}
