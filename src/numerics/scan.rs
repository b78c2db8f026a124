//! Exclusive prefix sum of u32 arrays of any length.

use crate::error::{Error, Result};
use crate::gpu::{Bound, Buffer, Constants, Extent, Gpu, Kernel, Pass, WORKGROUP, group_counts};

/// Elements one workgroup scans.
const BLOCK: u32 = SCAN_ITEMS * WORKGROUP;

/// Consecutive elements of one thread; `scan.wgsl` gets it from here.
const SCAN_ITEMS: u32 = 16;

/// Blocks at most whose totals each block adds up for itself; more are scanned like the elements.
const FEW: u32 = 2048;

/// Scans one buffer into another: blocks, and where they are many the totals of the blocks, and so on up; then the offsets down again.
#[derive(Debug)]
pub struct Scan {
    /// Dispatches in order, each with its workgroups.
    dispatches: Vec<(Bound, [u32; 3])>,
    /// Totals and their scans, level by level; the kernels hold them too.
    scratch: Vec<Buffer<u32>>,
}

impl Scan {
    /// Prepares `output[i] = input[0] + ... + input[i - 1]` for the first `n` elements of `input`. An output of `n + 1`
    /// elements or more gets the sum of all in `output[n]`; elements after it stay as they are.
    ///
    /// # Errors
    /// [`Error::Bug`] if a buffer is shorter than `n`; those of [`Buffer::new`] and [`Kernel::new`].
    pub fn new(gpu: &Gpu, input: &Buffer<u32>, output: &Buffer<u32>, n: u32) -> Result<Scan> {
        if input.len() < n as usize || output.len() < n as usize {
            let (input, output) = (input.len(), output.len());
            return Err(Error::Bug(format!("a scan of {n} elements from a buffer of {input} into one of {output}")));
        }
        let outputs = n + u32::from(output.len() > n as usize);
        Scan::over(gpu, input.raw(), output.raw(), n, outputs)
    }

    /// The same over buffers of any type whose first `n` and `outputs` words are meant.
    ///
    /// # Errors
    /// Those of [`Buffer::new`] and [`Kernel::new`].
    pub fn over(gpu: &Gpu, input: &wgpu::Buffer, output: &wgpu::Buffer, n: u32, outputs: u32) -> Result<Scan> {
        let constants = Constants { overrides: &[("SCAN_ITEMS", f64::from(SCAN_ITEMS))], source: "" };
        let blocks_kernel = Kernel::new(gpu, "numerics/scan.wgsl", "scan_blocks", &constants)?;
        let offsets_kernel = Kernel::new(gpu, "numerics/scan.wgsl", "scan_offsets", &constants)?;
        let mut scan = Scan { dispatches: Vec::new(), scratch: Vec::new() };
        let mut down = Vec::new();
        let mut inputs = n;
        let lengths = level_lengths(outputs);
        for (level, &length) in lengths.iter().enumerate() {
            let blocks = blocks(length);
            let groups = group_counts(u64::from(blocks));
            let is_last = level + 1 == lengths.len();
            let params = Buffer::<u32>::uniform(gpu, "scan level", 4)?;
            params.write(gpu, 0, &[inputs, length, blocks, u32::from(is_last)]);
            scan.scratch.push(Buffer::new(gpu, "scan totals", blocks as usize)?);
            if !is_last {
                scan.scratch.push(Buffer::new(gpu, "scan offsets", blocks as usize)?);
            }
            // Level 0 works on the caller's buffers, level k on totals and offsets of level k - 1; the last has no offsets.
            let [totals, offsets] = [&scan.scratch[2 * level], &scan.scratch[2 * level + usize::from(!is_last)]];
            let [from, to] = match level {
                0 => [input, output],
                _ => [scan.scratch[2 * level - 2].raw(), scan.scratch[2 * level - 1].raw()],
            };
            let params = ("params", params.raw());
            let up = [params, ("input", from), ("output", to), ("totals", totals.raw())];
            scan.dispatches.push((blocks_kernel.bind(gpu, &up)?, groups));
            if blocks > 1 {
                let names = [params, ("output", to), ("offsets", offsets.raw())];
                down.push((offsets_kernel.bind(gpu, &names)?, groups));
            }
            inputs = blocks;
        }
        scan.dispatches.extend(down.into_iter().rev());
        Ok(scan)
    }

    /// Workgroups of each dispatch of a scan with this many outputs, known before it is built.
    pub fn plan(outputs: u32) -> Vec<[u32; 3]> {
        let up: Vec<_> = level_lengths(outputs).iter().map(|length| group_counts(u64::from(blocks(*length)))).collect();
        let down = up.iter().rev().filter(|groups| **groups != [1, 1, 1]).copied();
        up.iter().copied().chain(down.collect::<Vec<_>>()).collect()
    }

    /// Bytes that a scan with this many outputs allocates, known before it is built.
    pub fn planned_bytes(outputs: u32) -> u64 {
        let lengths = level_lengths(outputs);
        let words = lengths.iter().map(|length| 2 * u64::from(blocks(*length))).sum::<u64>();
        (words - lengths.last().map_or(0, |length| u64::from(blocks(*length)))) * size_of::<u32>() as u64
    }

    /// Workgroups of each dispatch: what [`Scan::record_with`] runs when nothing is to be skipped.
    pub fn group_counts(&self) -> Vec<[u32; 3]> {
        self.dispatches.iter().map(|(_, groups)| *groups).collect()
    }

    /// Records the scan.
    pub fn record(&self, pass: &mut Pass) {
        for (bound, groups) in &self.dispatches {
            pass.dispatch(bound, &Extent::Groups(*groups));
        }
    }

    /// Records the scan with the caller's extents, one for each of [`Scan::group_counts`]: indirect ones hold these counts, or
    /// zeros to skip the scan. Extra extents are ignored, missing ones leave their dispatches out.
    pub fn record_with(&self, pass: &mut Pass, extents: &[Extent<'_>]) {
        for ((bound, _), extent) in self.dispatches.iter().zip(extents) {
            pass.dispatch(bound, extent);
        }
    }
}

fn blocks(length: u32) -> u32 {
    length.div_ceil(BLOCK).max(1)
}

/// Elements at each level, from the array itself to the level of few blocks.
fn level_lengths(outputs: u32) -> Vec<u32> {
    let mut lengths = vec![outputs];
    while let Some(many) = lengths.last().map(|length| blocks(*length)).filter(|blocks| *blocks > FEW) {
        lengths.push(many);
    }
    lengths
}
