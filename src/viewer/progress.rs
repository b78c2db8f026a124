//! How many kernels of the scene that is being opened are compiled. One window has one worker.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Compiled, and asked for.
static KERNELS: [AtomicUsize; 2] = [AtomicUsize::new(0), AtomicUsize::new(0)];

/// Takes note of how many are compiled, of how many.
pub(super) fn tell(compiled: usize, asked: usize) {
    KERNELS[0].store(compiled, Ordering::Relaxed);
    KERNELS[1].store(asked, Ordering::Relaxed);
}

/// What stands in place of a picture.
pub(super) fn text() -> String {
    let [compiled, asked] = [0, 1].map(|k| KERNELS[k].load(Ordering::Relaxed));
    if compiled < asked {
        format!("opening: compiling kernel {} of {asked}", compiled + 1)
    } else {
        "opening: reading, filling buffers".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_told_which_kernel_is_compiled() {
        tell(39, 95);
        assert_eq!(text(), "opening: compiling kernel 40 of 95");
        tell(95, 95);
        assert_eq!(text(), "opening: reading, filling buffers");
    }
}
