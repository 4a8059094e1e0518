//! What lies between the surfaces, or becomes of them, beside a law of friction (docs/formulation 20): a layer that yields under
//! pressure, wear, a bond. It is no law of its own. It changes what the law is asked: the law sees
//!
//! g + nu m d   in place of g,   lambda - T   in place of lambda,
//!
//! with the depth d(P, g_T) by which the surfaces give way, the traction T(delta_n, delta_t) of the bond and the covered area m; P =
//! max(0, - lambda_N) with what d needs, delta_n = g_N / m + d. What the law answers is turned back: p gains T, and derivatives are those
//! of the chain. So every law, every kind of facet and every form has all of it.

use super::bond::{BOND_STATES, Bond, Parted};
use super::node::{Node, NodeResponse, Turn};
use super::overclosure::Overclosure;
use super::table::LawFunctions;
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use nalgebra::{SMatrix, SVector};

/// What there is; at least one of these.
#[derive(Debug, Default, PartialEq)]
pub struct Layer {
    /// By how much the surfaces overlap under pressure.
    pub overclosure: Option<Overclosure>,
    /// Depth that is worn off a pressure and a slip [L^2/F], as Archard has it.
    pub wear: Option<f64>,
    /// What holds them together.
    pub bond: Option<Bond>,
}

/// Numbers that wear remembers of a node: the depth, and the volume.
const WEAR_STATES: usize = 2;

/// One node, as a layer sees it.
#[derive(Clone, Copy, Debug)]
pub struct LayerQuestion<'a> {
    /// The covered area of now, and of t_n [L^2].
    pub coverage: [f64; 2],
    /// The whole area of the node [L^2].
    pub area: f64,
    /// What is remembered of it.
    pub states: &'a [f64],
}

/// What a layer does at one node, at one point.
#[derive(Clone, Copy, Debug)]
pub struct LayerAnswer {
    /// m.
    coverage: f64,
    /// d `[L]`.
    depth: f64,
    /// dd / dP [L^3/F].
    by_pressure: f64,
    /// dd / dg_T [1/L^2].
    by_slip: Vec3,
    /// T [F/L^2].
    pub traction: Vec3,
    /// dT / d delta_n.
    by_opening: Vec3,
    /// dT / dg_T.
    traction_by_slip: Mat3,
    /// dT / dnu at fixed delta_n and g_T.
    by_normal: Mat3,
    /// What is left of the augmentation: it decides by a spring in line with that of the layer.
    share: f64,
}

impl Default for LayerAnswer {
    /// Of a node that nothing covers.
    fn default() -> Self {
        let (none, zero) = (Vec3::zeros(), Mat3::zeros());
        LayerAnswer {
            coverage: 0.0,
            depth: 0.0,
            by_pressure: 0.0,
            by_slip: none,
            traction: none,
            by_opening: none,
            traction_by_slip: zero,
            by_normal: zero,
            share: 1.0,
        }
    }
}

/// What has become of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LayerState {
    /// Depth that is worn off `[L]`.
    pub worn: f64,
    /// Volume likewise [L^3].
    pub volume: f64,
    /// D of the bond.
    pub damage: f64,
    /// Work that the bond has lost, an area [F/L].
    pub lost: f64,
}

impl Layer {
    /// Refuses numbers outside their range.
    pub fn validate(&self) -> Result<()> {
        if let Some(wear) = self.wear.filter(|k| !(*k > 0.0 && k.is_finite())) {
            let kind = if wear.is_finite() { Kind::InvalidValue } else { Kind::NotFinite };
            return Err(Error::new(kind, text!("layer.wear is {wear}; it must be finite and not negative")));
        }
        self.bond.as_ref().map_or(Ok(()), Bond::validate)
    }

    /// Whether it needs slip, and so three multipliers a node.
    pub fn slips(&self) -> bool {
        self.wear.is_some() || self.bond.is_some()
    }

    /// Numbers that it remembers of each node.
    pub fn states(&self) -> usize {
        self.bond.map_or(0, |_| BOND_STATES) + self.wear.map_or(0, |_| WEAR_STATES)
    }

    /// How far it acts across gaps, and how deep surfaces may overlap beside what is worn off `[L]`.
    pub fn reach(&self) -> [f64; 2] {
        let table = self.overclosure.as_ref();
        let (first, last) = table.map_or((0.0, 0.0), |table| (table.first(), table.last()));
        let bond = self.bond.as_ref().map_or(0.0, Bond::last);
        [bond.max(-first).max(0.0), last.max(0.0)]
    }

    /// What of remembered numbers is wear's, and what is the bond's.
    fn split<'a>(&self, states: &'a [f64]) -> (&'a [f64], &'a [f64]) {
        states.split_at(self.wear.map_or(0, |_| WEAR_STATES))
    }

    /// Puts back what must not change where a node has not slipped: a node that sticks slips by rounding.
    pub fn settle(&self, slips: bool, before: &[f64], states: &mut [f64]) {
        if !slips && self.wear.is_some() {
            states[..WEAR_STATES].copy_from_slice(&before[..WEAR_STATES]);
        }
    }

    /// What numbers that are remembered say.
    pub fn state(&self, states: &[f64]) -> LayerState {
        let (wear, bond) = self.split(states);
        let mut state = LayerState::default();
        if let &[worn, volume] = wear {
            (state.worn, state.volume) = (worn, volume);
        }
        if let (Some(of), Some(&kappa)) = (&self.bond, bond.first()) {
            (state.damage, state.lost) = (of.damage(kappa).0, of.lost(kappa));
        }
        state
    }

    /// What it does at a covered node, and in `after` what would be remembered.
    pub fn answer<const N: usize>(&self, node: &Node<N>, of: &LayerQuestion, after: &mut [f64]) -> LayerAnswer {
        let (wear, bond) = self.split(of.states);
        let (lambda_n, slip) = (normal_part(node), slip(node));
        let area = if node.covered_before { 1.0 / of.coverage[1] } else { 0.0 };
        let mut answer = LayerAnswer { coverage: of.coverage[0], ..LayerAnswer::default() };
        if let Some(table) = &self.overclosure {
            (answer.depth, answer.by_pressure) = table.at(-lambda_n);
            answer.share = 1.0 / (1.0 + node.augmentation * of.area * answer.by_pressure);
        }
        if let Some(k) = self.wear {
            let (pressure, size) = ((-lambda_n).max(0.0), slip.norm());
            let rub = k * area * size;
            answer.depth += wear[0] + rub * pressure;
            answer.by_pressure += if lambda_n < 0.0 { rub } else { 0.0 };
            // Where nothing has slipped yet, |slip| grows along where the node would slip to.
            let along = if size > 0.0 { slip / size } else { super::cone::trial(node).direction };
            answer.by_slip = along * (k * pressure * area);
            (after[0], after[1]) = (wear[0] + rub * pressure, wear[1] + k * pressure * size);
        }
        if let Some(of_bond) = &self.bond {
            let before = Vec3::from_column_slice(&bond[1..]);
            let (kept, turned) = in_surface(node, before);
            let opening = node.normal.dot(&node.gap_now) / answer.coverage + answer.depth;
            let at = Parted { normal: node.normal, opening, slip: kept + slip * area, largest: bond[0] };
            let borne = of_bond.at(&at);
            answer.traction = borne.traction;
            answer.by_opening = borne.by_opening;
            answer.traction_by_slip = borne.by_slip * area;
            answer.by_normal = Mat3::identity() * borne.by_normal + borne.by_slip * turned;
            let after = &mut after[self.wear.map_or(0, |_| WEAR_STATES)..];
            after[0] = borne.largest;
            after[1..].copy_from_slice(at.slip.as_slice());
        }
        answer
    }
}

/// lambda_N.
fn normal_part<const N: usize>(node: &Node<N>) -> f64 {
    if N == 1 { node.lambda[0] } else { super::cone::trial(node).lambda_n }
}

/// g_T.
fn slip<const N: usize>(node: &Node<N>) -> Vec3 {
    if N == 1 { Vec3::zeros() } else { super::cone::trial(node).slip }
}

/// A vector of the surface as it was, in that of now, as long as it was; with its derivative by nu.
fn in_surface<const N: usize>(node: &Node<N>, v: Vec3) -> (Vec3, Mat3) {
    let (nu, size) = (node.normal, v.norm());
    let along = node.free * (v - nu * nu.dot(&v));
    let left = along.norm();
    if size == 0.0 || left == 0.0 {
        return (Vec3::zeros(), Mat3::zeros());
    }
    let unit = along / left;
    let turned = node.free * (nu * v.transpose() + Mat3::identity() * nu.dot(&v)) * -1.0;
    (unit * size, (Mat3::identity() - unit * unit.transpose()) * turned * (size / left))
}

/// How R numbers of a layer change: by the multiplier, by g of now, by g at t_n's weights, by the covered area.
struct Slopes<const R: usize, const N: usize> {
    lambda: SMatrix<f64, R, N>,
    now: SMatrix<f64, R, 3>,
    previous: SMatrix<f64, R, 3>,
    area: SVector<f64, R>,
}

impl LayerAnswer {
    /// d, dd / d lambda_N at fixed slip, and what is left of the augmentation.
    pub fn yields(&self) -> [f64; 3] {
        [self.depth, -self.by_pressure, self.share]
    }

    /// The node as the law sees it.
    pub fn inner<const N: usize>(&self, node: &Node<N>) -> Node<N> {
        Node {
            lambda: node.lambda - SVector::from_fn(|i, _| self.traction[i]),
            gap_now: node.gap_now + node.normal * (self.coverage * self.depth),
            augmentation: node.augmentation * self.share,
            ..*node
        }
    }

    /// Of d.
    fn depth_slopes<const N: usize>(&self, node: &Node<N>) -> Slopes<1, N> {
        let (now, _) = node.slip.coefficients();
        let previous = (in_plane(node).transpose() * self.by_slip).transpose();
        // d lambda_N / d lambda; nu lies in the free directions.
        let along = SMatrix::from_fn(|_, i| if N == 1 { 1.0 } else { node.normal[i] });
        Slopes { lambda: along * -self.by_pressure, now: previous * -now, previous, area: SVector::zeros() }
    }

    /// Of T, through those of d.
    fn traction_slopes<const N: usize>(&self, node: &Node<N>, depth: &Slopes<1, N>) -> Slopes<3, N> {
        let (nu, m, (now, _)) = (node.normal, self.coverage, node.slip.coefficients());
        let (a, of_slip) = (self.by_opening, self.traction_by_slip * in_plane(node));
        Slopes {
            lambda: a * depth.lambda,
            now: a * (nu.transpose() / m + depth.now) - of_slip * now,
            previous: a * depth.previous + of_slip,
            area: a * (-nu.dot(&node.gap_now) / (m * m)),
        }
    }

    /// The law's answer about the node as it sees it, turned back.
    pub fn outer<const N: usize>(&self, node: &Node<N>, r: NodeResponse<N>) -> NodeResponse<N> {
        if self.coverage == 0.0 {
            return r;
        }
        let (nu, m) = (node.normal, self.coverage);
        let depth = self.depth_slopes(node);
        let traction = self.traction_slopes(node, &depth);
        let (by_depth, through) = (r.drow_dnow * nu * m, through::<N>(&r.drow_dlambda));
        let drow_dlambda = r.drow_dlambda + by_depth * depth.lambda - through * traction.lambda;
        let drow_dnow = r.drow_dnow + by_depth * depth.now - through * traction.now;
        let drow_dprevious = r.drow_dprevious + by_depth * depth.previous - through * traction.previous;
        let drow_darea = r.drow_dnow * nu * self.depth - through * traction.area;
        let drow_dlambda = drow_dlambda * self.share;
        let direction = SMatrix::<f64, 3, N>::from_fn(|i, j| if N == 1 { nu[i] } else { f64::from(u8::from(i == j)) });
        NodeResponse {
            traction: r.traction + self.traction,
            row: r.row * self.share,
            gap_normal: nu.dot(&node.gap_now),
            sigma: r.sigma + self.traction,
            dp_dlambda: direction * (SMatrix::identity() + drow_dlambda * node.augmentation),
            drow_dlambda,
            drow_dnow: drow_dnow * self.share,
            drow_dprevious: drow_dprevious * self.share,
            drow_darea: drow_darea * self.share,
            ..r
        }
    }

    /// How that turns with the normal.
    pub fn turn<const N: usize>(&self, law: &LawFunctions<N>, node: &Node<N>, inner: &Node<N>) -> Turn<N> {
        let turn = (law.turn)(inner);
        if self.coverage == 0.0 {
            return turn;
        }
        let (nu, m, (now, committed)) = (node.normal, self.coverage, node.slip.coefficients());
        let r = (law.respond)(inner);
        let u = match node.covered_before {
            true => node.gap_previous - node.gap_now * now - node.gap_committed * committed,
            false => Vec3::zeros(),
        };
        let slip = node.free * (nu * u.transpose() + Mat3::identity() * nu.dot(&u)) * -1.0;
        let pressure = if N == 1 { Vec3::zeros() } else { node.free * Vec3::from_fn(|i, _| -part(&node.lambda, i)) };
        let depth = (pressure * self.by_pressure + slip.transpose() * self.by_slip).transpose();
        let gap = nu * depth * m + Mat3::identity() * (m * self.depth);
        let opening = node.gap_now.transpose() / m + depth;
        let traction = self.by_opening * opening + self.traction_by_slip * slip + self.by_normal;
        let row = turn.drow_dnormal + r.drow_dnow * gap - through::<N>(&r.drow_dlambda) * traction;
        let drow_dnormal = row * self.share;
        let dp_dnormal = match N {
            1 => {
                let p = node.lambda[0] + node.augmentation * self.share * r.row[0];
                let along = SMatrix::<f64, 1, 3>::from_fn(|_, j| drow_dnormal[(0, j)]);
                Mat3::identity() * p + nu * along * node.augmentation
            }
            _ => Mat3::from_fn(|i, j| if i < N { drow_dnormal[(i % N, j)] * node.augmentation } else { 0.0 }),
        };
        Turn { dp_dnormal, drow_dnormal }
    }
}

/// What g_T takes of a gap at t_n's weights; nothing where the node was not covered then.
fn in_plane<const N: usize>(node: &Node<N>) -> Mat3 {
    let nu = node.normal;
    if node.covered_before { node.free * (Mat3::identity() - nu * nu.transpose()) } else { Mat3::zeros() }
}

fn part<const N: usize>(v: &SVector<f64, N>, i: usize) -> f64 {
    v.get(i).copied().unwrap_or(0.0)
}

/// drow / dlambda as it acts on a traction of three components. With one multiplier there is no bond.
fn through<const N: usize>(d: &SMatrix<f64, N, N>) -> SMatrix<f64, N, 3> {
    SMatrix::from_fn(|i, j| if j < N { d[(i, j)] } else { 0.0 })
}
