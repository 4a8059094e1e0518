//! What can be wrong with an input, and how it is said.
//!
//! Every refusal names the argument, what was found and what is allowed. A refusal changes nothing:
//! no output is written and no history moves. "No contact" is a state, not an error.

use std::ffi::CStr;
use std::fmt;

/// Result of every fallible routine of the crate.
pub type Result<T> = std::result::Result<T, Error>;

/// The kind of a refusal. The numbers are those of the C ABI: explicit, appended to, never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Kind {
    /// A required pointer is null.
    NullPointer = 1,
    /// A struct's `struct_size` is not one that this library knows.
    StructSize = 2,
    /// A count or length is not one of the allowed ones.
    InvalidSize = 3,
    /// A number is NaN or infinite.
    NotFinite = 4,
    /// An index points outside its array.
    IndexOutOfRange = 5,
    /// A facet names the same node twice.
    DuplicateNode = 6,
    /// A facet has no area, is folded or is not convex.
    DegenerateFacet = 7,
    /// A number or option is outside its allowed range.
    InvalidValue = 8,
    /// Neither an augmentation nor a modulus was given.
    MissingStiffness = 9,
    /// An option that is named but not available in this version.
    Unsupported = 10,
    /// The normals of the facets around a node cancel.
    UndefinedNormal = 11,
    /// A mortar facet's projection on a non-mortar facet's plane is not convex.
    ProjectionNotConvex = 12,
    /// The caller's buffer is too small.
    BufferTooSmall = 13,
    /// The caller's sparse matrix lacks an entry that the tangent needs.
    MissingEntry = 14,
    /// There is no commit to roll back.
    NothingToRollBack = 15,
    /// An imported history does not belong to this interface.
    HistoryMismatch = 16,
    /// Within the step the surfaces have turned by more than the normals of t_n allow.
    TurnedTooFar = 17,
    /// A commit would take pairs away from a closed node.
    ContactLost = 19,
}

/// All kinds with their short texts, in the order of their numbers.
pub const KINDS: [(Kind, &CStr); 18] = [
    (Kind::NullPointer, c"a required pointer is null"),
    (Kind::StructSize, c"a struct has an unknown size"),
    (Kind::InvalidSize, c"a count or length is not allowed"),
    (Kind::NotFinite, c"a number is NaN or infinite"),
    (Kind::IndexOutOfRange, c"an index is out of range"),
    (Kind::DuplicateNode, c"a facet names a node twice"),
    (Kind::DegenerateFacet, c"a facet has no area, is folded or is not convex"),
    (Kind::InvalidValue, c"a value is outside its allowed range"),
    (Kind::MissingStiffness, c"neither augmentation nor modulus given"),
    (Kind::Unsupported, c"not supported by this version"),
    (Kind::UndefinedNormal, c"the averaged normal of a node is undefined"),
    (Kind::ProjectionNotConvex, c"a mortar facet's projection is not convex"),
    (Kind::BufferTooSmall, c"a buffer is too small"),
    (Kind::MissingEntry, c"the matrix lacks an entry"),
    (Kind::NothingToRollBack, c"there is no commit to roll back"),
    (Kind::HistoryMismatch, c"the history belongs to another interface"),
    (Kind::TurnedTooFar, c"the surfaces turned too far within the step"),
    (Kind::ContactLost, c"the commit would take contact away"),
];

/// A refusal: its kind and a sentence that names the argument at fault.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    /// What kind of refusal this is.
    pub kind: Kind,
    /// Which argument, what was found, what is allowed.
    pub message: String,
}

impl Error {
    /// A refusal of the given kind.
    pub fn new(kind: Kind, message: impl Into<String>) -> Self {
        Error { kind, message: message.into() }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}
