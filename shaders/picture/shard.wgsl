// Shards: what a particle is drawn as that no other one touches. A box of one of three forms, turned, and cut at three corners, by what the
// particle's number says. Reads near_balls, near_names, near_reach.

// In near_names, above the colour: the particle touches no other one; it is broken.
const LONE: u32 = 0x80000000u;
const BROKEN: u32 = 0x40000000u;

fn particle_of(k: u32) -> u32 { return near_names[k].y; }

fn is_lone(k: u32) -> bool { return (near_names[k].x & LONE) != 0u; }

struct Shard {
    middle: vec3f,
    // Columns are its axes, and half its edges along them [m].
    axes: mat3x3f,
    sides: vec3f,
    // Signs of the corners that are cut.
    corners: vec3f,
}

// Next of a row of well mixed numbers [O'Neill 2014].
fn mixed(seed: u32) -> u32 {
    let state = seed * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn shard_of(k: u32) -> Shard {
    let seed = mixed(particle_of(k));
    // A quaternion of any direction.
    let parts = vec4f(vec4u(seed, seed >> 8u, seed >> 16u, seed >> 24u) & vec4u(255u)) - 127.4;
    let q = normalize(parts);
    let x = vec3f(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    let y = vec3f(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    let form = mixed(seed) >> 29u;
    var sides = vec3f(1.0, 0.9, 0.75);
    if form > 2u { sides = vec3f(1.25, 0.95, 0.5); }
    if form > 5u { sides = vec3f(1.45, 0.65, 0.55); }
    let corners = select(vec3f(-1.0), vec3f(1.0), (vec3u(form) & vec3u(1u, 2u, 4u)) != vec3u(0u));
    let half = largest_reach() * unpack2x16unorm(near_balls[k].w).y;
    return Shard(bitcast<vec3f>(near_balls[k].xyz), mat3x3f(x, y, cross(x, y)), half * sides, corners);
}

// Face that cuts a corner: its direction where the box has edges of 2, and its distance.
fn shard_cut(shard: Shard, k: u32) -> vec4f {
    let own = vec3u(0u, 1u, 2u) == vec3u(k);
    let flipped = own & (vec3u(k) > vec3u(0u));
    return vec4f(shard.corners * select(vec3f(0.5), select(vec3f(1.5), vec3f(-1.5), flipped), own), 1.2);
}

// Direction and distance along a ray of the face of a shard that it meets; negative for none.
fn meet_shard(ray: Ray, shard: Shard) -> vec4f {
    let start = ((ray.start - shard.middle) * shard.axes) / shard.sides;
    let along = (ray.direction * shard.axes) / shard.sides;
    let slope = select(along, vec3f(1e-6), abs(along) < vec3f(1e-6));
    let entries = (-sign(slope) - start) / slope;
    let exits = (sign(slope) - start) / slope;
    var enter = max(entries.x, max(entries.y, entries.z));
    var leave = min(exits.x, min(exits.y, exits.z));
    var face = -sign(slope) * vec3f(entries >= vec3f(enter));
    for (var k = 0u; k < 3u; k++) {
        let cut = shard_cut(shard, k);
        let rise = dot(cut.xyz, slope);
        let s = (cut.w - dot(cut.xyz, start)) / select(rise, 1e-6, abs(rise) < 1e-6);
        if rise > 0.0 { leave = min(leave, s); } else if s > enter {
            enter = s;
            face = cut.xyz;
        }
    }
    return vec4f(normalize(shard.axes * (face / shard.sides)), select(-1.0, enter, enter < leave));
}

// Direction of the face of a shard that lies towards a point.
fn face_towards(point: vec3f, shard: Shard) -> vec3f {
    let place = ((point - shard.middle) * shard.axes) / shard.sides;
    let far = abs(place);
    var most = max(far.x, max(far.y, far.z));
    var face = sign(place) * vec3f(far >= vec3f(most));
    for (var k = 0u; k < 3u; k++) {
        let cut = shard_cut(shard, k);
        let share = dot(cut.xyz, place) / cut.w;
        if share > most {
            most = share;
            face = cut.xyz;
        }
    }
    return normalize(shard.axes * (face / shard.sides));
}
