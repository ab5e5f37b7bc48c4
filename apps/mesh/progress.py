"""Tells what is being done where that takes long."""
import sys
import threading
from contextlib import contextmanager

PATIENCE = 5.0  # seconds


@contextmanager
def doing(what):
    """A line on standard error if what is done in this context has taken some seconds and goes on."""
    timer = threading.Timer(PATIENCE, lambda: print(f"sprekk: {what} ...", file=sys.stderr, flush=True))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
