//! The hashes of `alike`, as this program and a browser compute them (`tests/web/scene.rs`).

use crate::alike::hashes;

/// Known answers; a change of these is a change of every level that anybody has stored.
const KNOWN: [&str; 4] = [
    "53c122404ee7decd530405091af6776136b5eab5b117ed06f402d1b106d32e27",
    "18d09f2beda28fe8bcf330b71c8259eae0e66b615c55e436641a128c2b604e0c",
    "7031ac102718632c3e14406ff18c827b1bedc4e55e0493bd9d17ca28ccccc713",
    "d2e28fb8d2db2ba3134d1bcbed2b8ebe931d8317604f2b8a08a2d0be446a20b1",
];

#[test]
fn sequences_are_the_same_everywhere() {
    assert_eq!(hashes(), KNOWN);
}
