// What both forms of p2g read and write: particles, their order and where those of each cell begin in it; nodes.

override WITH_FORCE: bool;      // elastic force
override WITH_DRIVER: bool;     // and the driver of fracture times the mass, in w

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(3) var<storage, read> affine: array<vec4f>;
@group(0) @binding(4) var<storage, read> stress: array<vec4f>;
@group(0) @binding(5) var<storage, read> order: array<u32>;
@group(0) @binding(6) var<storage, read> cell_start: array<u32>;
@group(0) @binding(7) var<storage, read_write> node: array<vec4f>;     // velocity, mass
@group(0) @binding(8) var<storage, read_write> work: array<vec4f>;
