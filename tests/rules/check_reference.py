#!/usr/bin/env python3
"""Counts rows of docs/use/reference.md whose meaning does not start with a noun: check_reference.py ROOT

A meaning has at least three words. Its first word, after an article, is a plain word without a symbol or a colon, and in
none of the lists below. Prints each row with a defect; exit status 1 if there are any.
"""
import re
import sys
from pathlib import Path

NO_NOUNS = set("""
    and but if or unless until whether how what whatever when where which whichever who whose why
    he it its one ones she such that their them these they this those
    about above across after along among as at before below beside between by during for from in inside into of off on
    out over per through to under with within without
    absent all also always both clockwise each every instead like never no none not only required some then there
    are be can do does give gives go goes has have is keep keeps make makes may must need needs print prints
    put puts take takes tell tells use used uses write writes
    alpha delta kappa lambda mu nu phi psi rho sigma theta""".split())


def defect(meaning):
    """The reason why a meaning does not start with a noun; empty if there is none."""
    words = meaning.split()
    if len(words) < 3:
        return "has fewer than three words"
    if words[0].lower() in ("a", "an", "the"):
        words = words[1:]
    first = words[0].rstrip(",")
    if not re.fullmatch(r"[A-Za-z][A-Za-z]+('s)?(-[A-Za-z]+)*", first) or first.lower() in NO_NOUNS:
        return f'starts with "{words[0]}"'
    return ""


def rows(text):
    """(place, meaning) of the sections and of their entries."""
    section = ""
    for block in text.split("\n\n"):
        if block.startswith("## "):
            section = block[3:]
        elif block.startswith("| name |"):
            for line in block.splitlines()[2:]:
                cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
                yield f"{section} > {cells[0]}", cells[-1]
        elif section and block.strip():
            yield section, block.strip()


def main():
    found = list(rows((Path(sys.argv[1]) / "docs/use/reference.md").read_text()))
    defects = [f"{place}: {reason}: {meaning}" for place, meaning in found if (reason := defect(meaning))]
    print(*defects, f"{len(defects)} of {len(found)} rows do not start with a noun", sep="\n")
    return 1 if defects or len(found) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
