//! One non-mortar facet with all of its pairs, as the stage of a facet takes it.

use super::full::FullDerivatives;
use crate::support::{name, numbers, points};
use serde_json::Value;
use stickslip::dual::{Columns, DualBasis, FacetColumns, FacetMotion, FacetSums, GROUP, PairShare};
use stickslip::element::{FacetResponse, NodeTangent, PairNow, PairTangent, pair_force, row_columns};
use stickslip::geometry::{Facet, Mat3, Vec3};
use stickslip::mortar::{
    ForceDerivatives, MORTAR, NonmortarFrame, PAIR_NODES, PairWeights, Segment, WeightDerivatives, pair_motion_raised,
};
use stickslip::quadrature::cell::line_of;
use stickslip::quadrature::{DEGREE_5, Rule};
use stickslip::shape::MAX_NODES;

/// Dg_A / dx_k of one node of a pair, for every slot k.
pub fn gap_rows(now: &PairNow, a: usize) -> [Mat3; PAIR_NODES] {
    let node = NodeTangent { drow_dnow: Mat3::identity(), ..NodeTangent::default() };
    let mut t = PairTangent::<3>::default();
    row_columns((Some(now), None), &FacetResponse::new([&node; 4]), &mut t.rows);
    std::array::from_fn(|k| t.row_x(a, k))
}

/// A pair, and the places of its mortar nodes among those of the facet.
pub struct Pair {
    pub facet: Facet,
    pub segment: Segment,
    pub weights: PairWeights,
    pub places: Vec<usize>,
}

/// A facet at some positions.
pub struct Patch {
    pub name: String,
    pub facet: Facet,
    pub frame: NonmortarFrame,
    pub nodes: usize,
    /// Number of mortar nodes.
    pub mortar: usize,
    pub pairs: Vec<Pair>,
    pub sums: FacetSums,
    pub rule: &'static Rule,
}

/// What a facet is made of.
#[derive(Clone, Debug)]
pub struct Scene {
    pub name: String,
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub facets2: Vec<Vec<usize>>,
}

impl Scene {
    pub fn of(case: &Value) -> Scene {
        let facets2 = case["facets2"].as_array().unwrap().iter();
        let facets2 = facets2.map(|f| numbers(f).into_iter().map(|k| k as usize).collect()).collect();
        Scene { name: name(case).to_owned(), x1: points(&case["x1"]), x2: points(&case["x2"]), facets2 }
    }

    pub fn patch(&self, rule: &'static Rule) -> Patch {
        self.patch_of(rule, |frame, facet| Segment::new(frame, facet).unwrap())
    }

    /// With points of the facet in place of cells of the overlaps.
    pub fn patch_by_points(&self, points: usize) -> Patch {
        let line = line_of(points).unwrap();
        self.patch_of(&DEGREE_5, |frame, facet| Segment::of_points(frame, facet, line).unwrap())
    }

    fn patch_of(&self, rule: &'static Rule, overlap: impl Fn(&NonmortarFrame, &Facet) -> Option<Segment>) -> Patch {
        let facet = Facet::new(&self.x1).unwrap();
        let frame = NonmortarFrame::new(&facet).unwrap();
        let mut pairs = Vec::new();
        for places in &self.facets2 {
            let two = Facet::new(&places.iter().map(|&k| self.x2[k]).collect::<Vec<_>>()).unwrap();
            if let Some(segment) = overlap(&frame, &two) {
                let weights = PairWeights::integrate(&frame, &segment, rule);
                pairs.push(Pair { facet: two, segment, weights, places: places.clone() });
            }
        }
        let sums = FacetSums::of(&frame, pairs.iter().map(|p| (&p.segment, &p.weights)));
        let (nodes, mortar) = (self.x1.len(), self.x2.len());
        Patch { name: self.name.clone(), facet, frame, nodes, mortar, pairs, sums, rule }
    }

    /// Component j of a node moved by h; nodes of the facet come first.
    pub fn moved(&self, node: usize, j: usize, h: f64) -> Scene {
        let mut scene = self.clone();
        let n = self.x1.len();
        if node < n {
            scene.x1[node][j] += h
        } else {
            scene.x2[node - n][j] += h
        }
        scene
    }
}

/// Derivatives of what a facet's stage gives, column by column: x_j of each node, `3 * node + j`.
pub struct Motion {
    /// Of phi m_A h_A e: `[column][A]`.
    pub gaps: Vec<[Vec3; 4]>,
    /// Of phi m_A.
    pub diagonal: Vec<[f64; 4]>,
    /// Of f_B, then of f_C of every mortar node.
    pub forces: Vec<Vec<Vec3>>,
}

impl Patch {
    pub fn basis(&self) -> DualBasis {
        DualBasis::of(&self.sums).unwrap().unwrap_or_else(|| panic!("{}: faded out", self.name))
    }

    /// n_BC, lanes B.
    pub fn columns(&self) -> Vec<[f64; 4]> {
        let (mut weights, mut tractions, mut rows) = self.room();
        let mut columns = self.rows((&mut weights, &mut tractions, &mut rows));
        self.pairs.iter().for_each(|p| columns.add_weights(&p.weights, &p.places));
        (0..self.mortar).map(|c| weights[c / GROUP].map(|n| n[c % GROUP])).collect()
    }

    #[allow(clippy::type_complexity)]
    fn room(&self) -> (Vec<[[f64; GROUP]; 4]>, Vec<Columns>, Vec<Columns>) {
        let (groups, columns) = (self.mortar.div_ceil(GROUP), MAX_NODES + self.mortar);
        let of = |n| vec![[[[0.0; 4]; 3]; 3]; n];
        (vec![[[0.0; GROUP]; 4]; groups], of(columns), of(groups * columns))
    }

    #[allow(clippy::type_complexity)]
    fn rows<'a>(
        &self,
        (weights, tractions, rows): (&'a mut [[[f64; GROUP]; 4]], &'a mut [Columns], &'a mut [Columns]),
    ) -> FacetColumns<'a> {
        FacetColumns { nodes: self.nodes, weights, tractions, rows }
    }

    /// A node of the facet's columns, counted as in the golden file; nodes that a triangle does not have are left out.
    fn node(&self, column: usize) -> Option<usize> {
        if column >= MAX_NODES {
            Some(self.nodes + column - MAX_NODES)
        } else {
            (column < self.nodes).then_some(column)
        }
    }

    /// Derivatives of phi m_A and of n^d_AC: `[column][A]`, and `[column][C][A]`.
    #[allow(clippy::type_complexity)]
    pub fn full(&self) -> (Vec<[f64; 4]>, Vec<Vec<[f64; 4]>>) {
        let (basis, weights) = (self.basis(), self.columns());
        let mut diagonal = vec![[[0.0; 4]; 3]; MAX_NODES + self.mortar];
        let mut mortar = vec![[[0.0; 4]; 3]; diagonal.len() * self.mortar];
        let mut full = FullDerivatives::new(&self.frame, &basis, &weights, &mut diagonal, &mut mortar);
        for p in &self.pairs {
            let (weights, derivatives) = WeightDerivatives::integrate(&self.frame, &p.segment, self.rule);
            full.add(&weights, &derivatives, &p.places);
        }
        let columns = 3 * (self.nodes + self.mortar);
        let (mut of_areas, mut of_weights) = (vec![[0.0; 4]; columns], vec![vec![[0.0; 4]; self.mortar]; columns]);
        for (column, j) in (0..diagonal.len()).flat_map(|c| (0..3).map(move |j| (c, j))) {
            let Some(node) = self.node(column) else { continue };
            of_areas[3 * node + j] = diagonal[column][j];
            for c in 0..self.mortar {
                of_weights[3 * node + j][c] = mortar[column * self.mortar + c][j];
            }
        }
        (of_areas, of_weights)
    }

    /// phi m_A h_A e.
    pub fn gaps(&self) -> [Vec3; 4] {
        self.basis().dual(&self.sums.gamma).map(|g| self.frame.plane.e * g)
    }

    /// f_B, then f_C of every mortar node, by the pairs at phi q.
    pub fn forces(&self, p: &[[f64; 4]; 3]) -> Vec<Vec3> {
        let basis = self.basis();
        let q = basis.tractions(p);
        let field = [0, 1, 2, 3].map(|a| Vec3::from_fn(|i, _| basis.coverage.fade * q[i][a]));
        let mut forces = vec![Vec3::zeros(); self.nodes + self.mortar];
        for pair in &self.pairs {
            let f = pair_force(&pair.weights, &field);
            (0..self.nodes).for_each(|b| forces[b] += f[b]);
            pair.places.iter().enumerate().for_each(|(c, place)| forces[self.nodes + place] += f[MORTAR + c]);
        }
        forces
    }

    /// Derivatives at the tractions `p[i][A]`, by the kernels of pairs and the shares of these.
    pub fn motion(&self, p: &[[f64; 4]; 3]) -> Motion {
        let basis = self.basis();
        let facet = FacetMotion::new(&self.frame, &basis, &self.sums.gamma, p);
        let columns = 3 * (self.nodes + self.mortar);
        let mut motion = Motion {
            gaps: vec![[Vec3::zeros(); 4]; columns],
            diagonal: vec![[0.0; 4]; columns],
            forces: vec![vec![Vec3::zeros(); self.nodes + self.mortar]; columns],
        };
        let (mut weights, mut tractions, mut rows) = self.room();
        let mut mortar = self.rows((&mut weights, &mut tractions, &mut rows));
        // One of each serves all pairs, as in a tangent: what a pair does not have keeps what was there.
        let (mut forces, mut areas, mut dq) =
            (ForceDerivatives::default(), [[[0.0; 4]; 3]; PAIR_NODES], [[[[0.0; 4]; 3]; 3]; PAIR_NODES]);
        for pair in &self.pairs {
            let (kernel, raised) = ((&self.frame, &pair.segment, self.rule), facet.raised(&mut areas));
            let mut gap = pair_motion_raised(kernel, &pair.weights, &facet.field, &mut forces, raised);
            let share = PairShare { forces: &mut forces, gap: &mut gap, areas: &mut areas, tractions: &mut dq };
            facet.share(pair.places.len(), &pair.weights, share);
            mortar.add_weights(&pair.weights, &pair.places);
            mortar.add_forces(&forces, &pair.places);
            for (slot, of) in dq.iter().enumerate() {
                let column = match slot.checked_sub(MORTAR) {
                    None => (slot < self.nodes).then_some(slot),
                    Some(c) => pair.places.get(c).map(|place| MAX_NODES + place),
                };
                let Some(column) = column else { continue };
                let sum = mortar.tractions[column].as_flattened_mut().as_flattened_mut();
                sum.iter_mut().zip(of.as_flattened().as_flattened()).for_each(|(sum, of)| *sum += of);
            }
            let now = PairNow { weights: &pair.weights, gap: Some(&gap) };
            let slots = (0..self.nodes).map(|k| (k, k));
            let slots = slots.chain(pair.places.iter().enumerate().map(|(c, p)| (MORTAR + c, self.nodes + p)));
            for (slot, node) in slots {
                for j in 0..3 {
                    let column = 3 * node + j;
                    for a in 0..self.nodes {
                        motion.gaps[column][a] += gap_rows(&now, a)[slot].column(j);
                        motion.diagonal[column][a] += areas[slot][j][a];
                        motion.forces[column][a] += Vec3::from_fn(|i, _| forces.one[slot][j][i][a]);
                    }
                }
            }
        }
        mortar.couple();
        let columns = MAX_NODES + self.mortar;
        for (column, place) in (0..columns).flat_map(|column| (0..self.mortar).map(move |place| (column, place))) {
            let Some(node) = self.node(column) else { continue };
            for (j, of_column) in rows[place / GROUP * columns + column].iter().enumerate() {
                motion.forces[3 * node + j][self.nodes + place] = Vec3::from_fn(|i, _| of_column[i][place % GROUP]);
            }
        }
        motion
    }
}
