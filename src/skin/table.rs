//! What there is between two bodies: friction of its own, or no contact at all.

use crate::error::{Error, Kind, Result};
use crate::memory::Store;

/// What there is between two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Between {
    /// Contact with this coefficient of friction.
    Friction(f64),
    /// They do not see each other.
    Nothing,
}

/// Pairs of bodies that are not as the rest.
#[derive(Debug, Default)]
pub struct Table {
    rows: Vec<([usize; 2], Between)>,
}

impl Table {
    /// Says what there is between two bodies, or within one; the last word counts.
    pub fn set(&mut self, bodies: [usize; 2], between: Between) -> Result<()> {
        if let Between::Friction(mu) = between {
            let kind = if mu.is_finite() { Kind::InvalidValue } else { Kind::NotFinite };
            if kind == Kind::NotFinite || mu < 0.0 {
                return Err(Error::new(kind, text!("mu is {mu}; it must be finite and not negative")));
            }
        }
        let key = sorted(bodies);
        match self.rows.iter_mut().find(|row| row.0 == key) {
            Some(row) => row.1 = between,
            None => self.rows.store((key, between))?,
        }
        Ok(())
    }

    /// Goes back to what was said before the last word.
    pub fn put_back(&mut self, bodies: [usize; 2], before: Option<Between>) {
        let key = sorted(bodies);
        match before {
            Some(before) => self.rows.iter_mut().filter(|row| row.0 == key).for_each(|row| row.1 = before),
            None => self.rows.retain(|row| row.0 != key),
        }
    }

    /// What was said of two bodies.
    pub fn between(&self, bodies: [usize; 2]) -> Option<Between> {
        let key = sorted(bodies);
        self.rows.iter().find(|row| row.0 == key).map(|row| row.1)
    }

    /// The pairs that do not see each other.
    pub fn apart(&self) -> impl Iterator<Item = [usize; 2]> {
        self.rows.iter().filter(|row| row.1 == Between::Nothing).map(|row| row.0)
    }

    /// Whether they do not see each other.
    pub fn excludes(&self, bodies: [usize; 2]) -> bool {
        self.between(bodies) == Some(Between::Nothing)
    }
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_two_bodies_is_of_no_account_and_the_last_word_counts() {
        let mut table = Table::default();
        table.set([2, 1], Between::Nothing).unwrap();
        assert!(table.excludes([1, 2]) && table.excludes([2, 1]) && !table.excludes([1, 1]));
        table.set([1, 2], Between::Friction(0.5)).unwrap();
        assert_eq!((table.between([2, 1]), table.between([0, 1])), (Some(Between::Friction(0.5)), None));
        let mut refused = |mu| table.set([0, 0], Between::Friction(mu)).unwrap_err();
        assert!(refused(-1.0).message.contains("mu is -1"));
        assert_eq!((refused(-1.0).kind, refused(f64::NAN).kind), (Kind::InvalidValue, Kind::NotFinite));
    }
}
