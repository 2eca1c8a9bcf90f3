//! The image comparators, seen failing.

use image::{Rgba, RgbaImage};

use crate::harness::{Tolerance, blesses, check_golden_in};

fn picture() -> RgbaImage {
    RgbaImage::from_fn(64, 48, |x, y| Rgba([(4 * x) as u8, (5 * y) as u8, ((x * y) % 200) as u8, 255]))
}

fn blessed() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let blessing = check_golden_in(folder.path(), "picture", &picture(), Tolerance::IMAGE, true);
    assert!(blessing.expect_err("a blessing run never passes").contains("blessed"));
    folder
}

fn check(folder: &tempfile::TempDir, actual: &RgbaImage) -> Result<(), String> {
    check_golden_in(folder.path(), "picture", actual, Tolerance::IMAGE, false).map(|_| ())
}

#[test]
fn only_a_value_blesses() {
    for (value, expected) in [(None, false), (Some(""), false), (Some("0"), false), (Some("1"), true)] {
        assert_eq!(blesses(value.map(std::ffi::OsStr::new)), expected, "{value:?}");
    }
}

#[test]
fn an_equal_picture_passes_and_rounding_is_forgiven() {
    let folder = blessed();
    assert_eq!(check(&folder, &picture()), Ok(()));
    let mut rounded = picture();
    rounded.pixels_mut().step_by(11).for_each(|pixel| pixel.0[1] = pixel.0[1].saturating_add(1));
    assert_eq!(check(&folder, &rounded), Ok(()));
}

#[test]
fn a_shifted_picture_fails() {
    let shifted = RgbaImage::from_fn(64, 48, |x, y| *picture().get_pixel((x + 2) % 64, y));
    assert!(check(&blessed(), &shifted).expect_err("shifted").contains("exceeds"));
}

#[test]
fn a_patch_of_wrong_colour_fails_and_is_reported() {
    let mut wrong = picture();
    for (x, y) in (0..12).flat_map(|x| (0..12).map(move |y| (x, y))) {
        wrong.put_pixel(20 + x, 20 + y, Rgba([255, 0, 255, 255]));
    }
    let error = check(&blessed(), &wrong).expect_err("a twentieth of the picture is wrong");
    for kind in ["actual", "expected", "difference"] {
        let path = error
            .split(['\u{20}', ','])
            .find(|word| word.contains(kind))
            .expect("the report names its files");
        assert!(std::path::Path::new(path).exists(), "{path}");
    }
}

#[test]
fn a_faint_tint_everywhere_fails() {
    let mut tinted = picture();
    tinted.pixels_mut().for_each(|pixel| pixel.0[0] = pixel.0[0].saturating_add(9));
    assert!(check(&blessed(), &tinted).is_err());
}

#[test]
fn a_missing_an_unreadable_and_a_wrong_sized_golden_fail() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    assert!(check(&folder, &picture()).expect_err("missing").contains("no golden"));
    std::fs::write(folder.path().join("picture.png"), b"not a PNG").expect("writable");
    assert!(check(&folder, &picture()).expect_err("unreadable").contains("no golden"));
    RgbaImage::new(10, 10).save(folder.path().join("picture.png")).expect("writable");
    assert!(check(&folder, &picture()).expect_err("another size").contains("instead of"));
}

#[test]
fn every_golden_is_small_and_documented() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("goldens");
    let text = std::fs::read_to_string(folder.join("README.md")).expect("goldens/README.md");
    assert!(
        text.contains("adapter") && text.contains("tolerance"),
        "goldens/README.md says what they were made with"
    );
    for name in crate::harness::DEMO_VIEWS.iter().chain(crate::harness::DEMO_MAPS) {
        let size =
            std::fs::metadata(folder.join(format!("{name}.png"))).map(|data| data.len()).unwrap_or(u64::MAX);
        assert!(size <= 65_536, "{name}: {size} bytes");
    }
}
