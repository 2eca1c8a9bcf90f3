//! Checks of structs that host and shader share: encase's layout against naga's reflection of the flat shader.

use super::shaders::Shader;

/// Compares the size and member offsets of a struct with those of the shader's struct of the same name.
pub(crate) fn check(shader: &Shader, name: &str, size: u64, offsets: &[u64]) -> Result<(), String> {
    let found = shader.structs.iter().find(|layout| layout.name == name);
    let layout = found.ok_or_else(|| format!("{} has no struct `{name}`", shader.name))?;
    let expected: Vec<u64> = layout.members.iter().map(|member| member.offset.into()).collect();
    if offsets != expected || size != u64::from(layout.size) {
        return Err(format!("{name}: offsets {offsets:?} size {size}, but {layout:?} in {}", shader.name));
    }
    Ok(())
}

/// The value of a `u32` constant of the flat shader.
#[cfg(test)]
pub(crate) fn constant(shader: &Shader, name: &str) -> Option<u32> {
    let line =
        shader.source.lines().find_map(|line| line.trim().strip_prefix(&format!("const {name} = ")))?;
    line.strip_suffix("u;")?.parse().ok()
}

/// Defines a test that a `ShaderType` has the layout of the shader's struct of the same name.
macro_rules! layout_test {
    ($test:ident: $type:ty = $shader:ident $name:literal) => {
        #[cfg(test)]
        #[test]
        fn $test() {
            use encase::ShaderType;
            let metadata = <$type>::METADATA;
            let size = <$type>::min_size().get();
            let shader = &crate::gpu::shaders::$shader;
            assert_eq!(crate::gpu::layout::check(shader, $name, size, &metadata.extra.offsets), Ok(()));
        }
    };
}
pub(crate) use layout_test;

#[test]
fn constants_are_found_by_their_whole_name() {
    let shader = &super::shaders::ANIMATION_BUDGET;
    assert_eq!((constant(shader, "RANK"), constant(shader, "RANKS")), (Some(0), Some(1024)));
    assert_eq!(constant(shader, "RAN"), None);
}

#[test]
fn another_layout_is_refused() {
    let shader = &super::shaders::TERRAIN_PAD;
    assert_eq!(check(shader, "PadParams", 8, &[0, 4]), Ok(()));
    assert!(check(shader, "PadParams", 8, &[0, 8]).is_err());
    assert!(check(shader, "PadParams", 12, &[0, 4]).is_err());
    assert!(check(shader, "PadParams", 8, &[0]).is_err());
    assert!(check(shader, "Nothing", 8, &[0, 4]).is_err());
}
