//! A bundle field by field: what each of its bytes is.

use omm_layout::object::Field;
use omm_model::special_index::OpacityMicromapSpecialIndex;
use omm_model::usage::MicromapUsage;

use super::section::SectionKind;
use super::{Bundle, BundledMicromap, MAGIC, VERSION};

impl Bundle<'_> {
    /// Gives `visit` every field from the first byte to the last: each begins where the one before it ended, and the last ends with
    /// the file.
    pub fn describe(&self, visit: &mut dyn FnMut(Field)) {
        let mut walk = Walk { bytes: self.bytes, at: 0, visit };
        walk.field(8, "magic".to_owned(), format!("\"{}\"", MAGIC.escape_ascii()));
        walk.field(4, "version".to_owned(), VERSION.to_string());
        let sections = self.micromaps.len() * SectionKind::ALL.len();
        walk.field(8, "sections".to_owned(), format!("{sections}, {} for each micromap", SectionKind::ALL.len()));
        for (index, micromap) in self.micromaps.iter().enumerate() {
            walk.micromap(micromap, index);
        }
    }
}

/// A position that only moves forwards.
struct Walk<'a, 'v> {
    bytes: &'a [u8],
    at: u64,
    visit: &'v mut dyn FnMut(Field),
}

impl Walk<'_, '_> {
    /// The next `size` bytes; no field at all if that is 0.
    fn field(&mut self, size: u64, name: String, value: String) {
        if size > 0 {
            (self.visit)(Field { offset: self.at, size, name, value });
        }
        self.at += size;
    }

    /// The next 4 bytes.
    fn number(&self) -> u32 {
        let bytes = usize::try_from(self.at).ok().and_then(|at| self.bytes.get(at..)?.first_chunk());
        bytes.map_or(0, |bytes| u32::from_le_bytes(*bytes))
    }

    fn micromap(&mut self, micromap: &BundledMicromap<'_>, index: usize) {
        for kind in SectionKind::ALL {
            let path = format!("micromaps[{index}].{}", kind.name());
            let name = |field: &str| format!("{path}.{field}");
            let size = micromap.contents(kind).len() as u64;
            self.field(4, name("kind"), format!("{} ({})", kind.value(), kind.name()));
            self.field(4, name("micromap"), index.to_string());
            self.field(4, name("checksum"), format!("{:#010x}", self.number()));
            self.field(8, name("length"), format!("{size} bytes"));
            match kind {
                SectionKind::Name => self.field(size, path, format!("{:?}", micromap.name)),
                SectionKind::Array => self.field(size, path, "packed elements".to_owned()),
                SectionKind::Triangles => self.triangles(micromap, &path),
                SectionKind::Indices => self.indices(micromap, &path),
                SectionKind::UsageCounts => self.usage(micromap.usage_counts(), &path),
                SectionKind::IndexUsageCounts => self.usage(micromap.index_usage_counts(), &path),
                SectionKind::Settings => self.field(size, path, micromap.settings.to_owned()),
                SectionKind::Sources => self.sources(micromap, &path),
                SectionKind::Statistics => self.field(size, path, micromap.statistics.to_owned()),
            }
        }
    }

    fn triangles(&mut self, micromap: &BundledMicromap<'_>, path: &str) {
        for (index, triangle) in micromap.triangles().enumerate() {
            let (at, level, states) =
                (triangle.data_offset, triangle.subdivision_level.get(), 2 * triangle.format.value());
            self.field(8, format!("{path}[{index}]"), format!("data at {at}, level {level}, {states}-state"));
        }
    }

    fn indices(&mut self, micromap: &BundledMicromap<'_>, path: &str) {
        for (position, index) in micromap.indices().enumerate() {
            let value = match OpacityMicromapSpecialIndex::from_value(index) {
                Some(special) => format!("{index} ({special:?})"),
                None => format!("triangles[{index}]"),
            };
            self.field(4, format!("{path}[{position}]"), value);
        }
    }

    fn usage(&mut self, counts: impl Iterator<Item = MicromapUsage>, path: &str) {
        for (index, MicromapUsage { count, subdivision_level, format }) in counts.enumerate() {
            let (level, states) = (subdivision_level.get(), 2 * format.value());
            self.field(12, format!("{path}[{index}]"), format!("{count} of level {level}, {states}-state"));
        }
    }

    fn sources(&mut self, micromap: &BundledMicromap<'_>, path: &str) {
        self.field(8, format!("{path}.count"), micromap.sources().count().to_string());
        for (index, source) in micromap.sources().enumerate() {
            let name = |field: &str| format!("{path}[{index}].{field}");
            self.field(8, name("name.length"), format!("{} bytes", source.name.len()));
            self.field(source.name.len() as u64, name("name"), format!("{:?}", source.name));
            self.field(8, name("length"), format!("{} bytes", source.length));
            self.field(32, name("sha256"), source.sha256.iter().map(|byte| format!("{byte:02x}")).collect());
        }
    }
}
