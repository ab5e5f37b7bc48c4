"""Runs a measurement: python3 perf NAME [options] calls main() of perf/NAME/NAME.py.

With --save, save.py also saves the table. python3 perf pages [--check] updates the pages of results."""
import importlib
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:1] = [str(ROOT / folder) for folder in (".", "apps/plot", "apps/report", "apps/fit")]


def main(name, words):
    from perf import save
    from perf.common.program import Failed
    if any(word.startswith("--save") for word in words):
        return save.main(name, words)
    try:
        return importlib.import_module("perf.pages" if name == "pages" else f"perf.{name}.{name}").main(words)
    except Failed as error:
        return f"sprekk perf {name}: {error}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
