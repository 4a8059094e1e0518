//! What lies between the surfaces, through the handle (docs/formulation 20).

use super::compose::Feature;
use super::contact::Contact;
use crate::error::{Error, Kind, Result};
use crate::law::{Layer, LayerState};

impl<const N: usize> Contact<N> {
    /// How far what lies between the surfaces reaches where this is remembered of the nodes: across gaps, and into each other.
    pub(super) fn layer_reach(&self, states: &[f64]) -> [f64; 2] {
        let Some(layer) = &self.setup.layer else { return [0.0; 2] };
        let [across, into] = layer.reach();
        let nodes = 0..self.setup.nonmortar.len();
        let worn = nodes.map(|a| layer.state(&states[self.setup.layer_states(a)]).worn).fold(0.0_f64, f64::max);
        [across, into + worn]
    }

    /// What has become of a node at t_n.
    pub fn layer_state(&self, a: usize) -> LayerState {
        let of = |layer: &Layer| layer.state(&self.step.history.states[self.setup.layer_states(a)]);
        self.setup.layer.as_ref().map_or_else(LayerState::default, of)
    }

    /// What would become of it if the step ended at the last point.
    pub fn layer_state_now(&self, a: usize) -> LayerState {
        let of = |layer: &Layer| layer.state(&self.cache.answers().responses.own.states[self.setup.layer_states(a)]);
        self.setup.layer.as_ref().map_or_else(LayerState::default, of)
    }

    fn put_layer(&mut self, layer: Option<Layer>) -> Result<()> {
        layer.as_ref().map_or(Ok(()), Layer::validate)?;
        let slips = layer.as_ref().is_some_and(Layer::slips);
        if N == 1 && slips {
            let text = "layer has wear or a bond, which need slip: create the interface with STICKSLIP_FRICTION_COULOMB (mu may be 0)";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        self.setup.refuse(&[(Feature::Layer, layer.is_some()), (Feature::LayerSlips, slips)])?;
        if layer.is_none() && self.setup.layer.is_none() {
            return Ok(());
        }
        let kind = |layer: &Option<Layer>| layer.as_ref().map(|layer| (layer.bond.is_some(), layer.wear.is_some()));
        let renews = kind(&layer) != kind(&self.setup.layer);
        let new = [self.setup.states()[0], layer.as_ref().map_or(0, Layer::states)];
        let known = Some(&self.step.history.states[..]);
        let states = self.setup.states_of([known, if renews { None } else { known }], new)?;
        let before = std::mem::replace(&mut self.setup.layer, layer);
        let old_states = std::mem::replace(&mut self.step.history.states, states);
        let old_reach = self.setup.nonmortar.layer;
        self.setup.nonmortar.layer = self.layer_reach(&self.step.history.states);
        if old_reach != self.setup.nonmortar.layer
            && let Err(error) = self.settle_again()
        {
            self.setup.layer = before;
            (self.step.history.states, self.setup.nonmortar.layer) = (old_states, old_reach);
            return Err(error);
        }
        if renews {
            self.rollback = None;
        }
        self.cache.forget();
        self.linear.forget();
        Ok(())
    }
}

impl Contact<3> {
    /// What lies between the surfaces from the next evaluation on; `None`: nothing. One that remembers other things than the one before
    /// begins anew, and no commit before it can be undone.
    pub fn set_layer(&mut self, layer: Option<Layer>) -> Result<()> {
        self.put_layer(layer)?;
        self.renew_effects();
        Ok(())
    }
}

impl Contact<1> {
    /// The same, of a layer that needs no slip.
    pub fn set_layer(&mut self, layer: Option<Layer>) -> Result<()> {
        self.put_layer(layer)
    }
}
