//! Laws in place of Coulomb's: those of the library, and one of the host's.

use super::guard::{calling_the_host, guard};
use super::handle::{Inner, either, handle, stickslip_interface};
use super::raw;
use super::sized::{self, Sized64};
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::geometry::Vec3;
use crate::interface::Contact;
use crate::law::{Answer, Ellipse, Host, Own, Question, Threshold};
use crate::memory;
use libc::c_void;

/// Coulomb's law with mu.
pub const STICKSLIP_LAW_COULOMB: i32 = 0;
/// Cohesion (adhesion): a closed node slips at k = cohesion + mu p, p its pressure. It opens under tension all the same, and its
/// shear traction then drops to 0 from at most the cohesion.
pub const STICKSLIP_LAW_COHESION: i32 = 1;
/// Friction that weakens with slip: the coefficient falls from mu, in proportion to the way that the node has slipped since the first
/// configuration, to mu_after at critical_slip, and stays there. The way is the law's one state. A host that is softer than
/// (mu - mu_after) p / critical_slip a unit of area snaps: no step is small enough then, but with inertia.
pub const STICKSLIP_LAW_WEAKENING: i32 = 2;
/// Orthotropic friction: mu along a direction, mu_across across it. Tractions stick within an ellipse, and slip goes at a right angle to
/// its border.
/// Not with (UNSUPPORTED): lines; derivatives by positions of t_n and by parameters.
pub const STICKSLIP_LAW_ORTHOTROPIC: i32 = 3;
/// Friction that weakens with the velocity v of slip: mu_after + (mu - mu_after) exp(-v / critical_rate), v the slip of the step over `time`:
/// set the law again where a step takes another time. Where it falls faster than inertia and the host's own damping hold, a body sticks and slips.
pub const STICKSLIP_LAW_RATE: i32 = 4;
/// The most numbers a node that a law may remember.
pub const STICKSLIP_LAW_MAX_STATES: i32 = 1024;

/// A law of the library in place of Coulomb's, whose mu (of the options, or of `stickslip_interface_set_friction`) it goes on from. What
/// belongs to another kind is 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_law {
    /// sizeof(stickslip_law).
    pub struct_size: u64,
    /// STICKSLIP_LAW_...
    pub kind: i32,
    /// Must be 0.
    pub reserved: i32,
    /// With STICKSLIP_LAW_COHESION c >= 0 [F/L^2].
    pub cohesion: f64,
    /// With STICKSLIP_LAW_WEAKENING the coefficient from the critical slip on, with STICKSLIP_LAW_RATE that of fast slip, >= 0 [-].
    pub mu_after: f64,
    /// With STICKSLIP_LAW_WEAKENING the critical slip, > 0 [L].
    pub critical_slip: f64,
    /// With STICKSLIP_LAW_ORTHOTROPIC the coefficient across the direction, > 0 [-]. A node with mu = 0 has no friction.
    pub mu_across: f64,
    /// With STICKSLIP_LAW_ORTHOTROPIC the direction along which mu counts, of any length but 0 [-]: it is projected on the surface at
    /// each node, where a part of it must be left. It is fixed in space: set the law again where the body turns.
    pub direction: [f64; 3],
    /// With STICKSLIP_LAW_RATE the velocity over which a share of 1/e is left, > 0 [L/T].
    pub critical_rate: f64,
    /// With STICKSLIP_LAW_RATE how long the step takes, > 0 [T].
    pub time: f64,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_law {
    const NAME: &'static str = "stickslip_law";
    const FIRST: usize = 72;
}

/// What a law of the host's is asked about a node.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_law_point {
    /// sizeof(stickslip_law_point), as the library knows it.
    pub struct_size: u64,
    /// Which non-mortar node, counted from options.index_base.
    pub node: i64,
    /// sigma_N, the trial traction along nu: the pressure with a minus, <= 0 [F/L^2].
    pub normal: f64,
    /// Slip of this step, along the surface [L]; 0 where the node was not covered at t_n.
    pub slip: [f64; 3],
    /// Slip since the first configuration, without that of this step [L].
    pub slip_before: [f64; 3],
    /// The unit vector along the trial shear traction, or 0 [-]: along it the node would slip.
    pub direction: [f64; 3],
    /// The node's Coulomb coefficient [-].
    pub mu: f64,
}

/// What it answers. Before the call threshold is NaN, and all derivatives are 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_law_answer {
    /// sizeof(stickslip_law_answer), as the library knows it.
    pub struct_size: u64,
    /// k >= 0: shear tractions below it stick [F/L^2].
    pub threshold: f64,
    /// dk / dnormal <= 0 [-]: k must not fall where the pressure rises. Coulomb: -mu.
    pub dthreshold_dnormal: f64,
    /// dk / dslip [F/L^3].
    pub dthreshold_dslip: [f64; 3],
}

/// A law of the host's: the threshold k of the shear traction at one node, a function of its arguments alone, differentiable with
/// the derivatives that it answers (else Newton's method converges slowly).
///
/// user: as given with the function. states: the node's numbers at t_n; states_after, output: those at the end of the step, if it
/// ended here; both have as many as were announced, and states_after begins as a copy. Returns 0, or any other number to have the
/// evaluation refused (INVALID_VALUE, which names the node): within Newton a domain error.
///
/// It runs in the call of the library that needs it, in the calling thread, whatever method.threads says, for closed nodes one after
/// the other. It must not call the library with any interface (refused), nor change one; it must not throw, and not leave by longjmp. Traps of
/// floating point are off while it runs, and it must leave rounding as it is. In Fortran: a function with bind(C), by c_funloc.
pub type stickslip_threshold = Option<
    unsafe extern "C" fn(
        user: *mut c_void,
        point: *const stickslip_law_point,
        states: *const f64,
        answer: *mut stickslip_law_answer,
        states_after: *mut f64,
    ) -> i32,
>;

/// Asks the function of the host that `host` has the address of.
fn ask(host: &Host, question: &Question, states: &mut [f64]) -> Result<Answer> {
    let point = stickslip_law_point {
        struct_size: size_of::<stickslip_law_point>() as u64,
        node: question.node as i64 + host.base,
        normal: question.normal,
        slip: question.slip.into(),
        slip_before: question.slip_before.into(),
        direction: question.direction.into(),
        mu: question.mu,
    };
    let mut answer = stickslip_law_answer {
        struct_size: size_of::<stickslip_law_answer>() as u64,
        threshold: f64::NAN,
        dthreshold_dnormal: 0.0,
        dthreshold_dslip: [0.0; 3],
    };
    states.copy_from_slice(question.states);
    let [function, user] = host.words;
    let user = std::ptr::with_exposed_provenance_mut::<c_void>(user);
    // SAFETY: the words are those that `stickslip_interface_set_threshold` made of a function, which was not null.
    let function = unsafe {
        std::mem::transmute::<*const c_void, stickslip_threshold>(std::ptr::with_exposed_provenance(function))
    };
    let Some(function) = function else {
        return Err(Error::new(Kind::NullPointer, "the host's law has no function"));
    };
    // SAFETY: the function is the host's, by its contract one of this type; structs and states live as long as the call.
    let status = calling_the_host(|| unsafe {
        function(user, &raw const point, question.states.as_ptr(), &raw mut answer, states.as_mut_ptr())
    });
    if status != 0 {
        let text = text!("the host's law refuses non-mortar node {}: it returned {status}", question.node);
        return Err(Error::new(Kind::InvalidValue, text));
    }
    Ok(Answer {
        threshold: Threshold { radius: answer.threshold, fall: -answer.dthreshold_dnormal },
        slope: Vec3::from(answer.dthreshold_dslip),
    })
}

/// The interface with three multipliers behind a handle: laws are laws of friction.
fn with_friction(h: &mut stickslip_interface) -> Result<&mut Contact<3>> {
    match &mut h.inner {
        Inner::Three(contact) => Ok(contact),
        Inner::One(_) => {
            let text = "interface has no friction: it was created with STICKSLIP_FRICTION_NONE";
            Err(Error::new(Kind::InvalidValue, text))
        }
    }
}

/// The law that a host's struct means; `None`: Coulomb's.
fn read_law(law: *const stickslip_law) -> Result<Option<Own>> {
    if law.is_null() {
        return Ok(None);
    }
    let stickslip_law {
        struct_size: _,
        kind,
        reserved,
        cohesion,
        mu_after,
        critical_slip,
        mu_across,
        direction,
        critical_rate,
        time,
    } = sized::read(law)?;
    let [x, y, z] = direction;
    let numbers = [
        ("reserved", f64::from(reserved), &[][..]),
        ("cohesion", cohesion, &[STICKSLIP_LAW_COHESION]),
        ("mu_after", mu_after, &[STICKSLIP_LAW_WEAKENING, STICKSLIP_LAW_RATE]),
        ("critical_rate", critical_rate, &[STICKSLIP_LAW_RATE]),
        ("time", time, &[STICKSLIP_LAW_RATE]),
        ("critical_slip", critical_slip, &[STICKSLIP_LAW_WEAKENING]),
        ("mu_across", mu_across, &[STICKSLIP_LAW_ORTHOTROPIC]),
        ("direction", x, &[STICKSLIP_LAW_ORTHOTROPIC]),
        ("direction", y, &[STICKSLIP_LAW_ORTHOTROPIC]),
        ("direction", z, &[STICKSLIP_LAW_ORTHOTROPIC]),
    ];
    if kind != STICKSLIP_LAW_COULOMB {
        features::needs!(LAWS);
    }
    let own = match kind {
        STICKSLIP_LAW_COULOMB => None,
        STICKSLIP_LAW_COHESION => Some(Own::Cohesion { cohesion }),
        STICKSLIP_LAW_WEAKENING => Some(Own::Weakening { after: mu_after, slip: critical_slip }),
        STICKSLIP_LAW_ORTHOTROPIC => {
            Some(Own::Orthotropic(Ellipse { direction: Vec3::from(direction), across: mu_across }))
        }
        STICKSLIP_LAW_RATE => Some(Own::Rate { after: mu_after, rate: critical_rate, time }),
        _ => {
            let text = text!("law.kind is {kind}; 0 to {STICKSLIP_LAW_RATE} are allowed");
            return Err(Error::new(Kind::InvalidValue, text));
        }
    };
    for (name, v, of) in numbers {
        if !v.is_finite() {
            return Err(Error::new(Kind::NotFinite, text!("law.{name} is {v}; it must be finite")));
        }
        if v != 0.0 && !of.contains(&kind) {
            return Err(Error::new(Kind::InvalidValue, text!("law.{name} is {v}; it must be 0 with this kind of law")));
        }
    }
    Ok(own)
}

/// Takes a law of the library in place of Coulomb's, from the next evaluation on. The interface must have been created with
/// STICKSLIP_FRICTION_COULOMB. Newly covered nodes and prescribed directions are treated as under Coulomb's law.
///
/// law: see `stickslip_law`; NULL, or STICKSLIP_LAW_COULOMB: Coulomb's. It is copied. Not part of the history, which holds its states and
/// of which kind they are: set it again after a restart, before the import. A law of the same kind goes on with the states that
/// there are, and its numbers may change from step to step; another one begins with states 0, and no commit before it can be undone.
///
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS); derivatives by positions of t_n and by
/// parameters.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, INVALID_VALUE (a number; an interface with another law), UNSUPPORTED (see
/// above and the kinds).
/// That the direction has no part in the surface at a node is refused where the node is evaluated (INVALID_VALUE).
/// Cost: nothing grows with the surface but the states; allocates them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_law(
    interface: *mut stickslip_interface,
    law: *const stickslip_law,
) -> i32 {
    guard(|| {
        let contact = with_friction(handle(interface)?)?;
        contact.set_law(read_law(law)?)
    })
}

/// Takes a function of the host's as the law: what Abaqus calls FRIC, but with a threshold in place of a traction, so that
/// stick and slip, and the exact tangent, stay the library's. As `stickslip_interface_set_law` otherwise.
///
/// threshold: see `stickslip_threshold`; not NULL (Coulomb's law comes back by `stickslip_interface_set_law`). user: passed on to it, may be
/// NULL. n_states: how many numbers it remembers of each node, 0 to STICKSLIP_LAW_MAX_STATES; they begin at 0, or see
/// `stickslip_interface_set_law_states`. Function and user must be valid as long as the interface has them.
///
/// Evaluations refuse, and nothing has changed: an answer that is not finite (NOT_FINITE); a threshold below 0, one that falls
/// where the pressure rises, or a return value but 0 (INVALID_VALUE). The message names the node.
///
/// Errors: NULL_POINTER, INVALID_SIZE, INVALID_VALUE (an interface with another law), UNSUPPORTED (points that decide).
/// Cost: the states; allocates them. In evaluations one call a closed node, of carriers of others one more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_threshold(
    interface: *mut stickslip_interface,
    threshold: stickslip_threshold,
    user: *mut c_void,
    n_states: i64,
) -> i32 {
    guard(|| {
        features::needs!(LAWS);
        let h = handle(interface)?;
        let base = h.base;
        let Some(function) = threshold else {
            return Err(Error::new(Kind::NullPointer, "threshold is NULL"));
        };
        if !(0..=i64::from(STICKSLIP_LAW_MAX_STATES)).contains(&n_states) {
            let text = text!("n_states is {n_states}; it must be at least 0 and at most {STICKSLIP_LAW_MAX_STATES}");
            return Err(Error::new(Kind::InvalidSize, text));
        }
        let states = n_states as usize;
        let words = [function as usize, user.expose_provenance()];
        with_friction(h)?.set_law(Some(Own::Host(Host { ask, words, states, base })))
    })
}

/// What the law remembers of the nodes at t_n: for output, and to be handed to other handles with parts of the interface.
///
/// states, output: node by node, as many numbers as the law remembers (of STICKSLIP_LAW_WEAKENING one, the way slipped [L]). n: how many
/// it has room for; count, output: how many there are, 0 of a law that remembers nothing. states NULL: they are counted only. A call
/// that is refused leaves both as they were.
///
/// Errors: NULL_POINTER, BUFFER_TOO_SMALL.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_law_states(
    interface: *mut stickslip_interface,
    n: i64,
    states: *mut f64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        raw::check(count, "count")?;
        raw::check_optional(states, "states")?;
        let kept = either!(&h.inner, c => c.law_states());
        if !states.is_null() && n < kept.len() as i64 {
            let text = text!("n is {n}; the law's states need {}", kept.len());
            return Err(Error::new(Kind::BufferTooSmall, text));
        }
        raw::write(states, kept);
        raw::write(count, &[kept.len() as i64]);
        Ok(())
    })
}

/// Replaces what the law remembers of the nodes at t_n, after `stickslip_interface_set_committed`, which sets it to 0, or for states that do not
/// begin at 0. No commit can then be undone.
///
/// states: n numbers, as `stickslip_interface_law_states` has them.
///
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE.
/// Cost: a copy; allocates it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_law_states(
    interface: *mut stickslip_interface,
    n: i64,
    states: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let n = raw::count(n, 0, "n")?;
        let states = memory::copied(raw::numbers(states, n, "states")?)?;
        either!(&mut h.inner, c => c.set_law_states(&states))
    })
}
