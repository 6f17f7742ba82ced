#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| omm_fuzz::trace_decode(bytes));
