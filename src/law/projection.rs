//! The augmented traction's projection on the friction cone (paper (22), (24); docs/formulation 4.3):
//!
//! - gap:   sigma_N >= 0 or uncovered:         p = 0
//! - stick: |sigma_T| < k (1 - tie):           p = sigma_N nu + sigma_T
//! - slip:  otherwise:                         p = sigma_N nu + beta sigma_T, beta = k / |sigma_T|
//!
//! with a threshold k(sigma_N), Coulomb's being -mu sigma_N, and its derivative H = dp/dsigma. sigma = lambda + r g is a stress; nu points
//! into the non-mortar body, so sigma_N < 0 is compression.

use crate::geometry::{Mat3, Vec3};

/// A trial traction within this of the cone (relative) slips. Every step starts with slip nodes exactly
/// on the cone; left to rounding, their state and the iteration count would depend on the units.
pub const TIE: f64 = 1e-12;

/// What a non-mortar node does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(i32)]
pub enum State {
    /// Open or uncovered: no traction.
    #[default]
    Gap = 0,
    /// Closed, no slip in this step.
    Stick = 1,
    /// Closed, the traction is on the cone.
    Slip = 2,
}

/// A projected traction with its derivative.
#[derive(Clone, Copy, Debug)]
pub struct Projected {
    /// Gap, stick or slip.
    pub state: State,
    /// p [F/L^2].
    pub traction: Vec3,
    /// Its tangential part.
    pub tangential: Vec3,
    /// H = dp/dsigma [-].
    pub derivative: Mat3,
}

impl Projected {
    /// No traction.
    pub fn gap() -> Projected {
        let zero = Vec3::zeros();
        Projected { state: State::Gap, traction: zero, tangential: zero, derivative: Mat3::zeros() }
    }
}

/// Euclidean norm that neither underflows nor overflows before its result does.
pub(super) fn safe_norm(v: Vec3) -> f64 {
    let largest = v.amax();
    if largest == 0.0 { 0.0 } else { (v / largest).norm() * largest }
}

/// Which tangential tractions stick at a normal traction sigma_N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// k: they are shorter than this [F/L^2].
    pub radius: f64,
    /// -dk / dsigma_N [-].
    pub fall: f64,
}

impl Threshold {
    /// Coulomb's cone: k = -mu sigma_N.
    pub fn cone(mu: f64, sigma_n: f64) -> Threshold {
        Threshold { radius: -mu * sigma_n, fall: mu }
    }

    /// The same up to a limit, which decides from where the cone reaches it on.
    pub fn up_to(limit: f64, mu: f64, sigma_n: f64) -> Threshold {
        let cone = Threshold::cone(mu, sigma_n);
        if cone.radius < limit { cone } else { Threshold { radius: limit, fall: 0.0 } }
    }
}

/// Projects the augmented traction `sigma` of a covered node with unit normal `normal` and friction
/// coefficient `mu` >= 0.
pub fn project(sigma: Vec3, normal: Vec3, mu: f64) -> Projected {
    let sigma_n = sigma.dot(&normal);
    project_parts(sigma_n, sigma - normal * sigma_n, normal, Threshold::cone(mu, sigma_n))
}

/// The same of sigma_N nu + sigma_T. A caller that has both need not take them apart again: on the closed cone
/// (mu = 0) p then has no rounding of what slips.
pub fn project_parts(sigma_n: f64, sigma_t: Vec3, normal: Vec3, k: Threshold) -> Projected {
    if sigma_n >= 0.0 {
        return Projected::gap();
    }
    let size = safe_norm(sigma_t);
    if size < k.radius * (1.0 - TIE) {
        let traction = normal * sigma_n + sigma_t;
        return Projected { state: State::Stick, traction, tangential: sigma_t, derivative: Mat3::identity() };
    }
    // On a closed cone (mu = 0) there is no direction and no tangential part. Never above 1: within
    // the tie the trial traction may lie just inside.
    let (beta, direction) =
        if size > 0.0 { ((k.radius / size).min(1.0), sigma_t / size) } else { (0.0, Vec3::zeros()) };
    let nn = normal * normal.transpose();
    let tangential = Mat3::identity() - nn - direction * direction.transpose();
    Projected {
        state: State::Slip,
        traction: normal * sigma_n + sigma_t * beta,
        tangential: sigma_t * beta,
        derivative: nn - direction * normal.transpose() * k.fall + tangential * beta,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::DualSVec64;

    /// Rounding of a handful of operations.
    const ROUNDING: f64 = 1e-13;

    /// The formulas once more, on any real number type: an oracle for H by dual numbers.
    fn oracle<T: nalgebra::RealField + Copy>(
        sigma: nalgebra::Vector3<T>,
        normal: Vec3,
        mu: f64,
    ) -> nalgebra::Vector3<T> {
        let nu = normal.map(|v| T::from_f64(v).unwrap());
        let sigma_n = sigma.dot(&nu);
        let sigma_t = sigma - nu * sigma_n;
        let k = -sigma_n * T::from_f64(mu).unwrap();
        let size = sigma_t.norm();
        if sigma_n >= T::zero() {
            nalgebra::Vector3::zeros()
        } else if size < k {
            sigma
        } else {
            nu * sigma_n + sigma_t * (k / size)
        }
    }

    #[test]
    fn derivative_equals_dual_numbers_in_every_state() {
        let normal = Vec3::new(0.6, 0.0, 0.8);
        let cases = [
            (Vec3::new(1.0, 2.0, 3.0), 0.5, State::Gap),
            (Vec3::new(-6.0, 0.4, -8.0), 0.5, State::Stick),
            (Vec3::new(-6.0, 9.0, -8.0), 0.5, State::Slip),
            (Vec3::new(-6.0, 9.0, -8.0), 0.0, State::Slip),
            (Vec3::new(-6.0, 9e5, -8.0), 1e6, State::Stick),
        ];
        for (sigma, mu, state) in cases {
            let p = project(sigma, normal, mu);
            assert_eq!(p.state, state);
            let (value, jacobian) =
                num_dual::jacobian(|s: nalgebra::Vector3<DualSVec64<3>>| oracle(s, normal, mu), &sigma);
            assert!((value - p.traction).amax() <= ROUNDING * sigma.amax());
            assert!((jacobian - p.derivative).amax() <= ROUNDING, "{state:?}");
        }
    }

    #[test]
    fn continuous_across_both_borders() {
        let normal = Vec3::z();
        let eps = 1e-9;
        for (inside, outside) in [
            (Vec3::new(0.3, 0.0, -eps), Vec3::new(0.3, 0.0, eps)),
            (Vec3::new(0.5 - eps, 0.0, -1.0), Vec3::new(0.5 + eps, 0.0, -1.0)),
        ] {
            let (a, b) = (project(inside, normal, 0.5), project(outside, normal, 0.5));
            assert_ne!(a.state, b.state);
            assert!((a.traction - b.traction).amax() <= 3.0 * eps);
        }
    }

    #[test]
    fn a_trial_traction_on_the_cone_slips() {
        for (relative, state) in [(0.0, State::Slip), (-1e-13, State::Slip), (-1e-10, State::Stick)] {
            let sigma = Vec3::new(0.5 * (1.0 + relative), 0.0, -1.0);
            assert_eq!(project(sigma, Vec3::z(), 0.5).state, state);
        }
        assert_eq!(project(Vec3::zeros(), Vec3::z(), 0.5).state, State::Gap);
    }

    #[test]
    fn tiny_and_huge_tractions_project_alike() {
        for scale in [1e-180, 1e-300, 1.0, 1e150] {
            let p = project(Vec3::new(3.0, 4.0, -1.0) * scale, Vec3::z(), 0.5);
            assert_eq!(p.state, State::Slip);
            assert!((p.traction / scale - Vec3::new(0.3, 0.4, -1.0)).amax() < ROUNDING);
        }
    }
}
