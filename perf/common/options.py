"""Options of the command line that several measurements have."""
import argparse
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LISTED = 12  # number of names in a message
QUICK = "a small version, for a test; the status is 1 if a bound on counts is missed"


def parser(name, text, quick=QUICK, only="rows", sets=True, program=False):
    """Returns the parser of a measurement. None for `quick` or `only` omits the option; --program replaces --binary
    if the measurement has a program of its own."""
    made = argparse.ArgumentParser(prog=f"sprekk perf {name}", description=text,
                                   formatter_class=argparse.RawDescriptionHelpFormatter)
    made.set_defaults(name=name, refuse=made.error)
    if quick:
        made.add_argument("--quick", action="store_true", help=quick)
    if only:
        made.add_argument("--only", type=pattern, metavar="PATTERN", default="",
                          help=f"{only} whose name matches this regular expression")
    if sets:
        made.add_argument("--set", metavar="PATH=VALUE", action="append", default=[],
                          help="an entry of every scene, as for `sprekk run`; may be repeated")
    made.add_argument("--output", type=folder, default=f"output/perf/{name}", metavar="DIR",
                      help="folder of tables, figures and runs")
    if program:
        compiled = ROOT / f"build/perf/{name}/{name}"
        made.add_argument("--program", type=absolute, default=compiled, help=f"the compiled {name}.cpp")
    else:
        made.add_argument("--binary", type=absolute, default=ROOT / "build/apps/sprekk/sprekk", help="the program")
    return made


def absolute(words):
    return Path(words).resolve()


def folder(words):
    """Absolute path of a folder, which is created."""
    Path(words).mkdir(parents=True, exist_ok=True)
    return absolute(words)


def pattern(words):
    """Parses a regular expression of an option."""
    try:
        return re.compile(words).pattern
    except re.error as error:
        raise argparse.ArgumentTypeError(f'"{words}" is no regular expression: {error}') from None


def count(words):
    """Parses a number of ranks or cells of an option."""
    if not words.isdecimal() or int(words) < 1:
        raise argparse.ArgumentTypeError(f'"{words}" is no whole number from 1 on')
    return int(words)


def matching(options, rows, name=str):
    """Returns the rows whose name matches --only. Without a match the program exits with a usage error."""
    found = [row for row in rows if re.search(options.only, name(row))]
    if not found:
        names = [f'"{each}"' for each in dict.fromkeys(map(name, rows))]
        listed = ", ".join(names[:LISTED]) + " ..." * (len(names) > LISTED)
        options.refuse(f'argument --only: "{options.only}" matches none of {listed}')
    return found
