//! Many means at once, pass after pass: pixels, rays or sensors, on all cores.
//!
//! Each item adds its own samples in order, so the result does not depend on threads.

use crate::stopping::{ErrorEstimate, Groups};
use crate::{DEFAULT_SAMPLES, RenderOptions};
use rayon::prelude::*;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use sunpeak_core::{Control, Error, Result, Rgb, Sampler};

/// Items that a thread takes at a time.
const CHUNK: usize = 64;

/// Chunks that a thread takes at once: so few that all threads end a pass at about the same time.
const CHUNKS_AT_ONCE: usize = 8;

/// Longest pass [samples per item].
const LONGEST_PASS: u32 = 16;

/// Units of progress where the goal is a time [1/s].
const UNITS_PER_SECOND: f64 = 100.0;

/// The means, and the number of samples behind each.
pub(crate) struct Means {
    pub values: Vec<Rgb>,
    /// In the mean over items, where some get more than others.
    pub samples: u32,
    /// 95 % bound of the relative error (see [`RenderOptions::error`]), once enough passes are done.
    pub error: Option<f64>,
    /// Standard error of the mean of each group, luminous, once enough passes are done.
    pub group_errors: Option<Vec<f64>>,
}

/// Which of an item's samples is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Draw {
    /// Nominal samples of the passes before.
    pub done: u32,
    /// Samples of this item in this pass.
    pub pass: u32,
    /// Of them this one.
    pub index: u32,
}

impl Draw {
    /// Numbers of an item by itself: all its samples are one sequence.
    pub fn alone(&self, seed: u64, item: u64) -> Sampler {
        Sampler::new(seed, item, u64::from(self.done + self.index))
    }

    /// Numbers of a member of a group of `size`, by its place among them: in each pass the samples of the whole group are one
    /// sequence, each member's a stretch of it, so that the group's mean profits too (Ahmed and Wonka 2020).
    pub fn together(&self, seed: u64, group: u64, place: u64) -> Sampler {
        let stream = group << 32 | u64::from(self.done);
        Sampler::new(seed, stream, place * u64::from(self.pass) + u64::from(self.index))
    }
}

/// Says after a pass whether the means are good enough.
pub(crate) type Judge<'a> = &'a dyn Fn(&Means) -> Result<bool>;

/// Estimate `items` values, each by itself; `sample(item, draw)` is one estimate of one of them.
pub(crate) fn estimate(
    items: usize,
    options: &RenderOptions,
    control: &Control,
    sample: impl Fn(usize, Draw) -> Rgb + Sync,
) -> Result<Means> {
    estimate_until(items, options, control, Groups::each(items), sample, None)
}

/// The same for items in groups whose error counts together, until a judge is content too.
pub(crate) fn estimate_until(
    items: usize,
    options: &RenderOptions,
    control: &Control,
    groups: Groups,
    sample: impl Fn(usize, Draw) -> Rgb + Sync,
    judge: Option<Judge>,
) -> Result<Means> {
    let goal = Goal::new(items, options, judge.is_some())?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.unwrap_or(0))
        .build()
        .map_err(|e| Error::value(format!("cannot start {:?} threads: {e}", options.threads)))?;
    goal.announce(control);
    let mut run = Run {
        goal: &goal,
        control,
        sums: vec![Rgb::ZERO; items],
        means: vec![Rgb::ZERO; items],
        done: 0,
        error: ErrorEstimate::new(groups),
    };
    // Telling the error costs a look at all passes: only where it decides.
    while let Some(pass) = goal.next_pass(run.done, goal.error.and_then(|_| run.relative_error())) {
        pool.install(|| run.pass(pass, &sample))?;
        if run.is_good_enough(judge)? {
            break;
        }
    }
    Ok(run.means())
}

/// What is known so far.
struct Run<'a> {
    goal: &'a Goal,
    control: &'a Control,
    /// Sums of the passes' means times their nominal samples.
    sums: Vec<Rgb>,
    /// The same of the pass in work.
    means: Vec<Rgb>,
    /// Nominal samples behind each sum.
    done: u32,
    error: ErrorEstimate,
}

impl Run<'_> {
    fn pass(&mut self, nominal: u32, sample: &(impl Fn(usize, Draw) -> Rgb + Sync)) -> Result<()> {
        let (done, control, goal) = (self.done, self.control, self.goal);
        let (allotment, groups) = (self.error.allotment(nominal), self.error.groups());
        let chunks = self.means.par_chunks_mut(CHUNK).enumerate().with_max_len(CHUNKS_AT_ONCE);
        chunks.for_each(|(chunk, means)| {
            if control.is_stopped() {
                return;
            }
            for (i, mean) in means.iter_mut().enumerate() {
                let item = chunk * CHUNK + i;
                let pass = allotment[groups.of(item)];
                let draw = |index| Draw { done, pass, index };
                let sum: Rgb = (0..pass).map(|index| sample(item, draw(index))).sum();
                *mean = sum * (f64::from(nominal) / f64::from(pass));
            }
            goal.report(control, means.len() as u64 * u64::from(nominal));
        });
        control.check()?;
        self.sums.iter_mut().zip(&self.means).for_each(|(sum, &mean)| *sum += mean);
        self.done += nominal;
        self.error.add(&self.means, nominal, &allotment);
        Ok(())
    }

    fn is_good_enough(&self, judge: Option<Judge>) -> Result<bool> {
        let by_error = self.goal.error.is_some_and(|goal| self.relative_error().is_some_and(|e| e <= goal));
        match judge {
            Some(judge) if !by_error => judge(&self.means()),
            _ => Ok(by_error),
        }
    }

    fn relative_error(&self) -> Option<f64> {
        if self.goal.error_of_each { self.error.relative_to_own() } else { self.error.relative() }
    }

    fn means(&self) -> Means {
        Means {
            values: self.sums.iter().map(|&sum| sum / f64::from(self.done)).collect(),
            samples: self.done,
            error: self.relative_error(),
            group_errors: self.error.standard_errors(),
        }
    }
}

/// When to stop.
struct Goal {
    items: u64,
    samples: u32,
    error: Option<f64>,
    error_of_each: bool,
    time: Option<Duration>,
    start: Instant,
    /// Units of progress reported so far, where the goal is a time.
    reported: Mutex<u64>,
}

impl Goal {
    fn new(items: usize, options: &RenderOptions, has_judge: bool) -> Result<Self> {
        if options.samples == Some(0) {
            return Err(Error::value("the number of samples is 0; it must be at least 1"));
        }
        if options.threads == Some(0) {
            return Err(Error::value("the number of threads is 0; leave it out for all cores"));
        }
        if let Some(error) = options.error.filter(|e| e.is_nan() || *e <= 0.0) {
            return Err(Error::value(format!("the error is {error}; it must be positive")));
        }
        let time = match options.time_s {
            None => None,
            Some(s) => {
                Some(Duration::try_from_secs_f64(s).map_err(|_| Error::value(format!("the time is {s} s")))?)
            }
        };
        let has_goal = time.is_some() || options.error.is_some() || has_judge;
        let unlimited = if has_goal { u32::MAX } else { DEFAULT_SAMPLES };
        let samples = options.samples.unwrap_or(unlimited);
        Ok(Self {
            items: items as u64,
            samples,
            error: options.error,
            error_of_each: options.error_of_each,
            time,
            start: Instant::now(),
            reported: Mutex::new(0),
        })
    }

    fn announce(&self, control: &Control) {
        control.set_total(match self.time {
            Some(time) => (time.as_secs_f64() * UNITS_PER_SECOND) as u64,
            None => self.items * u64::from(self.samples),
        });
    }

    fn report(&self, control: &Control, samples: u64) {
        let Some(time) = self.time else { return control.advance(samples) };
        let elapsed = (self.start.elapsed().min(time).as_secs_f64() * UNITS_PER_SECOND) as u64;
        if let Ok(mut reported) = self.reported.lock() {
            control.advance(elapsed.saturating_sub(*reported));
            *reported = elapsed.max(*reported);
        }
    }

    /// Samples of the next pass: a power of two of at most half of what there is, so that no pass rules the mean and its error can be
    /// told, and no more than the error says are missing.
    fn next_pass(&self, done: u32, error: Option<f64>) -> Option<u32> {
        let over = self.error.zip(error).map_or(f64::INFINITY, |(goal, error)| (error / goal).powi(2) - 1.0);
        let missing = (f64::from(done) * over).ceil().max(1.0);
        let most = (f64::from(done / 2).max(1.0)).min(missing).min(f64::from(LONGEST_PASS)) as u32;
        let wanted = (1 << most.ilog2()).min(self.samples - done);
        let Some(time) = self.time.filter(|_| done > 0) else { return (wanted > 0).then_some(wanted) };
        let elapsed = self.start.elapsed();
        let per_sample = elapsed / done;
        let fits = |pass: u32| elapsed + per_sample * pass <= time;
        let mut pass = wanted;
        while pass > 1 && !fits(pass) {
            pass /= 2;
        }
        (pass > 0 && fits(pass)).then_some(pass)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_and_means_are_right_on_any_number_of_threads() {
        let one = |threads| {
            let options = RenderOptions { samples: Some(37), threads: Some(threads), ..Default::default() };
            let control = Control::new();
            let means = estimate(1000, &options, &control, |i, draw| {
                Rgb::splat(i as f64 + f64::from(draw.done + draw.index).sqrt())
            })
            .expect("runs");
            assert_eq!((means.samples, control.progress()), (37, (37_000, 37_000)));
            means.values
        };
        let values = one(1);
        assert_eq!(values, one(3));
        let mean: f64 = (0..37).map(|s| f64::from(s).sqrt()).sum::<f64>() / 37.0;
        assert!((values[10].x - 10.0 - mean).abs() < 1e-12);
    }

    #[test]
    fn time_is_kept_and_a_stop_is_heard() {
        let options = RenderOptions { time_s: Some(0.2), threads: Some(1), ..Default::default() };
        let start = Instant::now();
        let slow = |_, _: Draw| {
            std::thread::sleep(Duration::from_millis(1));
            Rgb::ONE
        };
        let means = estimate(5, &options, &Control::new(), slow).expect("runs");
        assert!(means.samples >= 8 && start.elapsed().as_secs_f64() < 0.4);
        let control = Control::new();
        control.stop();
        assert!(matches!(estimate(5, &RenderOptions::default(), &control, slow), Err(Error::Interrupted)));
    }

    #[test]
    fn senseless_options_are_refused() {
        for options in [
            RenderOptions { samples: Some(0), ..Default::default() },
            RenderOptions { threads: Some(0), ..Default::default() },
            RenderOptions { time_s: Some(f64::NAN), ..Default::default() },
        ] {
            assert!(estimate(1, &options, &Control::new(), |_, _| Rgb::ONE).is_err());
        }
    }
}
