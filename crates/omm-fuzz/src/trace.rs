//! Traces.

use arbitrary::Unstructured;
use omm_serialize::bundle::Checksums;
use omm_serialize::trace::Trace;

/// What is read as a trace, of bytes or of text, is the same in the other form; with right checksums, bytes are written again.
pub fn trace_decode(bytes: &[u8]) {
    if let Ok(trace) = Trace::read(bytes, Checksums::Skip) {
        both_forms(&trace);
        if Trace::read(bytes, Checksums::Verify).is_ok() {
            assert_eq!(trace.write(), bytes, "one content, one encoding");
        }
    }
    if let Some(trace) = std::str::from_utf8(bytes).ok().and_then(|text| Trace::from_text(text).ok()) {
        both_forms(&trace);
    }
}

/// Whatever is done survives both forms.
pub fn trace_structured(bytes: &[u8]) {
    if let Ok(trace) = crate::made(&mut Unstructured::new(bytes)) {
        both_forms(&trace);
    }
}

fn both_forms(trace: &Trace) {
    assert_eq!(Trace::read(&trace.write(), Checksums::Verify).as_ref(), Ok(trace));
    match trace.to_text() {
        Ok(text) => assert_eq!(Trace::from_text(&text).as_ref(), Ok(trace), "{text}"),
        Err(error) => panic!("{error}: {trace:?}"),
    }
}
