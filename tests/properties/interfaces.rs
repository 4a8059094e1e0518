//! Laws of an interface as a whole: balance, invariance, the tangent, functions without memory.

use super::{angles, config};
use crate::support::differences::Point;
use crate::support::mesh::{Cells, Mesh, Random, interface, options};
use crate::support::{max_abs, mesh::grid};
use nalgebra::Rotation3;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Form, Interface, MultiplierBasis, Normals, Options, Residual, RowScale, Scheme, Stiffness, Weights,
};
use stickslip::law::{SlipMeasure, State};
use stickslip::quadrature::{DEGREE_10, cell};

/// 7.2, 7.2, K4: rounding of sums over all pairs, relative to the sum of the terms' sizes.
const SUMS: f64 = 1e-13;
/// The same with dual multipliers, whose functions reach 1e4 on facets of which little is covered.
const SUMS_OF_DUAL: f64 = 1e-10;
/// 7.4: a rotated copy has rounded coordinates; over the size of the facets, times the slopes of the states.
const ROTATED: f64 = 1e-11;
/// K2 on facets that stay affine, as in `tangent.rs`.
const DIFFERENCES: f64 = 1e-7;
/// A wrong tangent is wrong at all of so many places, a kink lies within a step of the differences of one.
const TRIALS: usize = 4;
/// How far these lie apart: a thousand steps.
const ASIDE: f64 = 1e-3;

#[derive(Clone, Debug)]
struct Recipe {
    cells: [bool; 2],
    counts: [usize; 2],
    /// Angle of the mortar grid, and where it lies.
    turn: f64,
    shift: [f64; 2],
    /// Out of plane and in plane, over the facet size.
    warp: f64,
    jitter: f64,
    slide: [f64; 3],
    grid: Option<f64>,
    form: bool,
    slip: u8,
    weights: u8,
    mu: f64,
    seed: u64,
}

fn recipes() -> impl Strategy<Value = Recipe> {
    let geometry = (
        any::<[bool; 2]>(),
        [1..=3usize, 1..=4usize],
        prop_oneof![Just(0.0), -0.8..0.8f64, (1..=16i32).prop_map(|k| 10f64.powi(-k))],
        prop_oneof![Just([0.0; 2]), [-0.5..0.5f64, -0.5..0.5]],
        prop_oneof![Just(0.0), 0.0..0.08f64],
        prop_oneof![Just(0.0), 0.0..0.1f64],
        [-0.6..0.6f64, -0.6..0.6, -0.02..0.02],
        prop_oneof![2 => Just(None), 1 => (3..=6i32).prop_map(|k| Some(2f64.powi(k)))],
    );
    let law = (any::<bool>(), 0..3u8, 0..3u8, prop_oneof![Just(0.0), 0.0..2.0f64, Just(1e6)], any::<u64>());
    (geometry, law).prop_map(
        |((cells, counts, turn, shift, warp, jitter, slide, grid), (form, slip, weights, mu, seed))| Recipe {
            cells,
            counts,
            turn,
            shift,
            warp,
            jitter,
            slide,
            grid,
            form,
            slip,
            weights,
            mu,
            seed,
        },
    )
}

/// An interface and where it is evaluated.
struct Scene {
    interface: Interface,
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<Vec3>,
}

impl Recipe {
    fn options(&self) -> Options {
        Options {
            form: if self.form { Form::Augmented } else { Form::Multiplier },
            slip: [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper][usize::from(self.slip)],
            weights: [Weights::Current, Weights::Committed, Weights::Reference][usize::from(self.weights)],
            // They go with the weights of now alone.
            normals: if self.weights == 0 && (self.seed / 15).is_multiple_of(2) {
                Normals::Current
            } else {
                Normals::Committed
            },
            mu: self.mu,
            scheme: match self.seed / 3 % 5 {
                0 => Scheme::Elements(cell::line_of(3).unwrap()),
                1 => Scheme::Hybrid(cell::line_of(4).unwrap()),
                _ => Scheme::Segments,
            },
            basis: if self.seed.is_multiple_of(3) { MultiplierBasis::Dual } else { MultiplierBasis::Standard },
            ..options()
        }
    }

    /// Reference meshes, then the positions of both sides; facets of size 1.
    fn places(&self) -> ([Mesh; 2], [Vec<Vec3>; 2]) {
        let mut random = Random(self.seed);
        let kind = |triangles| if triangles { Cells::Triangles } else { Cells::Quads };
        let [n, m] = self.counts;
        let mut one = grid(n, n, [0.0; 2], [n as f64; 2], 0.0, false, kind(self.cells[0]));
        let mut two = grid(m, m, [0.0; 2], [m as f64; 2], 0.0, true, kind(self.cells[1]));
        let q = Rotation3::from_axis_angle(&Vec3::z_axis(), self.turn);
        let mut rough = |x: &Vec3, much: f64| {
            x + Vec3::new(random.next() * self.jitter, random.next() * self.jitter, random.next() * self.warp) * much
        };
        one.x.iter_mut().for_each(|x| *x = rough(x, 1.0));
        let shift = Vec3::new(self.shift[0], self.shift[1], 0.0);
        two.x.iter_mut().for_each(|x| *x = rough(&(q * *x + shift), 1.0));
        let slide = Vec3::from(self.slide);
        let tilt = Rotation3::from_euler_angles(0.01, -0.02, 0.0);
        let mut x = [
            one.x.iter().map(|x| tilt * rough(x, 0.2) + slide).collect(),
            two.x.iter().map(|x| rough(x, 0.2)).collect::<Vec<_>>(),
        ];
        if let Some(grid) = self.grid {
            let snap = |x: &mut Vec<Vec3>| x.iter_mut().for_each(|x| *x = x.map(|v| (v * grid).round() / grid));
            [&mut one.x, &mut two.x].into_iter().chain(&mut x).for_each(snap);
        }
        ([one, two], x)
    }

    /// The scene seen through `map`; `None` where it is refused.
    fn scene(&self, options: Options, map: impl Fn(&Vec3) -> Vec3, stress: impl Fn(&Vec3) -> Vec3) -> Option<Scene> {
        let (reference, x) = self.places();
        let mapped = |x: &[Vec3]| x.iter().map(&map).collect::<Vec<_>>();
        let meshes = reference.map(|m| Mesh { x: mapped(&m.x), facets: m.facets });
        let mut interface = create(&meshes, options)?;
        let [x1, x2] = x.map(|x| mapped(&x));
        let mut random = Random(!self.seed);
        let lambda: Vec<_> = meshes[0]
            .x
            .iter()
            .map(|_| stress(&Vec3::new(0.3 * random.next(), 0.3 * random.next(), -0.5 + 0.7 * random.next())))
            .collect();
        interface.residual(&x1, &x2, &lambda, None).ok()?;
        Some(Scene { interface, x1, x2, lambda })
    }

    fn plain(&self) -> Option<Scene> {
        self.scene(self.options(), |x| *x, |l| *l)
    }
}

fn create([one, two]: &[Mesh; 2], options: Options) -> Option<Interface> {
    // Layers and folds are refused, and that is no matter of these laws.
    std::panic::catch_unwind(|| interface(one, two, options)).ok()
}

impl Scene {
    fn residual(&mut self) -> Residual {
        self.interface.residual(&self.x1, &self.x2, &self.lambda, None).unwrap()
    }

    fn point(&mut self) -> Point<'_, 3> {
        Point { contact: &mut self.interface, x1: &self.x1, x2: &self.x2, lambda: &self.lambda }
    }

    fn states(&mut self) -> Vec<State> {
        let responses = self.interface.responses(&self.x1, &self.x2, &self.lambda, None).unwrap();
        responses.iter().map(|r| r.state).collect()
    }

    /// The traction that the forces use.
    fn tractions(&mut self) -> Vec<Vec3> {
        if self.interface.options().form == Form::Multiplier {
            return self.lambda.clone();
        }
        let responses = self.interface.responses(&self.x1, &self.x2, &self.lambda, None).unwrap();
        responses.iter().map(|r| r.traction).collect()
    }
}

fn sums_bound(s: &Scene) -> f64 {
    if s.interface.options().basis == MultiplierBasis::Dual { SUMS_OF_DUAL } else { SUMS }
}

/// 7.2, 7.2: forces balance, moments are those of the gaps.
fn balance(s: &mut Scene) -> TestCaseResult {
    let bound = sums_bound(s);
    let (r, t) = (s.residual(), s.tractions());
    let sums = s.interface.sums(&s.x1, &s.x2).unwrap();
    let forces = || r.nonmortar.iter().chain(&r.mortar);
    prop_assert!(forces().chain(&r.rows).all(|f| f.iter().all(|v| v.is_finite())));
    // The weights add up relative to the overlaps, also those of nodes whose own share of these is tiny.
    let overlap: f64 = sums.iter().map(|s| s.coverage).sum();
    let scale = forces().map(|f| f.norm()).sum::<f64>() + overlap * t.iter().map(|t| t.norm()).fold(0.0, f64::max);
    let sum: Vec3 = forces().sum();
    prop_assert!(sum.norm() <= bound * scale, "sum of forces {:e} of {scale:e}", sum.norm());
    if s.interface.options().weights == Weights::Current {
        let moments: Vec3 = s.x1.iter().chain(&s.x2).zip(forces()).map(|(x, f)| x.cross(f)).sum();
        let gaps: Vec3 = sums.iter().zip(&t).map(|(s, t)| s.gap_now.cross(t)).sum();
        let reach = s.x1.iter().chain(&s.x2).map(|x| x.norm()).fold(0.0, f64::max);
        prop_assert!((moments - gaps).norm() <= bound * scale * reach, "moments {moments:?}, of the gaps {gaps:?}");
    }
    Ok(())
}

/// K4: force rows add up to nothing, and a translation of all changes nothing.
fn tangent_balance(s: &mut Scene) -> TestCaseResult {
    let bound = sums_bound(s);
    let mut point = s.point();
    let (k, n) = (point.tangent(), point.unknowns());
    let x = 3 * (s.x1.len() + s.x2.len());
    prop_assert!(k.iter().all(|v| v.is_finite()));
    // In the augmented form a node's two products cancel between its pairs, relative to the largest entry.
    let scale = max_abs(k.iter().copied());
    for j in 0..n {
        for c in 0..3 {
            let column: f64 = (c..x).step_by(3).map(|i| k[i * n + j]).sum();
            let row: f64 = (c..x).step_by(3).map(|i| k[j * n + i]).sum();
            prop_assert!(column.abs() <= 10.0 * bound * scale, "column {j}: {column:e} of {scale:e}");
            prop_assert!(row.abs() <= 10.0 * bound * scale, "row {j} under a translation: {row:e} of {scale:e}");
        }
    }
    Ok(())
}

/// A, B, A give the same bits, and so do a copy made by export and import and a step taken back.
fn has_no_memory(s: &mut Scene, recipe: &Recipe) -> TestCaseResult {
    let first = (s.residual(), s.point().tangent());
    let history = s.interface.export_history().unwrap();
    let away: Vec<_> = s.x1.iter().map(|x| x + Vec3::new(0.3, -0.2, 0.01)).collect();
    let committed = s.interface.commit(&away, &s.x2, &s.lambda, None).is_ok();
    if committed {
        s.interface.roll_back().unwrap();
    }
    prop_assert!(first == (s.residual(), s.point().tangent()), "A, B, A");
    prop_assert!(history == s.interface.export_history().unwrap(), "the history after a step taken back");
    let mut copy = recipe.plain().expect("it was taken before");
    copy.interface.import_history(&history.0, &history.1).unwrap();
    prop_assert!(first == (copy.residual(), copy.point().tangent()), "a copy from the exported history");
    Ok(())
}

fn close(a: &[Vec3], b: &[Vec3], allowed: f64, what: &str) -> TestCaseResult {
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
    prop_assert!(apart <= allowed, "{what}: {apart:e}, allowed {allowed:e}");
    Ok(())
}

proptest! {
    #![proptest_config(config(file!(), 30))]

    #[test]
    fn laws_of_any_interface(recipe in recipes()) {
        let Some(mut scene) = recipe.plain() else { return Ok(()) };
        balance(&mut scene)?;
        tangent_balance(&mut scene)?;
        has_no_memory(&mut scene, &recipe)?;
    }

    /// 7.5, I4: units by powers of two change no bit.
    #[test]
    fn units_change_no_bit(recipe in recipes(), length in -60..60i32, stress in -60..60i32) {
        let (a, b) = (2f64.powi(length), 2f64.powi(stress));
        let base = Options { row_scale: RowScale::None, ..recipe.options() };
        let Stiffness::Augmentation(r) = base.stiffness else { unreachable!() };
        let scaled = Options { stiffness: Stiffness::Augmentation(r * b / a), ..base };
        let scenes = (recipe.scene(base, |x| *x, |l| *l), recipe.scene(scaled, |x| x * a, |l| l * b));
        let (Some(mut s), Some(mut t)) = scenes else { return Ok(()) };
        let times = |v: &[Vec3], s: f64| v.iter().map(|v| v * s).collect::<Vec<_>>();
        let (r, q) = (s.residual(), t.residual());
        prop_assert_eq!(q.nonmortar, times(&r.nonmortar, a * a * b));
        prop_assert_eq!(q.mortar, times(&r.mortar, a * a * b));
        prop_assert_eq!(q.rows, times(&r.rows, a * a * a));
    }

    /// 7.4, I1: a scene turned and moved as one has a turned residual.
    #[test]
    fn rigid_motion_turns_the_residual(recipe in recipes(), angles in angles(), far in -10.0..10.0f64) {
        let q = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        let shift = Vec3::new(far, 0.5 * far, -far);
        let recipe = Recipe { mu: recipe.mu.min(2.0), ..recipe };
        // A finer rule: where cells of other shape come about by rounding, the rule's error is no part of the law. And no
        // points: one that lies on a mortar edge passes it by rounding.
        let options = Options { rule: &DEGREE_10, scheme: Scheme::Segments, ..recipe.options() };
        let scenes = (recipe.scene(options, |x| *x, |l| *l), recipe.scene(options, |x| q * x + shift, |l| q * l));
        let (Some(mut s), Some(mut t)) = scenes else { return Ok(()) };
        let turn = |v: &[Vec3]| v.iter().map(|v| q * v).collect::<Vec<_>>();
        let rule = if recipe.warp > 0.0 || recipe.jitter > 0.0 || recipe.grid.is_some() { RULE } else { 0.0 };
        let (r, u) = (s.residual(), t.residual());
        let scale = r.nonmortar.iter().chain(&r.rows).map(|f| f.amax()).fold(1.0, f64::max);
        close(&turn(&r.nonmortar), &u.nonmortar, (ROTATED + rule) * scale, "non-mortar forces")?;
        close(&turn(&r.mortar), &u.mortar, (ROTATED + rule) * scale, "mortar forces")?;
        close(&turn(&r.rows), &u.rows, (ROTATED + rule) * scale, "rows")?;
    }

    /// K2: every column of the tangent, of facets that stay affine.
    #[test]
    fn tangent_equals_differences(recipe in recipes()) {
        // In general position: at coincident edges, and where weights are newly covered, there are two derivatives.
        let recipe = Recipe {
            cells: [true; 2], counts: [1, recipe.counts[1].min(2)], grid: None, turn: 0.4 + 0.3 * recipe.turn,
            jitter: 0.05 + 0.3 * recipe.jitter, shift: recipe.shift.map(|s| 0.13 + s), ..recipe
        };
        let Some(mut scene) = recipe.plain() else { return Ok(()) };
        // At the place itself or, where a border or a change of topology is too near for differences, close to it.
        let mut random = Random(recipe.seed);
        let mut errors = Vec::new();
        for _ in 0..TRIALS {
            let error = scene.point().difference_error(0.0);
            if error <= DIFFERENCES {
                return Ok(());
            }
            errors.push(error);
            for x in scene.x1.iter_mut().chain(&mut scene.lambda) {
                *x += random.vector(ASIDE);
            }
        }
        prop_assert!(false, "{errors:?} with {:?}", scene.states());
    }
}

/// The degree-10 rule's error on quads as rough as these.
const RULE: f64 = 1e-7;

/// A law that is hardly ever tested holds easily.
#[test]
fn most_recipes_make_interfaces_in_contact() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let strategy = recipes();
    let drawn = 300;
    let mut seen = [0; 3];
    let mut taken = 0;
    for _ in 0..drawn {
        let recipe = proptest::strategy::ValueTree::current(&strategy.new_tree(&mut runner).unwrap());
        let Some(mut scene) = recipe.plain() else { continue };
        taken += 1;
        for (k, state) in [State::Gap, State::Stick, State::Slip].into_iter().enumerate() {
            seen[k] += i32::from(scene.states().contains(&state));
        }
    }
    assert!(4 * taken > 3 * drawn && seen.iter().all(|n| 5 * n > drawn), "{taken} of {drawn} taken, states {seen:?}");
}
