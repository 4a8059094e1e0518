//! An interface in parts, each with a handle of its own (docs/host_parallel.md, "Parts that own nodes"): what the parts have adds up to what the
//! whole has, on random partitions of random curved interfaces, over several steps.

use super::plan;
use crate::support::mesh::*;
use crate::support::parents::{Kind, grid_of};
use crate::support::parts::{Part, part, rings};
use nalgebra::{DMatrix, SVector};
use proptest::prelude::*;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Decision, Form, Friction, MultiplierBasis, NO_WEAK_COVERAGE, Normals, Options, Scheme, Weights,
};
use stickslip::law::SlipMeasure;
use stickslip::mortar::MultiplierSpace;
use stickslip::quadrature::{DEGREE_10, cell};

/// Sums of the same numbers in another order, over the largest of their kind.
pub const ROUNDING: f64 = 1e-13;
/// Rings of facets around the nodes that a part owns. The pair of a facet depends on the bulges of both, and these on the
/// normals of neighbours' neighbours.
pub const RINGS: usize = 3;
/// The same where nodes carry others: four facets to a node that is carried, four from there to its other carriers, one to the
/// best covered neighbour that says whether these are strong, and the three around it.
pub const RINGS_OF_CARRIERS: usize = 12;
/// The same where points decide: a facet needs the gaps of all of its nodes, and so one ring more that is integrated.
const RINGS_OF_POINTS: usize = 4;
/// Of these the first eight are needed where carriers are covered as a whole.
pub const RINGS_OF_COVERED_CARRIERS: usize = 8;

/// The step whose tangents are compared with those of plans, which takes most of the time.
const PLANNED: usize = 1;

/// Before this step the interface is shared out anew.
const REPARTITIONED: usize = 1;

/// What is drawn at random.
#[derive(Clone, Debug)]
pub struct Recipe {
    cells: [bool; 2],
    counts: [usize; 4],
    parts: usize,
    bend: f64,
    /// How far a step goes, in facets, and how deep the bodies are in each other from the start.
    slide: f64,
    pub depth: f64,
    choices: [u8; 6],
    pub mu: f64,
    pub seed: u64,
    /// Nodes of the facets of both sides, where they are quadratic; none: `cells`.
    kinds: Option<[Kind; 2]>,
}

pub fn recipes() -> impl Strategy<Value = Recipe> {
    let counts = [4..=24usize, 2..=4usize, 3..=16usize, 2..=4usize];
    let bend = prop_oneof![2 => -0.03..0.03f64, 1 => -0.3..0.3f64];
    let shape = (bend, prop_oneof![2 => Just(0.17), 1 => -4.0..1.0f64], prop_oneof![2 => Just(0.0), 1 => 0.0..1.5f64]);
    let numbers = (2..=5usize, prop_oneof![Just(0.0), 0.0..1.0f64], any::<u64>());
    (any::<[bool; 2]>(), counts, any::<[u8; 6]>(), shape, numbers).prop_map(
        |(cells, counts, choices, (bend, slide, depth), (parts, mu, seed))| Recipe {
            cells,
            counts,
            parts,
            bend,
            slide,
            depth,
            choices,
            mu,
            seed,
            kinds: None,
        },
    )
}

/// Positions of both sides, and multipliers.
pub type At<const N: usize> = ([Vec<Vec3>; 2], Vec<SVector<f64, N>>);

/// An interface, its parts, and where the steps lead.
pub struct Scene<const N: usize> {
    pub whole: Contact<N>,
    pub parts: Vec<Part<N>>,
    pub steps: Vec<At<N>>,
    pub around: usize,
}

/// The mortar facets that a part needs: with `search_distance` those that come nearer to its facets than that and their own
/// longest edge, with two rings around them; without it all.
fn opposite<const N: usize>([one, two]: [&Mesh; 2], scene: &Scene<N>, own: &[bool]) -> Vec<usize> {
    let all = 0..two.facets.len();
    let Some(distance) = scene.whole.options().search_distance else { return all.collect() };
    let acting = rings(one, own.to_vec(), if scene.around == RINGS { 1 } else { scene.around });
    let corners = |x: &[Vec3], facet: &[i64]| facet.iter().map(|&k| x[k as usize]).collect::<Vec<_>>();
    let apart = |p: &[Vec3], q: &[Vec3]| {
        let bounds =
            |x: &[Vec3]| (x.iter().fold(x[0], |low, x| low.inf(x)), x.iter().fold(x[0], |high, x| high.sup(x)));
        let ((low1, high1), (low2, high2)) = (bounds(p), bounds(q));
        (low1 - high2).sup(&(low2 - high1)).max()
    };
    let is_near = |j: &usize| {
        let places = scene.steps.iter().map(|([x1, x2], _)| (x1, x2)).chain([(&one.x, &two.x)]);
        places.into_iter().any(|(x1, x2)| {
            let q = corners(x2, &two.facets[*j]);
            let longest = (0..q.len()).map(|k| (q[k] - q[(k + 1) % q.len()]).norm()).fold(0.0, f64::max);
            acting.iter().any(|&i| apart(&corners(x1, &one.facets[i]), &q) <= distance + longest)
        })
    };
    let mut nodes = vec![false; two.x.len()];
    all.filter(is_near).for_each(|j| two.facets[j].iter().for_each(|&k| nodes[k as usize] = true));
    let found = rings(two, nodes, RINGS - 1);
    if found.is_empty() { vec![0] } else { found } // a surface has at least one
}

impl Recipe {
    pub fn options(&self) -> Options {
        let [form, slip, weights, scheme, basis, weak] = self.choices;
        let weights =
            [Weights::Current, Weights::Current, Weights::Committed, Weights::Reference][usize::from(weights % 4)];
        Options {
            form: if form % 2 == 0 { Form::Multiplier } else { Form::Augmented },
            slip: [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper][usize::from(slip % 3)],
            weights,
            normals: if weights == Weights::Current && form % 4 < 2 { Normals::Current } else { Normals::Committed },
            rule: if weak % 5 == 0 { &DEGREE_10 } else { options().rule },
            scheme: match scheme % 6 {
                0 => Scheme::Elements(cell::line_of(3).unwrap()),
                1 => Scheme::Hybrid(cell::line_of(4).unwrap()),
                _ => Scheme::Segments,
            },
            basis: if basis % 2 == 0 { MultiplierBasis::Standard } else { MultiplierBasis::Dual },
            weak_coverage: if weak % 2 == 0 { 0.4 } else { NO_WEAK_COVERAGE },
            search_distance: (form / 4 % 2 == 0).then_some(0.5 + self.depth),
            turn_max: 1.0,
            mu: self.mu,
            ..options()
        }
    }

    /// Reference meshes: a curved surface over a turned one that covers a part of it.
    fn meshes(&self, random: &mut Random) -> [Mesh; 2] {
        let kind = |triangles| if triangles { Cells::Triangles } else { Cells::Quads };
        let [n, m, p, q] = self.counts;
        let size = [n as f64, m as f64];
        let mut one = grid(n, m, [0.0; 2], size, 0.0, false, kind(self.cells[0]));
        let far = [0.6, 1.1, 1.3][(self.seed % 3) as usize] * size[0];
        let mut two = grid(p, q, [-0.3, -0.4], [far, 1.1 * size[1]], 0.0, true, kind(self.cells[1]));
        if let Some([kind1, kind2]) = self.kinds {
            one = grid_of(n as i64, m as i64, [0.0; 2], size, false, &[kind1]);
            two = grid_of(p as i64, q as i64, [-0.3, -0.4], [far, 1.1 * size[1]], true, &[kind2]);
        }
        for (mesh, depth) in [(&mut one, self.depth), (&mut two, 0.0)] {
            for x in &mut mesh.x {
                x.z -= depth;
                *x += Vec3::new(0.08 * random.next(), 0.08 * random.next(), 0.01 * random.next());
                x.z += self.bend * ((x.x - 0.4 * size[0]).powi(2) + 0.7 * (x.y - 0.5 * size[1]).powi(2));
            }
        }
        [one, two]
    }

    /// With so many rings; `None` where the whole is refused.
    pub fn scene<const N: usize>(&self, options: Options, around: usize) -> Option<Scene<N>>
    where
        Contact<N>: Create<N>,
    {
        let mut random = Random(self.seed);
        let [one, two] = self.meshes(&mut random);
        let all: Vec<usize> = (0..two.facets.len()).collect();
        let whole = part::<N>((&one, &two), options, (vec![true; one.x.len()], 1), &all).ok()?.contact;
        let steps = (1..4).map(|step| {
            let slide = Vec3::new(self.slide, 0.08, -0.012) * f64::from(step);
            let mut moved = |x: &Vec3, by: Vec3| x + by + random.vector(0.004);
            let x1 = one.x.iter().map(|x| moved(x, slide)).collect();
            let x2 = two.x.iter().map(|x| moved(x, Vec3::zeros())).collect();
            let mut component =
                |i: usize| if N == 1 || i == 2 { -0.5 + 0.7 * random.next() } else { 0.3 * random.next() };
            let lambda = (0..one.x.len()).map(|_| SVector::from_fn(|i, _| component(i))).collect();
            ([x1, x2], lambda)
        });
        let steps: Vec<_> = steps.collect();
        let mut scene = Scene { whole, parts: Vec::new(), steps, around };
        scene.parts = self.parts([&one, &two], &scene, 0);
        Some(scene)
    }

    /// A random partition of it.
    fn parts<const N: usize>(&self, [one, two]: [&Mesh; 2], scene: &Scene<N>, which: u64) -> Vec<Part<N>>
    where
        Contact<N>: Create<N>,
    {
        let mut random = Random(self.seed ^ (which + 1));
        let some_node = |_| ((random.next() + 1.0) / 2.0 * one.x.len() as f64) as usize % one.x.len();
        let seeds: Vec<usize> = (0..self.parts).map(some_node).collect();
        let owner = |a: usize| {
            let distance = |k: &usize| (one.x[seeds[*k]] - one.x[a]).norm();
            (0..self.parts).min_by(|p, q| distance(p).total_cmp(&distance(q))).unwrap()
        };
        let of_part = |p: usize| {
            let own: Vec<bool> = (0..one.x.len()).map(|a| owner(a) == p).collect();
            let opposite = opposite([one, two], scene, &own);
            let has_any = own.contains(&true); // seeds may coincide
            has_any.then(|| part((one, two), *scene.whole.options(), (own, scene.around), &opposite).unwrap())
        };
        (0..self.parts).filter_map(of_part).collect()
    }
}

/// The largest component of an error over that of what is right.
pub fn over<const N: usize>(found: &[SVector<f64, N>], right: &[SVector<f64, N>]) -> f64 {
    let largest = |v: &mut dyn Iterator<Item = SVector<f64, N>>| v.map(|v| v.amax()).fold(0.0, f64::max);
    let error = largest(&mut found.iter().zip(right).map(|(a, b)| a - b));
    if error == 0.0 { 0.0 } else { error / largest(&mut right.iter().copied()) }
}

/// How far the parts are from the whole in a step, in residual and tangent, and whether anything else differs; `None` where the
/// whole is refused, or a part. Commits.
fn step<const N: usize>(scene: &mut Scene<N>, k: usize) -> Option<(f64, f64, bool)> {
    let ([x1, x2], lambda) = scene.steps[k].clone();
    let (n1, n2) = (x1.len(), x2.len());
    let n = 3 * (n1 + n2) + N * n1;
    let right = scene.whole.residual(&x1, &x2, &lambda, None).ok()?;
    let states: Vec<_> = scene.whole.responses(&x1, &x2, &lambda, None).unwrap().iter().map(|r| r.state).collect();
    let mut tangent = DMatrix::<f64>::zeros(n, n);
    let mut add = |i: i64, j: i64, v: f64| tangent[(i as usize, j as usize)] += v;
    scene.whole.tangent(&x1, &x2, &lambda, None, &mut add).unwrap();
    let mut sum = [vec![Vec3::zeros(); n1], vec![Vec3::zeros(); n2]];
    let (mut rows, mut of_parts) = (vec![SVector::<f64, N>::zeros(); n1], DMatrix::<f64>::zeros(n, n));
    let mut same = true;
    for part in &mut scene.parts {
        let (x1, x2, lambda) = part.at(&x1, &x2, &lambda);
        let r = part.contact.residual(&x1, &x2, &lambda, None).ok()?;
        part.nodes[0].iter().zip(&r.nonmortar).for_each(|(&a, f)| sum[0][a] += f);
        part.nodes[1].iter().zip(&r.mortar).for_each(|(&c, f)| sum[1][c] += f);
        let responses = part.contact.responses(&x1, &x2, &lambda, None).unwrap().to_vec();
        for (k, &a) in part.nodes[0].iter().enumerate() {
            rows[a] += r.rows[k];
            if part.own[k] {
                same &= responses[k].state == states[a];
                same &= part.contact.normal(k).unwrap() == scene.whole.normal(a).unwrap();
            } else {
                same &= r.rows[k] == SVector::<f64, N>::zeros();
            }
        }
        let mut add = |i: i64, j: i64, v: f64| of_parts[(i as usize, j as usize)] += v;
        part.contact.tangent(&x1, &x2, &lambda, None, &mut add).unwrap();
        if k == PLANNED {
            plan::agrees(&mut part.contact, &x1, &x2, &lambda, "a part");
        }
        part.contact.commit(&x1, &x2, &lambda, None).ok()?;
    }
    scene.whole.commit(&x1, &x2, &lambda, None).ok()?;
    let host_pairs = |c: &Contact<N>| c.history().pairs.iter().map(|p| p.one).collect::<Vec<_>>();
    for part in &scene.parts {
        let options = scene.whole.options();
        let sees_more = options.effective_weak_coverage() > 0.0 || options.decides_at_points();
        let facets = &part.contact.surfaces().0.facets;
        let acts = |f: usize| facets[f].as_slice().iter().any(|&k| part.own[k]);
        same &= sees_more || host_pairs(&part.contact).into_iter().all(acts);
        let (of_part, of_whole) = (part.contact.history(), scene.whole.history());
        for (k, &a) in part.nodes[0].iter().enumerate().filter(|(k, _)| part.own[*k]) {
            same &= of_part.normals[k] == of_whole.normals[a] && of_part.areas[k] == of_whole.areas[a];
            same &= of_part.slip.get(k) == of_whole.slip.get(a);
        }
    }
    let residual = over(&sum[0], &right.nonmortar).max(over(&sum[1], &right.mortar)).max(over(&rows, &right.rows));
    Some((residual, (of_parts - &tangent).amax() / tangent.amax(), same))
}

/// Another partition, which goes on from where the step before `k` ended.
fn again<const N: usize>(recipe: &Recipe, scene: &Scene<N>, k: usize) -> Vec<Part<N>>
where
    Contact<N>: Create<N>,
{
    let meshes = recipe.meshes(&mut Random(recipe.seed));
    let mut parts = recipe.parts([&meshes[0], &meshes[1]], scene, 1);
    let [x1, x2] = &scene.steps[k - 1].0;
    let mut slip = vec![Vec3::zeros(); x1.len()];
    for part in &scene.parts {
        let of_part = &part.contact.history().slip;
        let own = part.nodes[0].iter().enumerate().filter(|(k, _)| part.own[*k] && !of_part.is_empty());
        own.for_each(|(k, &a)| slip[a] = of_part[k]);
    }
    for part in &mut parts {
        let (x1, x2, slip) = (part.of(0, x1), part.of(1, x2), part.of(0, &slip));
        part.contact.set_committed(&x1, &x2, &slip, k as i64).unwrap();
    }
    parts
}

fn agree<const N: usize>(recipe: &Recipe, options: Options) -> Result<(), TestCaseError>
where
    Contact<N>: Create<N>,
{
    let carries = options.effective_weak_coverage() > 0.0;
    // What is deep is seen from farther away where the surfaces are curved.
    let of_points = if options.decides_at_points() { RINGS_OF_POINTS } else { RINGS };
    let around = if carries { RINGS_OF_CARRIERS } else { of_points } + recipe.depth.ceil() as usize;
    let scene = recipe.scene::<N>(options, around);
    prop_assume!(scene.is_some());
    let mut scene = scene.unwrap();
    for k in 0..scene.steps.len() {
        if k == REPARTITIONED {
            scene.parts = again(recipe, &scene, k);
        }
        let found = step(&mut scene, k);
        prop_assume!(k > 0 || found.is_some());
        let Some((residual, tangent, same)) = found else { return Ok(()) };
        prop_assert!(residual <= ROUNDING, "step {k}: residual {residual:e}");
        prop_assert!(tangent <= ROUNDING, "step {k}: tangent {tangent:e}");
        prop_assert!(same, "step {k}: states, normals, areas or slip differ");
    }
    Ok(())
}

/// A strip of twenty facets over two plates below its ends; a third one slides below the middle, where seven nodes in a row come into
/// contact, so that nodes from both ends carry them. The strip is cut behind its node `cut`.
fn bridged(cut: usize, around: usize) -> Scene<3> {
    let plate = |from: f64, to: f64, y: f64| grid(3, 2, [from, y - 0.2], [to, y + 1.3], 0.0, true, Cells::Quads);
    let mut one = grid(20, 1, [0.0; 2], [20.0, 1.0], 0.0, false, Cells::Quads);
    let mut random = Random(5);
    one.x.iter_mut().for_each(|x| *x += random.vector(0.002));
    let mut two = plate(-0.5, 6.1, 0.0);
    for more in [plate(13.9, 20.5, 0.0), plate(6.15, 13.85, 30.0)] {
        let first = two.x.len() as i64;
        two.facets.extend(more.facets.iter().map(|f| f.iter().map(|k| k + first).collect::<Vec<_>>()));
        two.x.extend(more.x);
    }
    let options = Options { weak_coverage: 0.4, basis: MultiplierBasis::Dual, ..options() };
    let whole = interface(&one, &two, options);
    let all: Vec<usize> = (0..two.facets.len()).collect();
    let is_left = |a: usize| a % 21 <= cut;
    let of_part = |left: bool| {
        let own = (0..one.x.len()).map(|a| is_left(a) == left).collect();
        part((&one, &two), options, (own, around), &all).unwrap()
    };
    let slid = |x: &Vec3| if x.y > 20.0 { x - Vec3::new(0.0, 30.0, 0.0) } else { *x };
    let x = [one.x.iter().map(|x| x - Vec3::new(0.0, 0.0, 0.01)).collect(), two.x.iter().map(slid).collect()];
    let lambda = one.x.iter().map(|_| Vec3::new(0.05, 0.02, -0.5) + random.vector(0.02)).collect();
    Scene { whole, parts: vec![of_part(true), of_part(false)], steps: vec![(x, lambda)], around }
}

/// Wherever the strip is cut, eight rings are enough, and seven are not.
#[test]
fn nodes_that_carry_others_need_further_rings() {
    let enough = |around: usize| {
        (0..20).all(|cut| {
            let mut scene = bridged(cut, around);
            let (residual, tangent, same) = step(&mut scene, 0).unwrap();
            assert!(scene.whole.counters().nodes.carried > 0);
            residual <= ROUNDING && tangent <= ROUNDING && same
        })
    };
    assert!(enough(RINGS_OF_CARRIERS));
    assert!(enough(RINGS_OF_COVERED_CARRIERS) && !enough(RINGS_OF_COVERED_CARRIERS - 1));
}

proptest! {
    #![proptest_config(crate::support::random::cases(80))]

    /// All laws, both bases and forms, weights, normals, schemes, with and without carried nodes.
    #[test]
    fn parts_add_up_to_the_whole(recipe in recipes(), law in 0..5usize) {
        let law = [Friction::Coulomb, Friction::None, Friction::Tied, Friction::Rough, Friction::Tresca][law];
        let options = under(law, recipe.mu, recipe.options());
        match law {
            Friction::None => agree::<1>(&recipe, options)?,
            _ => agree::<3>(&recipe, options)?,
        }
    }

}

proptest! {
    // Half a second each.
    #![proptest_config(crate::support::random::cases(20))]

    /// The same of quadratic facets.
    #[test]
    fn parts_of_quadratic_facets_add_up_to_the_whole(recipe in recipes(), kinds in any::<[prop::sample::Index; 2]>()) {
        let kinds = Some(kinds.map(|kind| *kind.get(&[6, 8, 9])));
        let recipe = Recipe { kinds, bend: 0.1 * recipe.bend, depth: 0.0, ..recipe };
        let (form, normals, scheme) = (Form::Multiplier, Normals::Committed, Scheme::Segments);
        let space = if recipe.seed.is_multiple_of(2) { MultiplierSpace::Corner } else { MultiplierSpace::Sub };
        let options = Options { form, normals, scheme, space, ..recipe.options() };
        agree::<3>(&recipe, options)?;
    }

    /// The same where points decide, which remember nothing without friction.
    #[test]
    fn parts_where_points_decide_add_up_to_the_whole(recipe in recipes(), kinds in any::<[prop::sample::Index; 2]>()) {
        let kinds = (recipe.seed % 4 == 0).then(|| kinds.map(|kind| *kind.get(&[6, 8, 9])));
        let bend = if kinds.is_some() { 0.1 * recipe.bend } else { recipe.bend };
        let recipe = Recipe { kinds, bend, depth: 0.0, ..recipe };
        let (form, scheme) = (Form::Multiplier, Scheme::Segments);
        let of = Options { form, scheme, basis: MultiplierBasis::Dual, weak_coverage: 0.0, ..recipe.options() };
        let weights = if kinds.is_some() { Weights::Committed } else { of.weights };
        let normals = if weights == Weights::Current { of.normals } else { Normals::Committed };
        let options = Options { weights, normals, decision: Decision::Points(1.0), ..of };
        agree::<1>(&recipe, under(Friction::None, 0.0, options))?;
    }
}
