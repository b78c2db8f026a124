//! The only way from the GPU to the CPU. Every call waits for all work submitted before.

use bytemuck::Pod;

use super::buffer::Buffer;
use super::device::Gpu;
use crate::error::{Error, Result};

/// All elements of a buffer.
///
/// # Errors
/// Those of [`Gpu::check`]: whatever went wrong before shows here at the latest.
pub fn read<T: Pod>(gpu: &Gpu, buffer: &Buffer<T>) -> Result<Vec<T>> {
    read_range(gpu, buffer, 0, buffer.len())
}

/// The `len` elements from `first` on.
///
/// # Errors
/// As [`read`], and [`Error::Bug`] if the range leaves the buffer.
pub fn read_range<T: Pod>(gpu: &Gpu, buffer: &Buffer<T>, first: usize, len: usize) -> Result<Vec<T>> {
    elements(gpu, buffer, (first, len), bytemuck::pod_collect_to_vec)
}

/// Appends what a function makes of each of the first `len` elements.
///
/// # Errors
/// As [`read_range`].
pub fn read_into<T: Pod, U>(
    gpu: &Gpu,
    buffer: &Buffer<T>,
    len: usize,
    of: impl Fn(T) -> U,
    all: &mut Vec<U>,
) -> Result<()> {
    elements(gpu, buffer, (0, len), |bytes| {
        all.extend(bytes.chunks_exact(size_of::<T>()).map(|bytes| of(bytemuck::pod_read_unaligned(bytes))));
    })
}

/// What a function makes of the bytes of `len` elements from `first` on.
fn elements<T: Pod, R>(
    gpu: &Gpu,
    buffer: &Buffer<T>,
    (first, len): (usize, usize),
    of: impl FnOnce(&[u8]) -> R,
) -> Result<R> {
    if first + len > buffer.len() {
        return Err(Error::Bug(format!("elements {first}..{} of a buffer of {} elements", first + len, buffer.len())));
    }
    if len == 0 {
        return Ok(of(&[]));
    }
    let element = size_of::<T>() as u64;
    mapped(gpu, buffer.raw(), first as u64 * element, len as u64 * element, of)
}

/// Bytes of any buffer with the usage `COPY_SRC`; offset and size are multiples of 4.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(gpu: &Gpu, source: &wgpu::Buffer, offset: u64, size: u64) -> Result<Vec<u8>> {
    mapped(gpu, source, offset, size, <[u8]>::to_vec)
}

/// What a function makes of bytes of a buffer.
fn mapped<R>(gpu: &Gpu, source: &wgpu::Buffer, offset: u64, size: u64, of: impl FnOnce(&[u8]) -> R) -> Result<R> {
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("readback") });
    encoder.copy_buffer_to_buffer(source, offset, &staging, 0, size);
    gpu.queue.submit([encoder.finish()]);
    gpu.check()?;
    let (sender, receiver) = std::sync::mpsc::channel();
    staging.map_async(wgpu::MapMode::Read, .., move |mapped| {
        // The receiver is gone only when waiting failed, which is reported below.
        let _ = sender.send(mapped);
    });
    gpu.wait(None)?;
    let failed = |reason: String| Error::Gpu(format!("reading back {size} bytes from {}: {reason}", gpu.info.name));
    receiver.recv().map_err(|error| failed(error.to_string()))?.map_err(|error| failed(error.to_string()))?;
    let result = of(&staging.get_mapped_range(..).map_err(|error| failed(error.to_string()))?);
    staging.unmap();
    Ok(result)
}
