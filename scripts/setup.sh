#!/bin/bash
# Makes sure that there is what the build needs besides cargo, with `adapter` that a Vulkan adapter works, and with
# `browser` that there is the Chromium that the tests compile shaders and draw a scene in, a display for windows without a
# screen (Xvfb), and a Rust that compiles for browsers, with `wasm` that Rust alone:
# installs Debian's packages as root, and otherwise says the one command to run. Does nothing, and needs no network, where
# all is there. PROGRAM has the arguments of cargo for the program that looks for an adapter.
set -euo pipefail
cargo=${CARGO:-cargo}

have_driver() {
    [ -n "${VK_ICD_FILENAMES:-}${VK_DRIVER_FILES:-}" ] ||
        compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null ||
        compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null
}
have_loader() {
    ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1' || compgen -G '/usr/lib/*/libvulkan.so.1' >/dev/null
}
# One that was chosen by name is the user's business.
have_browser() {
    [ -z "${RELIEVO_CHROMIUM:-}" ] || return 0
    for name in chromium chromium-browser google-chrome google-chrome-stable; do
        command -v "$name" >/dev/null && return 0
    done
    return 1
}
# The suite's own Rust with the target, or Debian's Rust for browsers (crates/relievo-testing/src/wasm.rs chooses in the same way).
have_wasm() {
    [ -d "$(rustc --print sysroot 2>/dev/null)/lib/rustlib/wasm32-unknown-unknown" ] ||
        { [ -f /usr/lib/rustlib/src/rust/library/std/Cargo.toml ] && [ -x /usr/bin/cargo ] && [ -x /usr/bin/rustc ] &&
            compgen -c wasm-ld- >/dev/null; }
}
# A driver's file may be there without its library or its hardware: only opening a device tells.
have_adapter() {
    "$cargo" run --quiet ${PROGRAM:-} --bin relievo -- info >/dev/null 2>&1
}
provide() {
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        echo "installing $*"
        export DEBIAN_FRONTEND=noninteractive
        apt-get install -y --no-install-recommends "$@" >/dev/null 2>&1 ||
            { apt-get update && apt-get install -y --no-install-recommends "$@"; }
    else
        echo "missing: $*. Run: sudo apt-get update && sudo apt-get install $*" >&2
        exit 1
    fi
}

command -v "$cargo" >/dev/null || { echo "cargo is missing: install Rust 1.95 or newer from https://rustup.rs" >&2; exit 1; }
missing=()
if [ "$(uname -s)" = Linux ]; then
    have_driver || missing+=(mesa-vulkan-drivers)
    have_loader || missing+=(libvulkan1)
    # FLIP, the image comparison of the tests, is C++.
    command -v c++ >/dev/null || missing+=(g++)
    [ "${1:-}" != browser ] || have_browser || missing+=(chromium)
    [ "${1:-}" != browser ] || command -v Xvfb >/dev/null || missing+=(xvfb)
    [[ "${1:-}" != @(browser|wasm) ]] || have_wasm || missing+=(rustc-web cargo-web rust-web-src lld-22)
elif [[ "${1:-}" = @(browser|wasm) ]] && ! have_wasm; then
    echo "missing: Rust for browsers. Run: rustup target add wasm32-unknown-unknown" >&2
    exit 1
fi
[ ${#missing[@]} = 0 ] || provide "${missing[@]}"

[ "${1:-}" = adapter ] || exit 0
"$cargo" build ${PROGRAM:-} --bin relievo
have_adapter && exit 0
# A driver that was chosen by name is the user's business.
if [ "$(uname -s)" = Linux ] && [ -z "${VK_ICD_FILENAMES:-}${VK_DRIVER_FILES:-}${RELIEVO_ADAPTER:-}" ]; then
    provide mesa-vulkan-drivers
fi
have_adapter || { "$cargo" run --quiet ${PROGRAM:-} --bin relievo -- info >/dev/null; exit 1; }
