//! Which pairs of facets may be active at a configuration: those that the filter of t_n admits and whose mortar facet may
//! reach into the non-mortar facet's prism.
//!
//! Where the normals follow the motion, a surface may slide round a curve or turn by any angle within a step. Then a pair may
//! be active, too, that the filter would admit where the facets are now. And what t_n admits counts only while neither facet
//! has turned far: a pair of t_n may be one of far sides now.

use super::ends::Ends;
use super::filter::FacetFilter;
use super::prism::Prism;
use super::search::Tree;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::options::{Options, Scheme};
use crate::interface::data::surface::{Surface, are_same};
use crate::memory::{self, Store};
use crate::mortar::NonmortarFrame;

/// Prisms are grown by this (over the facet's longest edge), so that touching facets are visited.
const TOUCH_MARGIN: f64 = 1e-6;
/// How far (over the facet's longest edge) surfaces may move within their plane before a tangent needs
/// entries beyond the superset pattern.
pub const SKIN: f64 = 0.25;

/// The search tree over a mortar surface, with the positions that it is of: a mortar side at rest needs one alone.
#[derive(Debug, Default)]
pub struct KeptTree {
    pub x2: Vec<Vec3>,
    pub tree: Tree,
    /// Whether the tree is of these positions; if not it is room.
    is_current: bool,
}

impl KeptTree {
    /// The tree of `two` at `x2`.
    pub fn at(&mut self, two: &Surface, x2: &[Vec3]) -> Result<&Tree> {
        if !are_same(&self.x2, x2) {
            self.is_current = false;
            memory::recopy(&mut self.x2, x2)?;
        }
        if !self.is_current {
            self.tree.renew(two.facets.len(), &|f| two.facet(f, x2))?;
            self.is_current = true;
        }
        Ok(&self.tree)
    }
}

/// Pairs that pass the filter and whose mortar facet may reach into the non-mortar facet's prism, grown by
/// `skin` (over the facet's longest edge). Where the normals follow the motion, those too that pass it after such a motion.
/// Sorted.
pub fn candidates(
    (one, two): (&Surface, &Surface),
    options: &Options,
    frames: &[NonmortarFrame],
    (x1, x2): (&[Vec3], &[Vec3]),
    (tree, filter): (&Tree, &FacetFilter),
    skin: f64,
    visited: &mut i64,
) -> Result<Vec<(usize, usize)>> {
    let (mut pairs, mut found) = (Vec::new(), Vec::new());
    let search = Search::new((one, two), options, (x1, x2), (tree, filter), skin);
    for (i, frame) in frames.iter().enumerate() {
        *visited += search.of_facet((i, frame), &mut found, &mut pairs, None)?;
    }
    Ok(pairs)
}

/// A search, facet by facet.
pub struct Search<'a> {
    surfaces: (&'a Surface, &'a Surface),
    x: (&'a [Vec3], &'a [Vec3]),
    tree: &'a Tree,
    filter: &'a FacetFilter,
    ends: Ends<'a>,
    skin: f64,
    /// Whether the normals follow the motion.
    pub follows: bool,
    all: bool,
}

impl<'a> Search<'a> {
    /// At these positions; see [`candidates`].
    pub fn new(
        surfaces: (&'a Surface, &'a Surface),
        options: &Options,
        x: (&'a [Vec3], &'a [Vec3]),
        (tree, filter): (&'a Tree, &'a FacetFilter),
        skin: f64,
    ) -> Search<'a> {
        let follows = options.follows_normals();
        let all = follows && (skin > 0.0 || filter.has_turned(surfaces, x));
        let ends = Ends::new((tree, filter), (surfaces.1, x.1), follows.then_some(skin));
        Search { surfaces, x, tree, filter, ends, skin, follows, all }
    }

    /// Whether facet i, which has this frame, may have facet j as its partner.
    pub fn admits(&self, (i, frame): (usize, &NonmortarFrame), j: usize) -> bool {
        let (filter, skin) = (self.filter, self.skin);
        if filter.hides(i, j) {
            return false;
        }
        if !self.follows {
            return filter.admits(i, j);
        }
        let pair = ((i, &frame.plane), (j, &self.surfaces.1.facet(j, self.x.1)));
        let then = filter.admits(i, j) && (skin > 0.0 || filter.holds_at(pair.0, pair.1));
        then || filter.admits_at(pair.0, pair.1, skin)
    }

    /// Whether facet i can have a partner at all.
    pub fn reaches(&self, i: usize) -> bool {
        (self.all || self.filter.reached[i]) && !self.surfaces.0.is_idle(i)
    }

    /// The prism over facet i, which has this frame, without ends.
    fn prism(&self, i: usize, frame: &NonmortarFrame) -> Prism {
        let facet = self.surfaces.0.facet(i, self.x.0);
        Prism::over(facet.points(), &frame.plane, (TOUCH_MARGIN + self.skin) * facet.longest_edge())
    }

    /// Whether the search of facet i, whose plane has this normal, may not look at all heights.
    pub fn may_end(&self, i: usize, normal: Vec3) -> bool {
        let facet = self.surfaces.0.facet(i, self.x.0);
        self.ends.may_cut(i, (normal, facet.points()[0]), facet.longest_edge())
    }

    /// Whether the search of facet i, which has this frame, looks at all heights: what it finds then does not depend on the
    /// filter.
    pub fn is_endless(&self, (i, frame): (usize, &NonmortarFrame)) -> bool {
        self.ends.of(self.prism(i, frame), i, &frame.plane).is_endless()
    }

    /// Appends the candidates of facet i, which has this frame, and to `excluded` what was found and is none. Gives how many
    /// boxes were compared.
    pub fn of_facet(
        &self,
        (i, frame): (usize, &NonmortarFrame),
        found: &mut Vec<usize>,
        pairs: &mut Vec<(usize, usize)>,
        mut excluded: Option<&mut Vec<(u32, u32)>>,
    ) -> Result<i64> {
        if !self.reaches(i) {
            return Ok(0);
        }
        let prism = self.prism(i, frame);
        let visited = self.tree.find(&self.ends.of(prism, i, &frame.plane), found)?;
        if self.skin == 0.0 {
            prism.keep_near(self.surfaces.1, self.x.1, found);
        }
        for &j in found.iter() {
            if self.admits((i, frame), j) {
                pairs.store((i, j))?;
            } else if let Some(excluded) = &mut excluded {
                excluded.store((i as u32, j as u32))?;
            }
        }
        Ok(visited as i64)
    }
}

/// The points of non-mortar facet `i` where it is integrated by points.
pub fn by_points(options: &Options, filter: &FacetFilter, i: usize) -> Option<&'static [[f64; 2]]> {
    match options.scheme {
        Scheme::Segments => None,
        Scheme::Elements(line) => Some(line),
        Scheme::Hybrid(line) => (!filter.by_overlaps[i]).then_some(line),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::data::options::{Normals, Stiffness};
    use crate::interface::data::surface::frames;
    use crate::interface::pairing::boxes::{Aabb, Four};
    use crate::interface::pairing::filter::Filter;
    use crate::interface::pairing::settle;
    use crate::mortar::Segment;
    use crate::simd::Plain;

    /// Numbers in -1..1.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 33) as f64 / (1u64 << 30) as f64 - 1.0
        }
        fn vector(&mut self) -> Vec3 {
            Vec3::new(self.next(), self.next(), self.next())
        }
    }

    /// Scattered facets with three or four nodes of their own, long ones among them, warped, that look up or down, each
    /// turned by an angle of its own.
    fn heap(side: &'static str, n: usize, size: f64, up: f64, random: &mut Random) -> Surface {
        let (mut x, mut facets) = (Vec::new(), Vec::new());
        let (long, bend) = (10_f64.powf(1.5 * random.next().max(0.0)), 0.5 * random.next().max(0.0));
        for f in 0..n {
            let (centre, angle) = (random.vector(), 3.0 * random.next());
            let first = x.len() as i64;
            for (a, b) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].into_iter().take(3 + f % 2) {
                let (a, b) = (a * long, up * b);
                let (sin, cos) = angle.sin_cos();
                x.push(centre + (Vec3::new(cos * a - sin * b, sin * a + cos * b, 0.0) + random.vector() * 0.1) * size);
            }
            let tilt = random.vector() * bend;
            x[first as usize..].iter_mut().for_each(|p| p.z += tilt.dot(&(*p - centre)));
            facets.push((first..x.len() as i64).collect());
        }
        let equations = vec![[-1; 3]; x.len()];
        Surface::new(side, x, &facets, equations).unwrap()
    }

    /// The places of now: a large motion of both sides alike, one of this side, one of each node, a turn.
    fn moved(surface: &Surface, common: Vec3, sizes: [f64; 3], random: &mut Random) -> Vec<Vec3> {
        let (own, turn) = (random.vector() * sizes[0], nalgebra::Rotation3::new(random.vector() * sizes[2]));
        surface.reference.iter().map(|x| turn * (x + random.vector() * sizes[1]) + own + common).collect()
    }

    /// The candidates are those that all against all gives, by the filter and by what lies beside what.
    #[test]
    fn ends_and_axes_lose_no_pair_whatever_the_motion() {
        let (mut random, mut seen, mut turned, mut of_segments) = (Random(5), [0; 2], 0, 0);
        for round in 0..400 {
            // With few facets the tree has the axes of space.
            let (n, m) = if round % 3 == 0 { (20, 60) } else { (30, 25) };
            let (one, two) = (heap("nonmortar", n, 0.3, -1.0, &mut random), heap("mortar", m, 0.2, 1.0, &mut random));
            let options = Options {
                search_distance: (round % 2 == 0).then_some(0.1 + 0.2 * random.next().abs()),
                normals: if round % 4 < 2 { Normals::Committed } else { Normals::Current },
                ..Options::paper(Stiffness::Modulus(1.0))
            };
            let Filter::Facets(filter) =
                settle::filter((&one, &two), &options, (&one.reference, &two.reference), &mut KeptTree::default())
                    .unwrap()
            else {
                panic!("facets")
            };
            let common = random.vector() * if round % 5 == 0 { 1e4 } else { 0.0 };
            let sizes = [0.0, 0.3, 1.0].map(|size| size * f64::from(round % 7 > 1));
            let sizes = [sizes[round % 3], 0.02 * sizes[(round / 3) % 3], sizes[(round / 9) % 3]];
            let (x1, x2) = (moved(&one, common, sizes, &mut random), moved(&two, common, sizes, &mut random));
            let Ok(frames) = frames(&one, &x1) else { continue };
            for skin in [0.0, SKIN] {
                let mut kept = KeptTree::default();
                let kept = kept.at(&two, &x2).unwrap();
                let is_turned = !kept.is_along_space();
                let (args, mut visited) = (((&one, &two), &options), 0);
                let found =
                    candidates(args.0, args.1, &frames, (&x1, &x2), (kept, &filter), skin, &mut visited).unwrap();
                let mut expected = Vec::new();
                let follows = options.follows_normals();
                let all = follows && (skin > 0.0 || filter.has_turned((&one, &two), (&x1, &x2)));
                for (i, frame) in frames.iter().enumerate().filter(|&(i, _)| all || filter.reached[i]) {
                    let facet = one.facet(i, &x1);
                    let margin = (TOUCH_MARGIN + skin) * facet.longest_edge();
                    let prism = Prism::over(facet.points(), &frame.plane, margin);
                    for j in 0..m {
                        let then = filter.admits(i, j);
                        let pair = ((i, &frame.plane), (j, &two.facet(j, &x2)));
                        let holds = !follows || skin > 0.0 || filter.holds_at(pair.0, pair.1);
                        if !(then && holds || follows && filter.admits_at(pair.0, pair.1, skin)) {
                            continue;
                        }
                        let mut near = vec![j];
                        prism.keep_near(&two, &x2, &mut near);
                        let around = Aabb::around(pair.1.1.points().iter().copied());
                        let meets = prism.overlaps::<Plain>(&Four::of([&around; 4]))[0] >= 0.0;
                        if !matches!(Segment::new(frame, pair.1.1), Ok(None) | Err(_)) {
                            assert!(!near.is_empty() && meets, "round {round}: {i} and {j} overlap");
                            of_segments += 1;
                        }
                        if skin == 0.0 && !near.is_empty() || skin > 0.0 && meets {
                            expected.push((i, j));
                        }
                    }
                }
                turned += usize::from(is_turned);
                if skin == 0.0 || !is_turned {
                    assert_eq!(found, expected, "round {round}, skin {skin}, motions {sizes:?}");
                } else {
                    // Boxes along other axes are other boxes, and each pair that comes near lies in both.
                    assert!(found.iter().all(|&(i, _)| i < n));
                }
                seen[usize::from(skin > 0.0)] += expected.len();
            }
        }
        println!("{seen:?} pairs, {of_segments} overlap, {turned} searches along other axes");
        assert!(seen.iter().all(|&pairs| pairs > 1000) && of_segments > 500 && turned > 20);
    }
}
