#!/usr/bin/env bash
# headers_test.sh - every firmware and hal header compiles alone, with clang, for this machine and
# for a target whose `int` and pointers have 16 bits as the 8085's have.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
command -v clang++-19 >/dev/null || { echo "clang++-19 is not installed"; exit 77; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mapfile -t headers < <(git ls-files -- 'firmware/*.hpp' 'hal/*.hpp')
[[ ${#headers[@]} -ge 5 ]] || { echo "found only ${#headers[@]} headers"; exit 1; }
for header in "${headers[@]}"; do
    printf '#include "%s"\n' "$header" >"$scratch/${header//\//.}.cpp"
done

options=(-std=c++20 -ffreestanding -fno-exceptions -fno-rtti -fsyntax-only
    -I. -Ifirmware/config/native -Itoolchain/include
    -Wall -Wextra -Wpedantic -Werror -Wshadow -Wconversion -Wsign-conversion)
for target in x86_64-linux-gnu msp430-none-elf; do
    find "$scratch" -name '*.cpp' -print0 |
        xargs -0 --max-procs="$(nproc)" -n 1 clang++-19 "--target=$target" "${options[@]}"
    echo "$target: ${#headers[@]} headers compile"
done
