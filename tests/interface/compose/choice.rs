//! What is chosen, by words; and which features of `compose` an interface has with it, said once more and apart from the library.

use stickslip::interface::compose::{Feature, Features};

/// Each kind of choice with its values, the default first.
pub const DIMENSIONS: [(&str, &[&str]); 23] = [
    ("facet", &["quad4", "tri3", "tri6", "quad8", "quad9", "mixed", "line2p", "line3p", "line2a", "line3a"]),
    ("basis", &["standard", "dual"]),
    ("space", &["corner", "sub"]),
    ("normals", &["committed", "current"]),
    ("decision", &["nodes", "points"]),
    ("form", &["multiplier", "augmented"]),
    ("weights", &["current", "committed", "reference", "conserving"]),
    ("slip", &["objective", "increment", "paper"]),
    (
        "law",
        &["coulomb", "none", "mu0", "tresca", "tied", "rough", "own", "cohesion", "weakening", "orthotropic", "rate"],
    ),
    ("layer", &["no", "overclosure", "wear", "bond", "all"]),
    ("mortar", &["deformable", "rigid", "plane", "sphere", "cylinder", "mplane", "msphere", "mcylinder"]),
    ("system", &["multipliers", "condensed", "inplace"]),
    ("heat", &["no", "temperatures", "all"]),
    ("offsets", &["no", "nonmortar", "mortar"]),
    ("weak", &["default", "none", "half"]),
    ("ranks", &["one", "parts", "sums"]),
    ("threads", &["1", "4"]),
    ("integration", &["segments", "elements", "hybrid"]),
    ("tangent", &["exact", "frozen_weights", "frozen_normals"]),
    ("new_contact", &["frictionless", "friction"]),
    ("extra", &["no", "constraints", "normals"]),
    ("restart", &["no", "committed"]),
    ("derivatives", &["no", "previous", "parameters"]),
];

/// A value of each.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Choice([usize; DIMENSIONS.len()]);

/// Only what is off the default.
impl std::fmt::Display for Choice {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let mut off = (0..DIMENSIONS.len()).filter(|&d| self.0[d] > 0);
        off.try_for_each(|d| write!(f, "{}={} ", DIMENSIONS[d].0, DIMENSIONS[d].1[self.0[d]]))
    }
}

impl Choice {
    pub const DEFAULT: Choice = Choice([0; DIMENSIONS.len()]);

    /// With this value of the kind of this number.
    pub fn with(mut self, kind: usize, value: usize) -> Choice {
        self.0[kind] = value;
        self
    }

    fn kind(name: &str) -> usize {
        DIMENSIONS.iter().position(|(kind, _)| *kind == name).unwrap_or_else(|| panic!("no choice is called {name}"))
    }

    pub fn of(&self, kind: &str) -> &'static str {
        let kind = Choice::kind(kind);
        DIMENSIONS[kind].1[self.0[kind]]
    }

    pub fn is(&self, kind: &str, value: &str) -> bool {
        debug_assert!(DIMENSIONS[Choice::kind(kind)].1.contains(&value), "{kind} is never {value}");
        self.of(kind) == value
    }

    pub fn set(self, kind: &str, value: &str) -> Choice {
        let kind = Choice::kind(kind);
        self.with(kind, DIMENSIONS[kind].1.iter().position(|v| *v == value).unwrap())
    }

    /// From words: `facet=quad8 basis=dual`.
    pub fn parsed(words: &str) -> Choice {
        let pairs = words.split_whitespace().map(|word| word.split_once('=').unwrap());
        pairs.fold(Choice::DEFAULT, |choice, (kind, value)| choice.set(kind, value))
    }

    /// What a choice needs by its definition, where these kinds leave it open.
    pub fn completed(mut self, chosen: &[usize]) -> Choice {
        let is_open = |kind: &str| !chosen.contains(&Choice::kind(kind));
        if self.is("space", "sub") && is_open("facet") {
            self = self.set("facet", "quad8");
        }
        if self.is("decision", "points") {
            if is_open("basis") {
                self = self.set("basis", "dual");
            }
            if !self.is("law", "none") && is_open("weights") {
                self = self.set("weights", "committed");
            }
        }
        if !self.is("system", "multipliers") && is_open("basis") {
            self = self.set("basis", "dual");
        }
        self
    }

    pub fn has_lines(&self) -> bool {
        self.of("facet").starts_with("line")
    }

    pub fn is_axisymmetric(&self) -> bool {
        matches!(self.of("facet"), "line2a" | "line3a")
    }

    pub fn is_quadratic(&self) -> bool {
        matches!(self.of("facet"), "tri6" | "quad8" | "quad9" | "mixed")
    }

    pub fn frame_moves(&self) -> bool {
        matches!(self.of("mortar"), "mplane" | "msphere" | "mcylinder")
    }

    pub fn is_analytic(&self) -> bool {
        self.frame_moves() || matches!(self.of("mortar"), "plane" | "sphere" | "cylinder")
    }

    pub fn is_condensed(&self) -> bool {
        !self.is("system", "multipliers")
    }

    /// One multiplier a node, for there is no friction.
    pub fn is_smooth(&self) -> bool {
        self.is("law", "none")
    }

    /// Laws in place of Coulomb's.
    pub fn has_own_law(&self) -> bool {
        matches!(self.of("law"), "own" | "cohesion" | "weakening" | "orthotropic" | "rate")
    }

    /// Whether weights are those of now.
    pub fn is_current(&self) -> bool {
        matches!(self.of("weights"), "current" | "conserving") && !self.is("law", "tied")
    }

    /// Why nothing can be asked of it; `None`: something can.
    pub fn not_applicable(&self) -> Option<&'static str> {
        if self.is_smooth() && matches!(self.of("layer"), "wear" | "bond" | "all") {
            return Some("with one multiplier a node nothing slips, and wear and bonds are refused by that");
        }
        if self.is_analytic() && self.is("ranks", "sums") {
            return Some("one analytic surface is not dealt out in shares");
        }
        if !self.is("heat", "no") && self.is("ranks", "sums") {
            return Some("no call for heat takes sums");
        }
        if self.is("integration", "hybrid") && self.is("ranks", "sums") {
            return Some("facets that both shares cover in part are refused, by what covers them and not by a feature");
        }
        if self.is("integration", "elements") && self.is("ranks", "sums") && self.is("basis", "dual") {
            return Some("a share covers too few points of a facet for its dual multipliers");
        }
        None
    }

    /// Options and surfaces, as an interface is created with them.
    pub fn created(&self) -> Features {
        let (tied, points) = (self.is("law", "tied"), self.is("decision", "points"));
        let (dual, half) = (self.is("basis", "dual"), self.is("weak", "half"));
        let conserves = self.is("weights", "conserving");
        let mid = self.is_quadratic() || matches!(self.of("facet"), "line3p" | "line3a");
        Features::which(&[
            (Feature::Lines, self.has_lines()),
            (Feature::Quadratic, self.is_quadratic()),
            (Feature::MidNodes, mid),
            (Feature::StandardBasis, !dual),
            (Feature::DualBasis, dual),
            (Feature::AllNodes, self.is("space", "sub") && (mid || self.has_lines())),
            (Feature::Augmented, self.is("form", "augmented")),
            (Feature::NormalsNow, (self.is("normals", "current") || conserves) && !tied),
            (Feature::WeightsNow, self.is_current()),
            (Feature::FrozenWeights, !self.is_current()),
            (Feature::WeightsCommitted, self.is("weights", "committed") && !tied),
            (Feature::Conserving, conserves && !tied),
            (Feature::PaperSlip, self.is("slip", "paper")),
            (Feature::Friction, !tied && !self.is("law", "none")),
            (Feature::Tied, tied),
            (Feature::Points, points),
            (Feature::NodesDecide, !points),
            (Feature::ElementPoints, !self.is("integration", "segments")),
            (Feature::FrozenTangent, self.is_current() && self.is("tangent", "frozen_weights")),
            (Feature::FrozenNormals, self.is("tangent", "frozen_normals")),
            (Feature::Carried, half || (dual && !points && self.is("weak", "default") && (tied || !conserves))),
            (Feature::Analytic, self.is_analytic()),
            (Feature::MovingFrame, self.frame_moves()),
        ])
    }

    /// What is asked of it one after the other, with the features that this brings.
    pub fn asked(&self) -> Vec<(Asked, Features)> {
        let offsets = !self.is("offsets", "no");
        let (motion, parts) = (self.is("heat", "all"), self.is("ranks", "parts"));
        let all = [
            (Asked::Created, true, Features::default()),
            (
                Asked::Law,
                self.has_own_law(),
                Features::which(&[(Feature::OwnLaw, true), (Feature::Orthotropic, self.is("law", "orthotropic"))]),
            ),
            (
                Asked::Layer,
                !self.is("layer", "no"),
                Features::which(&[(Feature::Layer, true), (Feature::LayerSlips, !self.is("layer", "overclosure"))]),
            ),
            (
                Asked::Offsets,
                offsets,
                Features::which(&[(Feature::Offsets, true), (Feature::MortarOffsets, self.is("offsets", "mortar"))]),
            ),
            (Asked::Normals, self.is("extra", "normals"), Features::of(&[Feature::HostNormals])),
            (Asked::Constraints, self.is("extra", "constraints"), Features::default()),
            (Asked::Owners, parts, Features::of(&[Feature::Elsewhere])),
            (Asked::Owners, self.is("ranks", "sums"), Features::of(&[Feature::Shared])),
        ];
        let mut has = self.created();
        let mut steps = Vec::new();
        for (asked, _, features) in all.into_iter().filter(|(_, is_asked, _)| *is_asked) {
            has = has.and(features);
            steps.push((asked, has));
        }
        let mut call = |asked, is_asked: bool, features| {
            if is_asked {
                steps.push((asked, has.and(Features::of(features))));
            }
        };
        call(Asked::Residual, self.is("ranks", "sums"), &[Feature::Sums]);
        call(Asked::Tangent, self.is("ranks", "sums") && !self.is_condensed(), &[Feature::Sums, Feature::SumsTangent]);
        call(Asked::Condensed, self.is_condensed(), &[Feature::Condensed]);
        call(Asked::InPlace, self.is("system", "inplace"), &[Feature::Condensed, Feature::InPlace]);
        call(Asked::HeatTangent, motion, &[Feature::HeatMotion]);
        call(Asked::Derivatives, !self.is("derivatives", "no"), &[Feature::Derivatives]);
        call(Asked::SetCommitted, self.is("restart", "committed"), &[Feature::NodeHistory]);
        steps
    }
}

/// When a combination is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Asked {
    Created,
    Law,
    Layer,
    Offsets,
    Normals,
    Constraints,
    Owners,
    Residual,
    Tangent,
    Condensed,
    InPlace,
    Heat,
    HeatTangent,
    Derivatives,
    SetCommitted,
}
