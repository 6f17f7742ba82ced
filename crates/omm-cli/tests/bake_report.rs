//! The report of `omm bake`, as text and in a browser.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use std::path::Path;
use std::process::Command;

use common::{Folder, glb, names, quad};
use serde_json::json;

/// A name that would run as a script, break out of an attribute and change the title, were it not escaped.
const HOSTILE: &str =
    "</title></b><script>document.title='broken'</script><img src=x onerror=\"document.title='broken'\">\" & '";

/// A folder with `scene.glb`, two meshes that share a texture, the second with a hostile name.
fn scene() -> Folder {
    let folder = Folder::new();
    let (mut json, binary) = quad();
    let primitives = json["meshes"][0]["primitives"].clone();
    // A linear filter leaves a contour that is unknown.
    json["samplers"][0] = json!({ "wrapS": 33071, "wrapT": 33071 });
    json["meshes"] =
        json!([{ "name": "leaf", "primitives": primitives }, { "name": HOSTILE, "primitives": primitives }]);
    folder.write("scene.glb", glb(&json, &binary));
    folder
}

fn report(folder: &Folder) -> String {
    let path = folder.path("report.html");
    folder.bake("scene.glb", &["--level", "5", "--report", path.to_str().unwrap(), "--format", "json"]).json();
    String::from_utf8(folder.read("report.html")).unwrap()
}

#[test]
fn the_report_holds_everything_and_fetches_nothing() {
    let folder = scene();
    let page = report(&folder);
    assert!(page.contains("<title>Opacity micromaps of scene.glb</title>"));
    assert_eq!(page.matches("<section id=").count(), 2);
    // An overlay and a close-up of each, and the overview of the texture that they share.
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 5);
    assert_eq!(page.matches("<script>").count(), 1, "names are escaped");
    assert!(!page.contains("http://") && !page.contains("https://") && !page.contains("onerror=\""));
    assert!(page.contains("&lt;img src=x onerror=&quot;document.title=&#39;broken&#39;&quot;&gt;"));
    assert!(page.contains("default-src 'none'"));
    // The same bytes each time.
    assert_eq!(report(&folder), page);
}

#[test]
fn a_report_appears_with_the_results_or_not_at_all() {
    let folder = scene();
    let path = folder.path("absent/deeper/report.html");
    folder.bake("scene.glb", &["--report", path.to_str().unwrap()]).clean();
    assert_eq!(names(&folder.path("absent/deeper")), ["report.html"]);
    let directory = folder.path("out");
    let text = folder.bake("scene.glb", &["--report", directory.to_str().unwrap()]).error().to_owned();
    assert!(text.contains("out: cannot write: "), "{text}");
}

/// The browser, if one is installed; says so if none is.
fn browser() -> Option<&'static str> {
    let found = ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(|name| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success()));
    if found.is_none() {
        println!("skipped: no chromium to open the report in");
    }
    found
}

fn open(browser: &str, profile: &Path, page: &Path, what: &str) -> String {
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--window-size=1200,1600",
        ])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(what)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_report_opens_in_a_browser() {
    let Some(browser) = browser() else { return };
    let folder = scene();
    report(&folder);
    let (profile, page) = (folder.path("profile"), folder.path("report.html"));
    let document = open(browser, &profile, &page, "--dump-dom");
    assert!(document.contains("data-ready=\"true\""), "the script has run");
    assert!(document.contains("<title>Opacity micromaps of scene.glb</title>"), "no name has run as a script");
    // Each of the three viewers has fitted its picture and says how large it is shown.
    assert_eq!(document.matches("transform: translate(").count(), 3);
    assert_eq!(document.matches(" %</output>").count(), 3);
    let changed = |text: &str, name: &str| {
        folder.write(name, text);
        open(browser, &profile, &folder.path(name), "--dump-dom")
    };
    // Buttons and keys zoom, each by a half. What was added to the page runs only without its policy.
    let text = String::from_utf8(folder.read("report.html")).unwrap();
    let added = "<script>addEventListener('load', () => { document.title = 'changed'; \
                 const press = action => document.querySelector(`[data-action=${action}]`).click(); press('one'); press('in'); \
                 document.querySelector('.stage').dispatchEvent(new KeyboardEvent('keydown', { key: '+' })); })</script></body>";
    let tampered = text.replace("</body>", added);
    assert!(changed(&tampered, "tampered.html").contains("<title>Opacity micromaps of scene.glb</title>"));
    let (before, rest) = tampered.split_once("<meta http-equiv").unwrap();
    let open_page = [before, rest.split_once('>').unwrap().1].concat();
    let pressed = changed(&open_page, "pressed.html");
    assert!(pressed.contains("<title>changed</title>") && pressed.contains(">225 %</output>"));
    let picture = folder.path("page.png");
    open(browser, &profile, &page, &format!("--screenshot={}", picture.display()));
    let picture = image::open(&picture).unwrap().to_rgb8();
    let near = |[r, g, b]: [u8; 3]| {
        let close = |(a, b): (u8, u8)| a.abs_diff(b) < 24;
        picture.pixels().filter(|p| close((p.0[0], r)) && close((p.0[1], g)) && close((p.0[2], b))).count()
    };
    // The bars and the legend in the colours of the states, opaque, transparent and unknown opaque.
    for colour in [[46, 168, 76], [66, 115, 235], [250, 205, 50]] {
        assert!(near(colour) > 100, "{colour:?}: {}", near(colour));
    }
}
