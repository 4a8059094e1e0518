//! Stages 2 and 4 for one non-mortar node.

use super::guard::guard;
use super::layout::column_major;
use super::method::slip_measure;
use super::options::{law, law_numbers};
use super::raw;
use super::sized::{self, Sized64};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::interface::own_rows;
use crate::law::{Coefficient, Friction, Node, Special};
use crate::simd::are_finite;

/// State of a node: open or uncovered.
pub const STICKSLIP_STATE_GAP: i32 = 0;
/// State of a node: closed, sticking.
pub const STICKSLIP_STATE_STICK: i32 = 1;
/// State of a node: closed, sliding or on the friction cone.
pub const STICKSLIP_STATE_SLIP: i32 = 2;

/// One non-mortar node: what is assembled over all its pairs, and its data.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_node {
    /// sizeof(stickslip_node).
    pub struct_size: u64,
    /// STICKSLIP_SLIP_...
    pub slip: i32,
    /// Number of prescribed directions, 0 to 2.
    pub n_directions: i32,
    /// Multiplier: minus the Cauchy traction on the non-mortar body [F/L^2].
    pub lambda: [f64; 3],
    /// nu(t_n): unit normal INTO the non-mortar body [-].
    pub normal: [f64; 3],
    /// r > 0 [F/L^5]; about 0.1 E / M_A^1.5, E the softer body's modulus, M_A the node's area. The answer does not depend on it.
    pub augmentation: f64,
    /// Coulomb coefficient >= 0 [-]; 0 with FRICTION_NONE, _ROUGH and _TIED.
    pub mu: f64,
    /// Covered area now [L^2]: the sum of n_AB over all B and all pairs.
    pub coverage: f64,
    /// Covered area at t_n [L^2]. 0: no slip history, g_T = 0; pass mu = 0 for that one step, or a
    /// sticking node has zero rows.
    pub coverage_previous: f64,
    /// At and below this the node counts as uncovered [L^2]; 1e-8 of its full area is a good choice.
    pub coverage_min: f64,
    /// g[n_{n+1}, x_{n+1}] [L^3].
    pub gap_now: [f64; 3],
    /// g[n_n, x_{n+1}] [L^3].
    pub gap_previous: [f64; 3],
    /// g[n_n, x_n] [L^3]; read by STICKSLIP_SLIP_INCREMENT only.
    pub gap_committed: [f64; 3],
    /// Orthonormal directions in which the node is prescribed on both sides [-], one after the other; the normal
    /// must be orthogonal to them.
    pub directions: [f64; 6],
    /// STICKSLIP_FRICTION_...; 0, and an older caller's: Coulomb. TIED: gap_committed is the gap to keep. NONE acts on
    /// three multipliers, of which the tangential two vanish.
    pub friction: i32,
    /// Must be 0.
    pub reserved: i32,
    /// With STICKSLIP_FRICTION_TRESCA the largest shear traction, > 0 [F/L^2]; else 0.
    pub shear_limit: f64,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_node {
    const NAME: &'static str = "stickslip_node";
    const FIRST: usize = 224;
}

/// The law's answer for one node. Matrices are row-major 3 x 3 and not symmetric: in Fortran m(j, i) is row i,
/// column j.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_node_response {
    /// sizeof(stickslip_node_response).
    pub struct_size: u64,
    /// STICKSLIP_STATE_...
    pub state: i32,
    /// Always 0.
    pub reserved: i32,
    /// Projected traction p [F/L^2].
    pub traction: [f64; 3],
    /// Multiplier row c = -(lambda - p)/r [L^3].
    pub row: [f64; 3],
    /// g_N = nu . g > 0: open [L^3].
    pub gap_normal: f64,
    /// Slip increment g_T [L^3].
    pub slip: [f64; 3],
    /// Augmented traction lambda + r g [F/L^2].
    pub sigma: [f64; 3],
    /// dp/dlambda [-].
    pub dp_dlambda: [f64; 9],
    /// dc/dlambda [L^5/F].
    pub drow_dlambda: [f64; 9],
    /// dc/dg[n_{n+1}, x_{n+1}] [-]; dp/dg is r times this.
    pub drow_dnow: [f64; 9],
    /// dc/dg[n_n, x_{n+1}] [-]; dp/dg is r times this.
    pub drow_dprevious: [f64; 9],
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_node_response {
    const NAME: &'static str = "stickslip_node_response";
    const FIRST: usize = 408;
}

/// Row-major entries of a matrix.
pub(super) fn rows(m: &Mat3) -> [f64; 9] {
    std::array::from_fn(|k| m[(k / 3, k % 3)])
}

fn matrix(rows: &[f64; 9], name: &str) -> Result<Mat3> {
    if !are_finite(rows) {
        return Err(Error::new(Kind::NotFinite, text!("{name} is not finite")));
    }
    Ok(Mat3::from_row_slice(rows))
}

/// (drow_dnow, drow_dprevious) of the a-th of an array of responses.
#[inline(always)] // called from loops over nodes, of linear and of quadratic facets
pub(super) fn read_response(first: *const stickslip_node_response, a: usize) -> Result<(Mat3, Mat3)> {
    raw::check(first, "responses")?;
    // The first response begins with its size, by which the array's members lie apart.
    let stride = sized::declared_size(first)?;
    let response = sized::read(first.wrapping_byte_add(a * stride))?;
    Ok((
        matrix(&response.drow_dnow, "responses.drow_dnow")?,
        matrix(&response.drow_dprevious, "responses.drow_dprevious")?,
    ))
}

/// The law that a host asks for, and the node as that law sees it.
pub(super) fn read_node(p: *const stickslip_node) -> Result<(Friction, Node)> {
    // A normal farther from unit length, or a direction farther from orthonormal, is an input error.
    const UNIT: f64 = 1e-10;
    let n = sized::read(p)?;
    let vector = |v: &[f64; 3], name: &str| -> Result<Vec3> {
        match v.iter().all(|c| c.is_finite()) {
            true => Ok(Vec3::from_column_slice(v)),
            false => Err(Error::new(Kind::NotFinite, text!("node.{name} is not finite"))),
        }
    };
    let refuse = |name: &str, v: f64, allowed: &str| {
        let kind = if v.is_finite() { Kind::InvalidValue } else { Kind::NotFinite };
        Err(Error::new(kind, text!("node.{name} is {v}; it must be {allowed}")))
    };
    let normal = vector(&n.normal, "normal")?;
    if !((normal.norm() - 1.0).abs() <= UNIT) {
        return refuse("normal", normal.norm(), "of length 1");
    }
    if !(n.augmentation > 0.0 && n.augmentation.is_finite()) {
        return refuse("augmentation", n.augmentation, "positive and finite");
    }
    for (name, v) in [
        ("mu", n.mu),
        ("coverage", n.coverage),
        ("coverage_previous", n.coverage_previous),
        ("coverage_min", n.coverage_min),
    ] {
        // Coverage is a sum of positive weights; rounding may leave it a hair below zero.
        if !v.is_finite() || (v < 0.0 && !matches!(name, "coverage" | "coverage_previous")) {
            return refuse(name, v, "finite and not negative");
        }
    }
    if !(0..=2).contains(&n.n_directions) {
        return refuse("n_directions", f64::from(n.n_directions), "0, 1 or 2");
    }
    let mut free = Mat3::identity();
    for k in 0..n.n_directions as usize {
        let d = Vec3::from_column_slice(&n.directions[3 * k..3 * k + 3]);
        if [d, free * d].iter().any(|d| !((d.norm_squared() - 1.0).abs() <= UNIT)) || !(d.dot(&normal).abs() <= UNIT) {
            return refuse("directions", d.norm(), "orthonormal and orthogonal to the normal");
        }
        free -= d * d.transpose();
    }
    if !n.shear_limit.is_finite() {
        return refuse("shear_limit", n.shear_limit, "finite");
    }
    if n.reserved != 0 {
        return refuse("reserved", f64::from(n.reserved), "0");
    }
    let friction = law(n.friction, "node.friction")?;
    law_numbers(friction, n.mu, n.shear_limit, "node")?;
    let node = Node {
        lambda: vector(&n.lambda, "lambda")?,
        normal,
        augmentation: n.augmentation,
        mu: match friction.law().mu {
            Coefficient::Given => n.mu,
            Coefficient::Always(mu) => mu,
        },
        shear_limit: n.shear_limit,
        gap_now: vector(&n.gap_now, "gap_now")?,
        gap_previous: vector(&n.gap_previous, "gap_previous")?,
        gap_committed: vector(&n.gap_committed, "gap_committed")?,
        covered: n.coverage > n.coverage_min,
        covered_before: n.coverage_previous > n.coverage_min,
        slip: slip_measure(n.slip, "node.slip")?,
        free,
        special: Special::Nothing,
    };
    Ok((friction, node))
}

/// Stage 2: gap, stick or slip of a node, its projected traction, its multiplier row and all
/// derivatives, from the gaps assembled over ALL its pairs (projecting pair by pair would make the answer
/// depend on the augmentation). Paper (17)-(31).
///
/// node: see `stickslip_node`; response, output, its struct_size set by the caller. A node of a plane or axisymmetric model has a
/// third component of 0 in all vectors, and (0, 0, 1) as its one prescribed direction: then the first two components of the
/// answer are those of the model, and what mixes them with the third is 0.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, INVALID_VALUE.
/// Cost: below a microsecond; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_node_respond(
    node: *const stickslip_node,
    response: *mut stickslip_node_response,
) -> i32 {
    guard(|| {
        let (friction, node) = read_node(node)?;
        sized::check_output(response)?;
        let r = friction.respond(&node);
        let matrices = [&r.dp_dlambda, &r.drow_dlambda, &r.drow_dnow, &r.drow_dprevious];
        raw::check_results("response", r.row.iter().chain(r.sigma.iter()).chain(matrices.into_iter().flatten()))?;
        sized::write(
            response,
            stickslip_node_response {
                struct_size: 0,
                state: r.state as i32,
                reserved: 0,
                traction: r.traction.into(),
                row: r.row.into(),
                gap_normal: r.gap_normal,
                slip: r.slip.into(),
                sigma: r.sigma.into(),
                dp_dlambda: rows(&r.dp_dlambda),
                drow_dlambda: rows(&r.drow_dlambda),
                drow_dnow: rows(&r.drow_dnow),
                drow_dprevious: rows(&r.drow_dprevious),
            },
        );
        Ok(())
    })
}

/// Stage 4: the node's own block, to be added once per non-mortar node, covered or not. Paper (25)-(27),
/// (29)-(31), third rows.
///
/// response: of `stickslip_node_respond`. scale multiplies the rows: r M_A [F/L^3] gives them the unit of a
/// force, 1 leaves them as in the paper [L^3]. layout: STICKSLIP_LAYOUT_... Outputs, each may be NULL: row (3),
/// block (3 x 3) = d row / d lambda.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, INVALID_VALUE.
/// Cost: nanoseconds; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_node_block(
    response: *const stickslip_node_response,
    scale: f64,
    layout: i32,
    row: *mut f64,
    block: *mut f64,
) -> i32 {
    guard(|| {
        let r = sized::read(response)?;
        let column_major = column_major(layout, "layout")?;
        if !scale.is_finite() {
            return Err(Error::new(Kind::NotFinite, text!("scale is {scale}; it must be finite")));
        }
        raw::check_optional(row, "row")?;
        raw::check_optional(block, "block")?;
        if !r.row.iter().all(|v| v.is_finite()) {
            return Err(Error::new(Kind::NotFinite, "response.row is not finite"));
        }
        let m = matrix(&r.drow_dlambda, "response.drow_dlambda")? * scale;
        let scaled = r.row.map(|v| v * scale);
        raw::check_results("row, block", scaled.iter().chain(m.iter()))?;
        raw::write(row, &scaled);
        raw::write(block, &rows(&if column_major { m.transpose() } else { m }));
        Ok(())
    })
}

/// What eliminating a node's multiplier makes of its rows, for a host without multipliers that assembles element by
/// element. The weights must be those of dual multipliers.
///
/// node, response: of `stickslip_node_respond`; of the node its covered area D, augmentation r and directions are read. layout:
/// STICKSLIP_LAYOUT_... Outputs, each may be NULL: w (3 x 3) [-]; row (3) [F], s c; row_scale [F/L^3], s = r D. An uncovered
/// node has I, 0 and 0.
///
/// The multiplier of a covered node A is -R / D, R the sum of the host's own forces at A. What elements and pairs have in
/// row i of A, of force and matrix, goes w[., i] times to the three rows of A. It goes M_AC / D times to row i of each
/// mortar node C, M_AC the sum of n_AC over the pairs. The output row is added to the rows of A. Pairs are linearised with this
/// row_scale (`stickslip_facet_tangent`, or `stickslip_pair_tangent` where weights are frozen): their multiplier rows go to
/// the rows of A, once and not times w. Columns of multipliers are left out. A direction in which the node is prescribed has no rows.
///
/// Errors: those of `stickslip_node_respond`, NULL_POINTER, STRUCT_SIZE, NOT_FINITE, INVALID_VALUE.
/// Cost: nanoseconds; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_node_condense(
    node: *const stickslip_node,
    response: *const stickslip_node_response,
    layout: i32,
    w: *mut f64,
    row: *mut f64,
    row_scale: *mut f64,
) -> i32 {
    guard(|| {
        let (coverage, (_, node)) = (sized::read(node)?.coverage, read_node(node)?);
        let response = sized::read(response)?;
        let column_major = column_major(layout, "layout")?;
        raw::check_optional(w, "w")?;
        raw::check_optional(row, "row")?;
        raw::check_optional(row_scale, "row_scale")?;
        if !response.row.iter().all(|v| v.is_finite()) {
            return Err(Error::new(Kind::NotFinite, "response.row is not finite"));
        }
        let drow_dlambda = matrix(&response.drow_dlambda, "response.drow_dlambda")?;
        let (own, scale) = match node.covered {
            true => (own_rows(&node.free, node.augmentation, &drow_dlambda), node.augmentation * coverage),
            false => (Mat3::identity(), 0.0),
        };
        let scaled = node.free * Vec3::from(response.row) * scale;
        raw::check_results("w, row, row_scale", own.iter().chain(scaled.iter()).chain([&scale]))?;
        raw::write(w, &rows(&if column_major { own.transpose() } else { own }));
        raw::write(row, scaled.as_slice());
        raw::write(row_scale, &[scale]);
        Ok(())
    })
}
