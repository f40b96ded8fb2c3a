//! Rays as they were traced, to time the bare hierarchy on the same ones.

use crate::World;
use crate::accel::Accel;
use crate::shapes::Ray;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// A ray, and what its search came to.
#[derive(Clone, Copy, Debug)]
pub struct RecordedRay {
    ray: Ray,
    t_max: f64,
    search: Search,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Search {
    Closest,
    /// All crossings; so many were visited, and whether the last one was enough.
    Crossings {
        visited: u32,
        is_stopped: bool,
    },
}

/// Takes rays down while it is asked to.
#[derive(Debug, Default)]
pub(crate) struct Recorder {
    is_on: AtomicBool,
    rays: Mutex<Vec<RecordedRay>>,
}

impl Recorder {
    #[inline(always)]
    pub fn is_on(&self) -> bool {
        self.is_on.load(Ordering::Relaxed)
    }

    #[cold]
    pub fn add(&self, ray: &Ray, t_max: f64, search: Search) {
        self.rays.lock().expect("no thread has failed").push(RecordedRay { ray: *ray, t_max, search });
    }
}

/// Recording that ends with it, whatever happens.
struct Recording<'r>(&'r Recorder);

impl<'r> Recording<'r> {
    fn begin(recorder: &'r Recorder) -> Self {
        recorder.is_on.store(true, Ordering::Relaxed);
        Self(recorder)
    }
}

impl Drop for Recording<'_> {
    fn drop(&mut self) {
        self.0.is_on.store(false, Ordering::Relaxed);
    }
}

impl World {
    /// All rays that are traced in this world while `work` is done, shadow rays included; for benchmarks.
    #[doc(hidden)]
    pub fn recorded_rays(&self, work: impl FnOnce()) -> Vec<RecordedRay> {
        let on = Recording::begin(self.accel.recorder());
        work();
        std::mem::take(&mut on.0.rays.lock().expect("no thread has failed"))
    }

    /// Search for the same surfaces again and do nothing with them; how many were found.
    #[doc(hidden)]
    pub fn trace_again(&self, rays: &[RecordedRay]) -> usize {
        rays.iter().map(|recorded| again(&self.accel, recorded)).sum()
    }
}

fn again(accel: &Accel, recorded: &RecordedRay) -> usize {
    match recorded.search {
        Search::Closest => usize::from(accel.closest(&recorded.ray, recorded.t_max).is_some()),
        Search::Crossings { visited, is_stopped } => {
            let mut found = 0;
            accel.each_crossing(&recorded.ray, recorded.t_max, |_| {
                found += 1;
                !(is_stopped && found == visited)
            });
            found as usize
        }
    }
}
