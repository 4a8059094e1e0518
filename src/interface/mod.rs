//! Two surfaces in contact: search, pairing, all four stages, history (docs/formulation.md 4.5).
//!
//! Residual and tangent are functions of (x, lambda, committed history) alone. The only place of the
//! core that allocates.

mod analytic;
mod apart;
mod assembly;
mod augmented;
mod bytes;
mod carried;
mod checksum;
mod closing;
mod crease;
mod crosspoints;
mod depth;
mod describe;
mod diagnosis;
mod effects;
mod emission;
mod equilibrium;
mod extent;
mod facet_gaps;
mod filter;
mod history;
mod hybrid;
mod integration;
mod layers;
mod lost;
mod meaning;
mod mistakes;
mod nodes;
mod numbering;
mod options;
mod overrides;
mod reach;
mod report;
mod restart;
mod search;
mod surface;
mod treatment;
mod turn;
mod weak;

pub use assembly::Residual;
pub use checksum::seal_history;
pub use crease::Split;
pub use crosspoints::{Crosspoint, InterfaceNodes, crosspoints};
pub use diagnosis::{Cause, Diagnosis, SUSPECT, Suspect, WorstPair};
pub use emission::Sink;
pub use equilibrium::{Equilibrium, Largest, ROUNDINGS, Scales};
pub use extent::Extent;
pub use facet_gaps::FacetGaps;
pub use history::{History, PairRecord};
pub use nodes::NodeSums;
pub use options::{
    COVERAGE_MIN, Form, Friction, MODULUS_FACTOR, MortarSide, NewContact, Options, RowScale, Scheme, Shortcuts,
    Stiffness, TURN_MAX, Tangent, Weights,
};
pub use report::{Cover, Finding, NodeCover, Report};
pub use surface::{FacetNodes, NO_EQUATION, Surface};
pub use treatment::NodeCounts;

use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::memory::{self, Stored};
use effects::Kernels;
use filter::Filter;
use history::Keeps;
use integration::{Integration, KeptTree, Start};
use nalgebra::SVector;

/// What an interface has done since its creation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counters {
    /// Pairs whose boxes met.
    pub pairs_tested: i64,
    /// Pairs that overlapped or touched.
    pub pairs_clipped: i64,
    /// Pairs with an area.
    pub pairs_integrated: i64,
    /// Pairs whose weights were differentiated.
    pub pairs_linearised: i64,
    /// Searches.
    pub searches: i64,
    /// Boxes that the searches compared.
    pub boxes_visited: i64,
    /// Pairs whose frozen weights served once more.
    pub pairs_reused: i64,
    /// Nodes whose slip was computed.
    pub nodes_slipping: i64,
    /// Nodes about which the law was asked.
    pub nodes_evaluated: i64,
    /// How the nodes were treated at the last evaluation.
    pub nodes: NodeCounts,
    /// Pairs active at the last evaluation, commit or creation.
    pub pairs_active: usize,
    /// Evaluations, and commits, that ended with the finding that the surfaces are apart.
    pub evaluations_apart: i64,
    /// See `evaluations_apart`.
    pub commits_apart: i64,
    /// Seconds in search.
    pub seconds_search: f64,
    /// Seconds in clipping and integration.
    pub seconds_integration: f64,
    /// Seconds in derivatives and assembly.
    pub seconds_assembly: f64,
}

/// An interface with three multipliers per non-mortar node.
pub type Interface = Contact<3>;

/// What follows from a history: the filter of the step that begins with it, and what that says of the nodes.
struct Prepared {
    filter: Option<Filter>,
    coverable: Vec<bool>,
    carriers: Vec<Vec<weak::Carrier>>,
}

/// A contact interface with N multipliers per non-mortar node: three, or one along the normal without friction. One
/// thread at a time; distinct interfaces are independent.
#[derive(Debug)]
pub struct Contact<const N: usize> {
    options: Options,
    kernels: Kernels<N>,
    nonmortar: Surface,
    mortar: Surface,
    multiplier_equations: Vec<[i64; N]>,
    owned: Vec<bool>,
    coverable: Vec<bool>,
    carriers: Vec<Vec<weak::Carrier>>,
    mu: Vec<f64>,
    augmentations: Option<Vec<f64>>,
    normals: Option<Vec<Vec3>>,
    free: Vec<Mat3>,
    filter: Option<Filter>,
    history: History,
    rollback: Option<History>,
    integration: Option<Integration>,
    tree: KeptTree,
    counters: Counters,
}

impl Contact<3> {
    /// An interface whose t_n is the surfaces' reference configuration.
    ///
    /// `multiplier_equations`: per non-mortar node and component, 0-based or [`NO_EQUATION`].
    pub fn new(
        nonmortar: Surface,
        mortar: Surface,
        multiplier_equations: Vec<[i64; 3]>,
        options: Options,
    ) -> Result<Interface> {
        let mu = if options.friction == Friction::Rough { f64::INFINITY } else { options.mu };
        let mu = memory::filled(mu, nonmortar.len())?;
        let kernels = effects::choose_three(&options, &mortar, &mu);
        Self::build((nonmortar, mortar), multiplier_equations, options, mu, kernels)
    }
}

impl Contact<1> {
    /// A frictionless interface whose t_n is the surfaces' reference configuration.
    ///
    /// `multiplier_equations`: per non-mortar node, 0-based or [`NO_EQUATION`].
    pub fn frictionless(
        nonmortar: Surface,
        mortar: Surface,
        multiplier_equations: Vec<[i64; 1]>,
        options: Options,
    ) -> Result<Contact<1>> {
        let options = Options { friction: Friction::None, ..options };
        let kernels = effects::choose_one(&options, &mortar);
        let mu = memory::filled(0.0, nonmortar.len())?;
        Self::build((nonmortar, mortar), multiplier_equations, options, mu, kernels)
    }
}

impl<const N: usize> Contact<N> {
    fn build(
        (nonmortar, mortar): (Surface, Surface),
        multiplier_equations: Vec<[i64; N]>,
        options: Options,
        mu: Vec<f64>,
        kernels: Kernels<N>,
    ) -> Result<Contact<N>> {
        options.validate()?;
        if multiplier_equations.len() != nonmortar.len() {
            let text = text!(
                "{} nodes have multiplier equations; nonmortar has {}",
                multiplier_equations.len(),
                nonmortar.len()
            );
            return Err(Error::new(Kind::InvalidSize, text));
        }
        numbering::check(&multiplier_equations, [&nonmortar, &mortar])?;
        if options.mortar_side == MortarSide::Rigid
            && let Some(k) = mortar.equations.iter().position(|e| e.iter().any(|&e| e != NO_EQUATION))
        {
            let text = text!("the mortar side is rigid, but its node {k} has an equation; give it none (-1)");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        if nonmortar.analytic.is_some() {
            let text = "nonmortar is an analytic surface; only the mortar side can be one";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        integration::check_mortar_facets(&mortar)?;
        analytic::check_frame(&nonmortar, &mortar)?;
        let (mut counters, mut tree) = (Counters::default(), KeptTree::default());
        let (surfaces, at) = ((&nonmortar, &mortar), (&nonmortar.reference[..], &mortar.reference[..]));
        let start = Self::start_at(surfaces, &options, Extent::Whole, (&mut counters, &mut tree), at)?;
        let n1 = nonmortar.len();
        let mut interface = Contact {
            options,
            kernels,
            nonmortar,
            mortar,
            multiplier_equations,
            owned: memory::filled(true, n1)?,
            coverable: Vec::new(),
            carriers: Vec::new(),
            mu,
            augmentations: None,
            normals: None,
            free: memory::filled(Mat3::identity(), n1)?,
            filter: start.filter,
            history: start.history,
            rollback: None,
            integration: None,
            tree,
            counters,
        };
        interface.coverable = interface.find_coverable(interface.filter.as_ref(), &interface.history)?;
        interface.carriers = interface.find_carriers(&interface.history, &interface.coverable)?;
        interface.set_constraints(&[])?; // those that follow from removed equations
        interface.integration = start.integration;
        interface.count_pairs();
        Ok(interface)
    }

    /// Puts a history in place with what belongs to its configuration; gives the old one back.
    fn adopt(&mut self, start: Start) -> Result<History> {
        let ready = self.prepare(start.filter, &start.history)?;
        Ok(self.put_in_place(ready, start.history, start.integration))
    }

    /// What follows from a history and its filter.
    fn prepare(&self, filter: Option<Filter>, history: &History) -> Result<Prepared> {
        let coverable = self.find_coverable(filter.as_ref(), history)?;
        let carriers = self.find_carriers(history, &coverable)?;
        Ok(Prepared { filter, coverable, carriers })
    }

    /// Puts a history in place that is not of now, and after which no commit can be undone.
    fn restore(&mut self, history: History) -> Result<()> {
        let ready = self.prepare_again(&history)?;
        self.put_in_place(ready, history, None);
        self.rollback = None;
        Ok(())
    }

    fn put_in_place(&mut self, ready: Prepared, history: History, integration: Option<Integration>) -> History {
        self.filter = ready.filter;
        self.coverable = ready.coverable;
        self.carriers = ready.carriers;
        self.integration = integration;
        std::mem::replace(&mut self.history, history)
    }

    fn find_coverable(&self, filter: Option<&Filter>, history: &History) -> Result<Vec<bool>> {
        let frozen = self.options.effective_weights() != Weights::Current;
        let pairs = frozen.then_some(&history.pairs[..]);
        reach::coverable(&self.nonmortar, filter, pairs)
    }

    /// What follows from a history that is not of now; its positions may be refused.
    fn prepare_again(&self, history: &History) -> Result<Prepared> {
        let current = self.options.effective_weights() == Weights::Current;
        let filter = current
            .then(|| Filter::new(&self.nonmortar, &self.mortar, &self.options, &history.x1, &history.x2))
            .transpose()?;
        self.prepare(filter, history)
    }

    /// Takes (x1, x2) as the configuration of t_n, with nothing slipped yet, instead of the reference.
    pub fn set_previous(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<()> {
        self.check_positions(x1, x2)?;
        let surfaces = (&self.nonmortar, &self.mortar);
        let kept = (&mut self.counters, &mut self.tree);
        let new = Self::start_at(surfaces, &self.options, Extent::Whole, kept, (x1, x2))?;
        new.history.check_finite()?;
        self.adopt(new)?;
        self.count_pairs();
        self.rollback = None;
        Ok(())
    }

    /// Accepts a converged step: (x1, x2) becomes t_n.
    pub fn commit(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<()> {
        let extent = Extent::of(sums);
        let shared = sums.is_some();
        let (sums, responses) = self.evaluate(x1, x2, lambda, sums)?;
        self.refuse_turn(x1, x2, shared)?;
        let surfaces = (&self.nonmortar, &self.mortar);
        let mut new = if self.options.effective_weights() == Weights::Reference {
            let mut history = self.history.moved_to(x1, x2)?;
            // Also where mu is 0 at every node: it may be set before the next step. Tied nodes keep their first gap.
            if self.history.keeps == Keeps::Slip {
                let moved = nodes::assemble(surfaces, &self.history.pairs, x1, x2)?;
                history.gap = moved.into_iter().map(|(_, gap)| gap).stored()?;
            }
            Start { history, filter: None, integration: None }
        } else {
            Self::start_at(surfaces, &self.options, extent, (&mut self.counters, &mut self.tree), (x1, x2))?
        };
        self.refuse_lost_contact(&new, (x1, x2), &responses)?;
        new.history.commits = self.history.commits.saturating_add(1); // an imported history may hold any number
        if self.kernels.slips {
            let slip = |a: usize| self.slip_after(a, &responses[a], sums[a].coverage_previous);
            new.history.slip = (0..responses.len()).map(slip).stored()?;
        } else {
            new.history.slip = memory::copied(&self.history.slip)?;
        }
        new.history.check_finite()?;
        self.rollback = Some(self.adopt(new)?);
        self.count_pairs();
        Ok(())
    }

    /// Slip of node A since the first configuration `[L]`, this step's included.
    /// g_T is weighted with n(t_n), so it is a length times `coverage_previous`, the covered area of t_n.
    /// An open node moves without slipping.
    pub fn slip_after(&self, a: usize, response: &crate::law::NodeResponse<N>, coverage_previous: f64) -> Vec3 {
        let closed = response.state != crate::law::State::Gap;
        let step = if closed && coverage_previous > 0.0 { response.slip / coverage_previous } else { Vec3::zeros() };
        self.history.slip.get(a).map_or(step, |slip| slip + step)
    }

    /// Undoes the last commit exactly.
    ///
    /// # Errors
    /// [`Kind::NothingToRollBack`] when there is none; only one commit can be undone.
    pub fn roll_back(&mut self) -> Result<()> {
        let Some(history) = &self.rollback else {
            let text = "no commit can be undone: none was made since creation, import or the last rollback";
            return Err(Error::new(Kind::NothingToRollBack, text));
        };
        let ready = self.prepare_again(history)?;
        if let Some(history) = self.rollback.take() {
            self.put_in_place(ready, history, None);
        }
        Ok(())
    }

    /// Multipliers per non-mortar node, N.
    pub fn components(&self) -> usize {
        N
    }

    /// Multiplier equations.
    pub fn multipliers(&self) -> usize {
        self.multiplier_equations.as_flattened().iter().filter(|&&e| e != NO_EQUATION).count()
    }

    /// The options.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The non-mortar and the mortar surface.
    pub fn surfaces(&self) -> (&Surface, &Surface) {
        (&self.nonmortar, &self.mortar)
    }

    /// The committed history.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// What has been done so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Pairs active at the last evaluation, commit or creation.
    pub fn active_pairs(&self) -> usize {
        self.counters.pairs_active
    }
}
