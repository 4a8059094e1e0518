//! The host's equation numbers: every multiplier is an unknown of its own.

use super::surface::{NO_EQUATION, Surface};
use crate::error::{Error, Kind, Result};
use crate::memory::{self, Store, Stored};

/// Refuses a multiplier whose equation is that of a displacement, of either side, or of another multiplier: both rows would
/// be added up. (Displacements may share theirs, as copies of a node on a crease do.)
pub fn check<const N: usize>(multipliers: &[[i64; N]], sides: [&Surface; 2]) -> Result<()> {
    fn named<'a>(name: &'a str, equations: &'a [i64]) -> impl Iterator<Item = (i64, &'a str, usize)> {
        let numbered = equations.iter().enumerate().filter(|(_, e)| **e != NO_EQUATION);
        numbered.map(move |(k, &e)| (e, name, k))
    }
    let mut taken = named("nonmortar.multiplier_equations", multipliers.as_flattened()).stored()?;
    let first_displacement = taken.len();
    taken.store_all(named("nonmortar.equations", sides[0].equations.as_flattened()))?;
    taken.store_all(named("mortar.equations", sides[1].equations.as_flattened()))?;
    let order = memory::order(taken.len(), &|i, j| taken[i].0.cmp(&taken[j].0))?; // of equal ones the multiplier comes first
    let twice = order.windows(2).find(|pair| taken[pair[0]].0 == taken[pair[1]].0 && pair[0] < first_displacement);
    let Some(&[one, other]) = twice else { return Ok(()) };
    let ((_, name, k), (_, other, j)) = (taken[one], taken[other]);
    let text = text!("{name}[{k}] and {other}[{j}] are the same equation; each multiplier needs one of its own");
    Err(Error::new(Kind::InvalidValue, text))
}
