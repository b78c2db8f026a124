// What both forms of p2g read and write: particles, nodes.

override WITH_FORCE: bool;      // elastic force
override WITH_DRIVER: bool;     // and the driver of fracture times the mass, in w

@group(0) @binding(1) var<storage, read> position: array<vec4f>;          // [m]; w: mass [kg]
@group(0) @binding(2) var<storage, read> velocity: array<vec4f>;          // [m s^-1]
@group(0) @binding(3) var<storage, read> affine: array<vec4f>;            // columns of the affine velocity C [s^-1], three per particle
@group(0) @binding(4) var<storage, read> stress: array<vec4f>;            // two per particle, see share_of() in p2g.wgsl
@group(0) @binding(5) var<storage, read> order: array<u32>;               // particles, cell by cell
@group(0) @binding(6) var<storage, read> cell_start: array<u32>;          // where those of a slot begin in it, and of the next slot end
@group(0) @binding(7) var<storage, read_write> node: array<vec4f>;        // velocity, mass
@group(0) @binding(8) var<storage, read_write> work: array<vec4f>;
