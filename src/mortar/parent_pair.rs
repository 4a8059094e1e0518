//! A pair of facets as hosts have them, linear or quadratic: the sum over the pairs of their sub-facets
//! (docs/formulation 12.2).

use super::field::MultiplierSpace;
use super::segment::{NonmortarFrame, Segment};
use super::slots::{MORTAR, PAIR_NODES};
use super::sub_pair::{COLUMNS, Side, SubDerivatives, SubWeights, rule_for, sub_weights};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Facet, Mat3, Plane, Vec3};
use crate::quadrature::{DEGREE_5, Rule};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES, Parent, SubFacet, TERMS, monomial_slopes};
use crate::simd::rolled;

/// The Jacobian at a node, over that of the linear facet on the corners, is above this. 0 is a mid node at a quarter of a straight
/// edge, where the normal at the corner is made of rounding; at 0.2505 it is 0.002.
const LEAST_JACOBIAN: f64 = 1e-3;

/// The same where a normal is taken there: a surface that bends turns that normal by so much less, and an overlap of parts is beside the
/// facet's own by up to a tenth of the edge where mid nodes are drawn so far. What the one makes of the other grows from iterate to iterate
/// at 0.04, where multipliers had no bound.
const LEAST_OF_NORMALS: f64 = 0.1;

const MID_NODES: &str = "nodes count from 0, corners first; mid node k lies between the corners k and k + 1, farther than a quarter of the edge from both";

/// A facet as hosts have it.
#[derive(Clone, Copy, Debug)]
pub struct ParentFacet {
    /// Its kind.
    pub parent: &'static Parent,
    /// Node positions, right-hand order seen from outside the body.
    pub x: [Vec3; MAX_PARENT_NODES],
}

impl ParentFacet {
    /// The facet through 3, 4, 6, 8 or 9 finite points.
    ///
    /// # Errors
    /// [`Kind::InvalidSize`]: another number; [`Kind::DegenerateFacet`]: a sub-facet that is turned over, as where mid nodes
    /// do not follow the corners in order, or a mid node a quarter of its edge from a corner, or nearer.
    pub fn new(nodes: &[Vec3]) -> Result<ParentFacet> {
        let parent = Parent::of(nodes.len()).ok_or_else(|| {
            let text = text!("a facet has {} nodes; 3, 4, 6, 8 or 9 are allowed", nodes.len());
            Error::new(Kind::InvalidSize, text)
        })?;
        let mut x = [nodes[0]; MAX_PARENT_NODES];
        x[..nodes.len()].copy_from_slice(nodes);
        let facet = ParentFacet { parent, x };
        if parent.subs.len() > 1 {
            let corners = [0, 1, 2, 3].map(|k| x[k % parent.corners()]);
            let whole = Facet { nodes: corners, shape: parent.cell }.area_vector();
            for (s, sub) in parent.subs.iter().enumerate() {
                if !(facet.sub(s).area_vector().dot(&whole) > 0.0) {
                    let nodes = &sub.nodes[..sub.shape.n];
                    let text = text!("its part between the nodes {nodes:?} is turned over; {MID_NODES}");
                    return Err(Error::new(Kind::DegenerateFacet, text));
                }
            }
            if let Some(k) = facet.flat_node(LEAST_JACOBIAN) {
                let text = text!("at its node {k} its mapping has no area or turns over; {MID_NODES}");
                return Err(Error::new(Kind::DegenerateFacet, text));
            }
        }
        Ok(facet)
    }

    /// The first node at which the Jacobian is no more than `least` of that of the linear facet on the corners.
    fn flat_node(&self, least: f64) -> Option<usize> {
        let corners = [0, 1, 2, 3].map(|k| self.x[k % self.parent.corners()]);
        let whole = Facet { nodes: corners, shape: self.parent.cell }.area_vector();
        // The area vector at the centre of a cell and x_xi x x_eta differ by a factor of the cell.
        let least = least * whole.norm_squared() * if self.parent.corners() == 3 { 1.0 } else { 0.125 };
        (0..self.parent.n).find(|&k| !(self.area_vector(k).dot(&whole) > least))
    }

    /// Refuses a facet that has hardly any area around a node, whose normals would follow the noise of the surface.
    ///
    /// # Errors
    /// [`Kind::DegenerateFacet`]
    pub fn check_normals(&self) -> Result<()> {
        match self.flat_node(LEAST_OF_NORMALS) {
            Some(k) if self.parent.subs.len() > 1 => {
                let text = text!(
                    "at its node {k} its mapping has hardly any area, and no normal to go by; take a mid node farther than 0.275 of its edge from both ends"
                );
                Err(Error::new(Kind::DegenerateFacet, text))
            }
            _ => Ok(()),
        }
    }

    /// How many multipliers it has: its first so many nodes do.
    pub fn multipliers(&self, space: MultiplierSpace) -> usize {
        if space == MultiplierSpace::Corner { self.parent.corners() } else { self.parent.n }
    }

    /// Unit normal at node k, out of the body (docs/formulation 12.4).
    pub fn normal(&self, k: usize) -> Vec3 {
        self.area_vector(k).normalize()
    }

    /// x_xi x x_eta at node k [L^2]; of a line the second direction is z.
    fn area_vector(&self, k: usize) -> Vec3 {
        let [along, across] = self.tangents(&self.slopes(k));
        along.cross(&across)
    }

    /// dN_B/dxi and dN_B/deta at node k.
    fn slopes(&self, k: usize) -> [[f64; MAX_PARENT_NODES]; 2] {
        let [x, y] = self.parent.at[k];
        let [_, dx, dy] = monomial_slopes(x, y);
        [self.functions(&dx), self.functions(&dy)]
    }

    /// The functions N_B, or their slopes, of the terms or the terms' slopes.
    #[inline(never)] // unrolled it is large
    fn functions(&self, m: &[f64; TERMS]) -> [f64; MAX_PARENT_NODES] {
        let mut n = [0.0; MAX_PARENT_NODES];
        for b in 0..rolled(self.parent.n) {
            n[b] = (0..TERMS).map(|t| self.parent.functions[t][b / 4][b % 4] * m[t]).sum();
        }
        n
    }

    /// x_xi and x_eta with these slopes; of a line the second one is z.
    fn tangents(&self, slopes: &[[f64; MAX_PARENT_NODES]; 2]) -> [Vec3; 2] {
        [self.sum(&slopes[0]), if self.parent.corners() == 2 { Vec3::z() } else { self.sum(&slopes[1]) }]
    }

    /// The sum of the nodes, but for the first one's part.
    fn sum(&self, n: &[f64; MAX_PARENT_NODES]) -> Vec3 {
        // Differences of nodes: exact under a common offset.
        (1..rolled(self.parent.n)).map(|b| (self.x[b] - self.x[0]) * n[b]).sum()
    }

    /// The point at these coordinates, and x_xi and x_eta there.
    pub fn point(&self, [xi, eta]: [f64; 2]) -> (Vec3, [Vec3; 2]) {
        let [m, dx, dy] = monomial_slopes(xi, eta);
        (self.x[0] + self.sum(&self.functions(&m)), self.tangents(&[self.functions(&dx), self.functions(&dy)]))
    }

    /// `rows` times the derivatives of m, the unit normal at node k, with respect to each node. With w = x_xi x x_eta,
    /// Dm = (I - m m^T) (Dx_xi x x_eta + x_xi x Dx_eta) / |w|.
    pub fn normal_derivatives(&self, k: usize, rows: &Mat3) -> [Mat3; MAX_PARENT_NODES] {
        let slopes = self.slopes(k);
        let [a, b] = self.tangents(&slopes);
        let w = a.cross(&b);
        let (norm, m) = (w.norm(), w.normalize());
        let across = (rows - rows * m * m.transpose()) / norm;
        // row . (Da x b) = (b x row) . Da, row . (a x Db) = (row x a) . Db; of a line b is fixed.
        let rows = [0, 1, 2].map(|i| across.row(i).transpose());
        let by = [rows.map(|row| b.cross(&row)), rows.map(|row| row.cross(&a))]
            .map(|by| Mat3::from_columns(&by).transpose());
        let (is_line, mut d) = (self.parent.corners() == 2, [Mat3::zeros(); MAX_PARENT_NODES]);
        for l in 0..rolled(self.parent.n) {
            d[l] = by[0] * slopes[0][l] + by[1] * if is_line { 0.0 } else { slopes[1][l] };
        }
        d
    }

    /// int N_A da of the multipliers over the whole facet, covered or not [L^2].
    ///
    /// # Errors
    /// [`Kind::DegenerateFacet`] of a sub-facet, which is named.
    pub fn areas(&self, space: MultiplierSpace) -> Result<[f64; MAX_PARENT_NODES]> {
        let mut areas = [0.0; MAX_PARENT_NODES];
        for (s, sub) in self.parent.subs.iter().enumerate() {
            let [j0, j1, j2] = frame(self, s)?.map.determinant();
            let mut add = |u: f64, v: f64, weight: f64| {
                let at = sub.shape.values(u, v);
                let n = match space {
                    MultiplierSpace::Sub => at,
                    MultiplierSpace::Corner => {
                        let xi =
                            [0, 1].map(|i| (0..sub.shape.n).map(|k| at[k] * self.parent.at[sub.nodes[k]][i]).sum());
                        self.parent.cell.values(xi[0], xi[1])
                    }
                };
                for (a, &node) in space.nodes(self.parent, sub).iter().enumerate() {
                    areas[node] += weight * (j0 + j1 * u + j2 * v) * n[a];
                }
            };
            // Both exact: the determinant is linear, and the functions are of degree 2 at most.
            match sub.shape.n {
                3 => DEGREE_5.triangle.iter().for_each(|[u, v, w]| add(*u, *v, 0.5 * w)),
                _ => {
                    for ([u, wu], [v, wv]) in
                        DEGREE_5.square.iter().flat_map(|u| DEGREE_5.square.iter().map(move |v| (u, v)))
                    {
                        add(2.0 * u - 1.0, 2.0 * v - 1.0, 4.0 * wu * wv);
                    }
                }
            }
        }
        Ok(areas)
    }

    /// A sub-facet.
    #[inline]
    pub fn sub(&self, s: usize) -> Facet {
        let SubFacet { nodes, shape, .. } = &self.parent.subs[s];
        Facet { nodes: nodes.map(|k| self.x[k]), shape }
    }
}

/// The frame of a sub-facet, with the planes beyond its edges within the parent.
fn frame(one: &ParentFacet, s: usize) -> Result<NonmortarFrame> {
    let named = |e: Error| {
        let nodes = &one.parent.subs[s].nodes[..one.parent.subs[s].shape.n];
        match one.parent.subs.len() {
            1 => e,
            _ => Error::new(e.kind, text!("the part between nodes {nodes:?} (counted from 0): {}", e.message)),
        }
    };
    let mut frame = NonmortarFrame::new(&one.sub(s)).map_err(named)?;
    for (k, beyond) in one.parent.subs[s].beyond.iter().enumerate() {
        if let Some(other) = *beyond {
            frame.plane.beyond[k] = Some(Plane::of(&one.sub(other)).map_err(named)?.e);
        }
    }
    Ok(frame)
}

/// n_AB and n_AC of a pair of parents: rows, the nodes with multipliers, which are the first ones; columns, the parents' nodes
/// [L^2].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ParentWeights {
    /// n_AB.
    pub ab: [[f64; MAX_PARENT_NODES]; MAX_PARENT_NODES],
    /// n_AC.
    pub ac: [[f64; MAX_PARENT_NODES]; MAX_PARENT_NODES],
}

/// Derivatives of n_AB and n_AC, row by row as a caller has them: `[A][B][k][j]` with respect to component j of the pair's
/// k-th node, mortar ones after non-mortar ones; m n1 3 (n1 + n2) and m n2 3 (n1 + n2) numbers of m multipliers `[L]`.
pub type ParentDerivatives<'a> = [&'a mut [f64]; 2];

/// The weights of a pair; where asked for, their derivatives are added to what is there.
///
/// # Errors
/// [`Kind::DegenerateFacet`] of a sub-facet, which is named; [`Kind::ProjectionNotConvex`].
pub fn parent_weights(
    (one, two): (&ParentFacet, &ParentFacet),
    space: MultiplierSpace,
    rule: &'static Rule,
    mut derivatives: Option<ParentDerivatives>,
) -> Result<ParentWeights> {
    let mut sum = ParentWeights::default();
    let rule = rule_for(rule, [one.parent, two.parent]);
    for (s, sigma) in one.parent.subs.iter().enumerate() {
        let frame = frame(one, s)?;
        for (t, tau) in two.parent.subs.iter().enumerate() {
            let Some(segment) = Segment::new(&frame, &two.sub(t))? else { continue };
            let (pair, sides) = ((&frame, &segment, rule), ((one.parent, sigma), (two.parent, tau)));
            let rows = space.nodes(one.parent, sigma);
            match &mut derivatives {
                None => sum.add(rows, &sub_weights(pair, sides, space, None)),
                Some([ab, ac]) => {
                    let mut d = SubDerivatives::default();
                    sum.add(rows, &sub_weights(pair, sides, space, Some(&mut d)));
                    add_derivatives(rows, sides, (&d.ab, one.parent.n), ab);
                    add_derivatives(rows, sides, (&d.ac, two.parent.n), ac);
                }
            }
        }
    }
    Ok(sum)
}

impl ParentWeights {
    /// Adds those of a pair of sub-facets, whose rows are these nodes of the parent.
    #[inline(never)] // it is met several times
    pub fn add(&mut self, rows: &[usize], weights: &SubWeights) {
        for (a, &row) in rows.iter().enumerate() {
            for b in 0..MAX_PARENT_NODES {
                self.ab[row][b] += weights.ab[a][b];
                self.ac[row][b] += weights.ac[a][b];
            }
        }
    }

    /// What is covered of the area of multiplier `a` [L^2].
    pub fn coverage(&self, a: usize) -> f64 {
        self.ab[a].iter().sum()
    }
}

/// Adds those of so many columns, of a pair of sub-facets, to those of the parents.
fn add_derivatives(
    rows: &[usize],
    ((one, sigma), (two, tau)): (Side, Side),
    (d, columns): (&[[[[f64; COLUMNS]; 3]; PAIR_NODES]; MAX_CORNERS], usize),
    to: &mut [f64],
) {
    let n = one.n + two.n;
    let non_mortar = (0..sigma.shape.n).map(|k| (k, sigma.nodes[k]));
    let mortar = (0..tau.shape.n).map(|l| (MORTAR + l, one.n + tau.nodes[l]));
    for (slot, node) in non_mortar.chain(mortar) {
        for (a, &row) in rows.iter().enumerate() {
            for (b, j) in (0..columns).flat_map(|b| (0..3).map(move |j| (b, j))) {
                to[3 * ((row * columns + b) * n + node) + j] += d[a][slot][j][b];
            }
        }
    }
}
