//! Typed GPU memory that knows its length and is counted.

use std::marker::PhantomData;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use bytemuck::Pod;

use super::allocations;
use super::device::{GIB, Gpu};
use crate::error::{Error, Result};

/// An array of `T` on the GPU. Fresh memory is zero.
#[derive(Debug)]
pub struct Buffer<T> {
    raw: wgpu::Buffer,
    len: usize,
    ledger: Arc<AtomicU64>,
    element: PhantomData<T>,
}

impl<T: Pod> Buffer<T> {
    /// A storage buffer of `len` elements. An empty one takes the room of one element, because bindings may not be empty;
    /// shaders must therefore take counts from their parameters, not from `arrayLength`.
    ///
    /// # Errors
    /// [`Error::DoesNotFit`] if it is larger than the device can bind or has left.
    pub fn new(gpu: &Gpu, label: &str, len: usize) -> Result<Buffer<T>> {
        Self::allocate(gpu, label, len, wgpu::BufferUsages::STORAGE)
    }

    /// A storage buffer that may also hold the group counts of [`super::Extent::Indirect`].
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn indirect(gpu: &Gpu, label: &str, len: usize) -> Result<Buffer<T>> {
        Self::allocate(gpu, label, len, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT)
    }

    /// A buffer for `var<uniform>`.
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn uniform(gpu: &Gpu, label: &str, len: usize) -> Result<Buffer<T>> {
        Self::allocate(gpu, label, len, wgpu::BufferUsages::UNIFORM)
    }

    /// A buffer that one kernel writes as storage and others read as `var<uniform>`; it holds `values`.
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn uniform_storage(gpu: &Gpu, label: &str, values: &[T]) -> Result<Buffer<T>> {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE;
        let buffer = Self::allocate(gpu, label, values.len(), usage)?;
        buffer.write(gpu, 0, values);
        Ok(buffer)
    }

    /// A storage buffer that holds `values`.
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn from_slice(gpu: &Gpu, label: &str, values: &[T]) -> Result<Buffer<T>> {
        let buffer = Self::new(gpu, label, values.len())?;
        buffer.write(gpu, 0, values);
        Ok(buffer)
    }

    /// Checks the size against the device, allocates, counts.
    fn allocate(gpu: &Gpu, label: &str, len: usize, usage: wgpu::BufferUsages) -> Result<Buffer<T>> {
        const { assert!(size_of::<T>() > 0 && size_of::<T>().is_multiple_of(4), "copies move whole 4-byte words") };
        let element = size_of::<T>() as u64;
        let bytes = (len.max(1) as u64).saturating_mul(element);
        let binding = if usage.contains(wgpu::BufferUsages::UNIFORM) {
            gpu.limits.max_uniform_buffer_binding_size
        } else {
            gpu.limits.max_storage_buffer_binding_size
        };
        let allowed = binding.min(gpu.limits.max_buffer_size);
        if bytes > allowed {
            return Err(Error::DoesNotFit(format!(
                "`{label}` needs {:.2} GiB ({len} elements of {element} bytes), {} allows {:.2} GiB per buffer \
                 ({} elements); use a coarser resolution or another --device",
                bytes as f64 / GIB,
                gpu.info.name,
                allowed as f64 / GIB,
                allowed / element,
            )));
        }
        let raw = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes,
            usage: usage | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let ledger = Arc::clone(gpu.ledger());
        ledger.fetch_add(bytes, Ordering::Relaxed);
        allocations::note::<T>(label, &raw, len);
        let buffer = Buffer { raw, len, ledger, element: PhantomData };
        gpu.check()?;
        Ok(buffer)
    }

    /// Number of elements asked for.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether no element was asked for.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Bytes of the elements asked for.
    #[must_use]
    pub fn size_bytes(&self) -> u64 {
        (self.len * size_of::<T>()) as u64
    }

    /// The wgpu buffer, as [`super::Kernel::bind`] takes it.
    #[must_use]
    pub fn raw(&self) -> &wgpu::Buffer {
        &self.raw
    }

    /// Replaces elements from `first` on, before the next submission. Writing past the end is reported by [`Gpu::check`].
    pub fn write(&self, gpu: &Gpu, first: usize, values: &[T]) {
        if !values.is_empty() {
            gpu.queue.write_buffer(&self.raw, (first * size_of::<T>()) as u64, bytemuck::cast_slice(values));
        }
    }
}

impl<T> Drop for Buffer<T> {
    fn drop(&mut self) {
        self.ledger.fetch_sub(self.raw.size(), Ordering::Relaxed);
    }
}
