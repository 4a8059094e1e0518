//! Three measures of the weighted slip increment g_T of a step (docs/formulation 4.2). With
//! g[n, x]_A = sum_B n_AB x_B - sum_C n_AC x_C and P = I - nu nu^T:
//!
//! - objective: P (g[n_n, x_{n+1}] - g[n_{n+1}, x_{n+1}])
//! - increment: P (g[n_n, x_{n+1}] - g[n_n, x_n])
//! - paper:     P  g[n_n, x_{n+1}], the paper's (12): drifts on curved interfaces
//!
//! All are linear in the gaps, so a measure is two coefficients.

/// How the slip increment is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SlipMeasure {
    /// Invariant under any rigid motion within the step. The default.
    #[default]
    Objective,
    /// Change since t_n with the weights of t_n.
    Increment,
    /// The paper's literal form.
    Paper,
}

impl SlipMeasure {
    /// g_T = P (g[n_n, x_{n+1}] - `now` g[n_{n+1}, x_{n+1}] - `committed` g[n_n, x_n]): (now, committed).
    pub fn coefficients(self) -> (f64, f64) {
        match self {
            SlipMeasure::Objective => (1.0, 0.0),
            SlipMeasure::Increment => (0.0, 1.0),
            SlipMeasure::Paper => (0.0, 0.0),
        }
    }
}
