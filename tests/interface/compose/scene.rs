//! Two small patches for every kind of facet and of mortar side: they do not match, are curved, and overlap in part.

use super::choice::Choice;
use crate::support::lines::{self, lines, plane_equations};
use crate::support::mesh::{Mesh, Random, numbered, under};
use crate::support::parents::{self, grid_of};
use nalgebra::{Rotation3, SVector};
use stickslip::error::Result;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{
    Decision, Form, Friction, MortarSide, MultiplierBasis, NO_EQUATION, NO_WEAK_COVERAGE, NewContact, Normals, Options,
    RowScale, Scheme, Stiffness, Surface, Tangent, Weights,
};
use stickslip::law::SlipMeasure;
use stickslip::line::Measure;
use stickslip::mortar::MultiplierSpace;
use stickslip::quadrature::{DEGREE_10, cell};

/// Of the bodies below both surfaces.
const MODULUS: f64 = 1000.0;
/// The radius of both surfaces, eight times their size: curved, and no facet is turned by more than some degrees.
const RADIUS: f64 = 8.0;
/// How far axisymmetric models are from their axis.
const FROM_AXIS: f64 = 0.3;

/// The surfaces, and which nodes have multipliers.
pub struct Scene {
    pub choice: Choice,
    pub one: Mesh,
    /// Of an analytic surface the points of its frame, and no facets.
    pub two: Mesh,
    pub has_row: Vec<bool>,
}

/// Where an interface is looked at.
#[derive(Clone)]
pub struct At<const N: usize> {
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub lambda: Vec<SVector<f64, N>>,
}

fn shape(choice: &Choice) -> AnalyticShape {
    let is_line = choice.has_lines();
    match choice.of("mortar").trim_start_matches('m') {
        "plane" if is_line => AnalyticShape::Line,
        "plane" => AnalyticShape::Plane,
        _ if is_line => AnalyticShape::Circle(RADIUS),
        "sphere" => AnalyticShape::Sphere(RADIUS),
        _ => AnalyticShape::Cylinder(RADIUS),
    }
}

/// The points of a frame as the library wants them.
fn frame(shape: AnalyticShape) -> Vec<Vec3> {
    let (centre, up) = (-RADIUS * Vec3::z(), Vec3::z());
    let of = |origin: Vec3, axis: Vec3, first: Vec3, second: Vec3| {
        vec![origin, origin + axis, origin + first, origin + second]
    };
    match shape {
        AnalyticShape::Plane => of(Vec3::new(0.4, 0.4, 0.0), up, Vec3::x(), Vec3::y()),
        AnalyticShape::Sphere(_) => of(centre, up, Vec3::x(), Vec3::y()),
        AnalyticShape::Cylinder(_) => of(centre, Vec3::y(), Vec3::x(), up),
        AnalyticShape::Line => [[0.4, 0.0], [0.4, 1.0], [1.4, 0.0]].map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
        AnalyticShape::Circle(_) => {
            [[0.0, -RADIUS], [0.0, 1.0 - RADIUS], [1.0, -RADIUS]].map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec()
        }
    }
}

/// How far a point of a surface with this shape lies below the plane that touches it.
fn depth(x: Vec3, shape: AnalyticShape) -> f64 {
    let away = match shape {
        AnalyticShape::Plane | AnalyticShape::Line => return 0.0,
        AnalyticShape::Sphere(_) => x.x.hypot(x.y),
        AnalyticShape::Cylinder(_) | AnalyticShape::Circle(_) => x.x,
    };
    RADIUS - (RADIUS * RADIUS - away * away).sqrt()
}

impl Scene {
    pub fn new(choice: Choice) -> Scene {
        let is_line = choice.has_lines();
        let [kind1, kind2] = match choice.of("facet") {
            "tri3" => [3, 3],
            "tri6" => [6, 6],
            "quad8" => [8, 8],
            "quad9" => [9, 9],
            "mixed" => [8, 3],
            "line2p" | "line2a" => [2, 2],
            "line3p" | "line3a" => [3, 3],
            _ => [4, 4],
        };
        let (mut one, mut two) = if is_line {
            (lines(4, kind1, [0.0, 1.0], false), lines(3, kind2, [-0.2, 0.84], true))
        } else {
            let one = grid_of(3, 2, [0.0, 0.0], [1.0, 0.8], false, &[kind1]);
            (one, grid_of(2, 3, [-0.25, -0.22], [0.84, 1.02], true, &[kind2]))
        };
        let curved = if is_line { AnalyticShape::Circle(RADIUS) } else { AnalyticShape::Sphere(RADIUS) };
        let of_one = if choice.is_analytic() { shape(&choice) } else { curved };
        let down = if is_line { -Vec3::y() } else { -Vec3::z() };
        let from_axis = if choice.is_axisymmetric() { FROM_AXIS * Vec3::x() } else { Vec3::zeros() };
        let is_ball = choice.is_analytic() && !matches!(of_one, AnalyticShape::Line | AnalyticShape::Plane);
        for (mesh, shape) in [(&mut one, of_one), (&mut two, curved)] {
            for x in &mut mesh.x {
                // Facets that are no parallelograms, and mid nodes beside the middle.
                let bend = if is_line { Vec3::zeros() } else { Vec3::new((3.0 * x.y).sin(), (2.0 * x.x).cos(), 0.0) };
                *x += 0.03 * bend;
                if is_ball {
                    *x += from_axis; // a ball's centre is on the axis
                }
                *x += down * depth(*x, shape);
                if !is_ball {
                    *x += from_axis;
                }
            }
        }
        if choice.is_analytic() {
            let offset = if is_ball { Vec3::zeros() } else { from_axis };
            two = Mesh { x: frame(of_one).into_iter().map(|x| x + offset).collect(), facets: Vec::new() };
        }
        let space = if choice.is("space", "sub") { MultiplierSpace::Sub } else { MultiplierSpace::Corner };
        let has_row = if is_line { lines::has_row(&one, space) } else { parents::has_row(&one, space) };
        Scene { choice, one, two, has_row }
    }

    /// The same somewhere else, turned and then shifted: along the axis alone in axisymmetric models, and not turned where directions are
    /// given in space.
    pub fn elsewhere(&self) -> (Scene, Rotation3<f64>, Vec3) {
        let by = match (self.choice.is_axisymmetric(), self.choice.has_lines()) {
            (true, _) => Vec3::new(0.0, -1.3, 0.0),
            (_, true) => Vec3::new(0.7, -1.3, 0.0),
            _ => Vec3::new(0.7, -1.3, 0.4),
        };
        let has_directions = self.choice.is("law", "orthotropic") || !self.choice.is("extra", "no");
        let turn = match has_directions || self.choice.is_axisymmetric() {
            true => Rotation3::identity(),
            false => self.rotation(Vec3::new(0.8, -0.5, 1.1)),
        };
        let moved =
            |mesh: &Mesh| Mesh { x: mesh.x.iter().map(|x| turn * x + by).collect(), facets: mesh.facets.clone() };
        let scene =
            Scene { choice: self.choice, one: moved(&self.one), two: moved(&self.two), has_row: self.has_row.clone() };
        (scene, turn, by)
    }

    pub fn down(&self) -> Vec3 {
        if self.choice.has_lines() { -Vec3::y() } else { -Vec3::z() }
    }

    /// Components of a position that are unknowns.
    pub fn axes(&self) -> usize {
        if self.choice.has_lines() { 2 } else { 3 }
    }

    /// Components of a multiplier that are unknowns.
    pub fn components<const N: usize>(&self) -> usize {
        if N == 1 { 1 } else { self.axes() }
    }

    /// Whether the nodes of the mortar side, or of its frame, have equations.
    pub fn mortar_moves(&self) -> bool {
        self.choice.is("mortar", "deformable") || self.choice.frame_moves()
    }

    pub fn options(&self) -> Options {
        let c = &self.choice;
        let friction = match c.of("law") {
            "none" => Friction::None,
            "tresca" => Friction::Tresca,
            "tied" => Friction::Tied,
            "rough" => Friction::Rough,
            _ => Friction::Coulomb,
        };
        let mu = if c.is("law", "mu0") { 0.0 } else { 0.3 };
        let of = under(friction, mu, Options::paper(Stiffness::Modulus(MODULUS)));
        Options {
            shear_limit: of.shear_limit.map(|_| 1.0),
            basis: if c.is("basis", "dual") { MultiplierBasis::Dual } else { MultiplierBasis::Standard },
            space: if c.is("space", "sub") { MultiplierSpace::Sub } else { MultiplierSpace::Corner },
            normals: if c.is("normals", "current") { Normals::Current } else { Normals::Committed },
            decision: if c.is("decision", "points") { Decision::Points(1.0) } else { Decision::Nodes },
            form: if c.is("form", "augmented") { Form::Augmented } else { Form::Multiplier },
            weights: match c.of("weights") {
                "committed" => Weights::Committed,
                "reference" => Weights::Reference,
                "conserving" => Weights::Conserving,
                _ => Weights::Current,
            },
            slip: match c.of("slip") {
                "increment" => SlipMeasure::Increment,
                "paper" => SlipMeasure::Paper,
                _ => SlipMeasure::Objective,
            },
            mortar_side: if c.is("mortar", "rigid") { MortarSide::Rigid } else { of.mortar_side },
            weak_coverage: match c.of("weak") {
                "none" => NO_WEAK_COVERAGE,
                "half" => 0.5,
                _ => 0.0,
            },
            threads: if c.is("threads", "4") { 4 } else { 1 },
            scheme: match c.of("integration") {
                "elements" => Scheme::Elements(cell::line_of(6).unwrap()), // facets that are hardly covered have some points, too
                "hybrid" => Scheme::Hybrid(cell::line_of(3).unwrap()),
                _ => Scheme::Segments,
            },
            tangent: match c.of("tangent") {
                "frozen_weights" => Tangent::FrozenWeights,
                "frozen_normals" => Tangent::FrozenNormals,
                _ => Tangent::Exact,
            },
            // Derivatives by what is no unknown hold the scale of rows, and want exact weights.
            row_scale: if c.is("derivatives", "no") { of.row_scale } else { RowScale::None },
            rule: if c.is("derivatives", "no") { of.rule } else { &DEGREE_10 },
            new_contact: if c.is("new_contact", "friction") { NewContact::KeepFriction } else { of.new_contact },
            ..of
        }
    }

    /// Both surfaces, the mortar side of these facets alone, with nodes numbered `kept`.
    pub fn surfaces(&self, two: &Mesh, kept: &[usize]) -> Result<(Surface, Surface)> {
        let (n1, n2, c) = (self.one.x.len(), self.two.x.len(), &self.choice);
        let numbers = |first: usize, n: usize| -> Vec<[i64; 3]> {
            let mut all = numbered(first, n);
            if c.has_lines() {
                let two = plane_equations(0, n);
                all.iter_mut().zip(two).for_each(|(all, two)| all[2] = two[2]);
            }
            all
        };
        let mut mortar = vec![[NO_EQUATION; 3]; n2];
        if self.mortar_moves() {
            mortar = numbers(3 * n1, n2);
        }
        let mortar: Vec<_> = kept.iter().map(|&k| mortar[k]).collect();
        let measure = if c.is_axisymmetric() { Measure::Axisymmetric } else { Measure::Thickness(1.0) };
        let surface = |side, mesh: &Mesh, equations: Vec<[i64; 3]>| match c.has_lines() {
            true => Surface::of_lines(side, mesh.x.clone(), &mesh.facets, equations, measure),
            false => Surface::new(side, mesh.x.clone(), &mesh.facets, equations),
        };
        let one = surface("nonmortar", &self.one, numbers(0, n1))?;
        if !c.is_analytic() {
            return Ok((one, surface("mortar", two, mortar)?));
        }
        let mut two = Surface::analytic("mortar", shape(c), self.two.x.clone())?;
        two.equations = mortar;
        Ok((one, two))
    }

    /// Equations of the multipliers.
    pub fn multipliers<const N: usize>(&self) -> Vec<[i64; N]> {
        let (first, per) = (3 * (self.one.x.len() + self.two.x.len()), self.components::<N>());
        let number = |a: usize, i: usize| {
            if self.has_row[a] && i < per { (first + N * a + i) as i64 } else { NO_EQUATION }
        };
        (0..self.one.x.len()).map(|a| std::array::from_fn(|i| number(a, i))).collect()
    }

    /// Where the first (0) or the second step (1) is looked at: pressed on one side and open on the other.
    pub fn at<const N: usize>(&self, step: usize) -> At<N> {
        let (c, down, mut random) = (&self.choice, self.down(), Random(17 + step as u64));
        let mut noise = |size: f64| {
            let v = random.vector(size);
            if c.has_lines() { Vec3::new(v.x, v.y, 0.0) } else { v }
        };
        let across = |x: Vec3| x - down * x.dot(&down);
        let left = self.one.x.iter().map(|x| x.x).fold(f64::INFINITY, f64::min);
        let (later, tilt) = (step as f64, |x: &Vec3| -0.5 + 2.2 * (x.x - left));
        let x1: Vec<_> = self
            .one
            .x
            .iter()
            .map(|x| {
                let deeper = 2.5e-3 * tilt(x) * (1.0 + 0.2 * later) * down;
                x + deeper + noise(3e-4) + across(noise(6e-3)) * later
            })
            .collect();
        let shift = Vec3::new(2e-3, 0.0, 0.0) - 5e-4 * down;
        let turn = noise(1e-3) * (1.0 + later);
        let moved = noise(1e-3) * (1.0 + later);
        let rotation = self.rotation(turn);
        let x2 = self.two.x.iter().map(|x| match c.of("mortar") {
            "deformable" => x + noise(3e-4),
            _ if c.frame_moves() => rotation * (x - self.two.x[0]) + self.two.x[0] + moved,
            _ => x + shift * later,
        });
        let x2 = x2.collect();
        let of_node = |(x, has): (&Vec3, &bool)| {
            let pressure = 6.0 * (x.x - left) - 0.4;
            let l = pressure * down + noise(0.5);
            let l = if N == 1 { Vec3::new(l.dot(&-down), 0.0, 0.0) } else { l };
            if *has { SVector::from_fn(|i, _| l[i]) } else { SVector::zeros() }
        };
        At { x1, x2, lambda: self.one.x.iter().zip(&self.has_row).map(of_node).collect() }
    }

    /// About this vector; of lines about the third axis.
    pub fn rotation(&self, vector: Vec3) -> Rotation3<f64> {
        Rotation3::new(if self.choice.has_lines() { Vec3::new(0.0, 0.0, vector.x) } else { vector })
    }
}
