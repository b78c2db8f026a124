// In which order does a sum over many elements take its terms? From this order follow its last bits.
// Neighbouring lanes take neighbouring elements: each octet of lanes its own octets of elements, the first one by its number, the next ones
// as many further as there are octets of lanes. The elements stand in rows; the last octet of a row may be partly empty.

struct Octet {
    at: vec2u,      // its number in the row, and the number of the row
    step: vec2u,    // from one to the next
    across: u32,    // octets of a row
}

// The first octet of a thread, of so many groups of threads; `row`: elements of a row.
fn first_octet(thread: u32, groups: u32, row: u32) -> Octet {
    let across = (row + OCTET - 1u) / OCTET;
    let own = thread / OCTET;
    let all = groups * (WORKGROUP / OCTET);
    return Octet(vec2u(own % across, own / across), vec2u(all % across, all / across), across);
}

fn next_octet(octet: Octet) -> Octet {
    var at = octet.at + octet.step;
    if at.x >= octet.across { at = vec2u(at.x - octet.across, at.y + 1u); }
    return Octet(at, octet.step, octet.across);
}

// Element of a thread's lane, or `none`.
fn element_in(octet: Octet, thread: u32, row: u32, none: u32) -> u32 {
    let place = OCTET * octet.at.x + thread % OCTET;
    return select(none, row * octet.at.y + place, place < row);
}
