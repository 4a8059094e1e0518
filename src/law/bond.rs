//! A bond between the surfaces (adhesion, glue, a cohesive zone): traction against opening and slip, up to a strength and down again to
//! nothing, which does not come back (docs/formulation 20.2). With delta = delta_n nu + delta_t, beta the shear strength over that in
//! tension and delta_e = sqrt(max(0, delta_n)^2 + beta^2 |delta_t|^2)
//!
//! T = (1 - D) K (max(0, delta_n) nu + beta^2 delta_t),   D = D(kappa), kappa the largest delta_e so far:
//!
//! without damage up to strength / K, none left at 2 toughness / strength, along a straight line in between.

use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};

/// A bond by what it bears and what it takes to part it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bond {
    /// K: traction an opening, without damage [F/L^3].
    pub stiffness: f64,
    /// The largest traction in tension [F/L^2].
    pub strength: f64,
    /// G_c: work that parts an area, in any mode [F/L].
    pub toughness: f64,
    /// beta: the largest shear traction over the strength [-].
    pub shear: f64,
}

/// Numbers that it remembers of a node: kappa, and delta_t.
pub const BOND_STATES: usize = 4;

/// Where a bond is asked.
#[derive(Clone, Copy, Debug)]
pub struct Parted {
    /// nu.
    pub normal: Vec3,
    /// delta_n `[L]`.
    pub opening: f64,
    /// delta_t `[L]`.
    pub slip: Vec3,
    /// kappa at t_n `[L]`.
    pub largest: f64,
}

/// What it bears there, with derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Borne {
    /// T [F/L^2].
    pub traction: Vec3,
    /// dT / d delta_n [F/L^3].
    pub by_opening: Vec3,
    /// dT / d delta_t.
    pub by_slip: Mat3,
    /// dT / dnu at fixed delta_n and delta_t [F/L^2].
    pub by_normal: f64,
    /// kappa if the step ended here `[L]`.
    pub largest: f64,
}

impl Bond {
    /// Refuses numbers outside their range.
    pub fn validate(&self) -> Result<()> {
        let all = [
            ("bond_stiffness", self.stiffness),
            ("bond_strength", self.strength),
            ("bond_toughness", self.toughness),
            ("bond_shear", self.shear),
        ];
        for (name, v) in all {
            if !(v > 0.0 && v.is_finite()) {
                let kind = if v.is_finite() { Kind::InvalidValue } else { Kind::NotFinite };
                return Err(Error::new(kind, text!("layer.{name} is {v}; with a bond it must be positive and finite")));
            }
        }
        if !(self.last() > self.first()) {
            let text = text!(
                "layer.bond_toughness is {}; with this strength and stiffness it must be above {}, the work that is stored where damage begins",
                self.toughness,
                0.5 * self.strength * self.first()
            );
            return Err(Error::new(Kind::InvalidValue, text));
        }
        Ok(())
    }

    /// delta_e where damage begins.
    pub fn first(&self) -> f64 {
        self.strength / self.stiffness
    }

    /// delta_e from which on nothing is left.
    pub fn last(&self) -> f64 {
        2.0 * self.toughness / self.strength
    }

    /// D at a kappa, and dD / dkappa.
    pub fn damage(&self, kappa: f64) -> (f64, f64) {
        let (first, last) = (self.first(), self.last());
        if kappa <= first {
            (0.0, 0.0)
        } else if kappa >= last {
            (1.0, 0.0)
        } else {
            let share = last / (last - first);
            (share * (1.0 - first / kappa), share * first / (kappa * kappa))
        }
    }

    /// Work that has been lost an area, up to a kappa [F/L].
    pub fn lost(&self, kappa: f64) -> f64 {
        let (first, last) = (self.first(), self.last());
        0.5 * self.strength * last * ((kappa - first) / (last - first)).clamp(0.0, 1.0)
    }

    /// T.
    pub fn at(&self, at: &Parted) -> Borne {
        let (open, square) = (at.opening.max(0.0), self.shear * self.shear);
        let effective = (open * open + square * at.slip.norm_squared()).sqrt();
        let largest = effective.max(at.largest);
        let (damage, slope) = self.damage(largest);
        let secant = self.stiffness * (1.0 - damage);
        let parted = at.normal * open + at.slip * square;
        let is_open = if at.opening >= 0.0 { 1.0 } else { 0.0 };
        let mut borne = Borne {
            traction: parted * secant,
            by_opening: at.normal * (secant * is_open),
            by_slip: Mat3::identity() * (secant * square),
            by_normal: secant * open,
            largest,
        };
        if effective > at.largest && slope > 0.0 {
            let fall = -self.stiffness * slope / effective;
            borne.by_opening += parted * (fall * open);
            borne.by_slip += parted * at.slip.transpose() * (fall * square);
        }
        borne
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOND: Bond = Bond { stiffness: 100.0, strength: 2.0, toughness: 0.3, shear: 0.7 };
    /// Central differences with a step of 1e-7 of tractions near 1 and slopes near 100.
    const DIFFERENCES: f64 = 1e-6;
    /// Rounding of some thousand sums of numbers near 1.
    const ROUNDING: f64 = 1e-12;

    fn at(opening: f64, slip: Vec3, largest: f64) -> Parted {
        Parted { normal: Vec3::z(), opening, slip, largest }
    }

    #[test]
    fn derivatives_equal_differences_along_every_branch() {
        const STEP: f64 = 1e-7;
        let slip = Vec3::new(0.03, -0.05, 0.0);
        for (opening, slip, largest) in [
            (0.005, slip * 0.1, 0.0),
            (0.05, slip, 0.0),
            (0.05, slip, 0.2),
            (-0.05, slip, 0.0),
            (0.4, slip, 0.0),
            (0.01, slip * 0.0, 0.0),
        ] {
            let k = BOND.at(&at(opening, slip, largest));
            let value = |opening: f64, slip: Vec3| BOND.at(&at(opening, slip, largest)).traction;
            let by_opening = (value(opening + STEP, slip) - value(opening - STEP, slip)) / (2.0 * STEP);
            assert!((by_opening - k.by_opening).amax() <= DIFFERENCES, "{by_opening} {}", k.by_opening);
            for i in 0..3 {
                let step = Vec3::ith(i, STEP);
                let by_slip = (value(opening, slip + step) - value(opening, slip - step)) / (2.0 * STEP);
                assert!((by_slip - k.by_slip.column(i)).amax() <= DIFFERENCES, "{opening} {by_slip}");
            }
        }
    }

    /// The work of T along straight pieces of (delta_n, delta_t), kappa remembered from point to point; piece by piece a rule that is
    /// exact where T is linear, and fine.
    fn work(path: &[(f64, f64)]) -> (f64, f64) {
        const PIECES: usize = 200_000;
        let (mut kappa, mut work) = (0.0, 0.0);
        let point = |k: usize, s: f64| {
            let ((a, b), (c, d)) = (path[k], path[k + 1]);
            (a + s * (c - a), b + s * (d - b))
        };
        for k in 0..path.len() - 1 {
            let mut before = point(k, 0.0);
            for n in 1..=PIECES {
                let now = point(k, n as f64 / PIECES as f64);
                let middle = (0.5 * (before.0 + now.0), 0.5 * (before.1 + now.1));
                let borne = BOND.at(&at(middle.0, Vec3::x() * middle.1, kappa));
                work += borne.traction.z * (now.0 - before.0) + borne.traction.x * (now.1 - before.1);
                kappa = BOND.at(&at(now.0, Vec3::x() * now.1, kappa)).largest;
                before = now;
            }
        }
        (work, kappa)
    }

    /// The midpoint's rule over 200 000 pieces, at the two kinks of the law and where mode changes.
    const RULE: f64 = 1e-8;

    #[test]
    fn parting_takes_the_toughness_in_any_mode_and_on_any_monotonic_path() {
        for path in [
            &[(0.0, 0.0), (0.5, 0.0)][..],
            &[(0.0, 0.0), (0.0, 0.6)],
            &[(0.0, 0.0), (0.4, 0.5)],
            &[(0.0, 0.0), (0.1, 0.0), (0.1, 0.6)],
            &[(0.0, 0.0), (0.0, 0.2), (0.5, 0.2)],
            &[(0.0, 0.0), (0.05, 0.1), (0.1, 0.1), (0.1, 0.3), (0.4, 0.3)],
        ] {
            let (work, kappa) = work(path);
            assert!((work - BOND.toughness).abs() <= RULE, "{path:?}: {work}");
            assert_eq!(BOND.damage(kappa).0, 1.0);
        }
    }

    #[test]
    fn cycles_go_along_the_secant_and_heal_nothing() {
        let there = [(0.0, 0.0), (0.1, 0.05)];
        let (once, kappa) = work(&there);
        let (thrice, again) = work(&[(0.0, 0.0), (0.1, 0.05), (0.0, 0.0), (0.1, 0.05), (-0.1, 0.0), (0.1, 0.05)]);
        assert!((kappa - again).abs() <= ROUNDING && (once - thrice).abs() <= RULE, "{once} {thrice}");
        let half = BOND.at(&at(0.05, Vec3::x() * 0.025, kappa)).traction;
        let whole = BOND.at(&at(0.1, Vec3::x() * 0.05, kappa)).traction;
        assert!((whole - half * 2.0).amax() <= ROUNDING);
        let stored = 0.5 * (whole.z * 0.1 + whole.x * 0.05);
        assert!((once - stored - BOND.lost(kappa)).abs() <= RULE, "{once} {stored}");
    }

    #[test]
    fn the_strengths_are_borne_and_no_more() {
        let most = |opening: f64, slip: f64| {
            (0..=4000).map(|n| f64::from(n) / 4000.0).fold((0.0_f64, 0.0_f64), |most, s| {
                let t = BOND.at(&at(opening * s, Vec3::x() * (slip * s), 0.0)).traction;
                (most.0.max(t.z), most.1.max(t.x))
            })
        };
        assert!((most(0.08, 0.0).0 - BOND.strength).abs() <= ROUNDING);
        assert!((most(0.0, 0.08 / BOND.shear).1 - BOND.strength * BOND.shear).abs() <= ROUNDING);
    }

    #[test]
    fn what_is_no_bond_is_refused() {
        for bond in [
            Bond { stiffness: 0.0, ..BOND },
            Bond { strength: -1.0, ..BOND },
            Bond { shear: f64::NAN, ..BOND },
            Bond { toughness: 0.02, ..BOND },
        ] {
            assert!(bond.validate().is_err(), "{bond:?}");
        }
        assert!(BOND.validate().is_ok());
    }
}
