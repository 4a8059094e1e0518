//! What lies nearest to the nodes of an interface (`nearest.rs`).

use crate::geometry::Vec3;

/// What lies nearest to a node along a non-mortar facet's normal.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// How far in front of it `[L]`; negative: behind.
    pub gap: f64,
    /// What of an overlap the facets' sagittas may be: in any case, and where they are pressed together until gaps and overlaps have the
    /// mean 0 `[L]`.
    pub sagittas: [f64; 2],
    /// The longest edge of the smaller facet `[L]`.
    pub size: f64,
    /// Whether the two look at each other.
    pub opposes: bool,
    /// A non-mortar facet and node there.
    pub facet: usize,
    pub node: usize,
}

/// Nothing was met.
pub const NOTHING: Nearest =
    Nearest { gap: f64::INFINITY, sagittas: [0.0; 2], size: 0.0, opposes: false, facet: 0, node: 0 };

impl Nearest {
    /// Keeps the nearer one.
    pub fn offer(&mut self, other: Nearest) {
        if other.gap.abs() < self.gap.abs() {
            *self = other;
        }
    }
}

/// Room for it.
#[derive(Debug, Default)]
pub struct Seen {
    /// Per node of both sides, mortar after non-mortar.
    pub nearest: Vec<Nearest>,
    /// Per non-mortar node the nearest point in front of the facets around it.
    pub front: Vec<Nearest>,
    /// Per facet of either side its plane's normal.
    pub normals: [Vec<Vec3>; 2],
}
