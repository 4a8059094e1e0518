//! Systems without multipliers: for hosts that have no place for them, that do not pivot, or that want multigrid.

use super::choice::choose;
use super::guard::guard;
use super::handle::{dimension, either, flat, handle, sizes, stickslip_interface};
use super::point::{Point, vectors};
use super::raw;
use super::tangent::{Triplets, read_csr};
use crate::features;
use crate::interface::Piece;
use crate::memory::Store;

/// A piece of a condensed matrix: what the contact forces add to the host's own matrix, their derivative with respect to the
/// displacements at fixed multipliers.
pub const STICKSLIP_CONDENSED_FORCES: i32 = 0;
/// The elimination without the identity, L - I.
pub const STICKSLIP_CONDENSED_ELIMINATION: i32 = 1;
/// The contact constraints G, in the rows of the non-mortar nodes.
pub const STICKSLIP_CONDENSED_CONSTRAINTS: i32 = 2;
/// What is added to G where the multipliers follow from the displacements (`stickslip_interface_condensed_multipliers` at the
/// same positions): the constraint rows' scale r_A D_A changes with the covered area D_A. Nothing with frozen weights.
pub const STICKSLIP_CONDENSED_SCALES: i32 = 3;
/// Of the reduced form, for multigrid, its rows without the identity, E_L - I. With J the condensed matrix, r its residual
/// and E_R from the next piece, E_L J E_R v = E_L r has the solution v with u = E_R v that of J u = r.
pub const STICKSLIP_CONDENSED_REDUCTION_ROWS: i32 = 4;
/// Its columns without the identity, E_R - I.
pub const STICKSLIP_CONDENSED_REDUCTION_COLUMNS: i32 = 5;
/// Q, the projector on the directions in which nodes have constraints: of an open node none, of a slipping one its normal, of
/// a sticking one all.
pub const STICKSLIP_CONDENSED_CONSTRAINED: i32 = 6;
/// What the constraints have on the diagonal of E_L J E_R, s_A D_A Q_A. Beside (I - Q) E_L J E_R (I - Q) it makes the matrix
/// that multigrid is set up with.
pub const STICKSLIP_CONDENSED_CONSTRAINT_DIAGONAL: i32 = 7;

/// In the order of their numbers.
const PIECES: [Piece; 8] = [
    Piece::Forces,
    Piece::Elimination,
    Piece::Constraints,
    Piece::Scales,
    Piece::ReductionRows,
    Piece::ReductionColumns,
    Piece::Constrained,
    Piece::ConstraintDiagonal,
];

/// Which nodes carry weakly covered ones in this step: lambda_A = sum_B w_AB lambda_B. Settled by t_n; a node that carries
/// another has a multiplier of its own. Read it after a commit, to carry in the stateless stages too.
///
/// Outputs: nodes A and carriers B (indices of non-mortar nodes, in the index base), weights w_AB [-] (capacity each), sorted
/// by A, count. With all three arrays NULL only count is written, and capacity is not read.
///
/// Errors: NULL_POINTER, BUFFER_TOO_SMALL.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_carriers(
    interface: *mut stickslip_interface,
    capacity: i64,
    nodes: *mut i64,
    carriers: *mut i64,
    weights: *mut f64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let mut t = Triplets::default();
        either!(&h.inner, c => for (a, b, w) in c.carriers() {
            t.rows.store(a as i64)?;
            t.columns.store(b as i64)?;
            t.values.store(w)?;
        });
        t.write_as(["nodes", "carriers", "weights"], h.base, capacity, nodes, carriers, Some(weights), count)
    })
}

/// The multipliers of a system without them, lambda_A = -(the host's own force at A) / D_A, D_A the covered area: those
/// with which the rows of the non-mortar nodes are balanced. Weakly covered nodes have their carriers', uncovered ones 0.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; host1 (3 n1): the residual of the host's own forces at the non-mortar nodes, internal
/// minus external, without contact [F]. lambda (n1 multipliers, 3 or 1 components each), output [F/L^2].
/// In each evaluation of a nonlinear solver: this call, then `stickslip_interface_condensed_residual`. After a linear solve
/// from given multipliers: at the old positions, host1 being the residual there plus J du, J the host's matrix with
/// STICKSLIP_CONDENSED_FORCES.
///
/// A component that the host prescribes has equation -1 in the surface, and at a node with multipliers none of these. Where the host
/// fixes a row afterwards instead, its reaction is missing in host1 and the mortar side is given wrong forces, which no
/// handle can notice.
///
/// Not with (UNSUPPORTED): standard multipliers (STICKSLIP_BASIS_STANDARD); points that decide (STICKSLIP_DECISION_POINTS);
/// the augmented form (STICKSLIP_FORM_AUGMENTED); nodes that handles share (owned has STICKSLIP_NODE_SHARED); parts of an
/// interface (owned has STICKSLIP_NODE_ELSEWHERE) and quadratic facets; parts of an interface (owned has
/// STICKSLIP_NODE_ELSEWHERE) and lines; conserving weights (STICKSLIP_WEIGHTS_CONSERVING).
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, INVALID_VALUE (as
/// `stickslip_interface_sums`); UNSUPPORTED too: a prescribed component (equation -1)
/// of a node that has a multiplier there, two nodes with an equation in common (of which one has a multiplier), two
/// components of one; and
/// a node that carries others and is not covered any more: within Newton's method take a smaller step.
/// Cost: as `stickslip_interface_sums`, and a sort of the nodes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_condensed_multipliers(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    host1: *const f64,
    lambda: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(CONDENSED);
        let h = &mut handle(interface)?.inner;
        let point = Point::positions(h, x1, x2)?;
        let host = vectors(h, host1, sizes(h).0, "host1")?;
        let (host, dimension) = (raw::as_vectors(&host), dimension(h));
        raw::check(lambda, "lambda")?;
        either!(h, c => {
            let values = c.condensed_multipliers(point.x1(), point.x2(), host)?;
            raw::check_results("lambda", values.iter().flat_map(|v| v.iter()))?;
            raw::write_each(lambda, flat(&values, dimension));
        });
        Ok(())
    })
}

/// The residual of a system without multipliers: rows1 in place of the host's rows of the non-mortar nodes, force2 to be added
/// to those of the mortar nodes. All are forces. With multipliers of `stickslip_interface_condensed_multipliers` a function of
/// the displacements alone, continuous across gap, stick and slip.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; lambda (n1 multipliers) [F/L^2], read where a node is covered and not carried; host1
/// (3 n1): the residual of the host's own forces at the non-mortar nodes, without contact [F]. Outputs: rows1 (3 n1; may be
/// host1) and force2 (3 n2) [F]. Of a node whose multiplier acts elsewhere rows1 has what is to be added to its rows.
///
/// Errors: NULL_POINTER and the others of `stickslip_interface_condensed_multipliers`.
/// Cost: as `stickslip_interface_residual`, and a sort of the pairs' nodes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_condensed_residual(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    host1: *const f64,
    rows1: *mut f64,
    force2: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(CONDENSED);
        let h = &mut handle(interface)?.inner;
        let point = Point::read(h, x1, x2, lambda, std::ptr::null())?;
        let host = vectors(h, host1, sizes(h).0, "host1")?;
        let (host, dimension) = (raw::as_vectors(&host), dimension(h));
        raw::check(rows1, "rows1")?;
        raw::check(force2, "force2")?;
        either!(h, c => {
            let (rows, gains) = c.condensed_residual(point.x1(), point.x2(), point.lambda(), host)?;
            raw::check_results("rows1, force2", rows.iter().chain(&gains).flat_map(|v| v.iter()))?;
            raw::write_each(rows1, flat(&rows, dimension));
            raw::write_each(force2, flat(&gains, dimension));
        });
        Ok(())
    })
}

/// A piece of the matrix of a system without multipliers as triplets in displacement equations. With K the host's own matrix,
/// T the piece FORCES, E the piece ELIMINATION and G the piece CONSTRAINTS, and J = K + T, the matrix is J + E J + G. Its step is
/// that of the system with multipliers from these multipliers. With the piece SCALES added it is the exact derivative of the
/// residual whose multipliers follow from the displacements, but for what docs/formulation 11.2 leaves out with NORMALS_CURRENT
/// and one multiplier a node: without it Newton's method may cycle where surfaces slip with weights of now. Not symmetric.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; lambda (n1 multipliers) [F/L^2], as for the residual; piece: STICKSLIP_CONDENSED_...
/// Outputs: rows, columns, values (capacity each), count; duplicates add up; entries without an equation are left out. With
/// all three arrays NULL only count is written, and capacity is not read. Units: F/L; ELIMINATION, REDUCTION_ROWS,
/// REDUCTION_COLUMNS and CONSTRAINED have none.
///
/// Errors: as `stickslip_interface_condensed_multipliers`, INVALID_VALUE (piece), BUFFER_TOO_SMALL.
/// Cost: FORCES, CONSTRAINTS and SCALES as `stickslip_interface_tangent_coo`, counting too; the
/// others as the residual. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_condensed_coo(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    piece: i32,
    capacity: i64,
    rows: *mut i64,
    columns: *mut i64,
    values: *mut f64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(CONDENSED);
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, std::ptr::null())?;
        let piece = choose(piece, "piece", &PIECES, PIECES.len() as i32)?;
        let mut t = Triplets::default();
        let at = (point.x1(), point.x2());
        either!(&mut h.inner, c => c.condensed_tangent(at, point.lambda(), piece, &mut t)?);
        t.check()?;
        t.write(h.base, capacity, rows, columns, Some(values), count)
    })
}

/// Turns the host's own matrix, compressed sparse rows, into that of the system without multipliers, in place: J + E J + G,
/// see `stickslip_interface_condensed_coo`. Where multipliers follow from the displacements add the piece SCALES to it: its
/// entries are there. Several interfaces of one matrix: call them in an order in which an interface whose forces act on a
/// node comes before the one in which the node has a multiplier (docs/host_condensed.md). A node with multipliers in two of
/// them gives wrong forces, which no handle can notice: `stickslip_crosspoints_find` names it as CLAIMED.
///
/// x1, x2, lambda as there; n_rows, row_offsets, columns, values as for `stickslip_interface_tangent_csr`; only the rows of
/// the interface's nodes are read and changed.
///
/// Not with (UNSUPPORTED): parts of an interface (owned has STICKSLIP_NODE_ELSEWHERE).
///
/// Errors: as `stickslip_interface_condensed_multipliers`, NOT_FINITE (the result), INVALID_SIZE, INDEX_OUT_OF_RANGE, and
/// MISSING_ENTRY where the matrix lacks an entry (renew its pattern by `stickslip_interface_condensed_pattern`); then
/// nothing was changed.
/// Cost: as `stickslip_interface_tangent_csr`, and a sum of rows for each mortar node near a non-mortar one. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_condensed_csr(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    n_rows: i64,
    row_offsets: *const i64,
    columns: *const i64,
    values: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(CONDENSED);
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, std::ptr::null())?;
        let csr = read_csr(h.base, n_rows, row_offsets, columns)?;
        raw::check(values, "values")?;
        let at = (point.x1(), point.x2());
        // SAFETY: places are below the number of entries, and the caller's values has that many.
        let value = |place: usize| unsafe { *values.add(place) };
        let rows = either!(&mut h.inner, c => c.condense(at, point.lambda(), csr, &value)?);
        raw::check_results("values", rows.values())?;
        for (place, value) in rows.places() {
            // SAFETY: as above.
            unsafe { *values.add(place) = value };
        }
        Ok(())
    })
}

/// The entries that `stickslip_interface_condensed_csr` may need in the host's matrix while the surfaces slide by less than a
/// quarter of a facet, its own left aside: rows of mortar nodes gain the columns of the non-mortar nodes near them.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; n_rows, row_offsets, columns: the pattern of the host's own matrix. Outputs:
/// entry_rows, entry_columns (capacity each; both NULL: only count), count. Duplicates occur, and entries that are there.
///
/// Errors: as `stickslip_interface_condensed_csr` but for NOT_FINITE and MISSING_ENTRY, BUFFER_TOO_SMALL.
/// Cost: as `stickslip_interface_pattern_coo`, and the entries sorted. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_condensed_pattern(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    n_rows: i64,
    row_offsets: *const i64,
    columns: *const i64,
    capacity: i64,
    entry_rows: *mut i64,
    entry_columns: *mut i64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(CONDENSED);
        let h = handle(interface)?;
        let point = Point::positions(&h.inner, x1, x2)?;
        let csr = read_csr(h.base, n_rows, row_offsets, columns)?;
        let mut t = Triplets::default();
        either!(&mut h.inner, c => c.condensed_pattern(point.x1(), point.x2(), &csr, &mut t)?);
        t.check()?;
        let names = ["entry_rows", "entry_columns", ""];
        t.write_as(names, h.base, capacity, entry_rows, entry_columns, None, count)
    })
}
