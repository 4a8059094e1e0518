//! What a commit settles about the pairs of the step that follows: which facets oppose each other, and how deep one may
//! lie behind the other. It depends on the positions of t_n alone. So evaluations within the step are functions of the
//! positions.
//!
//! Two facets may be a pair over any gap. A penetration deeper than a facet would find the far side of a body, so it is
//! no pair. But facets are chords of curved surfaces: a coarse chord lies farther off its surface than the facets of a
//! fine partner are long. So a pair may be as deep as its smaller facet is long, plus what both surfaces bulge from
//! their facets. This is the pair's own measure. A mortar facet that coarse non-mortar facets let in may lie deeper
//! (`depth.rs`).

use super::hidden::Hidden;
use crate::error::Result;
use crate::geometry::{Facet, Plane, Vec3};
use crate::interface::data::surface::{NO_FACET, Surface};
use crate::memory::{self, Stored};

/// Facets whose normals oppose each other less than this are no pair: beyond 80 degrees the
/// projection degenerates, and faces that look the same way must not be found.
pub const LEAST_OPPOSITION: f64 = 0.17;
/// A pair may be as deep as this part of the thinner of the two walls behind it. Far sides of two bodies are behind each other by
/// both thicknesses, those of one body and of a rim of the other by about one.
const PART_OF_WALL: f64 = 0.45;
/// A facet that is open all over by more than this (over the non-mortar facet's longest edge) touches nothing: a node that
/// has such pairs alone is closed by the rounding of a gap across its normal. Far above what rounding makes of a flat
/// contact, far below a gap.
pub const TOUCHES: f64 = 1e-6;
/// Neighbouring facets whose normals have a scalar product above this (45 degrees) approximate one smooth surface;
/// below it there is an edge, which says nothing about a bulge.
pub const SMOOTH: f64 = 0.7;
/// A circle lies off its chord of length h by h phi / 4 at most, phi the angle to the next, much shorter chord (phi / 8
/// where that is as long); this times h phi leaves a factor of 2.
const BULGE: f64 = 0.5;

/// Where the normals follow the motion, what t_n says of a facet counts up to this turn, cos 20 degrees: whether it can
/// have a pair at all, and which ones it has whatever the filter says now.
const TURNED: f64 = 0.94;

/// How much the normals of a pair must oppose each other: at all where a motion by `skin` is still to come.
pub fn least_opposition(skin: f64) -> f64 {
    if skin > 0.0 { 0.0 } else { LEAST_OPPOSITION }
}

/// What settles at a commit which pairs there can be.
#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "an interface has one")]
pub enum Filter {
    Facets(FacetFilter),
    /// Which non-mortar facets face an analytic mortar side.
    Analytic(Vec<bool>),
}

impl Filter {
    /// Per non-mortar facet, whether it can have a pair.
    pub fn reached(&self) -> &[bool] {
        match self {
            Filter::Facets(filter) => &filter.reached,
            Filter::Analytic(facing) => facing,
        }
    }
}

/// The facets of one side at t_n.
#[derive(Debug)]
pub struct Side {
    pub facets: Vec<(Facet, Plane)>,
    /// The longest edge of each `[L]`.
    pub edges: Vec<f64>,
    /// How far the surface may lie off each of them `[L]`.
    pub bulges: Vec<f64>,
    /// How thick the wall behind each of them is `[L]`; empty: none has a back in its surface.
    pub walls: Vec<f64>,
    /// The largest of the edges and of the bulges `[L]`.
    largest: (f64, f64),
}

impl Side {
    /// Those of a surface at `x`.
    pub fn new(surface: &Surface, x: &[Vec3]) -> Result<Side> {
        let facet = |f: usize| {
            let facet = surface.facet(f, x);
            Plane::of(&facet).map(|plane| (facet, plane)).map_err(surface.at(f))
        };
        let facets = (0..surface.facets.len()).map(facet).stored_if_ok()?;
        let normal = |f: usize| facets[f].1.e;
        let smooth = surface.edges.iter().map(|e| e.facets).filter(|&[f, g]| normal(f).dot(&normal(g)) > SMOOTH);
        // Twice: a triangle may touch the facets that are turned against it at one node only.
        let (mut angles, mut near) = (memory::filled(0.0_f64, facets.len())?, memory::filled(0.0_f64, facets.len())?);
        for [f, g] in smooth.clone() {
            let angle = normal(f).cross(&normal(g)).norm();
            (angles[f], angles[g]) = (angles[f].max(angle), angles[g].max(angle));
        }
        for [f, g] in smooth {
            let angle = angles[f].max(angles[g]);
            (near[f], near[g]) = (near[f].max(angle), near[g].max(angle));
        }
        let edges: Vec<_> = facets.iter().map(|(facet, _)| facet.longest_edge()).stored()?;
        let bulge = |f: usize| warp(&facets[f].0, &facets[f].1) + BULGE * near[f] * edges[f];
        let bulges: Vec<_> = (0..facets.len()).map(bulge).stored()?;
        let largest = |v: &[f64]| v.iter().copied().fold(0.0, f64::max);
        let largest = (largest(&edges), largest(&bulges));
        let wall = |(f, back): (usize, &u32)| match *back {
            NO_FACET => f64::INFINITY,
            back => thickness(&facets[f].1, &facets[back as usize].1).max(0.0),
        };
        let walls = surface.backs.iter().enumerate().map(wall).stored()?;
        Ok(Side { facets, edges, bulges, walls, largest })
    }
}

impl Side {
    /// The deepest penetration of a pair of this facet that is none through its wall `[L]`.
    fn within_wall(&self, f: usize) -> f64 {
        PART_OF_WALL * self.walls.get(f).copied().unwrap_or(f64::INFINITY)
    }

    /// The surface that is meant lies behind its facets, by so much: pairs may be as much deeper.
    pub fn raise(&mut self, offset: f64) {
        if offset > 0.0 {
            self.bulges.iter_mut().for_each(|bulge| *bulge += offset);
            self.largest.1 += offset;
        }
    }
}

/// How far the centre of a facet with the plane `back` lies behind another one `[L]`.
pub fn thickness(facet: &Plane, back: &Plane) -> f64 {
    facet.e.dot(&((facet.reference - back.reference) + (facet.origin - back.origin)))
}

/// How far a facet's nodes lie off its plane `[L]`.
fn warp(facet: &Facet, plane: &Plane) -> f64 {
    heights(facet, plane).fold(0.0, |most, d| most.max(d.abs()))
}

/// Heights of a facet's nodes over a plane `[L]`.
fn heights(facet: &Facet, plane: &Plane) -> impl Iterator<Item = f64> {
    facet.points().iter().map(|x| plane.e.dot(&(x - plane.reference - plane.origin)))
}

/// The lowest and the highest of a facet's nodes over a plane `[L]`.
fn extremes(facet: &Facet, plane: &Plane) -> (f64, f64) {
    heights(facet, plane).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| (l.min(d), h.max(d)))
}

/// Whether two facets can be a pair: opposing normals, and heights over the non-mortar facet between a penetration and
/// a gap.
#[derive(Debug)]
pub struct FacetFilter {
    /// Non-mortar, mortar.
    pub sides: [Side; 2],
    /// What the host gives for both penetration and gap `[L]`.
    pub distance: Option<f64>,
    /// Per mortar facet, how deep it may lie beyond the pairs' own measure `[L]`; empty: none may.
    pub depths: Vec<f64>,
    /// Per non-mortar facet, whether any mortar facet can be a pair with it.
    pub reached: Vec<bool>,
    /// Per non-mortar facet, whether it is integrated over overlaps and not over points; empty unless the scheme has both.
    pub by_overlaps: Vec<bool>,
    /// What layers of the mortar surface hide.
    pub hidden: Hidden,
}

impl FacetFilter {
    /// Whether a nearer mortar facet hides mortar facet j from non-mortar facet i: then they are no pair before the next commit.
    #[inline]
    pub fn hides(&self, i: usize, j: usize) -> bool {
        !self.hidden.stacked.is_empty() && self.is_hidden(i, j)
    }

    /// The same where there are layers.
    #[cold]
    #[inline(never)]
    fn is_hidden(&self, i: usize, j: usize) -> bool {
        let far = |j: usize| {
            let (low, high) = self.heights(i, j);
            (low + high).abs()
        };
        self.hidden.hides(i, j, &|other| self.admits(i, other) && far(other) < far(j))
    }

    /// Whether non-mortar facet i and mortar facet j can be a pair, where no other one lies between them.
    pub fn admits(&self, i: usize, j: usize) -> bool {
        self.opposes(i, j) && self.reaches((i, j), self.heights(i, j))
    }

    /// Whether they can be a pair where non-mortar facet i has this plane and mortar facet j these nodes, by what t_n says of
    /// sizes and bulges. `skin`: or after a motion of so much (over the longest edge of facet i); then they may turn, too,
    /// and need but oppose each other at all.
    pub fn admits_at(&self, (i, plane): (usize, &Plane), (j, facet): (usize, &Facet), skin: f64) -> bool {
        let (out, (low, high), slack) = (facet.area_vector(), extremes(facet, plane), skin * self.sides[0].edges[i]);
        let least = least_opposition(skin) * out.norm();
        plane.e.dot(&out) < -least && self.reaches((i, j), (low - slack, high + slack))
    }

    /// Whether what t_n says of non-mortar facet i and mortar facet j still holds where i has this plane and j these nodes:
    /// neither has turned by more than [`TURNED`], and they do not look the same way. A pair of t_n that has turned may
    /// be one of far sides now.
    pub fn holds_at(&self, (i, plane): (usize, &Plane), (j, facet): (usize, &Facet)) -> bool {
        let ([one, two], out) = (&self.sides, facet.area_vector());
        let least = TURNED * out.norm();
        let turned = one.facets[i].1.e.dot(&plane.e) < TURNED || two.facets[j].1.e.dot(&out) < least;
        !turned && plane.e.dot(&out) < 0.0
    }

    /// Whether these heights lie between a penetration and a gap.
    fn reaches(&self, (i, j): (usize, usize), (low, high): (f64, f64)) -> bool {
        low <= self.gap() && high >= -self.penetration(i, j)
    }

    /// Whether they look at each other.
    pub fn opposes(&self, i: usize, j: usize) -> bool {
        let [one, two] = &self.sides;
        one.facets[i].1.e.dot(&two.facets[j].1.e) < -LEAST_OPPOSITION
    }

    /// The lowest and the highest node of mortar facet j over the plane of non-mortar facet i `[L]`.
    pub fn heights(&self, i: usize, j: usize) -> (f64, f64) {
        let [one, two] = &self.sides;
        extremes(&two.facets[j].0, &one.facets[i].1)
    }

    /// Whether a facet has turned since t_n by more than [`TURNED`].
    pub fn has_turned(&self, (one, two): (&Surface, &Surface), (x1, x2): (&[Vec3], &[Vec3])) -> bool {
        let [side1, side2] = &self.sides;
        let turned = |side: &Side, surface: &Surface, x: &[Vec3]| {
            let cosine = |f: usize| side.facets[f].1.e.dot(&surface.facet(f, x).area_vector().normalize());
            (0..side.facets.len()).any(|f| cosine(f) < TURNED)
        };
        turned(side1, one, x1) || turned(side2, two, x2)
    }

    /// The widest gap of a pair `[L]`.
    pub fn gap(&self) -> f64 {
        self.distance.unwrap_or(f64::INFINITY)
    }

    /// The deepest penetration at which they can be a pair `[L]`.
    fn penetration(&self, i: usize, j: usize) -> f64 {
        let [one, two] = &self.sides;
        let own = || self.penetrations(i, j)[0] + self.depths.get(j).copied().unwrap_or(0.0);
        self.distance.unwrap_or_else(own).min(one.within_wall(i)).min(two.within_wall(j))
    }

    /// What of it follows from their sizes and bulges, and how deep the coarser of them lets a body in at most.
    pub fn penetrations(&self, i: usize, j: usize) -> [f64; 2] {
        let [one, two] = &self.sides;
        let (edges, bulges) = ((one.edges[i], two.edges[j]), one.bulges[i] + two.bulges[j]);
        [edges.0.min(edges.1), edges.0.max(edges.1)].map(|edge| edge + bulges)
    }

    /// The most that any mortar facet may lie beyond that.
    pub fn largest_depth(&self) -> f64 {
        self.depths.iter().copied().fold(0.0, f64::max)
    }

    /// At least the deepest penetration of any pair of non-mortar facet i `[L]`; `depth`: [`FacetFilter::largest_depth`].
    pub fn deepest_of(&self, i: usize, depth: f64) -> f64 {
        self.deepest_beside(i, self.sides[1].largest, depth)
    }

    /// The same of pairs with mortar facets whose edges and bulges are at most so large, and which may lie so much deeper.
    pub fn deepest_beside(&self, i: usize, (edge, bulge): (f64, f64), depth: f64) -> f64 {
        let one = &self.sides[0];
        self.distance.unwrap_or(one.edges[i].min(edge) + one.bulges[i] + bulge + depth)
    }

    /// At least how deep the coarser facet of any pair of non-mortar facet i lets a body in `[L]`.
    pub fn deepest_let_in(&self, i: usize) -> f64 {
        let (one, (edge, bulge)) = (&self.sides[0], self.sides[1].largest);
        one.edges[i].max(edge) + one.bulges[i] + bulge
    }

    /// At least the deepest penetration of any pair `[L]`.
    pub fn deepest(&self) -> f64 {
        let [(h1, b1), (h2, b2)] = self.sides.each_ref().map(|side| side.largest);
        self.distance.unwrap_or(h1.min(h2) + b1 + b2 + self.largest_depth())
    }
}
