#!/usr/bin/env python3
"""Checks the documentation against itself and against the code. Run from the repository root.

* every citation [@Key] in docs/ stands in references.bib, and every entry is cited in docs/;
* every relative link in a tracked or new *.md file leads to a file, and its anchor to a heading;
* every update rule in the library and every method of `gimfit curve` has a page in docs/methods/.

Python 3.11, standard library only. Prints one line per fault; the exit status is 1 if there is any.
"""

import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

ROOT = Path.cwd()
BIBLIOGRAPHY = ROOT / "references.bib"
METHODS = ROOT / "docs/methods"
RULES = ROOT / "crates/gimfit/src/iteration/update"
ARGUMENTS = ROOT / "crates/gimfit-cli/src/arguments.rs"

# Files and methods whose page has another name.
PAGE_OF = {
    "gauss_seidel": "gauss-seidel",
    "sor": "gauss-seidel",
    "staged": "auto",
    "grid": "surfaces",
    "net_preconditioned": "surfaces",
    "column-sums": "lspia",
    "sor-lspia": "gs-lspia",
    "heavy_ball": "mlspia",
    "conjugate_gradients": "cgls",
    "pcg": "cgls",
    "random_columns": "randomised",
    "random_rows": "randomised",
    "random-columns": "randomised",
    "random-rows": "randomised",
}

LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
CITATION = re.compile(r"\[(@[^\[\]]+)\]")


def markdown_files():
    """Tracked and new Markdown files, without what git ignores."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return sorted(path for name in listed.stdout.splitlines() if (path := ROOT / name).is_file())


def prose_lines(path):
    """Numbered lines outside code blocks, without code spans."""
    fence = None
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        mark = re.match(r"\s*(```+|~~~+)", line)
        if mark and (fence is None or line.strip().startswith(fence)):
            fence = mark[1] if fence is None else None
            continue
        if fence is None:
            yield number, line


def without_code(line):
    return re.sub(r"(`+).*?\1", "", line)


def anchors(path):
    """Anchors of the headings, made as forges make them."""
    found, seen = set(), {}
    for _, line in prose_lines(path):
        heading = re.match(r"#{1,6}\s+(.*?)\s*#*$", line)
        if heading:
            text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).replace("`", "")
            slug = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
            count = seen.get(slug, 0)
            seen[slug] = count + 1
            found.add(slug if count == 0 else f"{slug}-{count}")
        found.update(re.findall(r"<a (?:id|name)=\"([^\"]+)\"", line))
    return found


def check_links(path):
    for number, line in prose_lines(path):
        for target in LINK.findall(without_code(line)):
            if re.match(r"[a-z][a-z0-9+.-]*:|//", target, re.IGNORECASE):
                continue
            name, _, anchor = unquote(target).partition("#")
            base = ROOT if name.startswith("/") else path.parent
            aim = base / name.lstrip("/") if name else path
            place = f"{path.relative_to(ROOT)}:{number}"
            if not aim.exists():
                yield f"{place}: the link {target} leads to no file"
            elif anchor and aim.suffix == ".md" and anchor not in anchors(aim):
                yield f"{place}: the link {target} leads to no heading of {name or 'this page'}"


def check_citations(pages):
    keys = re.findall(r"^@\w+\{\s*([^,\s]+)\s*,", BIBLIOGRAPHY.read_text(encoding="utf-8"), re.M)
    for key in sorted({key for key in keys if keys.count(key) > 1}):
        yield f"references.bib: the key {key} stands twice"
    cited = set()
    for path in pages:
        for number, line in prose_lines(path):
            for group in CITATION.findall(without_code(line)):
                for key in re.findall(r"@([\w:-]+)", group):
                    cited.add(key)
                    if key not in keys:
                        place = f"{path.relative_to(ROOT)}:{number}"
                        yield f"{place}: [@{key}] is not in references.bib"
    for key in sorted(set(keys) - cited):
        yield f"references.bib: {key} is cited nowhere in docs/"


def page_exists(name):
    return (METHODS / f"{PAGE_OF.get(name, name)}.md").is_file()


def methods_of_the_program():
    """Values of --method, from the enum that clap reads."""
    source = ARGUMENTS.read_text(encoding="utf-8")
    body = re.search(r"enum MethodChoice \{(.*?)\n\}", source, re.S)
    names = re.findall(r"^\s*([A-Z]\w*),", body[1], re.M) if body else []
    return [re.sub(r"(?<!^)(?=[A-Z])", "-", name).lower() for name in names]


def check_methods():
    rules = sorted(path.stem for path in RULES.glob("*.rs") if path.stem != "mod")
    for rule in rules:
        if not page_exists(rule):
            yield f"{RULES.relative_to(ROOT)}/{rule}.rs has no page in docs/methods/"
    methods = methods_of_the_program()
    if not rules or not methods:
        yield "no update rules or no methods were found; correct the paths in this script"
    for method in methods:
        if not page_exists(method):
            yield f"--method {method} has no page in docs/methods/"


def main():
    pages = markdown_files()
    faults = [fault for path in pages for fault in check_links(path)]
    docs = ROOT / "docs"
    faults += check_citations([path for path in pages if path.is_relative_to(docs)])
    faults += check_methods()
    for fault in faults:
        print(fault)
    if faults:
        sys.exit(f"check_docs: {len(faults)} fault{'s' if len(faults) > 1 else ''}")
    print(f"check_docs: {len(pages)} pages, no fault")


if __name__ == "__main__":
    main()
