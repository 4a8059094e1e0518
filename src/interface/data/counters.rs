//! What an interface has done, and how its nodes were treated: what a scene pays for.

/// What an interface has done since its creation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counters {
    /// Pairs that came near each other, seen along the normal.
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

impl Counters {
    /// Adds what a thread has done of an integration.
    pub fn add(&mut self, other: &Counters) {
        self.pairs_tested += other.pairs_tested;
        self.pairs_clipped += other.pairs_clipped;
        self.pairs_integrated += other.pairs_integrated;
        self.boxes_visited += other.boxes_visited;
        self.seconds_search += other.seconds_search;
        self.seconds_integration += other.seconds_integration;
    }
}

/// How the nodes were treated at the last evaluation. They add up to all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NodeCounts {
    /// Covered, with friction: Coulomb's law with mu > 0, rough.
    pub frictional: i64,
    /// Covered, without friction: mu = 0, or no friction at all.
    pub frictionless: i64,
    /// Covered now and not at t_n: without friction for this step.
    pub new: i64,
    /// Covered and tied.
    pub tied: i64,
    /// Covered, and carried by neighbours: no multiplier of its own in this step.
    pub carried: i64,
    /// Not covered here: the row is -lambda / r.
    pub uncovered: i64,
    /// Not covered wherever the step may go, or the surfaces are apart: the same row, without asking the law.
    pub left_out: i64,
}

impl NodeCounts {
    /// All nodes.
    pub fn total(&self) -> i64 {
        self.frictional + self.frictionless + self.new + self.tied + self.carried + self.uncovered + self.left_out
    }
}
