//! What only rules of our own find.

use omm_model::vk;

use crate::state::RecordingState;

/// What is wrong with a value, where only a rule of our own says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum OwnFinding {
    /// A buffer is bound to memory already.
    AlreadyBound {
        /// The memory.
        memory: u64,
    },
    /// A command buffer is elsewhere in its life than it has to be.
    RecordingState {
        /// Where it is.
        found: RecordingState,
        /// Where it has to be; `None` where only the place found is wrong.
        required: Option<RecordingState>,
    },
    /// A command buffer is of the other level.
    CommandBufferLevel {
        /// The level that it has to be of.
        required: vk::CommandBufferLevel,
    },
    /// A query is waited for that nothing will write.
    WaitsForever {
        /// The query.
        query: u32,
    },
    /// A value that has no meaning here.
    Meaningless {
        /// The value.
        found: i64,
    },
    /// Something differs that has to be the same.
    Differs {
        /// What it is.
        what: &'static str,
        /// As it is now.
        found: u64,
        /// As it was.
        required: u64,
    },
    /// Geometry of a type that cannot be built here, or whose data is that of another type.
    Geometry,
    /// A command cannot be executed twice and is.
    Twice,
}

impl OwnFinding {
    /// The value found, as text.
    pub(crate) fn found(&self) -> String {
        match *self {
            Self::AlreadyBound { memory } => format!("a buffer bound to memory {memory:#x}"),
            Self::RecordingState { found, .. } => format!("a command buffer in the {found} state"),
            Self::CommandBufferLevel { required: vk::CommandBufferLevel::PRIMARY } => "a secondary one".to_owned(),
            Self::CommandBufferLevel { .. } => "a primary one".to_owned(),
            Self::WaitsForever { query } => format!("query {query}, which nothing will write"),
            Self::Meaningless { found } => found.to_string(),
            Self::Differs { what, found, .. } => format!("{what} {found}"),
            Self::Geometry => "geometry that the structure is not built from".to_owned(),
            Self::Twice => "a command buffer for one submission, a second time".to_owned(),
        }
    }

    /// What was required, as text.
    pub(crate) fn required(&self) -> String {
        match *self {
            Self::AlreadyBound { .. } => "one that is not bound".to_owned(),
            Self::RecordingState { required: Some(required), .. } => format!("one in the {required} state"),
            Self::RecordingState { .. } => "one in another state".to_owned(),
            Self::CommandBufferLevel { required: vk::CommandBufferLevel::PRIMARY } => {
                "a primary command buffer".to_owned()
            }
            Self::CommandBufferLevel { .. } => "a secondary command buffer".to_owned(),
            Self::WaitsForever { .. } => "queries that are written, or no wait".to_owned(),
            Self::Meaningless { .. } => "a value with a meaning here".to_owned(),
            Self::Differs { required, .. } => required.to_string(),
            Self::Geometry => "geometry of the right type, with its data".to_owned(),
            Self::Twice => "one submission".to_owned(),
        }
    }
}
