//! `--bones`: models of fewer bones.

use serde_json::Value;

use crate::harness::relievo;

const MOMENT: [&str; 6] = ["--model", "builtin", "--clip", "walk", "--time", "0.3"];

/// What the command prints, and the positions of the vertices that it writes.
fn skinned(more: &[&str]) -> (String, Vec<[f32; 3]>) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().to_str().expect("UTF-8");
    let run = relievo(&[&["skin", "--out", out], &MOMENT[..], more].concat());
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    let text = std::fs::read_to_string(folder.path().join("mesh.obj")).expect("written");
    let place = |line: &str| -> [f32; 3] {
        let all: Vec<f32> = line.split(' ').map(|x| x.parse().expect("a number")).collect();
        all.try_into().expect("three")
    };
    (run.stdout, text.lines().filter_map(|line| line.strip_prefix("v ")).map(place).collect())
}

#[test]
fn vertices_are_off_as_little_as_is_said() {
    let (_, full) = skinned(&[]);
    for (bones, left) in [("80", "80 of 153"), ("50%", "77 of 153")] {
        let [(said, gpu), (_, cpu)] =
            ["gpu", "cpu"].map(|name| skinned(&["--bones", bones, "--backend", name]));
        let largest = said.strip_prefix(left).and_then(|said| said.strip_prefix(" bones; vertices are "));
        let largest = largest.and_then(|said| said.split(' ').next()).expect("as documented");
        let largest: f32 = largest.parse().expect("a number");
        let off = |a: &[[f32; 3]], b: &[[f32; 3]]| {
            assert_eq!(a.len(), b.len());
            let distance = |(a, b): (&[f32; 3], &[f32; 3])| glam::Vec3::from(*a).distance((*b).into());
            a.iter().zip(b).map(distance).fold(0.0, f32::max)
        };
        assert!(off(&gpu, &cpu) < 1e-5);
        // The error at this time need not be the largest.
        assert!((0.05 * largest..=1.01 * largest).contains(&off(&gpu, &full)), "{said}");
    }
}

#[test]
fn ends_of_limbs_stay_where_they_are() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("pose.json");
    let out = out.to_str().expect("UTF-8");
    let posed = |more: &[&str]| -> Vec<Value> {
        let run = relievo(&[&["pose", "--out", out], &MOMENT[..], more].concat());
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
        let text = std::fs::read(out).expect("written");
        let pose: Value = serde_json::from_slice(&text).expect("JSON");
        pose["bones"].as_array().expect("a list").clone()
    };
    let full = posed(&[]);
    let few = posed(&["--bones", "40%", "--keep-bone", "hand_right"]);
    assert_eq!((full.len(), few.len()), (153, 62));
    assert!(few.iter().any(|bone| bone["name"] == "hand_right"));
    for bone in &few {
        let same = full.iter().find(|other| other["name"] == bone["name"]).expect("one of them");
        for at in 12..15 {
            let [a, b] = [bone, same].map(|bone| bone["model"][at].as_f64().expect("a number"));
            assert!((a - b).abs() < 5e-3, "{} {a} {b}", bone["name"]);
        }
    }
}

#[test]
fn what_cannot_be_is_refused_in_one_line() {
    for (more, words) in [
        (&["--bones", "0"][..], "bones = 0: must be in 1..=153"),
        (&["--bones", "154"], "bones = 154: must be in 1..=153"),
        (&["--bones", "4"], "bones = 4: must be at least"),
        (&["--bones", "many"], "bones = many: must be a number of bones, or a part of all such as 25%"),
        (&["--bones", "-10%"], "must be above 0"),
        (&["--bones", "NaN%"], "must be above 0"),
        (&["--bones", "80", "--keep-bone", "tail9"], "keep[0] = tail9: must be the name of a bone"),
        (&["--keep-bone", "hips"], "--bones"),
    ] {
        for command in ["skin", "pose"] {
            let run = relievo(&[&[command, "--out", "never"], &MOMENT[..], more].concat());
            assert_eq!(run.code, Some(2), "{}", run.stderr);
            assert!(run.stderr.contains(words) && run.stderr.lines().count() == 1, "{}", run.stderr);
        }
    }
}
