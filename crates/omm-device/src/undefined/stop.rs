//! The way of a reason from where it is found to where the command is known.

use std::fmt;

use super::{Reason, Undefined};

/// A reason and the parameter at fault, before the command is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Stop {
    pub(crate) at: String,
    pub(crate) why: Reason,
}

impl Stop {
    /// The same stop where the parameter lies inside `parent`.
    pub(crate) fn within(self, parent: impl fmt::Display) -> Self {
        // Where the parent ends in `->` it says itself how the two are joined.
        let parent = parent.to_string();
        let separator = if self.at.is_empty() || parent.ends_with("->") { "" } else { "." };
        Self { at: format!("{parent}{separator}{}", self.at), ..self }
    }

    /// Names the command.
    pub(crate) fn of(self, command: &'static str) -> Undefined {
        Undefined { command, submitted: None, at: self.at, why: self.why }
    }
}

impl<R: Into<Reason>> From<R> for Stop {
    fn from(why: R) -> Self {
        Self { at: String::new(), why: why.into() }
    }
}

/// Says at which parameter something stopped.
pub(crate) trait At<T> {
    /// The parameter, under its name in the API.
    fn at(self, at: impl fmt::Display) -> Result<T, Stop>;
}

impl<T, E: Into<Stop>> At<T> for Result<T, E> {
    fn at(self, at: impl fmt::Display) -> Result<T, Stop> {
        self.map_err(|error| error.into().within(at))
    }
}
