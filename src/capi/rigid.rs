//! Rigid bodies: equations of a reference point in place of those of nodes. Beside the interface: functions of plain data.

use super::choice::choose;
use super::guard::guard;
use super::preparation::read_base;
use super::raw::{self, Member};
use super::sized::{self, Sized64};
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::geometry::Vec3;
use crate::memory::{self, Store, Stored};
use crate::rigid::{Body, Levers, Motion, RigidPlan, SIX, turned};
use nalgebra::Matrix3;

/// A rigid body: nodes that move with a reference point, those of a surface of one interface or of several, or any others.
///
/// In plane and axisymmetric models (dimension 2) vectors have two numbers, and a body has three unknowns: two displacements and
/// the rotation from the first axis towards the second. In an axisymmetric model only the displacement along the axis may have an
/// equation.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_rigid_body {
    /// sizeof(stickslip_rigid_body).
    pub struct_size: u64,
    /// Numbers of a node: 3, or 2 of lines.
    pub dimension: i32,
    /// 0.
    pub reserved: i32,
    /// Number of nodes.
    pub n_nodes: i64,
    /// dimension n_nodes coordinates of the first configuration, node by node [L].
    pub coordinates: *const f64,
    /// dimension numbers: the reference point P of the first configuration, anywhere [L].
    pub point: *const f64,
    /// dimension n_nodes equations of the nodes in the nodal matrix, node by node, in the index base: those that the interfaces were
    /// created with. Numbers that nothing else has, as those beyond the host's unknowns; -1: none. Read by
    /// `stickslip_rigid_create` alone; else it may be NULL.
    pub node_equations: *const i64,
    /// 6 equations of the host's unknowns in the index base: displacement of the reference point along x, y, z, rotation vector along
    /// x, y, z; of lines 3: displacement along both axes, rotation. -1: prescribed. Read by `stickslip_rigid_create` alone; else it may
    /// be NULL.
    pub equations: *const i64,
}

// SAFETY: repr(C), struct_size first, integers and raw pointers only, no padding.
unsafe impl Sized64 for stickslip_rigid_body {
    const NAME: &'static str = "stickslip_rigid_body";
    const FIRST: usize = 56;
}

/// Moments are about the reference point, of forces at the nodes of the motion. Default.
pub const STICKSLIP_RIGID_ARMS_END: i32 = 0;
/// Moments have the means of a node's arms at t_n and at the motion: the work of forces that are constant in a step is that of their sum over u
/// and of this moment over 2 tan(|theta| / 2) theta / |theta|, exactly. For dynamics (docs/formulation 14.7).
pub const STICKSLIP_RIGID_ARMS_MIDDLE: i32 = 1;

/// The motion of a rigid body since the first configuration: x = P + u + exp[theta] R (X - P). A host keeps theta among its
/// unknowns, adds Newton's steps to it, and calls `stickslip_rigid_turn` after each converged step.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_rigid_motion {
    /// sizeof(stickslip_rigid_motion).
    pub struct_size: u64,
    /// u of the reference point [L]; of lines the third is 0.
    pub displacement: [f64; 3],
    /// theta, the rotation vector of the step: axis times angle, at most pi [-]; of lines the first two are 0.
    pub rotation: [f64; 3],
    /// R, what the body has turned by at t_n, row by row [-]; zeros alone: not at all.
    pub turned: [f64; 9],
    /// STICKSLIP_RIGID_ARMS_...; an older caller's: END.
    pub arms: i32,
    /// 0.
    pub reserved: i32,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_rigid_motion {
    const NAME: &'static str = "stickslip_rigid_motion";
    const FIRST: usize = 128;
}

/// Where the entries of a nodal matrix go that have rows or columns of rigid nodes. Created and destroyed by the library; one thread
/// at a time.
pub struct stickslip_rigid {
    plan: RigidPlan,
    base: i64,
}

/// A body but for its equations.
fn read_body(b: &stickslip_rigid_body) -> Result<Body<'static>> {
    let name = |member| Member("body", member);
    let dimension = match b.dimension {
        2 | 3 => b.dimension as usize,
        other => {
            let text = text!("body.dimension is {other}; 3, or 2 of lines, is allowed");
            return Err(Error::new(Kind::InvalidValue, text));
        }
    };
    if b.reserved != 0 {
        return Err(Error::new(Kind::InvalidValue, text!("body.reserved is {}; it must be 0", b.reserved)));
    }
    let n = raw::count(b.n_nodes, 1, name("n_nodes"))?;
    let coordinates = raw::numbers(b.coordinates, dimension * n, name("coordinates"))?;
    if b.point.is_null() {
        let text =
            "body.point is NULL: a rigid body needs a reference point, which its displacement and its moment are of";
        return Err(Error::new(Kind::NullPointer, text));
    }
    let point = raw::numbers(b.point, dimension, name("point"))?;
    let point = Vec3::new(point[0], point[1], point.get(2).copied().unwrap_or(0.0));
    Ok(Body { point, coordinates, dimension })
}

/// A motion of a body of this dimension.
fn read_motion(m: &stickslip_rigid_motion, dimension: usize) -> Result<Motion> {
    for (values, member) in
        [(&m.displacement[..], "displacement"), (&m.rotation[..], "rotation"), (&m.turned[..], "turned")]
    {
        raw::numbers(values.as_ptr(), values.len(), Member("motion", member))?;
    }
    let out_of_plane = [m.displacement[2], m.rotation[0], m.rotation[1]];
    if dimension == 2 && out_of_plane.iter().any(|&v| v != 0.0) {
        let text = "motion leaves the plane: displacement[2], rotation[0] and rotation[1] of lines must be 0";
        return Err(Error::new(Kind::InvalidValue, text));
    }
    if m.reserved != 0 {
        return Err(Error::new(Kind::InvalidValue, text!("motion.reserved is {}; it must be 0", m.reserved)));
    }
    let levers = choose(m.arms, "motion.arms", &[Levers::End, Levers::Middle], 2)?;
    Motion::new(m.displacement.into(), m.rotation.into(), Matrix3::from_row_slice(&m.turned), levers)
}

/// The k-th struct of a caller's array, whose first one says how far apart they are.
fn read_each<T: Sized64>(first: *const T, k: usize) -> Result<T> {
    let stride = sized::declared_size(first)?;
    sized::read(first.wrapping_byte_add(k * stride))
}

/// Equations from 0; -1 stays.
fn from_zero(values: &[i64], base: i64, name: &str) -> Result<Vec<i64>> {
    let from_zero = |(k, &v): (usize, &i64)| match v {
        -1 => Ok(-1),
        v if v >= base => Ok(v - base),
        v => {
            let text = text!("{name}[{k}] is {v}; -1 or at least {base} is allowed");
            Err(Error::new(Kind::IndexOutOfRange, text))
        }
    };
    values.iter().enumerate().map(from_zero).stored_if_ok()
}

/// The equations of a reference point, of lines with none for what they lack.
fn six(b: &stickslip_rigid_body, dimension: usize, base: i64) -> Result<[i64; SIX]> {
    let given = if dimension == 2 { 3 } else { SIX };
    let e = from_zero(raw::slice(b.equations, given, Member("body", "equations"))?, base, "body.equations")?;
    Ok(if dimension == 2 { [e[0], e[1], -1, -1, -1, e[2]] } else { [e[0], e[1], e[2], e[3], e[4], e[5]] })
}

/// Positions of a rigid body's nodes, docs/formulation 14.1: what the functions of an interface take for x1 or x2.
///
/// body, motion: see there. Output: x (dimension n_nodes), node by node [L].
///
/// Errors: NULL_POINTER (body.point, too: a body needs a reference point), STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INVALID_VALUE (the
/// dimension, a rotation longer than pi, a matrix that is no rotation, a motion out of the plane).
/// Cost: O(n_nodes); allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_rigid_positions(
    body: *const stickslip_rigid_body,
    motion: *const stickslip_rigid_motion,
    x: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(RIGID);
        let body = read_body(&sized::read(body)?)?;
        let motion = read_motion(&sized::read(motion)?, body.dimension)?;
        raw::check(x, "x")?;
        let fine = |x: Vec3| x.iter().all(|x| x.is_finite());
        if !body.positions(&motion).all(fine) {
            return raw::overflow("x");
        }
        let x_of = body.positions(&motion);
        raw::write_each(x, x_of.flat_map(|x| [x.x, x.y, x.z].into_iter().take(body.dimension)));
        Ok(())
    })
}

/// Force and moment about the reference point as it is now, of forces on a rigid body's nodes, docs/formulation 14.3: what a host
/// adds to the equations of the body in place of the nodal forces of `stickslip_interface_residual`, with the same sign.
///
/// body, motion: see there; forces (dimension n_nodes), node by node [F]. Output: resultant (6): force along x, y, z [F], moment
/// about x, y, z [F L]; of lines 3: force along both axes, moment.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INVALID_VALUE (as `stickslip_rigid_positions`).
/// Cost: O(n_nodes); allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_rigid_resultant(
    body: *const stickslip_rigid_body,
    motion: *const stickslip_rigid_motion,
    forces: *const f64,
    resultant: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(RIGID);
        let body = read_body(&sized::read(body)?)?;
        let motion = read_motion(&sized::read(motion)?, body.dimension)?;
        let forces = raw::numbers(forces, body.coordinates.len(), "forces")?;
        raw::check(resultant, "resultant")?;
        let [f, m] = body.resultant(&motion, forces);
        let all = if body.dimension == 2 { [f.x, f.y, m.z, 0.0, 0.0, 0.0] } else { [f.x, f.y, f.z, m.x, m.y, m.z] };
        raw::check_results("resultant", &all)?;
        raw::write(resultant, &all[..if body.dimension == 2 { 3 } else { SIX }]);
        Ok(())
    })
}

/// After a converged step: takes what the body has turned by in it into `turned`, and sets `rotation` to 0. The positions stay
/// those they were, but for rounding.
///
/// motion: input and output.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, INVALID_VALUE (as `stickslip_rigid_positions`).
/// Cost: below a microsecond; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_rigid_turn(motion: *mut stickslip_rigid_motion) -> i32 {
    guard(|| {
        features::needs!(RIGID);
        let mut m = sized::read(motion.cast_const())?;
        read_motion(&m, 3)?;
        let before = Matrix3::from_row_slice(&m.turned);
        let before = if before == Matrix3::zeros() { Matrix3::identity() } else { before };
        m.turned.copy_from_slice(turned(&m.rotation.into(), &before).transpose().as_slice());
        m.rotation = [0.0; 3];
        sized::write(motion, m);
        Ok(())
    })
}

/// Finds where the entries of a nodal matrix go where rigid bodies have equations of their reference points: rows and columns of their
/// nodes become six, docs/formulation 14.4. The nodal matrix is a tangent of an interface by `stickslip_interface_plan_coo` or
/// `stickslip_interface_tangent_coo`, a piece of a condensed one, those of several interfaces one after the other, or element
/// matrices of the host's; its other entries stay as they are. Multipliers of a rigid non-mortar side stay those of its nodes.
///
/// n_bodies, bodies: each body once, whatever interfaces it is in; index_base 0 or 1; n_entries, rows, columns (n_entries each): the
/// nodal matrix, in any order, with entries more than once where they add up; one of row or column -1 is left out. With n_entries 0, as
/// of a tool that nothing follows, both may be NULL: forces on the bodies turn with them all the same. Outputs: out, the handle; count:
/// entries of the outcome, those of a body's rows and columns with itself always among them.
///
/// Errors: NULL_POINTER (body.point, too: a body needs a reference point), STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INDEX_OUT_OF_RANGE,
/// INVALID_VALUE (the index base, the dimension; an equation that two nodes or two unknowns have), UNSUPPORTED (more than 1e9 nodes).
/// Cost: O(n log n) of n entries and nodes; allocates 40 bytes an entry at most, which it keeps.
/// Owner: the caller, who ends it with `stickslip_rigid_destroy`. All arrays may be freed after the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_rigid_create(
    n_bodies: i64,
    bodies: *const stickslip_rigid_body,
    index_base: i32,
    n_entries: i64,
    rows: *const i64,
    columns: *const i64,
    out: *mut *mut stickslip_rigid,
    count: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(RIGID);
        let n_bodies = raw::count(n_bodies, 1, "n_bodies")?;
        let base = read_base(index_base)?;
        sized::declared_size(bodies)?;
        let (mut all, mut of_nodes) = (memory::with_room(n_bodies)?, memory::with_room(n_bodies)?);
        for k in 0..n_bodies {
            let b = read_each(bodies, k)?;
            let body = read_body(&b)?;
            let equations = raw::slice(b.node_equations, body.coordinates.len(), Member("body", "node_equations"))?;
            of_nodes.store(from_zero(equations, base, "body.node_equations")?)?;
            let six = six(&b, body.dimension, base)?;
            all.store((body, six))?;
        }
        let kept: Vec<_> = all.into_iter().zip(&of_nodes).map(|((body, six), of)| (body, &of[..], six)).stored()?;
        let n = raw::count(n_entries, 0, "n_entries")?;
        let (rows, columns) = if n == 0 {
            (Vec::new(), Vec::new())
        } else {
            let rows = from_zero(raw::slice(rows, n, "rows")?, base, "rows")?;
            (rows, from_zero(raw::slice(columns, n, "columns")?, base, "columns")?)
        };
        raw::check(out, "out")?;
        raw::check(count, "count")?;
        let plan = RigidPlan::new(&kept, rows.into_iter(), columns.into_iter())?;
        let entries = plan.places().len() as i64;
        raw::write(out, &[raw::owned(stickslip_rigid { plan, base })?]);
        raw::write(count, &[entries]);
        Ok(())
    })
}

/// What is behind a pointer.
fn plan<'a>(p: *mut stickslip_rigid) -> Result<&'a mut stickslip_rigid> {
    raw::check(p, "rigid")?;
    // SAFETY: non-null and aligned; by the caller's contract it came from create, is not destroyed, and is used by this thread
    // alone.
    Ok(unsafe { &mut *p })
}

/// The entries of the outcome, in the index base, by rows and within a row by columns, each once: as compressed sparse rows have
/// them.
///
/// rigid: what `stickslip_rigid_create` made. Outputs: rows, columns (capacity each; at least its count).
///
/// Errors: NULL_POINTER, BUFFER_TOO_SMALL.
/// Cost: a copy; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_rigid_coo(
    rigid: *mut stickslip_rigid,
    capacity: i64,
    rows: *mut i64,
    columns: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(RIGID);
        let r = plan(rigid)?;
        raw::check(rows, "rows")?;
        raw::check(columns, "columns")?;
        let places = r.plan.places();
        raw::room(capacity, places.len(), "rows and columns")?;
        raw::write_each(rows, places.iter().map(|place| place.0 + r.base));
        raw::write_each(columns, places.iter().map(|place| place.1 + r.base));
        Ok(())
    })
}

/// The values of the entries that `stickslip_rigid_coo` gives: exact derivatives, by the unknowns of the bodies, of forces, of moments about
/// the reference points as they are now, and of all other rows. docs/formulation 14.4.
///
/// rigid: what `stickslip_rigid_create` made; motions: one of each body; forces: of the bodies' nodes, body by body, each dimension n_nodes, as for
/// `stickslip_rigid_resultant` [F]: their arms turn with the body; nodal (n_entries; NULL where there are none): the nodal matrix
/// in the order of `stickslip_rigid_create`. Output: values (count of `stickslip_rigid_create`). After NOT_FINITE because a value overflows they mean
/// nothing. Units of an entry: its row's over its column's.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, INVALID_VALUE (a motion, as `stickslip_rigid_positions`).
/// Cost: O(entries), up to 16 products for one of a rigid row and a rigid column; allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_rigid_values(
    rigid: *mut stickslip_rigid,
    motions: *const stickslip_rigid_motion,
    forces: *const f64,
    nodal: *const f64,
    values: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(RIGID);
        let plan = &mut plan(rigid)?.plan;
        sized::declared_size(motions)?;
        let motion = |(k, (dimension, _)): (usize, (usize, usize))| read_motion(&read_each(motions, k)?, dimension);
        let of_bodies = plan.bodies().enumerate().map(motion).stored_if_ok()?;
        let n: usize = plan.bodies().map(|(dimension, nodes)| dimension * nodes).sum();
        let forces = raw::numbers(forces, n, "forces")?;
        let nodal = if plan.entries() == 0 { &[] } else { raw::numbers(nodal, plan.entries(), "nodal")? };
        let values = raw::values(values, plan.places().len(), "values")?;
        plan.values(&of_bodies, forces, nodal, values);
        raw::check_array("values", values)
    })
}

/// Destroys rigid, what `stickslip_rigid_create` made, and sets the caller's pointer to NULL. NULL, or a pointer to NULL, is fine.
///
/// Errors: NULL_POINTER (misaligned).
/// Cost: frees memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_rigid_destroy(rigid: *mut *mut stickslip_rigid) -> i32 {
    guard(|| {
        if rigid.is_null() {
            return Ok(());
        }
        raw::check(rigid, "rigid")?;
        // SAFETY: non-null and aligned.
        let made = unsafe { rigid.read() };
        if made.is_null() {
            return Ok(());
        }
        raw::check(made, "rigid")?;
        raw::write(rigid, &[std::ptr::null_mut()]);
        // SAFETY: non-null and aligned; it came from create and is destroyed once.
        drop(unsafe { Box::from_raw(made) });
        Ok(())
    })
}
