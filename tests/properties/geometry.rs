//! Random pairs of facets, made to be awkward: what lies on what, how thin, how far off, how large.

use nalgebra::Rotation3;
use proptest::prelude::*;
use stickslip::geometry::bilinear_map::BilinearMap;
use stickslip::geometry::{Facet, Vec3};
use stickslip::mortar::{MORTAR, NonmortarFrame, PairWeights, Segment, WeightDerivatives};
use stickslip::quadrature::{DEGREE_5, DEGREE_10, Rule};

/// How the mortar facet comes about.
#[derive(Clone, Copy, Debug)]
pub enum Relation {
    /// On its own.
    Free,
    /// The non-mortar facet itself, turned in its plane by 10^-k.
    Turned(i32),
    /// The non-mortar facet, beside itself with a strip of 10^-k of its size in common; or, at k = 0, with an edge.
    Strip(i32),
    /// With two nodes of the non-mortar facet: on one edge, from one side or the other.
    OnEdge,
    /// With one node of the non-mortar facet.
    OnVertex,
    /// The non-mortar facet seen through a magnifying glass: larger by 10^k, smaller where k < 0.
    Sized(i32),
}

/// What a pair is made from. Everything that is drawn at random, so that a failure shows it.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// Nodes of both facets.
    pub nodes: [usize; 2],
    /// Noise in -1..1.
    pub noise: Vec<f64>,
    pub relation: Relation,
    /// Coordinates are multiples of 1 / grid.
    pub grid: Option<i32>,
    /// Out-of-plane noise over the facet size.
    pub warp: f64,
    /// 10^k times longer than wide.
    pub aspect: f64,
    /// Which facets run clockwise, seen from above. Contact has them opposed; the kernel need not.
    pub clockwise: [bool; 2],
    /// Place in space: Euler angles, size, offset over the size.
    pub angles: [f64; 3],
    pub size: f64,
    pub offset: f64,
}

fn exponent(low: i32, high: i32) -> impl Strategy<Value = f64> {
    (low..=high).prop_map(|k| 10f64.powi(k))
}

fn relation() -> impl Strategy<Value = Relation> {
    prop_oneof![
        4 => Just(Relation::Free),
        2 => (1..=16).prop_map(Relation::Turned),
        2 => (0..=15).prop_map(Relation::Strip),
        1 => Just(Relation::OnEdge),
        1 => Just(Relation::OnVertex),
        1 => (-4..=4).prop_map(Relation::Sized),
    ]
}

/// Any pair.
pub fn recipes() -> impl Strategy<Value = Recipe> {
    let shape = (
        [3usize..=4, 3usize..=4],
        proptest::collection::vec(-1.0..1.0f64, 24),
        relation(),
        prop_oneof![2 => Just(None), 1 => (0..=5).prop_map(|k| Some(1 << k))],
        prop_oneof![2 => Just(0.0), 1 => 0.0..0.1f64],
        prop_oneof![3 => Just(1.0), 1 => exponent(0, 4)],
        any::<[bool; 2]>(),
    );
    let place = (
        prop_oneof![Just([0.0; 3]), [-3.0..3.0f64, -3.0..3.0, -3.0..3.0]],
        prop_oneof![2 => Just(1.0), 1 => exponent(-9, 9)],
        prop_oneof![2 => Just(0.0), 1 => exponent(0, 6)],
    );
    (shape, place).prop_map(|((nodes, noise, relation, grid, warp, aspect, clockwise), (angles, size, offset))| {
        Recipe { nodes, noise, relation, grid, warp, aspect, clockwise, angles, size, offset }
    })
}

/// Pairs in the plane z = 0 with small whole coordinates: what lies on what is decided exactly.
pub fn whole_recipes() -> impl Strategy<Value = Recipe> {
    recipes().prop_map(|r| Recipe {
        grid: Some(r.grid.unwrap_or(8)),
        warp: 0.0,
        aspect: 1.0,
        angles: [0.0; 3],
        size: f64::from(r.grid.unwrap_or(8)),
        offset: 0.0,
        relation: match r.relation {
            Relation::Turned(_) | Relation::Sized(_) => Relation::Free,
            Relation::Strip(_) => Relation::OnEdge,
            other => other,
        },
        ..r
    })
}

impl Recipe {
    /// A facet on a circle with mild noise, counter-clockwise; convex unless the grid makes it otherwise.
    fn outline(&self, of: usize) -> Vec<Vec3> {
        let (n, noise) = (self.nodes[of], &self.noise[12 * of..12 * of + 12]);
        let at = |k: usize| {
            let angle = 3.0 * noise[11] + std::f64::consts::TAU * (k as f64 + 0.15 * noise[k]) / n as f64;
            let centre = Vec3::new(noise[8], noise[9], 0.1 * noise[10]) * 0.8;
            Vec3::new(angle.cos(), angle.sin(), self.warp * noise[4 + k]) + centre
        };
        (0..n).map(at).map(|p| self.snapped(p)).collect()
    }

    fn snapped(&self, p: Vec3) -> Vec3 {
        self.grid.map_or(p, |g| p.map(|v| (v * f64::from(g)).round() / f64::from(g)))
    }

    /// Before the pair is put in its place.
    fn shapes(&self) -> [Vec<Vec3>; 2] {
        let (one, mut two) = (self.outline(0), self.outline(1));
        let centre = one.iter().sum::<Vec3>() / one.len() as f64;
        let about = |by: f64, turn: f64| {
            let q = Rotation3::from_axis_angle(&Vec3::z_axis(), turn);
            one.iter().map(|x| q * (x - centre) * by + centre).collect::<Vec<_>>()
        };
        match self.relation {
            Relation::Free => {}
            Relation::Turned(k) => two = about(1.0, 10f64.powi(-k)),
            Relation::Sized(k) => two = about(10f64.powi(k), 0.0),
            Relation::Strip(k) => {
                // Turned half round and moved by a diagonal less the strip.
                let shift = (one[0] - centre) * 2.0 * (1.0 - if k == 0 { 0.0 } else { 10f64.powi(-k) });
                two = one.iter().map(|x| centre * 2.0 - x + shift).collect();
            }
            Relation::OnEdge => (two[0], two[1]) = (one[1], one[0]),
            Relation::OnVertex => two[0] = one[(self.nodes[1] + 1) % one.len()],
        }
        let stretch = |p: &Vec3| Vec3::new(p.x * self.aspect, p.y, p.z);
        [one, two].map(|x| x.iter().map(stretch).collect())
    }

    /// The nodes of both facets.
    pub fn points(&self) -> [Vec<Vec3>; 2] {
        let q = Rotation3::from_euler_angles(self.angles[0], self.angles[1], self.angles[2]);
        let offset = Vec3::new(1.0, -0.7, 0.4) * self.offset;
        let mut shapes = self.shapes();
        for (x, clockwise) in shapes.iter_mut().zip(self.clockwise) {
            x.iter_mut().for_each(|p| *p = (q * *p + offset) * self.size);
            if clockwise {
                x.reverse();
            }
        }
        shapes
    }

    /// The pair, or `None` where it is refused.
    pub fn pair(&self) -> Option<Pair> {
        let [one, two] = self.points();
        Pair::new(Facet::new(&one).ok()?, Facet::new(&two).ok()?)
    }
}

/// A pair that the kernel takes.
pub struct Pair {
    pub one: Facet,
    pub two: Facet,
    pub frame: NonmortarFrame,
    pub segment: Option<Segment>,
}

impl Pair {
    /// `None` where a facet is degenerate, folded, not convex, or too steep.
    pub fn new(one: Facet, two: Facet) -> Option<Pair> {
        let frame = NonmortarFrame::new(&one).ok()?;
        let segment = Segment::new(&frame, &two).ok()?;
        Some(Pair { one, two, frame, segment })
    }

    /// The pair with nodes at these places.
    pub fn at(one: &[Vec3], two: &[Vec3]) -> Option<Pair> {
        Pair::new(Facet::new(one).ok()?, Facet::new(two).ok()?)
    }

    pub fn weights(&self, rule: &Rule) -> PairWeights {
        self.segment.as_ref().map(|s| PairWeights::integrate(&self.frame, s, rule)).unwrap_or_default()
    }

    pub fn derivatives(&self, rule: &Rule) -> WeightDerivatives {
        self.segment.as_ref().map(|s| WeightDerivatives::integrate(&self.frame, s, rule).1).unwrap_or_default()
    }

    /// Area of the overlap.
    pub fn area(&self) -> f64 {
        self.segment.as_ref().map_or(0.0, |s| s.area)
    }

    /// The largest distance of a corner of the overlap from the first one.
    pub fn overlap_diameter(&self) -> f64 {
        let vertices = self.segment.as_ref().map_or(&[][..], |s| s.polygon.vertices());
        vertices.iter().map(|v| (v - vertices[0]).norm()).fold(0.0, f64::max)
    }

    /// What the inverse maps multiply rounding by: the largest over the smallest determinant of a facet's map, times
    /// its longest edge squared over twice its projected area.
    pub fn distortion(&self) -> f64 {
        let of = |map: &BilinearMap, edge: f64, area2: f64| {
            let [j, xi, eta] = map.determinant();
            let change = xi.abs() + eta.abs();
            (j + change) / (j - change).max(f64::EPSILON * j) * edge * edge / area2
        };
        let one = of(&self.frame.map, self.one.longest_edge(), self.frame.projection.area2);
        self.segment.as_ref().map_or(one, |s| one.max(of(&s.mortar_map, self.two.longest_edge(), s.mortar.area2)))
    }

    /// Whether the weights are integrated exactly by any rule.
    pub fn is_affine(&self) -> bool {
        self.frame.map.is_affine && self.segment.as_ref().is_none_or(|s| s.mortar_map.is_affine)
    }

    /// Nodes as derivatives count them, relative to the first one.
    pub fn nodes(&self) -> impl Iterator<Item = (usize, Vec3)> {
        let origin = self.one.nodes[0];
        let one = self.one.points().iter().enumerate().map(move |(k, x)| (k, x - origin));
        one.chain(self.two.points().iter().enumerate().map(move |(k, x)| (MORTAR + k, x - origin)))
    }

    /// The largest distance of a node from the first one.
    pub fn reach(&self) -> f64 {
        self.nodes().map(|(_, x)| x.norm()).fold(0.0, f64::max)
    }

    /// The smallest angle at which edges of the facets may cross, as the kernel sees it: below the tie they are one.
    pub fn smallest_angle(&self) -> f64 {
        let edges = |f: &Facet| (0..f.len()).map(|k| f.nodes[f.shape.next[k]] - f.nodes[k]).collect::<Vec<_>>();
        let sine = |a: &Vec3, b: &Vec3| self.frame.plane.e.dot(&a.cross(b)).abs() / (a.norm() * b.norm());
        let (one, two) = (edges(&self.one), edges(&self.two));
        let all = one.iter().flat_map(|a| two.iter().map(move |b| sine(a, b)));
        all.filter(|sine| *sine > TIE).fold(1.0, f64::min)
    }

    /// The smallest height of either facet, projected: twice its area over its longest edge.
    pub fn smallest_height(&self) -> f64 {
        let one = self.frame.projection.area2 / self.one.longest_edge();
        self.segment.as_ref().map_or(one, |s| one.min(s.mortar.area2 / self.two.longest_edge()))
    }

    /// All weights in a row, with their derivatives.
    pub fn rows(w: &PairWeights, d: &WeightDerivatives) -> Vec<(f64, [Vec3; 8])> {
        let flat = |n: &[[f64; 4]; 4]| n.iter().flatten().copied().collect::<Vec<f64>>();
        let rows = |d: &[[[[f64; 3]; 8]; 4]; 4]| d.iter().flatten().map(|r| r.map(Vec3::from)).collect::<Vec<_>>();
        let (ab, ac) = (flat(&w.ab), flat(&w.ac));
        ab.into_iter().chain(ac).zip(rows(&d.ab).into_iter().chain(rows(&d.ac))).collect()
    }

    /// What the weights move by when every coordinate moves by a rounding (`eps` of the largest): their conditioning.
    /// The edges' own speed, reach times the smaller size, also where a derivative is one-sided; and the error of the
    /// rule, where there is one, from comparing it with a finer one.
    pub fn sensitivity(&self, eps: f64) -> f64 {
        let (coarse, fine) = (self.weights(&DEGREE_5), self.weights(&DEGREE_10));
        let (rows, finer) = (Pair::rows(&coarse, &self.derivatives(&DEGREE_5)), Pair::rows(&fine, &Default::default()));
        let offset = self.one.points().iter().chain(self.two.points()).map(|x| x.amax()).fold(0.0, f64::max);
        let shake = eps * offset.max(self.reach());
        let smaller = self.one.longest_edge().min(self.two.longest_edge());
        let motion = rows.iter().map(|(_, d)| d.iter().map(|d| d.norm()).sum::<f64>()).fold(smaller, f64::max);
        let rule = if self.is_affine() {
            0.0
        } else {
            rows.iter().zip(&finer).map(|((a, _), (b, _))| (a - b).abs()).fold(0.0, f64::max)
        };
        shake * motion + RULE_ESTIMATE * rule
    }
}

/// What the kernel takes for lines that coincide (`edge_interval`).
const TIE: f64 = 1e-13;
/// The error of the degree-5 rule over its difference from the degree-10 one: 1, and as much again where both err or
/// the cells of two evaluations differ.
pub const RULE_ESTIMATE: f64 = 2.0;
