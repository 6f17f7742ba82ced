//! Where each check applies, and under which identifier.

pub(super) mod command;
pub(super) mod member;
pub(super) mod structure;
