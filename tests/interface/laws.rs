//! Laws of one's own in place of Coulomb's (docs/formulation 4.8): the tangent against differences, what each of them is where it
//! is Coulomb's, what they remember, what is refused.

use super::weak;
use crate::support::differences::Point;
use crate::support::lines::moved_lines;
use crate::support::mesh::*;
use crate::support::parents::moved_parents;
use nalgebra::SVector;
use stickslip::error::{Error, Kind, Result};
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Form, Friction, Interface, MultiplierBasis, NO_WEAK_COVERAGE, NewContact, Normals, Options, Owner, Scales,
    Weights,
};
use stickslip::law::{Answer, Ellipse, Host, Own, Question, SlipMeasure, State, Threshold};
use stickslip::line::Measure;
use stickslip::mortar::MultiplierSpace;
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// The tangent against differences, relative to the largest entry of a block.
const DIFFERENCES: f64 = 1e-7;
/// Two ways to the same number, over the largest one.
const SAME: f64 = 1e-14;
/// Coefficients of `moved`, whose nodes slip at some tenths.
const MU: f64 = 0.7;
const BASES: [MultiplierBasis; 2] = [MultiplierBasis::Standard, MultiplierBasis::Dual];
const FORMS: [Form; 2] = [Form::Multiplier, Form::Augmented];

/// A law of a host that depends on all that it may: pressure, each component of the slip, the slip before, its states.
fn some_law(host: &Host, q: &Question, states: &mut [f64]) -> Result<Answer> {
    const POWER: f64 = 0.9;
    let (slope, p) = (host.words[0] as f64 * 0.1, -q.normal);
    let along = Vec3::new(0.3, -0.5, 0.2);
    let factor = 1.0 + along.dot(&q.slip) * slope + 0.5 * slope * q.slip.norm_squared() + 0.1 * q.slip_before.norm();
    let (size, older) = (q.mu * p.powf(POWER), 0.1 + 0.01 * q.states[1]);
    states[0] = q.states[0] + q.slip.norm();
    states[1] = q.states[1] + 1.0;
    Ok(Answer {
        threshold: Threshold { radius: older + size * factor, fall: POWER * size / p * factor },
        slope: (along + q.slip) * (slope * size),
    })
}

/// Coulomb's law as a host would write it.
fn coulomb(_: &Host, q: &Question, _: &mut [f64]) -> Result<Answer> {
    Ok(Answer { threshold: Threshold { radius: -q.mu * q.normal, fall: q.mu }, slope: Vec3::zeros() })
}

fn host(ask: fn(&Host, &Question, &mut [f64]) -> Result<Answer>, states: usize) -> Own {
    Own::Host(Host { ask, words: [7, 0], states, base: 0 })
}

/// Along a direction that is along no axis of `moved`.
fn ellipse(across: f64) -> Own {
    Own::Orthotropic(Ellipse { direction: Vec3::new(2.0, -1.0, 0.7), across })
}

/// Every law, with numbers that make it differ from Coulomb's.
fn laws() -> [Own; 6] {
    [
        Own::Rate { after: 0.2, rate: 0.4, time: 0.3 },
        Own::Cohesion { cohesion: 0.1 },
        Own::Weakening { after: 0.2, slip: 0.15 },
        Own::Weakening { after: 0.2, slip: 0.01 },
        ellipse(0.2),
        host(some_law, 2),
    ]
}

/// Those that are Coulomb's.
fn coulombs() -> [Own; 5] {
    [
        Own::Rate { after: MU, rate: 0.1, time: 1.0 },
        Own::Cohesion { cohesion: 0.0 },
        Own::Weakening { after: MU, slip: 0.1 },
        ellipse(MU),
        host(coulomb, 0),
    ]
}

fn error<const N: usize>(contact: &mut Contact<N>, x: (&[Vec3], &[Vec3]), lambda: &[SVector<f64, N>]) -> f64 {
    Point { contact, x1: x.0, x2: x.1, lambda }.difference_error(0.0)
}

#[test]
fn tangents_equal_differences() {
    let mut seen = [0; 3];
    for own in laws() {
        for (what, rough, cells) in rough_scenes(0.05) {
            let rule = if cells[1] == Cells::Quads { &DEGREE_10 } else { &DEGREE_5 };
            for (form, basis) in FORMS.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))) {
                for (weights, slip) in [
                    (Weights::Current, SlipMeasure::Objective),
                    (Weights::Current, SlipMeasure::Increment),
                    (Weights::Committed, SlipMeasure::Objective),
                ] {
                    for weak_coverage in [NO_WEAK_COVERAGE, 0.2] {
                        let of = Options { form, basis, weights, slip, weak_coverage, rule, mu: MU, ..options() };
                        let mut t = moved(&of, cells, rough, 3);
                        t.interface.set_law(Some(own)).unwrap();
                        let error = error(&mut t.interface, (&t.x1, &t.x2), &t.lambda);
                        let what = format!("{what} {form:?} {basis:?} {own:?} {weights:?} {slip:?} {weak_coverage}");
                        assert!(error <= DIFFERENCES, "{what}: {error:e}");
                        seen.iter_mut().zip(t.states()).for_each(|(all, here)| *all += here);
                    }
                }
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 50), "{seen:?}");
}

#[test]
fn tangents_with_carried_nodes_and_with_normals_of_now_equal_differences() {
    for own in laws() {
        for (form, basis) in FORMS.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))) {
            let of = Options { form, basis, weak_coverage: weak::WEAK, mu: MU, rule: &DEGREE_10, ..options() };
            let mut s = weak::scene::<3>(&of, Cells::Quads);
            s.contact.set_law(Some(own)).unwrap();
            let off = error(&mut s.contact, (&s.x1, &s.x2), &s.lambda);
            assert!(off <= DIFFERENCES, "carried, {form:?} {basis:?} {own:?}: {off:e}");
            assert!(s.contact.counters().nodes.carried > 0);
            if matches!(own, Own::Orthotropic(_)) {
                continue;
            }
            for slip in [SlipMeasure::Objective, SlipMeasure::Increment] {
                let normals = Normals::Current;
                let of = Options { normals, slip, weak_coverage: NO_WEAK_COVERAGE, rule: &DEGREE_5, ..of };
                let rough = Roughness { warp: 0.12, jitter: 0.08, slide: 0.02 };
                let mut t = moved(&of, [Cells::Triangles; 2], rough, 3);
                t.interface.set_law(Some(own)).unwrap();
                let off = error(&mut t.interface, (&t.x1, &t.x2), &t.lambda);
                assert!(off <= DIFFERENCES, "normals of now, {form:?} {basis:?} {slip:?} {own:?}: {off:e}");
            }
        }
    }
}

#[test]
fn tangents_of_quadratic_facets_and_of_lines_equal_differences() {
    for own in laws() {
        for (space, basis) in
            [(MultiplierSpace::Sub, MultiplierBasis::Standard), (MultiplierSpace::Corner, MultiplierBasis::Dual)]
        {
            let weak_coverage = if basis == MultiplierBasis::Dual { 0.4 } else { NO_WEAK_COVERAGE };
            let of = Options { space, basis, rule: &DEGREE_10, weak_coverage, mu: MU, ..options() };
            let mut s = moved_parents::<3>(&of, [&[8], &[9]], FLAT, 0.0, false, 3);
            s.contact.set_law(Some(own)).unwrap();
            let off = error::<3>(&mut s.contact, (&s.x1, &s.x2), &s.lambda);
            assert!(off <= DIFFERENCES, "{space:?} {basis:?} {own:?}: {off:e}");
            for measure in [Measure::Thickness(0.7), Measure::Axisymmetric] {
                let mut s = moved_lines::<3>(&of, [3, 2], measure, 5);
                if matches!(own, Own::Orthotropic(_)) {
                    assert_eq!(s.contact.set_law(Some(own)).unwrap_err().kind, Kind::Unsupported);
                    continue;
                }
                s.contact.set_law(Some(own)).unwrap();
                let off = s.difference_error();
                assert!(off <= DIFFERENCES, "lines, {measure:?} {space:?} {basis:?} {own:?}: {off:e}");
            }
        }
    }
}

#[test]
fn tangents_where_a_direction_is_prescribed_equal_differences() {
    for own in laws() {
        let of = Options { mu: MU, ..options() };
        let mut t = moved(&of, [Cells::Triangles; 2], FLAT, 3);
        t.interface.set_law(Some(own)).unwrap();
        let normal = t.interface.normal(0).unwrap();
        let across = normal.cross(&Vec3::new(0.3, 0.9, 0.1)).normalize();
        let all: Vec<_> = (0..t.x1.len()).map(|a| (a, across)).collect();
        t.interface.set_constraints(&all).unwrap();
        let off = error(&mut t.interface, (&t.x1, &t.x2), &t.lambda);
        assert!(off <= DIFFERENCES, "{own:?}: {off:e}");
    }
}

type Numbers = (Vec<f64>, Vec<(i64, i64, f64)>);

fn numbers(t: &mut Moved) -> Numbers {
    let r = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap();
    let all = r.nonmortar.iter().chain(&r.mortar).chain(&r.rows).flat_map(|v| v.iter().copied()).collect();
    let mut k = Vec::new();
    let mut sink = |i: i64, j: i64, v: f64| k.push((i, j, v));
    t.interface.tangent(&t.x1, &t.x2, &t.lambda, None, &mut sink).unwrap();
    (all, k)
}

fn off((a, k): &Numbers, (b, l): &Numbers) -> f64 {
    assert_eq!((a.len(), k.len()), (b.len(), l.len()));
    let largest = |v: &[f64]| v.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let residual = a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / largest(b);
    let entries: Vec<_> = l.iter().map(|e| e.2).collect();
    let tangent = k.iter().zip(l).fold(0.0_f64, |m, (a, b)| {
        assert_eq!((a.0, a.1), (b.0, b.1));
        m.max((a.2 - b.2).abs())
    });
    residual.max(tangent / largest(&entries))
}

/// In the residual, the tangent and the distance from equilibrium, over two steps.
#[test]
fn without_cohesion_with_one_coefficient_and_by_the_hosts_words_each_law_is_coulombs() {
    for own in coulombs() {
        for (form, basis) in FORMS.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))) {
            for new_contact in [NewContact::Frictionless, NewContact::KeepFriction] {
                let of = Options { form, basis, new_contact, mu: MU, ..options() };
                let rough = Roughness { warp: 0.05, jitter: 0.08, slide: 0.02 };
                let [mut plain, mut other] = [0, 1].map(|_| moved(&of, [Cells::Quads; 2], rough, 3));
                other.interface.set_law(Some(own)).unwrap();
                for step in 0..2 {
                    let error = off(&numbers(&mut other), &numbers(&mut plain));
                    assert!(error <= SAME, "{own:?} {form:?} {basis:?}, step {step}: {error:e}");
                    let [a, b] = [&mut plain, &mut other]
                        .map(|t| t.interface.equilibrium(&t.x1, &t.x2, &t.lambda, None, &Scales::default()).unwrap());
                    for (a, b) in [(a.gap, b.gap), (a.traction, b.traction), (a.slip, b.slip)] {
                        let stretched = matches!(own, Own::Orthotropic(_));
                        assert!((a.value - b.value).abs() <= SAME * a.value.max(a.scale), "{own:?} {stretched}");
                    }
                    assert_eq!(plain.interface.counters().nodes, other.interface.counters().nodes);
                    for t in [&mut plain, &mut other] {
                        t.interface.commit(&t.x1, &t.x2, &t.lambda, None).unwrap();
                        t.x1.iter_mut().for_each(|x| *x += Vec3::new(0.004, 0.003, -0.001));
                    }
                }
            }
        }
    }
}

/// A node that slips: the ellipse, and the right angle of slip and border.
#[test]
fn an_orthotropic_node_slips_at_a_right_angle_to_its_ellipse() {
    use stickslip::geometry::Mat3;
    use stickslip::law::{Law, Node, Orthotropic, Special};
    let (mu, across, pressure) = (0.6, 0.2, 3.0);
    let ellipse = Ellipse { direction: Vec3::new(1.0, 1.0, 5.0), across };
    let [one, two] = ellipse.axes(Vec3::z()).unwrap();
    assert!((one - Vec3::new(0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0)).amax() < 1e-15);
    for angle in 0..12 {
        let angle = 0.5 + f64::from(angle) * std::f64::consts::FRAC_PI_6;
        // On the border, and a slip along its normal: in equilibrium, whatever r.
        let (c, s) = (angle.cos(), angle.sin());
        let shear = (one * (mu * c) + two * (across * s)) * pressure;
        let slip = (one * (c / mu) + two * (s / across)) * 0.01;
        for r in [0.1, 3.0, 1e4] {
            let node = Node {
                lambda: shear - Vec3::z() * pressure,
                normal: Vec3::z(),
                augmentation: r,
                mu,
                shear_limit: f64::INFINITY,
                gap_now: Vec3::zeros(),
                gap_previous: slip,
                gap_committed: Vec3::zeros(),
                covered: true,
                covered_before: true,
                slip: SlipMeasure::Objective,
                free: Mat3::identity(),
                special: Special::Ellipse(ellipse),
            };
            let response = Orthotropic::respond(&node);
            assert_eq!(response.state, State::Slip);
            assert!((response.traction - node.lambda).amax() <= 1e-14 * pressure, "{r}");
            assert!((response.slip - slip).amax() <= 1e-15);
            assert!(response.row.amax() * r <= 1e-13 * pressure, "{r} {}", response.row);
        }
    }
}

/// States go with the history: commit, rollback, restart, and another handle that takes over.
#[test]
fn what_a_law_remembers_goes_with_the_history() {
    for (own, states) in [(Own::Weakening { after: 0.2, slip: 0.15 }, 1), (host(some_law, 2), 2)] {
        for (basis, weights) in BASES.into_iter().flat_map(|b| [Weights::Current, Weights::Reference].map(|w| (b, w))) {
            let of = Options { basis, weights, mu: MU, ..options() };
            let make = || {
                let mut t = moved(&of, [Cells::Quads; 2], FLAT, 3);
                t.interface.set_law(Some(own)).unwrap();
                t
            };
            let mut t = make();
            let n = t.x1.len();
            assert_eq!(t.interface.law_states(), vec![0.0; states * n]);
            let commit = |t: &mut Moved| t.interface.commit(&t.x1, &t.x2, &t.lambda, None);
            commit(&mut t).unwrap();
            let first = t.interface.law_states().to_vec();
            assert!(first.iter().any(|v| *v > 0.0), "{own:?}");
            let slipped = t.interface.history().slip.iter().map(|s| s.norm()).collect::<Vec<_>>();
            if states == 1 {
                for (a, way) in first.iter().enumerate() {
                    assert!(*way == 0.0 || (way - slipped[a]).abs() <= 1e-15, "{way} {}", slipped[a]);
                }
            }
            t.x1.iter_mut().for_each(|x| *x += Vec3::new(0.004, 0.003, -0.001));
            let there = numbers(&mut t);
            commit(&mut t).unwrap();
            assert!(t.interface.law_states().iter().zip(&first).any(|(a, b)| a > b));
            t.interface.roll_back().unwrap();
            assert_eq!(t.interface.law_states(), first);
            assert_eq!(off(&numbers(&mut t), &there), 0.0);
            // A restart; and a handle that takes the step over from this one.
            let exported = t.interface.export_history().unwrap();
            let size = t.interface.history_size().unwrap();
            assert_eq!(size, (exported.0.len(), exported.1.len()));
            let mut restarted = make();
            restarted.interface.import_history(&exported.0, &exported.1).unwrap();
            assert_eq!(restarted.interface.law_states(), first);
            restarted.x1 = t.x1.clone();
            assert_eq!(off(&numbers(&mut restarted), &there), 0.0);
            let mut taken = make();
            let history = t.interface.history().clone();
            taken.interface.set_committed(&history.x1, &history.x2, &history.slip, history.commits).unwrap();
            assert_eq!(taken.interface.law_states(), vec![0.0; states * n]);
            taken.interface.set_law_states(&first).unwrap();
            taken.x1 = t.x1.clone();
            assert_eq!(off(&numbers(&mut taken), &there), 0.0);
            // The history of another law, or of one with other states, is not this one's.
            let mut plain = moved(&of, [Cells::Quads; 2], FLAT, 3);
            let refused = plain.interface.import_history(&exported.0, &exported.1).unwrap_err();
            assert_eq!(refused.kind, Kind::HistoryMismatch, "{refused}");
            plain.interface.set_law(Some(host(some_law, 3))).unwrap();
            let refused = plain.interface.import_history(&exported.0, &exported.1).unwrap_err();
            assert_eq!(refused.kind, Kind::HistoryMismatch, "{refused}");
            let refused = t.interface.set_law_states(&first[1..]).unwrap_err();
            assert_eq!(refused.kind, Kind::InvalidSize);
            // The same kind goes on with its states, another forgets them.
            t.interface.set_law(Some(own)).unwrap();
            assert_eq!(t.interface.law_states(), first);
            t.interface.set_law(None).unwrap();
            assert!(t.interface.law_states().is_empty());
        }
    }
}

/// Which nodes a handle owns.
type Rule = fn(usize) -> bool;

/// Handles that own some nodes each: forces and rows add up to those of the whole, and what the law remembers is that of the
/// whole at the nodes that are owned; also after other handles, with other nodes, have taken over.
#[test]
fn parts_add_up_and_hand_on_what_the_law_remembers() {
    for (own, states) in [(Own::Weakening { after: 0.2, slip: 0.15 }, 1), (host(some_law, 2), 2)] {
        for basis in BASES {
            let of = Options { basis, mu: MU, ..options() };
            let with = |owners: Option<Rule>| {
                let mut t = moved(&of, [Cells::Quads; 2], FLAT, 3);
                if let Some(owns) = owners {
                    let here = |a| if owns(a) { Owner::Here } else { Owner::Elsewhere };
                    t.interface.set_owners((0..t.x1.len()).map(here).collect()).unwrap();
                }
                t.interface.set_law(Some(own)).unwrap();
                t
            };
            let mut whole = with(None);
            let n = whole.x1.len();
            let rules: [[Rule; 2]; 2] = [[|a| a < 4, |a| a >= 4], [|a| a % 3 == 0, |a| a % 3 != 0]];
            let mut parts = rules[0].map(|rule| with(Some(rule)));
            for (step, owns) in rules.into_iter().enumerate() {
                let right = numbers(&mut whole).0;
                let mut sum = vec![0.0; right.len()];
                for part in &mut parts {
                    part.x1.clone_from(&whole.x1);
                    sum.iter_mut().zip(numbers(part).0).for_each(|(to, v)| *to += v);
                    part.interface.commit(&part.x1, &part.x2, &part.lambda, None).unwrap();
                }
                let largest = right.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let error = sum.iter().zip(&right).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                assert!(error <= SAME * largest, "{own:?} {basis:?}, step {step}: {error:e}");
                whole.interface.commit(&whole.x1, &whole.x2, &whole.lambda, None).unwrap();
                let (mut kept, history) = (vec![f64::NAN; states * n], whole.interface.history().clone());
                for (part, owns) in parts.iter().zip(owns) {
                    for k in (0..states * n).filter(|k| owns(k / states)) {
                        kept[k] = part.interface.law_states()[k];
                    }
                }
                assert_eq!(kept, whole.interface.law_states(), "{own:?} {basis:?}, step {step}");
                parts = rules[1].map(|rule| with(Some(rule)));
                for part in &mut parts {
                    let (x1, x2) = (&history.x1, &history.x2);
                    part.interface.set_committed(x1, x2, &history.slip, history.commits).unwrap();
                    part.interface.set_law_states(&kept).unwrap();
                }
                whole.x1.iter_mut().for_each(|x| *x += Vec3::new(0.004, 0.003, -0.001));
            }
        }
    }
}

/// An answer that no evaluation can use is refused, names the node, and changes nothing.
#[test]
fn bad_answers_are_refused_and_change_nothing() {
    /// `words[1]`: what is wrong with it, from `BAD_NODE` on.
    fn bad(host: &Host, q: &Question, states: &mut [f64]) -> Result<Answer> {
        let mut answer = coulomb(host, q, states)?;
        states[0] = q.slip.norm();
        if q.node < host.words[0] {
            return Ok(answer);
        }
        match host.words[1] {
            0 => answer.threshold.radius = f64::NAN,
            1 => answer.threshold.radius = f64::INFINITY,
            2 => answer.threshold.radius = -1e-3,
            3 => answer.threshold.fall = -1e-6,
            4 => answer.threshold.fall = f64::NAN,
            5 => answer.slope.y = f64::INFINITY,
            6 => states[0] = f64::NAN,
            7 => return Err(Error::new(Kind::InvalidValue, "node of a law that has no answer")),
            _ => {}
        }
        Ok(answer)
    }
    let law = |wrong: usize| Own::Host(Host { ask: bad, words: [3, wrong], states: 1, base: 0 });
    let kinds = [
        Kind::NotFinite,
        Kind::NotFinite,
        Kind::InvalidValue,
        Kind::InvalidValue,
        Kind::NotFinite,
        Kind::NotFinite,
        Kind::NotFinite,
        Kind::InvalidValue,
    ];
    let mut t = moved(&Options { mu: MU, ..options() }, [Cells::Quads; 2], FLAT, 3);
    t.interface.set_law(Some(law(8))).unwrap();
    t.interface.commit(&t.x1, &t.x2, &t.lambda, None).unwrap();
    t.x1.iter_mut().for_each(|x| *x += Vec3::new(0.004, 0.003, -0.001));
    let (good, history) = (numbers(&mut t), t.interface.history().clone());
    for (wrong, kind) in kinds.into_iter().enumerate() {
        t.interface.set_law(Some(law(wrong))).unwrap();
        let refused = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap_err();
        assert_eq!(refused.kind, kind, "{refused}");
        assert!(refused.message.contains("node"), "{refused}");
        assert_eq!(t.interface.commit(&t.x1, &t.x2, &t.lambda, None).unwrap_err().kind, kind);
        assert!(*t.interface.history() == history);
        t.interface.set_law(Some(law(8))).unwrap();
        assert_eq!(off(&numbers(&mut t), &good), 0.0);
    }
}

#[test]
fn what_is_no_law_is_refused_by_name() {
    let refused = |i: &mut Interface, own: Own| i.set_law(Some(own)).unwrap_err();
    let mut t = moved(&Options { mu: MU, ..options() }, [Cells::Quads; 2], FLAT, 3);
    let before = numbers(&mut t);
    for (own, name) in [
        (Own::Cohesion { cohesion: -1.0 }, "cohesion"),
        (Own::Weakening { after: -0.1, slip: 1.0 }, "mu_after"),
        (Own::Weakening { after: 0.1, slip: 0.0 }, "critical_slip"),
        (ellipse(0.0), "mu_across"),
        (Own::Orthotropic(Ellipse { direction: Vec3::zeros(), across: 0.2 }), "direction"),
    ] {
        let e = refused(&mut t.interface, own);
        assert!(e.kind == Kind::InvalidValue && e.message.contains(name), "{e}");
    }
    assert_eq!(refused(&mut t.interface, Own::Cohesion { cohesion: f64::NAN }).kind, Kind::NotFinite);
    assert_eq!(off(&numbers(&mut t), &before), 0.0);
    let along = Own::Orthotropic(Ellipse { direction: t.interface.normal(0).unwrap(), across: 0.2 });
    t.interface.set_law(Some(along)).unwrap();
    let e = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap_err();
    assert!(e.kind == Kind::InvalidValue && e.message.contains("normal of non-mortar node"), "{e}");
    for friction in [Friction::Tied, Friction::Rough, Friction::Tresca] {
        let mut t = moved(&under(friction, MU, options()), [Cells::Quads; 2], FLAT, 3);
        let e = refused(&mut t.interface, Own::Cohesion { cohesion: 1.0 });
        assert!(e.kind == Kind::InvalidValue && e.message.contains(friction.law().name), "{e}");
    }
}

/// The axes of the ellipse turn with the normals, in both forms.
#[test]
fn an_ellipse_turns_with_normals_of_now() {
    for (form, across) in [Form::Multiplier, Form::Augmented].into_iter().flat_map(|f| [0.2, 0.6, MU].map(|m| (f, m))) {
        for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper] {
            let of = Options { mu: MU, form, slip, normals: Normals::Current, ..options() };
            let mut t = moved(&of, [Cells::Triangles; 2], FLAT, 3);
            t.interface.set_law(Some(ellipse(across))).unwrap();
            let error = error(&mut t.interface, (&t.x1, &t.x2), &t.lambda);
            assert!(error <= DIFFERENCES, "{form:?}, {slip:?}, {across} across: {error:e}");
        }
    }
}

/// With mu = 0 at every node the library leaves friction out; with cohesion it must not.
#[test]
fn cohesion_alone_is_friction() {
    let mut t = moved(&Options { mu: 0.0, ..options() }, [Cells::Quads; 2], FLAT, 3);
    t.interface.set_law(Some(Own::Cohesion { cohesion: 0.15 })).unwrap();
    let error = error(&mut t.interface, (&t.x1, &t.x2), &t.lambda);
    assert!(error <= DIFFERENCES, "{error:e}");
    let responses = t.interface.responses(&t.x1, &t.x2, &t.lambda, None).unwrap();
    let mut slips = 0;
    for (a, r) in responses.iter().enumerate().filter(|(_, r)| r.state == State::Slip) {
        let normal = t.interface.normal(a).unwrap();
        let shear = (r.traction - normal * normal.dot(&r.traction)).norm();
        assert!((shear - 0.15).abs() <= 1e-15, "{shear}");
        slips += 1;
    }
    assert!(slips > 1 && t.interface.effects().unwrap().contains("cohesion"));
}
