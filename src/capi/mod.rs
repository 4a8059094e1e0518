//! The C ABI: converts, checks, calls the core, and nothing else. With `simd` the only place with `unsafe`.
//!
//! # Error handling
//! Every fallible function returns an int32 status: 0 is success; positive means the call was refused
//! and nothing was changed (no output written, no history moved); negative means that the library
//! itself is at fault and the handle is suspect. `stickslip_last_error_message` tells, for the calling
//! thread, which argument was wrong and what is allowed. No panic crosses the boundary; nothing is
//! printed. "No contact" is a state, not an error.
//!
//! # Threads
//! Stateless calls from any thread; distinct handles from any threads; one handle from one thread at a
//! time.
//!
//! # Compatibility
//! Every struct begins with its `struct_size`, set by the caller. Structs grow at the end only: a shorter one (an
//! older caller's) is taken as if its missing members were 0; a longer one (a newer caller's) is accepted when its
//! unknown tail is zero, and filled with zeros where it is an output. Numbers of statuses and options are appended to,
//! never reused. See `docs/abi.md`.
#![allow(unsafe_code)]
#![allow(non_camel_case_types)]
#![allow(rustdoc::broken_intra_doc_links)] // The header's units stand in brackets, [L^2].
#![allow(clippy::missing_safety_doc)] // One contract for all, in `raw.rs` and in the header's head.

// In the order in which the header introduces them; the empty lines keep it.
mod version;

mod status;

mod message;

mod method;
mod options;

mod surface;

mod preparation;

mod handle;

mod interface;

mod point;

mod evaluation;

mod tangent;

mod plan;

mod condensed;

mod closing;

mod history;

mod counters;

mod report;

mod diagnosis;

mod facet;

mod layout;

mod pair;
mod pair_in;
mod space;

mod model;

mod lines;
mod pair_state;
mod parents;

mod node;

mod normals;

mod dual;

mod facet_tangent;

mod equilibrium;

mod offsets;
mod rigid;

mod law;

mod layer;

mod heat;

mod sensitivity;

mod skin;

mod skin_steps;

mod choice;
mod fp_environment;
mod guard;
mod nodal;
mod pair_out;
mod raw;
mod sized;

pub use closing::*;
pub use condensed::*;
pub use counters::*;
pub use diagnosis::*;
pub use dual::*;
pub use equilibrium::*;
pub use evaluation::*;
pub use facet::*;
pub use facet_tangent::*;
pub use handle::*;
pub use heat::*;
pub use history::*;
pub use interface::*;
pub use law::*;
pub use layer::*;
pub use layout::*;
pub use message::*;
pub use method::*;
pub use model::*;
pub use node::*;
pub use normals::*;
pub use offsets::*;
pub use options::*;
pub use pair::*;
pub use pair_in::*;
pub use pair_state::*;
pub use plan::*;
pub use point::*;
pub use preparation::*;
pub use report::*;
pub use rigid::*;
pub use sensitivity::*;
pub use skin::*;
pub use skin_steps::*;
pub use space::*;
pub use status::*;
pub use surface::*;
pub use tangent::*;
pub use version::*;
