//! A facet kind: which cell it has, and which functions its fields have. The two are apart, as in other libraries of
//! elements; a kernel that needs some of them to be the same asks for it with one of the traits below, so that a kind of
//! which it is not true does not compile there.

use super::basis::Basis;
use super::cell::Cell;

/// A facet kind that kernels are compiled for.
pub trait FacetKind {
    /// The geometry.
    type Cell: Cell;
    /// The functions of the displacement: N_B on the non-mortar side, N_C on the mortar side.
    type Displacement: Basis;
    /// The functions of the multipliers, N_A; a mortar facet's are not asked for.
    type Multiplier: Basis;
}

/// The functions N^sigma of a kind's map.
pub type Map<K> = <<K as FacetKind>::Cell as Cell>::Map;

/// A kind whose displacement has the functions of its map: gradients of the map are those of N_B, along an edge N_B are
/// linear, its nodes are the corners.
pub trait Isoparametric: FacetKind<Displacement = Map<Self>> {}
impl<K: FacetKind<Displacement = Map<K>>> Isoparametric for K {}

/// A kind whose multipliers have the functions of its map: the same of N_A.
pub trait CornerMultipliers: FacetKind<Multiplier = Map<Self>> {}
impl<K: FacetKind<Multiplier = Map<K>>> CornerMultipliers for K {}

/// A kind whose multipliers have the functions of its displacement (standard multipliers, as in the paper): n_AB is
/// symmetric, and an integral of N_B is one of N_A.
pub trait StandardMultipliers: FacetKind<Multiplier = <Self as FacetKind>::Displacement> {}
impl<K: FacetKind<Multiplier = <K as FacetKind>::Displacement>> StandardMultipliers for K {}

/// A kind with one basis for all three.
pub trait SingleBasis: Isoparametric + CornerMultipliers + StandardMultipliers {}
impl<K: Isoparametric + CornerMultipliers + StandardMultipliers> SingleBasis for K {}
