// Sum, minimum and maximum over a workgroup as a tree of fixed shape: equal inputs give equal bits on every run.
// All WORKGROUP threads must call these, in uniform control flow; every thread gets the result.

var<workgroup> reduce_scratch: array<f32, WORKGROUP>;

fn workgroup_sum(local: u32, value: f32) -> f32 {
    reduce_scratch[local] = value;
    workgroupBarrier();
    for (var width = WORKGROUP / 2u; width > 0u; width /= 2u) {
        if (local < width) {
            reduce_scratch[local] += reduce_scratch[local + width];
        }
        workgroupBarrier();
    }
    return reduce_result();
}

fn workgroup_min(local: u32, value: f32) -> f32 {
    reduce_scratch[local] = value;
    workgroupBarrier();
    for (var width = WORKGROUP / 2u; width > 0u; width /= 2u) {
        if (local < width) {
            reduce_scratch[local] = min(reduce_scratch[local], reduce_scratch[local + width]);
        }
        workgroupBarrier();
    }
    return reduce_result();
}

fn workgroup_max(local: u32, value: f32) -> f32 {
    return -workgroup_min(local, -value);
}

// The barrier lets a thread start the next reduction only when all have read this one.
fn reduce_result() -> f32 {
    let result = reduce_scratch[0];
    workgroupBarrier();
    return result;
}
