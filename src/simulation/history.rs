//! What the device recorded of the latest steps, as the host reads it.

use super::Simulation;
use super::recorded::Recorded;
use crate::diagnostics::{Load, PointRecord, StepRecord};
use crate::error::Result;
use crate::gpu::{Buffer, Pass, readback};
use crate::state::constants::HISTORY_WIDTH;
use crate::state::gauges::GAUGE_WIDTH;
use crate::state::loads::LOAD_WIDTH;
use crate::state::{HISTORY, State};

/// The history rings.
struct Rings {
    steps: Vec<[f32; 4]>,
    probes: Vec<[f32; 4]>,
    loads: Vec<[f32; 4]>,
    points: Vec<[f32; 4]>,
}

impl Rings {
    /// The record of a step, without its time and its sums.
    fn record(&self, number: u64, state: &State) -> StepRecord {
        let slot = (number % u64::from(HISTORY)) as usize;
        let part = |ring: &[[f32; 4]], width: usize| ring[slot * width..(slot + 1) * width].to_vec();
        let (grid, start) = (&state.grid, &state.gauges.start);
        let loads = LOAD_WIDTH * state.load_count.iter().sum::<usize>();
        StepRecord {
            probes: StepRecord::probes_from_raw(&part(&self.probes, 2 * state.params.probes as usize)),
            loads: Load::from_raw(&part(&self.loads, loads), grid.origin),
            points: PointRecord::from_raw(&part(&self.points, GAUGE_WIDTH as usize * start.len()), start, grid),
            ..StepRecord::from_raw(&part(&self.steps, HISTORY_WIDTH as usize))
        }
    }
}

impl Simulation {
    /// Kernels of all dispatches of a recording, in order, with so many iterations of each solve; none of them is run.
    #[doc(hidden)]
    pub fn launches(&mut self, iterations: u32) -> Vec<String> {
        let recorded = Recorded { iterations, ..self.recorded };
        let before = std::mem::replace(&mut self.recorded, recorded);
        let mut pass = Pass::new(&self.gpu, "counted");
        self.record_step(&mut pass);
        self.record_totals(&mut pass);
        self.recorded = before;
        pass.launches().iter().map(|name| name.to_string()).collect()
    }

    /// Sums, loads, gauges and maps of the step.
    pub(super) fn record_totals(&self, pass: &mut Pass) {
        self.totals.record(pass, &self.state);
        if let Some(dust) = &self.dust {
            dust.record_totals(pass, &self.state);
        }
        if let Some(loads) = &self.loads {
            loads.record(pass, &self.state);
        }
        if let Some(gauges) = &self.gauges {
            gauges.record(pass, &self.state);
        }
        if let Some(maps) = &self.maps {
            maps.record(pass, &self.state);
        }
    }

    /// Records of the steps since the last reading.
    pub(super) fn read_history(&mut self, step: u64, records: &mut Vec<StepRecord>) -> Result<()> {
        if step == self.step {
            return Ok(());
        }
        let (gpu, state) = (&self.gpu, &self.state);
        let read = |ring: &Buffer<[f32; 4]>| readback::read(gpu, ring);
        let rings = Rings {
            steps: read(&state.history)?,
            probes: read(&state.probe_history)?,
            loads: read(&state.load_history)?,
            points: read(&state.gauges.history)?,
        };
        let mut time = self.time;
        for number in self.step..step {
            let mut record = rings.record(number, &self.state);
            time += f64::from(record.dt);
            record.time = time;
            record.add_up(&mut self.given);
            record.given.mass = self.released.mass as f32;
            self.pull(&record);
            self.bear(&record);
            records.push(record);
        }
        Ok(())
    }
}
