//! What a host is told: which features, why, and the ways out.

use super::table::{Row, Verdict};
use crate::error::{Result, Text};

fn append(to: &mut Text, mark: &str, what: &str) -> Result<()> {
    if what.is_empty() { Ok(()) } else { to.append(format_args!("{mark}{what}")) }
}

impl Row {
    fn written(&self) -> Result<Text> {
        let mut text = Text::EMPTY;
        for (k, feature) in self.features.as_slice().iter().enumerate() {
            append(&mut text, ["", " with ", " and ", " and "][k.min(3)], feature.name())?;
        }
        let why = match self.verdict {
            Verdict::NotBuilt if self.why().is_empty() => "this is not built",
            _ => self.why(),
        };
        append(&mut text, ": ", why)?;
        let ways = self.without.as_slice().iter().map(|way| way.without());
        ways.enumerate().try_for_each(|(k, way)| append(&mut text, if k == 0 { "; " } else { ", or " }, way))?;
        Ok(text)
    }

    /// The refusal. Without memory for it a short one that needs none.
    #[cold]
    pub fn sentence(&self) -> Text {
        self.written().unwrap_or_else(|error| error.message)
    }
}

#[cfg(test)]
mod tests {
    use super::super::feature::{FEATURES, Feature};
    use super::super::table::ROWS;
    use super::*;

    #[test]
    fn features_are_in_the_order_of_their_numbers() {
        assert!(FEATURES.iter().enumerate().all(|(k, about)| about.feature as usize == k));
        assert!(FEATURES.iter().all(|a| a.feature.name() == a.name && a.feature.without() == a.without));
        assert!(FEATURES.len() <= 64, "a bit for each");
    }

    #[test]
    fn every_row_says_why_and_a_way_out() {
        for row in &ROWS {
            let text = row.sentence();
            assert!(row.features.as_slice().len() >= 2, "{text}");
            assert!(row.verdict == Verdict::NotBuilt || !row.why().is_empty(), "{text}");
            assert!(
                row.without
                    .as_slice()
                    .iter()
                    .all(|way| !way.without().is_empty() && row.features.as_slice().contains(way)),
                "{text}"
            );
            assert!(!row.without.as_slice().is_empty() || row.features.as_slice()[0] == Feature::ShapeOffsets);
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
