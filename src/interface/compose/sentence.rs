//! What a host is told: which features, why, and the ways out.

use super::feature::{FEATURES, Feature};
use super::table::{Row, Verdict};
use crate::error::{Result, Text};

fn append(to: &mut Text, mark: &str, what: &str) -> Result<()> {
    if what.is_empty() { Ok(()) } else { to.append(format_args!("{mark}{what}")) }
}

impl Row {
    fn written(&self) -> Result<Text> {
        let mut text = Text::EMPTY;
        for (k, feature) in self.features.iter().enumerate() {
            append(&mut text, ["", " with ", " and ", " and "][k.min(3)], feature.name())?;
        }
        let why = match self.verdict {
            Verdict::NotBuilt if self.why.is_empty() => "this is not built",
            _ => self.why,
        };
        append(&mut text, ": ", why)?;
        let ways = self.without.iter().map(|way| way.without());
        ways.enumerate().try_for_each(|(k, way)| append(&mut text, if k == 0 { "; " } else { ", or " }, way))?;
        Ok(text)
    }

    /// The refusal. Without memory for it a short one that needs none.
    #[cold]
    pub fn sentence(&self) -> Text {
        self.written().unwrap_or_else(|error| error.message)
    }
}

impl Feature {
    /// What it is called in refusals.
    pub fn name(self) -> &'static str {
        FEATURES[self as usize].name
    }

    /// How a host does without.
    pub fn without(self) -> &'static str {
        FEATURES[self as usize].without
    }
}

#[cfg(test)]
mod tests {
    use super::super::table::ROWS;
    use super::*;

    #[test]
    fn features_are_in_the_order_of_their_numbers() {
        assert!(FEATURES.iter().enumerate().all(|(k, about)| about.feature as usize == k));
        assert!(FEATURES.len() <= 64, "a bit for each");
    }

    #[test]
    fn every_row_says_why_and_a_way_out() {
        for row in ROWS {
            let text = row.sentence();
            assert!(row.features.len() >= 2, "{text}");
            assert!(row.verdict == Verdict::NotBuilt || !row.why.is_empty(), "{text}");
            assert!(row.without.iter().all(|way| !way.without().is_empty() && row.features.contains(way)), "{text}");
            assert!(!row.without.is_empty() || row.why.contains("; ") || row.features[0] == Feature::ShapeOffsets);
        }
    }

    /// A row that holds all features of an earlier one would never be told.
    #[test]
    fn no_row_hides_behind_another() {
        for (k, row) in ROWS.iter().enumerate() {
            assert!(ROWS[..k].iter().all(|before| !row.all().have(before.all())), "{}", row.sentence());
        }
    }
}
