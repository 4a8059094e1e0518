//! Plans of a tangent: their entries are those of the tangent, each once, and their values its sums.

use super::weak;
use crate::support::mesh::*;
use nalgebra::SVector;
use std::collections::BTreeMap;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Extent, Form, Friction, MultiplierBasis, NO_EQUATION, Normals, Options, Plan, PlanOf, PlanPairs,
    PlanSystem, Shortcuts, Surface,
};

/// Sums of a few dozen terms in another order, over the largest entry.
const ROUNDING: f64 = 1e-14;

pub fn entries((plan, of): (&Plan, PlanOf)) -> Vec<(i64, i64)> {
    let (rows, offsets) = plan.rows();
    let (mut entries, mut k) = (Vec::new(), 0);
    plan.each_row(of, &mut |columns| {
        assert_eq!(offsets[k + 1] - offsets[k], columns.len());
        entries.extend(columns.iter().map(|&column| (rows[k], column)));
        k += 1;
        Ok(())
    })
    .unwrap();
    assert_eq!((k, plan.len()), (rows.len(), entries.len()));
    assert!(entries.windows(2).all(|e| e[0] < e[1]), "sorted, each once");
    entries
}

/// Compares plans at a point with the tangent entry by entry.
pub fn agrees<const N: usize>(c: &mut Contact<N>, x1: &[Vec3], x2: &[Vec3], lambda: &[SVector<f64, N>], what: &str) {
    let mut expected = BTreeMap::new();
    c.tangent(x1, x2, lambda, None, &mut |i: i64, j: i64, v: f64| *expected.entry((i, j)).or_insert(0.0) += v).unwrap();
    let largest = expected.values().fold(0.0, |m: f64, v| m.max(v.abs()));
    for pairs in [PlanPairs::Active(Extent::Whole), PlanPairs::Active(Extent::Part), PlanPairs::Possible] {
        let n = c.make_plan((x1, x2), pairs).unwrap();
        let found = entries(c.plan(PlanSystem::Whole).unwrap());
        assert_eq!(n, found.len());
        // Where points decide, a tangent leaves out what is open, and what forces have elsewhere.
        if pairs == PlanPairs::Active(Extent::Whole) && !c.options().decides_at_points() {
            assert!(found.iter().eq(expected.keys()), "{what}: {} entries for {}", found.len(), expected.len());
        }
        for _ in 0..2 {
            let mut values = vec![f64::NAN; n];
            c.plan_values((x1, x2), lambda, None, &mut values).unwrap_or_else(|e| panic!("{what} {pairs:?}: {e}"));
            let values: BTreeMap<_, _> = found.iter().copied().zip(values).collect();
            for (entry, value) in &expected {
                let found = values.get(entry).unwrap_or_else(|| panic!("{what} {pairs:?} lacks {entry:?}"));
                assert!((found - value).abs() <= ROUNDING * largest, "{what} {pairs:?} {entry:?}: {found} for {value}");
            }
            let others = values.iter().filter(|(entry, _)| !expected.contains_key(entry));
            assert!(others.into_iter().all(|(_, value)| *value == 0.0), "{what} {pairs:?}");
        }
    }
}

fn variants(of: Options) -> impl Iterator<Item = Options> {
    let bases = [MultiplierBasis::Standard, MultiplierBasis::Dual];
    let forms = [Form::Multiplier, Form::Augmented];
    let normals = [Normals::Committed, Normals::Current];
    let all = bases.into_iter().flat_map(move |b| forms.into_iter().map(move |f| (b, f)));
    let all = all.flat_map(move |(b, f)| normals.into_iter().map(move |n| (b, f, n)));
    all.map(move |(basis, form, normals)| Options { basis, form, normals, ..of })
}

fn scenes() -> impl Iterator<Item = (&'static str, Roughness, [Cells; 2])> {
    let quads = [Cells::Quads, Cells::Quads];
    rough_scenes(0.0).chain([("quads", Roughness { warp: 0.01, jitter: 0.05, slide: 0.02 }, quads)])
}

#[test]
fn a_plan_has_the_tangents_entries_once() {
    for (what, rough, cells) in scenes() {
        for options in variants(options()) {
            let mut t = moved(&options, cells, rough, 3);
            agrees(&mut t.interface, &t.x1, &t.x2, &t.lambda, &format!("{what} {options:?}"));
        }
    }
}

#[test]
fn a_plan_without_friction_has_the_tangents_entries_once() {
    for (what, rough, cells) in scenes() {
        for options in variants(Options { friction: Friction::None, mu: 0.0, ..options() }) {
            for prescribed in [false, true] {
                let t = moved(&standard(), cells, rough, 3);
                let (one, two) = t.interface.surfaces();
                let mut c: Contact<1> = contact(&mesh_of(one), &mesh_of(two), prescribed, options);
                let lambda: Vec<_> = t.lambda.iter().map(|l| nalgebra::Vector1::new(l.z)).collect();
                agrees(&mut c, &t.x1, &t.x2, &lambda, &format!("{what} {prescribed} {options:?}"));
            }
        }
    }
}

fn standard() -> Options {
    options()
}

#[test]
fn a_plan_has_what_carried_nodes_add() {
    for options in variants(Options { weak_coverage: weak::WEAK, ..options() }) {
        let mut s = weak::scene::<3>(&options, Cells::Quads);
        agrees(&mut s.contact, &s.x1, &s.x2, &s.lambda, &format!("{options:?}"));
        let options = Options { friction: Friction::None, mu: 0.0, ..options };
        let mut s = weak::scene::<1>(&options, Cells::Triangles);
        agrees(&mut s.contact, &s.x1, &s.x2, &s.lambda, &format!("{options:?}"));
    }
}

/// Numberings of a host, as functions of (node over both surfaces and multipliers, component).
type Numbers = Box<dyn Fn(usize, usize) -> i64>;

fn numberings(n1: usize, n2: usize) -> Vec<(&'static str, Numbers)> {
    let n = 2 * n1 + n2;
    let by_node = |k: usize, i: usize| (3 * k + i) as i64;
    // A non-mortar node's displacements, then its multipliers.
    let beside = move |k: usize, i: usize| {
        let k = if k < n1 {
            2 * k
        } else if k < n1 + n2 {
            n1 + k
        } else {
            2 * (k - n1 - n2) + 1
        };
        (3 * k + i) as i64
    };
    vec![
        ("multipliers beside displacements", Box::new(beside)),
        ("component by component", Box::new(move |k, i| (n * i + k) as i64)),
        ("backwards", Box::new(move |k, i| (3 * n - 1 - 3 * k - i) as i64)),
        ("scattered, with gaps", Box::new(move |k, i| 7 * by_node((k * 5 + 2) % n.next_power_of_two().max(n), i) + 3)),
        ("prescribed plane", Box::new(move |k, i| if i == 2 { NO_EQUATION } else { by_node(k, i) })),
        ("prescribed nodes", Box::new(move |k, i| if k % 5 == 1 { NO_EQUATION } else { by_node(k, i) })),
        ("a symmetry plane", Box::new(move |k, i| if k % 3 == 0 && i == 0 { NO_EQUATION } else { by_node(k, i) })),
        (
            "shared displacements",
            Box::new(move |k, i| {
                by_node(
                    if k == 3 {
                        1
                    } else if k == n1 + 5 {
                        n1 + 4
                    } else {
                        k
                    },
                    i,
                )
            }),
        ),
        ("a shared component", Box::new(move |k, i| by_node(if k == n1 + 5 && i == 1 { n1 + 4 } else { k }, i))),
    ]
}

#[test]
fn a_plan_follows_any_numbering() {
    for (what, rough, cells) in scenes() {
        for options in variants(options()) {
            let t = moved(&options, cells, rough, 3);
            let (one, two) = t.interface.surfaces();
            let (one, two) = (mesh_of(one), mesh_of(two));
            let (n1, n2) = (one.x.len(), two.x.len());
            for (numbering, number) in numberings(n1, n2) {
                let of = |first: usize, n: usize| -> Vec<[i64; 3]> {
                    (first..first + n).map(|k| std::array::from_fn(|i| number(k, i))).collect()
                };
                let one = Surface::new("nonmortar", one.x.clone(), &one.facets, of(0, n1)).unwrap();
                let two = Surface::new("mortar", two.x.clone(), &two.facets, of(n1, n2)).unwrap();
                let mut c = Contact::new(one, two, of(n1 + n2, n1), options).unwrap();
                agrees(&mut c, &t.x1, &t.x2, &t.lambda, &format!("{numbering}, {what} {options:?}"));
            }
        }
    }
}

/// A plan of active pairs does not suffice where there are others; the values that it had are then gone, and nothing else.
#[test]
fn a_plan_that_does_not_suffice_is_refused() {
    let (_, rough, cells) = scenes().next().unwrap();
    let mut t = moved(&options(), cells, rough, 3);
    let c = &mut t.interface;
    let refused = c.plan_values((&t.x1, &t.x2), &t.lambda, None, &mut []).unwrap_err();
    assert_eq!(refused.kind, Kind::InvalidValue, "{refused}");
    let n = c.make_plan((&t.x1, &t.x2), PlanPairs::Active(Extent::Whole)).unwrap();
    let (mut values, mut again) = (vec![0.0; n], vec![0.0; n]);
    c.plan_values((&t.x1, &t.x2), &t.lambda, None, &mut values).unwrap();
    let far: Vec<_> = t.x1.iter().map(|x| x + (t.x1[8] - t.x1[0]) * 0.4).collect();
    let refused = c.plan_values((&far, &t.x2), &t.lambda, None, &mut again).unwrap_err();
    assert_eq!(refused.kind, Kind::MissingEntry, "{refused}");
    assert!(format!("{refused}").contains("stickslip_interface_plan"), "{refused}");
    c.plan_values((&t.x1, &t.x2), &t.lambda, None, &mut again).unwrap();
    assert!(values.iter().zip(&again).all(|(v, w)| v.to_bits() == w.to_bits()));
}

/// Facets enough for several chunks a phase (`src/interface/plan/phases.rs`), in whose order a plan adds blocks up.
const MANY: usize = 72;

fn many(options: Options) -> Contact<3> {
    let one = grid(MANY, MANY, [0.0, 0.0], [1.0, 1.0], -1e-3, false, Cells::Quads);
    let two = grid(MANY + 9, MANY + 9, [-0.1, -0.1], [1.1, 1.1], 0.0, true, Cells::Quads);
    contact(&one, &two, false, options)
}

fn values_of(c: &mut Contact<3>, x: (&[Vec3], &[Vec3]), lambda: &[Vec3], n: usize) -> Vec<u64> {
    let mut values = vec![f64::NAN; n];
    c.plan_values(x, lambda, None, &mut values).unwrap();
    values.iter().map(|v| v.to_bits()).collect()
}

/// A quad over four triangles that meet in a point. A fourth one, all of whose nodes the plan knows by the other three, has
/// blocks of its nodes with each other that the plan lacks: they were left out, and values came without a word.
#[test]
fn a_mortar_facet_whose_nodes_the_plan_has_by_others_alone_is_missing() {
    let corners = |list: &[[f64; 2]]| list.iter().map(|x| Vec3::new(x[0], x[1], 0.0)).collect::<Vec<_>>();
    let one =
        Mesh { x: corners(&[[0.05, -0.3], [0.05, 0.3], [0.5, 0.3], [0.5, -0.3]]), facets: vec![vec![0, 1, 2, 3]] };
    let two = Mesh {
        x: corners(&[[0.0, 0.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]),
        facets: [[0, 4, 1], [0, 1, 2], [0, 2, 3], [0, 3, 4]].map(|f| f.to_vec()).to_vec(),
    };
    let moved: Vec<_> = one.x.iter().map(|x| x - Vec3::x() * 0.15).collect();
    let lambda = vec![Vec3::new(0.02, 0.01, -0.5); 4];
    for extent in [Extent::Whole, Extent::Part] {
        let mut c: Contact<3> = contact(&one, &two, false, options());
        let n = c.make_plan((&one.x, &two.x), PlanPairs::Active(extent)).unwrap();
        let refused = c.plan_values((&moved, &two.x), &lambda, None, &mut vec![0.0; n]).unwrap_err();
        assert_eq!(refused.kind, Kind::MissingEntry, "{refused}");
        agrees(&mut c, &moved, &two.x, &lambda, "made again");
        // The fourth one met the quad at t_n, and does not now: the plan has its pair, but no forces among its nodes.
        c.set_previous(&moved, &two.x).unwrap();
        let n = c.make_plan((&one.x, &two.x), PlanPairs::Active(extent)).unwrap();
        agrees_or_misses(&mut c, (&moved, &two.x), &lambda, n);
    }
}

/// Values of the plan that was made last, with so many entries, are those of the tangent, or are refused.
fn agrees_or_misses(c: &mut Contact<3>, x: (&[Vec3], &[Vec3]), lambda: &[Vec3], n: usize) {
    let found = entries(c.plan(PlanSystem::Whole).unwrap());
    let mut values = vec![f64::NAN; n];
    match c.plan_values(x, lambda, None, &mut values) {
        Err(refused) => assert_eq!(refused.kind, Kind::MissingEntry, "{refused}"),
        Ok(()) => {
            let mut expected = BTreeMap::new();
            let mut add = |i: i64, j: i64, v: f64| *expected.entry((i, j)).or_insert(0.0) += v;
            c.tangent(x.0, x.1, lambda, None, &mut add).unwrap();
            for (entry, value) in found.into_iter().zip(values) {
                let expected = expected.remove(&entry).unwrap_or(0.0);
                assert!((value - expected).abs() < ROUNDING, "{entry:?}: {value} for {expected}");
            }
            assert!(expected.values().all(|v| *v == 0.0));
        }
    }
}

/// What has no equations needs no place: a mortar facet that comes new there is no reason to make a plan again.
#[test]
fn mortar_nodes_without_equations_are_never_missing() {
    for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
        let one = grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
        let two = grid(9, 9, [-0.5, -0.5], [1.5, 1.5], -1e-3, true, Cells::Quads);
        let (n1, n2) = (one.x.len(), two.x.len());
        let nonmortar = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, n1)).unwrap();
        let none = vec![[NO_EQUATION; 3]; n2];
        let mortar = Surface::new("mortar", two.x.clone(), &two.facets, none).unwrap();
        let options = Options { basis, shortcuts: Shortcuts { rigid: false, ..Shortcuts::default() }, ..options() };
        let mut c: Contact<3> = Contact::new(nonmortar, mortar, numbered(3 * n1, n1), options).unwrap();
        let lambda = vec![Vec3::new(0.02, 0.01, -0.5); n1];
        let n = c.make_plan((&one.x, &two.x), PlanPairs::Active(Extent::Whole)).unwrap();
        let slid: Vec<_> = one.x.iter().map(|x| x + Vec3::new(0.3, 0.2, 0.0)).collect();
        c.plan_values((&slid, &two.x), &lambda, None, &mut vec![0.0; n]).unwrap();
        agrees(&mut c, &slid, &two.x, &lambda, &format!("{basis:?}"));
    }
}

/// Seconds and more: `make test-long`.
mod long {
    use super::*;

    #[test]
    fn a_plan_of_many_facets_has_the_same_values_on_any_number_of_threads() {
        for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
            let mut expected: Option<Vec<u64>> = None;
            for threads in [1, 2, 3, 7] {
                let mut c = many(Options { basis, threads, ..options() });
                let (one, two) = (c.surfaces().0.reference.clone(), c.surfaces().1.reference.clone());
                let x1: Vec<_> = one.iter().map(|x| x + Vec3::new(2e-3, 1e-3, 1e-4 * (30.0 * x.x).sin())).collect();
                let lambda = vec![Vec3::new(0.1, 0.0, -1.0); x1.len()];
                if threads == 1 {
                    agrees(&mut c, &x1, &two, &lambda, &format!("{basis:?}"));
                }
                let n = c.make_plan((&x1, &two), PlanPairs::Possible).unwrap();
                let found = values_of(&mut c, (&x1, &two), &lambda, n);
                assert!(*expected.get_or_insert_with(|| found.clone()) == found, "{basis:?}, {threads} threads");
            }
        }
    }

    /// Pairs that are not in the plan lead to rows of another chunk: that was an internal error, and not a refusal.
    #[test]
    fn a_plan_of_many_facets_that_does_not_suffice_is_refused() {
        for (basis, threads) in
            [(MultiplierBasis::Standard, 1), (MultiplierBasis::Dual, 1), (MultiplierBasis::Standard, 3)]
        {
            let mut c = many(Options { basis, threads, ..options() });
            let (one, two) = (c.surfaces().0.reference.clone(), c.surfaces().1.reference.clone());
            let lambda = vec![Vec3::new(0.1, 0.0, -1.0); one.len()];
            let n = c.make_plan((&one, &two), PlanPairs::Possible).unwrap();
            let before = values_of(&mut c, (&one, &two), &lambda, n);
            for slide in [0.02, 0.09] {
                let far: Vec<_> = one.iter().map(|x| x + Vec3::new(slide, slide, 0.0)).collect();
                let refused = c.plan_values((&far, &two), &lambda, None, &mut vec![0.0; n]).unwrap_err();
                assert_eq!(refused.kind, Kind::MissingEntry, "{basis:?}, {threads} threads: {refused}");
            }
            assert!(values_of(&mut c, (&one, &two), &lambda, n) == before, "{basis:?}, {threads} threads");
        }
    }
}
