//! A law of one's own through the handle: what it is, and what it remembers (docs/formulation 4.8).

use super::compose::Feature;
use super::contact::Contact;
use super::data::options::Friction;
use crate::error::{Error, Kind, Result};
use crate::law::Own;

impl Contact<3> {
    /// The law in place of Coulomb's, from the next evaluation on; `None`: Coulomb's. What another law has remembered is
    /// forgotten, and a commit before it can no longer be undone; a law of the same kind, with as many states, goes on with them.
    pub fn set_law(&mut self, own: Option<Own>) -> Result<()> {
        let options = &self.setup.options;
        if options.friction != Friction::Coulomb {
            let text = text!(
                "a law of one's own stands in place of Coulomb's: create the interface with STICKSLIP_FRICTION_COULOMB; this one has {}",
                options.friction.law().name
            );
            return Err(Error::new(Kind::InvalidValue, text));
        }
        own.as_ref().map_or(Ok(()), Own::validate)?;
        let is_orthotropic = matches!(own, Some(Own::Orthotropic(_)));
        self.setup.refuse(&[(Feature::OwnLaw, own.is_some()), (Feature::Orthotropic, is_orthotropic)])?;
        let kind = |own: &Option<Own>| own.map(|own| (own.number(), own.states()));
        if kind(&own) != kind(&self.setup.own) {
            let new = [own.map_or(0, |own| own.states()), self.setup.states()[1]];
            self.step.history.states = self.setup.states_of([None, Some(&self.step.history.states)], new)?;
            self.rollback = None;
        }
        self.setup.own = own;
        self.renew_effects();
        self.cache.forget();
        self.linear.forget();
        Ok(())
    }
}

impl<const N: usize> Contact<N> {
    /// What is remembered of each node at t_n, by the law, then by what lies between the surfaces; empty where nothing is.
    pub fn law_states(&self) -> &[f64] {
        if self.remembers() { &self.step.history.states } else { &[] }
    }

    /// Whether states are of nodes.
    fn remembers(&self) -> bool {
        self.setup.own.is_some() || self.setup.layer.is_some()
    }

    /// Replaces that, as after [`Contact::set_committed`]. No commit can then be undone.
    pub fn set_law_states(&mut self, states: &[f64]) -> Result<()> {
        let kept: &mut [f64] = if self.remembers() { &mut self.step.history.states } else { &mut [] };
        if states.len() != kept.len() {
            let text = text!("states has {} entries; the law remembers {}", states.len(), kept.len());
            return Err(Error::new(Kind::InvalidSize, text));
        }
        if let Some(k) = states.iter().position(|v| !v.is_finite()) {
            return Err(Error::new(Kind::NotFinite, text!("states[{k}] is {}; it must be finite", states[k])));
        }
        kept.copy_from_slice(states);
        self.setup.nonmortar.layer = self.layer_reach(&self.step.history.states);
        self.rollback = None;
        self.cache.forget();
        Ok(())
    }
}
