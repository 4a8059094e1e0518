//! How the surfaces of an interface lie: what a host shows its user before and between steps.

use super::guard::guard;
use super::handle::{either, handle, stickslip_interface};
use super::point::Point;
use super::raw;
use super::sized::{self, Sized64};
use crate::error::{Result, Text};
use crate::interface::{Cover, Finding, Report};
use libc::c_char;

/// Cover of a node: none (at and below coverage_min). It is open.
pub const STICKSLIP_COVER_NONE: i32 = 0;
/// Cover of a node: part of its area, at an edge of the mortar surface.
pub const STICKSLIP_COVER_PART: i32 = 1;
/// Cover of a node: all of its area, within 1 %.
pub const STICKSLIP_COVER_FULL: i32 = 2;
/// Cover of a node: several layers of the mortar surface, over a facet around it. The next
/// commit settles which are the nearest; at a seam a part of a facet may stay covered twice.
pub const STICKSLIP_COVER_SEVERAL: i32 = 3;

/// Finding: nothing is amiss with surfaces that lie over each other.
pub const STICKSLIP_FINDING_NONE: i32 = 0;
/// Finding: no facets lie over each other, or only in front of each other, beyond search_distance. Not amiss where they meet later.
pub const STICKSLIP_FINDING_NO_OVERLAP: i32 = 1;
/// Finding: no facets that lie over each other oppose each other: the node order of one side is reversed, or it is the
/// wrong face of its body.
pub const STICKSLIP_FINDING_SAME_WAY: i32 = 2;
/// Finding: opposing facets lie behind each other deeper than a pair can: both node orders are reversed, or the bodies
/// have passed through each other, or start so deep that search_distance is needed.
pub const STICKSLIP_FINDING_BEHIND: i32 = 3;
/// Finding: the positions of either side are those of the other side's first configuration, node by node: x1 and x2 are
/// swapped. Seen where both sides have as many nodes.
pub const STICKSLIP_FINDING_SWAPPED: i32 = 4;
/// Finding: both node orders look reversed. Every covered node penetrates by a tenth of a facet (the smaller side's longest
/// edge) or more, be it an open gap that is seen from inside or a deep interference fit; or a closed surface is a cavity and
/// the other side is not in it. Open patches that touch do not tell.
pub const STICKSLIP_FINDING_INSIDE_OUT: i32 = 5;

/// What `stickslip_interface_report` finds. A NULL member is not wanted.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_report {
    /// sizeof(stickslip_report).
    pub struct_size: u64,
    /// n1: STICKSLIP_COVER_... of each non-mortar node.
    pub cover: *mut i32,
    /// n1: covered over full area [-].
    pub fraction: *mut f64,
    /// n1: layers of the mortar surface over a facet around the node, 1 where there are no several. Layers that cover
    /// less than one facet in all count as two, with frozen weights as one.
    pub layers: *mut i32,
    /// n1: mortar facets that overlap with the facets around the node.
    pub facets: *mut i64,
    /// The report in sentences, for the host's log; zero-terminated, cut where it is longer. For people: the words may
    /// change.
    pub text: *mut c_char,
    /// Room for text, at least 1; 1000 characters are enough. 0 where text is NULL.
    pub text_capacity: i64,
    /// Output: nodes with STICKSLIP_COVER_NONE.
    pub nodes_none: i64,
    /// Output: nodes with STICKSLIP_COVER_PART.
    pub nodes_part: i64,
    /// Output: nodes with STICKSLIP_COVER_FULL.
    pub nodes_full: i64,
    /// Output: nodes with STICKSLIP_COVER_SEVERAL.
    pub nodes_several: i64,
    /// Output: STICKSLIP_FINDING_...; where nodes are covered NONE, SWAPPED or INSIDE_OUT.
    pub finding: i32,
    /// 0.
    pub reserved: i32,
    /// Output: the deepest penetration of a covered node, its weighted gap over its covered area; 0 where all are open
    /// [L]. Where both sides are seen from inside, an open gap reads as a penetration.
    pub penetration: f64,
}

// SAFETY: repr(C), struct_size first, numbers and raw pointers only.
unsafe impl Sized64 for stickslip_report {
    const NAME: &'static str = "stickslip_report";
    const FIRST: usize = 104;
}

/// Which non-mortar nodes are covered at (x1, x2), in full, in part, by how many facets and layers; and, where nothing
/// overlaps, what that looks like. Once after creation, and where a host wants to show it. The state of the handle
/// stays as it is, and what the library leaves out for surfaces that are apart is looked at here all the same.
///
/// x1 (3 n1), x2 (3 n2): positions [L]. out, input and output: its members point to the caller's arrays, which are
/// filled; its numbers are written.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE (text_capacity), NOT_FINITE, DEGENERATE_FACET,
/// PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, INVALID_VALUE (an analytic surface's frame).
/// Cost: one search and one integration (frozen weights: none), a second search where no node is covered; allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_report(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    out: *mut stickslip_report,
) -> i32 {
    guard(|| {
        let h = &mut handle(interface)?.inner;
        let point = Point::positions(h, x1, x2)?;
        sized::check_output(out)?;
        let wanted = sized::read(out)?;
        check(&wanted)?;
        let report = either!(h, c => c.report(point.x1(), point.x2())?);
        raw::check_results(
            "fraction, penetration",
            report.nodes.iter().map(|n| &n.fraction).chain([&report.penetration]),
        )?;
        write(&wanted, out, &report)
    })
}

fn check(wanted: &stickslip_report) -> Result<()> {
    raw::check_optional(wanted.cover, "stickslip_report.cover")?;
    raw::check_optional(wanted.fraction, "stickslip_report.fraction")?;
    raw::check_optional(wanted.layers, "stickslip_report.layers")?;
    raw::check_optional(wanted.facets, "stickslip_report.facets")?;
    if !wanted.text.is_null() {
        raw::count(wanted.text_capacity, 1, "stickslip_report.text_capacity")?;
    }
    Ok(())
}

fn write(wanted: &stickslip_report, out: *mut stickslip_report, report: &Report) -> Result<()> {
    let text = if wanted.text.is_null() { Text::EMPTY } else { report.text()? };
    raw::write_each(wanted.cover, report.nodes.iter().map(|n| n.cover as i32));
    raw::write_each(wanted.fraction, report.nodes.iter().map(|n| n.fraction));
    raw::write_each(wanted.layers, report.nodes.iter().map(|n| n.layers));
    raw::write_each(wanted.facets, report.nodes.iter().map(|n| n.facets));
    if !wanted.text.is_null() {
        raw::write_text(wanted.text, wanted.text_capacity as usize, &text);
    }
    let count = |cover| report.count(cover) as i64;
    sized::write(
        out,
        stickslip_report {
            nodes_none: count(Cover::None),
            nodes_part: count(Cover::Part),
            nodes_full: count(Cover::Full),
            nodes_several: count(Cover::Several),
            finding: match report.finding {
                None => STICKSLIP_FINDING_NONE,
                Some(Finding::NoOverlap) => STICKSLIP_FINDING_NO_OVERLAP,
                Some(Finding::SameWay) => STICKSLIP_FINDING_SAME_WAY,
                Some(Finding::Behind) => STICKSLIP_FINDING_BEHIND,
                Some(Finding::Swapped) => STICKSLIP_FINDING_SWAPPED,
                Some(Finding::InsideOut) => STICKSLIP_FINDING_INSIDE_OUT,
            },
            reserved: 0,
            penetration: report.penetration,
            ..*wanted
        },
    );
    Ok(())
}
