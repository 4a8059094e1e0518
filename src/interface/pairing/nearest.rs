//! Which facet of the other side lies nearest to each node, whatever the filter says (docs/formulation 4.7): along the
//! normal of the non-mortar facet, in front or behind and whichever way it looks. Where that one opposes and lies behind, the node is in the
//! other body. A far side is not nearest, nor is a plate that lies in front of it.

use super::filter::{LEAST_OPPOSITION, SMOOTH};
use super::prism::{Prism, Slab};
use super::seen::{NOTHING, Nearest, Seen};
use super::work::Work;
use crate::error::Result;
use crate::geometry::{Facet, OUTSIDE, Over, Plane, Vec3};
use crate::interface::data::surface::{NO_FACET, Surface};
use crate::memory;

/// The middle of a quadrilateral with edges h lies off the sphere through its nodes by h phi / 4, phi the angle to its
/// neighbours.
const SAGITTA: f64 = 0.25;
/// The middle of a line off the circle.
const SAGITTA_OF_LINE: f64 = 0.125;

/// How far a facet may lie off the round surface that it stands for `[L]`: outside of the body where that is hollow, inside where it is round.
#[inline(never)] // it is asked for three times
fn sagittas(surface: &Surface, normals: &[Vec3], x: &[Vec3], f: usize, facet: &Facet) -> [f64; 2] {
    let part = if surface.lines().is_some() { SAGITTA_OF_LINE } else { SAGITTA } * facet.longest_edge();
    let mut most = [0.0_f64; 2];
    for &g in surface.neighbours[f].iter().filter(|&&g| g != NO_FACET) {
        let (m, n) = (&normals[f], &normals[g as usize]);
        if m.dot(n) > SMOOTH {
            let rise: f64 = surface.facet(g as usize, x).nodes.iter().map(|p| m.dot(&(p - facet.nodes[0]))).sum();
            let which = usize::from(rise < 0.0);
            most[which] = most[which].max(part * m.cross(n).norm());
        }
    }
    most
}

/// Looks at every node of facets that are not idle.
#[inline(never)] // then it is compiled once, not in each of its callers
pub fn look((one, two): (&Surface, &Surface), (x1, x2): (&[Vec3], &[Vec3]), work: &mut Work) -> Result<()> {
    let Work { tree, room, .. } = work;
    let Seen { nearest, front, normals } = &mut room.seen;
    // Against a shape middles of facets take the place of its nodes.
    let shape = if two.analytic.is_some() { Some(two.analytic_at(x2)?) } else { None };
    memory::refill(nearest, NOTHING, one.len() + shape.map_or(two.len(), |_| one.facets.len()))?;
    memory::refill(front, NOTHING, one.len())?;
    one.plane_normals(x1, &mut normals[0])?;
    two.plane_normals(x2, &mut normals[1])?;
    let tree = if shape.is_none() { Some(tree.at(two, x2)?) } else { None };
    for i in (0..one.facets.len()).filter(|&i| !one.is_idle(i)) {
        let facet = one.facet(i, x1);
        let (plane, edge) = (Plane::of(&facet).map_err(one.at(i))?, facet.longest_edge());
        let (nodes, rows) = (one.facets[i].as_slice(), one.rows(i).as_slice());
        let own = sagittas(one, &normals[0], x1, i, &facet);
        let mut meet = |place: usize, found: Nearest| {
            nearest[place].offer(found);
            if found.opposes {
                rows.iter().for_each(|&a| {
                    if found.gap < front[a].gap {
                        front[a] = found
                    }
                });
            }
        };
        if let Some(surface) = shape {
            let middle = (plane.reference + plane.origin, one.len() + i, nodes[0]);
            for (x, place, node) in nodes.iter().map(|&a| (x1[a], a, a)).chain([middle]) {
                if let Some(closest) = surface.closest(x - surface.origin) {
                    let opposes = -plane.e.dot(&closest.normal) > LEAST_OPPOSITION;
                    let gap = closest.distance + one.offset(node);
                    meet(place, Nearest { gap, sagittas: own, size: edge, opposes, facet: i, node });
                }
            }
            continue;
        }
        let under = Over::new(&facet, &plane);
        let reach = edge + under.warp();
        let middle = plane.e.dot(&plane.origin);
        let slab = Slab { direction: plane.e, low: middle - reach, high: middle + reach };
        let prism = Prism::over(facet.points(), &plane, OUTSIDE * edge).within([slab]);
        tree.map_or(Ok(0), |tree| tree.find(&prism, &mut room.found))?;
        for &j in &room.found {
            let opposition = -plane.e.dot(&normals[1][j]);
            if opposition.abs() <= LEAST_OPPOSITION {
                continue;
            }
            let other = two.facet(j, x2);
            let (over, length) = (Over::new(&other, &plane), other.longest_edge());
            let others = sagittas(two, &normals[1], x2, j, &other);
            let sagittas = [own[0] + others[0], own[1] + others[1]];
            let found = |gap, node| Nearest {
                gap,
                sagittas,
                size: edge.min(length),
                opposes: opposition > 0.0,
                facet: i,
                node,
            };
            for &a in nodes {
                if let Some((height, n)) = over.height(x1[a], &plane) {
                    let offset = one.offset(a) + over.mean(&n, |k| two.offset(two.facets[j].of_corner(k)));
                    meet(a, found(offset - height, a));
                }
            }
            for &c in two.facets[j].as_slice() {
                if let Some((height, n)) = under.height(x2[c], &plane) {
                    let offset = two.offset(c) + under.mean(&n, |k| one.offset(one.facets[i].of_corner(k)));
                    meet(one.len() + c, found(offset + height, nodes[0]));
                }
            }
        }
    }
    Ok(())
}
