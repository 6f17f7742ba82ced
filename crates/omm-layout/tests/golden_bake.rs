//! The arrays that a peer baked read back, entry for entry, and write to the same bytes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stderr)]

use std::path::PathBuf;

use omm_layout::index::IndexType;
use omm_layout::index_buffer::{self, MicromapIndexBuffer};
use omm_layout::packed::PackedStates;
use omm_layout::triangle::{self, TriangleArray};
use omm_model::special_index::TriangleMap;

fn golden(folder: &str) -> Option<PathBuf> {
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/golden");
    let root = std::env::var_os("OMM_GOLDEN").map_or_else(|| PathBuf::from(default), PathBuf::from);
    let path = root.join(folder);
    if !path.is_dir() {
        eprintln!("skipped: golden data absent ({})", path.display());
        return None;
    }
    Some(path)
}

#[test]
fn baked_arrays_read_back() {
    let Some(folder) = golden("bake") else { return };
    let mut jobs = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let Some(name) = path.to_str().and_then(|path| path.strip_suffix(".desc.bin")) else { continue };
        let read = |suffix: &str| std::fs::read(format!("{name}{suffix}")).unwrap();
        let (array, descriptors, indices) = (read(".array.bin"), read(".desc.bin"), read(".index.bin"));

        let triangles = TriangleArray::new(&descriptors, 8, descriptors.len() as u64 / 8).unwrap();
        let raw: Vec<_> = triangles.iter().collect();
        assert_eq!(triangle::write(&raw, 8).unwrap(), descriptors, "{name}");
        for triangle in triangles.checked() {
            let triangle = triangle.unwrap();
            let data = &array[triangle.data_offset as usize..];
            let states = PackedStates::new(data, triangle.format, triangle.subdivision_level).unwrap();
            assert_eq!(states.len() as u32, triangle.subdivision_level.microtriangles());
        }

        let count = indices.len() as u64 / 4;
        let buffer = MicromapIndexBuffer::new(&indices, IndexType::Uint32, 4, 0, count).unwrap();
        let maps: Vec<_> = buffer.iter().map(Result::unwrap).collect();
        for map in &maps {
            if let TriangleMap::Triangle(index) = *map {
                assert!(triangles.get(index.into()).is_some(), "{name}: {index}");
            }
        }
        assert_eq!(index_buffer::write(&maps, IndexType::Uint32, 0).unwrap(), indices, "{name}");
        jobs += 1;
    }
    assert!(jobs > 0, "the folder holds no baked arrays");
}
