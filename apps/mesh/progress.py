"""Messages about long operations."""
import sys
import threading
from contextlib import contextmanager

PATIENCE = 5.0  # seconds


@contextmanager
def doing(what):
    """Prints a message on standard error if the operation in this context takes more than some seconds."""
    timer = threading.Timer(PATIENCE, lambda: print(f"sprekk: {what} ...", file=sys.stderr, flush=True))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
