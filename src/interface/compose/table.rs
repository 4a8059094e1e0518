//! Which features do not go with each other. What no row names goes: to build it is to delete its row.

use super::feature::Feature::{self, *};
use super::feature::Features;

/// Why features do not go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// By what they mean.
    Meaningless,
    /// By what this version has.
    NotBuilt,
}

/// Features that do not go together, and what a host is told.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The features, in the order in which a refusal names them.
    pub features: &'static [Feature],
    /// Of what kind the refusal is.
    pub verdict: Verdict,
    /// Why; empty where nothing is to be said but that it is not built.
    pub why: &'static str,
    /// The ways out: without which of the features, each as its own row of the features says.
    pub without: &'static [Feature],
}

impl Row {
    /// The features at once.
    pub const fn all(&self) -> Features {
        Features::of(self.features)
    }
}

const fn meaningless(features: &'static [Feature], why: &'static str, without: &'static [Feature]) -> Row {
    Row { features, verdict: Verdict::Meaningless, why, without }
}

const fn not_built(features: &'static [Feature], why: &'static str, without: &'static [Feature]) -> Row {
    Row { features, verdict: Verdict::NotBuilt, why, without }
}

/// The table. Of several rows that an interface meets, the first one is told.
pub const ROWS: &[Row] = &[
    // Options.
    meaningless(
        &[NormalsNow, FrozenWeights],
        "gaps and normals would be of different configurations",
        &[FrozenWeights, NormalsNow],
    ),
    meaningless(&[PaperSlip, KeptOverlaps], "the work of friction would not be that of its slip", &[PaperSlip]),
    meaningless(&[Points, Tied], "there is nothing to decide", &[Points]),
    not_built(&[Points, OtherLaw], "", &[OtherLaw, Points]),
    not_built(
        &[Points, Friction, WeightsNow],
        "points remember a traction, and are the same within a step with frozen weights alone",
        &[WeightsNow, Points],
    ),
    meaningless(
        &[Points, Friction, PaperSlip],
        "points remember what slipped before, and need the slip of a step",
        &[PaperSlip],
    ),
    meaningless(&[Points, StandardBasis], "gaps of points are measured by dual functions", &[StandardBasis]),
    not_built(&[Points, KeptOverlaps], "overlaps are kept node by node", &[KeptOverlaps, Points]),
    not_built(&[Points, NormalsNow], "", &[NormalsNow, Points]),
    not_built(&[Points, Augmented], "", &[Augmented, Points]),
    not_built(&[Points, ElementPoints], "", &[ElementPoints]),
    meaningless(&[Points, Carried], "no node has to be carried", &[Carried]),
    // Surfaces.
    not_built(&[MovingFrame, Quadratic], "", &[MovingFrame]),
    not_built(&[MovingFrame, Lines], "", &[MovingFrame]),
    not_built(&[MovingFrame, Augmented], "", &[MovingFrame, Augmented]),
    not_built(&[MovingFrame, DualBasis], "", &[MovingFrame, DualBasis]),
    not_built(&[MovingFrame, Carried], "", &[MovingFrame, Carried]),
    not_built(&[MovingFrame, Tied], "", &[MovingFrame]),
    not_built(&[ElementPoints, Quadratic], "they are integrated over overlaps", &[ElementPoints]),
    not_built(&[ElementPoints, Lines], "they are integrated over overlaps", &[ElementPoints]),
    not_built(&[Augmented, Quadratic], "", &[Augmented]),
    not_built(&[Augmented, Lines], "", &[Augmented]),
    not_built(&[NormalsNow, Quadratic], "", &[NormalsNow]),
    not_built(&[NormalsNow, Lines], "", &[NormalsNow]),
    meaningless(&[FrozenNormals, Lines], "it compares with codes of facets in space", &[FrozenNormals]),
    meaningless(&[DualBasis, AllNodes], "their areas would not be positive", &[AllNodes, DualBasis]),
    not_built(&[Points, Analytic], "", &[Points]),
    not_built(&[Points, MidNodes], "", &[Points, MidNodes]),
    // What is set.
    meaningless(&[HostNormals, NormalsNow], "they would not follow the motion", &[NormalsNow, HostNormals]),
    not_built(&[OwnLaw, Points], "it is asked at nodes", &[Points]),
    not_built(
        &[Orthotropic, NormalsNow],
        "how its axes turn with a normal of now is not in the tangent",
        &[NormalsNow],
    ),
    meaningless(&[Orthotropic, Lines], "a plane or axisymmetric model has one direction to slip in", &[Orthotropic]),
    meaningless(&[MortarOffsets, Analytic], "it has no nodes; move or resize the shape", &[MortarOffsets]),
    not_built(
        &[Offsets, Points, WeightsNow],
        "what they add to the gaps of points is not in the tangent",
        &[WeightsNow, Points],
    ),
    not_built(
        &[Offsets, NormalsNow, Carried, ThreeMultipliers],
        "how the offset of a carried node turns is not in the tangent",
        &[Carried, NormalsNow, ThreeMultipliers],
    ),
    not_built(
        &[Offsets, KeptOverlaps],
        "what they overlap by at the last commit would count as closed, and one that grows would press nothing",
        &[KeptOverlaps],
    ),
    not_built(&[Points, Elsewhere], "tractions of a facet need the gaps of all of its nodes", &[Points]),
    not_built(&[Points, Shared], "tractions of a facet need the gaps of all of its nodes", &[Points]),
    not_built(&[NodeHistory, Points, Friction], "what points remember is not in it", &[NodeHistory]),
    // What is asked.
    meaningless(&[Condensed, StandardBasis], "their forces couple neighbours", &[StandardBasis]),
    meaningless(&[Condensed, Points], "a facet's mass matrix couples its multipliers", &[Condensed, Points]),
    meaningless(&[Condensed, Augmented], "its forces do not determine the multipliers of open nodes", &[Augmented]),
    meaningless(
        &[Condensed, Shared],
        "one handle must know all facets around a node whose multiplier it eliminates",
        &[Shared],
    ),
    not_built(
        &[Condensed, Elsewhere, Quadratic],
        "several multipliers act on a node in the middle, and one handle must have them all",
        &[Condensed],
    ),
    not_built(
        &[Condensed, Elsewhere, Lines],
        "several multipliers act on a node in the middle, and one handle must have them all",
        &[Condensed],
    ),
    meaningless(&[InPlace, Elsewhere], "a row of it belongs to one handle", &[InPlace]),
    meaningless(
        &[Sums, DualBasis],
        "a dual basis depends on all pairs of a facet, which are known within one handle only",
        &[DualBasis],
    ),
    meaningless(&[Sums, Carried], "weakly covered nodes are carried within one handle only", &[Carried]),
    meaningless(&[SumsTangent, Augmented], "it couples pairs of different handles", &[Augmented]),
    not_built(&[Heat, Analytic], "it has no nodes and no temperatures", &[Analytic]),
    not_built(&[Heat, Points], "pressures are of points", &[Points]),
    not_built(&[HeatMotion, NormalsNow], "how the normals turn is not in them", &[NormalsNow, HeatMotion]),
    meaningless(&[ShapeOffsets, Analytic], "it is one", &[]),
    meaningless(&[ShapeOffsets, MidNodes], "they follow a shape by themselves; put these nodes on it", &[]),
];
