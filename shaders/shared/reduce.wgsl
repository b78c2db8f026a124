// Sum, minimum and maximum over a workgroup as a tree of fixed shape: equal inputs give equal bits on every run.
// All WORKGROUP threads must call these, in uniform control flow; every thread gets the result.

var<workgroup> reduce_scratch: array<f32, WORKGROUP>;

fn workgroup_sum(local: u32, value: f32) -> f32 {
    reduce_scratch[local] = value;
    workgroupBarrier();
    for (var width = WORKGROUP / 2u; width > 0u; width /= 2u) {
        if local < width { reduce_scratch[local] += reduce_scratch[local + width]; }
        workgroupBarrier();
    }
    return reduce_result();
}

fn workgroup_min(local: u32, value: f32) -> f32 {
    reduce_scratch[local] = value;
    workgroupBarrier();
    for (var width = WORKGROUP / 2u; width > 0u; width /= 2u) {
        if local < width {
            reduce_scratch[local] = min(reduce_scratch[local], reduce_scratch[local + width]);
        }
        workgroupBarrier();
    }
    return reduce_result();
}

fn workgroup_max(local: u32, value: f32) -> f32 { return -workgroup_min(local, -value); }

// The barrier lets a thread start the next reduction only when all have read this one.
fn reduce_result() -> f32 {
    let result = reduce_scratch[0];
    workgroupBarrier();
    return result;
}

// Sum and maximum of four values at once over a workgroup, as a tree of fixed shape: eight values, then eight such results.
// Wide and shallow, because barriers cost more than additions. As above. No compiler knows the bounds of the inner loops: unrolled, a
// sum takes a tenth of a second to compile in software.

var<workgroup> reduce4_scratch: array<vec4f, WORKGROUP>;

const REDUCE4_WIDTH = 8u;

fn workgroup_sum4(local: u32, value: vec4f) -> vec4f {
    reduce4_scratch[local] = value;
    for (var stride = 1u; stride < WORKGROUP; stride *= REDUCE4_WIDTH) {
        workgroupBarrier();
        let turns = select(0u, REDUCE4_WIDTH, local % (stride * REDUCE4_WIDTH) == 0u);
        var sum = reduce4_scratch[local];
        for (var k = 1u; k < turns; k++) { sum += reduce4_scratch[local + k * stride]; }
        if turns > 0u { reduce4_scratch[local] = sum; }
    }
    return reduce4_result();
}

fn workgroup_max4(local: u32, value: vec4f) -> vec4f {
    reduce4_scratch[local] = value;
    for (var stride = 1u; stride < WORKGROUP; stride *= REDUCE4_WIDTH) {
        workgroupBarrier();
        let turns = select(0u, REDUCE4_WIDTH, local % (stride * REDUCE4_WIDTH) == 0u);
        var largest = reduce4_scratch[local];
        for (var k = 1u; k < turns; k++) { largest = max(largest, reduce4_scratch[local + k * stride]); }
        if turns > 0u { reduce4_scratch[local] = largest; }
    }
    return reduce4_result();
}

// The barriers let every thread read the result, and a thread start the next reduction only when all have read this one.
fn reduce4_result() -> vec4f {
    workgroupBarrier();
    let result = reduce4_scratch[0];
    workgroupBarrier();
    return result;
}
