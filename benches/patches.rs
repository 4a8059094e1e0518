//! An interface of two patches, as `studies/effects/effects_probe.c` has it: 16 x 16 quadrilaterals, bent a little,
//! that slide over 19 x 19 that move; or that lie turned in space over as many, node over node, hardly sliding.

use nalgebra::{Rotation3, Vector3};
use stickslip::geometry::Vec3;
use stickslip::interface::{Counters, Interface, Options, Sink, Stiffness, Surface};

const N1: usize = 16;
const N2: usize = 19;
/// Of the larger patch, about that from 0 to 1.
const RIM: f64 = 0.3;
const DEPTH: f64 = 0.001;
/// How far it slides before each evaluation: 1/20 of a facet, back and forth.
const SLIDE: f64 = 0.003;
/// The same where nodes lie over each other: positions are new, and edges all but coincide.
const TREMBLE: f64 = 1e-14;

/// Takes the entries of a tangent at no cost.
struct Total(f64);

impl Sink for Total {
    fn add(&mut self, _: i64, _: i64, value: f64) {
        self.0 += value;
    }

    fn add_block(&mut self, _: &[i64], _: &[i64], values: &[f64]) {
        self.0 += values[0];
    }
}

pub struct Patches {
    contact: Interface,
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<Vector3<f64>>,
    slide: f64,
}

pub fn patch(n: usize, low: f64, high: f64, up: bool) -> (Vec<Vec3>, Vec<Vec<i64>>) {
    let at = |k: usize| low + (high - low) * k as f64 / n as f64;
    let x = (0..(n + 1) * (n + 1)).map(|k| Vec3::new(at(k % (n + 1)), at(k / (n + 1)), 0.0)).collect();
    let facet = |f: usize| {
        let a = ((f / n) * (n + 1) + f % n) as i64;
        let m = n as i64 + 1;
        if up { vec![a, a + 1, a + m + 1, a + m] } else { vec![a, a + m, a + m + 1, a + 1] }
    };
    (x, (0..n * n).map(facet).collect())
}

pub fn equations(n: usize, first: usize) -> Vec<[i64; 3]> {
    (0..n).map(|a| [0, 1, 2].map(|i| (first + 3 * a + i) as i64)).collect()
}

impl Patches {
    pub fn new(matching: bool) -> Patches {
        let (n2, rim, slide) = if matching { (N1, 0.0, TREMBLE) } else { (N2, RIM, SLIDE) };
        let ((mut x1, facets1), (mut x2, facets2)) = (patch(N1, 0.0, 1.0, false), patch(n2, -rim, 1.0 + rim, true));
        for x in &mut x1 {
            x.z = -DEPTH * (1.0 + 0.5 * (3.0 * x.y).sin());
        }
        if matching {
            let turn = Rotation3::from_euler_angles(0.3, 0.7, 1.1);
            x1.iter_mut().chain(&mut x2).for_each(|x| *x = turn * *x);
        }
        let (n1, n2) = (x1.len(), x2.len());
        let upper = Surface::new("nonmortar", x1.clone(), &facets1, equations(n1, 0)).expect("a patch");
        let lower = Surface::new("mortar", x2.clone(), &facets2, equations(n2, 3 * n1)).expect("a patch");
        let mut options = Options::paper(Stiffness::Modulus(1000.0));
        options.mu = 0.3;
        let contact = Interface::new(upper, lower, equations(n1, 3 * (n1 + n2)), options).expect("an interface");
        let lambda = vec![Vec3::new(0.0, 0.0, -1.0); n1];
        Patches { contact, x1, x2, lambda, slide }
    }

    /// Pairs active now.
    pub fn pairs(&self) -> usize {
        self.contact.active_pairs()
    }

    pub fn counters(&self) -> Counters {
        self.contact.counters()
    }

    /// Search, integration, law and forces at new positions.
    pub fn residual(&mut self) -> f64 {
        self.x1.iter_mut().for_each(|x| x.x += self.slide);
        self.slide = -self.slide;
        self.contact.residual(&self.x1, &self.x2, &self.lambda, None).expect("a residual").rows[0].z
    }

    /// The tangent where the residual was.
    pub fn tangent(&mut self) -> f64 {
        let mut sink = Total(0.0);
        self.contact.tangent(&self.x1, &self.x2, &self.lambda, None, &mut sink).expect("a tangent");
        sink.0
    }
}
