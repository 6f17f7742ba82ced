//! Processor time of the calling thread.

use std::time::{Duration, Instant};

/// Where Linux says how long the thread has run, in nanoseconds, as the first of three numbers.
const THREAD_TIME: &str = "/proc/thread-self/schedstat";

/// What a duration was measured with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ClockKind {
    /// Time in which the thread was running on a processor.
    ThreadCpu,
    /// Time on the wall, where the system does not tell the former.
    Wall,
}

/// What is measured with here.
#[must_use]
pub fn kind() -> ClockKind {
    if thread_time().is_some() { ClockKind::ThreadCpu } else { ClockKind::Wall }
}

/// How long one of several runs of `work` took on the average, and the last one's result. It is repeated until the runs took
/// `enough` together: systems may count a thread's time in steps of some milliseconds, so a fraction of a second is needed.
pub fn time<T>(enough: Duration, mut work: impl FnMut() -> T) -> (Duration, T) {
    let (wall, cpu) = (Instant::now(), thread_time());
    let mut runs = 0;
    loop {
        let result = work();
        runs += 1;
        let spent = cpu.and_then(|start| thread_time()?.checked_sub(start));
        let spent = spent.unwrap_or_else(|| wall.elapsed());
        if spent >= enough {
            return (spent / runs, result);
        }
    }
}

/// The least and the most of several measurements.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    least: Duration,
    most: Duration,
}

impl Default for Times {
    fn default() -> Self {
        Self { least: Duration::MAX, most: Duration::ZERO }
    }
}

impl Times {
    /// Takes one more.
    pub fn add(&mut self, time: Duration) {
        self.least = self.least.min(time);
        self.most = self.most.max(time);
    }

    /// The least; the longest duration that there is if there were none.
    #[must_use]
    pub const fn least(&self) -> Duration {
        self.least
    }

    /// The most over the least: how noisy the measurements were.
    #[must_use]
    pub fn spread(&self) -> f64 {
        self.most.as_secs_f64() / self.least.as_secs_f64()
    }
}

/// How long the calling thread has run, if the system tells.
#[must_use]
pub fn thread_time() -> Option<Duration> {
    let text = std::fs::read_to_string(THREAD_TIME).ok()?;
    Some(Duration::from_nanos(text.split_whitespace().next()?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_takes_time() {
        let work = || (0..1_000_000_u64).fold(0, |sum, k| std::hint::black_box(sum ^ k));
        let (spent, _) = time(Duration::from_millis(20), work);
        assert!(spent > Duration::from_micros(10) && spent < Duration::from_secs(1), "{spent:?} {:?}", kind());
    }
}
