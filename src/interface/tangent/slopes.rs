//! What sigma_A of each node depends on beside lambda_A (docs/formulation 16.4): rhat_A nu_A . Dg_A / D_A; with friction rhat_A Dg_A / D_A
//! in each direction. With weights that are held dual
//! ones leave no node of its own side but A: sum_B n^d_AB x_B = D_A x_A (10.1), for off the diagonal there is nothing but rounding. With
//! weights that are differentiated there are all nodes of the facets around A.

use super::around::Around;
use super::point_motion::Motions;
use super::point_numbers::PointNumbers;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Store};

/// The nodes of both surfaces that each sigma_A depends on, and d sigma_A / dx, each with a fourth number that is 0. Without
/// numbers the nodes alone; with them those of the sigma_A that act alone. With friction the numbers are those of the three directions.
#[derive(Debug, Default)]
pub struct Slopes {
    first: Vec<usize>,
    nodes: Vec<u32>,
    slopes: Vec<[f64; 4]>,
}

/// The nodes of one sigma_A while they are found.
struct Finder<'a> {
    of: &'a mut Slopes,
    places: Vec<u32>,
    first: usize,
}

impl Finder<'_> {
    /// The place of a node, which is put at the end if it was not there.
    #[inline]
    fn place(&mut self, node: usize) -> Result<usize> {
        let place = self.places[node] as usize;
        if place >= self.first && self.of.nodes.get(place) == Some(&(node as u32)) {
            return Ok(place);
        }
        self.places[node] = self.of.nodes.len() as u32;
        self.of.nodes.store(node as u32)?;
        self.of.slopes.store([0.0; 4])?;
        Ok(self.of.nodes.len() - 1)
    }
}

fn lanes(v: Vec3) -> [f64; 4] {
    [v.x, v.y, v.z, 0.0]
}

/// Which gap of its node sigma_A follows.
#[derive(Clone, Copy)]
pub enum Along<'a> {
    /// That along nu_A; the motions of the weights, if these are differentiated.
    Normals(Option<&'a Motions>),
    /// With friction: that in each direction.
    All,
}

/// The surfaces, what is around their nodes, whether the mortar side moves, and whether weights are differentiated.
pub type Sides<'a> = ((&'a Surface, &'a Surface), &'a Around, bool, bool);

impl Slopes {
    /// Of all nodes.
    pub fn of(sides: Sides, numbers: Option<(&PointNumbers, Along)>) -> Result<Slopes> {
        let ((one, two), around, ..) = sides;
        let (mut all, n1) = (Slopes::default(), one.len());
        let places = memory::filled(0, n1 + two.len())?;
        let mut finder = Finder { of: &mut all, places, first: 0 };
        for a in 0..n1 {
            finder.first = finder.of.nodes.len();
            finder.of.first.store(finder.first)?;
            if one.has_row(a) && !around.around(a).is_empty() {
                match numbers {
                    None => finder.reach(sides, a)?,
                    Some((numbers, _)) if !numbers.acts(a, around) => {}
                    Some((numbers, Along::Normals(motions))) => {
                        match motions {
                            Some(motions) => finder.moving(sides, a, motions)?,
                            None => finder.held(sides, a, numbers, numbers.normals[a])?,
                        }
                        finder.turning(sides, a, numbers)?;
                    }
                    Some((numbers, Along::All)) => finder.held(sides, a, numbers, Vec3::repeat(1.0))?,
                }
            }
        }
        all.first.store(all.nodes.len())?;
        Ok(all)
    }

    /// The nodes that sigma_A depends on.
    #[inline]
    pub fn nodes(&self, a: usize) -> &[u32] {
        &self.nodes[self.first[a]..self.first[a + 1]]
    }

    /// d sigma_A / dx of each.
    #[inline]
    pub fn slopes(&self, a: usize) -> &[[f64; 4]] {
        &self.slopes[self.first[a]..self.first[a + 1]]
    }
}

impl Finder<'_> {
    /// The nodes alone.
    fn reach(&mut self, ((one, _), around, _, own): Sides, a: usize) -> Result<()> {
        self.place(a)?;
        for &f in around.turning(a) {
            one.host_nodes(f as usize).iter().try_for_each(|&b| self.place(b).map(|_| ()))?;
        }
        for &k in around.around(a) {
            for &b in one.host_nodes(around.facets[k as usize]).iter().filter(|_| own) {
                self.place(b)?;
            }
            around.mortar(k as usize).iter().try_for_each(|&c| self.place(one.len() + c as usize).map(|_| ()))?;
        }
        Ok(())
    }

    /// With weights that are held, along this direction.
    fn held(
        &mut self,
        ((one, two), around, moves, has_mid_nodes): Sides,
        a: usize,
        PointNumbers { points, sums, parents, .. }: &PointNumbers,
        direction: Vec3,
    ) -> Result<()> {
        let along = direction * points.rhat[a];
        let (own, mut diagonal) = (self.place(a)?, 0.0);
        for f in around.around(a).iter().map(|&k| around.facets[k as usize]).filter(|_| points.has_parts) {
            let nodes = one.host_nodes(f);
            let Some(l) = nodes.iter().position(|&b| b == a) else { continue };
            let first = parents.partition_point(|pair| pair.one < f);
            for pair in parents[first..].iter().take_while(|pair| pair.one == f) {
                for (&b, n) in nodes.iter().zip(&pair.weights.ab[l]).filter(|_| has_mid_nodes) {
                    if b == a {
                        diagonal += n;
                    } else {
                        let place = self.place(b)?;
                        self.of.slopes[place][0] += n;
                    }
                }
                for (&c, n) in two.host_nodes(pair.two).iter().zip(&pair.weights.ac[l]).filter(|_| moves) {
                    let place = self.place(one.len() + c)?;
                    self.of.slopes[place][0] -= n;
                }
            }
        }
        let of_points = around.around(a).iter().flat_map(|&k| around.at(k as usize)).filter(|_| !points.has_parts);
        for facet in of_points.map(|at| &points.facets[at]) {
            let Some(l) = facet.nodes().iter().position(|&b| b == a) else { continue };
            for pair in points.pairs[facet.places()].iter().filter(|_| moves) {
                for (&c, n) in two.host_nodes(pair.two).iter().zip(&pair.dual.ac[l]) {
                    let place = self.place(one.len() + c)?;
                    self.of.slopes[place][0] -= n;
                }
            }
        }
        let other = along / sums[a].coverage;
        self.of.slopes[own] = lanes(if has_mid_nodes { other * diagonal } else { along });
        self.of.slopes[own + 1..].iter_mut().for_each(|slope| *slope = lanes(other * slope[0]));
        Ok(())
    }

    /// With weights that are differentiated.
    fn moving(&mut self, ((one, _), around, ..): Sides, a: usize, motions: &Motions) -> Result<()> {
        for k in around.around(a).iter().map(|&k| k as usize) {
            let (own, mortar) = (one.host_nodes(around.facets[k]), around.mortar(k));
            let Some(l) = own.iter().position(|&b| b == a) else { continue };
            let nodes = own.iter().copied().chain(mortar.iter().map(|&c| one.len() + c as usize));
            for (node, slope) in nodes.zip(motions.slopes(k, l, own.len() + mortar.len())) {
                let place = self.place(node)?;
                (0..3).for_each(|i| self.of.slopes[place][i] += slope[i]);
            }
        }
        Ok(())
    }

    /// With normals of now: (rhat_A / D_A) g_A . Dnu_A.
    fn turning(&mut self, ((one, _), around, ..): Sides, a: usize, numbers: &PointNumbers) -> Result<()> {
        let Some(turns) = numbers.turns else { return Ok(()) };
        let gap = numbers.sums[a].gap_now * (numbers.points.rhat[a] / numbers.sums[a].coverage);
        for f in around.turning(a).iter().map(|&f| f as usize) {
            let nodes = one.host_nodes(f);
            let Some(k) = nodes.iter().position(|&b| b == a) else { continue };
            for (column, dnu) in turns((f, k)).as_slice() {
                let (place, slope) = (self.place(nodes[*column])?, dnu.transpose() * gap);
                (0..3).for_each(|i| self.of.slopes[place][i] += slope[i]);
            }
        }
        Ok(())
    }
}
