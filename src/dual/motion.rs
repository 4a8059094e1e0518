//! Exact derivatives of a facet's stage, pair by pair (docs/formulation 10.4).
//!
//! Every derivative of the stage is linear in those of m_AB, gamma_A and |e|, with m^-1, h, q held fixed, and so it is a
//! sum over the facet's pairs: each pair has its share, with respect to its own nodes alone. The kernels of `mortar` give
//! what stands in the brackets,
//!
//! D(phi m_A h_A) = D(phi m_A) h_A + phi m_A (m^-1 [Dgamma - Dm h])_A,
//! D(phi q) = phi m^-1 (Dm_B p_B - [Dm q]_B) + Dphi q,
//! Df_B = D(phi m_B) p_B,   Df_C = phi [-sum_B Dn_BC q_B] - sum_B n_BC D(phi q_B).
//!
//! The last term alone is no sum over pairs (`columns.rs`). Dphi = phi' (sum_A Dm_A - kappa D|e|) / |e|.

use super::basis::DualBasis;
use super::columns::{Columns, TractionDerivatives};
use super::coverage::whole_area_derivative;
use crate::geometry::Vec3;
use crate::mortar::{AlongNormal, AreaDerivatives, ForceDerivatives, MORTAR, NonmortarFrame, PairWeights, Raised};
use crate::shape::MAX_CORNERS;
use crate::simd::{self, Kernel, Lanes, rolled};

/// A facet at its tractions and heights, which the derivatives of its pairs are taken at.
#[derive(Clone, Debug)]
pub struct FacetMotion<'a> {
    basis: &'a DualBasis,
    /// p_A, held fixed: `[i][A]`.
    pub tractions: [[f64; MAX_CORNERS]; 3],
    /// q_A, the tractions that kernels are to be given.
    pub field: [[f64; MAX_CORNERS]; 3],
    /// h_A, by which kernels are to raise the mortar surface.
    pub heights: [f64; MAX_CORNERS],
    /// phi m^-1, column by column: it is multiplied with some hundred columns of derivatives a pair.
    inverse: [[f64; MAX_CORNERS]; MAX_CORNERS],
    /// D|e| / Dx_k.
    area: [Vec3; MAX_CORNERS],
}

/// Derivatives of one pair: first as the kernels give them at the facet's field and heights, then the pair's share of the
/// facet's.
#[derive(Debug)]
pub struct PairShare<'a> {
    /// [Dm q] and [-Dn q]; then Df_B, and the part of Df_C that belongs to the pair.
    pub forces: &'a mut ForceDerivatives,
    /// gamma and [Dgamma - Dm h]; then phi m_A h_A and its derivative.
    pub gap: &'a mut AlongNormal,
    /// Dm_A; then D(phi m_A).
    pub areas: &'a mut AreaDerivatives,
    /// Takes D(phi q).
    pub tractions: &'a mut TractionDerivatives,
}

/// The same of a facet's columns, its own nodes in the first [`MORTAR`] places: of one pair, or summed up over its pairs. There are as
/// many as `forces` has.
#[derive(Debug)]
pub struct FacetShare<'a> {
    /// [Dm q]; then Df_B.
    pub forces: &'a mut [Columns],
    /// [-Dn q]; then the part of Df_C that belongs to the pairs. Nothing, where it is elsewhere.
    pub opposite: &'a mut [Columns],
    /// gamma; then phi m_A h_A.
    pub gamma: &'a mut [f64; MAX_CORNERS],
    /// [Dgamma - Dm h]; then their derivative.
    pub slopes: &'a mut [[[f64; MAX_CORNERS]; 3]],
    /// Dm_A; then D(phi m_A).
    pub areas: &'a mut [[[f64; MAX_CORNERS]; 3]],
    /// Takes D(phi q).
    pub tractions: &'a mut [Columns],
}

impl<'a> FacetMotion<'a> {
    /// At the tractions `p[i][A]` and the facet's sum of gamma.
    pub fn new(
        frame: &NonmortarFrame,
        basis: &'a DualBasis,
        gamma: &[f64; MAX_CORNERS],
        p: &[[f64; MAX_CORNERS]; 3],
    ) -> FacetMotion<'a> {
        FacetMotion {
            basis,
            tractions: *p,
            field: basis.tractions(p),
            heights: basis.heights(gamma),
            inverse: basis.inverse().map(|column| column.map(|v| basis.coverage.fade * v)),
            area: whole_area_derivative(frame),
        }
    }

    /// What the kernels are asked for beside forces and gaps.
    pub fn raised<'b>(&'b self, areas: &'b mut AreaDerivatives) -> Raised<'b> {
        Raised { heights: &self.heights, areas }
    }

    /// Dphi, the share of a pair: `of_pair` is its share of kappa, `dm` its Dm_A with respect to x_k,j.
    #[inline(never)]
    fn dfade(&self, of_pair: f64, dm: &[f64; MAX_CORNERS], k: usize, j: usize) -> f64 {
        let whole = if k < MORTAR { self.area[k][j] } else { 0.0 };
        self.basis.fade_derivative(dm, (of_pair, whole))
    }

    /// Makes of a pair's derivatives its share of the facet's, with respect to the facet's nodes and so many nodes of the
    /// mortar facet: none where that side is at rest. `weights` are the pair's own. Where a kernel takes all pairs of a
    /// facet together, they count as one pair with the sum of their weights.
    pub fn share(&self, mortar: usize, weights: &PairWeights, pair: PairShare) {
        let PairShare { forces, gap, areas, tractions } = pair;
        let of = FacetShare {
            forces: &mut forces.one[..MORTAR + mortar],
            opposite: &mut forces.two,
            gamma: &mut gap.gamma,
            slopes: &mut gap.dgamma,
            areas,
            tractions,
        };
        self.share_facet(share_of(self.basis, weights), of);
    }

    /// The same of all pairs of a facet whose derivatives are summed up, with their share of kappa.
    #[inline(never)]
    pub fn share_facet(&self, kappa: f64, of: FacetShare) {
        simd::dispatch(Share { facet: self, kappa, of });
    }
}

struct Share<'a, 'b> {
    facet: &'a FacetMotion<'a>,
    kappa: f64,
    of: FacetShare<'b>,
}

impl Kernel for Share<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Share {
            facet,
            kappa,
            of: FacetShare { forces, opposite, gamma, slopes, areas: slopes_of_areas, tractions },
        } = self;
        let columns = forces.len();
        let (slopes, slopes_of_areas) = (&mut slopes[..columns], &mut slopes_of_areas[..columns]);
        let tractions = &mut tractions[..columns];
        let (basis, [a, b, c, d]) = (facet.basis, &facet.inverse);
        let solve = Times([L::load(a), L::load(b), L::load(c), L::load(d)]);
        let (phi, fades) = (L::splat(basis.coverage.fade), basis.coverage.slope != 0.0);
        let (zero, areas, heights) = (L::splat(0.0), L::load(&basis.areas), L::load(&facet.heights));
        *gamma = (areas * solve.times(gamma, zero)).store();
        for k in 0..columns {
            if k >= basis.nodes && k < MORTAR {
                continue;
            }
            for j in 0..rolled(3) {
                let dm = L::load(&slopes_of_areas[k][j]);
                let (mut area, mut dphi) = (dm, zero);
                if fades {
                    dphi = L::splat(facet.dfade(kappa, &slopes_of_areas[k][j], k, j));
                    area = dphi.mul_add(areas, phi * dm);
                    slopes_of_areas[k][j] = area.store();
                }
                let dgamma = &mut slopes[k][j];
                *dgamma = areas.mul_add(solve.times(dgamma, zero), area * heights).store();
                for i in 0..3 {
                    let (p, force) = (L::load(&facet.tractions[i]), &mut forces[k][j][i]);
                    let r = dm.mul_sub(p, L::load(force)).store();
                    *force = (area * p).store();
                    tractions[k][j][i] = solve.times(&r, dphi * L::load(&facet.field[i])).store();
                    if let (true, Some(force)) = (fades, opposite.get_mut(k)) {
                        force[j][i] = (phi * L::load(&force[j][i])).store();
                    }
                }
            }
        }
    }
}

/// A matrix, by its columns.
struct Times<L>([L; MAX_CORNERS]);

impl<L: Lanes> Times<L> {
    /// It times `v`, added to `sum`.
    #[inline(always)]
    fn times(&self, v: &[f64; MAX_CORNERS], mut sum: L) -> L {
        for b in 0..MAX_CORNERS {
            sum = self.0[b].mul_add(L::splat(v[b]), sum);
        }
        sum
    }
}

/// A pair's share of kappa.
pub fn share_of(basis: &DualBasis, weights: &PairWeights) -> f64 {
    (0..basis.nodes).map(|a| weights.coverage(a)).sum::<f64>() / basis.area
}
