# Sourced by ./demo, ./check and deploy/*: installs the Debian packages that are missing, builds a preset, makes packages.
# shellcheck shell=bash

hermes_tool_packages=(build-essential cmake ninja-build pkg-config python3)
hermes_library_packages=(
    qtbase5-dev libqt5serialport5-dev libqt5svg5-dev libsdl2-dev libeigen3-dev nlohmann-json3-dev rapidjson-dev libcli11-dev libssl-dev libvalijson-dev libzstd-dev zlib1g-dev
    libbz2-dev liblz4-dev libsqlite3-dev
)
# What is built only where its library is installed: hermes-ros2, hermes-web.
hermes_optional_packages=(cyclonedds-dev libqt5websockets5-dev)
hermes_build_packages=("${hermes_tool_packages[@]}" "${hermes_library_packages[@]}")
hermes_package_packages=("${hermes_optional_packages[@]}" debhelper dpkg-dev fakeroot help2man)
hermes_site_packages=(mkdocs mkdocs-material mkdocstrings mkdocstrings-python-handlers doxygen help2man mandoc)
hermes_long_test_packages=("${hermes_package_packages[@]}" "${hermes_site_packages[@]}" lintian debootstrap systemd-container umockdev
    g++-mingw-w64-x86-64-posix libz-mingw-w64-dev wine64)
# What only some tests need, which are skipped without it; not every Debian has all of it.
hermes_peer_packages=("${hermes_optional_packages[@]}" libfastrtps-dev python3-rosbag python3-websockets)
hermes_test_packages=(codespell iproute2 libpcap-dev python3-jsonschema clang-format tshark python3-matplotlib zsh xvfb openbox xdotool)
hermes_fuzz_packages=(clang libclang-rt-dev)
hermes_bench_packages=(libbenchmark-dev)

# install_missing PACKAGE...: installs those that dpkg does not know as installed; says which; silent when none is missing.
install_missing() {
    local missing=() package
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    local sudo=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || {
            echo "These Debian packages are missing and this user is not root, nor is there sudo: ${missing[*]}" >&2
            return 1
        }
        sudo=(sudo)
    fi
    echo "Installing missing Debian packages: ${missing[*]}"
    "${sudo[@]}" apt-get update -qq &&
        "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# install_wanted PACKAGE...: as install_missing, but does without those that this Debian does not have, and says which.
install_wanted() {
    local known=() package
    for package in "$@"; do
        if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
            apt-cache show "$package" >/dev/null 2>&1; then
            known+=("$package")
        else
            echo "This Debian has no package $package: what needs it is left out"
        fi
    done
    install_missing "${known[@]}" || echo "Left out is what needs these packages"
}

# build_preset PRESET [TARGET...]: configures and builds; everything when no target is named.
build_preset() {
    local preset=$1
    shift
    mkdir -p "build/$preset"
    cmake --preset "$preset" >"build/$preset/configure.log" 2>&1 || {
        cat "build/$preset/configure.log" >&2
        return 1
    }
    echo "Building ($preset) ..."
    cmake --build --preset "$preset" ${1:+--target "$@"}
}

# make_packages FOLDER [OPTION...]: puts the Debian packages of this tree there; the options are those of dpkg-buildpackage. Built
# is a copy of the tree, always at the same place, so that the same tree gives the same packages.
make_packages() {
    local out=$1 work=build/package
    shift
    rm -rf "$work"
    mkdir -p "$work/hermes" "$out"
    tar --exclude=./build --exclude=./.git --exclude=./demo-out -c . | tar -x -C "$work/hermes"
    cp -r deploy/debian "$work/hermes/debian"
    echo "Building packages ..."
    (cd "$work/hermes" && dpkg-buildpackage --no-sign "$@") >"$work/log" 2>&1 || {
        tail -50 "$work/log" >&2
        echo "The whole log: $work/log" >&2
        return 1
    }
    mv "$work"/*.deb "$out"
    echo "Packages in $out:" && (cd "$out" && ls -sh ./*.deb)
}
