//! `interface`: where do gas and solid meet, and what happens to the gas of cells that a body covers or uncovers?
//! [Cao et al. 2022, section 2.3]

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::numerics::Scan;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct InterfaceStage {
    flags: Bound,
    /// Over the flags of the extra list, then over those of the slots that come first in the list.
    scan: Scan,
    edge: Bound,
    edge_scan: Scan,
    list: Bound,
    solids: Option<Solids>,
}

#[derive(Debug)]
struct Solids {
    /// Where obstacles cut cells.
    whole: Option<Bound>,
    fill: Bound,
    walls: Bound,
    kind: Bound,
    /// And `edge`.
    extra: Bound,
    start: Bound,
    ledger: [Bound; 3],
}

impl InterfaceStage {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let gpu = &state.gpu;
        let mark = |entry: &str| state.bind("interface/interface_mark.wgsl", entry, &[], &[]);
        let scan = |counts: &str, places: &str| {
            let (slots, [counts, places]) = (state.params.slots, [counts, places].map(|name| state.lent(name)));
            Scan::over(gpu, counts, places, slots, slots + 1)
        };
        let fill = |entry: &str| state.bind("interface/interface.wgsl", entry, &[], &[]);
        let ledger = |entry: &str| state.bind("interface/ledger.wgsl", entry, &[], &[]);
        let solids = if state.has_solids() {
            let whole = |entry: &str| state.bind("interface/whole_cells.wgsl", entry, &[], &[]);
            Some(Solids {
                whole: state.cuts().then(|| whole("interface_whole")).transpose()?,
                fill: fill("interface_fill")?,
                walls: mark("interface_walls")?,
                kind: mark("interface_kind")?,
                extra: mark("interface_extra")?,
                start: ledger("ledger_start")?,
                ledger: [ledger("ledger_uncover")?, ledger("ledger_share")?, ledger("ledger_settle")?],
            })
        } else {
            None
        };
        Ok(Self {
            flags: mark("interface_flags")?,
            scan: scan("wanted", "wanted_place")?,
            edge: mark("interface_edge")?,
            edge_scan: scan("edge", "edge_place")?,
            list: mark("interface_list")?,
            solids,
        })
    }

    /// Marks the start: without bodies these marks stay; with bodies the cells they cover lose their gas.
    pub fn record_start(&self, pass: &mut Pass, state: &State) {
        if let Some(solids) = &self.solids {
            let kinds = [&solids.fill, &solids.walls, &solids.kind, &solids.start];
            for kernel in solids.whole.iter().chain(kinds) {
                pass.dispatch(kernel, &state.extent(Phase::Begin, Over::Slots));
            }
        }
        pass.dispatch(&self.flags, &state.extent(Phase::Begin, Over::Slots));
        pass.dispatch(&self.edge, &state.extent(Phase::Begin, Over::Slots));
        self.record_list(pass, state);
    }

    /// The list that follows from what is marked.
    fn record_list(&self, pass: &mut Pass, state: &State) {
        for scan in [&self.edge_scan, &self.scan] {
            scan.record_with(pass, &state.scan_extents(Phase::Begin));
        }
        pass.dispatch(&self.list, &state.extent(Phase::Begin, Over::Slots));
    }

    /// Marks all slots and settles the ledger of covered gas. Without bodies nothing changes.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        let Some(solids) = &self.solids else { return };
        pass.stage(Stage::Interface.name());
        for kernel in solids.whole.iter().chain([&solids.fill, &solids.walls, &solids.kind]) {
            pass.dispatch(kernel, &state.extent(Phase::Begin, Over::Slots));
        }
        pass.dispatch(&self.flags, &state.extent(Phase::Begin, Over::Slots));
        self.scan.record_with(pass, &state.scan_extents(Phase::Begin));
        pass.dispatch(&solids.extra, &state.extent(Phase::Begin, Over::Slots));
        self.record_list(pass, state);
        for kernel in &solids.ledger {
            pass.dispatch(kernel, &state.extent(Phase::Begin, Over::Slots));
        }
    }
}
