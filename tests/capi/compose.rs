//! Features that meet, behind a handle of the C ABI: golden interfaces of every kind of facet, both forms, both normals, with offsets,
//! removed components, one multiplier a node, frames that move, heat.

use super::golden::*;
use crate::support::*;
use serde_json::Value;
use std::ffi::CStr;
use std::mem::{size_of, zeroed};
use std::ptr::{null, null_mut};
use stickslip::capi::*;

/// Residual blocks and normals, relative to the largest entry of the block.
const RESIDUAL: f64 = 1e-12;
/// Tangent blocks.
const TANGENT: f64 = 1e-10;
/// The rule's error against a cylinder, whose integrand is no polynomial, over facets with straight and with curved edges.
const CYLINDER: f64 = 1e-7;
/// A block smaller than this part of the matrix is what is left of terms that cancel.
const VANISHING: f64 = 1e-5;

/// A case with these normals, through a handle.
struct Case<'a> {
    of: &'a Value,
    fields: &'a Value,
    handle: *mut stickslip_interface,
    x: [Vec<f64>; 2],
    lambda: Vec<f64>,
    /// Components of a node, and of a multiplier.
    d: usize,
    m: usize,
}

impl Drop for Case<'_> {
    fn drop(&mut self) {
        ok!(stickslip_interface_destroy(&mut self.handle));
    }
}

/// Facets as the ABI takes them: where each begins, and the nodes.
fn arrays(v: &Value) -> (Vec<i64>, Vec<i64>) {
    let facets = facets(v);
    let ends = facets.iter().scan(0, |end, f| {
        *end += f.len() as i64;
        Some(*end)
    });
    (std::iter::once(0).chain(ends).collect(), facets.concat())
}

impl<'a> Case<'a> {
    /// Created with the positions of t_n.
    fn new(of: &'a Value, normals: &str, form: i32, one: bool) -> Case<'a> {
        let x = ["x1", "x2"].map(|x| flat(&of[x]));
        let previous = ["x1_prev", "x2_prev"].map(|x| flat(&of[x]));
        let d = of["x1"][0].as_array().unwrap().len();
        let (m, n1) = (if one { 1 } else { d }, x[0].len() / d);
        let first = x[0].len() + x[1].len();
        let mut equations: Vec<i64> = (0..(first + n1 * m) as i64).collect();
        for a in (0..n1).filter(|&a| of["has_multiplier"][a] == false) {
            equations[first + m * a..][..m].fill(-1);
        }
        for (a, i) in (0..n1).flat_map(|a| (0..m).map(move |i| (a, i))).filter(|&(a, i)| of["free"][a][i] == false) {
            equations[first + m * a + i] = -1;
        }
        let [(offsets1, nodes1), (offsets2, nodes2)] = ["facets1", "facets2"].map(|f| arrays(&of[f]));
        let (mut nonmortar, mut mortar) = (sized!(stickslip_surface), sized!(stickslip_surface));
        (nonmortar.n_nodes, nonmortar.n_facets) = (n1 as i64, offsets1.len() as i64 - 1);
        nonmortar.coordinates = previous[0].as_ptr();
        (nonmortar.facet_offsets, nonmortar.facet_nodes) = (offsets1.as_ptr(), nodes1.as_ptr());
        (nonmortar.equations, nonmortar.multiplier_equations) = (equations.as_ptr(), equations[first..].as_ptr());
        (mortar.n_nodes, mortar.n_facets) = ((x[1].len() / d) as i64, offsets2.len() as i64 - 1);
        (mortar.coordinates, mortar.equations) = (previous[1].as_ptr(), equations[x[0].len()..].as_ptr());
        if mortar.n_facets > 0 {
            (mortar.facet_offsets, mortar.facet_nodes) = (offsets2.as_ptr(), nodes2.as_ptr());
        }
        let (mut options, mut method) = golden_options(of);
        method.form = form;
        method.quadrature = STICKSLIP_QUADRATURE_DEGREE_10;
        options.model = match of["model"].as_str().unwrap() {
            "plane" => STICKSLIP_MODEL_PLANE,
            "axisymmetric" => STICKSLIP_MODEL_AXISYMMETRIC,
            _ => STICKSLIP_MODEL_SOLID,
        };
        options.thickness = of["thickness"].as_f64().unwrap_or(0.0);
        method.multiplier_basis = [STICKSLIP_BASIS_STANDARD, STICKSLIP_BASIS_DUAL][usize::from(of["basis"] == "dual")];
        method.multiplier_space =
            [STICKSLIP_SPACE_CORNER, STICKSLIP_SPACE_SUB][usize::from(of["multiplier_space"] == "sub")];
        method.normals = [STICKSLIP_NORMALS_COMMITTED, STICKSLIP_NORMALS_CURRENT][usize::from(normals == "current")];
        if let Some(shape) = of["shape"].as_str() {
            options.mortar_side = STICKSLIP_MORTAR_ANALYTIC;
            options.shape = if shape == "plane" { STICKSLIP_SHAPE_PLANE } else { STICKSLIP_SHAPE_CYLINDER };
            options.radius = of["radius"].as_f64().unwrap();
        }
        if one {
            options.friction = STICKSLIP_FRICTION_NONE;
        }
        options.method = &raw const method;
        let mut case = Case { of, fields: &of[normals], handle: null_mut(), x, lambda: Vec::new(), d, m };
        case.lambda = flat(&of[if one { "lambda_N" } else { "lambda" }]);
        ok!(stickslip_interface_create(&nonmortar, &mortar, &options, &mut case.handle));
        if !one {
            ok!(stickslip_interface_set_friction(case.handle, per_node(&of["mu"], n1).as_ptr()));
        }
        ok!(stickslip_interface_set_augmentation(case.handle, per_node(&of["r"], n1).as_ptr()));
        if of["offsets1"].is_array() {
            let [offsets1, offsets2] = ["offsets1", "offsets2"].map(|o| numbers(&of[o]));
            ok!(stickslip_interface_set_offsets(case.handle, offsets1.as_ptr(), offsets2.as_ptr()));
        }
        case
    }

    fn ends(&self) -> [usize; 4] {
        let (a, b) = (self.x[0].len(), self.x[0].len() + self.x[1].len());
        [0, a, b, b + self.lambda.len()]
    }

    fn residual(&self) -> Vec<f64> {
        let [_, a, b, n] = self.ends();
        let mut r = vec![f64::NAN; n];
        let ([x1, x2], p) = ([self.x[0].as_ptr(), self.x[1].as_ptr()], r.as_mut_ptr());
        ok!(stickslip_interface_residual(self.handle, x1, x2, self.lambda.as_ptr(), null(), p, p.add(a), p.add(b)));
        r
    }

    /// Multipliers that are not there.
    fn is_absent(&self, i: usize) -> bool {
        let Some(k) = i.checked_sub(self.ends()[2]) else { return false };
        let (a, component) = (k / self.m, k % self.m);
        self.of["has_multiplier"][a] == false || self.m > 1 && self.of["free"][a][component] == false
    }

    /// Dense, of n columns: with motions of a frame in place of its points.
    fn tangent(&self) -> (Vec<f64>, usize) {
        let (n, k) = (self.ends()[3], dense_tangent(self.handle, [&self.x[0], &self.x[1], &self.lambda]));
        if self.of["shape"].is_null() {
            return (k, n);
        }
        // dP_C = u + w x (P_C - P0); of lines one w, about z.
        let ([_, a, b, _], d) = (self.ends(), self.d);
        let motions = if d == 3 { 6 } else { 3 };
        let width = n - (b - a) + motions;
        let motion = |column: usize, motion: usize| -> f64 {
            let (c, i) = ((column - a) / d, (column - a) % d);
            let arm = |j: usize| self.x[1][d * c + j] - self.x[1][j];
            match (motion.checked_sub(d), d) {
                (None, _) => f64::from(i == motion),
                (Some(_), 2) => [-arm(1), arm(0)][i],
                (Some(w), _) if i == w => 0.0,
                // e_w x arm
                (Some(w), _) => {
                    if i == (w + 1) % 3 {
                        -arm((w + 2) % 3)
                    } else {
                        arm((w + 1) % 3)
                    }
                }
            }
        };
        let mut moved = vec![0.0; n * width];
        for i in 0..n {
            let (from, to) = (&k[i * n..][..n], &mut moved[i * width..][..width]);
            to[..a].copy_from_slice(&from[..a]);
            (0..motions).for_each(|q| to[a + q] = (a..b).map(|j| from[j] * motion(j, q)).sum());
            to[a + motions..].copy_from_slice(&from[b..]);
        }
        (moved, width)
    }
}

/// Blocks of rows and columns that end there, each relative to its largest entry.
fn block_error((rows, columns): ([usize; 4], [usize; 4]), k: &[f64], expected: &[f64]) -> f64 {
    let (n, least) = (columns[3], VANISHING * max_abs(expected.iter().copied()));
    let mut worst = 0.0_f64;
    for (r, c) in rows.windows(2).flat_map(|r| columns.windows(2).map(move |c| (r, c))) {
        let of = |v: &[f64]| (r[0]..r[1]).flat_map(|i| v[i * n + c[0]..i * n + c[1]].to_vec()).collect::<Vec<_>>();
        let (k, expected) = (of(k), of(expected));
        worst = worst.max(relative(difference(&k, &expected), least.max(max_abs(expected.iter().copied()))));
    }
    worst
}

#[test]
fn golden_interfaces_of_features_that_meet() {
    let (mut worst, mut compared) = ([[0.0_f64; 2]; 2], [0; 2]);
    let forms = [(STICKSLIP_FORM_MULTIPLIER, "_mult"), (STICKSLIP_FORM_AUGMENTED, "")];
    for of in golden("golden_compose.json") {
        let rule = if of["shape"] == "cylinder" { CYLINDER } else { 0.0 };
        let one = |one: bool| if one { "one_" } else { "" };
        for (normals, (form, suffix), is_one) in ["committed", "current"]
            .into_iter()
            .flat_map(|n| forms.into_iter().flat_map(move |f| [false, true].map(|one| (n, f, one))))
        {
            let key = |what: &str| format!("{}{what}{suffix}", one(is_one));
            let expected = &of[normals][key("residual")];
            if !expected.is_array() {
                continue;
            }
            let what = format!("{} {normals} {}", name(&of), key("residual"));
            let case = Case::new(&of, normals, form, is_one);
            let (ends, mut r, mut expected) = (case.ends(), case.residual(), numbers(expected));
            for i in (0..ends[3]).filter(|&i| case.is_absent(i)) {
                (r[i], expected[i]) = (0.0, 0.0);
            }
            let error = residual_error(ends, &r, &expected);
            let at = usize::from(rule > 0.0);
            worst[at][0] = worst[at][0].max(error);
            compared[0] += 1;
            assert!(error <= RESIDUAL.max(rule), "{what} off by {error:e}");
            if !case.fields[key("tangent")].is_object() {
                continue;
            }
            let (k, n) = case.tangent();
            let mut expected = vec![0.0; ends[3] * n];
            let coo = &case.fields[key("tangent")];
            for ((i, j), v) in numbers(&coo["i"]).into_iter().zip(numbers(&coo["j"])).zip(numbers(&coo["v"])) {
                if !case.is_absent(i as usize) && !case.is_absent(j as usize + ends[3] - n) {
                    expected[i as usize * n + j as usize] = v;
                }
            }
            let shift = ends[3] - n;
            let columns = [0, ends[1], ends[2] - shift, n];
            let error = block_error((ends, columns), &k, &expected);
            worst[at][1] = worst[at][1].max(error);
            compared[1] += 1;
            assert!(error <= TANGENT.max(rule), "{what}: tangent off by {error:e}");
        }
    }
    let [[residual, tangent], [of_rule, tangent_of_rule]] = worst;
    println!(
        "residual {residual:.1e}, tangent {tangent:.1e}; cylinder {of_rule:.1e}, {tangent_of_rule:.1e}; {compared:?}"
    );
}

/// Heat: rows of the temperatures, columns of displacements and multipliers.
#[test]
fn golden_heat_of_features_that_meet() {
    let (mut worst, mut compared) = ([0.0_f64; 2], 0);
    for of in golden("golden_compose.json").iter().filter(|of| of["heat_law"].is_object()) {
        for normals in ["committed", "current"] {
            let (case, law) = (Case::new(of, normals, STICKSLIP_FORM_MULTIPLIER, false), &of["heat_law"]);
            let mut heat = sized!(stickslip_heat);
            let value = |key: &str| law[key].as_f64().unwrap();
            (heat.contact, heat.pressure, heat.exponent) = (value("contact"), value("pressure"), value("exponent"));
            (heat.constant, heat.gas, heat.gas_gap) = (value("constant"), value("gas"), value("gas_gap"));
            (heat.reach, heat.share, heat.time) = (value("reach"), value("share"), value("time"));
            let t = ["T1", "T2"].map(|t| numbers(&of[t]));
            let ([n1, n2], ends) = ([t[0].len(), t[1].len()], case.ends());
            let ([x1, x2], lambda) = ([case.x[0].as_ptr(), case.x[1].as_ptr()], case.lambda.as_ptr());
            let [t1, t2] = [t[0].as_ptr(), t[1].as_ptr()];
            let mut q = vec![f64::NAN; n1 + n2];
            let to = q.as_mut_ptr();
            ok!(stickslip_interface_heat(case.handle, x1, x2, lambda, &heat, t1, t2, to, to.add(n1), null()));
            let what = format!("{} {normals}", name(of));
            let expected = numbers(&case.fields["heat"]["residual"]);
            let error = difference(&q, &expected) / max_abs(expected.iter().copied());
            assert!(error <= RESIDUAL, "{what}: heat off by {error:e}");
            worst[0] = worst[0].max(error);
            // Temperatures come after all else: their columns are not compared.
            let rows: Vec<i64> = (ends[3] as i64..(ends[3] + n1 + n2) as i64).collect();
            let (which, mut count) = (STICKSLIP_HEAT_ALL, 0);
            let mut coo = |capacity: i64, at: [*mut i64; 2], values: *mut f64| {
                ok!(stickslip_interface_heat_tangent_coo(
                    case.handle,
                    x1,
                    x2,
                    lambda,
                    &heat,
                    t1,
                    t2,
                    rows.as_ptr(),
                    rows[n1..].as_ptr(),
                    which,
                    capacity,
                    at[0],
                    at[1],
                    values,
                    &mut count
                ));
                count
            };
            let capacity = coo(0, [null_mut(); 2], null_mut());
            let mut at = [vec![-1; capacity as usize], vec![-1; capacity as usize]];
            let mut values = vec![f64::NAN; capacity as usize];
            coo(capacity, at.each_mut().map(|at| at.as_mut_ptr()), values.as_mut_ptr());
            let n = ends[3];
            let (mut k, mut expected) = (vec![0.0; (n1 + n2) * n], vec![0.0; (n1 + n2) * n]);
            for ((i, j), v) in at[0].iter().zip(&at[1]).zip(&values).filter(|((_, j), _)| **j < n as i64) {
                k[(*i as usize - n) * n + *j as usize] += v;
            }
            let coo = &case.fields["heat"]["tangent"];
            for ((i, j), v) in numbers(&coo["i"]).into_iter().zip(numbers(&coo["j"])).zip(numbers(&coo["v"])) {
                expected[i as usize * n + j as usize] = v;
            }
            let error = difference(&k, &expected) / max_abs(expected.iter().copied());
            assert!(error <= TANGENT, "{what}: tangent of heat off by {error:e}");
            worst[1] = worst[1].max(error);
            compared += 1;
        }
    }
    println!("heat {:.1e}, its tangent {:.1e}, {compared} cases", worst[0], worst[1]);
    assert!(compared > 0);
}

/// Through previous positions: derivatives of all weights, relative to the largest entry.
const PREVIOUS: f64 = 1e-12;

/// Rows of the residual, columns of the positions at t_n; and products from either side, of all at once.
#[test]
fn golden_derivatives_by_previous_positions() {
    let (mut worst, mut compared) = ([0.0_f64; 2], 0);
    for of in golden("golden_compose.json") {
        for normals in ["committed", "current"] {
            let coo = &of[normals]["dresidual_mult_dprev"];
            if !coo.is_object() {
                continue;
            }
            let case = Case::new(&of, normals, STICKSLIP_FORM_MULTIPLIER, false);
            let ([_, a, b, n], what) = (case.ends(), format!("{} {normals}", name(&of)));
            let ([x1, x2], lambda) = ([case.x[0].as_ptr(), case.x[1].as_ptr()], case.lambda.as_ptr());
            let mut count = 0;
            let mut call = |capacity: i64, at: [*mut i64; 2], values: *mut f64| {
                let [rows, columns] = at;
                ok!(stickslip_interface_previous_tangent_coo(
                    case.handle,
                    x1,
                    x2,
                    lambda,
                    capacity,
                    rows,
                    columns,
                    values,
                    &mut count
                ));
                count as usize
            };
            let entries = call(0, [null_mut(); 2], null_mut());
            let mut at = [vec![-1_i64; entries], vec![-1; entries]];
            let mut values = vec![f64::NAN; entries];
            let [rows, columns] = at.each_mut().map(|at| at.as_mut_ptr());
            call(entries as i64, [rows, columns], values.as_mut_ptr());
            let (mut k, mut expected) = (vec![0.0; n * b], vec![0.0; n * b]);
            for ((i, j), v) in at[0].iter().zip(&at[1]).zip(&values) {
                k[*i as usize * b + *j as usize] += v;
            }
            for ((i, j), v) in numbers(&coo["i"]).into_iter().zip(numbers(&coo["j"])).zip(numbers(&coo["v"])) {
                if !case.is_absent(i as usize) {
                    expected[i as usize * b + j as usize] = v;
                }
            }
            let largest = max_abs(expected.iter().copied());
            let error = difference(&k, &expected) / largest;
            assert!(error <= PREVIOUS, "{what}: off by {error:e}");
            worst[0] = worst[0].max(error);

            // Numbers without a pattern, 0 where there is no equation.
            let some = |i: usize| if case.is_absent(i) { 0.0 } else { ((7 * i + 3) % 11) as f64 - 5.0 };
            let left: Vec<f64> = (0..n).map(some).collect();
            let mut products = vec![f64::NAN; b];
            let mut to = sized!(stickslip_gradient);
            (to.previous1, to.previous2) = (products.as_mut_ptr(), products[a..].as_mut_ptr());
            let [a1, a2, a_rows] = [left.as_ptr(), left[a..].as_ptr(), left[b..].as_ptr()];
            ok!(stickslip_interface_adjoint(case.handle, x1, x2, lambda, a1, a2, a_rows, &to));
            let right: Vec<f64> = (0..b).map(some).collect();
            let mut change = vec![f64::NAN; n];
            let mut along = sized!(stickslip_direction);
            (along.previous1, along.previous2) = (right.as_ptr(), right[a..].as_ptr());
            let p = change.as_mut_ptr();
            ok!(stickslip_interface_sensitivity(case.handle, x1, x2, lambda, &along, p, p.add(a), p.add(b)));
            (0..n).filter(|&i| case.is_absent(i)).for_each(|i| change[i] = 0.0);
            let from_left: Vec<f64> = (0..b).map(|j| (0..n).map(|i| left[i] * k[i * b + j]).sum()).collect();
            let from_right: Vec<f64> = (0..n).map(|i| (0..b).map(|j| right[j] * k[i * b + j]).sum()).collect();
            for (products, expected) in [(&products, &from_left), (&change, &from_right)] {
                let error = difference(products, expected) / max_abs(expected.iter().copied());
                assert!(error <= PREVIOUS, "{what}: a product is off by {error:e}");
                worst[1] = worst[1].max(error);
            }
            compared += 1;
        }
    }
    println!("by previous positions {:.1e}, products {:.1e}, {compared} cases", worst[0], worst[1]);
    assert!(compared > 0);
}
