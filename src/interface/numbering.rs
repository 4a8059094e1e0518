//! The host's equation numbers: every multiplier is an unknown of its own.

use super::{NO_EQUATION, Surface};
use crate::error::{Error, Kind, Result};

/// Refuses a multiplier whose equation is that of a displacement, of either side, or of another multiplier: both rows would
/// be added up. (Displacements may share theirs, as copies of a node on a crease do.)
pub(super) fn check<const N: usize>(multipliers: &[[i64; N]], sides: [&Surface; 2]) -> Result<()> {
    let named = |name: &'static str, equations: &[i64]| {
        let numbered = equations.iter().enumerate().filter(|(_, e)| **e != NO_EQUATION);
        numbered.map(|(k, &e)| (e, name, k)).collect::<Vec<_>>()
    };
    let mut taken = named("nonmortar.multiplier_equations", multipliers.as_flattened());
    let first_displacement = taken.len();
    taken.extend(named("nonmortar.equations", sides[0].equations.as_flattened()));
    taken.extend(named("mortar.equations", sides[1].equations.as_flattened()));
    let mut order: Vec<usize> = (0..taken.len()).collect();
    order.sort_unstable_by_key(|&i| (taken[i].0, i)); // of equal ones the multiplier comes first
    let twice = order.windows(2).find(|pair| taken[pair[0]].0 == taken[pair[1]].0 && pair[0] < first_displacement);
    let Some(&[one, other]) = twice else { return Ok(()) };
    let ((_, name, k), (_, other, j)) = (taken[one], taken[other]);
    let text = format!("{name}[{k}] and {other}[{j}] are the same equation; each multiplier needs one of its own");
    Err(Error::new(Kind::InvalidValue, text))
}
