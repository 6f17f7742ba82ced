//! The options of `omm bake`, and `omm downsample`, on real files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use common::{Folder, glb, names, omm, quad};
use serde_json::{Value, json};

/// A job of 64 x 64 texels, opaque in a disc, with all mips, and 32 triangles of which each two have the same coordinates.
fn disc() -> Folder {
    let folder = Folder::new();
    let texel = |k: usize, side: usize| {
        let at = |k: usize| (k as f64 + 0.5) / side as f64 - 0.5;
        u8::from(at(k % side).hypot(at(k / side)) < 0.3) * 255
    };
    let mut mips = Vec::new();
    for mip in 0..7 {
        let side = 64 >> mip;
        // Two bytes between rows of the first.
        let gap: &[u8] = if mip == 0 { &[1, 2] } else { &[] };
        let row = |y: usize| (0..side).map(move |x| texel(y * side + x, side)).chain(gap.iter().copied());
        folder.write(&format!("t{mip}.bin"), (0..side).flat_map(row).collect::<Vec<_>>());
        if mip > 0 {
            mips.push(format!("t{mip}.bin"));
        }
    }
    // A 5 x 5 grid of 16-bit coordinates, four bytes apart.
    let uvs = (0..25_u16).flat_map(|k| [k % 5 * 0x3fff, k / 5 * 0x3fff, 7, 7]);
    folder.write("uv.bin", uvs.flat_map(u16::to_le_bytes).collect::<Vec<_>>());
    let corner = |k: u8| k / 4 * 5 + k % 4;
    let cell = |k: u8| [corner(k), corner(k) + 1, corner(k) + 5, corner(k) + 6, corner(k) + 5, corner(k) + 1];
    folder.write("tri.bin", (0..16).flat_map(cell).collect::<Vec<_>>());
    let job = json!({
        "name": "disc",
        "texture": {
            "path": "t0.bin", "width": 64, "height": 64, "format": "unorm8", "row_pitch": 66, "mips": mips,
        },
        "uvs": "uv.bin",
        "uv_format": "unorm16",
        "uv_stride": 8,
        "triangles": "tri.bin",
        "index_format": "uint8",
        "format": "4-state",
        "max_level": 4,
        "address_mode": "clamp",
        "filter": "linear",
        "alpha_cutoff": 0.5,
        "unknown_state_promotion": "nearest",
    });
    folder.write("disc.job.json", job.to_string());
    folder
}

/// The statistics of a bake of the disc.
fn bake(folder: &Folder, options: &[&str]) -> Value {
    let options: Vec<_> = options.iter().chain(&["--format", "json"]).copied().collect();
    folder.bake("disc.job.json", &options).json()[0].clone()
}

fn count(statistics: &Value, pointer: &str) -> u64 {
    statistics.pointer(pointer).and_then(Value::as_u64).unwrap_or_else(|| panic!("{pointer}: {statistics}"))
}

#[test]
fn every_layout_is_read_and_mips_cost_coverage() {
    let folder = disc();
    let known = |options: &[&str]| bake(&folder, options)["known_fraction"].as_f64().unwrap();
    let (first, two, all) = (known(&["--mips", "0"]), known(&["--mips", "0-1"]), known(&[]));
    assert!(0.8 < first && first < 1.0 && two < first && all < two, "{first} {two} {all}");
    // The last mip is a single texel: nothing is mixed.
    assert_eq!(known(&["--mips", "6"]), 1.0);
    assert_eq!(
        folder.refused("disc.job.json", &["--mips", "5-7"]),
        "disc.job.json: disc: mips 5 to 7 are asked for, but the texture has mips 0 to 6"
    );
}

#[test]
fn smoke_has_no_opaque_states() {
    let folder = disc();
    let usual = bake(&folder, &["--mips", "0", "--promotion", "force-opaque"]);
    let smoke = bake(&folder, &["--mips", "0", "--promotion", "force-opaque", "--greater", "uo"]);
    assert_eq!(count(&smoke, "/triangle_states/opaque"), 0);
    assert_eq!(count(&smoke, "/triangle_states/transparent"), count(&usual, "/triangle_states/transparent"));
    assert_eq!(
        count(&smoke, "/triangle_states/unknown_opaque"),
        count(&usual, "/triangle_states/opaque") + count(&usual, "/triangle_states/unknown_opaque")
    );
    let reversed = bake(&folder, &["--mips", "0", "--greater", "t", "--less-or-equal", "o"]);
    assert_eq!(count(&reversed, "/triangle_states/opaque"), count(&usual, "/triangle_states/transparent"));
}

#[test]
fn levels_and_formats_of_single_triangles() {
    let folder = disc();
    folder.write("levels.bin", [[255; 16], [2; 16]].concat());
    folder.write("formats.bin", [[255; 31].as_slice(), &[1]].concat());
    let (levels, formats) = (folder.path("levels.bin"), folder.path("formats.bin"));
    let [levels, formats] = [&levels, &formats].map(|path| path.to_str().unwrap());
    let options = ["--no-special-indices", "--no-merge", "--levels", levels, "--formats", formats];
    let found = bake(&folder, &options);
    let expected = json!([
        { "level": 4, "format": 2, "count": 16 }, { "level": 2, "format": 2, "count": 15 }, { "level": 2, "format": 1, "count": 1 },
    ]);
    assert_eq!(found["histogram"], expected);
    folder.write("levels.bin", [13; 32]);
    assert_eq!(folder.refused("disc.job.json", &options), "levels.bin: byte 0: subdivision level 13 is above 12");
    folder.write("levels.bin", [3; 31]);
    assert_eq!(folder.refused("disc.job.json", &options), "formats.bin: 32 formats for 31 levels");
    assert_eq!(
        folder.refused("disc.job.json", &["--levels", levels]),
        "disc.job.json: disc: there are 31 overrides for 32 triangles: give one for each triangle, or none"
    );
    folder.write("formats.bin", [3; 32]);
    assert_eq!(
        folder.refused("disc.job.json", &["--formats", formats]),
        "formats.bin: byte 0: 3 is no format: neither 1, for 2-state, nor 2, for 4-state"
    );
}

#[test]
fn indices_alignment_and_coverage() {
    let folder = disc();
    let usual = bake(&folder, &[]);
    assert_eq!((&usual["index_type"], count(&usual, "/bytes/index")), (&json!("uint32"), 128));
    let wide = folder.read("out/disc.index.bin");
    let small = bake(&folder, &["--index-type", "auto", "--coverage", "--order", "mesh", "--block-alignment", "256"]);
    assert_eq!((&small["index_type"], count(&small, "/bytes/index")), (&json!("uint8"), 32));
    let special = |bytes: &[u8]| bytes.iter().filter(|&&byte| byte >= 0xfc).count();
    assert_eq!(special(&folder.read("out/disc.index.bin")) * 4, special(&wide));
    // A bundle has 32 bits whatever the file had.
    let (out, bundle, again) = (folder.path("out"), folder.path("b.omm"), folder.path("again"));
    omm(["bundle".as_ref(), "pack".as_ref(), out.as_os_str(), "-o".as_ref(), bundle.as_os_str()]).clean();
    omm(["bundle".as_ref(), "unpack".as_ref(), bundle.as_os_str(), "--out".as_ref(), again.as_os_str()]).clean();
    let widened = folder.read("again/disc.index.bin");
    let narrowed: Vec<u8> = widened.chunks(4).map(|index| index[0]).collect();
    assert_eq!((widened.len(), narrowed), (128, folder.read("out/disc.index.bin")));
    let blocks = count(&small, "/micromap_triangles");
    assert_eq!(count(&small, "/bytes/array"), (blocks - 1) * 256 + 64);
    let coverage: Value = serde_json::from_slice(&folder.read("out/disc.coverage.json")).unwrap();
    assert_eq!(
        (coverage["triangles"].as_array().unwrap().len(), &coverage["area_known_fraction"]),
        (32, &small["area_known_fraction"])
    );
    assert_eq!(
        folder.refused("disc.job.json", &["--block-alignment", "3"]),
        "disc.job.json: disc: the block alignment is 3: it must be a power of two up to 65536"
    );
}

#[test]
fn budgets_are_met_or_refused() {
    let folder = disc();
    let options = ["--mips", "0", "--level", "6"];
    let all = bake(&folder, &options);
    let bytes = count(&all, "/bytes/array");
    let budget = (bytes / 3).to_string();
    let limited = bake(&folder, &[options.as_slice(), &["--max-array-bytes", &budget]].concat());
    assert!(count(&limited, "/bytes/array") <= bytes / 3 && count(&limited, "/lowered") > 0);
    assert!(limited["area_known_fraction"].as_f64() < all["area_known_fraction"].as_f64());
    let refused = folder.refused("disc.job.json", &[options.as_slice(), &["--max-work", "1000"]].concat());
    assert!(
        refused.starts_with("disc.job.json: disc: the bake is ")
            && refused.contains(" microtriangles of 32 triangles, "),
        "{refused}"
    );
    assert!(
        refused.ends_with("but the work budget is 1000: raise it, or choose lower levels or fewer mips"),
        "{refused}"
    );
    let refused = folder.refused("disc.job.json", &["--max-array-bytes", "1", "--no-special-indices"]);
    assert!(
        refused.contains("the array cannot have fewer than ") && refused.contains("but the budget is 1"),
        "{refused}"
    );
    let rejected = bake(&folder, &["--reject", "1", "--mips", "0"]);
    assert_eq!((count(&rejected, "/bytes/array"), count(&rejected, "/rejected") > 0), (0, true));
    let near = bake(&folder, &["--mips", "0", "--merge-distance", "0.25", "--level", "5"]);
    let exact = bake(&folder, &["--mips", "0", "--level", "5"]);
    assert_eq!(
        count(&near, "/near_merged") + count(&near, "/micromap_triangles"),
        count(&exact, "/micromap_triangles")
    );
    assert!(count(&near, "/near_merged") > 0);
    assert_eq!(
        folder.refused("disc.job.json", &["--merge-distance", "0.1", "--no-merge"]),
        "disc.job.json: disc: merge_distance above 0 contradicts no merge: allow merging, or set the distance to 0"
    );
}

#[test]
fn a_dry_run_writes_nothing() {
    let folder = disc();
    let (quad, binary) = quad();
    folder.write("quad.glb", glb(&quad, &binary));
    let dry = |input: &str, options: &[&str]| {
        let input = folder.path(input);
        let arguments = ["bake", input.to_str().unwrap(), "--dry-run"];
        omm(arguments.iter().chain(options).copied())
    };
    let before = names(&folder.path(""));
    let forecast = dry("disc.job.json", &["--mips", "0", "--format", "json"]).json()[0].clone();
    let text = dry("quad.glb", &[]);
    assert!(text.clean().ends_with("predicted; nothing was baked or written\n"), "{text:?}");
    assert_eq!(names(&folder.path("")), before);
    let baked = bake(&folder, &["--mips", "0"]);
    assert_eq!((count(&forecast, "/triangles"), count(&forecast, "/microtriangles")), (32, 32 * 256));
    let [predicted, known] = [&forecast, &baked].map(|json| json["area_known_fraction"].as_f64().unwrap());
    assert!((predicted - known).abs() < 0.05, "{predicted} {known}");
    assert!(count(&forecast, "/array_bytes") >= count(&baked, "/bytes/array"));
    let error = dry("disc.job.json", &["--max-work", "10"]);
    assert!(error.error().contains("but the work budget is 10"));
    assert_eq!(omm(["bake", folder.path("quad.glb").to_str().unwrap()]).status, 2, "without --out");
}

/// What is lowered afterwards is what is baked at the lower level.
#[test]
fn downsampling_is_baking_at_a_lower_level() {
    let folder = disc();
    for options in [[].as_slice(), &["--index-type", "uint8"]] {
        let forced = [options, &["--promotion", "force-opaque"]].concat();
        folder.bake("disc.job.json", &[forced.as_slice(), &["--mips", "0", "--level", "3"]].concat()).clean();
        let expected = ["array", "desc", "index"].map(|part| folder.read(&format!("out/disc.{part}.bin")));
        folder.bake("disc.job.json", &[forced.as_slice(), &["--mips", "0", "--level", "5"]].concat()).clean();
        let (stem, out) = (folder.path("out/disc"), folder.path("low"));
        let mut arguments = vec!["downsample", stem.to_str().unwrap(), "--levels", "2", "--out", out.to_str().unwrap()];
        arguments.extend(&forced);
        let run = omm(arguments.iter().chain(&["--format", "json"]).copied());
        let summary = run.json();
        assert_eq!(count(&summary, "/array_bytes/1"), expected[0].len() as u64);
        let found = ["array", "desc", "index"].map(|part| folder.read(&format!("low/disc.{part}.bin")));
        assert_eq!(found, expected);
        assert!(omm(&arguments).clean().contains("written to "));
    }
    folder.write("out/disc.array.bin", [0; 7]);
    let (stem, out) = (folder.path("out/disc"), folder.path("none"));
    let run = omm(["downsample", stem.to_str().unwrap(), "--index-type", "uint8", "--out", out.to_str().unwrap()]);
    assert!(run.error().ends_with("out/disc: micromap triangle 0 ends at byte 256, but the array has 7"), "{run:?}");
    assert!(!out.exists());
    let run = omm(["downsample", folder.path("absent").to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(run.error().contains("absent.desc.bin: cannot read: "));
}
