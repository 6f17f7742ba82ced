//! Serialized data field by field: what each of its bytes is.

use omm_layout::object::{Field, Object, ObjectHeader};

use crate::Blob;
use crate::blob::Count;
use crate::header::{BLOCK_SIZE, BLOCK_TYPE_OPACITY_MICROMAP};
use crate::summary::Address;

impl Blob<'_> {
    /// Gives `visit` every field from the first byte to the last: each begins where the one before it ended, and the last ends with
    /// the data. Our own payload is named field by field; that of a driver is one field.
    pub fn describe(&self, visit: &mut dyn FnMut(Field)) {
        let mut at = 0;
        let mut field = |size: u64, name: String, value: String| {
            if size > 0 {
                visit(Field { offset: at, size, name, value });
            }
            at += size;
        };
        let prefix = self.prefix();
        field(16, "driver_uuid".to_owned(), prefix.driver_uuid.to_string());
        field(16, "compatibility_uuid".to_owned(), prefix.compatibility_uuid.to_string());
        field(8, "serialized_size".to_owned(), format!("{} bytes of header and payload", prefix.serialized_size));
        field(8, "deserialized_size".to_owned(), format!("{} bytes to create it with", prefix.deserialized_size));
        match prefix.count {
            Count::Handles(count) => field(8, "handle_count".to_owned(), count.to_string()),
            Count::Blocks(count) => {
                field(8, "block_count".to_owned(), format!("{count}, the high half being all ones"));
            }
        }
        for (index, handle) in self.handles().enumerate() {
            field(8, format!("handles[{index}]"), Address(handle).to_string());
        }
        for (index, block) in self.blocks().enumerate() {
            let meaning = match block.block_type {
                BLOCK_TYPE_OPACITY_MICROMAP => "0 (opacity micromaps)".to_owned(),
                other => format!("{other} (unknown)"),
            };
            field(4, format!("blocks[{index}].type"), meaning);
            field(4, format!("blocks[{index}].reserved"), block.reserved.to_string());
            field(8, format!("blocks[{index}].count"), block.addresses().len().to_string());
            for (entry, address) in block.addresses().enumerate() {
                field(8, format!("blocks[{index}].addresses[{entry}]"), Address(address).to_string());
            }
        }
        let size = self.payload().len() as u64;
        match self.to_object() {
            Ok(bytes) => match Object::read(&bytes) {
                Ok(object) => describe_object(&object, &mut field),
                Err(error) => field(size, "payload".to_owned(), error.to_string()),
            },
            Err(error) if self.payload().starts_with(&omm_layout::object::MAGIC) => {
                field(size, "payload".to_owned(), format!("begins as that of the simulated device, but {error}"));
            }
            Err(_) => field(size, "payload".to_owned(), "the driver's own".to_owned()),
        }
    }
}

/// The object without its reference table, which the header has.
fn describe_object(object: &Object<'_>, field: &mut impl FnMut(u64, String, String)) {
    let table = ObjectHeader::SIZE..object.header().body_offset();
    object.describe(&mut |Field { offset, size, name, value }| {
        if !table.contains(&offset) {
            field(size, format!("payload.{name}"), value);
        }
    });
}

const _: () = assert!(BLOCK_SIZE == 4 + 4 + 8);
