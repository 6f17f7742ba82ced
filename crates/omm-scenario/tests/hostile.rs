//! Any text is read or refused, and whatever is read runs to an end.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use omm_scenario::{Scenario, run};
use proptest::prelude::*;

/// Reads and runs a text; what it says about it.
fn outcome(text: &str) -> String {
    match Scenario::parse("hostile.ron", text).and_then(|scenario| run(&scenario)) {
        Ok(transcript) => transcript.to_string(),
        Err(error) => error.to_string(),
    }
}

/// Scenarios that use every word.
const SEEDS: &[&str] = &[
    include_str!("../../../spec-tests/readme.ron"),
    r#"(title: "a", given: {"leaf": micromap(triangles: ["TOUu", (states: "TO", level: 3, format: two_state, offset: 1, count: 2)], flags:
    [ALLOW_COMPACTION], stride: 12, usage: [(count: 3, level: 4)], size: 4096), "card": blas(geometries: [(triangles: 2, micromap:
    "leaf", base_triangle: 1, index_stride: 4, indices: u16([0, T]), vertex_indices: u8), (aabbs: 1), (triangles: [inactive,
    [(0, 0, 0), (1, 0, 0), (0, 1, NaN)]], vertex_indices: none, transform: [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0]])]), "top":
    tlas(instances: [(of: "card", mask: 255), inactive], pointers: true)}, when: [build(["leaf"]), build("card"), update("card"), clone("leaf",
    "twin"), compact("leaf", "small"), serialize("card", "blob"), write("blob + 3", "00"), compatibility("blob"), deserialize("blob",
    "again"), destroy("leaf"), destroy("blob")], then: [ok, same("leaf", "twin"), maps("card", [0])])"#,
    r#"(title: "b", profile: minimum({"maxGeometryCount": 1}), given: {"pool": query_pool(type: VK_QUERY_TYPE_OCCLUSION, count: 3),
    "cmd": command_buffer(level: SECONDARY, recording: true), "s": structure(type: GENERIC, size: 256), "b": buffer(bytes: [u8(3),
    zeros(4), f32(1.5)], bound: true), "op": vkCreateDeferredOperationKHR({})}, when: [end("cmd"), submit(["cmd"]), create("s"),
    address("s"), record([query("s", size), vkCmdResetQueryPool({"queryPool": "pool", "queryCount": 2})]), only(query("s",
    compacted_size, {"commandBuffer": "cmd"})), vkResetQueryPool(set: {"queryPool": "pool"}, name: "x")], then: [values([1]),
    sizes(structure: 3), incompatible, states("s", ["T"]), positions("s", []), instances("s", []), result(VK_SUCCESS), bytes("b",
    "00"), smaller("s", "s"), report(rule: "VUID-x", at: "…"), undefined("x")])"#,
];

/// What is put in the place of a part of a text.
const PARTS: &[&str] = &[
    "4000000000",
    "-1",
    "18446744073709551615",
    "340282366920938463463374607431768211456",
    "1e400",
    "NaN",
    "null",
    "\"leaf\"",
    "\"\"",
    "[]",
    "()",
    "{}",
    "push(1)",
    "remove",
    "same(\"…\")",
    "\"…\"",
    "\"pInfos[0]\"",
    "inactive",
    "T",
    "VkGeometry()",
    "VkMicromapUsageKHR(count: 3)",
    "vkCreateBuffer({})",
    "vkCreateBuffer({\"…size\": 18446744073709551615})",
    "u16([1])",
    "micromap([\"T\"])",
    "blas(triangles: 4000000000)",
    "micromap([(level: 12, count: 1000000)])",
    "zeros(99999999999)",
    "tlas([])",
    "record([])",
    "only(only(only(end(\"cmd\"))))",
    "(of: \"card\")",
    "\"é…é\"",
    "'x'",
    "r#\"x\"#",
    "/*",
    "*/",
    "//",
    "micromap([(states: \"T\", offset: 4294967295)])",
    "micromap([\"T\", \"T\"], stride: 18446744073709551615)",
    "blas(triangles: 1, indices: u32([0, 0]), index_stride: 9223372036854775807)",
    "structure(type: GENERIC, size: 268435456)",
    "vkCmdBuildAccelerationStructuresKHR({\"ppBuildRangeInfos[0][0].primitiveCount\": 4294967295})",
    "vkCreateQueryPool({\"…queryCount\": 4294967295})",
    "vkAllocateMemory({\"…allocationSize\": 18446744073709551615})",
    "buffer(size: 18446744073709551615)",
    "query_pool(count: 4294967295)",
];

#[test]
fn the_seeds_are_read() {
    for seed in SEEDS {
        Scenario::parse(
            "seed.ron",
            &seed.replace("VUID-x", "VUID-VkAccelerationStructureBuildGeometryInfoKHR-type-03654"),
        )
        .unwrap();
    }
}

#[test]
fn each_part_stands_everywhere() {
    for seed in SEEDS {
        let places: Vec<usize> =
            seed.match_indices(|letter: char| "([{:,".contains(letter)).map(|(at, _)| at + 1).collect();
        // A part in the place of the value that begins there, of which the rest is cut off at the next comma or bracket.
        for (index, part) in PARTS.iter().enumerate() {
            for at in places.iter().skip(index % 7).step_by(7) {
                let rest = &seed[*at..];
                let end = rest.find([',', ')', ']', '}']).unwrap_or(rest.len());
                outcome(&format!("{}{part}{}", &seed[..*at], &rest[end..]));
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn any_mixture_ends(
        seed in 0..SEEDS.len(),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..30, 0..PARTS.len()), 1..5),
    ) {
        let mut letters: Vec<char> = SEEDS[seed].chars().collect();
        for (at, length, part) in cuts {
            let start = at.index(letters.len());
            let end = (start + length).min(letters.len());
            letters.splice(start..end, PARTS[part].chars());
        }
        outcome(&letters.into_iter().collect::<String>());
    }

    #[test]
    fn any_letters_are_refused(text in "[ -~é…\n]{0,200}") {
        outcome(&text);
    }
}
