#!/bin/bash
# Makes sure that there is a Vulkan adapter and what the build needs besides cargo: installs Debian's packages
# as root, and otherwise says the one command to run. Does nothing, and needs no network, where all is there.
set -euo pipefail

missing=()
have_driver() {
    [ -n "${VK_ICD_FILENAMES:-}${VK_DRIVER_FILES:-}" ] ||
        compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null ||
        compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null
}
have_loader() {
    ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1' || compgen -G '/usr/lib/*/libvulkan.so.1' >/dev/null
}
if [ "$(uname -s)" = Linux ]; then
    have_driver || missing+=(mesa-vulkan-drivers)
    have_loader || missing+=(libvulkan1)
    # FLIP, the image comparison of the tests, is C++.
    command -v c++ >/dev/null || missing+=(g++)
fi
command -v cargo >/dev/null || { echo "cargo is missing: install Rust 1.95 or newer from https://rustup.rs" >&2; exit 1; }
[ ${#missing[@]} -gt 0 ] || exit 0

if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    echo "installing ${missing[*]}"
    export DEBIAN_FRONTEND=noninteractive
    apt-get install -y --no-install-recommends "${missing[@]}" >/dev/null 2>&1 ||
        { apt-get update && apt-get install -y --no-install-recommends "${missing[@]}"; }
else
    echo "missing: ${missing[*]}. Run: sudo apt-get install ${missing[*]}" >&2
    exit 1
fi
