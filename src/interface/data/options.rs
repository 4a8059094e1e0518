//! The choices of an interface, resolved once at creation.

use crate::error::{Error, Kind, Result};
use crate::features;
use crate::interface::compose::{self, Feature, Features};
pub use crate::law::Friction;
use crate::law::SlipMeasure;
use crate::mortar::MultiplierSpace;
use crate::points;
use crate::quadrature::{DEGREE_5, Rule};
use std::f64::consts::PI;

/// Which traction the forces use (design: same solutions, different sparsity).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Forces use lambda, the rows use the projection: the tangent is a sum of pairs and nodes.
    #[default]
    Multiplier,
    /// Forces use the projected traction (the paper's): couples all pairs of a node.
    Augmented,
}

/// Which configuration the weights belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weights {
    /// The current one, linearised: large sliding.
    Current,
    /// Frozen at the last commit.
    Committed,
    /// Frozen, with normals and areas, at the first configuration: small displacements.
    Reference,
    /// Of now, and gaps are functions of the places alone: contact takes exactly what they change by (docs/formulation 21).
    Conserving = 4,
}

/// Which configuration the normals nu belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normals {
    /// That of the last commit: data of a step, as in the paper.
    Committed,
    /// The current one, linearised (docs/formulation 11).
    Current,
}

/// How a pair's weights are integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Scheme {
    /// Over triangles of the overlap: exact on affine facets.
    #[default]
    Segments,
    /// Over the products of these Gauss points on the whole non-mortar facet, each where it falls on a mortar facet: no
    /// clipping, and no patch test.
    Elements(&'static [[f64; 2]]),
    /// As `Elements`, but over overlaps where a point or a corner of the non-mortar facet is uncovered.
    Hybrid(&'static [[f64; 2]]),
}

/// What the tangent knows of the weights of now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tangent {
    /// All.
    #[default]
    Exact,
    /// Nothing: the weights count as constants.
    FrozenWeights,
    /// Their derivatives, but for the tilt of the facets' planes. Of an analytic mortar side all.
    FrozenNormals,
}

/// Unit of the multiplier rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RowScale {
    /// Times r_A M_A: M_A (p_A - lambda_A), a force like the force rows.
    #[default]
    Force,
    /// As in the paper: L^3.
    None,
}

/// The functions that multiply the multipliers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MultiplierBasis {
    /// The shape functions, as in the paper.
    Standard,
    /// Biorthogonal to the shape functions over what is covered of a facet (docs/formulation 10).
    Dual,
}

/// Where it is decided what is closed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Decision {
    /// At nodes.
    #[default]
    Nodes,
    /// At the points of overlaps, with E* of both bodies together [F/L^2] (docs/formulation 16).
    Points(f64),
}

/// What a node does in the step in which it becomes covered: it has no slip history.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NewContact {
    /// It acts without friction for that one step; a stick row would be zero.
    #[default]
    Frictionless,
    /// It keeps its mu.
    KeepFriction,
}

/// What the mortar side does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MortarSide {
    /// It deforms; rigid all the same where none of its nodes has an equation.
    #[default]
    Deformable,
    /// It is rigid or prescribed: the tangent has no rows and columns for it.
    Rigid,
}

/// Work that is left out where the scene does not call for it. None of them changes the answer of surfaces that
/// face each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shortcuts {
    /// Coulomb with mu = 0 at every node: no slip is computed.
    pub frictionless: bool,
    /// A mortar side without equations: as [`MortarSide::Rigid`].
    pub rigid: bool,
    /// Surfaces whose boxes are farther apart than a facet: neither search nor integration.
    pub apart: bool,
    /// Nodes that nothing can cover before the next commit, and all of surfaces that are apart: no law.
    pub uncovered: bool,
}

impl Default for Shortcuts {
    fn default() -> Self {
        Shortcuts { frictionless: true, rigid: true, apart: true, uncovered: true }
    }
}

/// Where the augmentation comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stiffness {
    /// rhat [F/L^3], the same for all nodes.
    Augmentation(f64),
    /// Young's modulus E of the softer body [F/L^2]: rhat_A = 0.1 E / sqrt(M_A).
    Modulus(f64),
}

/// What a host asks for where the best choice follows from others; `None`: the library's choice, [`Options::settle`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Wishes {
    /// Standard or dual multipliers.
    pub basis: Option<MultiplierBasis>,
    /// Current or frozen weights.
    pub weights: Option<Weights>,
    /// Committed or current normals.
    pub normals: Option<Normals>,
}

/// All options of an interface.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Multiplier or augmented form.
    pub form: Form,
    /// Standard or dual multipliers.
    pub basis: MultiplierBasis,
    /// Nodes or points.
    pub decision: Decision,
    /// Where multipliers of quadratic facets stand.
    pub space: MultiplierSpace,
    /// Slip measure.
    pub slip: SlipMeasure,
    /// Current or frozen weights.
    pub weights: Weights,
    /// Committed or current normals.
    pub normals: Normals,
    /// Whether the library chose the normals: those of a host take their place.
    pub normals_yield: bool,
    /// Whether the weights are the library's choice, which yields to those of the last commit where an analytic surface takes no others.
    pub weights_yield: bool,
    /// Threads that an evaluation may use, at least 1.
    pub threads: usize,
    /// Quadrature of triangles, and against an analytic mortar side.
    pub rule: &'static Rule,
    /// Overlaps or points; nothing to choose against an analytic mortar side.
    pub scheme: Scheme,
    /// Exact or frozen; the answer is the same, Newton's path is not.
    pub tangent: Tangent,
    /// Scale of the multiplier rows.
    pub row_scale: RowScale,
    /// Newly covered nodes.
    pub new_contact: NewContact,
    /// What happens along the surface.
    pub friction: Friction,
    /// What the mortar side does.
    pub mortar_side: MortarSide,
    /// Whether the library may leave out work that the answer does not depend on.
    pub shortcuts: Shortcuts,
    /// Coulomb coefficient of all nodes, >= 0.
    pub mu: f64,
    /// The largest shear traction [F/L^2] of a law that has such a limit, else `None`.
    pub shear_limit: Option<f64>,
    /// Source of the augmentation.
    pub stiffness: Stiffness,
    /// Covered over full nodal area at and below which a node counts as uncovered.
    pub coverage_min: f64,
    /// A node covered less than this times its best covered neighbour at t_n has no multiplier of its own in the step:
    /// its covered neighbours carry it (`weak.rs`). [`NO_WEAK_COVERAGE`]: every covered node has one. 0: the library's
    /// choice, [`Options::effective_weak_coverage`].
    pub weak_coverage: f64,
    /// Facets farther apart than this along the normal at the last commit, gap or penetration, are no pair
    /// `[L]`. `None`: as far as the surfaces reach for a gap, one facet (the smaller of the two) for a
    /// penetration, so that the far side of a body is not found.
    pub search_distance: Option<f64>,
    /// How far a surface may turn from one commit to the next, in radians; pi: as far as it likes (`turn.rs`).
    pub turn_max: f64,
}

/// Default of [`Options::coverage_min`]: rounding of the covered area is 1e-15 of the facet's.
pub const COVERAGE_MIN: f64 = 1e-8;
/// rhat_A = this times E / sqrt(M_A) when a modulus is given. The answer does not depend on it.
pub const MODULUS_FACTOR: f64 = 0.1;

/// [`Options::weak_coverage`] for: every covered node has a multiplier of its own.
pub const NO_WEAK_COVERAGE: f64 = -1.0;
/// What dual multipliers take where the host says nothing. A facet that is covered at one end alone supports the node at the
/// other end by nothing, and its multiplier grows as the covered part goes (docs/formulation 10.5).
const WEAK_COVERAGE_OF_DUAL: f64 = 0.2;

/// Default of [`Options::turn_max`]: 20 degrees.
pub const TURN_MAX: f64 = PI / 9.0;

impl Options {
    /// The defaults with the given source of the augmentation.
    pub fn new(stiffness: Stiffness) -> Options {
        Options::paper(stiffness).settle(Wishes::default())
    }

    /// The paper's element: standard multipliers, weights of now, normals of the last commit.
    pub fn paper(stiffness: Stiffness) -> Options {
        Options {
            form: Form::default(),
            basis: MultiplierBasis::Standard,
            decision: Decision::default(),
            space: MultiplierSpace::Corner,
            slip: SlipMeasure::default(),
            weights: Weights::Current,
            normals: Normals::Committed,
            normals_yield: false,
            weights_yield: false,
            threads: 1,
            rule: &DEGREE_5,
            scheme: Scheme::default(),
            tangent: Tangent::default(),
            row_scale: RowScale::default(),
            new_contact: NewContact::default(),
            friction: Friction::default(),
            mortar_side: MortarSide::default(),
            shortcuts: Shortcuts::default(),
            mu: 0.0,
            shear_limit: None,
            stiffness,
            coverage_min: COVERAGE_MIN,
            weak_coverage: 0.0,
            search_distance: None,
            turn_max: TURN_MAX,
        }
    }

    /// With what is wished, and the best of the rest: dual multipliers, weights and normals of now, as far as they go with
    /// the other options. Where points decide, friction needs weights that stay within a step. With conserving weights dual multipliers, which
    /// are below 0 somewhere and are carried by none there, see overlaps that are none where a surface turns away.
    #[must_use]
    pub fn settle(self, wishes: Wishes) -> Options {
        let stays = self.decision != Decision::Nodes && self.friction != Friction::None;
        let weights = wishes.weights.unwrap_or(if stays { Weights::Committed } else { Weights::Current });
        let sub = self.space == MultiplierSpace::Sub && self.decision == Decision::Nodes;
        let standard = sub || weights == Weights::Conserving;
        let choice = if standard { MultiplierBasis::Standard } else { MultiplierBasis::Dual };
        let basis = wishes.basis.unwrap_or(choice);
        let yields = (wishes.normals.is_none(), wishes.weights.is_none());
        let settled = Options { weights, basis, normals_yield: yields.0, weights_yield: yields.1, ..self };
        Options { normals: wishes.normals.unwrap_or(settled.best_normals()), ..settled }
    }

    /// Those of now, unless the weights are frozen.
    fn best_normals(&self) -> Normals {
        let follows = matches!(self.weights, Weights::Current | Weights::Conserving);
        if follows { Normals::Current } else { Normals::Committed }
    }

    /// With normals of the host, or without: they take the place of those that the library chose.
    #[must_use]
    pub fn beside_normals(self, of_host: bool) -> Options {
        let normals = match (self.normals_yield, of_host) {
            (false, _) => self.normals,
            (true, true) => Normals::Committed,
            (true, false) => self.best_normals(),
        };
        Options { normals, ..self }
    }

    /// Opposite an analytic surface, or with mid nodes: points that decide take no weights of now there.
    #[must_use]
    pub fn with_held_points(self) -> Options {
        if !self.decides_at_points() || !self.weights_yield {
            return self;
        }
        let settled = Options { weights: Weights::Committed, ..self };
        settled.beside_normals(false)
    }

    /// Refuses numbers outside their range.
    pub fn validate(&self) -> Result<()> {
        let refuse = |name: &str, v: f64, allowed: &str| {
            Err(Error::new(Kind::InvalidValue, text!("{name} is {v}; it must be {allowed}")))
        };
        let (name, stiffness) = match self.stiffness {
            Stiffness::Augmentation(r) => ("method.augmentation", r),
            Stiffness::Modulus(e) => ("options.modulus", e),
        };
        if !(stiffness > 0.0 && stiffness.is_finite()) {
            return refuse(name, stiffness, "positive and finite");
        }
        if !(self.mu >= 0.0 && self.mu.is_finite()) {
            return refuse("options.mu", self.mu, "finite and not negative");
        }
        if let Some(allowed) = self.friction.law().refuses(self.shear_limit) {
            return refuse("options.shear_limit", self.shear_limit.unwrap_or(0.0), allowed);
        }
        if !(0.0..1.0).contains(&self.coverage_min) {
            return refuse("method.coverage_min", self.coverage_min, "at least 0 and below 1");
        }
        if !(0.0..=1.0).contains(&self.weak_coverage) && self.weak_coverage != NO_WEAK_COVERAGE {
            return refuse("method.weak_coverage", self.weak_coverage, "at least 0 and at most 1, or -1 for none");
        }
        if !(self.turn_max > 0.0 && self.turn_max <= PI) {
            return refuse("method.turn_max", self.turn_max, "positive and at most pi");
        }
        if self.decision != Decision::Nodes {
            features::needs!(POINTS);
        }
        match self.search_distance {
            Some(d) if !(d > 0.0 && d.is_finite()) => refuse("options.search_distance", d, "positive and finite"),
            _ => compose::refuse(self.features()),
        }
    }

    /// Whether points decide.
    #[inline]
    pub fn decides_at_points(&self) -> bool {
        features::POINTS.built && self.decision != Decision::Nodes
    }

    /// What is chosen here that does not go with everything.
    #[inline(never)]
    pub fn features(&self) -> Features {
        let (law, is_now) = (self.friction.law(), self.effective_weights() == Weights::Current);
        Features::which(&[
            (Feature::StandardBasis, self.basis == MultiplierBasis::Standard),
            (Feature::DualBasis, self.basis == MultiplierBasis::Dual),
            (Feature::Augmented, self.form == Form::Augmented),
            (Feature::NormalsNow, self.follows_normals()),
            (Feature::WeightsNow, is_now),
            (Feature::FrozenWeights, !is_now),
            (Feature::WeightsCommitted, self.effective_weights() == Weights::Committed),
            (Feature::Conserving, self.conserves()),
            (Feature::PaperSlip, self.slip == SlipMeasure::Paper),
            (Feature::Friction, law.opens && law.multipliers > 1),
            (Feature::Tied, !law.opens),
            (Feature::Points, self.decides_at_points()),
            (Feature::NodesDecide, !self.decides_at_points()),
            (Feature::ElementPoints, self.scheme != Scheme::Segments),
            (Feature::FrozenTangent, is_now && self.tangent == Tangent::FrozenWeights),
            (Feature::FrozenNormals, self.tangent == Tangent::FrozenNormals),
            (Feature::Carried, self.weak_coverage > 0.0 || self.effective_weak_coverage() > 0.0),
        ])
    }

    /// The weights in force: tied surfaces keep those of the reference configuration.
    pub fn effective_weights(&self) -> Weights {
        match self.weights {
            _ if !self.friction.law().opens => Weights::Reference,
            Weights::Conserving => Weights::Current,
            weights => weights,
        }
    }

    /// Whether gaps are functions of the places alone, whose discrete derivatives are the forces.
    pub fn conserves(&self) -> bool {
        self.weights == Weights::Conserving && self.friction.law().opens
    }

    /// Whether the normals follow the motion within a step. Tied surfaces use none.
    pub fn follows_normals(&self) -> bool {
        (self.normals == Normals::Current || self.conserves()) && self.friction.law().opens
    }

    /// Whether the tangent has the weights' derivatives.
    pub fn differentiates_weights(&self) -> bool {
        self.effective_weights() == Weights::Current && self.tangent != Tangent::FrozenWeights
    }

    /// The weak coverage in force; 0: no node is carried.
    pub fn effective_weak_coverage(&self) -> f64 {
        if self.decides_at_points() || self.conserves() {
            return 0.0;
        }
        match (self.weak_coverage, self.basis) {
            (NO_WEAK_COVERAGE, _) | (0.0, MultiplierBasis::Standard) => 0.0,
            (0.0, MultiplierBasis::Dual) => WEAK_COVERAGE_OF_DUAL,
            (part, _) => part,
        }
    }

    /// Whether copies of a node on a crease are told apart by what they have opposite. Dual gaps of all of them are that of the one
    /// point.
    pub fn tells_copies_apart(&self) -> bool {
        self.basis == MultiplierBasis::Dual && self.effective_weak_coverage() > 0.0
    }

    /// The slip measure in force: with frozen weights the objective one measures nothing (both its
    /// terms use the same weights), and the increment is what it stands for.
    pub fn effective_slip(&self) -> SlipMeasure {
        if self.conserves() {
            return SlipMeasure::Increment;
        }
        match (self.effective_weights(), self.slip) {
            (Weights::Committed | Weights::Reference, SlipMeasure::Objective) => SlipMeasure::Increment,
            (_, slip) => slip,
        }
    }

    /// rhat_A of a node of this size `[L]` (`Given::size`) [F/L^3].
    pub fn augmentation(&self, size: f64) -> f64 {
        match self.stiffness {
            Stiffness::Augmentation(r) => r,
            Stiffness::Modulus(e) if self.decides_at_points() => points::STIFFNESS * e / size,
            Stiffness::Modulus(e) => MODULUS_FACTOR * e / size,
        }
    }
}
