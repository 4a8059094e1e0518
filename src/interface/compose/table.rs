//! Which features do not go with each other. What no row names goes: to build it is to delete its row.

use super::feature::{Feature, Features, line};

/// Why features do not go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// By what they mean.
    Meaningless,
    /// By what this version has.
    NotBuilt,
}

/// Most features of a row.
const MOST: usize = 4;

/// Some features in their order.
#[derive(Clone, Copy, Debug)]
pub struct List {
    all: [Feature; MOST],
    len: u8,
}

impl List {
    const fn of(features: &[Feature]) -> List {
        let (mut all, mut k) = ([Feature::Lines; MOST], 0);
        while k < features.len() {
            all[k] = features[k];
            k += 1;
        }
        List { all, len: k as u8 }
    }

    /// One after the other.
    pub const fn as_slice(&self) -> &[Feature] {
        self.all.split_at(self.len as usize).0
    }
}

/// Features that do not go together, and what a host is told. It has no pointers: a shared library would have to set each of them
/// when it is loaded.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The features, in the order in which a refusal names them.
    pub features: List,
    /// Of what kind the refusal is.
    pub verdict: Verdict,
    /// The ways out: without which of the features, each as its own row of the features says.
    pub without: List,
    /// Its place in the table.
    place: u8,
}

impl Row {
    /// The features at once.
    pub const fn all(&self) -> Features {
        Features::of(self.features.as_slice())
    }

    /// Why; empty where nothing is to be said but that it is not built.
    pub fn why(&self) -> &'static str {
        line(WHYS, self.place as usize)
    }
}

/// The rows: verdict, features in the order in which a refusal names them, why, the ways out.
macro_rules! rows {
    ($($verdict:ident [$($feature:ident)+] $why:literal [$($without:ident)*];)*) => {
        /// Why, a line for each row.
        const WHYS: &str = concat!($($why, "\n"),*);

        /// The table. Of several rows that an interface meets, the first one is told.
        pub static ROWS: [Row; [$($why),*].len()] = numbered([$(Row {
            features: List::of(&[$(Feature::$feature),+]),
            verdict: Verdict::$verdict,
            without: List::of(&[$(Feature::$without),*]),
            place: 0,
        }),*]);
    };
}

const fn numbered<const N: usize>(mut rows: [Row; N]) -> [Row; N] {
    assert!(N <= u8::MAX as usize + 1, "a row's place is a byte");
    let mut k = 0;
    while k < N {
        rows[k].place = k as u8;
        k += 1;
    }
    rows
}

rows! {
    // Options.
    Meaningless [NormalsNow FrozenWeights] "gaps and normals would be of different configurations" [FrozenWeights NormalsNow];
    Meaningless [Points Tied] "there is nothing to decide" [Points];
    NotBuilt [Points Friction WeightsNow] "points remember a traction, and are the same within a step with frozen weights alone" [WeightsNow Points];
    Meaningless [Points Friction PaperSlip] "points remember what slipped before, and need the slip of a step" [PaperSlip];
    Meaningless [Points StandardBasis] "gaps of points are measured by dual functions" [StandardBasis];
    Meaningless [Points Augmented] "forces of points follow sigma in either form" [Augmented];
    NotBuilt [Points ElementPoints] "" [ElementPoints];
    Meaningless [Points Carried] "no node has to be carried" [Carried];
    Meaningless [PaperSlip Conserving] "slip is that of the weights half way" [PaperSlip];
    NotBuilt [Points Conserving] "gaps of points are no functions of the nodes' places alone" [Conserving Points];
    NotBuilt [Augmented Conserving] "forces follow the multipliers alone" [Augmented];
    NotBuilt [ElementPoints Conserving] "a gap jumps where a point leaves a facet" [ElementPoints];
    NotBuilt [Carried Conserving] "who carries whom changes at a commit, and gaps with it" [Carried];
    // Surfaces.
    NotBuilt [ElementPoints Quadratic] "they are integrated over overlaps" [ElementPoints];
    NotBuilt [ElementPoints Lines] "they are integrated over overlaps" [ElementPoints];
    Meaningless [FrozenNormals Lines] "it compares with codes of facets in space" [FrozenNormals];
    Meaningless [DualBasis AllNodes NodesDecide] "their areas would not be positive" [AllNodes DualBasis NodesDecide];
    NotBuilt [Points Analytic WeightsNow] "what is closed of a facet is not differentiated against a shape" [WeightsNow Points];
    NotBuilt [Points MidNodes WeightsNow] "what is closed of a facet with mid nodes is not differentiated" [WeightsNow Points];
    NotBuilt [MovingFrame Conserving] "its own work is not counted" [MovingFrame Conserving];
    // What is set.
    Meaningless [HostNormals Conserving] "gaps would be no functions of the places" [HostNormals Conserving];
    Meaningless [HostNormals NormalsNow] "they would not follow the motion" [NormalsNow HostNormals];
    NotBuilt [OwnLaw Points] "it is asked at nodes" [Points];
    NotBuilt [LayerSlips Points] "it is asked at nodes" [LayerSlips Points];
    Meaningless [Layer Tied] "tied surfaces neither open nor slip, nor give way" [Layer Tied];
    Meaningless [LayerSlips PaperSlip] "it follows slip, which that measure makes of curved surfaces at rest" [PaperSlip];
    Meaningless [Orthotropic Lines] "a plane or axisymmetric model has one direction to slip in" [Orthotropic];
    Meaningless [MortarOffsets Analytic] "it has no nodes; move or resize the shape" [MortarOffsets];
    NotBuilt [Offsets Conserving] "" [Conserving];
    NotBuilt [Layer Conserving] "" [Conserving];
    NotBuilt [Shared Conserving] "forces follow the gaps of all handles" [Shared];
    NotBuilt [Points Shared] "tractions of a facet need the gaps of all of its nodes" [Points];
    NotBuilt [NodeHistory Points Friction] "what points remember is not in it" [NodeHistory];
    // What is asked.
    Meaningless [Condensed StandardBasis] "their forces couple neighbours" [StandardBasis];
    Meaningless [Condensed Points] "a facet's mass matrix couples its multipliers" [Condensed Points];
    Meaningless [Condensed Augmented] "its forces do not determine the multipliers of open nodes" [Augmented];
    Meaningless [Condensed Shared] "one handle must know all facets around a node whose multiplier it eliminates" [Shared];
    NotBuilt [Condensed Elsewhere Quadratic] "several multipliers act on a node in the middle, and one handle must have them all" [Condensed];
    NotBuilt [Condensed Elsewhere Lines] "several multipliers act on a node in the middle, and one handle must have them all" [Condensed];
    Meaningless [Condensed Conserving] "their forces couple neighbours" [Condensed Conserving];
    Meaningless [InPlace Elsewhere] "a row of it belongs to one handle" [InPlace];
    Meaningless [Sums DualBasis] "a dual basis depends on all pairs of a facet, which are known within one handle only" [DualBasis];
    Meaningless [Sums Carried] "weakly covered nodes are carried within one handle only" [Carried];
    NotBuilt [Sums Conserving] "forces follow the gaps of all handles" [Conserving];
    Meaningless [SumsTangent Augmented] "it couples pairs of different handles" [Augmented];
    NotBuilt [HeatMotion Points] "pressures are of points" [HeatMotion Points];
    NotBuilt [HeatMotion Conserving] "they follow the positions of t_n, too" [HeatMotion Conserving];
    Meaningless [Derivatives FrozenTangent] "adjoints solve with the exact tangent" [FrozenTangent];
    Meaningless [Derivatives FrozenNormals] "adjoints solve with the exact tangent" [FrozenNormals];
    NotBuilt [Derivatives Augmented] "forces follow the positions of t_n, too" [Augmented];
    NotBuilt [Derivatives WeightsCommitted] "forces follow the positions of t_n, too" [WeightsCommitted];
    NotBuilt [Derivatives Conserving] "forces follow the positions of t_n, too" [Conserving];
    NotBuilt [Derivatives Points] "points remember tractions" [Points];
    NotBuilt [Derivatives OwnLaw] "what it remembers is the host's" [OwnLaw];
    NotBuilt [Derivatives Layer] "what it remembers, and covered areas, follow the positions of t_n" [Layer];
    NotBuilt [Derivatives Orthotropic] "its axes follow the positions of all steps" [Orthotropic];
    NotBuilt [Derivatives Shared] "a row is of the gaps of all handles" [Shared];
    Meaningless [ShapeOffsets Analytic] "it is one" [];
    Meaningless [ShapeOffsets MidNodes] "they follow a shape by themselves; put these nodes on it" [];
}
