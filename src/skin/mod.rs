//! General contact: the skin of all bodies in one piece, which may touch each other and themselves (docs/formulation 19).
//!
//! A layer above the interface handle, of which it knows the calls and the search alone. [`Whole`] is what the host hands over,
//! cut at creases. At a commit `near` finds which facets may touch, `roles` gives each of them a side, `pieces` cuts what
//! hangs together, and each piece is an interface. [`Skin`] owns them and calls them all.

mod evaluation;
mod handle;
mod history;
mod missed;
mod near;
mod piece;
mod pieces;
mod roles;
mod step;
mod table;
mod whole;

pub use evaluation::{OfCopy, SkinResidual};
pub use handle::{Counts, Skin};
pub use near::Near;
pub use roles::Role;

pub use table::{Between, Table};
pub use whole::{Given, Whole};
