//! What happens to the gas alone.

mod carrier;
mod detonate;
mod dust;
mod fluid_update;
mod gas_advection;
mod intermediate_pressure;
mod odd_even;
mod still;

pub use carrier::{Carried, CarrierVelocity};
pub(super) use detonate::Ball;
pub use detonate::Detonate;
pub use dust::Dust;
pub use fluid_update::FluidUpdate;
pub use gas_advection::GasAdvection;
pub use intermediate_pressure::IntermediatePressure;
pub(super) use intermediate_pressure::open_sides;
pub use odd_even::OddEven;
pub use still::Still;
