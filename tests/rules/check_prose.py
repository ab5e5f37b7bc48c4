#!/usr/bin/env python3
"""Measures the readability of all Markdown pages in the repository.

    check_prose.py ROOT [--pages]     exit status 1 if a bound is exceeded; --pages prints the counts of each page

The bounds apply to all pages together: "what" per 10,000 words, relative and demonstrative words per 100 words, the
90th percentile of words per sentence, and the share of sentences with more than 40 words. Lines of prose have at most
120 characters, except tables and quoted code. Good counts do not prove that a page reads well. Read it aloud."""
import re
import subprocess
import sys
from pathlib import Path

MAX_WHAT, MAX_RELATIVE, MAX_P90, MAX_LONG, MAX_WIDTH = 15, 3.0, 30, 0.03, 120
RELATIVE = {"what", "whatever", "which", "whichever", "that", "those", "such", "one", "ones", "whose", "where"}


def sentences(text):
    """Returns the words of each sentence, without code, tables, headings, formulas and targets of links."""
    text = re.sub(r"<!--.*?-->|```.*?```|\$\$.*?\$\$", "", text, flags=re.DOTALL)
    text = re.sub(r"\$[^$\n]*\$|`[^`\n]*`", "X", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    lines = [line for line in text.splitlines() if not re.match(r"\s*(\||#|!|    )", line)]
    found = []
    for block in re.split(r"\n\s*\n|\n\s*(?:[*+-]|\d+\.)\s", "\n".join(lines)):
        for sentence in re.split(r"(?<=[.!?:])\s+(?=[A-Z\"(])", " ".join(block.split())):
            words = re.findall(r"[A-Za-z][A-Za-z'-]*", sentence)
            if len(words) > 2:
                found.append(words)
    return found


def long_lines(text):
    outside = re.sub(r"```.*?```", lambda block: "\n" * block[0].count("\n"), text, flags=re.DOTALL)
    return [k for k, line in enumerate(outside.splitlines(), 1) if len(line) > MAX_WIDTH and not line.startswith("|")]


def counts(found):
    words = [word.lower() for sentence in found for word in sentence]
    lengths = sorted(map(len, found))
    n = max(len(words), 1)
    return {"what per 10,000 words": 1e4 * words.count("what") / n,
            "relative words per 100": 1e2 * sum(word in RELATIVE for word in words) / n,
            "90th percentile of words per sentence": lengths[int(0.9 * (len(lengths) - 1))] if lengths else 0,
            "share of sentences over 40 words": sum(length > 40 for length in lengths) / max(len(lengths), 1)}


def main():
    root = Path(sys.argv[1])
    listed = subprocess.run(["git", "-C", root, "ls-files", "*.md"], capture_output=True, text=True)
    pages = [root / name for name in listed.stdout.split() if (root / name).exists()] or sorted(root.rglob("*.md"))
    wrong, whole = [], []
    for page in pages:
        text = page.read_text()
        found = sentences(text)
        whole += found
        wrong += [f"{page.relative_to(root)}:{line}: more than {MAX_WIDTH} characters" for line in long_lines(text)]
        if "--pages" in sys.argv:
            print(f"{page.relative_to(root)}: " + ", ".join(f"{value:.3g} {name}" for name, value in counts(found).items()))
    for (name, value), maximum in zip(counts(whole).items(), (MAX_WHAT, MAX_RELATIVE, MAX_P90, MAX_LONG)):
        print(f"{name}: {value:.3g}, at most {maximum}")
        if value > maximum:
            wrong.append(f"{name}: {value:.3g} exceeds {maximum}")
    print(*wrong, sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
