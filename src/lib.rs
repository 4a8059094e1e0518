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
//! | A, B / C | nodes of the non-mortar side (has the multipliers) / of the mortar side | |
//! | n_AB, n_AC (13) | [`mortar::PairWeights`] `ab`, `ac` | L^2 |
//! | g_A (11) | weighted gap; g_N = nu . g_A > 0 is open | L^3 |
//! | nu_A | averaged normal of t_n, pointing INTO the non-mortar body | |
//! | lambda_A (7) | multiplier: minus the Cauchy traction on the non-mortar body; lambda . nu <= 0 is compression |
//! F/L^2 |
//! | r_A | augmentation; the answer does not depend on it | F/L^5 |
//! | sigma, p (22), (24) | augmented and projected traction, [`law`] | F/L^2 |
//! | M_A, m_A | full and covered area of a node | L^2 |
//!
//! # Modules, lowest first
//!
//! [`error`]; [`features`], what a build may lack; [`memory`]; [`simd`]; [`adjacency`], [`shape`], [`quadrature`], [`geometry`], [`normal`] know nothing of contact;
//! [`mortar`] integrates a pair and knows no law, [`line`](mod@line) one of a plane model, [`dual`] changes the basis of a facet's multipliers; [`law`] is nodal
//! and knows no geometry; they meet in [`element`]; [`interface`] searches, assembles and remembers; [`rigid`] puts the
//! nodes of rigid bodies together; [`capi`] is the C
//! ABI, the only place that touches raw pointers.
//!
//! # Example
//!
//! A facet of 1 x 1 that has sunk 0.001 into a larger one below it:
//!
//! ```
//! use stickslip::geometry::Vec3;
//! use stickslip::interface::{Interface, NO_EQUATION, Options, Stiffness, Surface};
//!
//! # fn main() -> Result<(), stickslip::error::Error> {
//! // Right-hand order, normals out of each body.
//! let x1: Vec<_> = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)].map(|(x, y)| Vec3::new(x, y, -1e-3)).into();
//! let x2: Vec<_> = [(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).into();
//! let facets = [vec![0, 1, 2, 3]];
//! // Equation numbers of the host: 0 to 11 for the positions of the upper facet, 12 to 23 for its multipliers.
//! let equations = |first: i64| (0..4).map(|a| [0, 1, 2].map(|i| first + 3 * a + i)).collect::<Vec<_>>();
//! let upper = Surface::new("nonmortar", x1.clone(), &facets, equations(0))?;
//! let lower = Surface::new("mortar", x2.clone(), &facets, vec![[NO_EQUATION; 3]; 4])?;
//! let mut options = Options::new(Stiffness::Modulus(1000.0)); // of the softer body
//! options.mu = 0.3;
//! let mut contact = Interface::new(upper, lower, equations(12), options)?;
//!
//! let lambda = contact.initial_multipliers()?; // once; then an unknown of the host's Newton
//! let residual = contact.residual(&x1, &x2, &lambda, None)?;
//! assert!((residual.rows[0].z + 0.05).abs() < 1e-14); // r_A M_A g_N, a force
//! let mut entries = 0; // a host adds (row, column, value) to its matrix
//! contact.tangent(&x1, &x2, &lambda, None, &mut |_row: i64, _column: i64, _value: f64| entries += 1)?;
//! assert_eq!(entries, 372);
//! contact.commit(&x1, &x2, &lambda, None)?; // after each converged step
//! # Ok(())
//! # }
//! ```

#![warn(missing_docs)]

#[macro_use]
pub mod error; // first, for its macro

pub mod adjacency;
pub mod capi;
pub mod dual;
pub mod element;
pub mod features;
pub mod geometry;
pub mod interface;
pub mod law;
pub mod line;
pub mod memory;
pub mod mortar;
pub mod normal;
pub mod points;
pub mod quadrature;
pub mod rigid;
pub mod shape;
pub mod simd;
pub mod skin;
mod threads;
