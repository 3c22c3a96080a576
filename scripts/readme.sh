#!/usr/bin/env bash
# Runs each command that README.md shows in a block marked `sh`, in a scratch folder of its own that
# holds links to what the commands name, and fails if one of them does.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
ln -s "$root/testdata" "$scratch/testdata"

cargo build --release --locked
awk '/^```sh$/ {show = 1; next} /^```/ {show = 0} show' README.md >"$scratch/commands"
while IFS= read -r line; do
    case $line in
    '' | '#'* | 'bash scripts/test.sh'*) continue ;;
    'cargo run --release -- '*) line="gimfit ${line#cargo run --release -- }" ;;
    'cargo install '*) continue ;;
    esac
    printf '$ %s\n' "$line"
    (cd "$scratch" && PATH="$root/target/release:$PATH" bash -euo pipefail -c "$line" >"$scratch/out" 2>&1) ||
        { cat "$scratch/out"; exit 1; }
done <"$scratch/commands"
