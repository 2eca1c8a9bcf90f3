//! Progressive meshes as they are stored: read to the bit, and damage is told.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use relievo::ops::mesh::{ProgressiveMesh, SimplifyOptions, simplify};
use serde_json::Value;

use super::{Case, cases, error_of, halves, mesh};
use crate::shapes::sphere;

#[test]
fn what_is_stored_is_read_to_the_bit() {
    for Case { name, progressive, .. } in cases() {
        let json = serde_json::to_vec(&progressive).expect("JSON");
        let read = ProgressiveMesh::from_json(&json).expect("valid");
        assert!(read == progressive, "{name}");
        // Through serde alone.
        let read: ProgressiveMesh = serde_json::from_slice(&json).expect("valid");
        let hashes = (0..read.levels()).all(|level| read.hash(level) == progressive.hash(level));
        assert!(read == progressive && hashes, "{name}");
        let mut all: Vec<&str> = (0..read.levels()).map(|level| read.hash(level)).collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), read.levels(), "{name}: hashes differ");
    }
}

/// The path of the error for what was stored and then changed.
fn refused(stored: &Value, change: impl Fn(&mut Value)) -> String {
    let mut stored = stored.clone();
    change(&mut stored);
    let json = serde_json::to_vec(&stored).expect("JSON");
    error_of(ProgressiveMesh::from_json(&json)).path
}

#[test]
fn damage_is_told_with_its_place() {
    let Case { progressive, .. } = cases().remove(2);
    let stored = serde_json::to_value(&progressive).expect("JSON");
    let refused = |change: &dyn Fn(&mut Value)| refused(&stored, change);
    let huge = u64::from(u32::MAX);
    assert_eq!(refused(&|all| all["version"] = 2.into()), "version");
    assert_eq!(refused(&|all| all["levels"][1]["hash"] = "0".into()), "levels[1].hash");
    assert_eq!(refused(&|all| all["levels"][1]["vertices"] = 1.into()), "levels[1].vertices");
    assert_eq!(refused(&|all| all["levels"][0]["error"] = 1.into()), "levels[0].error");
    assert_eq!(refused(&|all| all["levels"][2]["error"] = huge.into()), "mesh.levels[1].error");
    assert_eq!(refused(&|all| all["sources"][0] = all["sources"][1].clone()), "sources[1]");
    assert_eq!(refused(&|all| all["partners"][3] = huge.into()), "mesh.partners[3]");
    assert_eq!(refused(&|all| all["triangles"][0] = huge.into()).split('[').next(), Some("patches"));
    assert_eq!(refused(&|all| all["patches"][0]["added"][1][0] = huge.into()), "patches[0].added[1]");
    assert_eq!(refused(&|all| all["patches"][1]["corners"][0][0] = huge.into()), "patches[1].corners[0]");
    assert_eq!(refused(&|all| all["patches"][0]["first"] = 1.into()), "patches[0]");
    assert_eq!(refused(&|all| all["influences"][4][0][1] = huge.into()), "influences[4]");
    assert_eq!(refused(&|all| all["influences"][4] = Value::Array(Vec::new())), "influences[4]");
    assert_eq!(refused(&|all| all["positions"][4][1] = 0x7f80_0000.into()), "mesh.positions[4][1]");
    // One bit of a number that nothing but the hash knows.
    let flip = |number: &mut Value| *number = (number.as_u64().expect("bits") ^ 1).into();
    assert_eq!(refused(&|all| flip(&mut all["uv"][0][0])), "levels[0].hash");
    assert_eq!(
        refused(&|all| all["weight_keys"][0]["times"] = Value::Array(Vec::new())),
        "weight_keys[0].times.len"
    );
    assert_eq!(refused(&|all| all["weight_keys"][0]["targets"] = huge.into()), "weight_keys[0].targets");
    assert_eq!(refused(&|all| all["weights"][0] = 0x7fc0_0000.into()), "mesh.weights[0]");
    assert_eq!(refused(&|all| all["patches"] = Value::Array(Vec::new())), "patches.len");
    assert_eq!(refused(&|all| all["uv"] = "none".into()), "uv");
}

fn settings() -> ProptestConfig {
    ProptestConfig {
        cases: 1000,
        rng_seed: RngSeed::Fixed(2026),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// A small mesh, as JSON.
fn small() -> Vec<u8> {
    static SMALL: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();
    let make = || {
        let shape = sphere(8, 6);
        let simplified = simplify(&shape.with_uv(), &SimplifyOptions::default()).expect("valid");
        let chosen = halves(&simplified, shape.triangles());
        let progressive = ProgressiveMesh::new(&mesh(&shape, 3), &simplified, &chosen).expect("valid");
        serde_json::to_vec(&progressive).expect("JSON")
    };
    SMALL.get_or_init(make).clone()
}

proptest! {
    #![proptest_config(settings())]

    /// Damaged bytes give an error, or a mesh whose levels are right: what the hash does not cover, such as a name.
    #[test]
    fn damaged_bytes_never_panic(damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4), digits in any::<bool>()) {
        let mut json = small();
        for (at, byte) in damage {
            let at = at.index(json.len());
            // Another digit instead of a digit reaches further than a syntax error.
            let is_digit = digits && json[at].is_ascii_digit();
            json[at] = if is_digit { b'0' + byte % 10 } else if digits { json[at] } else { byte };
        }
        if let Ok(read) = ProgressiveMesh::from_json(&json) {
            let known = ProgressiveMesh::from_json(&small()).expect("valid");
            for level in 0..read.levels() {
                prop_assert!(read.hash(level) == known.hash(level), "level {level}");
            }
        }
    }
}
