//! How far a node is from the contact conditions, in lengths and tractions that vanish in equilibrium (docs/formulation
//! 4.7). Nothing of it knows the augmentation, which decides how Newton's method gets there.
//!
//! With gbar = g_N / m, the mean gap over the covered area m, s = g_T / m(t_n), the slip, and the law's threshold k at
//! lambda_N (Coulomb: -mu lambda_N, 0 under tension), a node may be read in these ways:
//!
//! | read as | gap            | traction                               | slip                  |
//! |---------|----------------|----------------------------------------|-----------------------|
//! | gap     | max(0, -gbar)  | |lambda|                               | 0                     |
//! | stick   | |gbar|         | max(0, lambda_N, |lambda_T| - k)       | |s|                   |
//! | slip    | |gbar|         | max(0, lambda_N, | |lambda_T| - k | )   | |s - max(0, s . t) t| |
//! | or      | |gbar|         | max(0, lambda_N, |lambda_T - k s/|s||) | 0                     |
//!
//! with t = lambda_T / |lambda_T|: slip goes along the traction, and the traction along the slip. What is astray may be
//! either; after a long slide the traction. In equilibrium one reading is zero. Elsewhere the nearest one counts: that
//! whose entries have the least sum, lengths being made tractions by a stiffness [F/L^3]. So a node near a border
//! between states is not taken for one far from it.

use crate::geometry::Vec3;

/// What a node lacks to equilibrium, each >= 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Violation {
    /// Penetration, or opening under pressure `[L]`.
    pub gap: f64,
    /// Traction that the law does not allow: tension, beyond the cone, where open, in a prescribed direction [F/L^2].
    pub traction: f64,
    /// Slip where it sticks, against or across the traction `[L]`.
    pub slip: f64,
}

/// What a node's lengths and tractions are measured by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measure {
    /// Covered area now [L^2].
    pub coverage: f64,
    /// Covered area at t_n [L^2].
    pub coverage_previous: f64,
    /// A length times this is a traction [F/L^3].
    pub stiffness: f64,
    /// What rounding makes of a length that is zero: does not count `[L]`.
    pub rounding: f64,
    /// The same of a traction [F/L^2].
    pub traction_rounding: f64,
}

/// A covered node under a cone, in lengths and tractions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Covered {
    /// gbar.
    pub gap: f64,
    /// s.
    pub slip: Vec3,
    /// lambda_N.
    pub normal: f64,
    /// lambda_T.
    pub tangential: Vec3,
    /// What lambda has in prescribed directions.
    pub held: f64,
    /// k at lambda_N: longer tangential tractions slip; infinite: none does.
    pub radius: f64,
}

impl Violation {
    /// Of an uncovered node, whose multiplier of this size must vanish.
    pub fn uncovered(lambda: f64, measure: &Measure) -> Violation {
        Violation { traction: lambda, ..Violation::default() }.beyond_rounding(measure)
    }

    /// Of a node whose equation lacks a gap of this size.
    pub fn of_gap(gap: f64, measure: &Measure) -> Violation {
        Violation { gap, ..Violation::default() }.beyond_rounding(measure)
    }

    /// Of equations alone, without an inequality.
    pub(super) fn of(gap: f64, slip: f64, held: f64, measure: &Measure) -> Violation {
        Violation { gap, traction: held, slip }.beyond_rounding(measure)
    }

    fn beyond_rounding(self, measure: &Measure) -> Violation {
        Violation {
            gap: (self.gap - measure.rounding).max(0.0),
            traction: (self.traction - measure.traction_rounding).max(0.0),
            slip: (self.slip - measure.rounding).max(0.0),
        }
    }

    /// All of it as a traction.
    fn size(&self, stiffness: f64) -> f64 {
        self.traction + stiffness * (self.gap + self.slip)
    }
}

impl Covered {
    /// The nearest reading; of equal ones the first.
    pub fn nearest(&self, measure: &Measure) -> Violation {
        let gap = self.gap.abs();
        let (tangential, slip) = (self.tangential.norm(), self.slip.norm());
        let tension = self.normal.max(self.held);
        let (cone, rough) = (self.radius, self.radius.is_infinite());
        // Without a cone any slip is free.
        let astray = if tangential > 0.0 && cone > 0.0 {
            let direction = self.tangential / tangential;
            (self.slip - direction * self.slip.dot(&direction).max(0.0)).norm()
        } else {
            0.0
        };
        let off = if rough { 0.0 } else { (self.tangential - self.slip * (cone / slip)).norm() };
        let open = self.normal.hypot(tangential).max(self.held);
        let readings = [
            Violation { gap: (-self.gap).max(0.0), traction: open, slip: 0.0 },
            Violation { gap, traction: tension.max(tangential - cone).max(0.0), slip },
            Violation { gap, traction: tension.max((tangential - cone).abs()).max(0.0), slip: astray },
            Violation { gap, traction: tension.max(off).max(0.0), slip: 0.0 },
        ];
        let count = match (rough, slip > 0.0) {
            (true, _) => 2,
            (false, false) => 3,
            (false, true) => 4,
        };
        let mut nearest = readings[0].beyond_rounding(measure);
        for reading in &readings[1..count] {
            let reading = reading.beyond_rounding(measure);
            if reading.size(measure.stiffness) < nearest.size(measure.stiffness) {
                nearest = reading;
            }
        }
        nearest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEASURE: Measure =
        Measure { coverage: 1.0, coverage_previous: 1.0, stiffness: 10.0, rounding: 0.0, traction_rounding: 0.0 };

    fn node() -> Covered {
        let (slip, tangential) = (Vec3::zeros(), Vec3::zeros());
        Covered { gap: 0.0, slip, normal: -2.0, tangential, held: 0.0, radius: 1.0 }
    }

    fn found(node: Covered) -> (f64, f64, f64) {
        let v = node.nearest(&MEASURE);
        (v.gap, v.traction, v.slip)
    }

    #[test]
    fn nothing_is_amiss_in_each_state() {
        let states = [
            Covered { gap: 3.0, normal: 0.0, radius: 0.0, slip: Vec3::x(), ..node() },
            Covered { tangential: Vec3::x() * 0.7, ..node() },
            Covered { tangential: Vec3::x(), slip: Vec3::x() * 0.2, ..node() },
            Covered { slip: Vec3::x(), radius: 0.0, ..node() },
            Covered { tangential: Vec3::x() * 9.0, radius: f64::INFINITY, ..node() },
            Covered { normal: 0.0, radius: 0.0, ..node() },
        ];
        for state in states {
            assert_eq!(found(state), (0.0, 0.0, 0.0), "{state:?}");
        }
    }

    #[test]
    fn each_condition_by_itself() {
        assert_eq!(found(Covered { gap: -0.01, ..node() }), (0.01, 0.0, 0.0));
        assert_eq!(found(Covered { gap: 0.01, ..node() }), (0.01, 0.0, 0.0));
        assert_eq!(
            found(Covered { gap: 9.0, normal: -0.01, radius: 0.005, ..node() }),
            (0.0, 0.01, 0.0),
            "the nearer is open"
        );
        assert_eq!(
            found(Covered { gap: -1.0, normal: 0.0, radius: 0.0, ..node() }),
            (1.0, 0.0, 0.0),
            "no pressure in a penetration"
        );
        assert_eq!(found(Covered { normal: 0.3, radius: 0.0, ..node() }), (0.0, 0.3, 0.0), "tension");
        assert_eq!(found(Covered { tangential: Vec3::y() * 1.5, ..node() }), (0.0, 0.5, 0.0), "beyond the cone");
        assert_eq!(found(Covered { slip: Vec3::x() * 0.01, ..node() }), (0.0, 0.0, 0.01), "slip where it sticks");
        assert_eq!(found(Covered { held: 0.2, ..node() }), (0.0, 0.2, 0.0));
        let on_the_cone = Covered { tangential: Vec3::x(), ..node() };
        assert_eq!(found(Covered { slip: Vec3::x() * -0.1, ..on_the_cone }), (0.0, 0.0, 0.1), "slip against");
        assert_eq!(found(Covered { slip: Vec3::new(0.02, 0.03, 0.0), ..on_the_cone }).2, 0.03, "slip across");
        let far = found(Covered { slip: Vec3::new(20.0, 0.02, 0.0), ..on_the_cone });
        assert!(
            far.2 == 0.0 && (far.1 - 1e-3).abs() < 1e-8,
            "a long slide, and the traction not quite along it: {far:?}"
        );
        let inside = Covered { tangential: Vec3::x() * 0.75, slip: Vec3::x() * 0.25, ..node() };
        assert_eq!(found(inside), (0.0, 0.25, 0.0), "far slip a little inside of the cone");
        assert_eq!(
            found(Covered { tangential: Vec3::x() * 0.5, radius: 0.0, ..node() }),
            (0.0, 0.5, 0.0),
            "no friction"
        );
        assert_eq!(found(Covered { slip: Vec3::x() * 0.1, radius: f64::INFINITY, ..node() }), (0.0, 0.0, 0.1), "rough");
    }

    #[test]
    fn noise_of_a_grazing_node_has_no_direction() {
        let grazing =
            Covered { normal: -1e-15, radius: 5e-16, tangential: Vec3::x() * 5e-16, slip: Vec3::x() * -0.1, ..node() };
        let v = grazing.nearest(&MEASURE);
        assert!(v.gap == 0.0 && v.slip == 0.0 && v.traction < 2e-15, "{v:?}");
    }

    #[test]
    fn rounding_does_not_count() {
        let measure = Measure { rounding: 1e-15, traction_rounding: 1e-14, ..MEASURE };
        let noisy = Covered { gap: -1e-15, slip: Vec3::x() * 1e-15, held: 1e-14, ..node() };
        assert_eq!(noisy.nearest(&measure), Violation::default());
        assert_eq!(Violation::uncovered(1e-14, &measure), Violation::default());
        assert_eq!(Violation::uncovered(0.5, &MEASURE).traction, 0.5);
    }
}
