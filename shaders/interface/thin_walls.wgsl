// Walls about one cell thick, from the solid volume of cells: `fill`, `cells` and `wanted` are those of interface_mark.wgsl.

// What makes two cells side by side a thin wall, in volumes at which a cell is full: what they hold together, and how much more than the two
// cells beyond them. A wall of one cell may lie in two rows and fill neither; a heap of fragments has no empty cells beside it.
const WALL_HOLDS = 1.4;
const WALL_STANDS_OUT = 0.8;
// Beside the wall's row, along the surface of a body, there is this little.
const WALL_ENDS = 0.7;
// The fuller of the two is solid, both where they differ by less than this share of a cell; but then one that was solid alone stays so.
const WALL_TIES = 0.1;
// A cell that closes the corner of a wall holds more than this.
const WALL_CORNER = 0.1;

// Whether a body may end there: nothing does at the sides of the domain or at obstacles.
fn is_free(c: vec3i) -> bool { return inside(c) && kind_of(cells[slot_of(c)]) != WALL; }

// Whether the pair is the edge of a body's surface, not a wall: beside both, along any other axis, are full cells, and nothing on the other side.
fn is_edge_of_body(c: vec3i, n: vec3i, along: u32) -> bool {
    for (var a = 0u; a < DIM; a++) {
        if a == along { continue; }
        for (var side = -1; side <= 1; side += 2) {
            let least = min(fill_at(c + side * axis(a)), fill_at(n + side * axis(a)));
            let other = fill_at(c - side * axis(a)) + fill_at(n - side * axis(a));
            if least > full_volume() && other < WALL_ENDS * full_volume() && is_free(c - side * axis(a)) { return true; }
        }
    }
    return false;
}

// Volume of the thinnest wall that the cell, not full, is the solid part of: the cell and one beside it; 0: of none.
fn thin_wall(c: vec3i, slot: u32) -> f32 {
    var found = 0.0;
    let own = fill[slot].x;
    let was = kind_of(cells[slot]) == SOLID;
    for (var a = 0u; a < DIM; a++) {
        for (var side = -1; side <= 1; side += 2) {
            let n = c + side * axis(a);
            let next = fill_at(n);
            let volume = own + next;
            let beyond = fill_at(c - side * axis(a)) + fill_at(n + side * axis(a));
            let stands = volume >= WALL_HOLDS * full_volume() && volume - beyond >= WALL_STANDS_OUT * full_volume();
            if !stands || next > full_volume() + WALL_TIES * cell_volume() { continue; }
            let ties = abs(own - next) <= WALL_TIES * cell_volume() && (was || kind_of(cells[slot_of(n)]) != SOLID);
            if (ties || own > next + WALL_TIES * cell_volume()) && !is_edge_of_body(c, n, a) { found = max(found, volume); }
        }
    }
    return found;
}

fn closed_volume(c: vec3i) -> f32 {
    if !inside(c) { return 0.0; }
    return bitcast<f32>(wanted[slot_of(c)]);
}

// Least closed volume of the cells beside c towards an offset.
fn closed_beside(c: vec3i, o: vec3i) -> f32 {
    var least = 1e30;
    for (var a = 0u; a < DIM; a++) {
        if o[a] != 0 { least = min(least, closed_volume(c + o * axis(a))); }
    }
    return least;
}

// Volume of a wall that parts this cell from one across a corner, where gas of both sides would meet at a vertex and have one pressure;
// 0: none. The fuller of the two closes the corner, both where they are about as full.
fn corner_of_wall(c: vec3i, slot: u32) -> f32 {
    var found = 0.0;
    for (var k = 0u; k < block_size(); k++) {
        let o = block_offset(k);
        let across = c + o;
        if abs(o.x) + abs(o.y) + abs(o.z) < 2 || closed_volume(across) > 0.0 || !is_free(across) { continue; }
        if fill[slot].x >= fill_at(across) - WALL_TIES * cell_volume() {
            found = max(found, max(closed_beside(c, o), closed_beside(across, -o)));
        }
    }
    return found;
}
