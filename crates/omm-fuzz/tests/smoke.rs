//! The targets on seeds, and on seeds with errors.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

/// A small generator of numbers; only its determinism matters.
fn next(state: &mut u64) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state as usize
}

#[test]
fn seeds_and_their_mutations() {
    let seeds = omm_fuzz::seeds();
    assert!(seeds.len() > 20);
    let mut state = 0x9e37_79b9_7f4a_7c15;
    for (_, body) in omm_fuzz::TARGETS {
        for seed in &seeds {
            body(seed);
            for _ in 0..200 {
                let mut bytes = seed.clone();
                for _ in 0..next(&mut state) % 4 {
                    match next(&mut state) % 3 {
                        _ if bytes.is_empty() => bytes.push(next(&mut state) as u8),
                        0 => bytes.truncate(next(&mut state) % bytes.len()),
                        _ => {
                            let at = next(&mut state) % bytes.len();
                            bytes[at] = [0, 1, 0xff, next(&mut state) as u8][next(&mut state) % 4];
                        }
                    }
                }
                body(&bytes);
            }
        }
    }
}
