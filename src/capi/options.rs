//! What an interface models: `stickslip_options`.

use super::choice::{choose, unnamed};
use super::guard::guard;
use super::method::{Modelled, PAPER, read_method, stickslip_method};
use super::model::{STICKSLIP_MODEL_SOLID, measure, model as read_model};
use super::raw;
use super::sized::{self, Sized64};
use crate::error::{Error, Kind, Result, Text};
use crate::geometry::AnalyticShape;
use crate::interface::{MortarSide, Options, Stiffness};
use crate::law::{Coefficient, Friction, LAWS};
use crate::line::Measure;

/// Coulomb friction with the coefficient mu (0 allowed). Default.
pub const STICKSLIP_FRICTION_COULOMB: i32 = 0;
/// One multiplier per node, along the normal: multiplier_equations, lambda and rows have n1 entries. No slip history.
pub const STICKSLIP_FRICTION_NONE: i32 = 1;
/// Mesh tying: a node that is covered in the first configuration keeps its place; weights of the reference. A gap at the
/// start stays, and turns with the non-mortar facets; linear where there is none.
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS); a layer between the surfaces
/// (stickslip_interface_set_layer).
pub const STICKSLIP_FRICTION_TIED: i32 = 2;
/// Opens and closes, never slips.
pub const STICKSLIP_FRICTION_ROUGH: i32 = 3;
/// Coulomb friction with the coefficient mu, up to a largest shear traction, shear_limit.
pub const STICKSLIP_FRICTION_TRESCA: i32 = 4;
/// The mortar side deforms (or is prescribed, where it has no equations). Default.
pub const STICKSLIP_MORTAR_DEFORMABLE: i32 = 0;
/// The mortar side is rigid or prescribed (no equations): no rows and columns for it in the tangent.
pub const STICKSLIP_MORTAR_RIGID: i32 = 1;
/// The mortar side is rigid and in closed form, STICKSLIP_SHAPE_...: no facets, no search. Its stickslip_surface has
/// four nodes (of lines three), a frame that is fixed to it and that the host moves as a rigid body: see there.
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS) and weights of now (STICKSLIP_WEIGHTS_CURRENT);
/// offsets of the mortar nodes; offsets that follow from a shape.
pub const STICKSLIP_MORTAR_ANALYTIC: i32 = 2;
/// A plane; of lines a straight line. Default.
pub const STICKSLIP_SHAPE_PLANE: i32 = 0;
/// A sphere; of lines a circle.
pub const STICKSLIP_SHAPE_SPHERE: i32 = 1;
/// A circular cylinder without ends; of lines a circle.
pub const STICKSLIP_SHAPE_CYLINDER: i32 = 2;

/// What an interface models; `stickslip_options_init` writes the defaults.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_options {
    /// sizeof(stickslip_options), as `stickslip_options_init` sets it.
    pub struct_size: u64,
    /// How it is computed; NULL (default): as the library chooses. Read during the call alone.
    pub method: *const stickslip_method,
    /// STICKSLIP_FRICTION_...
    pub friction: i32,
    /// STICKSLIP_MORTAR_...
    pub mortar_side: i32,
    /// STICKSLIP_SHAPE_... with STICKSLIP_MORTAR_ANALYTIC, else 0.
    pub shape: i32,
    /// STICKSLIP_MODEL_...: whether facets are of a model in space, or lines of a plane or axisymmetric one. With lines every array of
    /// vectors of this interface has two components a node in place of three: positions, forces, multipliers, normals,
    /// directions; so have equations. The frame of an analytic mortar side has three points. What
    /// lines do not go with: docs/compose.md.
    pub model: i32,
    /// 1: displacements are small against the facets: weights, normals and areas stay those of the first configuration, which saves
    /// work. 0 (default): as large as they like.
    pub small_displacements: i32,
    /// 0 (default, C) or 1 (Fortran): base of node numbers, equations, rows, columns and row offsets. Not of
    /// facet_offsets.
    pub index_base: i32,
    /// Coulomb coefficient of all nodes [-]; default 0, and 0 with FRICTION_NONE, _ROUGH and _TIED.
    pub mu: f64,
    /// With STICKSLIP_FRICTION_TRESCA the largest shear traction, > 0 [F/L^2]; else 0 (default).
    pub shear_limit: f64,
    /// Thickness of a plane model [L]; 0 (default): 1. 0 of other models.
    pub thickness: f64,
    /// With STICKSLIP_MORTAR_ANALYTIC [L]. Sphere, cylinder: > 0: a ball, a bar; < 0: a cavity, a bore, the body
    /// outside. Plane, and where there is no shape: 0.
    pub radius: f64,
    /// Young's modulus of the softer body [F/L^2]: rhat_A = 0.1 E / h_A, h_A = sqrt(M_A), of lines about their length; 0 (default): use the
    /// augmentation. With STICKSLIP_DECISION_POINTS it is needed, and is E* of both bodies together.
    pub modulus: f64,
    /// Facets farther apart than this along the normal at the last commit, gap or penetration, are no pair
    /// [L]. 0 (default): any gap, and a penetration of one facet (the smaller of the two) beyond what the curved
    /// surfaces lie off their facets, so that the far side of a body is not found; a fine mortar surface that dips into
    /// coarse non-mortar facets is followed down from where it enters them, by as much as a coarse facet is long. Give it
    /// where the surfaces start deeper in each other than a facet. Of a mortar surface in layers the nearest facets are pairs.
    pub search_distance: f64,
}

// SAFETY: repr(C), struct_size first, numbers and a pointer.
unsafe impl Sized64 for stickslip_options {
    const NAME: &'static str = "stickslip_options";
    const FIRST: usize = size_of::<stickslip_options>();
}

const DEFAULTS: stickslip_options = stickslip_options {
    struct_size: 0,
    method: std::ptr::null(),
    friction: STICKSLIP_FRICTION_COULOMB,
    mortar_side: STICKSLIP_MORTAR_DEFORMABLE,
    shape: STICKSLIP_SHAPE_PLANE,
    model: STICKSLIP_MODEL_SOLID,
    small_displacements: 0,
    index_base: 0,
    mu: 0.0,
    shear_limit: 0.0,
    thickness: 0.0,
    radius: 0.0,
    modulus: 0.0,
    search_distance: 0.0,
};

/// Writes the defaults into options: what docs/accuracy.md recommends, as the host's other choices allow. struct_size:
/// sizeof(stickslip_options) as the caller knows it; of an older caller's shorter struct only that much is written, the tail of
/// a newer caller's longer one is zeroed.
///
/// Errors: NULL_POINTER, STRUCT_SIZE.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_options_init(options: *mut stickslip_options, struct_size: u64) -> i32 {
    guard(|| sized::initialise(options, struct_size, stickslip_options { struct_size, ..DEFAULTS }, "options"))
}

/// Sets `method` of options to that of the paper's element: standard multipliers, normals of the last commit, and weights of now unless displacements are small. It is the
/// library's and stays; to change a member of it, copy it.
///
/// options: in and out, after `stickslip_options_init`.
///
/// Errors: NULL_POINTER, STRUCT_SIZE.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_options_paper(options: *mut stickslip_options) -> i32 {
    guard(|| {
        raw::check(options, "options")?;
        let paper = stickslip_options { method: &raw const PAPER, ..sized::read(options)? };
        sized::write(options, paper);
        Ok(())
    })
}

/// The method of an interface with these options: with the weights, the basis and the normals that the library chooses where options
/// leave them. `stickslip_interface_effects` says it of a handle in words.
///
/// options: complete but for the stiffness. method, output; may be `options->method` itself.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_VALUE, NOT_FINITE.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_options_method(
    options: *const stickslip_options,
    method: *mut stickslip_method,
) -> i32 {
    guard(|| {
        raw::check(options, "options")?;
        sized::check_output(method)?;
        let given = sized::read(options)?;
        let asked = read_method(given.method)?;
        let friction = law(given.friction, "options.friction")?;
        let what = Modelled { modulus: 1.0, small_displacements: given.is_small()? };
        let settled = asked.put(Options { friction, ..Options::paper(Stiffness::Modulus(1.0)) }, what)?;
        sized::write(method, asked.settled(&settled));
        Ok(())
    })
}

/// The law of a STICKSLIP_FRICTION_... value.
pub(super) fn law(value: i32, name: &str) -> Result<Friction> {
    let row = usize::try_from(value).ok().and_then(|k| LAWS.get(k));
    row.map(|row| row.friction).ok_or_else(|| unnamed(value, name, LAWS.len() as i32))
}

/// Refuses numbers of other laws, and a law without its own.
pub(super) fn law_numbers(friction: Friction, mu: f64, shear_limit: f64, of: &str) -> Result<()> {
    let refuse = |text: Text| Err(Error::new(Kind::InvalidValue, text));
    let law = friction.law();
    if law.mu != Coefficient::Given && mu != 0.0 {
        return refuse(text!(
            "{of}.mu is {mu}; it must be 0 where {of}.friction is not Coulomb's, with a limit or without"
        ));
    }
    match law.refuses(given_limit(shear_limit)) {
        None => Ok(()),
        Some(allowed) => refuse(text!("{of}.shear_limit is {shear_limit}; it must be {allowed}")),
    }
}

/// 0 stands for no limit.
fn given_limit(shear_limit: f64) -> Option<f64> {
    (shear_limit != 0.0).then_some(shear_limit)
}

/// What an interface is created with.
pub(super) struct Choices {
    /// The core's options.
    pub options: Options,
    /// The index base.
    pub base: i64,
    /// The shape of an analytic mortar side.
    pub shape: Option<AnalyticShape>,
    /// rho of lines; `None`: a model in space.
    pub measure: Option<Measure>,
}

/// The shape; with `lines` as it is seen in their plane.
fn read_shape(analytic: bool, lines: bool, shape: i32, radius: f64) -> Result<Option<AnalyticShape>> {
    let refuse = |text: Text| Err(Error::new(Kind::InvalidValue, text));
    if !analytic {
        return match (shape, radius) {
            (0, 0.0) => Ok(None),
            _ => refuse(text!(
                "options.shape is {shape} and options.radius {radius}; both must be 0 where options.mortar_side is not STICKSLIP_MORTAR_ANALYTIC"
            )),
        };
    }
    let shapes = [AnalyticShape::Plane, AnalyticShape::Sphere(radius), AnalyticShape::Cylinder(radius)];
    let shape = choose(shape, "options.shape", &shapes, 3)?;
    match (shape, radius == 0.0) {
        (AnalyticShape::Plane, false) => refuse(text!("options.radius is {radius}; it must be 0 of a plane")),
        (AnalyticShape::Sphere(_) | AnalyticShape::Cylinder(_), true) => {
            refuse("options.radius is 0; it must be positive (a ball, a bar) or negative (a cavity, a bore)".into())
        }
        _ if lines => {
            Ok(Some(if shape == AnalyticShape::Plane { AnalyticShape::Line } else { AnalyticShape::Circle(radius) }))
        }
        _ => Ok(Some(shape)),
    }
}

impl stickslip_options {
    fn is_small(&self) -> Result<bool> {
        choose(self.small_displacements, "options.small_displacements", &[false, true], 2)
    }
}

/// The options, checked.
pub(super) fn read_options(p: *const stickslip_options) -> Result<Choices> {
    let given = sized::read(p)?;
    // Every member by name: a new one does not compile until it is handled.
    let stickslip_options {
        struct_size: _,
        method,
        friction,
        mortar_side,
        shape,
        model,
        small_displacements: _,
        index_base,
        mu,
        shear_limit,
        thickness,
        radius,
        modulus,
        search_distance,
    } = given;
    let friction = law(friction, "options.friction")?;
    let sides = [MortarSide::Deformable, MortarSide::Rigid, MortarSide::Rigid];
    let analytic = mortar_side == STICKSLIP_MORTAR_ANALYTIC;
    let mortar_side = choose(mortar_side, "options.mortar_side", &sides, 3)?;
    let numbers = [
        ("mu", mu),
        ("modulus", modulus),
        ("search_distance", search_distance),
        ("radius", radius),
        ("shear_limit", shear_limit),
    ];
    for (name, v) in numbers {
        if !v.is_finite() {
            return Err(Error::new(Kind::NotFinite, text!("options.{name} is {v}; it must be finite")));
        }
    }
    law_numbers(friction, mu, shear_limit, "options")?;
    if modulus < 0.0 {
        return Err(Error::new(Kind::InvalidValue, text!("options.modulus is {modulus}; it must not be negative")));
    }
    let method = read_method(method)?;
    let stiffness = method.stiffness(modulus)?;
    let measure = measure(read_model(model, "options.model")?, thickness, "options.thickness")?;
    let options = Options {
        friction,
        mortar_side,
        mu,
        shear_limit: given_limit(shear_limit),
        search_distance: (search_distance != 0.0).then_some(search_distance),
        ..Options::paper(stiffness)
    };
    let options = method.put(options, Modelled { modulus, small_displacements: given.is_small()? })?;
    options.validate()?;
    let base = choose(index_base, "options.index_base", &[0, 1], 2)?;
    Ok(Choices { options, base, shape: read_shape(analytic, measure.is_some(), shape, radius)?, measure })
}
