//! Heat across an interface.

use super::choice::choose;
use super::guard::guard;
use super::handle::{either, handle, sizes, stickslip_interface};
use super::point::Point;
use super::raw;
use super::sized::{self, Sized64};
use super::tangent::Triplets;
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::interface::{NO_EQUATION, Temperatures};
use crate::law::{Conductance, HeatNode, heat_flow};
use crate::memory::{self, Store};

/// Columns of the heat's tangent: of temperatures alone.
pub const STICKSLIP_HEAT_TEMPERATURES: i32 = 0;
/// Columns of the heat's tangent: of temperatures, displacements and multipliers.
pub const STICKSLIP_HEAT_ALL: i32 = 1;

/// Derivatives per side of `stickslip_node_heat`.
pub const STICKSLIP_HEAT_SLOPES: i32 = 5;

/// How heat crosses an interface, and where that of friction goes. Zeros: nothing passes, friction makes none. T stands for a time,
/// K for a temperature, so that F L/T is a power.
///
/// Per area h (T1 - T2) leaves the non-mortar body and enters the mortar one. With the pressure p and the mean gap g of a node
/// h = contact f(p / pressure) + (constant + gas / (g + gas_gap)) b(g / reach). f(x) is x to the exponent; below x = 1/1000 a
/// parabola of third degree takes its place that begins with slope 0. b is 1 and falls over the last tenth of the reach
/// smoothly to 0. Below g = 0 gas / (g + gas_gap) goes on along its tangent.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_heat {
    /// sizeof(stickslip_heat).
    pub struct_size: u64,
    /// Conductance at the reference pressure, >= 0 [F/(L T K)].
    pub contact: f64,
    /// The reference pressure, above 0 where contact is [F/L^2].
    pub pressure: f64,
    /// The exponent, above 0 where contact is, at most 2 [-]. About 0.95 for rough metals.
    pub exponent: f64,
    /// Conductance at any pressure and any gap within reach, >= 0 [F/(L T K)].
    pub constant: f64,
    /// Conductivity of what fills the gap, >= 0 [F/(T K)].
    pub gas: f64,
    /// What touching surfaces count as a gap, above 0 where gas is [L].
    pub gas_gap: f64,
    /// Gaps from which on neither constant nor gas pass anything; required, above 0, where one of them is [L].
    pub reach: f64,
    /// The share of the heat of friction that goes into the non-mortar body, 0 to 1 [-]. The rest goes into the mortar body.
    pub share: f64,
    /// The time that the step takes [T]; 0: friction makes no heat. The heat of a node is its dissipation in the step over this.
    pub time: f64,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_heat {
    const NAME: &'static str = "stickslip_heat";
    const FIRST: usize = 80;
}

/// What `stickslip_interface_heat` reports per non-mortar node, n1 each; a NULL member is not wanted. 0 where nothing covers the
/// node, or its multiplier acts elsewhere.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_heat_nodes {
    /// sizeof(stickslip_heat_nodes).
    pub struct_size: u64,
    /// h [F/(L T K)].
    pub conductance: *mut f64,
    /// h times the mean jump of temperature: from the non-mortar to the mortar body, without friction's heat [F/(L T)].
    pub flux: *mut f64,
    /// The mean jump of temperature, T1 - T2 [K].
    pub jump: *mut f64,
    /// The heat of friction, which both bodies get in all [F L/T].
    pub friction: *mut f64,
    /// The area that the means are of [L^2].
    pub area: *mut f64,
}

// SAFETY: repr(C), struct_size first, raw pointers only.
unsafe impl Sized64 for stickslip_heat_nodes {
    const NAME: &'static str = "stickslip_heat_nodes";
    const FIRST: usize = 48;
}

fn read_heat(p: *const stickslip_heat) -> Result<Conductance> {
    let h = sized::read(p)?;
    let c = Conductance {
        contact: h.contact,
        pressure: h.pressure,
        exponent: h.exponent,
        constant: h.constant,
        gas: h.gas,
        gas_gap: h.gas_gap,
        reach: h.reach,
        share: h.share,
        time: h.time,
    };
    c.check("heat").map(|()| c)
}

/// Heat that leaves the nodes of both sides, what to ADD to the host's internal heat flow (conduction and storage, less sources).
/// With q_A of each non-mortar node: sum_A n_AB q_A at the non-mortar, - sum_A n_AC q_A at the mortar nodes, less friction's heat.
/// All of it sums up to minus the heat of friction: what leaves one body enters the other one. A linear temperature over meshes
/// that do not match passes exactly. docs/formulation, 17.
///
/// x1 (3 n1), x2 (3 n2), lambda (3 n1): as for `stickslip_interface_states`; before the commit, as there. heat: see there.
/// temperatures1 (n1), temperatures2 (n2) [K], from any zero. An analytic mortar side has temperatures at the points of its frame: one value
/// at all of them is a tool of one temperature, one equation for all of them a tool that stores heat. Outputs: heat1 (n1), heat2 (n2) [F L/T]; nodes: NULL, or its members point
/// to the caller's arrays. Of a part of an interface (`owned`) they are what its own nodes give, to be added up like forces. In
/// plane models they are of the thickness, in axisymmetric ones of the whole ring.
///
/// Errors: as `stickslip_interface_residual` without sums; INVALID_VALUE (a member of heat), NOT_FINITE (temperatures; a result that
/// overflows).
/// Cost: after a residual at the same point O(pairs); where surfaces are apart an integration. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_heat(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    heat: *const stickslip_heat,
    temperatures1: *const f64,
    temperatures2: *const f64,
    heat1: *mut f64,
    heat2: *mut f64,
    nodes: *const stickslip_heat_nodes,
) -> i32 {
    guard(|| {
        features::needs!(HEAT);
        let h = &mut handle(interface)?.inner;
        let point = Point::read(h, x1, x2, lambda, std::ptr::null())?;
        let conductance = read_heat(heat)?;
        let temperatures = read_temperatures(sizes(h), &conductance, temperatures1, temperatures2)?;
        raw::check(heat1, "heat1")?;
        raw::check(heat2, "heat2")?;
        let out = if nodes.is_null() { None } else { Some(sized::read(nodes)?) };
        for out in out.iter() {
            for (p, name) in [
                (out.conductance, "nodes.conductance"),
                (out.flux, "nodes.flux"),
                (out.jump, "nodes.jump"),
                (out.friction, "nodes.friction"),
                (out.area, "nodes.area"),
            ] {
                raw::check_optional(p, name)?;
            }
        }
        let x = [point.x1(), point.x2()];
        let found = either!(h, c => c.heat(x, point.lambda(), temperatures)?);
        found.sides.iter().try_for_each(|side| raw::check_results("heat1, heat2", side))?;
        raw::write(heat1, &found.sides[0]);
        raw::write(heat2, &found.sides[1]);
        if let Some(out) = out {
            let all = || found.nodes.iter();
            let covered = |node: &HeatNode, v: f64| if node.area > 0.0 { v } else { 0.0 };
            let heats = conductance.time > 0.0;
            raw::write_each(out.conductance, all().map(|(_, flow)| flow.conductance));
            raw::write_each(out.flux, all().map(|(_, flow)| flow.flux));
            raw::write_each(out.jump, all().map(|(node, _)| covered(node, node.jump / node.area)));
            let friction = |node: &HeatNode| if heats { node.work / conductance.time } else { 0.0 };
            raw::write_each(out.friction, all().map(|(node, _)| friction(node)));
            raw::write_each(out.area, all().map(|(node, _)| node.area));
        }
        Ok(())
    })
}

fn read_temperatures<'a>(
    (n1, n2): (usize, usize),
    conductance: &'a Conductance,
    one: *const f64,
    two: *const f64,
) -> Result<Temperatures<'a>> {
    let sides = [raw::numbers(one, n1, "temperatures1")?, raw::numbers(two, n2, "temperatures2")?];
    Ok(Temperatures { sides, conductance })
}

/// The exact tangent of `stickslip_interface_heat` as triplets in the host's equation numbers and index base: by rows, which are the
/// temperatures' equations, each entry once (as often as nodes share equations). For Newton's method in which temperatures, displacements and
/// multipliers are solved for together: forces have no columns of temperatures, so that the rest of that matrix is
/// `stickslip_interface_tangent_coo` and the host's own. docs/formulation, 17.2.
///
/// x1, x2, lambda, heat, temperatures1, temperatures2: as for `stickslip_interface_heat`. equations1 (n1), equations2 (n2): of the temperatures, one a node, in
/// the index base; -1: prescribed. which: STICKSLIP_HEAT_TEMPERATURES, or STICKSLIP_HEAT_ALL: with columns of the displacements and
/// multipliers that the interface was created with. Outputs: rows, columns, values (capacity each), count. With all three arrays
/// NULL only count is written, and capacity is not read. Entries of [F L/(T K)], [F/T], [L^3/T]. After NOT_FINITE because a value
/// overflows, values mean nothing.
///
/// STICKSLIP_HEAT_ALL:
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS); conserving weights
/// (STICKSLIP_WEIGHTS_CONSERVING).
///
/// Errors: those of `stickslip_interface_heat`, INDEX_OUT_OF_RANGE (an equation below the base), INVALID_VALUE (which), BUFFER_TOO_SMALL,
/// UNSUPPORTED.
/// Cost: as the heat; with all columns the derivatives of all weights, about twice a tangent of forces. Counting costs the same.
/// Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_heat_tangent_coo(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    heat: *const stickslip_heat,
    temperatures1: *const f64,
    temperatures2: *const f64,
    equations1: *const i64,
    equations2: *const i64,
    which: i32,
    capacity: i64,
    rows: *mut i64,
    columns: *mut i64,
    values: *mut f64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(HEAT);
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, std::ptr::null())?;
        let conductance = read_heat(heat)?;
        let sizes = sizes(&h.inner);
        let temperatures = read_temperatures(sizes, &conductance, temperatures1, temperatures2)?;
        let one = read_equations(equations1, sizes.0, h.base, "equations1")?;
        let two = read_equations(equations2, sizes.1, h.base, "equations2")?;
        let with_motion = choose(which, "which", &[false, true], 2)?;
        raw::check(count, "count")?;
        raw::only_counts(&[(rows.cast(), "rows"), (columns.cast(), "columns"), (values.cast(), "values")])?;
        let mut triplets = Triplets::default();
        let x = [point.x1(), point.x2()];
        either!(&mut h.inner, c => {
            c.heat_tangent(x, point.lambda(), temperatures, ([&one, &two], with_motion), &mut triplets)?;
        });
        triplets.check()?;
        triplets.write(h.base, capacity, rows, columns, Some(values), count)
    })
}

/// Equations of the caller's, from 0.
fn read_equations(p: *const i64, n: usize, base: i64, name: &str) -> Result<Vec<i64>> {
    let mut all = memory::with_room(n)?;
    for (k, &e) in raw::slice(p, n, name)?.iter().enumerate() {
        all.store(match e {
            -1 => NO_EQUATION,
            e if e >= base => e - base,
            e => {
                let text = text!("{name}[{k}] is {e}; -1 or at least {base} is allowed");
                return Err(Error::new(Kind::IndexOutOfRange, text));
            }
        })?;
    }
    Ok(all)
}

/// What passes through one node, for hosts that go through the stages: they add up jump and area over the node's pairs with the
/// weights of `stickslip_pair_weights`, as they do with gaps, and deal the result out as they do with forces: heat of
/// sum_A n_AB sides[0] at non-mortar, - sum_A n_AC sides[1] at mortar nodes.
///
/// jump: sum_B n_AB T_B - sum_C n_AC T_C [K L^2]. pressure >= 0: minus the normal projected traction [F/L^2]. gap: the normal
/// weighted gap, nu . g_A [L^3]. area: sum_B n_AB, above 0 [L^2]. work: traction times slip in the step [F L]. Outputs: sides (2)
/// [F/(L T)]: what leaves the non-mortar body and what enters the mortar one, friction's heat included; slopes (2 times
/// STICKSLIP_HEAT_SLOPES, or NULL): their derivatives by these five numbers, side by side; conductance (1, or NULL) [F/(L T K)].
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, INVALID_VALUE (a member of heat, an area that is not positive, a negative pressure).
/// Cost: below a microsecond; allocates nothing. docs/formulation, 17.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_node_heat(
    heat: *const stickslip_heat,
    jump: f64,
    pressure: f64,
    gap: f64,
    area: f64,
    work: f64,
    sides: *mut f64,
    slopes: *mut f64,
    conductance: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(HEAT);
        let law = read_heat(heat)?;
        for (v, name, least) in [
            (jump, "jump", f64::NEG_INFINITY),
            (pressure, "pressure", 0.0),
            (gap, "gap", f64::NEG_INFINITY),
            (area, "area", f64::MIN_POSITIVE),
            (work, "work", f64::NEG_INFINITY),
        ] {
            if !v.is_finite() {
                return Err(Error::new(Kind::NotFinite, text!("{name} is {v}; it must be finite")));
            }
            if v < least {
                let text =
                    text!("{name} is {v}; it must {}", if least > 0.0 { "be positive" } else { "not be negative" });
                return Err(Error::new(Kind::InvalidValue, text));
            }
        }
        raw::check(sides, "sides")?;
        raw::check_optional(slopes, "slopes")?;
        raw::check_optional(conductance, "conductance")?;
        let flow = heat_flow(&law, &HeatNode { jump, pressure, gap, area, work });
        let numbers = flow.slopes.as_flattened();
        raw::check_results("sides, slopes", &[flow.sides[0], flow.sides[1]])?;
        raw::check_results("sides, slopes", numbers)?;
        raw::write(sides, &flow.sides);
        raw::write(slopes, numbers);
        raw::write(conductance, &[flow.conductance]);
        Ok(())
    })
}
