//! Where in a call a value stands, written as the caller wrote it.

use std::fmt;

use omm_model::vk;

use crate::value::Constant;

/// An object that a violation concerns: its kind and its handle.
pub type Object = (vk::ObjectType, u64);

/// The path from a command's parameters to the offending value, such as
/// `pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts[2].subdivisionLevel`.
///
/// Names and punctuation are those of the C interface; `pNext<…>` names the structure of the chain that holds the next step.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(transparent)]
pub struct Location(String);

impl Location {
    /// The path as text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A [`Location`] in the making: a step and a link to the step before it, all on the stack.
///
/// Walking a call costs no allocation; [`location`](Self::location) makes the path owned once something is wrong there. A step
/// may carry the object that it is about, so that a rule does not have to name objects itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At<'a> {
    parent: Option<&'a At<'a>>,
    step: Step,
    object: Option<Object>,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    /// The command itself, where every path begins.
    Command(&'static str),
    /// A member or parameter.
    Field(&'static str),
    /// A parameter that points to one structure.
    Pointer(&'static str),
    /// An element of an array.
    Element(&'static str, usize),
    /// An element of an array of pointers.
    ElementPointer(&'static str, usize),
    /// A structure in a `pNext` chain.
    Chained(&'static str),
    /// A structure in a `pNext` chain, by its type.
    ChainedType(vk::StructureType),
}

impl<'a> At<'a> {
    /// The start of a path: a command and the object that it is called on.
    pub(crate) const fn command(name: &'static str, object: Object) -> At<'static> {
        At { parent: None, step: Step::Command(name), object: Some(object) }
    }

    const fn step(&'a self, step: Step) -> Self {
        At { parent: Some(self), step, object: None }
    }

    /// A member or parameter.
    pub(crate) const fn field(&'a self, name: &'static str) -> Self {
        self.step(Step::Field(name))
    }

    /// A parameter that points to one structure.
    pub(crate) const fn pointer(&'a self, name: &'static str) -> Self {
        self.step(Step::Pointer(name))
    }

    /// An element of an array.
    pub(crate) const fn element(&'a self, name: &'static str, index: usize) -> Self {
        self.step(Step::Element(name, index))
    }

    /// An element of an array of pointers.
    pub(crate) const fn element_pointer(&'a self, name: &'static str, index: usize) -> Self {
        self.step(Step::ElementPointer(name, index))
    }

    /// A structure in the `pNext` chain.
    pub(crate) const fn chained(&'a self, structure: &'static str) -> Self {
        self.step(Step::Chained(structure))
    }

    /// A structure in the `pNext` chain that should not be there: by its type, since it may be any.
    pub(crate) const fn chained_type(&'a self, structure: vk::StructureType) -> Self {
        self.step(Step::ChainedType(structure))
    }

    /// The same step, about an acceleration structure.
    pub(crate) const fn about(mut self, handle: vk::AccelerationStructure) -> Self {
        self.object = Some((vk::AccelerationStructure::OBJECT_TYPE, handle.0));
        self
    }

    /// The same step, about a micromap object.
    pub(crate) const fn about_micromap(mut self, handle: vk::Micromap) -> Self {
        self.object = Some((vk::Micromap::OBJECT_TYPE, handle.0));
        self
    }

    /// The same step, about an object.
    pub(crate) const fn about_object(mut self, object: Object) -> Self {
        self.object = Some(object);
        self
    }

    /// This step and those before it, last step first.
    fn steps(&self) -> impl Iterator<Item = &At<'_>> {
        std::iter::successors(Some(self), |at| at.parent)
    }

    /// The command's name.
    pub(crate) fn command_name(&self) -> &'static str {
        let command = |at: &At<'_>| if let Step::Command(name) = at.step { Some(name) } else { None };
        self.steps().find_map(command).unwrap_or_default()
    }

    /// The objects along the path, the command's first, each once, without null handles.
    pub(crate) fn objects(&self) -> Vec<Object> {
        let mut objects = Vec::new();
        for object in self.steps().filter_map(|at| at.object) {
            if object.1 != 0 && !objects.contains(&object) {
                objects.push(object);
            }
        }
        objects.reverse();
        objects
    }

    /// The path so far, owned.
    pub(crate) fn location(&self) -> Location {
        Location(self.to_string())
    }
}

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(parent) = self.parent {
            parent.fmt(f)?;
            f.write_str(match parent.step {
                Step::Command(_) => "",
                Step::Pointer(_) | Step::ElementPointer(..) => "->",
                Step::Field(_) | Step::Element(..) | Step::Chained(_) | Step::ChainedType(_) => ".",
            })?;
        }
        match self.step {
            Step::Command(_) => Ok(()),
            Step::Field(name) | Step::Pointer(name) => f.write_str(name),
            Step::Element(name, index) | Step::ElementPointer(name, index) => {
                write!(f, "{name}[{index}]")
            }
            Step::Chained(structure) => write!(f, "pNext<{structure}>"),
            Step::ChainedType(structure) => write!(f, "pNext<{}>", Constant::from(structure)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_reads_as_written() {
        let command = At::command("vkCommand", (vk::CommandBuffer::OBJECT_TYPE, 7));
        let info = command.element("pInfos", 1).about(vk::AccelerationStructure(9));
        let geometry = info.element_pointer("ppGeometries", 0);
        let triangles = geometry.field("geometry");
        let chained = triangles.chained("VkStructure");
        let field = chained.field("indexStride").about(vk::AccelerationStructure::NULL);
        assert_eq!(field.location().as_str(), "pInfos[1].ppGeometries[0]->geometry.pNext<VkStructure>.indexStride");
        assert_eq!(field.command_name(), "vkCommand");
        assert_eq!(field.objects(), [(vk::CommandBuffer::OBJECT_TYPE, 7), (vk::AccelerationStructure::OBJECT_TYPE, 9)]);
        let pointer = command.pointer("pBuildInfo");
        assert_eq!(pointer.field("type").location().as_str(), "pBuildInfo->type");
    }
}
