//! Exclusive prefix sum of u32 arrays of any length.

use crate::error::{Error, Result};
use crate::gpu::{Bound, Buffer, Constants, Extent, Gpu, Kernel, Pass, WORKGROUP, group_counts};

/// Elements one workgroup scans.
const BLOCK: u32 = SCAN_ITEMS * WORKGROUP;

/// Consecutive elements of one thread; `scan.wgsl` gets it from here.
const SCAN_ITEMS: u32 = 16;

/// Groups per axis that every device allows; the shape of dispatches must not depend on the device.
const MAX_GROUPS: u32 = 65_535;

/// Scans one buffer into another: blocks, then the totals of the blocks, and so on up; then the offsets down again.
#[derive(Debug)]
pub struct Scan {
    /// Dispatches in order, each with its workgroups.
    dispatches: Vec<(Bound, [u32; 3])>,
    /// Workgroups on the device, for [`Scan::record_gated`]: x, y, z and a filler for each dispatch; zeros while closed.
    extents: Buffer<u32>,
    open: Bound,
    close: Bound,
}

/// The kernels and what has been bound so far.
struct Levels<'a> {
    gpu: &'a Gpu,
    blocks: Kernel,
    offsets: Kernel,
    up: Vec<(Bound, [u32; 3])>,
    down: Vec<(Bound, [u32; 3])>,
}

impl Scan {
    /// Prepares `output[i] = input[0] + ... + input[i - 1]` for the first `n` words of `input`; with `total` also
    /// `output[n]`, the sum of all. Both are storage buffers of u32, in the shader's eyes.
    ///
    /// # Errors
    /// [`Error::Gpu`] if a buffer is too short; those of [`Buffer::new`] and [`Kernel::new`].
    pub fn new(gpu: &Gpu, input: &wgpu::Buffer, output: &wgpu::Buffer, n: u32, total: bool) -> Result<Scan> {
        let outputs = n + u32::from(total);
        let words = |buffer: &wgpu::Buffer| buffer.size() / 4;
        if words(input) < u64::from(n) || words(output) < u64::from(outputs) {
            let (input, output) = (words(input), words(output));
            return Err(Error::Gpu(format!("a scan of {n} words from a buffer of {input} to {outputs} of {output}")));
        }
        let constants = Constants { overrides: &[("SCAN_ITEMS", f64::from(SCAN_ITEMS))], source: "" };
        let kernel = |entry: &str| Kernel::new(gpu, "scan.wgsl", entry, &constants);
        let (blocks, offsets) = (kernel("scan_blocks")?, kernel("scan_offsets")?);
        let mut levels = Levels { gpu, blocks, offsets, up: Vec::new(), down: Vec::new() };
        levels.bind(input, output, n, outputs)?;
        let Levels { up: mut dispatches, down, .. } = levels;
        dispatches.extend(down.into_iter().rev());
        let open: Vec<u32> = dispatches.iter().flat_map(|(_, [x, y, z])| [*x, *y, *z, 0]).collect();
        let extents = Buffer::<u32>::indirect(gpu, "scan extents", open.len())?;
        let gate = kernel("scan_gate")?;
        let switch = |counts: &[u32]| {
            let counts = Buffer::from_slice(gpu, "scan counts", counts)?;
            gate.bind(gpu, &[("counts", counts.raw()), ("extents", extents.raw())])
        };
        let (open, close) = (switch(&open)?, switch(&vec![0; open.len()])?);
        Ok(Scan { dispatches, extents, open, close })
    }

    /// Records the scan.
    pub fn record(&self, pass: &mut Pass) {
        for (bound, groups) in &self.dispatches {
            pass.dispatch(bound, &Extent::Groups(*groups));
        }
    }

    /// Records the scan so that it runs only if `gate`, an indirect extent, is one workgroup when its turn comes; at zero
    /// workgroups nothing is read or written.
    pub fn record_gated(&self, pass: &mut Pass, gate: &Extent<'_>) {
        pass.dispatch(&self.open, gate);
        for (index, (bound, _)) in self.dispatches.iter().enumerate() {
            pass.dispatch(bound, &Extent::Indirect(&self.extents, 16 * index as u64));
        }
        pass.dispatch(&self.close, gate);
    }
}

impl Levels<'_> {
    /// Binds one level and all above: the level's blocks, the scan of their totals, the way back.
    fn bind(&mut self, input: &wgpu::Buffer, output: &wgpu::Buffer, inputs: u32, outputs: u32) -> Result<()> {
        let gpu = self.gpu;
        let blocks = outputs.div_ceil(BLOCK).max(1);
        let groups = group_counts(u64::from(blocks), MAX_GROUPS);
        let params = Buffer::<u32>::uniform(gpu, "scan level", 3)?;
        params.write(gpu, 0, &[inputs, outputs, blocks]);
        let totals = Buffer::<u32>::new(gpu, "scan totals", blocks as usize)?;
        let params = ("params", params.raw());
        let up = [params, ("input", input), ("output", output), ("totals", totals.raw())];
        self.up.push((self.blocks.bind(gpu, &up)?, groups));
        if blocks > 1 {
            let offsets = Buffer::<u32>::new(gpu, "scan offsets", blocks as usize)?;
            let down = [params, ("output", output), ("offsets", offsets.raw())];
            self.down.push((self.offsets.bind(gpu, &down)?, groups));
            self.bind(totals.raw(), offsets.raw(), blocks, blocks)?;
        }
        Ok(())
    }
}
