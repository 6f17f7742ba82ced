//! Drivers that depart from the specification, recognised by what they write. Their data is read like any other.

use crate::Blob;

/// How a driver departs from the specification.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Departure {
    /// The first 16 bytes are not the driver's UUID but the start of its version in letters, and bytes 16 to 31, which should say
    /// what is compatible, repeat them. lavapipe 25.0.7 writes this.
    VersionTextForUuids,
}

impl Departure {
    /// What was found and what follows from it, in a sentence for each.
    #[must_use]
    pub const fn explanation(self) -> &'static str {
        match self {
            Self::VersionTextForUuids => {
                "the first 16 bytes are no driver UUID but the start of a driver version in letters, and the compatibility UUID \
                 repeats them, as lavapipe writes it; that driver ignores bytes 16 to 31 when it is asked for compatibility, and its \
                 driverUUID property is another value, so compare with data that it wrote and not with the property"
            }
        }
    }
}

impl Blob<'_> {
    /// The departure that the data shows, if it shows one that is known.
    #[must_use]
    pub fn departure(&self) -> Option<Departure> {
        let prefix = self.prefix();
        let text = prefix.driver_uuid.0;
        let version = text.first().is_some_and(u8::is_ascii_digit)
            && text.contains(&b'.')
            // A shorter version would be filled up with zeros.
            && text.iter().all(|byte| byte.is_ascii_graphic() || *byte == 0);
        (version && prefix.driver_uuid == prefix.compatibility_uuid).then_some(Departure::VersionTextForUuids)
    }

    /// The text in the place of the driver UUID, if the data departs in that way.
    #[must_use]
    pub fn version_text(&self) -> Option<String> {
        self.departure().map(|Departure::VersionTextForUuids| {
            let text = self.prefix().driver_uuid.0;
            String::from_utf8_lossy(&text).trim_end_matches('\0').to_owned()
        })
    }
}
