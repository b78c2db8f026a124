//! The GPU without physics: device, buffers, shaders, kernels, passes, readback.
//!
//! The usual order: [`Gpu::new`] picks a device, [`Buffer::new`] allocates, [`Kernel::new`] reflects the bindings of one entry
//! point and has it compiled, [`Kernel::bind`] connects buffers by name, a [`Pass`] records dispatches and submits them,
//! [`readback::read`] brings numbers back. Nothing here panics on a driver error: the first one is kept and
//! [`Gpu::check`] hands it out.

mod adapters;
mod allocations;
mod buffer;
mod device;
mod kernel;
mod pass;
mod pipeline;
pub mod readback;
mod reflect;
mod shader;
mod sources;
mod written;

pub use adapters::AdapterSummary;
pub use allocations::{Allocation, watched};
pub use buffer::Buffer;
pub use device::{Gpu, GpuOptions, Settings};
pub use kernel::{Bound, Constants, Extent, Kernel, MAX_GROUPS, OCTET, WORKGROUP, group_counts};
pub use pass::{Detail, Pass, Times, add_time};
pub use reflect::{Access, Binding, Compiled, MAX_STORAGE_BUFFERS};
pub use shader::{Folder, Shader};
pub use sources::SOURCES;
