//! Looking at an interface: read only.

pub mod adjust;
pub mod bytes;
pub mod closing;
pub mod describe;
pub mod diagnosis;
pub mod equilibrium;
pub mod largest;
pub mod mistakes;
pub mod overlap;
pub mod report;
pub mod why;
