//! The hashes of `alike`, as this program and a browser compute them (`tests/web/scene.rs`).

use crate::alike::hashes;

/// Known answers; a change of these is a change of every level that anybody has stored.
const KNOWN: [&str; 4] = [
    "03c80341922eb0691f1f2c18f14720b5103b9cb7781ce17956df8ef4eefe799d",
    "0c3e7cb58b04c2eb6b8f415fef043a886368b56dbd818d289d325108db85b35d",
    "1c8d49f50dbfdb143074d96c05b35b507b72de3ce50de98867e69edcbee7ddc2",
    "4408e9b9f8b6272dbb22ea0034f0a8d0608d3dbcf888dee8d3a11c6746ec40f2",
];

#[test]
fn sequences_are_the_same_everywhere() {
    assert_eq!(hashes(), KNOWN);
}
