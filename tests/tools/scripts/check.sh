# check.sh - what the tests of the scripts share: expectations that name what they found.
# Sourced; sets `scratch` to a folder that is removed at the end.
# shellcheck shell=bash
set -euo pipefail

failures=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# expect_equal WHAT ACTUAL EXPECTED
expect_equal() {
    [[ "$2" == "$3" ]] && return
    printf 'FAILED: %s\n  found:    %s\n  expected: %s\n' "$1" "$2" "$3"
    failures=$((failures + 1))
}

# expect_contains WHAT TEXT PART
expect_contains() {
    [[ "$2" == *"$3"* ]] && return
    printf 'FAILED: %s\n  found:    %s\n  expected part: %s\n' "$1" "$2" "$3"
    failures=$((failures + 1))
}

# Ends the test: exit code 1 when an expectation failed.
finish() {
    [[ $failures -eq 0 ]] || exit 1
    echo "all expectations hold"
}
