//! What gives a history its meaning: of another interface the same numbers would say something else. Facets and their
//! kinds, the first configuration, the law, the multiplier's basis and whether points decide, the weights, the slip measure, the shape of an
//! analytic mortar side. Not mu, augmentation, tolerances and forms: a run may go on with others.

use super::checksum::of_words;
use super::options::{Options, Weights};
use super::surface::Surface;
use crate::error::{Error, Kind, Result, Text};
use crate::geometry::AnalyticShape;
use crate::law::{LAWS, OWN_NAMES, Own, Remembers, SlipMeasure};
use crate::line::Measure;

/// Integers of a meaning.
pub const LENGTH: usize = 8;

/// By [`MultiplierBasis`](super::options::MultiplierBasis), and with [`Decision::Points`].
const BASES: [&str; 3] =
    ["the standard multiplier basis", "the dual multiplier basis", "points that decide (method.decision)"];
const POINTS: i64 = 2;
const WEIGHTS: [&str; 5] = [
    "weights of now",
    "weights frozen at the last commit",
    "weights of the first configuration",
    "weights that this version does not have",
    "weights of now, whose forces are discrete derivatives of the gaps",
];
const SLIPS: [&str; 4] = ["no slip", "the objective slip measure", "the slip increment", "the paper's slip measure"];

/// The choices, each with the names of its values, then shape, radius, facets and coordinates.
pub fn of(options: &Options, own: Option<&Own>, (nonmortar, mortar): (&Surface, &Surface)) -> [i64; LENGTH] {
    let law = options.friction.law();
    let weights = match options.effective_weights() {
        _ if options.conserves() => 4,
        Weights::Current | Weights::Conserving => 0,
        Weights::Committed => 1,
        Weights::Reference => 2,
    };
    let slip = match (law.remembers == Remembers::Slip, options.effective_slip()) {
        (false, _) => 0,
        (_, SlipMeasure::Objective) => 1,
        (_, SlipMeasure::Increment) => 2,
        (_, SlipMeasure::Paper) => 3,
    };
    let [shape, radius] = mortar.analytic.map_or([0; 2], |shape| {
        let [kind, radius] = AnalyticShape::words(shape);
        [kind + 1, radius]
    });
    let sides = [nonmortar, mortar];
    let facets = sides.iter().flat_map(|s| {
        let facets = s.facets.iter().flat_map(|f| std::iter::once(f.len).chain(f.nodes));
        // Of parents the nodes of their parts, how many these are, and where the multipliers stand.
        let parents = s.parents.iter().flat_map(|p| {
            let kinds = p.facets.iter().map(|f| f.parent.n);
            std::iter::once(p.space as usize).chain(kinds)
        });
        // Of lines what their lengths stand for.
        let measure = s.lines().into_iter().map(|lines| match lines.measure {
            Measure::Axisymmetric => u64::MAX,
            Measure::Thickness(thickness) => thickness.to_bits(),
        });
        std::iter::once(s.facets.len()).chain(facets).chain(parents).map(|word| word as u64).chain(measure)
    });
    // 0 and -0 are one place: a text file may not tell them apart.
    let coordinates = sides.iter().flat_map(|s| s.reference.iter().flatten().map(|v| (v + 0.0).to_bits()));
    [
        own.map_or(law.friction as usize, Own::number) as i64,
        if options.decides_at_points() { POINTS } else { options.basis as i64 },
        weights,
        slip,
        shape as i64,
        radius as i64,
        of_words(facets) as i64,
        of_words(coordinates) as i64,
    ]
}

/// Refuses a history whose meaning is another one, saying what differs.
pub fn check(found: &[i64; LENGTH], own: &[i64; LENGTH]) -> Result<()> {
    let refuse = |text: Text| Err(Error::new(Kind::HistoryMismatch, text));
    let name = |names: &[&'static str], value: i64| {
        usize::try_from(value).ok().and_then(|k| names.get(k).copied()).unwrap_or("something unknown")
    };
    let mut laws = [""; LAWS.len() + OWN_NAMES.len()];
    let names = LAWS.iter().map(|law| law.name).chain(OWN_NAMES);
    laws.iter_mut().zip(names).for_each(|(to, name)| *to = name);
    for (k, names) in [&laws[..], &BASES, &WEIGHTS, &SLIPS].into_iter().enumerate() {
        if found[k] != own[k] {
            let (theirs, ours) = (name(names, found[k]), name(names, own[k]));
            return refuse(text!("the history is one with {theirs}, the interface one with {ours}"));
        }
    }
    if found[4..6] != own[4..6] {
        return refuse("the history was made with another shape or radius of the mortar side".into());
    }
    if found[6] != own[6] {
        return refuse("the history was made with other facets, or with the same in another order".into());
    }
    if found[7] != own[7] {
        let text = "the history was made on another mesh: coordinates of the first configuration differ, be it in their \
                    last digit; create the interface from the same numbers (17 digits keep a double)";
        return refuse(text.into());
    }
    Ok(())
}
