//! Sizes of the preconditioner of the interface pressures.

/// Terms of the polynomial.
pub(crate) const TERMS: u32 = 12;

/// Share of the slots whose vertices may have a row, and rows that there are at least.
const SHARE: usize = 64;
const LEAST: usize = 768;

/// Threads of the workgroup that has all rows, and rows that it has at most.
pub(super) const THREADS: u32 = 256;
const FEW: usize = 2048;

/// Whether one workgroup has all rows.
pub(crate) const fn are_few(rows: usize) -> bool {
    rows <= FEW
}

/// Steps that the kernels of the polynomial are told of: its terms, or before the iterations and in one.
pub(crate) const fn turns(rows: usize) -> u32 {
    if are_few(rows) { 2 } else { TERMS }
}

/// Numbers of a row before its couplings.
pub(super) const COUPLINGS: usize = 6;

/// Rows for so many vertices with pressures apart; those beyond have the diagonal alone.
pub(crate) fn rows(slots: usize, extra_capacity: usize) -> usize {
    extra_capacity.min((slots / SHARE).max(LEAST))
}

/// Numbers of a row: head, and couplings with half of the neighbours.
pub(crate) fn row_length(dimension: usize) -> usize {
    COUPLINGS + 3_usize.pow(dimension as u32) / 2
}
