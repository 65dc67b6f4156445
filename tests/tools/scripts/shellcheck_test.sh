#!/usr/bin/env bash
# Every tracked shell script passes shellcheck.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
command -v shellcheck >/dev/null || { echo "shellcheck is not installed"; exit 77; }

scripts=()
while IFS= read -r -d '' file; do
    if [[ $file == *.sh ]] || head -c 32 "$file" | grep -qaE '^#!.*\b(ba)?sh'; then
        scripts+=("$file")
    fi
done < <(git ls-files -z)
[[ ${#scripts[@]} -ge 5 ]] || { echo "found only ${#scripts[@]} scripts"; exit 1; }
shellcheck --external-sources --source-path=SCRIPTDIR "${scripts[@]}"
echo "${#scripts[@]} scripts are clean"
