#!/usr/bin/env python3
"""Runs every command shown in a block marked `console` and compares what it prints with the page.

usage: check_console.py [--write] [GIMFIT] [PAGE ...]

GIMFIT is the program, by default target/release/gimfit. The commands of one page run one after the
other in a folder of its own, which holds a link to testdata. With --write what differs is put into
the page.

Numbers agree if they differ by less than a millionth of the larger one, or if both are at rounding
level, where the place of the largest is left to chance, too. Times are not compared, and standard error
may come before or after the rest.

Python 3.11, standard library only. The exit status is 1 if a page says what is not so.
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ROUNDING = 1e-10
# With a fraction or an exponent; bare integers count things and have to agree.
NUMBER = re.compile(r"(?<![\w.])-?(?:\d+\.\d+(?:e-?\d+)?|\d+e-?\d+)(?![\w.])")
TIME = re.compile(r'\b[0-9.]+ (?:us|ms|s)\b|"(?:read|fit|write)": [0-9.e-]+')
PLACE = re.compile(r"(row \d+, column \d+ \()?line \d+\)?|number \d+")


def blocks(lines):
    """The lines inside each block marked console, as (number of the first, indent, lines)."""
    start = None
    for number, line in enumerate(lines):
        mark = re.fullmatch(r"( *)```console", line)
        if start is None and mark:
            start, indent = number + 1, len(mark[1])
        elif start is not None and line.strip() == "```":
            yield start, indent, [text[indent:] for text in lines[start:number]]
            start = None


def commands(first, lines):
    """The commands of a block: (number of its first line, command, number of its output, output)."""
    found = []
    for number, line in enumerate(lines, start=first):
        if line.startswith("$ "):
            found.append([number, line[2:], number + 1, []])
        elif line.startswith("> ") and found and not found[-1][3]:
            found[-1][1] += "\n" + line[2:]
            found[-1][2] = number + 1
        elif found:
            found[-1][3].append(line)
    return found


def shape(line):
    """The line without its numbers, and the numbers."""
    line = TIME.sub("TIME", line.rstrip())
    numbers = [float(text) for text in NUMBER.findall(line)]
    if "largest" in line and numbers and abs(numbers[0]) < ROUNDING:
        line = PLACE.sub("PLACE", line)
    return NUMBER.sub("NUMBER", line), numbers


def close(a, b):
    largest = max(abs(a), abs(b))
    return abs(a - b) <= 1e-6 * largest or largest < ROUNDING


def same_line(a, b):
    (text_a, numbers_a), (text_b, numbers_b) = shape(a), shape(b)
    return text_a == text_b and all(map(close, numbers_a, numbers_b))


def same(shown, printed):
    if len(shown) != len(printed):
        return False
    if all(map(same_line, shown, printed)):
        return True
    return all(map(same_line, sorted(shown, key=shape), sorted(printed, key=shape)))


def check(page, path, write):
    """Faults of a page, one text each."""
    lines = page.read_text(encoding="utf-8").splitlines()
    changes = []
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(ROOT / "testdata", Path(folder) / "testdata")
        environment = dict(os.environ, PATH=f"{path}{os.pathsep}{os.environ['PATH']}")
        for first, indent, block in blocks(lines):
            for number, command, output, shown in commands(first, block):
                run = subprocess.run(
                    ["bash", "-c", command], cwd=folder, env=environment, text=True,
                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                )
                printed = run.stdout.splitlines()
                if not same(shown, printed):
                    yield fault(page.relative_to(ROOT), number + 1, command, shown, printed)
                    changes.append((output, len(shown), [" " * indent + line for line in printed]))
    if write and changes:
        for output, count, printed in reversed(changes):
            lines[output : output + count] = [line.rstrip() for line in printed]
        page.write_text("\n".join(lines) + "\n", encoding="utf-8")


def fault(page, number, command, shown, printed):
    text = [f"{page}:{number}: {command.splitlines()[0]}"]
    text += [f"    shown    {line}" for line in shown if line not in printed]
    text += [f"    printed  {line}" for line in printed if line not in shown]
    return "\n".join(text)


def pages():
    listed = subprocess.run(
        ["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return [ROOT / name for name in listed.stdout.splitlines()]


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--write"]
    program = Path(arguments[0] if arguments else ROOT / "target/release/gimfit").resolve()
    if not program.is_file():
        sys.exit(f"check_console: there is no {program}; build it: cargo build --release --locked")
    chosen = [Path(argument).resolve() for argument in arguments[1:]] or pages()
    with tempfile.TemporaryDirectory() as path:
        os.symlink(program, Path(path) / "gimfit")
        write = "--write" in sys.argv
        faults = [text for page in chosen for text in check(page, path, write)]
    for text in faults:
        print(text)
    if faults:
        sys.exit(f"check_console: {len(faults)} fault{'s' if len(faults) > 1 else ''}")
    print(f"check_console: {len(chosen)} pages, no fault")


if __name__ == "__main__":
    main()
