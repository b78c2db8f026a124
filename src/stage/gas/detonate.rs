//! `detonate`: energy for the gas in a ball. No part of a step: it runs between two of them, when the user asks.

use bytemuck::{Pod, Zeroable};

use crate::error::{Error, Result};
use crate::gpu::{Bound, Buffer, Extent, Gpu, Pass, readback};
use crate::state::State;
use crate::structure::structure;
use crate::structure::types::vec3f;

structure! {
    /// A ball of gas to heat.
    #[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
    pub(crate) Ball as "Blast" {
        /// Its middle, in cells from the low corner of the domain.
        center: vec3f,
        /// In cells.
        radius: f32,
        /// Energy per volume \[J m^-3\].
        rise: f32,
        /// Fills the last 16 bytes.
        unused: [f32; 3],
    }
}

/// Kernels of a blast.
#[derive(Debug)]
pub struct Detonate {
    ball: Buffer<Ball>,
    volume: Bound,
    heat: Bound,
}

impl Detonate {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let gpu = &state.gpu;
        let ball = Buffer::uniform(gpu, "blast", 1)?;
        let bind = |entry: &str| state.bind("gas/detonate.wgsl", entry, &[("blast", ball.raw())], &[]);
        let (volume, heat) = (bind("detonate_volume")?, bind("detonate_heat")?);
        Ok(Self { ball, volume, heat })
    }

    /// Gives an energy \[J\] to the gas whose cell centres lie within `radius` of a point \[m\], evenly over its volume, and returns the
    /// energy as rounded to what the device adds.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no gas within the radius; driver errors.
    pub fn run(&self, gpu: &Gpu, state: &State, center: [f64; 3], radius: f64, energy: f64) -> Result<f64> {
        let (grid, params) = (&state.grid, &state.params);
        let spacing = f64::from(grid.spacing);
        let mut ball = Ball {
            center: std::array::from_fn(|axis| ((center[axis] - grid.low()[axis]) / spacing) as f32),
            radius: (radius / spacing) as f32,
            ..Ball::default()
        };
        self.ball.write(gpu, 0, &[ball]);
        let mut pass = Pass::new(gpu, "detonate");
        pass.dispatch(&self.volume, &Extent::Groups([params.groups, 1, 1]));
        pass.submit()?;
        let shares = readback::read_range(gpu, &state.partials, 0, params.groups as usize)?;
        let cells: f64 = shares.iter().map(|share| f64::from(share[0])).sum();
        if cells <= 0.0 {
            return Err(Error::Usage(format!(
                "there is no gas within {radius:.3e} m of that point; choose another point or a larger radius \
                 (a cell is {spacing:.3e} m wide)"
            )));
        }
        let volume = cells * spacing.powi(grid.dimension as i32);
        ball.rise = (energy / volume) as f32;
        self.ball.write(gpu, 0, &[ball]);
        let mut pass = Pass::new(gpu, "detonate");
        pass.dispatch(&self.heat, &Extent::Threads(u64::from(params.slots)));
        pass.submit()?;
        Ok(f64::from(ball.rise) * volume)
    }
}
