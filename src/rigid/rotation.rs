//! The rotation of a body by a rotation vector, and how its spin depends on that vector (docs/formulation 14.1, 14.2).

use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use nalgebra::Matrix3;

/// Terms of a series in the square of an angle of at most 1: what is left out is below 1e-19.
const TERMS: i32 = 9;
/// How far R^T R of a host's rotation may be from I: a thousand times the rounding of a million products, and far below what a
/// gap would show.
const ORTHOGONAL: f64 = 1e-8;

/// `[v]`: `[v]` w = v x w.
pub fn cross(v: &Vec3) -> Matrix3<f64> {
    v.cross_matrix()
}

/// (sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3) of an angle t.
fn factors(angle: f64) -> [f64; 3] {
    let half = 0.5 * angle;
    let sinc = |t: f64| if t == 0.0 { 1.0 } else { t.sin() / t };
    let third = if angle > 1.0 {
        (angle - angle.sin()) / angle.powi(3)
    } else {
        // 1 / 3! - t^2 / 5! + ..., from the smallest term on
        let factor = |k: i32| angle * angle / f64::from((2 * k + 4) * (2 * k + 5));
        (0..TERMS).rev().fold(1.0, |rest, k| 1.0 - factor(k) * rest) / 6.0
    };
    [sinc(angle), 0.5 * sinc(half) * sinc(half), third]
}

/// exp `[theta]`, the rotation about theta by its length (R2).
pub fn rotation(theta: &Vec3) -> Matrix3<f64> {
    let ([a, b, _], w) = (factors(theta.norm()), cross(theta));
    Matrix3::identity() + w * a + w * w * b
}

/// H: where the rotation vector changes by d theta, the body turns by the small rotation H d theta (R3).
pub fn spin(theta: &Vec3) -> Matrix3<f64> {
    let ([_, b, c], w) = (factors(theta.norm()), cross(theta));
    Matrix3::identity() + w * b + w * w * c
}

/// exp `[theta]` R, and what rounding takes from its orthogonality put back.
pub fn turned(theta: &Vec3, r: &Matrix3<f64>) -> Matrix3<f64> {
    let r = rotation(theta) * r;
    r * (Matrix3::identity() * 3.0 - r.transpose() * r) * 0.5
}

/// Refuses what is no rotation.
pub fn check_rotation(r: &Matrix3<f64>, name: &str) -> Result<()> {
    let off = (r.transpose() * r - Matrix3::identity()).amax();
    if off <= ORTHOGONAL && r.determinant() > 0.0 {
        return Ok(());
    }
    let text = text!(
        "{name} is no rotation: R^T R differs from I by {off:.1e} (at most {ORTHOGONAL:.0e}), det R is {:.3}; rows of a rotation, or zeros alone, are allowed",
        r.determinant()
    );
    Err(Error::new(Kind::InvalidValue, text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const EXACT: f64 = 1e-15;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let r = rotation(&Vec3::new(0.0, 0.0, 0.5 * PI));
        assert!((r * Vec3::x() - Vec3::y()).amax() < EXACT);
    }

    #[test]
    fn rotations_are_orthogonal_and_the_spin_is_their_derivative() {
        for length in [0.0, 1e-9, 1e-3, 0.3, 0.999_999, 1.000_001, 2.0, 3.1] {
            let theta = Vec3::new(0.36, -0.48, 0.8) * length;
            let r = rotation(&theta);
            assert!((r.transpose() * r - Matrix3::identity()).amax() < 4.0 * EXACT, "{length}");
            for j in 0..3 {
                // Five points: what is left out goes with h^4.
                let h = 1e-3;
                let at = |k: f64| rotation(&(theta + Vec3::ith(j, k * h)));
                let d = (at(-2.0) - at(2.0) + (at(1.0) - at(-1.0)) * 8.0) / (12.0 * h);
                let expected = cross(&spin(&theta).column(j).into_owned()) * r;
                assert!((d - expected).amax() < 1e-12, "{length} {j}: {}", (d - expected).amax());
            }
        }
    }

    #[test]
    fn the_series_and_the_closed_form_meet() {
        let [below, above] = [1.0, 1.0 + 1e-15].map(|t| factors(t)[2]);
        assert!((below - above).abs() < 4.0 * EXACT);
    }

    #[test]
    fn many_turns_stay_a_rotation() {
        let theta = Vec3::new(0.3, 0.2, -0.4);
        let r = (0..10_000).fold(Matrix3::identity(), |r, _| turned(&theta, &r));
        assert!(check_rotation(&r, "r").is_ok());
        assert!((r.transpose() * r - Matrix3::identity()).amax() < 10.0 * EXACT);
    }

    #[test]
    fn what_is_no_rotation_is_refused() {
        for r in [Matrix3::identity() * 1.001, -Matrix3::identity(), Matrix3::zeros()] {
            assert_eq!(check_rotation(&r, "r").unwrap_err().kind, Kind::InvalidValue);
        }
    }
}
