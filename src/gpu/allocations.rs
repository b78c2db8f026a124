//! What a piece of work allocates, by label and in order: for those who copy all of it.

use std::any::TypeId;
use std::cell::RefCell;

use bytemuck::Pod;

/// One buffer.
#[derive(Clone, Debug)]
pub struct Allocation {
    /// Its label.
    pub label: String,
    /// The buffer.
    pub raw: wgpu::Buffer,
    /// Bytes of the elements asked for.
    pub bytes: u64,
    /// Whether the words are floating point numbers.
    pub real: bool,
    /// Words of an element.
    pub columns: usize,
}

thread_local! {
    static SEEN: RefCell<Option<Vec<Allocation>>> = const { RefCell::new(None) };
}

/// Does a piece of work, and returns the buffers that it made on this thread.
pub fn watched<R>(work: impl FnOnce() -> R) -> (R, Vec<Allocation>) {
    let outer = SEEN.replace(Some(Vec::new()));
    let result = work();
    (result, SEEN.replace(outer).unwrap_or_default())
}

/// Notes a buffer of elements `T`, if somebody watches.
pub(super) fn note<T: Pod>(label: &str, raw: &wgpu::Buffer, len: usize) {
    SEEN.with_borrow_mut(|seen| {
        if let Some(seen) = seen {
            let kind = TypeId::of::<T>();
            let real = [TypeId::of::<f32>(), TypeId::of::<[f32; 2]>(), TypeId::of::<[f32; 4]>()].contains(&kind);
            let (bytes, columns) = ((len * size_of::<T>()) as u64, size_of::<T>() / 4);
            seen.push(Allocation { label: label.to_owned(), raw: raw.clone(), bytes, real, columns });
        }
    });
}
