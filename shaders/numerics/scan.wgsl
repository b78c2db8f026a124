// Exclusive prefix sum of an array of u32, level by level.
// Equation: output[i] = sum of input[j], j < i; sums wrap at 2^32.
// scan_blocks: reads input, writes output (sums inside each block) and totals (one per block).
// scan_offsets: reads offsets (the scan of totals, or of few blocks the totals, which each block sums up), adds them to output; then the
// equation holds across blocks.

// Consecutive elements of one thread, set by Rust; SCAN_ITEMS * WORKGROUP is a block.
override SCAN_ITEMS: u32;

struct ScanParams {
    // Length of the input; what lies beyond counts as zero.
    inputs: u32,
    // Length of the output: equal, or one more to hold the total.
    outputs: u32,
    // Blocks of this level: the last workgroups of a split dispatch may have none.
    blocks: u32,
    // 1 where blocks are few: `offsets` holds their totals.
    few: u32,
}

@group(0) @binding(0) var<uniform> params: ScanParams;
@group(0) @binding(1) var<storage, read> input: array<u32>;
@group(0) @binding(2) var<storage, read_write> output: array<u32>;
@group(0) @binding(3) var<storage, read_write> totals: array<u32>;
@group(0) @binding(4) var<storage, read> offsets: array<u32>;

var<workgroup> scratch: array<u32, WORKGROUP>;

fn input_at(i: u32) -> u32 {
    if i < params.inputs { return input[i]; }
    return 0u;
}

@compute @workgroup_size(WORKGROUP)
fn scan_blocks(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let thread = thread_index(workgroup, local);
    let block = thread / WORKGROUP;
    let first = thread * SCAN_ITEMS;
    var own = 0u;
    for (var k = 0u; k < SCAN_ITEMS; k++) {
        own += input_at(first + k);
    }
    // Inclusive scan of the threads' sums [Hillis and Steele 1986].
    scratch[local] = own;
    workgroupBarrier();
    for (var reach = 1u; reach < WORKGROUP; reach *= 2u) {
        var below = 0u;
        if local >= reach { below = scratch[local - reach]; }
        workgroupBarrier();
        scratch[local] += below;
        workgroupBarrier();
    }
    var sum = scratch[local] - own;
    for (var k = 0u; k < SCAN_ITEMS; k++) {
        let i = first + k;
        if i < params.outputs {
            output[i] = sum;
            sum += input_at(i);
        }
    }
    if local == WORKGROUP - 1u && block < params.blocks { totals[block] = scratch[local]; }
}

// Sum of all blocks before one.
fn offset_of(block: u32, local: u32) -> u32 {
    if params.few == 0u { return offsets[block]; }
    var own = 0u;
    for (var k = local; k < block; k += WORKGROUP) { own += offsets[k]; }
    scratch[local] = own;
    workgroupBarrier();
    var sum = 0u;
    for (var k = 0u; k < WORKGROUP; k++) { sum += scratch[k]; }
    return sum;
}

@compute @workgroup_size(WORKGROUP)
fn scan_offsets(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let block = group_index(workgroup);
    if block >= params.blocks { return; }
    let offset = offset_of(block, local);
    for (var k = 0u; k < SCAN_ITEMS; k++) {
        let i = (block * WORKGROUP + local) * SCAN_ITEMS + k;
        if i < params.outputs { output[i] += offset; }
    }
}
