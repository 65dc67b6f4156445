#!/usr/bin/env bash
# ci_run_test.sh - the last line and the exit code of .ci/run for every way a test run can end.
# tools/test is replaced by a script that prints what ctest 3.25 prints.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=check.sh
source "$here/check.sh"
mkdir "$scratch/.ci" "$scratch/tools"
cp "$here/../../../.ci/run" "$scratch/.ci/run"

# A test run that prints $1, '@' being a tab, and exits with $2, for both presets.
test_prints() {
    tr '@' '\t' <<<"$1" >"$scratch/text"
    printf '#!/bin/bash\ncat "%s"\nexit %s\n' "$scratch/text" "$2" >"$scratch/tools/test"
    chmod +x "$scratch/tools/test"
}

# Runs .ci/run with the options; sets `last` and `code`.
run_ci() {
    code=0
    last=$("$scratch/.ci/run" "$@" 2>&1 | tail -n 1) || code=$?
}

test_prints "100% tests passed, 0 tests failed out of 123" 0
run_ci --fast
expect_equal "all passed" "$last/$code" "123 passed, 0 failed/0"
run_ci
expect_equal "both presets are summed" "$last/$code" "246 passed, 0 failed/0"

test_prints "43% tests passed, 4 tests failed out of 7

Total Test time (real) =   1.11 sec

The following tests did not run:
@  4 - d (Skipped)
@  5 - e (Disabled)
@  6 - f (Skipped)

The following tests FAILED:
@  2 - b (Failed)
@  3 - c (Not Run)
@  7 - g (Timeout)
@  8 - h (SEGFAULT)" 8
run_ci --fast
expect_equal "failed, missing, skipped and disabled" "$last/$code" "1 passed, 4 failed, 3 skipped/8"

test_prints "92% tests passed, 1 tests failed out of 12" 8
run_ci --fast
expect_equal "one failure" "$last/$code" "11 passed, 1 failed/8"

test_prints "FAILED: the build stopped" 1
run_ci --fast
expect_equal "a build that fails counts as a failure" "$last/$code" "0 passed, 1 failed/1"

test_prints "nothing was run" 0
run_ci --fast
expect_equal "a run without a summary is a failure" "$last/$code" "0 passed, 1 failed/1"

test_prints "100% tests passed, 0 tests failed out of 3" 5
run_ci --fast
expect_equal "an exit code is never lost" "$last/$code" "3 passed, 1 failed/5"

finish
