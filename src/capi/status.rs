//! Status numbers.

/// Success.
pub const STICKSLIP_OK: i32 = 0;
/// A required pointer is null or misaligned.
pub const STICKSLIP_NULL_POINTER: i32 = 1;
/// A struct's struct_size is not one that this library knows.
pub const STICKSLIP_STRUCT_SIZE: i32 = 2;
/// A count or length is not allowed.
pub const STICKSLIP_INVALID_SIZE: i32 = 3;
/// A number is NaN or infinite.
pub const STICKSLIP_NOT_FINITE: i32 = 4;
/// An index is out of range.
pub const STICKSLIP_INDEX_OUT_OF_RANGE: i32 = 5;
/// A facet names a node twice.
pub const STICKSLIP_DUPLICATE_NODE: i32 = 6;
/// A facet has no area, is folded or is not convex.
pub const STICKSLIP_DEGENERATE_FACET: i32 = 7;
/// A number or option is outside its allowed range.
pub const STICKSLIP_INVALID_VALUE: i32 = 8;
/// Neither an augmentation nor a modulus was given.
pub const STICKSLIP_MISSING_STIFFNESS: i32 = 9;
/// An option that is named but not available in this version.
pub const STICKSLIP_UNSUPPORTED: i32 = 10;
/// The normals of the facets around a node cancel.
pub const STICKSLIP_UNDEFINED_NORMAL: i32 = 11;
/// A mortar facet's projection on a non-mortar facet's plane is not convex. Within Newton: a domain
/// error; take a smaller step.
pub const STICKSLIP_PROJECTION_NOT_CONVEX: i32 = 12;
/// The caller's buffer is too small.
pub const STICKSLIP_BUFFER_TOO_SMALL: i32 = 13;
/// The caller's sparse matrix lacks an entry that the tangent needs.
pub const STICKSLIP_MISSING_ENTRY: i32 = 14;
/// There is no commit to roll back.
pub const STICKSLIP_NOTHING_TO_ROLL_BACK: i32 = 15;
/// An imported history does not belong to this interface.
pub const STICKSLIP_HISTORY_MISMATCH: i32 = 16;
/// Within the step a surface has turned by more than method.turn_max: the normals of t_n no longer mean it. Commit
/// smaller steps. With STICKSLIP_WEIGHTS_REFERENCE it is the turn since the first configuration, which none shortens: take
/// STICKSLIP_WEIGHTS_CURRENT.
pub const STICKSLIP_TURNED_TOO_FAR: i32 = 17;
/// The system has no memory left for what the call needs. Nothing was changed.
pub const STICKSLIP_OUT_OF_MEMORY: i32 = 18;
/// A commit would take pairs away from a node that is closed. Commit a smaller step, or give a search_distance.
pub const STICKSLIP_CONTACT_LOST: i32 = 19;
/// The library is at fault; please report it. The handle is suspect.
pub const STICKSLIP_PANIC: i32 = -1;
