//! How much of a facet is covered, and how facets that hardly are fade out (docs/formulation 10.5).

use crate::geometry::Vec3;
use crate::mortar::NonmortarFrame;
use crate::shape::MAX_CORNERS;

/// Shares of a facet's area between which it fades out. Below the first the condition of m_AB may be above 1e8 and
/// weights lose more than half of their digits; above the second nothing is changed.
pub const FADE_BAND: [f64; 2] = [1e-4, 1e-2];

/// The covered share of a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// kappa: covered area over the area of the projected facet.
    pub share: f64,
    /// phi(kappa), which multiplies the measure of the facet: 0 below the band, 1 above it.
    pub fade: f64,
    /// Dphi / Dkappa.
    pub slope: f64,
}

impl Coverage {
    /// That of a share.
    pub fn of(share: f64) -> Coverage {
        let [low, high] = FADE_BAND;
        let s = ((share - low) / (high - low)).clamp(0.0, 1.0);
        Coverage { share, fade: s * s * (3.0 - 2.0 * s), slope: 6.0 * s * (1.0 - s) / (high - low) }
    }
}

/// |e|, the area of the projected facet [L^2].
pub fn whole_area(frame: &NonmortarFrame) -> f64 {
    0.5 * frame.projection.area2
}

/// D|e| / Dx_k `[L]`. A tilt of the plane changes it in second order only, so what is left is the area of the polygon of
/// the y_k: Dy_k times half of the vector between the neighbours of node k.
pub fn whole_area_derivative(frame: &NonmortarFrame) -> [Vec3; MAX_CORNERS] {
    let (plane, facet) = (&frame.plane, &frame.projection);
    let mut d = [Vec3::zeros(); MAX_CORNERS];
    for k in 0..facet.shape.n {
        // From k to the one after the next: this edge vector belongs to the node between.
        let middle = facet.shape.next[k];
        let between = facet.y[facet.shape.next[middle]] - facet.y[k];
        d[middle] = (plane.t1 * between.y - plane.t2 * between.x) * 0.5;
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Facet;

    /// Central differences at 1e-6 of the size: rounding 1e-16 / 1e-6, truncation 1e-12.
    const STEP: f64 = 1e-6;
    const DIFFERENCES: f64 = 1e-9;

    #[test]
    fn fades_from_nothing_to_all_with_its_slope() {
        let [low, high] = FADE_BAND;
        assert_eq!(Coverage::of(low), Coverage { share: low, fade: 0.0, slope: 0.0 });
        assert_eq!(Coverage::of(1.0), Coverage { share: 1.0, fade: 1.0, slope: 0.0 });
        assert_eq!(Coverage::of(0.0).fade, 0.0);
        for s in [0.01, 0.3, 0.5, 0.9] {
            let (at, h) = (low + s * (high - low), STEP * (high - low));
            let difference = (Coverage::of(at + h).fade - Coverage::of(at - h).fade) / (2.0 * h);
            let slope = Coverage::of(at).slope;
            assert!((slope - difference).abs() <= DIFFERENCES / (high - low), "{slope} {difference}");
        }
    }

    #[test]
    fn the_areas_derivative_is_that_of_differences() {
        let x = [[0.1, 0.0, 0.05], [1.1, 0.2, -0.05], [0.9, 1.3, 0.1], [-0.2, 0.8, -0.1]].map(Vec3::from);
        for n in [3, 4] {
            let area = |x: &[Vec3]| whole_area(&NonmortarFrame::new(&Facet::new(&x[..n]).unwrap()).unwrap());
            let d = whole_area_derivative(&NonmortarFrame::new(&Facet::new(&x[..n]).unwrap()).unwrap());
            for (k, j) in (0..n).flat_map(|k| (0..3).map(move |j| (k, j))) {
                let at = |h: f64| {
                    let mut y = x;
                    y[k][j] += h;
                    area(&y)
                };
                let difference = (at(STEP) - at(-STEP)) / (2.0 * STEP);
                assert!((d[k][j] - difference).abs() <= DIFFERENCES, "{n} {k} {j}: {} {difference}", d[k][j]);
            }
        }
    }
}
