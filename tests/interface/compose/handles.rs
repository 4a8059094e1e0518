//! One handle of an interface, two that own parts of it, or two that have shares of its mortar side.

use super::choice::{Asked, Choice};
use super::scene::{At, Scene};
use crate::support::mesh::Create;
use crate::support::parts::submesh;
use nalgebra::SVector;
use stickslip::error::{Error, Result};
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, NodeSums, Owner};
use stickslip::law::{
    Answer, Bond, Ellipse, Host, Layer, NodeResponse, Overclosure, Own, Question, Squeeze, Threshold,
};

/// Offsets of up to a thousandth of a facet: both kinds of states remain.
const OFFSET: f64 = 5e-4;

/// Of the order of the library's: derivatives hold it, differences would not.
const AUGMENTATION: f64 = 3e3;

/// A refusal, and when it came.
pub struct Refused {
    pub asked: Asked,
    pub error: Error,
}

/// Says when a refusal came.
pub fn when<T>(asked: Asked, result: Result<T>) -> std::result::Result<T, Refused> {
    result.map_err(|error| Refused { asked, error })
}

pub struct Handles<const N: usize> {
    pub all: Vec<Contact<N>>,
    /// Of each the nodes of the mortar side that it has.
    pub mortar: Vec<Vec<usize>>,
    /// Where the multipliers of the first handle act; all at one.
    pub owns: Vec<bool>,
    shares: bool,
}

/// A threshold that depends on pressure, slip and what is remembered.
fn own_threshold(_: &Host, q: &Question, states: &mut [f64]) -> Result<Answer> {
    let threshold = Threshold { radius: 0.3 + 0.1 * q.states[0] - 0.2 * q.normal, fall: 0.2 };
    states[0] = q.states[0] + q.slip.norm();
    Ok(Answer { threshold, slope: Vec3::zeros() })
}

fn own_law(choice: &Choice) -> Option<Own> {
    match choice.of("law") {
        "own" => Some(Own::Host(Host { ask: own_threshold, words: [1, 2], states: 1, base: 0 })),
        "cohesion" => Some(Own::Cohesion { cohesion: 0.5 }),
        "weakening" => Some(Own::Weakening { after: 0.1, slip: 0.01 }),
        "rate" => Some(Own::Rate { after: 0.1, rate: 0.05, time: 0.2 }),
        "orthotropic" => Some(Own::Orthotropic(Ellipse { direction: Vec3::new(1.0, 0.3, 0.0), across: 0.15 })),
        _ => None,
    }
}

/// Of the scene's gaps of a thousandth, pressures of some units and slips of a hundredth, each in the middle of what it has kinks at.
fn layer(choice: &Choice) -> Option<Layer> {
    let has = |name: &str| choice.is("layer", name) || choice.is("layer", "all");
    let points = [(-1e-4, 0.0), (2e-4, 3.0), (5e-4, 20.0)];
    let table = points.map(|(overclosure, pressure)| Squeeze { overclosure, pressure });
    let layer = Layer {
        overclosure: has("overclosure").then(|| Overclosure::new(&table).unwrap()),
        wear: has("wear").then_some(0.01),
        bond: has("bond").then_some(Bond { stiffness: 2e3, strength: 3.0, toughness: 0.01, shear: 0.8 }),
    };
    (!choice.is("layer", "no")).then_some(layer)
}

/// Interfaces with three multipliers a node take laws of one's own and coefficients of friction, those with one do not.
pub trait TakesLaw {
    fn take(&mut self, own: Own) -> Result<()>;
    fn take_friction(&mut self, mu: Vec<f64>) -> Result<()>;
    fn take_layer(&mut self, layer: Layer) -> Result<()>;
}

impl TakesLaw for Contact<3> {
    fn take(&mut self, own: Own) -> Result<()> {
        self.set_law(Some(own))
    }

    fn take_friction(&mut self, mu: Vec<f64>) -> Result<()> {
        self.set_friction(mu)
    }

    fn take_layer(&mut self, layer: Layer) -> Result<()> {
        self.set_layer(Some(layer))
    }
}

impl TakesLaw for Contact<1> {
    fn take(&mut self, _: Own) -> Result<()> {
        unreachable!("without friction there is no law")
    }

    fn take_friction(&mut self, _: Vec<f64>) -> Result<()> {
        unreachable!("without friction there is no law")
    }

    fn take_layer(&mut self, layer: Layer) -> Result<()> {
        self.set_layer(Some(layer))
    }
}

/// The sums of several handles together.
fn sum(all: Vec<Vec<NodeSums>>) -> Option<Vec<NodeSums>> {
    all.into_iter().reduce(|mut sum, of| {
        sum.iter_mut().zip(of).for_each(|(sum, of)| {
            sum.coverage += of.coverage;
            sum.coverage_previous += of.coverage_previous;
            sum.gap_now += of.gap_now;
            sum.gap_previous += of.gap_previous;
            sum.gap_committed += of.gap_committed;
        });
        sum
    })
}

impl<const N: usize> Handles<N>
where
    Contact<N>: Create<N> + TakesLaw,
{
    pub fn new(scene: &Scene) -> std::result::Result<Handles<N>, Refused> {
        let (c, n1, n2) = (&scene.choice, scene.one.x.len(), scene.two.x.len());
        let parts = c.is("ranks", "parts");
        let shares = c.is("ranks", "sums");
        let middle = {
            let mut x: Vec<f64> = scene.one.x.iter().map(|x| x.x).collect();
            x.sort_by(f64::total_cmp);
            x[n1 / 2]
        };
        let owns: Vec<bool> = scene.one.x.iter().map(|x| !parts || x.x < middle).collect();
        let mut handles = Handles { all: Vec::new(), mortar: Vec::new(), owns, shares };
        for k in 0..if parts || shares { 2 } else { 1 } {
            let half = scene.two.facets.len() / 2;
            let facets: Vec<usize> = if !shares {
                (0..scene.two.facets.len()).collect()
            } else if k == 0 {
                (0..half).collect()
            } else {
                (half..scene.two.facets.len()).collect()
            };
            let (two, kept) = match c.is_analytic() {
                true => (scene.two.clone(), (0..n2).collect()),
                false => submesh(&scene.two, &facets),
            };
            let owner = |owns: bool| match (parts, shares) {
                (true, _) if owns != (k == 0) => Owner::Elsewhere,
                (_, true) if k == 1 => Owner::Shared,
                _ => Owner::Here,
            };
            let owners = (parts || shares).then(|| handles.owns.iter().map(|&owns| owner(owns)).collect());
            handles.all.push(dressed(scene, &two, &kept, owners)?);
            handles.mortar.push(kept);
        }
        Ok(handles)
    }

    pub fn sums(&mut self, at: &At<N>) -> Result<Option<Vec<NodeSums>>> {
        if !self.shares {
            return Ok(None);
        }
        let each = self.all.iter_mut().zip(&self.mortar);
        let all: Result<Vec<_>> = each.map(|(handle, kept)| handle.share_of_sums(&at.x1, &of(kept, &at.x2))).collect();
        Ok(sum(all?))
    }

    /// What each handle is asked, with its mortar nodes.
    pub fn each<T>(
        &mut self,
        at: &At<N>,
        mut ask: impl FnMut(&mut Contact<N>, &[Vec3], &[usize], Option<&[NodeSums]>) -> Result<T>,
    ) -> Result<Vec<T>> {
        let sums = self.sums(at)?;
        let each = self.all.iter_mut().zip(&self.mortar);
        each.map(|(handle, kept)| ask(handle, &of(kept, &at.x2), kept, sums.as_deref())).collect()
    }

    /// Forces of both sides and rows, one after the other.
    pub fn residual(&mut self, at: &At<N>) -> Result<Vec<f64>> {
        let (n1, n) = (at.x1.len(), at.x1.len() + at.x2.len());
        let mut r = vec![0.0; 3 * n + N * n1];
        let parts = self
            .each(at, |handle, x2, kept, sums| Ok((handle.residual(&at.x1, x2, &at.lambda, sums)?, kept.to_vec())))?;
        for (of, kept) in parts {
            let nodes = (0..n1).chain(kept.iter().map(|k| n1 + k));
            for (node, force) in nodes.zip(of.nonmortar.iter().chain(&of.mortar)) {
                (0..3).for_each(|i| r[3 * node + i] += force[i]);
            }
            for (a, row) in of.rows.iter().enumerate() {
                (0..N).for_each(|i| r[3 * n + N * a + i] += row[i]);
            }
        }
        Ok(r)
    }

    /// The tangent's entries, which add up.
    pub fn tangent(&mut self, at: &At<N>, add: &mut dyn FnMut(usize, usize, f64)) -> Result<()> {
        self.each(at, |handle, x2, _, sums| {
            let mut sink = |i: i64, j: i64, v: f64| add(i as usize, j as usize, v);
            handle.tangent(&at.x1, x2, &at.lambda, sums, &mut sink)
        })
        .map(drop)
    }

    /// The law's answers, each node's from the handle where it acts.
    pub fn answers(&mut self, at: &At<N>) -> Result<Vec<NodeResponse<N>>> {
        let all = self.each(at, |handle, x2, _, sums| Ok(handle.evaluate(&at.x1, x2, &at.lambda, sums)?.1))?;
        Ok((0..at.x1.len()).map(|a| all[usize::from(!self.owns[a])][a]).collect())
    }

    pub fn commit(&mut self, at: &At<N>) -> Result<()> {
        self.each(at, |handle, x2, _, sums| handle.commit(&at.x1, x2, &at.lambda, sums)).map(drop)
    }

    pub fn roll_back(&mut self) -> Result<()> {
        self.all.iter_mut().try_for_each(Contact::roll_back)
    }

    /// Multipliers that follow from the host's forces at the non-mortar nodes.
    pub fn condensed_multipliers(&mut self, at: &At<N>, host: &[Vec3]) -> Result<Vec<SVector<f64, N>>> {
        let all = self.each(at, |handle, x2, _, _| handle.condensed_multipliers(&at.x1, x2, host))?;
        Ok((0..at.x1.len()).map(|a| all[usize::from(!self.owns[a])][a]).collect())
    }
}

pub fn of(kept: &[usize], x: &[Vec3]) -> Vec<Vec3> {
    kept.iter().map(|&k| x[k]).collect()
}

/// Offsets of the sides that have some.
pub fn offsets(choice: &Choice, n1: usize, kept: &[usize]) -> [Option<Vec<f64>>; 2] {
    let of = |k: usize| OFFSET * (1.0 + (k as f64).sin());
    [
        choice.is("offsets", "nonmortar").then(|| (0..n1).map(of).collect()),
        choice.is("offsets", "mortar").then(|| kept.iter().map(|&k| of(k)).collect()),
    ]
}

/// A handle, with all that is set of it.
fn dressed<const N: usize>(
    scene: &Scene,
    two: &crate::support::mesh::Mesh,
    kept: &[usize],
    owners: Option<Vec<Owner>>,
) -> std::result::Result<Contact<N>, Refused>
where
    Contact<N>: Create<N> + TakesLaw,
{
    let (c, n1) = (&scene.choice, scene.one.x.len());
    let (one, two) = when(Asked::Created, scene.surfaces(two, kept))?;
    let mut contact = when(Asked::Created, Contact::create(one, two, scene.multipliers(), scene.options()))?;
    if let Some(own) = own_law(c) {
        when(Asked::Law, contact.take(own))?;
    }
    if let Some(layer) = layer(c) {
        when(Asked::Layer, contact.take_layer(layer))?;
    }
    if !c.is("derivatives", "no") {
        when(Asked::Created, contact.set_augmentation(Some(vec![AUGMENTATION; n1])))?;
    }
    let of = offsets(c, n1, kept);
    if of.iter().any(Option::is_some) {
        when(Asked::Offsets, contact.set_offsets(of))?;
    }
    if c.is("extra", "normals") {
        let normal = |k: usize| (-scene.down() + 0.02 * (1.3 * k as f64).sin() * Vec3::x()).normalize();
        when(Asked::Normals, contact.set_normals(Some((0..n1).map(normal).collect())))?;
    }
    if c.is("extra", "constraints") {
        let first = (0..n1).find(|&a| scene.has_row[a]).unwrap();
        when(Asked::Constraints, contact.set_constraints(&[(first, Vec3::new(1.0, 0.0, 0.0))]))?;
    }
    if let Some(owners) = owners {
        when(Asked::Owners, contact.set_owners(owners))?;
    }
    Ok(contact)
}
