//! The browser's driver reports every failure in time and leaves no process behind.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::harness::browser::{program, program_among, visit};

#[test]
fn without_a_browser_the_remedy_is_named_in_one_line() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let error = program_among(None, [folder.path().to_owned()].into_iter()).expect_err("there is none");
    assert!(error.contains("apt-get install chromium") && error.contains("RELIEVO_CHROMIUM"), "{error}");
    assert_eq!(error.lines().count(), 1);
    let chosen = Some(PathBuf::from("/no/such/browser"));
    let error = program_among(chosen, std::iter::empty()).expect_err("there is none");
    assert!(error.contains("RELIEVO_CHROMIUM = /no/such/browser"), "{error}");
    let path = folder.path().join("google-chrome");
    std::fs::write(&path, "").expect("writable");
    assert_eq!(program_among(None, [folder.path().to_owned()].into_iter()), Ok(path.clone()));
    assert_eq!(program_among(Some(path.clone()), std::iter::empty()), Ok(path));
}

#[test]
fn a_page_that_says_nothing_ends_in_time_with_what_it_said_last() {
    let page = br#"<script>fetch("/note", { method: "POST", body: "so far" })</script>"#;
    let start = Instant::now();
    let program = program().expect("the suite needs a browser");
    let error = visit(&program, &[("/", page)], Duration::from_secs(15)).expect_err("it says nothing");
    assert!(error.contains("no result within 15 s") && error.contains("last said: so far"), "{error}");
    assert!(start.elapsed() < Duration::from_secs(60));
}

/// When the driver ends, its processes and those that they started end too.
#[cfg(target_os = "linux")]
#[test]
fn a_browser_that_ends_or_hangs_is_noticed_and_killed_with_its_children() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (ends, hangs, child) =
        (folder.path().join("ends"), folder.path().join("hangs"), folder.path().join("child"));
    script(&ends, "echo no display >&2; exit 3");
    script(&hangs, &format!("sleep 600 & echo $! > {}; wait", child.display()));
    let error = visit(&ends, &[], Duration::from_secs(30)).expect_err("it ends");
    assert!(error.contains("exit status: 3") && error.contains("no display"), "{error}");
    let error = visit(&hangs, &[], Duration::from_secs(2)).expect_err("it hangs");
    assert!(error.contains("no result within 2 s") && error.contains("last said: nothing"), "{error}");
    let child = std::fs::read_to_string(child).expect("written");
    let state = || std::fs::read_to_string(format!("/proc/{}/stat", child.trim())).unwrap_or_default();
    // A killed process may remain listed until its new parent has waited for it.
    let gone = || state().is_empty() || state().contains(") Z ");
    let start = Instant::now();
    while !gone() {
        assert!(start.elapsed() < Duration::from_secs(10), "{} runs on", child.trim());
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[cfg(target_os = "linux")]
fn script(path: &Path, text: &str) {
    use std::os::unix::fs::PermissionsExt;
    std::fs::write(path, format!("#!/bin/sh\n{text}\n")).expect("writable");
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).expect("writable");
}
