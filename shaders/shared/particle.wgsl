// What a particle gives to one node: its share of mass and momentum (APIC) and of the internal force - vol0 tau grad w.
// Needs the bindings position, velocity, affine and stress. [Jiang et al. 2015; Cao et al. 2022, section 2.2]

override WITH_MASS: bool;       // mass and momentum
override WITH_FORCE: bool;      // elastic force
override WITH_DRIVER: bool;     // and the driver of fracture

fn stress_of(p: u32) -> mat3x3f {
    let d = stress[2u * p].xyz;      // xx, yy, zz of vol0 tau [J]
    let o = stress[2u * p + 1u].xyz; // xy, yz, zx
    return mat3x3f(vec3f(d.x, o.x, o.z), vec3f(o.x, d.y, o.y), vec3f(o.z, o.y, d.z));
}

struct Share { momentum: vec4f, force: vec4f } // momentum.w = mass, force.w = mass times driver

fn share_of(p: u32, s: Spline, offset: vec3i) -> Share {
    var share: Share;
    let node = spline_node(s, offset);
    if WITH_MASS {
        let x = position[p];
        let reach_to_node = node_distance(s, offset, x.xyz);
        let c = mat3x3f(affine[3u * p].xyz, affine[3u * p + 1u].xyz, affine[3u * p + 2u].xyz);
        let mass = node.w * x.w;
        share.momentum = vec4f(mass * (velocity[p].xyz + c * reach_to_node), mass);
    }
    if WITH_FORCE { share.force = vec4f(-(stress_of(p) * node.xyz), 0.0); }
    if WITH_DRIVER { share.force.w = node.w * position[p].w * stress[2u * p + 1u].w; }
    return share;
}
