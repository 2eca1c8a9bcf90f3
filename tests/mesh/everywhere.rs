//! The hashes of `alike`, as this program and a browser compute them (`tests/web/scene.rs`).

use crate::alike::hashes;

/// Known answers; a change of these is a change of every level that anybody has stored.
const KNOWN: [&str; 4] = [
    "e1e03b831ce191db196e3cc43ee3a37b321113b9d2d7f34e6d9b5227d43a877b",
    "0e4f8cc6c5f057b7f79ac5b8760d3ca3632794e909ac52560aa5952e2c066da9",
    "577ab3f0a869434b037940b0f74176e43242305112bbe260865bd216fad99209",
    "68d83f275e70d007751a5c2ac4718f05f15a573e5de581c7d5887e75648ee0c3",
];

#[test]
fn sequences_are_the_same_everywhere() {
    assert_eq!(hashes(), KNOWN);
}
