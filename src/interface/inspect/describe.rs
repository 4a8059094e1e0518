//! What an interface computes and why, one sentence an effect, for a host's log.

use crate::error::{Result, Text};
use crate::interface::data::options::{MortarSide, MultiplierBasis, Scheme, Tangent, Weights};
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::NO_EQUATION;
use crate::law::{Coefficient, Own};
use crate::mortar::MultiplierSpace;

/// A sentence, if there is memory for it.
macro_rules! say {
    ($($what:tt)*) => { Text::try_of(format_args!($($what)*)) };
}

/// One sentence per effect: what is computed, and whether the options ask for it or the scene lets the library
/// choose it.
///
/// # Errors
/// [`crate::error::Kind::OutOfMemory`].
pub fn effects<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    let mut text = friction_sentence(setup)?;
    let sentences = [
        mortar_sentence(setup)?,
        weights_sentence(setup)?,
        apart_sentence(setup)?,
        uncovered_sentence(setup)?,
        integration_sentence(setup)?,
    ];
    for sentence in sentences {
        text.append(format_args!(" {sentence}"))?;
    }
    if setup.nonmortar.parents.is_some() {
        let corner = setup.options.space == MultiplierSpace::Corner;
        let nodes = if corner { "the corners (default)" } else { "all nodes (asked for)" };
        text.append(format_args!(" Multipliers of quadratic facets: at {nodes}."))?;
    }
    text.append(format_args!(
        " Multipliers: {}.",
        if setup.options.basis == MultiplierBasis::Dual { "dual" } else { "standard" }
    ))?;
    if setup.decides_at_points() {
        text.append(format_args!(" Decision: at points (asked for)."))?;
    }
    if setup.options.friction.law().opens {
        text.append(format_args!(" Normals: {}.", normals_words(setup)))?;
    }
    text.append(format_args!("{}", weak_sentence(setup)?))?;
    if let Some(layer) = &setup.layer {
        let parts = [
            (layer.overclosure.is_some(), " yields by a table"),
            (layer.wear.is_some(), " wears"),
            (layer.bond.is_some(), " is bonded"),
        ];
        text.append(format_args!(" What lies between the surfaces (asked for):"))?;
        for (_, what) in parts.iter().filter(|(is_there, _)| *is_there) {
            text.append(format_args!("{what},"))?;
        }
        text.append(format_args!(" {} numbers remembered a node.", layer.states()))?;
    }
    Ok(text)
}

/// Which normals, and why not those of now where the library chose.
fn normals_words<const N: usize>(setup: &Setup<N>) -> &'static str {
    match (setup.options.follows_normals(), setup.options.normals_yield) {
        _ if setup.nodes.normals.is_some() => "the host's",
        (true, _) => "of now, differentiated",
        (false, false) => "of the last commit (asked for)",
        (false, true) => "of the last commit (chosen: the weights are frozen)",
    }
}

/// Only where nodes are carried.
fn weak_sentence<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    let why = if setup.options.weak_coverage > 0.0 { "asked for" } else { "chosen: multipliers are dual" };
    match setup.options.effective_weak_coverage() {
        0.0 => Ok(Text::EMPTY),
        w => say!(" Nodes covered less than {w} of their best covered neighbour: carried by it ({why})."),
    }
}

fn friction_sentence<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    let unknowns = if N == 1 { "one multiplier a node, along the normal" } else { "three multipliers a node" };
    let law = setup.options.friction.law();
    let own = setup.own.as_ref().filter(|_| setup.effects.law.slips);
    let what: Text = match law.mu {
        _ if own.is_some() => own_law(setup)?,
        Coefficient::Always(_) => law.effect.into(),
        Coefficient::Given if !setup.effects.law.slips => "none (chosen: mu is 0 at every node), no slip".into(),
        Coefficient::Given => match setup.options.shear_limit {
            None => say!("{} {}", law.effect, mu_range(setup)?)?,
            Some(limit) => say!("{} {} and the limit {limit}", law.effect, mu_range(setup)?)?,
        },
    };
    say!("Friction: {what}; {unknowns}.")
}

fn own_law<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    let mu = mu_range(setup)?;
    match setup.own {
        Some(Own::Cohesion { cohesion }) => say!("Coulomb's law with mu {mu} and the cohesion {cohesion} (asked for)"),
        Some(Own::Weakening { after, slip }) => {
            say!("mu {mu}, which falls to {after} over a slip of {slip} (asked for)")
        }
        Some(Own::Rate { after, rate, time }) => {
            say!("mu {mu}, which falls to {after} over a rate of slip of {rate}, in a step of {time} (asked for)")
        }
        Some(Own::Orthotropic(ellipse)) => say!("orthotropic, mu {mu} along, {} across (asked for)", ellipse.across),
        Some(Own::Host(host)) => say!("a law of the host's, {} numbers remembered a node (asked for)", host.states),
        None => Ok(Text::EMPTY),
    }
}

fn mu_range<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    let (least, most) = setup.nodes.mu.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), &mu| (l.min(mu), m.max(mu)));
    if least == most { say!("{most}") } else { say!("from {least} to {most}") }
}

fn mortar_sentence<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    if let Some(shape) = setup.mortar.analytic {
        let equations =
            if setup.frame_moves() { "rows and columns of its frame" } else { "no rows and columns for it" };
        return say!("Mortar side: {shape} (asked for), no facets, no search, {equations}.");
    }
    let prescribed = setup.mortar.equations.iter().flatten().all(|&e| e == NO_EQUATION);
    let what = match (setup.options.mortar_side, setup.effects.moves()) {
        (MortarSide::Rigid, _) => "rigid (asked for), no rows and columns for it",
        (MortarSide::Deformable, false) => "rigid (chosen: no mortar node has an equation), no rows and columns for it",
        (MortarSide::Deformable, true) if prescribed => {
            "treated as deformable though no node of it has an equation (asked for)"
        }
        (MortarSide::Deformable, true) => "deformable",
    };
    say!("Mortar side: {what}.")
}

fn weights_sentence<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    let what = match setup.options.effective_weights() {
        _ if setup.options.conserves() => {
            "of now; forces are discrete derivatives of the gaps (asked for): contact gives no energy"
        }
        Weights::Current | Weights::Conserving => "of now, differentiated (large sliding)",
        Weights::Committed if setup.options.weights_yield => {
            "frozen at the last commit (chosen: points decide), reused within a step"
        }
        Weights::Committed => "frozen at the last commit (asked for), reused within a step",
        Weights::Reference if !setup.options.friction.law().opens => {
            "frozen at the first configuration (tied), always reused"
        }
        Weights::Reference => "frozen at the first configuration (asked for), always reused (small sliding)",
    };
    say!("Weights: {what}{}.", tangent_clause(setup))
}

/// What the tangent leaves out.
fn tangent_clause<const N: usize>(setup: &Setup<N>) -> &'static str {
    match (setup.options.effective_weights(), setup.options.tangent) {
        (Weights::Committed | Weights::Reference, _) | (_, Tangent::Exact) => "",
        (_, Tangent::FrozenWeights) => ", but not in the tangent (asked for): Newton's method is not quadratic",
        (_, Tangent::FrozenNormals) if setup.mortar.analytic.is_some() => "",
        (_, Tangent::FrozenNormals) => {
            ", but for the tilt of facets in the tangent (asked for): Newton's method is not quadratic"
        }
    }
}

fn integration_sentence<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    const NOT_EXACT: &str = "not exact across mortar edges: patch tests fail";
    let points = setup.options.rule.triangle.len();
    let degree = setup.options.rule.degree;
    let coarse = if degree < 4 { ", not exact on any facet (asked for): patch tests fail" } else { "" };
    let what: Text = match setup.options.scheme {
        _ if setup.mortar.analytic.is_some() => "over whole facets".into(),
        Scheme::Segments => say!("over triangles of each overlap, {points} points a triangle{coarse}")?,
        Scheme::Elements(line) => {
            say!("{0} x {0} points on each non-mortar facet (asked for), no clipping; {NOT_EXACT}", line.len())?
        }
        Scheme::Hybrid(line) => say!(
            "{0} x {0} points on each non-mortar facet, overlaps where it is partly covered (asked for); {NOT_EXACT}",
            line.len()
        )?,
    };
    say!("Integration: {what}.")
}

fn apart_sentence<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    let what = match (setup.options.effective_weights(), setup.options.shortcuts.apart) {
        (Weights::Current, true) if setup.mortar.analytic.is_some() => {
            "only the nodes' distances and normals are compared (chosen)"
        }
        (Weights::Current, false) if setup.mortar.analytic.is_some() => "integrated all the same (asked for)",
        (Weights::Current, true) => "only their boxes and normals are compared (chosen)",
        (Weights::Current, false) => "searched all the same (asked for)",
        _ => "nothing special, for frozen weights need no search",
    };
    say!("Surfaces that are apart: {what}.")
}

fn uncovered_sentence<const N: usize>(setup: &Setup<N>) -> Result<Text> {
    let what = match setup.options.shortcuts.uncovered {
        true => "no law (chosen), unless sums of several handles are given",
        false => "the law all the same (asked for)",
    };
    say!("Nodes that nothing can cover in a step: {what}.")
}
