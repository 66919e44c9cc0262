#!/bin/sh
# packages.sh demo|tests: installs what building and the demo, or the tests, need and is not there yet. Debian
# and Ubuntu, through apt-get, as root or with sudo; elsewhere it says what to install.
set -eu

optional=""
wanted="gcc g++ libc6-dev make cmake pkg-config libopenexr-dev libhdf5-dev libvulkan-dev mesa-vulkan-drivers libegl-dev libgl-dev libegl-mesa0 libgl1-mesa-dri glslang-tools libstb-dev libembree-dev"
case ${1:-} in
demo) ;;
tests)
    wanted="$wanted clang clang-format-14 clang-tidy-14 libcmocka-dev vulkan-validationlayers
        spirv-cross"
    # Other machines, locales and languages; what needs them is skipped without.
    optional="locales qemu-user-static gcc-aarch64-linux-gnu libc6-dev-arm64-cross gcc-i686-linux-gnu
        libc6-dev-i386-cross gcc-s390x-linux-gnu libc6-dev-s390x-cross gcc-mingw-w64-x86-64 ninja-build dpkg-dev
        lintian"
    # Shaders in a browser (150 MB to download with what it depends on) and npm packages; what else brings
    # these commands serves as well.
    command -v chromium > /dev/null || command -v google-chrome > /dev/null ||
        optional="$optional chromium-headless-shell"
    command -v node > /dev/null || optional="$optional nodejs"
    command -v npm > /dev/null || optional="$optional npm"
    # The Python module and the pages: 12 MB to download.
    optional="$optional python3-numpy doxygen mandoc"
    # Fits by several processes; any other MPI serves as well.
    command -v mpirun > /dev/null || optional="$optional libopenmpi-dev openmpi-bin"
    # libFuzzer and the sanitizers of clang; the package carries the version of the clang that is installed or
    # will be. Without it clang fuzzes nothing.
    clang=$(clang -dumpversion 2> /dev/null || apt-cache depends clang 2> /dev/null | sed -n 's/.*Depends: clang-//p')
    [ -z "$clang" ] || wanted="$wanted libclang-rt-${clang%%.*}-dev"
    ;;
*)
    echo "usage: sh $0 demo|tests" >&2
    exit 2
    ;;
esac

missing="" also_missing=""
is_installed() {
    dpkg-query -W -f '${Status}\n' "$1" 2> /dev/null | grep -q '^install ok installed'
}
if command -v dpkg-query > /dev/null; then
    for package in $wanted; do
        # An installed package may be given by another one (pkg-config by pkgconf).
        is_installed "$package" || missing="$missing $package"
    done
    for package in $optional; do
        is_installed "$package" || also_missing="$also_missing $package"
    done
else
    for tool in gcc make cmake pkg-config glslangValidator; do
        command -v $tool > /dev/null || {
            echo "no dpkg here and no $tool: install what Debian calls $wanted" >&2
            exit 1
        }
    done
    echo "no dpkg here: taking it that the equivalents of these are installed:" $wanted $optional
fi

if [ -n "$missing$also_missing" ]; then
    install="apt-get install -y --no-install-recommends$missing$also_missing"
    if [ "$(id -u)" = 0 ]; then
        as_root="env DEBIAN_FRONTEND=noninteractive"
    elif command -v sudo > /dev/null; then
        as_root="sudo env DEBIAN_FRONTEND=noninteractive"
    else
        printf 'These packages are missing, and only root can install them:\n\n  %s\n' "$install" >&2
        exit 1
    fi
    log=$(mktemp)
    $as_root apt-get update > "$log" 2>&1 || true # what is missing then is told below
    for package in $also_missing; do
        if apt-cache show "$package" > /dev/null 2>&1; then
            missing="$missing $package"
        else
            echo "no package $package here: what needs it will be skipped"
        fi
    done
    install="apt-get install -y --no-install-recommends$missing"
    [ -z "$missing" ] || echo "installing:$missing"
    [ -z "$missing" ] || $as_root $install >> "$log" 2>&1 || {
        tail -n 20 "$log" >&2
        rm -f "$log"
        printf 'Could not install what is missing. By hand:\n\n  %s\n' "$install" >&2
        exit 1
    }
    rm -f "$log"
fi

version=$(cmake --version | sed -n 's/^cmake version \([0-9]*\.[0-9]*\).*/\1/p')
major=${version%.*} minor=${version#*.}
if [ "$major" -lt 3 ] || { [ "$major" -eq 3 ] && [ "$minor" -lt 25 ]; }; then
    echo "CMake $version is here, 3.25 or later is needed: see https://cmake.org/download/" >&2
    exit 1
fi
