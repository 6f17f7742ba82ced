//! `shuttle` runs the threads one at a time, switches at each lock, and goes through the orders in which that can be done.

use std::sync::atomic::{AtomicUsize, Ordering};

use shuttle::sync::{Arc, Mutex};
use shuttle::thread;

use super::*;

impl<T> Lock<T> for Mutex<T> {
    fn with<R>(&self, with: impl FnOnce(&mut T) -> R) -> R {
        with(&mut self.lock().unwrap())
    }
}

/// How often each part of some work was done.
struct Counts {
    units: Vec<AtomicUsize>,
    end: AtomicUsize,
}

/// Lets `threads` threads join. The unit `fails`, or the end, fails the first time, and threads then join until all is done.
fn scenario(threads: usize, units: usize, fails: Option<usize>) {
    let state = Arc::new(Mutex::new(State::new(units)));
    let counts = Counts { units: (0..units).map(|_| AtomicUsize::new(0)).collect(), end: AtomicUsize::new(0) };
    let counts = Arc::new(counts);
    let work = {
        let (state, counts) = (Arc::clone(&state), Arc::clone(&counts));
        move || loop {
            let unit = |index: usize| {
                let before = counts.units[index].fetch_add(1, Ordering::SeqCst);
                if before == 0 && fails == Some(index) { Err("unit") } else { Ok(index * 10) }
            };
            let end = |made: &[usize]| {
                assert_eq!(made, (0..units).map(|index| index * 10).collect::<Vec<_>>());
                let before = counts.end.fetch_add(1, Ordering::SeqCst);
                if before == 0 && fails == Some(units) { Err("end") } else { Ok(()) }
            };
            match join(&*state, unit, end) {
                Ok(Joined::Complete) => {
                    assert!(state.with(|state| matches!(state, State::Complete(made) if made.len() == units)));
                    assert_eq!(state.with(|state| state.concurrency()), 0);
                    return true;
                }
                Ok(Joined::Idle | Joined::Done) if fails.is_none() => return false,
                // Another thread may fail, and what it took is then left to this one.
                Ok(Joined::Idle | Joined::Done) => thread::yield_now(),
                Err(error) => assert_eq!(error, if fails == Some(units) { "end" } else { "unit" }),
            }
        }
    };
    let others: Vec<_> = (1..threads).map(|_| thread::spawn(work.clone())).collect();
    let mut complete = usize::from(work());
    complete += others.into_iter().map(|other| usize::from(other.join().unwrap())).sum::<usize>();
    assert!(complete >= 1, "nobody saw the end");
    for (index, count) in counts.units.iter().enumerate() {
        assert_eq!(count.load(Ordering::SeqCst), 1 + usize::from(fails == Some(index)));
    }
    assert_eq!(counts.end.load(Ordering::SeqCst), 1 + usize::from(fails == Some(units)));
}

#[test]
fn two_threads_share_the_work_in_every_order() {
    // All of them for one unit, which are some 42 thousand.
    shuttle::check_dfs(|| scenario(2, 1, None), None);
    shuttle::check_dfs(|| scenario(2, 2, None), Some(50_000));
}

#[test]
fn many_threads_share_the_work_in_many_orders() {
    shuttle::check_random(|| scenario(4, 6, None), 2_000);
    shuttle::check_pct(|| scenario(3, 2, None), 2_000, 3);
}

#[test]
fn what_failed_is_done_again() {
    shuttle::check_random(|| scenario(3, 3, Some(1)), 2_000);
    shuttle::check_random(|| scenario(3, 2, Some(2)), 2_000);
    shuttle::check_random(|| scenario(2, 0, Some(0)), 1_000);
}
