//! What can be wrong with an input, and how it is said.
//!
//! Every refusal names the argument, what was found and what is allowed. A refusal changes nothing:
//! no output is written and no history moves. "No contact" is a state, not an error.

use std::borrow::Cow;
use std::ffi::CStr;
use std::fmt::{self, Write};
use std::ops::Deref;

/// Result of every fallible routine of the crate.
pub type Result<T> = std::result::Result<T, Error>;

/// The kind of a refusal. The numbers are those of the C ABI: explicit, appended to, never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Kind {
    /// A required pointer is null.
    NullPointer = 1,
    /// A struct's `struct_size` is not one that this library knows.
    StructSize = 2,
    /// A count or length is not one of the allowed ones.
    InvalidSize = 3,
    /// A number is NaN or infinite.
    NotFinite = 4,
    /// An index points outside its array.
    IndexOutOfRange = 5,
    /// A facet names the same node twice.
    DuplicateNode = 6,
    /// A facet has no area, is folded or is not convex.
    DegenerateFacet = 7,
    /// A number or option is outside its allowed range.
    InvalidValue = 8,
    /// Neither an augmentation nor a modulus was given.
    MissingStiffness = 9,
    /// An option that is named but not available in this version.
    Unsupported = 10,
    /// The normals of the facets around a node cancel.
    UndefinedNormal = 11,
    /// A mortar facet's projection on a non-mortar facet's plane is not convex.
    ProjectionNotConvex = 12,
    /// The caller's buffer is too small.
    BufferTooSmall = 13,
    /// The caller's sparse matrix lacks an entry that the tangent needs.
    MissingEntry = 14,
    /// There is no commit to roll back.
    NothingToRollBack = 15,
    /// An imported history does not belong to this interface.
    HistoryMismatch = 16,
    /// Within the step the surfaces have turned by more than the normals of t_n allow.
    TurnedTooFar = 17,
    /// The system has no memory left for what the call needs.
    OutOfMemory = 18,
    /// A commit would take pairs away from a closed node.
    ContactLost = 19,
}

/// All kinds with their short texts, in the order of their numbers.
pub const KINDS: [(Kind, &CStr); 19] = [
    (Kind::NullPointer, c"a required pointer is null"),
    (Kind::StructSize, c"a struct has an unknown size"),
    (Kind::InvalidSize, c"a count or length is not allowed"),
    (Kind::NotFinite, c"a number is NaN or infinite"),
    (Kind::IndexOutOfRange, c"an index is out of range"),
    (Kind::DuplicateNode, c"a facet names a node twice"),
    (Kind::DegenerateFacet, c"a facet has no area, is folded or is not convex"),
    (Kind::InvalidValue, c"a value is outside its allowed range"),
    (Kind::MissingStiffness, c"neither augmentation nor modulus given"),
    (Kind::Unsupported, c"not supported by this version"),
    (Kind::UndefinedNormal, c"the averaged normal of a node is undefined"),
    (Kind::ProjectionNotConvex, c"a mortar facet's projection is not convex"),
    (Kind::BufferTooSmall, c"a buffer is too small"),
    (Kind::MissingEntry, c"the matrix lacks an entry"),
    (Kind::NothingToRollBack, c"there is no commit to roll back"),
    (Kind::HistoryMismatch, c"the history belongs to another interface"),
    (Kind::TurnedTooFar, c"the surfaces turned too far within the step"),
    (Kind::OutOfMemory, c"memory has run out"),
    (Kind::ContactLost, c"the commit would take contact away"),
];

/// A refusal: its kind and a sentence that names the argument at fault.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    /// What kind of refusal this is.
    pub kind: Kind,
    /// Which argument, what was found, what is allowed.
    pub message: Text,
}

impl Error {
    /// A refusal of the given kind.
    pub fn new(kind: Kind, message: impl Into<Text>) -> Self {
        Error { kind, message: message.into() }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

/// A text that grows while there is memory: a `String` of its own would abort where there is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text(Cow<'static, str>);

impl Text {
    /// An empty one.
    pub const EMPTY: Text = Text(Cow::Borrowed(""));

    /// Appends what `format_args!` or `text!` says.
    ///
    /// # Errors
    /// [`Kind::OutOfMemory`]; the text may then have got a part of it.
    pub fn append(&mut self, what: fmt::Arguments) -> Result<()> {
        let mut longer = Longer(String::new());
        let begun = match std::mem::take(&mut self.0) {
            Cow::Borrowed(text) => longer.write_str(text),
            Cow::Owned(text) => {
                longer.0 = text;
                Ok(())
            }
        };
        let all = begun.and_then(|()| longer.write_fmt(what));
        self.0 = Cow::Owned(longer.0);
        all.map_err(|_| Error::new(Kind::OutOfMemory, "memory has run out; nothing was changed"))
    }

    /// What `format_args!` says.
    ///
    /// # Errors
    /// [`Kind::OutOfMemory`].
    pub fn try_of(what: fmt::Arguments) -> Result<Text> {
        let mut text = Text::EMPTY;
        text.append(what)?;
        Ok(text)
    }

    /// The text of a refusal. Without memory for it a short one that needs none.
    pub fn of(what: fmt::Arguments) -> Text {
        Text::try_of(what).unwrap_or(Text(Cow::Borrowed("refused; there is no memory left to say why")))
    }
}

/// `format!` for refusals: a [`Text`] in place of a `String`. Known to all modules, for this one comes first.
macro_rules! text {
    ($($what:tt)*) => { $crate::error::Text::of(format_args!($($what)*)) };
}

impl Deref for Text {
    type Target = str;
    fn deref(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl From<&'static str> for Text {
    fn from(text: &'static str) -> Text {
        Text(Cow::Borrowed(text))
    }
}

impl From<String> for Text {
    fn from(text: String) -> Text {
        Text(Cow::Owned(text))
    }
}

impl PartialEq<str> for Text {
    fn eq(&self, other: &str) -> bool {
        self.0 == *other
    }
}

impl PartialEq<&str> for Text {
    fn eq(&self, other: &&str) -> bool {
        self.0 == **other
    }
}

/// What formatting writes to: ends with an error where there is no memory.
struct Longer(String);

impl fmt::Write for Longer {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        self.0.try_reserve(s.len()).map_err(|_| fmt::Error)?;
        self.0.push_str(s);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_say_what_format_says() {
        let mut text = text!("{} of {:.1}", 1, 2.0);
        assert_eq!(text, "1 of 2.0");
        text.append(format_args!(", {text:?}", text = "more")).unwrap();
        assert_eq!(text.to_string(), "1 of 2.0, \"more\"");
        assert_eq!(*Text::EMPTY, *"");
    }
}
