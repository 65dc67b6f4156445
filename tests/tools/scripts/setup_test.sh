#!/usr/bin/env bash
# setup_test.sh - tools/setup with stand-ins for dpkg-query, apt-get and sudo: what it asks for, and
# what it says when it cannot go on.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=check.sh
source "$here/check.sh"
setup=$here/../../../tools/setup

# A machine: $scratch/installed lists its packages, $scratch/calls what was run.
machine() {
    rm -rf "${scratch:?}/bin" "$scratch/calls"
    mkdir "$scratch/bin"
    touch "$scratch/calls"
    printf '%s\n' "$@" >"$scratch/installed"
    printf 'ID=debian\nVERSION_ID="12"\n' >"$scratch/os-release"
    cat >"$scratch/bin/dpkg-query" <<X
#!/bin/bash
grep -qx "\${*: -1}" "$scratch/installed" && echo -n installed
X
    cat >"$scratch/bin/apt-get" <<X
#!/bin/bash
echo "apt-get \$* frontend=\$DEBIAN_FRONTEND" >>"$scratch/calls"
[[ ! -e "$scratch/no-network" ]]
X
    local tool
    for tool in bash env sed tr sort grep; do ln -s "$(command -v $tool)" "$scratch/bin/$tool"; done
    chmod +x "$scratch/bin/dpkg-query" "$scratch/bin/apt-get"
}

# Runs setup on the machine as user id $1; sets `output`, `code` and `calls`.
run_as() {
    local uid=$1
    shift
    code=0
    output=$(PATH=$scratch/bin ROVER_OS_RELEASE=$scratch/os-release ROVER_EFFECTIVE_UID=$uid \
        ROVER_SKIP_SETUP=${skip:-0} "$setup" "$@" 2>&1) || code=$?
    calls=$(cat "$scratch/calls")
}

machine
run_as 0 run
expect_equal "a bare machine succeeds" "$code" 0
expect_contains "says what it installs" "$output" "Installing 14 Debian packages"
all_run=$(sed -n 's/.*first run): //p' <<<"$output")
expect_contains "asks for a compiler" "$all_run" build-essential
expect_contains "asks for what the image needs" "$all_run" "clang-19"
expect_equal "updates, then installs without questions or extras" "$calls" \
    "apt-get -q update frontend=noninteractive
apt-get -q install --yes --no-install-recommends $all_run frontend=noninteractive"

# shellcheck disable=SC2086  # one argument a package is meant
machine $all_run
run_as 1000 run
expect_equal "nothing missing: succeeds without root" "$code" 0
expect_equal "nothing missing: says nothing" "$output" ""
expect_equal "nothing missing: apt-get is not called" "$calls" ""

# shellcheck disable=SC2086
machine ${all_run/ninja-build/}
run_as 0 run
expect_contains "only what is missing is installed" "$calls" \
    "--no-install-recommends ninja-build frontend"

machine
run_as 0 test
expect_contains "tests need more" "$output" clang-format-19
expect_contains "tests need what the program needs" "$output" libeigen3-dev

machine
run_as 1000 run
expect_equal "neither root nor sudo: fails" "$code" 1
expect_contains "neither root nor sudo: says the command" "$output" \
    "Run as root: apt-get install --no-install-recommends"
expect_equal "neither root nor sudo: calls nothing" "$calls" ""

machine
printf '#!/bin/bash\n"$@"\n' >"$scratch/bin/sudo"
chmod +x "$scratch/bin/sudo"
run_as 1000 run
expect_equal "sudo serves instead of root" "$code" 0
expect_contains "sudo keeps the frontend setting" "$calls" "update frontend=noninteractive"

machine
printf 'ID=ubuntu\nVERSION_ID="24.04"\n' >"$scratch/os-release"
run_as 0 run
expect_equal "another system: fails" "$code" 1
expect_contains "another system: says which" "$output" "this is not Debian 12 (found: ubuntu 24.04)"
expect_contains "another system: says the way out" "$output" "ROVER_SKIP_SETUP=1"
skip=1
run_as 0 run
expect_equal "the way out works" "$code$output$calls" 0
skip=0

machine
touch "$scratch/no-network"
run_as 0 run
rm "$scratch/no-network"
expect_equal "no network: fails" "$code" 1
expect_contains "no network: says so" "$output" "check the network"

machine
run_as 0 nonsense
expect_equal "an unknown group fails" "$code" 1
expect_contains "an unknown group is named" "$output" "unknown group 'nonsense'"

finish
