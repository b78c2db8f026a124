//! Sizes of the preconditioner of the interface pressures.

/// Share of the slots whose vertices may have a row, and rows that there are at least.
const SHARE: usize = 128;
const LEAST: usize = 4096;

/// Vertices that an entry of a row may stand for along each axis.
const WINDOW: usize = 5;

/// Rows for so many vertices with pressures apart; those beyond have the diagonal alone.
pub(crate) fn rows(slots: usize, extra_capacity: usize) -> usize {
    extra_capacity.min((slots / SHARE).max(LEAST))
}

/// Entries of a row: its head and the neighbours within two vertices.
pub(crate) fn row_length(dimension: usize) -> usize {
    1 + WINDOW.pow(dimension as u32)
}
