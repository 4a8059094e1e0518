//! Features of an interface: what a host can choose, give or ask for, as far as one may not go with another. Whether an interface
//! has one is a predicate on its data: `Options::features`, `Setup::features`.

/// A feature: what it is called in refusals, and how a host does without.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct About {
    /// The feature.
    pub feature: Feature,
    /// In refusals and in the matrix.
    pub name: &'static str,
    /// The way out; empty: a host that has it cannot do without.
    pub without: &'static str,
}

/// The features, one a row: name in the code, name in refusals, how to do without.
macro_rules! features {
    ($($feature:ident $name:literal $without:literal;)*) => {
        /// A feature.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[repr(u8)]
        pub enum Feature {
            $(#[doc = $name] $feature,)*
        }

        /// All of them, in the order of their numbers.
        pub const FEATURES: &[About] = &[
            $(About { feature: Feature::$feature, name: $name, without: $without },)*
        ];

        /// Their names, a line for each: see [`super::Row`] for why this is no table of strings.
        const NAMES: &str = concat!($($name, "\n"),*);

        /// How to do without, likewise.
        const WITHOUT: &str = concat!($($without, "\n"),*);
    };
}

features! {
    Lines "lines" "";
    Quadratic "quadratic facets" "";
    MidNodes "facets with mid nodes" "mesh with linear facets";
    StandardBasis "standard multipliers (STICKSLIP_BASIS_STANDARD)" "take STICKSLIP_BASIS_DUAL";
    DualBasis "dual multipliers (STICKSLIP_BASIS_DUAL)" "take STICKSLIP_BASIS_STANDARD";
    AllNodes "multipliers at all nodes of quadratic facets or lines (STICKSLIP_SPACE_SUB)" "take STICKSLIP_SPACE_CORNER";
    Augmented "the augmented form (STICKSLIP_FORM_AUGMENTED)" "take STICKSLIP_FORM_MULTIPLIER";
    NormalsNow "normals of now (STICKSLIP_NORMALS_CURRENT)" "take STICKSLIP_NORMALS_COMMITTED";
    HostNormals "normals of the host" "leave them to the library";
    WeightsNow "weights of now (STICKSLIP_WEIGHTS_CURRENT)" "take STICKSLIP_WEIGHTS_COMMITTED or STICKSLIP_WEIGHTS_REFERENCE";
    FrozenWeights "frozen weights" "take STICKSLIP_WEIGHTS_CURRENT";
    Conserving "conserving weights (STICKSLIP_WEIGHTS_CONSERVING)" "take other weights";
    PaperSlip "the paper's slip measure (STICKSLIP_SLIP_PAPER)" "take STICKSLIP_SLIP_OBJECTIVE or STICKSLIP_SLIP_INCREMENT";
    Friction "friction" "take STICKSLIP_FRICTION_NONE";
    Tied "tied surfaces (STICKSLIP_FRICTION_TIED)" "take another law";
    Layer "a layer between the surfaces (stickslip_interface_set_layer)" "leave it out";
    LayerSlips "wear or a bond (stickslip_layer)" "give the overclosure alone";
    OwnLaw "a law of one's own" "leave Coulomb's";
    Orthotropic "orthotropic friction" "give one mu";
    Points "points that decide (STICKSLIP_DECISION_POINTS)" "take STICKSLIP_DECISION_NODES";
    NodesDecide "nodes that decide (STICKSLIP_DECISION_NODES)" "take STICKSLIP_DECISION_POINTS";
    ElementPoints "points that stand for overlaps (method.element_points)" "take STICKSLIP_INTEGRATION_SEGMENTS";
    FrozenTangent "the tangent with frozen weights (STICKSLIP_TANGENT_FROZEN_WEIGHTS)" "take the exact tangent";
    FrozenNormals "the tangent with frozen normals (STICKSLIP_TANGENT_FROZEN_NORMALS)" "take the exact tangent";
    Carried "nodes that others carry (weak_coverage > 0, the default of dual multipliers)" "give STICKSLIP_WEAK_COVERAGE_NONE";
    Analytic "an analytic mortar side" "mesh its surface";
    MovingFrame "an analytic mortar side whose frame has equations" "mesh its surface";
    Offsets "offsets" "";
    MortarOffsets "offsets of the mortar nodes" "give them to the non-mortar nodes";
    Elsewhere "parts of an interface (owned has STICKSLIP_NODE_ELSEWHERE)" "";
    Shared "nodes that handles share (owned has STICKSLIP_NODE_SHARED)" "give them to one handle, with all facets around them";
    Sums "sums of several handles" "";
    SumsTangent "the tangent by sums of several handles" "";
    Condensed "condensation" "keep multipliers as unknowns";
    InPlace "a matrix condensed in place" "take the pieces (stickslip_interface_condensed_coo), which add up over the handles";
    HeatMotion "derivatives of heat by displacements and multipliers" "solve for temperatures in turns with the mechanics";
    Derivatives "derivatives by positions of t_n and by parameters" "";
    WeightsCommitted "weights of the last commit (STICKSLIP_WEIGHTS_COMMITTED)" "take STICKSLIP_WEIGHTS_CURRENT";
    NodeHistory "a history of nodes (stickslip_interface_set_committed)" "import one of points (stickslip_interface_history_import)";
    ShapeOffsets "offsets that follow from a shape" "";
}

/// A line of a text, by its number.
pub fn line(text: &'static str, k: usize) -> &'static str {
    text.split('\n').nth(k).unwrap_or_default()
}

impl Feature {
    /// What it is called in refusals.
    pub fn name(self) -> &'static str {
        line(NAMES, self as usize)
    }

    /// How a host does without.
    pub fn without(self) -> &'static str {
        line(WITHOUT, self as usize)
    }
}

/// Features that are there at once: a bit for each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Features(u64);

impl Features {
    /// Of these.
    pub const fn of(features: &[Feature]) -> Features {
        let (mut bits, mut k) = (0, 0);
        while k < features.len() {
            bits |= 1 << features[k] as u8;
            k += 1;
        }
        Features(bits)
    }

    /// Those of the list that are there.
    #[inline(never)]
    pub fn which(list: &[(Feature, bool)]) -> Features {
        Features(list.iter().fold(0, |bits, (feature, is_there)| bits | u64::from(*is_there) << *feature as u8))
    }

    /// These and others.
    #[inline]
    pub const fn and(self, others: Features) -> Features {
        Features(self.0 | others.0)
    }

    /// Whether all of these are among them.
    #[inline]
    pub const fn have(self, all: Features) -> bool {
        self.0 & all.0 == all.0
    }
}
