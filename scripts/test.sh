#!/usr/bin/env bash
# Every check a change must pass: format, lints, documentation, tests, examples in documentation,
# and what the README and the pages show.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

step format
cargo fmt --all --check

step lints
cargo clippy --workspace --all-targets --locked -- -D warnings

step documentation
RUSTDOCFLAGS='-D warnings' cargo doc --workspace --no-deps --locked
python3 scripts/check_docs.py

step 'the commands of the README'
bash scripts/readme.sh

step 'what the pages say the program prints'
python3 scripts/check_console.py

step 'tests and examples in documentation'
cargo test --workspace --locked
