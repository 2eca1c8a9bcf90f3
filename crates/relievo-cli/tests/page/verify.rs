//! `relievo verify` in the browser: every case that holds natively on SwiftShader holds there.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Duration;

use relievo_testing::browser;
use relievo_testing::wasm::Program;
use serde_json::Value;

use crate::{ALONE, swiftshader};

/// Runs the cases of one kernel after the other, and posts what each said.
const PAGE: &str = r#"<!doctype html><meta charset="utf-8"><script type="module">
const post = (path, body) => fetch(path, { method: "POST", body });
async function main() {
    window.panicked = (message) => post("/result", JSON.stringify({ failed: message }));
    const { default: init, parity } = await import("/scene.js");
    await init({ module_or_path: "/scene_bg.wasm" });
    const all = {};
    for (const stem of await (await fetch("/stems.json")).json()) {
        await post("/note", stem);
        all[stem] = await parity(stem);
    }
    return all;
}
main().catch((error) => ({ failed: String(error.stack || error) })).then((result) => post("/result", JSON.stringify(result)));
</script>"#;

/// A case by its kernel and its name.
type Case = (String, String);

/// All cases on SwiftShader natively, and those that do not hold.
fn native(folder: &Path) -> [BTreeSet<Case>; 2] {
    let path = folder.join("verify.json");
    // Its status tells whether all cases hold.
    let mut command = swiftshader(folder);
    command.args(["verify", "--json"]).arg(&path);
    let output = command.output().expect("started");
    let text = std::fs::read_to_string(&path);
    let text = text.unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(&output.stderr)));
    let report: Value = serde_json::from_str(&text).expect("JSON");
    let text = |case: &Value, field: &str| case[field].as_str().expect("text").to_owned();
    let cases = report["cases"].as_array().expect("a list");
    let of = |holds: bool| {
        let chosen = cases.iter().filter(move |case| !holds || case["holds"] == false);
        chosen.map(|case| (text(case, "stem"), text(case, "case"))).collect()
    };
    [of(false), of(true)]
}

#[test]
fn every_case_that_holds_natively_on_swiftshader_holds_in_the_page() {
    let _alone = ALONE.lock();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [all, failing] = native(folder.path());
    let stems: BTreeSet<&String> = all.iter().map(|(stem, _)| stem).collect();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("web");
    let program = Program { package: "relievo-web-scene", library: "scene", profile: "dev", target: &target };
    program.build(folder.path()).expect("the cases compile for browsers");
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect("built");
    let (script, program) = (read("scene.js"), read("scene_bg.wasm"));
    let list = serde_json::to_vec(&stems).expect("JSON");
    let files = [
        ("/", PAGE.as_bytes()),
        ("/stems.json", list.as_slice()),
        ("/scene.js", script.as_slice()),
        ("/scene_bg.wasm", program.as_slice()),
    ];
    let browser = browser::program().expect("the suite needs a browser");
    let said = browser::visit(&browser, &files, Duration::from_secs(1800)).expect("a result");
    assert!(said["failed"].is_null(), "{}", said["failed"]);
    let mut count = 0;
    for stem in &stems {
        let lines: Vec<&str> =
            said[stem.as_str()].as_array().expect("lines").iter().filter_map(Value::as_str).collect();
        count += lines[0].parse::<usize>().expect("a number");
        let own = |(of, case): &&Case| {
            of == *stem && lines[1..].iter().any(|line| line.contains(&format!("case: {case:?}")))
        };
        let wrong: Vec<&Case> = all.iter().filter(own).filter(|case| !failing.contains(*case)).collect();
        assert!(wrong.is_empty(), "{wrong:?}: {:?}", &lines[1..]);
        let natively = failing.iter().filter(|(of, _)| of == *stem).count();
        assert!(lines.len() - 1 <= natively, "{stem}: {:?}", &lines[1..]);
    }
    println!("{count} cases of {} kernels; natively {} do not hold: {failing:?}", stems.len(), failing.len());
    // A name that is part of another one selects both kernels.
    assert!(count >= all.len() && stems.len() > 30, "{count} of {}", all.len());
}
