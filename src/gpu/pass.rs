//! Recording: one submission of dispatches, in stages that carry names and, on request, times.

use std::sync::Arc;
use std::time::Instant;

use super::buffer::Buffer;
use super::device::Gpu;
use super::kernel::{Bound, Extent, group_counts};
use super::readback;
use crate::error::{Error, Result};

/// Work recorded for one submission. Dispatches run in order; each sees what the earlier ones wrote.
#[derive(Debug)]
pub struct Pass {
    gpu: Gpu,
    encoder: wgpu::CommandEncoder,
    /// The open compute pass. A timed one spans a single stage, because only pass borders carry timestamps everywhere.
    open: Option<wgpu::ComputePass<'static>>,
    stage: String,
    in_group: bool,
    clock: Option<Clock>,
    label: String,
    /// Whether each stage is a submission of its own.
    cut: bool,
    launches: Vec<Arc<str>>,
}

/// What a stopwatch tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Whole stages.
    Stages,
    /// Every kernel of a stage: more pauses between dispatches.
    Kernels,
}

/// Stopwatch of a timed pass.
#[derive(Debug)]
struct Clock {
    detail: Detail,
    watch: Watch,
}

/// How a stopwatch measures.
#[derive(Debug)]
enum Watch {
    /// Two timestamps of the device per span; the stage of each span, in order.
    Timestamps(wgpu::QuerySet, Vec<String>),
    /// Each span is a submission of its own, with a wait for its end: its milliseconds, or what went wrong.
    Waits(Result<Times>),
}

/// Stages and their milliseconds, in order of first appearance.
pub type Times = Vec<(String, f64)>;

/// Adds a time \[ms\] to that of its stage.
pub fn add_time(times: &mut Times, stage: &str, time: f64) {
    match times.iter_mut().find(|(known, _)| known == stage) {
        Some((_, sum)) => *sum += time,
        None => times.push((stage.to_owned(), time)),
    }
}

impl Pass {
    /// Starts recording.
    #[must_use]
    pub fn new(gpu: &Gpu, label: &str) -> Pass {
        let encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) });
        Pass {
            gpu: gpu.clone(),
            encoder,
            open: None,
            stage: label.to_owned(),
            in_group: false,
            clock: None,
            label: label.to_owned(),
            cut: false,
            launches: Vec::new(),
        }
    }

    /// Starts recording with a stopwatch per stage or kernel: timestamps of the device, or, where it has none ([`Gpu::timestamps`]), a
    /// submission and a wait for each, which counts the launch, too.
    #[must_use]
    pub fn timed(gpu: &Gpu, label: &str, detail: Detail) -> Pass {
        let mut pass = Pass::new(gpu, label);
        let queries = || {
            gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some(label),
                ty: wgpu::QueryType::Timestamp,
                count: wgpu::QUERY_SET_MAX_QUERIES,
            })
        };
        let watch =
            if gpu.timestamps { Watch::Timestamps(queries(), Vec::new()) } else { Watch::Waits(Ok(Times::new())) };
        pass.clock = Some(Clock { detail, watch });
        pass
    }

    /// Submits each stage on its own, where all together would take longer than a system lets a submission run.
    #[must_use]
    pub fn cut(mut self, each: bool) -> Pass {
        self.cut = each;
        self
    }

    /// Names what follows, for debuggers and the stopwatch.
    pub fn stage(&mut self, name: &str) {
        self.close_group();
        if self.cut {
            self.open = None;
            let label = wgpu::CommandEncoderDescriptor { label: Some(name) };
            let encoder = std::mem::replace(&mut self.encoder, self.gpu.device.create_command_encoder(&label));
            self.gpu.queue.submit([encoder.finish()]);
        }
        if self.clock.is_some() {
            self.open = None;
            self.wait_for_span(None);
        }
        name.clone_into(&mut self.stage);
    }

    /// Submits what the present span has recorded and waits for it, if that is how it is timed.
    fn wait_for_span(&mut self, kernel: Option<&str>) {
        let Some(Clock { watch: Watch::Waits(times), .. }) = &mut self.clock else { return };
        let label = wgpu::CommandEncoderDescriptor { label: Some(&self.stage) };
        let encoder = std::mem::replace(&mut self.encoder, self.gpu.device.create_command_encoder(&label));
        let start = Instant::now();
        let submission = self.gpu.queue.submit([encoder.finish()]);
        self.gpu.note_work(format!("`{}`, stage {}", self.label, self.stage));
        let outcome = self.gpu.wait(Some(submission));
        let time = 1e3 * start.elapsed().as_secs_f64();
        let name = kernel.map_or_else(|| self.stage.clone(), |kernel| format!("{}: {kernel}", self.stage));
        match (times.as_mut(), outcome) {
            (Ok(times), Ok(())) => add_time(times, &name, time),
            (Ok(_), Err(error)) => *times = Err(error),
            (Err(_), _) => {}
        }
    }

    /// Records one dispatch. Extents of no threads record nothing.
    pub fn dispatch(&mut self, bound: &Bound, extent: &Extent<'_>) {
        let each = self.clock.as_ref().is_some_and(|clock| clock.detail == Detail::Kernels);
        if each {
            self.close_group();
            self.open = None;
        }
        let pipeline = match bound.pipeline.get(&self.gpu.device) {
            Ok(pipeline) => pipeline,
            Err(error) => return self.gpu.note(error),
        };
        self.launches.push(Arc::clone(&bound.name));
        let pass = self.compute(&bound.name);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &bound.group, &[]);
        match extent {
            Extent::Threads(threads) => {
                let [x, y, z] = group_counts(threads.div_ceil(u64::from(bound.threads_per_group)));
                if x > 0 {
                    pass.dispatch_workgroups(x, y, z);
                }
            }
            Extent::Groups([x, y, z]) => pass.dispatch_workgroups(*x, *y, *z),
            Extent::Indirect(buffer, offset) => pass.dispatch_workgroups_indirect(buffer.raw(), *offset),
        }
        if each {
            self.close_group();
            self.open = None;
            self.wait_for_span(Some(&bound.name));
        }
    }

    /// Kernels of all dispatches so far, in order, with those that the device may close.
    #[must_use]
    pub fn launches(&self) -> &[Arc<str>] {
        &self.launches
    }

    /// Sets a buffer to zero.
    pub fn clear<T: bytemuck::Pod>(&mut self, buffer: &Buffer<T>) {
        self.encoder().clear_buffer(buffer.raw(), 0, None);
    }

    /// Copies `len` elements between two buffers.
    pub fn copy<T: bytemuck::Pod>(&mut self, from: (&Buffer<T>, usize), to: (&Buffer<T>, usize), len: usize) {
        let bytes = |count: usize| (count * size_of::<T>()) as u64;
        self.encoder().copy_buffer_to_buffer(from.0.raw(), bytes(from.1), to.0.raw(), bytes(to.1), bytes(len));
    }

    /// The encoder itself, between compute passes, for commands that are neither dispatch, copy nor clear.
    pub fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.close_group();
        self.open = None;
        &mut self.encoder
    }

    /// Hands the work to the device and does not wait.
    ///
    /// # Errors
    /// What the driver found wrong while recording, see [`Gpu::check`].
    pub fn submit(self) -> Result<wgpu::SubmissionIndex> {
        let Pass { gpu, encoder, label, stage, .. } = self.finish();
        gpu.note_work(format!("`{label}` up to its stage {stage}"));
        let submission = gpu.queue.submit([encoder.finish()]);
        gpu.check()?;
        Ok(submission)
    }

    /// Submits, waits, and returns the milliseconds of each stage in order of first appearance; equal names are added up.
    ///
    /// # Errors
    /// As [`Pass::submit`]; [`Error::Bug`] if there were more stages than timestamps.
    pub fn submit_timed(mut self) -> Result<Times> {
        self.stage("rest");
        let Pass { gpu, mut encoder, clock, .. } = self.finish();
        let (queries, spans) = match clock.map(|clock| clock.watch) {
            Some(Watch::Timestamps(queries, spans)) if !spans.is_empty() => (queries, spans),
            Some(Watch::Waits(times)) => return times,
            _ => {
                let submission = gpu.queue.submit([encoder.finish()]);
                return gpu.wait(Some(submission)).map(|()| Times::new());
            }
        };
        if spans.len() > MAX_SPANS {
            return Err(Error::Bug(format!("{} timed stages, at most {MAX_SPANS} in one submission", spans.len())));
        }
        let count = 2 * spans.len() as u32;
        let size = u64::from(count) * 8;
        let resolved = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("timestamps"),
            size,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        encoder.resolve_query_set(&queries, 0..count, &resolved, 0);
        gpu.queue.submit([encoder.finish()]);
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&readback::read_bytes(&gpu, &resolved, 0, size)?);
        let milliseconds_per_tick = f64::from(gpu.queue.get_timestamp_period()) * 1e-6;
        let mut times = Times::new();
        for (name, ends) in spans.iter().zip(ticks.chunks_exact(2)) {
            add_time(&mut times, name, ends[1].saturating_sub(ends[0]) as f64 * milliseconds_per_tick);
        }
        Ok(times)
    }

    /// The open compute pass of the current stage.
    fn compute(&mut self, kernel: &str) -> &mut wgpu::ComputePass<'static> {
        let Pass { encoder, open, stage, in_group, clock, .. } = self;
        let pass = open.get_or_insert_with(|| {
            let timestamp_writes = clock.as_mut().and_then(|clock| clock.span(stage, kernel));
            let descriptor = wgpu::ComputePassDescriptor { label: Some(stage), timestamp_writes };
            encoder.begin_compute_pass(&descriptor).forget_lifetime()
        });
        if !*in_group {
            pass.push_debug_group(stage);
            *in_group = true;
        }
        pass
    }

    /// Ends the debug group of a stage that dispatched something.
    fn close_group(&mut self) {
        if let Some(pass) = self.open.as_mut().filter(|_| self.in_group) {
            pass.pop_debug_group();
        }
        self.in_group = false;
    }

    /// Ends the compute pass.
    fn finish(mut self) -> Pass {
        self.close_group();
        self.open = None;
        self
    }
}

/// Spans one query set can time.
const MAX_SPANS: usize = wgpu::QUERY_SET_MAX_QUERIES as usize / 2;

impl Clock {
    /// Opens a span; no timestamps once the queries are used up, which [`Pass::submit_timed`] reports.
    fn span(&mut self, stage: &str, kernel: &str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let Watch::Timestamps(queries, spans) = &mut self.watch else { return None };
        let first = 2 * spans.len() as u32;
        spans.push(match self.detail {
            Detail::Stages => stage.to_owned(),
            Detail::Kernels => format!("{stage}: {kernel}"),
        });
        (spans.len() <= MAX_SPANS).then_some(wgpu::ComputePassTimestampWrites {
            query_set: queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }
}
