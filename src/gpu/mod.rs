//! The GPU without physics: device, buffers, shaders, kernels, passes, readback.
//!
//! The usual order: [`Gpu::new`] picks a device, [`Buffer::new`] allocates, [`Kernel::new`] reflects the bindings of one entry
//! point and has it compiled, [`Kernel::bind`] connects buffers by name, a [`Pass`] records dispatches and submits them,
//! [`readback::read`] brings numbers back. Nothing here panics on a driver error: the first one is kept and
//! [`Gpu::check`] hands it out.

mod adapters;
mod allocations;
mod buffer;
mod cache;
mod device;
mod kernel;
mod pass;
mod pipeline;
#[doc(hidden)]
pub mod readback;
mod reflect;
mod shader;
mod sources;
mod specialised;
mod written;

pub use adapters::AdapterSummary;
pub use device::{Gpu, GpuOptions, Settings};
#[doc(hidden)]
pub use {
    allocations::{Allocation, watched},
    buffer::Buffer,
    kernel::{Bound, Constants, Extent, Kernel, MAX_GROUPS, OCTET, WORKGROUP, group_counts},
    pass::{Detail, Pass, Times, add_time},
    reflect::{Access, Binding, Compiled, MAX_STORAGE_BUFFERS},
    shader::{Folder, Shader},
    sources::SOURCES,
};
