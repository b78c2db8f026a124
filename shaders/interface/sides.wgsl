// interface, the ledger: on which side of a body the gas lies that its cells hold.
// A wall of one or two cells takes in gas behind while it gives off gas ahead, from the same cell. Those are two gases: what is left of one
// must not come out on the other side. So a SOLID slot keeps two books: one for the gas on its lower side, `conserved`, which collects all
// that passes, and one for its upper side, `owed_flow`. Ahead is upper, but where gas lies on both sides and that behind is denser, behind
// is: a wall that swings back keeps its sides. Faces along the motion belong to neither side, and serve both, as do all of a body at rest.
// Needs the bindings of interface/ledger.wgsl.

// Amounts of gas that a SOLID slot holds [kg, kg m s^-1, J]; the second gas as in interface/owed_species.wgsl.
struct Held { flow: vec4f, energy: f32, species: vec2f }

// For the gas on either side.
struct Books { lower: Held, upper: Held }

fn sum_of_held(a: Held, b: Held) -> Held { return Held(a.flow + b.flow, a.energy + b.energy, a.species + b.species); }

fn times(a: Held, factor: f32) -> Held { return Held(factor * a.flow, factor * a.energy, factor * a.species); }

fn is_nothing(a: Held) -> bool { return all(a.flow == vec4f(0.0)) && a.energy == 0.0; }

fn on_one_side(all: Held, upper: bool) -> Books {
    var none: Held;
    if upper { return Books(none, all); }
    return Books(all, none);
}

// The faces of a slot. A number that no compiler knows: unrolled, the loops over them take seconds to compile in software.
fn faces_of(slot: u32) -> u32 { return select(0u, 2u * DIM, slot < params.slots); }

const ALONG = 0u;
const LOWER = 1u;
const UPPER = 2u;

// A face whose normal is nearer to a right angle with the motion than this cosine lies along it.
const SIDEWAYS = 0.05;

// A body that is slower than this share of the speed of sound has no sides: noise at rest may cover and open cells.
const STILL = 1e-3;

fn is_still_body(slot: u32) -> bool { return length(node[slot].xyz) <= STILL * control.sound; }

// Which side of a slot lies behind a face; `turned`: upper is behind.
fn side_of(slot: u32, turned: bool, a: u32, up: bool) -> u32 {
    let v = node[slot].xyz;
    let towards = select(-v[a], v[a], up != turned);
    if abs(towards) <= SIDEWAYS * length(v) || is_still_body(slot) { return ALONG; }
    return select(LOWER, UPPER, towards > 0.0);
}

// Gas behind is denser by more than this share where it is upper.
const DENSER = 1e-3;

// Whether the upper side of a slot is that behind it. `before`: with what was gas in the step before.
fn is_turned(slot: u32, before: bool) -> bool {
    var ahead = vec2f(0.0);
    var behind = vec2f(0.0);
    for (var face = 0u; face < faces_of(slot); face++) {
        let a = face / 2u;
        let up = (face & 1u) == 1u;
        let other = select(slot - step_of(a), slot + step_of(a), up);
        let word = cells[other];
        if select(kind_of(word), previous_kind_of(word), before) != GAS { continue; }
        let here = side_of(slot, false, a, up);
        if here == UPPER { ahead += vec2f(1.0, conserved[other].x); }
        if here == LOWER { behind += vec2f(1.0, conserved[other].x); }
    }
    return ahead.x > 0.0 && behind.x > 0.0 && behind.y * ahead.x > (1.0 + DENSER) * ahead.y * behind.x;
}

// What has come in through a closed face in the step before: the gas there at the velocity of the wall.
fn passed(slot: u32, other: u32, a: u32, up: bool) -> Held {
    let here = node[slot];
    let there = node[other];
    let speed = (here.w * here[a] + there.w * there[a]) / max(here.w + there.w, 1e-30);
    let way = select(speed, -speed, up) * control.dt_previous * blocked_of(cells[slot]) * face_area();
    let gas = gas_at(other);
    return times(Held(gas.flow, gas.energy, summed_species(gas)), way);
}

fn kept_books(slot: u32) -> Books {
    let lower = times(Held(conserved[slot], energy[slot], covered_species(slot)), cell_volume());
    return Books(lower, Held(owed_flow[slot], owed_energy[slot], owed_species(slot)));
}

fn keep_books(slot: u32, books: Books) {
    conserved[slot] = books.lower.flow / cell_volume();
    energy[slot] = books.lower.energy / cell_volume();
    hold_species(slot, books.lower.species / cell_volume());
    owed_flow[slot] = books.upper.flow;
    owed_energy[slot] = books.upper.energy;
    owe_species(slot, books.upper.species);
}

// Sorts what a SOLID slot holds after the step before by sides. All belongs to the side where there was gas, if that is one.
fn sort_by_sides(slot: u32) {
    let turned = is_turned(slot, true);
    var faces = vec2u(0u);
    var upper: Held;
    for (var face = 0u; face < faces_of(slot); face++) {
        let a = face / 2u;
        let up = (face & 1u) == 1u;
        let other = select(slot - step_of(a), slot + step_of(a), up);
        if previous_kind_of(cells[other]) != GAS { continue; }
        let here = side_of(slot, turned, a, up);
        faces += vec2u(u32(here == LOWER), u32(here == UPPER));
        if here == UPPER { upper = sum_of_held(upper, passed(slot, other, a, up)); }
    }
    let books = kept_books(slot);
    if faces.x > 0u && faces.y > 0u {
        keep_books(slot, Books(sum_of_held(books.lower, times(upper, -1.0)), sum_of_held(books.upper, upper)));
    } else if faces.x > 0u || faces.y > 0u {
        keep_books(slot, on_one_side(sum_of_held(books.lower, books.upper), faces.y > 0u));
    }
}

// What a SOLID slot holds, by the sides that it has now. The gas of a cell that has just been covered belongs where there is most gas beside
// it, or else ahead.
fn books_of(slot: u32, flags: u32) -> Books {
    let books = kept_books(slot);
    if previous_kind_of(cells[slot]) != GAS {
        if (flags & SWAPPED) == 0u { return books; }
        return Books(books.upper, books.lower);
    }
    let turned = (flags & TURNED) != 0u;
    var faces = vec2u(0u);
    for (var face = 0u; face < faces_of(slot); face++) {
        let a = face / 2u;
        let up = (face & 1u) == 1u;
        let there = cells[select(slot - step_of(a), slot + step_of(a), up)];
        if kind_of(there) != GAS || previous_kind_of(there) != GAS { continue; }
        let here = side_of(slot, turned, a, up);
        faces += vec2u(u32(here == LOWER), u32(here == UPPER));
    }
    return on_one_side(sum_of_held(books.lower, books.upper), faces.y > faces.x || (faces.x == faces.y && !turned));
}

// What `receivers` of a SOLID slot says: nobody; or else its GAS neighbours on that side, the SOLID ones in that direction which are at the
// surface, or all that are SOLID there get what it hands on; FROM_UPPER if that is of its upper side; TURNED if its upper side is behind;
// SWAPPED if that was not so in the step before.
const TO_NOBODY = 0u;
const TO_GAS = 1u;
const TO_SURFACE = 2u;
const TO_SOLID = 3u;
const FROM_UPPER = 4u;
const TURNED = 8u;
const SWAPPED = 16u;

// What goes to each of the receivers.
struct Handed { flow: vec4f, energy: f32, species: vec2f, receivers: u32 }

// Whether a face is one through which a side hands on: to gas also along the motion, and all faces where there is none.
fn serves(slot: u32, receivers: u32, a: u32, up: bool, kind: u32) -> bool {
    let here = side_of(slot, (receivers & TURNED) != 0u, a, up);
    return here == select(LOWER, UPPER, (receivers & FROM_UPPER) != 0u) || (here == ALONG && (kind == GAS || is_still_body(slot)));
}

// Whether a SOLID cell can get what a SOLID slot hands on: one beside gas hands on only to what is covered ahead of it.
fn follows(slot: u32, other: u32) -> bool { return !at_surface(slot) || previous_kind_of(cells[other]) == GAS; }

// GAS neighbours that a side of a slot has, SOLID ones at the surface, and all that are SOLID.
fn counts_beside(slot: u32, receivers: u32) -> vec3f {
    var sum = vec3f(0.0);
    for (var face = 0u; face < faces_of(slot); face++) {
        let a = face / 2u;
        let other = select(slot - step_of(a), slot + step_of(a), (face & 1u) == 1u);
        let kind = kind_of(cells[other]);
        if !serves(slot, receivers, a, (face & 1u) == 1u, kind) || (kind == SOLID && !follows(slot, other)) { continue; }
        sum += vec3f(f32(kind == GAS), f32(kind == SOLID && at_surface(other)), f32(kind == SOLID));
    }
    return sum;
}

// Mean density of the GAS neighbours of a side.
fn density_beside(slot: u32, receivers: u32) -> f32 {
    var sum = vec2f(0.0);
    for (var face = 0u; face < faces_of(slot); face++) {
        let a = face / 2u;
        let other = select(slot - step_of(a), slot + step_of(a), (face & 1u) == 1u);
        if kind_of(cells[other]) != GAS || !serves(slot, receivers, a, (face & 1u) == 1u, GAS) { continue; }
        sum += vec2f(1.0, conserved[other].x);
    }
    return sum.y / max(sum.x, 1.0);
}

// What belongs to one of the sides.
fn hold_of(books: Books, upper: bool) -> Held {
    if upper { return books.upper; }
    return books.lower;
}

// What the side of a slot that `receivers` names hands on.
fn handed_of(slot: u32, held: Held, receivers: u32) -> Handed {
    var out = Handed(vec4f(0.0), 0.0, vec2f(0.0), receivers);
    if is_nothing(held) { return out; }
    let counts = counts_beside(slot, receivers);
    var each = 0.0;
    var whom = TO_NOBODY;
    if counts.x > 0.0 {
        let part = 1.0 - HELD_AT_SURFACE * density_beside(slot, receivers) * cell_volume() / max(abs(held.flow.x), 1e-30);
        each = max(part, 0.0) / counts.x;
        whom = TO_GAS;
    } else if counts.z > 0.0 {
        each = 1.0 / select(counts.z, counts.y, counts.y > 0.0);
        whom = select(TO_SOLID, TO_SURFACE, counts.y > 0.0);
    }
    if each == 0.0 { return out; }
    return Handed(each * held.flow, each * held.energy, each * held.species, receivers + whom);
}

// One side a step: the one that has no gas any more, else the one that hands on more.
fn handed_by_solid(slot: u32) -> Handed {
    // Loops over what is now and before, over both sides: else the compiler sees the same twice.
    var turned = vec2<bool>(false);
    for (var k = 0u; k < min(faces_of(slot), 2u); k++) { turned = vec2<bool>(is_turned(slot, k == 0u), turned.x); }
    let flags = select(0u, TURNED, turned.x) + select(0u, SWAPPED, turned.x != turned.y);
    let books = books_of(slot, flags);
    var lower: Handed;
    var upper: Handed;
    for (var k = 0u; k < min(faces_of(slot), 2u); k++) {
        lower = upper;
        upper = handed_of(slot, hold_of(books, k == 1u), flags + k * FROM_UPPER);
    }
    let lower_stays = (lower.receivers & 3u) <= TO_GAS;
    let upper_stays = (upper.receivers & 3u) <= TO_GAS;
    let more = abs(upper.flow.x) > abs(lower.flow.x);
    if select(more, lower_stays, lower_stays != upper_stays) { return upper; }
    return lower;
}
