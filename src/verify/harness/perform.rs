//! Cases side by side, on as many devices as there are.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::Case;
use super::session::{Common, Findings, Session};
use crate::Result;
use crate::gpu::Gpu;

/// Runs cases, as many at a time as there are devices, and brings together what they found in the order of the cases. Small runs
/// leave a device idle between their dispatches; two at a time fill it. `done` is called after each case, with what it found.
///
/// # Errors
/// Beside what was found: the first driver error or wrong scene. No case starts after it.
pub fn perform(
    devices: &[Gpu],
    common: &Common<'_>,
    cases: &[&'static Case],
    done: &(dyn Fn(&Findings) + Sync),
) -> (Findings, Result<()>) {
    // the last cases run longest and start first
    let left = AtomicUsize::new(cases.len());
    let found = Mutex::new((0..cases.len()).map(|_| None).collect::<Vec<Option<_>>>());
    let work = |gpu: &Gpu| {
        while let Ok(index) = left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1)) {
            let index = index - 1;
            let result = Session::perform(gpu, common, cases[index]);
            if result.1.is_err() {
                left.store(0, Ordering::Relaxed);
            }
            done(&result.0);
            found.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(result);
        }
    };
    std::thread::scope(|scope| {
        for gpu in devices {
            scope.spawn(|| work(gpu));
        }
    });
    let mut findings = Findings::default();
    let mut outcome = Ok(());
    for (own, result) in found.into_inner().unwrap_or_else(PoisonError::into_inner).into_iter().flatten() {
        findings.add(own);
        outcome = outcome.and(result);
    }
    findings.overview();
    (findings, outcome)
}
