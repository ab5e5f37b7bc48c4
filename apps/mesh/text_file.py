"""Lines of text files with different encodings."""
import contextlib
import os
import stat

from shapes import NetworkError

MAX_BYTES = 2 * 10**8  # in a file; some million fractures


def read_lines(path):
    """Returns the lines of a file. Rejects pipes and devices, which may have no end."""
    def refuse(why):
        raise NetworkError(f"{path}: cannot be read: {why}", [path]) from None
    try:
        mode = os.stat(path).st_mode
        if not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):  # open() reports folders
            refuse("is not a regular file, but a pipe, a socket or a device")
        with open(path, "rb") as file:
            data = file.read(MAX_BYTES + 1)
    except OSError as error:
        refuse(error.strerror)
    if len(data) > MAX_BYTES:
        refuse(f"has more than {MAX_BYTES:g} bytes; divide it into several sets, or remove fractures")
    text = decoded(data)
    if text is None:
        refuse("is not text")
    return text.splitlines()


def decoded(data):
    """Returns bytes as text: UTF-8, UTF-16 with a byte order mark, or else Latin-1; None for bytes that are no text."""
    for encoding in ("utf-16",) if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "latin-1"):
        with contextlib.suppress(UnicodeDecodeError):
            text = data.decode(encoding)
            return None if "\0" in text else text
    return None
