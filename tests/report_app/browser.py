"""Headless Chromium with one page, controlled through the pipe of its DevTools protocol."""

import base64
import json
import os
import select
import shutil
import signal
import subprocess
import tempfile
import time

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
PATIENCE = 120  # seconds for one reply; drawing is slow without a graphics card


def program():
    """Returns the path of the browser, or None."""
    return next(filter(None, map(shutil.which, NAMES)), None)


class Browser:
    """Browser with one page. `complaints` are messages in its console above the level of information."""

    def __init__(self):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, own_out = os.pipe()
        own_in, from_browser = os.pipe()

        def pipes():  # the protocol uses the file descriptors 3 and 4
            os.setpgrp()
            high = [os.dup2(end, fd) for end, fd in ((to_browser, 30), (from_browser, 31))]
            os.dup2(high[0], 3)
            os.dup2(high[1], 4)

        self.process = subprocess.Popen(
            [
                program(),
                "--headless",
                "--no-sandbox",
                "--disable-dev-shm-usage",
                "--remote-debugging-pipe",
                "--use-gl=angle",
                "--use-angle=swiftshader",
                "--enable-unsafe-swiftshader",
                "--disable-background-networking",
                "--host-resolver-rules=MAP * ~NOTFOUND",
                f"--user-data-dir={self.profile.name}",
                "about:blank",
            ],
            preexec_fn=pipes,
            close_fds=False,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)
        self.write, self.read, self.buffer = own_out, own_in, b""
        self.number, self.target, self.events, self.complaints, self.requests = 0, None, [], [], []
        page = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.target = self.call("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def message(self):
        end = time.monotonic() + PATIENCE
        while b"\0" not in self.buffer:
            if not select.select([self.read], [], [], max(end - time.monotonic(), 0))[0]:
                raise TimeoutError("the browser does not answer")
            part = os.read(self.read, 1 << 20)
            if not part:
                raise ConnectionError("the browser has ended")
            self.buffer += part
        one, _, self.buffer = self.buffer.partition(b"\0")
        return json.loads(one)

    def note(self, event):
        kind, content = event.get("method"), event.get("params", {})
        self.events.append(kind)
        if kind == "Runtime.exceptionThrown":
            self.complaints.append(json.dumps(content["exceptionDetails"]))
        elif kind == "Runtime.consoleAPICalled" and content["type"] in ("error", "warning", "assert"):
            self.complaints.append(json.dumps(content["args"]))
        elif kind == "Log.entryAdded" and content["entry"]["level"] == "error":
            self.complaints.append(content["entry"]["text"])
        elif kind == "Network.requestWillBeSent":
            self.requests.append(content["request"]["url"])

    def call(self, method, **content):
        self.number += 1
        words = {"id": self.number, "method": method, "params": content}
        if self.target:
            words["sessionId"] = self.target
        os.write(self.write, json.dumps(words).encode() + b"\0")
        while True:
            answer = self.message()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.note(answer)

    def open(self, file, width=1200, height=900, mobile=False):
        self.events, self.complaints, self.requests = [], [], []
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        self.call("Page.navigate", url=f"file://{file}")
        while "Page.loadEventFired" not in self.events:
            self.note(self.message())

    def value(self, expression):
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(json.dumps(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def picture(self, selector=None):
        """Returns a PNG of an element or of the visible page."""
        options = {}
        if selector:
            self.value(f"document.querySelector({selector!r}).scrollIntoView()")
            box = self.value(
                f"(b => [b.x + scrollX, b.y + scrollY, b.width, b.height])(document.querySelector({selector!r}).getBoundingClientRect())"
            )
            options = {
                "clip": {**dict(zip(("x", "y", "width", "height"), box)), "scale": 1},
                "captureBeyondViewport": True,
            }
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", **options)["data"])

    def drag(self, selector, dx, dy):
        """Drags the mouse from the centre of an element."""
        self.value(f"document.querySelector({selector!r}).scrollIntoView()")
        x, y = self.value(
            f"(b => [b.x + b.width / 2, b.y + b.height / 2])(document.querySelector({selector!r}).getBoundingClientRect())"
        )
        for kind, part in (("mousePressed", 0), ("mouseMoved", 0.5), ("mouseMoved", 1), ("mouseReleased", 1)):
            self.call(
                "Input.dispatchMouseEvent",
                type=kind,
                x=x + part * dx,
                y=y + part * dy,
                button="left",
                buttons=int(kind != "mouseReleased"),
                clickCount=1,
            )

    def click(self, selector):
        """Clicks on the centre of an element."""
        self.drag(selector, 0, 0)

    def paper(self):
        """Returns a PDF of the printed page."""
        return base64.b64decode(self.call("Page.printToPDF", printBackground=True)["data"])

    def close(self):
        os.killpg(self.process.pid, signal.SIGKILL)  # includes child processes
        self.process.wait()
        self.profile.cleanup()
        os.close(self.write)
        os.close(self.read)
