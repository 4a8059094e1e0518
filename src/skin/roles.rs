//! Which side of the contact each facet is on: two facets that may touch are on different sides, smooth neighbours on the same one.
//! What hangs together is coloured with two colours, and then one of the two gets the multipliers (docs/formulation 19.3).

use super::near::Near;
use super::whole::Whole;
use crate::adjacency::SharedEdge;
use crate::error::Result;
use crate::memory::{self, Stored};

/// Pairs closer than this, over the smaller facet's longest edge, are in contact: a role that is in use counts.
const TOUCHES: f64 = 0.01;
/// Facets in contact count as so many others: they have what would be lost.
const IN_CONTACT: f64 = 100.0;
/// Parts of a face that differ by less are equal: which facets are just within reach is an accident.
const SAME_PART: f64 = 0.05;
/// Sizes that differ by less are equal.
const SAME_SIZE: f64 = 0.01;

/// The side of a facet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// It touches nothing.
    #[default]
    None,
    /// It has the multipliers.
    Nonmortar,
    /// It is what they act on.
    Mortar,
}

/// The sides of all facets.
#[derive(Debug, Default)]
pub struct Sides {
    /// Per facet of the host.
    pub roles: Vec<Role>,
    /// How many facets are in contact and had the other side before.
    pub exchanged: usize,
    /// How many pairs could not be put on different sides.
    pub contradictions: usize,
}

/// Groups of facets in two colours.
struct Colours {
    parent: Vec<usize>,
    /// Whether a facet has another colour than its parent.
    differs: Vec<bool>,
}

impl Colours {
    /// The facet that stands for the group of `f`, and whether `f` has another colour.
    fn find(&mut self, mut f: usize) -> (usize, bool) {
        let mut differs = false;
        while self.parent[f] != f {
            let up = self.parent[f];
            // The way is halved.
            self.differs[f] ^= self.differs[up];
            self.parent[f] = self.parent[up];
            differs ^= self.differs[f];
            f = self.parent[f];
        }
        (f, differs)
    }

    /// Puts two facets on different sides, or on the same one; whether that is so now.
    fn join(&mut self, [f, g]: [usize; 2], differ: bool) -> bool {
        let ((root, of_f), (other, of_g)) = (self.find(f), self.find(g));
        if root == other {
            return (of_f ^ of_g) == differ;
        }
        self.parent[other] = root;
        self.differs[other] = of_f ^ of_g ^ differ;
        true
    }
}

/// What speaks for one of the two colours of a group to be the non-mortar side.
#[derive(Clone, Copy, Default)]
struct Colour {
    /// How much of it is so now, less what is so of the other side.
    kept: f64,
    /// Whether it can move.
    moves: bool,
    /// Its area, and that of the faces which it is of `[L^2]`.
    area: f64,
    faces: f64,
    /// Sum of the sizes of its facets, and their number.
    sizes: f64,
    facets: f64,
}

impl Colour {
    /// Whether it is to have the multipliers, and not `other`: the side that has them, the one that moves, the one that
    /// stays covered, the finer one.
    fn is_nonmortar(&self, other: &Colour) -> bool {
        let (part, of_other) = (self.area / self.faces, other.area / other.faces);
        let (size, size_of_other) = (self.sizes / self.facets, other.sizes / other.facets);
        if self.kept != other.kept {
            return self.kept > other.kept;
        }
        if self.moves != other.moves {
            return self.moves;
        }
        if (part - of_other).abs() > SAME_PART {
            return part > of_other;
        }
        size <= size_of_other * (1.0 + SAME_SIZE)
    }
}

/// The sides of all facets where these pairs may touch. `before`: those of the last step.
pub fn sides(whole: &Whole, near: &[Near], before: &[Role]) -> Result<Sides> {
    let n = whole.facets();
    let mut colours = Colours { parent: (0..n).stored()?, differs: memory::filled(false, n)? };
    let (mut has_role, mut touches) = (memory::filled(false, n)?, memory::filled(false, n)?);
    let size = |f: usize| whole.areas[f].sqrt();
    for pair in near {
        if pair.under {
            continue;
        }
        let [f, g] = pair.facets;
        let close = pair.distance <= TOUCHES * size(f).min(size(g));
        (has_role[f], has_role[g]) = (true, true);
        (touches[f], touches[g]) = (touches[f] || close, touches[g] || close);
    }
    // What is in contact first: it is in the deepest.
    let order = memory::order(near.len(), &|p, q| near[p].distance.total_cmp(&near[q].distance))?;
    let contradictions = order.iter().filter(|&&p| !near[p].under && !colours.join(near[p].facets, true)).count();
    for SharedEdge { facets, .. } in &whole.surface.edges {
        let [f, g] = facets.map(|f| whole.surface.host_facet(f));
        if has_role[f] && has_role[g] {
            colours.join([f, g], false);
        }
    }
    let mut groups = memory::filled([Colour::default(); 2], n)?;
    let mut face_areas = memory::filled(0.0, n)?;
    (0..n).for_each(|f| face_areas[whole.faces[f]] += whole.areas[f]);
    // A face counts once for each colour.
    let mut counted = memory::filled([usize::MAX; 2], n)?;
    for f in (0..n).filter(|&f| has_role[f]) {
        let (group, differs) = colours.find(f);
        let colour = usize::from(differs);
        let weight = if touches[f] { IN_CONTACT } else { 1.0 };
        let kept = match before.get(f) {
            Some(Role::Nonmortar) => weight,
            Some(Role::Mortar) => -weight,
            _ => 0.0,
        };
        groups[group][colour].kept += kept;
        groups[group][1 - colour].kept -= kept;
        let face = whole.faces[f];
        let is_new = counted[face][colour] != group;
        counted[face][colour] = group;
        let own = &mut groups[group][colour];
        own.moves |= whole.moves(f);
        own.area += whole.areas[f];
        own.faces += if is_new { face_areas[face] } else { 0.0 };
        own.sizes += size(f);
        own.facets += 1.0;
    }
    let mut found = Sides { roles: memory::filled(Role::None, n)?, exchanged: 0, contradictions };
    for f in (0..n).filter(|&f| has_role[f]) {
        let (group, differs) = colours.find(f);
        let [first, other] = &groups[group];
        let role = if first.is_nonmortar(other) ^ differs { Role::Nonmortar } else { Role::Mortar };
        let had = before.get(f).copied().unwrap_or_default();
        found.exchanged += usize::from(touches[f] && had != Role::None && had != role);
        found.roles[f] = role;
    }
    Ok(found)
}
