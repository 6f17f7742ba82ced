//! What two drivers wrote reads as `cases.json` says, and writes back byte for byte.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stderr)]

use std::path::{Path, PathBuf};

use omm_model::profile::DeviceProfile;
use omm_serialize::{Blob, ByteOrder, Certainty, Departure, DetectedOrder, ObjectKind, compatibility, kind};
use serde_json::Value;

fn drivers() -> Vec<PathBuf> {
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/golden");
    let root = std::env::var_os("OMM_GOLDEN").map_or_else(|| PathBuf::from(default), PathBuf::from);
    let Ok(folders) = std::fs::read_dir(root.join("blobs")) else {
        eprintln!("skipped: golden data absent ({})", root.display());
        return Vec::new();
    };
    let drivers: Vec<_> = folders.map(|folder| folder.unwrap().path()).collect();
    assert!(!drivers.is_empty(), "the folder holds no drivers");
    drivers
}

fn check(folder: &Path, case: &Value) {
    let name = case["name"].as_str().unwrap();
    let bytes = std::fs::read(folder.join(case["blob"].as_str().unwrap())).unwrap();
    assert_eq!(case["blob_length"], bytes.len(), "{name}");
    let (blob, detected) = Blob::read_detected(&bytes).unwrap();
    assert_eq!(detected, DetectedOrder::Certain(ByteOrder::Little), "{name}");

    let header = &case["header"];
    let summary = serde_json::to_value(blob.summary()).unwrap();
    assert_eq!(summary["driver_uuid"], header["driver_uuid"], "{name}");
    assert_eq!(summary["compatibility_uuid"], header["compat_uuid"], "{name}");
    for field in ["serialized_size", "deserialized_size", "handle_count"] {
        assert_eq!(summary[field], header[field], "{name}: {field}");
    }
    let handles: Vec<_> =
        header["handles"].as_array().unwrap().iter().map(|handle| &handle["device_address"]).collect();
    assert_eq!(summary["handles"].as_array().unwrap().iter().collect::<Vec<_>>(), handles, "{name}");
    assert_eq!(summary["blocks"], Value::Array(Vec::new()), "{name}");
    assert_eq!(header["handle_count_hex"], format!("{:#018x}", handles.len()), "{name}");
    let next: String = blob.payload()[..16].iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(header["next_16_bytes"], next, "{name}");
    assert_eq!(case["queries"]["SERIALIZATION_SIZE"], blob.prefix().serialized_size, "{name}");
    assert_eq!(case["queries"]["SIZE"], blob.prefix().deserialized_size, "{name}");

    let guess = blob.kind();
    let real = case["kind"].as_str().unwrap();
    assert!(guess.candidates.iter().any(|candidate| kind::name(*candidate) == real), "{name}: {guess:?}");
    let certain = !handles.is_empty();
    assert_eq!(guess.certainty == Certainty::Certain, certain, "{name}");
    assert_eq!(guess.kind(), certain.then_some(ObjectKind::TopLevel), "{name}");
    assert_eq!(summary["kind"]["name"], if certain { "tlas" } else { "unknown" }, "{name}");

    assert_eq!(blob.header().write(ByteOrder::Little, blob.payload()), bytes, "{name}");
    let swapped = blob.header().write(ByteOrder::Big, blob.payload());
    let (again, detected) = Blob::read_detected(&swapped).unwrap();
    assert_eq!(detected, DetectedOrder::Certain(ByteOrder::Big), "{name}");
    assert_eq!(again.header(), blob.header(), "{name}");

    let lavapipe = folder.to_string_lossy().contains("lavapipe");
    assert_eq!(blob.departure(), lavapipe.then_some(Departure::VersionTextForUuids), "{name}");
    assert_eq!(blob.version_text(), lavapipe.then(|| "25.0.7-2+deb13u1".to_owned()), "{name}");
    let mut end = 0;
    blob.describe(&mut |field| {
        assert_eq!(field.offset, end, "{name}: {field:?}");
        end += field.size;
    });
    assert_eq!(end, bytes.len() as u64, "{name}");

    check_compatibility(case, &bytes);
}

/// As the chapter has it, not as lavapipe does, which looks at the first UUID only.
fn check_compatibility(case: &Value, bytes: &[u8]) {
    let (blob, _) = Blob::read_detected(bytes).unwrap();
    let device = DeviceProfile {
        driver_uuid: blob.prefix().driver_uuid,
        compatibility_uuid: blob.prefix().compatibility_uuid,
        ..DeviceProfile::reference()
    };
    let answer = |bytes: &[u8]| if compatibility(bytes, &device) { "COMPATIBLE" } else { "INCOMPATIBLE" };
    let flipped = |at: usize| {
        let mut bytes = bytes.to_vec();
        bytes[at] ^= 1;
        bytes
    };
    assert_eq!(case["compat"]["as_is"], answer(bytes));
    assert_eq!(case["compat"]["byte_0_flipped"], answer(&flipped(0)));
    let departs = blob.prefix().driver_uuid == blob.prefix().compatibility_uuid;
    assert_eq!(case["compat"]["byte_16_flipped"] == answer(&flipped(16)), !departs);
    assert!((0..32).all(|at| !compatibility(&flipped(at), &device)));
    assert!(compatibility(&flipped(32), &device));
    assert!(!compatibility(&bytes[..31], &device));
}

#[test]
fn blobs_of_two_drivers() {
    for folder in drivers() {
        let cases: Value = serde_json::from_slice(&std::fs::read(folder.join("cases.json")).unwrap()).unwrap();
        let cases = cases["cases"].as_array().unwrap();
        cases.iter().for_each(|case| check(&folder, case));
        let files = std::fs::read_dir(&folder).unwrap();
        let blobs =
            files.filter(|file| file.as_ref().unwrap().path().extension().is_some_and(|end| end == "blob")).count();
        assert!(blobs > 0 && cases.len() == blobs, "{}: every blob has a case", folder.display());
    }
}
