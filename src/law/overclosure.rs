//! Pressure-overclosure: a layer that yields under pressure (coatings, asperities, gaskets), as a table of overclosures h and the
//! pressures P that they take, straight lines in between and beyond both ends (docs/formulation 20.1).

use crate::error::{Error, Kind, Result};
use crate::memory::{self, Store};

/// A point of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Squeeze {
    /// h: by how much the meshed surfaces overlap `[L]`; below 0 they are apart.
    pub overclosure: f64,
    /// P [F/L^2].
    pub pressure: f64,
}

/// The table.
#[derive(Debug, PartialEq)]
pub struct Overclosure {
    points: Vec<Squeeze>,
}

impl Overclosure {
    /// Of at least two points, the first without pressure; both numbers grow from one to the next.
    pub fn new(points: &[Squeeze]) -> Result<Overclosure> {
        if points.len() < 2 {
            let text = text!("layer.overclosure has {} points; it must have none, or at least 2", points.len());
            return Err(Error::new(Kind::InvalidSize, text));
        }
        for (k, point) in points.iter().enumerate() {
            for (name, v) in [("overclosure", point.overclosure), ("pressure", point.pressure)] {
                if !v.is_finite() {
                    return Err(Error::new(Kind::NotFinite, text!("layer.{name}[{k}] is {v}; it must be finite")));
                }
            }
        }
        if points[0].pressure != 0.0 {
            let text = text!("layer.pressure[0] is {}; it must be 0, where the pressure begins", points[0].pressure);
            return Err(Error::new(Kind::InvalidValue, text));
        }
        for (k, two) in points.windows(2).enumerate() {
            let steps = [
                ("overclosure", two[0].overclosure, two[1].overclosure),
                ("pressure", two[0].pressure, two[1].pressure),
            ];
            if let Some((name, a, b)) = steps.into_iter().find(|(_, a, b)| !(b > a)) {
                let text = text!("layer.{name}[{}] is {b}; it must be above the one before it, {a}", k + 1);
                return Err(Error::new(Kind::InvalidValue, text));
            }
        }
        let mut kept = memory::with_room(points.len())?;
        kept.store_all(points.iter().copied())?;
        Ok(Overclosure { points: kept })
    }

    /// h and dh / dP at a pressure.
    pub fn at(&self, pressure: f64) -> (f64, f64) {
        let above = self.points.partition_point(|point| point.pressure <= pressure);
        let k = above.clamp(1, self.points.len() - 1);
        let [a, b] = [self.points[k - 1], self.points[k]];
        let slope = (b.overclosure - a.overclosure) / (b.pressure - a.pressure);
        (a.overclosure + slope * (pressure - a.pressure), slope)
    }

    /// Where the pressure begins.
    pub fn first(&self) -> f64 {
        self.points[0].overclosure
    }

    /// The deepest point of the table.
    pub fn last(&self) -> f64 {
        self.points[self.points.len() - 1].overclosure
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(points: &[[f64; 2]]) -> Result<Overclosure> {
        let points: Vec<_> = points.iter().map(|&[overclosure, pressure]| Squeeze { overclosure, pressure }).collect();
        Overclosure::new(&points)
    }

    #[test]
    fn straight_lines_between_the_points_and_beyond() {
        let t = table(&[[-0.5, 0.0], [0.0, 2.0], [0.25, 6.0]]).unwrap();
        for (pressure, h, slope) in
            [(-2.0, -1.0, 0.25), (0.0, -0.5, 0.25), (1.0, -0.25, 0.25), (2.0, 0.0, 0.0625), (10.0, 0.5, 0.0625)]
        {
            assert_eq!(t.at(pressure), (h, slope), "{pressure}");
        }
        assert_eq!((t.first(), t.last()), (-0.5, 0.25));
    }

    #[test]
    fn what_is_no_table_is_refused() {
        for (points, kind) in [
            (&[[0.0, 0.0]][..], Kind::InvalidSize),
            (&[[0.0, 1.0], [1.0, 2.0]], Kind::InvalidValue),
            (&[[0.0, 0.0], [0.0, 2.0]], Kind::InvalidValue),
            (&[[0.0, 0.0], [1.0, 0.0]], Kind::InvalidValue),
            (&[[0.0, 0.0], [f64::NAN, 1.0]], Kind::NotFinite),
        ] {
            assert_eq!(table(points).unwrap_err().kind, kind, "{points:?}");
        }
    }
}
