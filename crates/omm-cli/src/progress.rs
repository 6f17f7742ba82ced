//! A progress bar for work that takes longer than a second, on a terminal only.

use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Work of less than this shows nothing.
const PATIENCE: Duration = Duration::from_secs(1);

/// How far a piece of work has come. It shows itself once the work has lasted a second, unless the standard error is no terminal,
/// and goes when it is dropped.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    since: Instant,
}

impl Progress {
    /// `total` steps of what `label` says are ahead.
    pub(crate) fn new(label: &str, total: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {percent}% {eta}") {
            bar.set_style(style);
        }
        bar.set_message(label.to_owned());
        Self { bar, since: Instant::now() }
    }

    /// `steps` more are done.
    pub(crate) fn advance(&self, steps: u64) {
        self.bar.inc(steps);
        self.show();
    }

    /// `done` steps of `total` are done.
    pub(crate) fn set(&self, done: u64, total: u64) {
        self.bar.set_length(total);
        self.bar.set_position(done);
        self.show();
    }

    /// `steps` more are done, and `label` says now what is ahead.
    pub(crate) fn advance_with(&self, steps: u64, label: String) {
        self.bar.set_message(label);
        self.advance(steps);
    }

    fn show(&self) {
        if self.bar.is_hidden() && self.since.elapsed() >= PATIENCE && io::stderr().is_terminal() {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
