//! Frictional mortar contact between two surfaces of a finite element model: the element of Cavalieri
//! and Cardona (augmented Lagrangian, exact Newton tangents), to be plugged into a host code.
//!
//! The host owns mesh, bulk elements, unknowns, linear solver and time; this crate owns what happens
//! between two surfaces. Hosts in C and Fortran use the C ABI (`include/stickslip.h`); this is the Rust
//! core below it.
//!
//! # Notation
//!
//! | symbol | here | unit |
//! |---|---|---|
//! | A, B / C | nodes of the non-mortar side (carries the multipliers) / of the mortar side | |
//! | n_AB, n_AC (13) | [`mortar::PairWeights`] `ab`, `ac` | L^2 |
//! | g_A (11) | weighted gap; g_N = nu . g_A > 0 is open | L^3 |
//! | nu_A | averaged normal of t_n, pointing INTO the non-mortar body | |
//! | lambda_A (7) | multiplier: minus the Cauchy traction on the non-mortar body; lambda . nu <= 0 is compression | F/L^2 |
//! | r_A | augmentation; the answer does not depend on it | F/L^5 |
//! | sigma, p (22), (24) | augmented and projected traction, [`law`] | F/L^2 |
//! | M_A, m_A | full and covered area of a node | L^2 |
//!
//! # Modules, lowest first
//!
//! [`error`]; [`shape`], [`quadrature`], [`geometry`], [`normal`] know nothing of contact; [`mortar`]
//! integrates a pair and knows no law; [`law`] is nodal and knows no geometry; they meet in
//! [`element`]; [`interface`] searches, assembles and remembers; [`capi`] is the C ABI, the only
//! place that touches raw pointers.

#![warn(missing_docs)]

pub mod capi;
pub mod element;
pub mod error;
pub mod geometry;
pub mod interface;
pub mod law;
pub mod mortar;
pub mod normal;
pub mod quadrature;
pub mod shape;
