//! The hashes of `alike`, as this program and a browser compute them (`crates/relievo-cli/tests/web/scene.rs`).

use crate::alike::{hashes, reduced};

/// Known answers; a change of these is a change of every level that anybody has stored.
const KNOWN: [&str; 4] = [
    "9b9f232afa39563f2e6cbc136ac8219866cb6246426633230b792f075bb66919",
    "47c7289c8b6ddc1261ea57602ab80649dc1d9fc91cd6695b20828399ea533652",
    "2d489b76e21f2801bf17b7cc6e22902870551d3949ef0e4b0b7481a8a8702aca",
    "9ac3532a09de83eb94aa891d20b76c61258b5e44d36fa3156958809a28d0be36",
];

#[test]
fn sequences_are_the_same_everywhere() {
    assert_eq!(hashes(), KNOWN);
}

/// Known answers of the other reducers.
const REDUCED: [&str; 6] = [
    "melax: 00fad3f92fac cc8c8feaa077 18af20fcfe5f | 13d570f6b90f 594efc88b80f d3595d08c3ab",
    "full-edge: 778af6b75781 21f4979ee4f4 124bdd8b8bcb | 41767f5e5c77 b20810a2e249 c7b70bbd9de9",
    "vertex-pair: b1f540c6ce1c 7d39a4e8fff7 9292408056e9 | 41767f5e5c77 b20810a2e249 82136725c4bc",
    "uniform-clustering: 7e2a8fce1d9e 0a9f28c18215 8eb8f479b803 | f2f36fc6d734 d38971c3fb70 a760c60d4f48",
    "importance-clustering: 52f79db2b805 81b1e180b399 ef1f67be8281 | 0c32422d1223 69323e43b121 a3aefae84d93",
    "vertex-removal: 50e5d9f3bde7 ee6c35c80663 271ed5e6e2e6 | b5dfeb134333 a5550fa52a1b 0386da98b794",
];

#[test]
fn reduced_meshes_are_the_same_everywhere() {
    assert_eq!(reduced(), REDUCED);
}
