//! The objects of a scenario by name: their handles, and where they lie.

use crate::nearest;

/// What a name stands for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Object {
    pub(crate) name: String,
    /// Types of handles, as the model calls them, and handles. A buffer has its own and that of its memory.
    pub(crate) handles: Vec<(&'static str, u64)>,
    pub(crate) place: Option<Range>,
}

/// Where an object lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Range {
    pub(crate) address: u64,
    pub(crate) size: u64,
    /// In the application's memory instead of the device's.
    pub(crate) host: bool,
}

/// An address that a scenario wrote down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Address {
    pub(crate) value: u64,
    pub(crate) host: bool,
}

/// Why a name means nothing here, and what may have been meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Unknown {
    pub(crate) message: String,
    pub(crate) help: Option<String>,
}

/// All named objects, in the order in which they were made. What was destroyed keeps its name.
#[derive(Clone, Debug, Default)]
pub(crate) struct Objects {
    all: Vec<Object>,
    /// Every handle below this and from [`FIRST_HANDLE`] on was given out; those without a name are a step's own.
    next_handle: Option<u64>,
}

impl Objects {
    /// Adds an object, or replaces one of the same name.
    pub(crate) fn insert(&mut self, object: Object) {
        match self.all.iter_mut().find(|known| known.name == object.name) {
            Some(known) => *known = object,
            None => self.all.push(object),
        }
    }

    /// A handle that nothing has.
    pub(crate) fn new_handle(&mut self) -> u64 {
        let handle = self.next_handle.unwrap_or(FIRST_HANDLE);
        self.next_handle = Some(handle.saturating_add(1));
        handle
    }

    /// Whether a handle was given out without a name.
    fn is_own(&self, handle: u64) -> bool {
        handle >= FIRST_HANDLE && self.next_handle.is_some_and(|next| handle < next)
    }

    /// The object of that name.
    pub(crate) fn get(&self, name: &str) -> Result<&Object, Unknown> {
        self.all.iter().find(|object| object.name == name).ok_or_else(|| Unknown {
            message: format!("there is no object \"{name}\""),
            help: nearest::among(name, self.all.iter().map(|object| object.name.as_str())),
        })
    }

    /// Whether there is an object of that name.
    pub(crate) fn contains(&self, name: &str) -> bool {
        self.get(name).is_ok()
    }

    /// The handle of one type that an object has.
    pub(crate) fn handle(&self, type_name: &str, name: &str) -> Result<u64, Unknown> {
        let object = self.get(name)?;
        object.handle(type_name).ok_or_else(|| {
            let types: Vec<_> = object.handles.iter().map(|(type_name, _)| format!("Vk{type_name}")).collect();
            let of_type = self.all.iter().filter(|object| object.handle(type_name).is_some());
            let what = if types.is_empty() { "no handle".to_owned() } else { types.join(" and ") };
            Unknown {
                message: format!("\"{name}\" is {what}, a Vk{type_name} is needed"),
                help: nearest::among(name, of_type.map(|object| object.name.as_str())),
            }
        })
    }

    /// Where an object lies, or so many bytes further: `leaf.data`, `leaf.data + 64`.
    pub(crate) fn address(&self, text: &str) -> Result<Address, Unknown> {
        let (name, offset) = match text.rfind(['+', '-']).map(|at| text.split_at(at)) {
            Some((name, offset)) if !self.contains(text) => (name.trim(), offset),
            _ => (text, ""),
        };
        let unknown = |message: String| Unknown { message, help: None };
        let place = self.get(name)?.place.ok_or_else(|| unknown(format!("\"{name}\" lies nowhere in memory")))?;
        let offset: String = offset.split_whitespace().collect();
        let (sign, digits) = offset.split_at_checked(1).unwrap_or(("+", "0"));
        let number = match digits.strip_prefix("0x") {
            Some(digits) => u64::from_str_radix(digits, 16),
            None => digits.parse(),
        };
        let number = number.map_err(|_| unknown(format!("\"{digits}\" is no number of bytes")))?;
        let value = match sign {
            "-" => place.address.checked_sub(number),
            _ => place.address.checked_add(number),
        };
        let value = value.ok_or_else(|| unknown(format!("\"{text}\" is no address of 64 bits")))?;
        Ok(Address { value, host: place.host })
    }

    /// The object that has a handle.
    pub(crate) fn name_of_handle(&self, type_name: &str, handle: u64) -> Option<&str> {
        let found = self.all.iter().find(|object| object.handle(type_name) == Some(handle));
        found.map(|object| object.name.as_str()).or(self.is_own(handle).then_some(OWN))
    }

    /// An address as an object's name and a distance: the object that begins last before it.
    pub(crate) fn name_of_address(&self, address: u64, host: bool) -> Option<String> {
        let inside = |object: &&Object| {
            object.place.is_some_and(|place| {
                place.host == host && place.address <= address && address - place.address <= place.size
            })
        };
        // Of a structure and the buffer that it lies in, the structure was made last.
        let found = self.all.iter().filter(inside).max_by_key(|object| object.place.map(|place| place.address))?;
        match address - found.place?.address {
            0 => Some(found.name.clone()),
            offset => Some(format!("{}+{offset:#x}", found.name)),
        }
    }

    /// The buffer that an address lies in: its name, and where it lies.
    pub(crate) fn holding(&self, address: u64) -> Option<(String, Range)> {
        let found = self.all.iter().find(|object| {
            object.handle("Buffer").is_some()
                && object.place.is_some_and(|place| place.address <= address && address - place.address < place.size)
        })?;
        Some((found.name.clone(), found.place?))
    }

    /// A message with names instead of the addresses and handles of named objects.
    pub(crate) fn named(&self, text: &str) -> String {
        let mut out = String::with_capacity(text.len());
        let mut rest = text;
        while let Some(at) = rest.find("0x") {
            let (before, number) = rest.split_at(at);
            let digits = number.get(2..).unwrap_or_default();
            let end = digits.find(|letter: char| !letter.is_ascii_hexdigit()).unwrap_or(digits.len());
            let (digits, after) = digits.split_at(end);
            out.push_str(before);
            match u64::from_str_radix(digits, 16).ok().and_then(|value| self.name_of(value)) {
                Some(name) => out.push_str(&name),
                None => {
                    out.push_str("0x");
                    out.push_str(digits);
                }
            }
            rest = after;
        }
        out.push_str(rest);
        out
    }

    /// What a number in a message means. Handles and addresses are so large that they are nothing else.
    fn name_of(&self, value: u64) -> Option<String> {
        let has = |object: &&Object| object.handles.iter().any(|(_, handle)| *handle == value);
        let named = || self.all.iter().find(has).map(|object| object.name.clone()).unwrap_or(OWN.to_owned());
        let handle = || self.is_own(value).then(named);
        self.name_of_address(value, false).or_else(|| self.name_of_address(value, true)).or_else(handle)
    }
}

/// How messages call an object that a step made for itself.
const OWN: &str = "(own)";

/// Handles that a scenario gives out begin here, so that they are not taken for counts.
const FIRST_HANDLE: u64 = 0x4000;

impl Object {
    /// The handle of that type.
    pub(crate) fn handle(&self, type_name: &str) -> Option<u64> {
        self.handles.iter().find(|(found, _)| *found == type_name).map(|(_, handle)| *handle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn objects() -> Objects {
        let mut objects = Objects { next_handle: Some(0x4010), ..Objects::default() };
        let place = |address, size, host| Some(Range { address, size, host });
        let buffer = |name: &str, handle, place| Object {
            name: name.to_owned(),
            handles: vec![("Buffer", handle), ("DeviceMemory", handle + 1)],
            place,
        };
        objects.insert(buffer("leaf.storage", 0x4000, place(0x1_0000, 0x100, false)));
        objects.insert(Object {
            name: "leaf".to_owned(),
            handles: vec![("AccelerationStructure", 0x4002)],
            place: place(0x1_0000, 0x100, false),
        });
        objects.insert(buffer("a-b", 0x4003, place(0x2_0000, 0x10, true)));
        objects
    }

    #[test]
    fn names_are_handles_and_addresses() {
        let objects = objects();
        assert_eq!(objects.handle("Buffer", "leaf.storage"), Ok(0x4000));
        let wrong = objects.handle("Buffer", "leaf").unwrap_err();
        assert_eq!(wrong.message, "\"leaf\" is VkAccelerationStructure, a VkBuffer is needed");
        assert!(objects.handle("Buffer", "laef.storage").unwrap_err().help.unwrap().contains("leaf.storage"));
        let address =
            |text| objects.address(text).map(|found| (found.value, found.host)).map_err(|error| error.message);
        assert_eq!(address("leaf"), Ok((0x1_0000, false)));
        assert_eq!(address("leaf + 0x10"), Ok((0x1_0010, false)));
        assert_eq!(address("leaf-1"), Ok((0xffff, false)));
        assert_eq!(address("a-b"), Ok((0x2_0000, true)));
        assert_eq!(address("a-b+1"), Ok((0x2_0001, true)));
        assert!(address("leaf + x").is_err() && address("leaf + 18446744073709551615").is_err());
        assert!(address("+").is_err() && address("leaf - 0x10001").is_err() && address("é+é").is_err());
    }

    #[test]
    fn messages_name_objects() {
        let objects = objects();
        let text = "0x10040 and 0x10100 in 0x4000, not 0x7, 0x400f, 0x4010, 0x20000, 0xfffffffffffffffffff or 0x";
        let named =
            "leaf+0x40 and leaf+0x100 in leaf.storage, not 0x7, (own), 0x4010, a-b, 0xfffffffffffffffffff or 0x";
        assert_eq!(objects.named(text), named);
    }
}
