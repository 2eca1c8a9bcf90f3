//! The toolchain that compiles for browsers.

use relievo_testing::wasm::Toolchain;

#[test]
fn without_a_toolchain_the_remedy_is_named_in_one_line() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (own, debian) = (folder.path().join("own"), folder.path().join("debian"));
    let file = |path: &str| {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
        std::fs::write(path, "").expect("writable");
    };
    let fails = || {
        let error = Toolchain::among(&own, &debian).expect_err("there is none");
        assert!(
            error.contains("rustup target add") && error.contains("apt-get install rustc-web"),
            "{error}"
        );
        assert_eq!(error.lines().count(), 1);
    };
    fails();
    file("debian/bin/cargo");
    file("debian/bin/rustc");
    file("debian/lib/rustlib/src/rust/library/std/Cargo.toml");
    // Every part is needed.
    fails();
    file("debian/bin/wasm-ld-14");
    file("debian/bin/wasm-ld-22");
    let linker = debian.join("bin/wasm-ld-22");
    let expected = Toolchain::Debian { folder: debian.join("bin"), linker };
    assert_eq!(Toolchain::among(&own, &debian), Ok(expected));
    file("own/lib/rustlib/wasm32-unknown-unknown/lib/libstd.rlib");
    assert_eq!(Toolchain::among(&own, &debian), Ok(Toolchain::Own));
}
