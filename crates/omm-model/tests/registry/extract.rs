//! What this crate takes from the registry, and the text form in which a copy of it lies beside the tests.

use std::collections::BTreeMap;
use std::fmt;

/// The part of `vk.xml` that `omm_model::vk` has to agree with.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Extract {
    /// Type that an extension in scope requires, to the type that stands for it: itself, the type it is another name of, or
    /// for a set of flags the type of its bits.
    pub required: BTreeMap<String, String>,
    /// Enumerated and flag types, each with its constants.
    pub constants: BTreeMap<String, BTreeMap<String, i64>>,
    /// Structures and unions, each with its members in order.
    pub members: BTreeMap<String, Vec<Member>>,
    /// Handles, each with the name of its object type.
    pub handles: BTreeMap<String, String>,
}

/// A member of a structure or union.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Member {
    /// Its name in the registry.
    pub name: String,
    /// The member that counts the elements, where this is an array.
    pub len: Option<String>,
    /// The constant that it has to hold, where it is `sType`.
    pub value: Option<String>,
}

const HEADER: &str = "\
# What omm_model::vk takes from the Vulkan registry. Written by `OMM_BLESS=1 cargo test -p omm-model --test registry`
# where vk.xml is present; do not edit.
";

impl fmt::Display for Extract {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(HEADER)?;
        for (name, stands_for) in &self.required {
            match name == stands_for {
                true => writeln!(f, "required {name}")?,
                false => writeln!(f, "required {name} {stands_for}")?,
            }
        }
        for (name, object_type) in &self.handles {
            writeln!(f, "handle {name} {object_type}")?;
        }
        for (name, constants) in &self.constants {
            writeln!(f, "constants {name}")?;
            for (constant, value) in constants {
                writeln!(f, "  {constant} {value}")?;
            }
        }
        for (name, members) in &self.members {
            writeln!(f, "members {name}")?;
            for member in members {
                write!(f, "  {}", member.name)?;
                if let Some(len) = &member.len {
                    write!(f, " [{len}]")?;
                }
                if let Some(value) = &member.value {
                    write!(f, " {value}")?;
                }
                writeln!(f)?;
            }
        }
        Ok(())
    }
}

impl Extract {
    /// Reads the text form.
    pub(crate) fn parse(text: &str) -> Self {
        let mut extract = Self::default();
        let (mut constants, mut members) = (String::new(), String::new());
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words[..] {
                ["required", name] => {
                    extract.required.insert(name.into(), name.into());
                }
                ["required", name, stands_for] => {
                    extract.required.insert(name.into(), stands_for.into());
                }
                ["handle", name, object_type] => {
                    extract.handles.insert(name.into(), object_type.into());
                }
                ["constants", name] => {
                    extract.constants.insert(name.into(), BTreeMap::new());
                    (constants, members) = (name.into(), String::new());
                }
                ["members", name] => {
                    extract.members.insert(name.into(), Vec::new());
                    (constants, members) = (String::new(), name.into());
                }
                [constant, value] if !constants.is_empty() => {
                    let value = value.parse().expect("a number");
                    let list = extract.constants.get_mut(&constants).expect("a list of constants");
                    list.insert(constant.into(), value);
                }
                [name, ref rest @ ..] if !members.is_empty() => {
                    let mut member = Member { name: name.into(), ..Member::default() };
                    for word in rest {
                        match word.strip_prefix('[').and_then(|word| word.strip_suffix(']')) {
                            Some(len) => member.len = Some(len.into()),
                            None => member.value = Some((*word).into()),
                        }
                    }
                    extract.members.get_mut(&members).expect("a list of members").push(member);
                }
                _ => panic!("extract: cannot read {line:?}"),
            }
        }
        extract
    }
}
