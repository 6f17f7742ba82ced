//! How threads share the work of a deferred command.
//!
//! The work is a number of units, which threads take one at a time, and an end, which one thread does when all units are done. A
//! thread that finds nothing to take goes away: idle while units are being done, because the end is still to come; done while
//! another thread is at the end, because nothing will come after it. The thread that does the last unit does the end, so there is
//! progress whoever else goes away.

use std::sync::{Mutex, PoisonError};

/// Exclusive access to a value that threads share.
pub(crate) trait Lock<T> {
    /// Calls `with` while nobody else has access.
    fn with<R>(&self, with: impl FnOnce(&mut T) -> R) -> R;
}

impl<T> Lock<T> for Mutex<T> {
    fn with<R>(&self, with: impl FnOnce(&mut T) -> R) -> R {
        // No caller leaves the value half changed, so it is good even after a panic.
        with(&mut self.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// How far the work is.
#[derive(Debug)]
pub(crate) enum State<U> {
    /// Units are being done.
    Units {
        /// Those that nobody has taken, the next one last.
        waiting: Vec<usize>,
        /// How many have been taken and are not done.
        running: usize,
        /// Those that are done, each at its place.
        done: Vec<Option<U>>,
    },
    /// A thread is at the end.
    Ending,
    /// Everything is done. What it made is there until somebody takes it.
    Complete(Vec<U>),
}

/// What a thread has to do next.
enum Next<U> {
    Unit(usize),
    End(Vec<U>),
    Leave(Joined),
}

/// Why a thread returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Joined {
    /// The work is complete.
    Complete,
    /// There is nothing to do now, but there will be.
    Idle,
    /// There is nothing to do and will be nothing, but another thread is still at it.
    Done,
}

impl<U> State<U> {
    /// So many units, none of which is done.
    pub(crate) fn new(units: usize) -> Self {
        let waiting = (0..units).rev().collect();
        Self::Units { waiting, running: 0, done: std::iter::repeat_with(|| None).take(units).collect() }
    }

    /// How many threads can find something to do; 0 if all is done.
    pub(crate) fn concurrency(&self) -> usize {
        match self {
            Self::Units { waiting, running, .. } => (waiting.len() + running).max(1),
            Self::Ending => 1,
            Self::Complete(_) => 0,
        }
    }

    /// Takes what is to be done next.
    fn next(&mut self) -> Next<U> {
        match self {
            Self::Complete(_) => Next::Leave(Joined::Complete),
            Self::Ending => Next::Leave(Joined::Done),
            Self::Units { waiting, running, done } => match waiting.pop() {
                Some(unit) => {
                    *running += 1;
                    Next::Unit(unit)
                }
                None if *running > 0 => Next::Leave(Joined::Idle),
                None => {
                    let units = std::mem::take(done).into_iter().flatten().collect();
                    *self = Self::Ending;
                    Next::End(units)
                }
            },
        }
    }

    /// Brings back a unit: done, or not.
    fn put(&mut self, unit: usize, made: Option<U>) {
        if let Self::Units { waiting, running, done } = self {
            *running = running.saturating_sub(1);
            match (made, done.get_mut(unit)) {
                (Some(made), Some(place)) => *place = Some(made),
                _ => waiting.push(unit),
            }
        }
    }
}

/// Lends the calling thread to the work, until there is nothing to do for it.
///
/// # Errors
/// What a unit or the end returned. The work is then as if this thread had not taken that part of it.
pub(crate) fn join<U, E>(
    state: &impl Lock<State<U>>,
    unit: impl Fn(usize) -> Result<U, E>,
    end: impl Fn(&[U]) -> Result<(), E>,
) -> Result<Joined, E> {
    loop {
        match state.with(State::next) {
            Next::Leave(joined) => return Ok(joined),
            Next::Unit(index) => {
                let made = unit(index);
                let (made, error) = match made {
                    Ok(made) => (Some(made), None),
                    Err(error) => (None, Some(error)),
                };
                state.with(|state| state.put(index, made));
                if let Some(error) = error {
                    return Err(error);
                }
            }
            Next::End(units) => match end(&units) {
                Ok(()) => state.with(|state| *state = State::Complete(units)),
                Err(error) => {
                    let done = units.into_iter().map(Some).collect();
                    state.with(|state| *state = State::Units { waiting: Vec::new(), running: 0, done });
                    return Err(error);
                }
            },
        }
    }
}

#[cfg(test)]
mod tests;
