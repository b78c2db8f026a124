// Sum and maximum of four values at once over a workgroup, as a tree of fixed shape. As shared/reduce.wgsl.

var<workgroup> reduce4_scratch: array<vec4f, WORKGROUP>;

fn workgroup_sum4(local: u32, value: vec4f) -> vec4f {
    reduce4_scratch[local] = value;
    workgroupBarrier();
    for (var width = WORKGROUP / 2u; width > 0u; width /= 2u) {
        if local < width { reduce4_scratch[local] += reduce4_scratch[local + width]; }
        workgroupBarrier();
    }
    let result = reduce4_scratch[0];
    workgroupBarrier();
    return result;
}

fn workgroup_max4(local: u32, value: vec4f) -> vec4f {
    reduce4_scratch[local] = value;
    workgroupBarrier();
    for (var width = WORKGROUP / 2u; width > 0u; width /= 2u) {
        if local < width { reduce4_scratch[local] = max(reduce4_scratch[local], reduce4_scratch[local + width]); }
        workgroupBarrier();
    }
    let result = reduce4_scratch[0];
    workgroupBarrier();
    return result;
}
