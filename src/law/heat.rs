//! Heat through one non-mortar node (docs/formulation 17): what passes from the non-mortar to the mortar body per area,
//!
//! q_A = h J_A / W_A,   h = h0 f(P / p0) + (h1 + kg / (g + g0)) b(g / reach),
//!
//! with the weighted temperature jump J_A, the covered area W_A, the pressure P and the mean gap g = g_A / W_A; and the heat of
//! friction D_A / dt, which is split between the bodies.
//!
//! f is a power; below [`FEW`] a parabola of third degree in its place begins with slope 0, so that h is smooth where contact
//! begins. b is 1, and falls over the last tenth of the reach to 0 with slopes 0 at both ends. Below g = 0 kg / (g + g0) goes on
//! along its tangent.

use crate::error::{Error, Kind, Result};

/// P / p0 below which f is no power: a thousandth.
pub const FEW: f64 = 1e-3;
/// Where b begins to fall, over the reach.
pub const FADES: f64 = 0.9;
/// Exponents above which f would not grow everywhere below [`FEW`].
const MOST: f64 = 2.0;

/// How heat passes, and where that of friction goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductance {
    /// h0 [F/(L T K)]: at the pressure p0.
    pub contact: f64,
    /// p0 > 0 [F/L^2].
    pub pressure: f64,
    /// The exponent of P / p0 [-].
    pub exponent: f64,
    /// h1 [F/(L T K)]: at any pressure, within reach.
    pub constant: f64,
    /// kg [F/(T K)]: conductivity of what fills the gap.
    pub gas: f64,
    /// g0 > 0 `[L]`: what the gap of surfaces that touch counts.
    pub gas_gap: f64,
    /// Gaps from which on neither h1 nor kg pass anything `[L]`.
    pub reach: f64,
    /// The share of the heat of friction that goes into the non-mortar body [-].
    pub share: f64,
    /// The time dt that the step takes \[T\]; 0: friction makes no heat.
    pub time: f64,
}

/// A value with its derivatives.
type WithSlopes<const N: usize> = (f64, [f64; N]);

impl Conductance {
    /// Refuses what is no conductance; `name`: of the struct.
    pub fn check(&self, name: &str) -> Result<()> {
        let c = self;
        let all = [
            (c.contact, "contact", f64::INFINITY),
            (c.pressure, "pressure", f64::INFINITY),
            (c.exponent, "exponent", MOST),
            (c.constant, "constant", f64::INFINITY),
            (c.gas, "gas", f64::INFINITY),
            (c.gas_gap, "gas_gap", f64::INFINITY),
            (c.reach, "reach", f64::INFINITY),
            (c.share, "share", 1.0),
            (c.time, "time", f64::INFINITY),
        ];
        for (v, member, most) in all {
            if !v.is_finite() {
                return Err(Error::new(Kind::NotFinite, text!("{name}.{member} is {v}; it must be finite")));
            }
            if !(v >= 0.0 && v <= most) {
                let text = text!("{name}.{member} is {v}; it must not be negative, nor above {most}");
                return Err(Error::new(Kind::InvalidValue, text));
            }
        }
        let missing = [
            (c.contact > 0.0 && !(c.pressure > 0.0), "pressure", "contact"),
            (c.contact > 0.0 && !(c.exponent > 0.0), "exponent", "contact"),
            (c.gas > 0.0 && !(c.gas_gap > 0.0), "gas_gap", "gas"),
            (c.gas > 0.0 && !(c.reach > 0.0), "reach", "gas"),
            (c.constant > 0.0 && !(c.reach > 0.0), "reach", "constant"),
        ];
        match missing.iter().find(|(is, ..)| *is) {
            None => Ok(()),
            Some((_, member, other)) => {
                let text = text!("{name}.{member} is 0; with {other} above 0 it must be above 0, too");
                Err(Error::new(Kind::InvalidValue, text))
            }
        }
    }

    /// h [F/(L T K)] at a pressure and a mean gap, and its derivatives by both.
    pub fn at(&self, pressure: f64, gap: f64) -> WithSlopes<2> {
        let (mut h, mut slopes) = (0.0, [0.0; 2]);
        if self.contact > 0.0 {
            let (f, df) = power(pressure / self.pressure, self.exponent);
            h += self.contact * f;
            slopes[0] = self.contact * df / self.pressure;
        }
        if (self.constant > 0.0 || self.gas > 0.0) && gap < self.reach {
            let (mut v, mut dv) = (self.constant, 0.0);
            if self.gas > 0.0 {
                let open = self.gas / (gap.max(0.0) + self.gas_gap);
                dv = -open / (gap.max(0.0) + self.gas_gap);
                v += open + dv * gap.min(0.0);
            }
            let (b, db) = fading(gap / self.reach);
            h += v * b;
            slopes[1] = dv * b + v * db / self.reach;
        }
        (h, slopes)
    }
}

/// f and its derivative.
fn power(x: f64, exponent: f64) -> (f64, f64) {
    if x <= 0.0 {
        return (0.0, 0.0);
    }
    if x >= FEW {
        let f = x.powf(exponent);
        return (f, exponent * f / x);
    }
    // s^2 (3 - e) + s^3 (e - 2) times the value at FEW: value and slope of the power there, none at 0.
    let (s, at) = (x / FEW, FEW.powf(exponent));
    let (two, three) = (3.0 - exponent, exponent - 2.0);
    (at * s * s * (two + three * s), at * s * (2.0 * two + 3.0 * three * s) / FEW)
}

/// b and its derivative.
fn fading(x: f64) -> (f64, f64) {
    let s = (x - FADES) / (1.0 - FADES);
    if s <= 0.0 {
        (1.0, 0.0)
    } else if s >= 1.0 {
        (0.0, 0.0)
    } else {
        ((1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s), -6.0 * s * (1.0 - s) / (1.0 - FADES))
    }
}

/// A node, as heat sees it.
#[derive(Clone, Copy, Debug, Default)]
pub struct HeatNode {
    /// J_A = sum_B n_AB T_B - sum_C n_AC T_C [K L^2].
    pub jump: f64,
    /// P >= 0 [F/L^2].
    pub pressure: f64,
    /// g_A, normal [L^3].
    pub gap: f64,
    /// W_A = sum_B n_AB > 0 [L^2].
    pub area: f64,
    /// D_A: the work of friction in the step [F L].
    pub work: f64,
}

/// What passes through a node.
#[derive(Clone, Copy, Debug, Default)]
pub struct HeatFlow {
    /// h [F/(L T K)].
    pub conductance: f64,
    /// q_A [F/(L T)], from the non-mortar to the mortar body.
    pub flux: f64,
    /// What leaves the non-mortar body and what enters the mortar one, friction's heat included [F/(L T)].
    pub sides: [f64; 2],
    /// Their derivatives by the node's numbers, in their order.
    pub slopes: [[f64; 5]; 2],
}

/// The law of a node that is covered.
pub fn heat_flow(c: &Conductance, node: &HeatNode) -> HeatFlow {
    let (area, gap) = (node.area, node.gap / node.area);
    let (h, [dp, dg]) = c.at(node.pressure, gap);
    let jump = node.jump / area;
    let flux = h * jump;
    let by = [h / area, dp * jump, dg * jump / area, -(h + dg * gap) * jump / area, 0.0];
    let mut flow = HeatFlow { conductance: h, flux, sides: [flux; 2], slopes: [by; 2] };
    if c.time > 0.0 {
        let per = 1.0 / (c.time * area);
        for (side, share) in [-c.share, 1.0 - c.share].into_iter().enumerate() {
            flow.sides[side] += share * node.work * per;
            flow.slopes[side][3] -= share * node.work * per / area;
            flow.slopes[side][4] = share * per;
        }
    }
    flow
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences of functions of size 1 with steps of 1e-6: their rounding, 1e-16 / 1e-6.
    const DIFFERENCES: f64 = 1e-8;
    const STEP: f64 = 1e-6;

    fn some() -> Conductance {
        Conductance {
            contact: 2.0,
            pressure: 3.0,
            exponent: 0.95,
            constant: 0.3,
            gas: 0.4,
            gas_gap: 0.5,
            reach: 2.0,
            share: 0.3,
            time: 0.25,
        }
    }

    #[test]
    fn slopes_equal_differences() {
        let c = some();
        for work in [0.0, 0.7] {
            for gap in [-0.4, -0.01, 0.3, 1.0, 1.3, 1.35, 1.39, 1.5] {
                for pressure in [0.0, 1e-3, 0.5, 4.0] {
                    let of = [0.8, pressure, gap, 0.7, work];
                    let node = |v: [f64; 5]| HeatNode { jump: v[0], pressure: v[1], gap: v[2], area: v[3], work: v[4] };
                    let flow = heat_flow(&c, &node(of));
                    for k in 0..5 {
                        // A thousandth of p0 is where small pressures matter.
                        let step = if k == 1 { STEP * 1e-3 } else { STEP };
                        let at = |sign: f64| {
                            let mut v = of;
                            v[k] += sign * step;
                            heat_flow(&c, &node(v)).sides
                        };
                        let (more, less) = (at(1.0), at(-1.0));
                        for side in 0..2 {
                            let d = (more[side] - less[side]) / (2.0 * step);
                            let bound = if k == 1 { 1e3 * DIFFERENCES } else { 10.0 * DIFFERENCES };
                            let error = (d - flow.slopes[side][k]).abs();
                            assert!(error <= bound, "{k} {side} {gap} {pressure}: {d:e} {error:e}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn it_is_smooth_where_its_formulas_change() {
        let c = some();
        let there = [(c.pressure * FEW, 0.0), (0.0, 0.0), (1.0, FADES * c.reach), (1.0, c.reach)];
        for (pressure, gap) in there {
            let near = |sign: f64| c.at(pressure + sign * 1e-12, gap + sign * 1e-12);
            let ((h, d), (k, e)) = (near(1.0), near(-1.0));
            assert!((h - k).abs() <= 1e-9, "{h} {k}");
            assert!((0..2).all(|i| (d[i] - e[i]).abs() <= 1e-6 * (1.0 + d[i].abs())), "{d:?} {e:?}");
        }
    }

    #[test]
    fn the_power_is_exact_above_a_thousandth_and_both_sides_share_what_friction_makes() {
        let c = Conductance { constant: 0.0, gas: 0.0, ..some() };
        assert_eq!(c.at(6.0, 0.0).0, 2.0 * 2.0_f64.powf(0.95));
        let flow = heat_flow(&c, &HeatNode { jump: 0.1, pressure: 6.0, gap: 0.0, area: 0.5, work: 2.0 });
        let made = (flow.sides[1] - flow.sides[0]) * 0.5 * c.time;
        assert!((made - 2.0).abs() <= 1e-15);
    }

    #[test]
    fn what_is_no_conductance_is_refused() {
        let refused = |c: Conductance| c.check("c").unwrap_err().message.to_string();
        assert!(some().check("c").is_ok());
        assert!(refused(Conductance { contact: f64::NAN, ..some() }).contains("contact"));
        assert!(refused(Conductance { share: 1.5, ..some() }).contains("share"));
        assert!(refused(Conductance { pressure: 0.0, ..some() }).contains("pressure"));
        assert!(refused(Conductance { reach: 0.0, ..some() }).contains("reach"));
        assert!(refused(Conductance { gas_gap: 0.0, ..some() }).contains("gas_gap"));
        assert!(refused(Conductance { exponent: 3.0, ..some() }).contains("exponent"));
    }
}
