//! The hashes of `alike`, as this program and a browser compute them (`crates/relievo-cli/tests/web/scene.rs`).

use crate::alike::{hashes, reduced};

/// Known answers; a change of these is a change of every level that anybody has stored.
const KNOWN: [&str; 4] = [
    "d2faed9a5e5ec970d16db00b5ef45cab61ad180cc98bc1f14702ac3927723867",
    "959c38ea89dc9a9cb2e73d6518c6ed2fa547aff598d7184c20b106d434e3d32c",
    "cbbf0e193c502cba8389784fb11b6632566f02b01e13481159f8fa643584ea7c",
    "a936f228f149dd12c157555300ae05d5116a37457601b3dd4ec7984d3413a9b4",
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
