//! Bundles.

use omm_serialize::bundle::{Bundle, Checksums};

/// What is read as a bundle writes back to a bundle of the same contents; with right checksums, to the same bytes.
pub fn bundle_decode(bytes: &[u8]) {
    let Ok(bundle) = Bundle::read(bytes, Checksums::Skip) else { return };
    let again = bundle.to_data().write();
    match Bundle::read(&again, Checksums::Verify) {
        Ok(read) => assert_eq!(read.to_data(), bundle.to_data()),
        Err(error) => panic!("written and refused: {error}"),
    }
    if Bundle::read(bytes, Checksums::Verify).is_ok() {
        assert_eq!(again, bytes, "one content, one encoding");
    }
}
