//! Laws beside Coulomb's that a host gives to an interface: thresholds k(sigma_N, slip, state) and, of the orthotropic one, an
//! ellipse (docs/formulation 4.8). Their numbers in histories follow those of the table's laws.

use super::projection::Threshold;
use super::question::{Answer, Question};
use super::rate;
use super::special::Ellipse;
use super::table::LAWS;
use super::weakening;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;

/// A law of one's own, for an interface under Coulomb's law, in place of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Own {
    /// k = c - mu sigma_N.
    Cohesion {
        /// c >= 0 [F/L^2].
        cohesion: f64,
    },
    /// mu falls with the way that has been slipped, down to another one.
    Weakening {
        /// The coefficient from the critical slip on.
        after: f64,
        /// The critical slip, > 0 `[L]`.
        slip: f64,
    },
    /// mu falls with the velocity of slip, towards another one.
    Rate {
        /// The coefficient of fast slip.
        after: f64,
        /// The velocity over which a share of 1/e is left of the difference, > 0 [L/T].
        rate: f64,
        /// How long the step takes, > 0 \[T\].
        time: f64,
    },
    /// mu along a direction, another coefficient across it.
    Orthotropic(Ellipse),
    /// What a function of the host says.
    Host(Host),
}

/// A function of the host, by words that who has made them understands.
#[derive(Clone, Copy, Debug)]
pub struct Host {
    /// Asks the host; writes what the law would remember if the step ended here. `Err`: why it has no answer.
    pub ask: fn(&Host, &Question, &mut [f64]) -> Result<Answer>,
    /// What `ask` knows the host by.
    pub words: [usize; 2],
    /// Numbers that are remembered of each node.
    pub states: usize,
    /// What it adds to the numbers of nodes.
    pub base: i64,
}

impl PartialEq for Host {
    fn eq(&self, other: &Host) -> bool {
        (self.words, self.states, self.base) == (other.words, other.states, other.base)
    }
}

/// Names in sentences, in the order of [`Own`].
pub const OWN_NAMES: [&str; 5] = [
    "cohesion",
    "weakening friction",
    "orthotropic friction",
    "the host's own law",
    "friction that follows the rate of slip",
];

/// -dk / dsigma_N may be below zero by the rounding of a derivative that should be none.
const ROUNDING_OF_FALL: f64 = 1e-12;

impl Own {
    /// Its number in histories.
    pub fn number(&self) -> usize {
        let place = match self {
            Own::Cohesion { .. } => 0,
            Own::Weakening { .. } => 1,
            Own::Orthotropic(_) => 2,
            Own::Host(_) => 3,
            Own::Rate { .. } => 4,
        };
        LAWS.len() + place
    }

    /// Numbers that it remembers of each node.
    pub fn states(&self) -> usize {
        match self {
            Own::Cohesion { .. } | Own::Orthotropic(_) | Own::Rate { .. } => 0,
            Own::Weakening { .. } => 1,
            Own::Host(host) => host.states,
        }
    }

    /// Whether what is remembered changes in slip alone: a node that sticks slips by rounding.
    pub fn ages_by_slip(&self) -> bool {
        matches!(self, Own::Weakening { .. })
    }

    /// Refuses numbers outside their range.
    pub fn validate(&self) -> Result<()> {
        let refuse = |name: &str, v: f64, allowed: &str| {
            let kind = if v.is_finite() { Kind::InvalidValue } else { Kind::NotFinite };
            Err(Error::new(kind, text!("law.{name} is {v}; it must be {allowed}")))
        };
        match *self {
            Own::Cohesion { cohesion } if !(cohesion >= 0.0 && cohesion.is_finite()) => {
                refuse("cohesion", cohesion, "finite and not negative")
            }
            Own::Rate { after, .. } if !(after >= 0.0 && after.is_finite()) => {
                refuse("mu_after", after, "finite and not negative")
            }
            Own::Rate { rate, .. } if !(rate > 0.0 && rate.is_finite()) => {
                refuse("critical_rate", rate, "positive and finite")
            }
            Own::Rate { time, .. } if !(time > 0.0 && time.is_finite()) => refuse("time", time, "positive and finite"),
            Own::Weakening { after, .. } if !(after >= 0.0 && after.is_finite()) => {
                refuse("mu_after", after, "finite and not negative")
            }
            Own::Weakening { slip, .. } if !(slip > 0.0 && slip.is_finite()) => {
                refuse("critical_slip", slip, "positive and finite")
            }
            Own::Orthotropic(ellipse) if !(ellipse.across > 0.0 && ellipse.across.is_finite()) => {
                refuse("mu_across", ellipse.across, "positive and finite")
            }
            Own::Orthotropic(ellipse) if !(ellipse.direction.norm() > 0.0 && ellipse.direction.norm().is_finite()) => {
                refuse("direction, its length,", ellipse.direction.norm(), "positive and finite")
            }
            _ => Ok(()),
        }
    }

    /// The threshold, and in `states` what is remembered if the step ends here.
    ///
    /// # Errors
    /// The host's refusal; a threshold that is not finite, negative, or falls where the pressure rises. The node is named.
    pub fn answer(&self, question: &Question, states: &mut [f64]) -> Result<Answer> {
        match *self {
            Own::Cohesion { cohesion } => {
                let cone = Threshold::cone(question.mu, question.normal);
                Ok(Answer { threshold: Threshold { radius: cohesion + cone.radius, ..cone }, slope: Vec3::zeros() })
            }
            Own::Weakening { after, slip } => Ok(weakening::answer((after, slip), question, states)),
            Own::Rate { after, rate, time } => Ok(rate::answer((after, rate * time), question)),
            // Not a threshold: the node is told the ellipse.
            Own::Orthotropic(_) => {
                Ok(Answer { threshold: Threshold::cone(question.mu, question.normal), slope: Vec3::zeros() })
            }
            Own::Host(host) => {
                let answer = (host.ask)(&host, question, states)?;
                check(&answer, question, states)?;
                Ok(answer)
            }
        }
    }
}

/// Refuses an answer that no evaluation could use.
fn check(answer: &Answer, question: &Question, states: &[f64]) -> Result<()> {
    let (a, Answer { threshold: k, slope }) = (question.node, answer);
    let numbers = [("threshold", k.radius), ("dthreshold_dnormal", k.fall)];
    let slopes = slope.iter().map(|v| ("dthreshold_dslip", *v));
    let not_finite = numbers.into_iter().chain(slopes).chain(states.iter().map(|v| ("states_after", *v)));
    if let Some((name, v)) = not_finite.into_iter().find(|(_, v)| !v.is_finite()) {
        let text = text!("the host's law says {name} {v} at non-mortar node {a}; it must be finite");
        return Err(Error::new(Kind::NotFinite, text));
    }
    if k.radius < 0.0 {
        let text =
            text!("the host's law says a threshold of {} at non-mortar node {a}; it must not be negative", k.radius);
        return Err(Error::new(Kind::InvalidValue, text));
    }
    if k.fall < -ROUNDING_OF_FALL {
        let text = text!(
            "the host's law says a threshold that falls where the pressure rises, dthreshold_dnormal {} at non-mortar node {a}: one shear traction would be slip at two pressures; it must not be positive",
            -k.fall
        );
        return Err(Error::new(Kind::InvalidValue, text));
    }
    Ok(())
}
