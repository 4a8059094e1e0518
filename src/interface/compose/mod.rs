//! What goes with what: one table of features (`feature.rs`) that do not go together (`table.rs`). It decides, and its sentences are
//! the refusals. Plain data: it knows no interface. docs/compose.md is made of it.
//!
//! What depends on numbers and not on features (a negative mu, two nodes with an equation in common) is refused where it is read.

mod feature;
mod sentence;
mod table;

pub use feature::{About, FEATURES, Feature, Features};
pub use table::{ROWS, Row, Verdict};

use crate::error::{Error, Kind, Result};

/// The first row that an interface with these features meets; `None`: they go together.
pub fn verdict(has: Features) -> Option<&'static Row> {
    ROWS.iter().find(|row| has.have(row.all()))
}

/// Refuses features that do not go together.
///
/// # Errors
/// [`Kind::Unsupported`], with the sentence of the table's row.
#[inline(never)]
pub fn refuse(has: Features) -> Result<()> {
    verdict(has).map_or(Ok(()), |row| Err(Error::new(Kind::Unsupported, row.sentence())))
}
