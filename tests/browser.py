"""Chromium spoken to over a pipe, in its own protocol: one start for many pages, widths, themes and media."""

import json
import os
import select
import shutil
import subprocess
import time

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
MISSING = "no Chromium on this machine: no report was opened in a browser"
QUIET = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-sync",
    "--disable-background-networking",
    "--disable-component-update",
]
PATIENCE = 30.0


class Browser:
    """One process; `with` ends it."""

    def __init__(self, profile):
        theirs, self._out = os.pipe()
        self._in, back = os.pipe()
        line = [CHROMIUM, *QUIET, f"--user-data-dir={profile}", "--remote-debugging-pipe"]
        # the protocol is spoken over descriptors 3 and 4, above all that are open here
        shell = f'exec "$@" 3<&{theirs} 4>&{back}'
        self._process = subprocess.Popen(
            ["bash", "-c", shell, "bash", *line],
            pass_fds=(theirs, back),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(theirs)
        os.close(back)
        self._told, self._rest, self._last = [], b"", 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self._out)
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._in)

    def send(self, method, session=None, **params):
        """The answer to one command."""
        self._last += 1
        asked = {"id": self._last, "method": method, "params": params} | ({"sessionId": session} if session else {})
        os.write(self._out, json.dumps(asked).encode() + b"\0")
        answer = self._until(lambda one: one.get("id") == asked["id"])
        assert "error" not in answer, f"{method}: {answer['error']}"
        return answer["result"]

    def event(self, method, session):
        """Wait for something to happen on a page; what happened before counts too, once."""
        for i, one in enumerate(self._told):
            if one.get("method") == method and one.get("sessionId") == session:
                return self._told.pop(i)
        return self._until(lambda one: one.get("method") == method and one.get("sessionId") == session)

    def _until(self, wanted):
        limit = time.monotonic() + PATIENCE
        while time.monotonic() < limit:
            while b"\0" in self._rest:
                message, self._rest = self._rest.split(b"\0", 1)
                one = json.loads(message)
                if wanted(one):
                    return one
                self._told.append(one)
            if not select.select([self._in], [], [], 1.0)[0]:
                continue
            more = os.read(self._in, 1 << 20)
            assert more, "Chromium ended"
            self._rest += more
        raise TimeoutError("Chromium does not answer")

    def page(self):
        """A new tab."""
        return Page(self)


class Page:
    """One tab."""

    def __init__(self, browser):
        self._browser = browser
        self._target = browser.send("Target.createTarget", url="about:blank")["targetId"]
        self._session = browser.send("Target.attachToTarget", targetId=self._target, flatten=True)["sessionId"]
        self.send("Page.enable")

    def send(self, method, **params):
        return self._browser.send(method, self._session, **params)

    def open(self, path):
        """Load a file and wait until it is there."""
        self._browser._told = []
        self.send("Page.bringToFront")  # one behind another is not painted
        self.send("Page.navigate", url=path.as_uri())
        self._browser.event("Page.loadEventFired", self._session)
        return self

    def run(self, script):
        """The value of an expression on the page, of a promise what it promises."""
        done = self.send("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in done, done["exceptionDetails"]
        return done["result"].get("value")

    def width(self, pixels):
        """As on a screen so many pixels wide."""
        self.send(
            "Emulation.setDeviceMetricsOverride", width=pixels, height=900, deviceScaleFactor=1, mobile=pixels < 600
        )

    def media(self, kind="", **features):
        """As on paper, in the dark, without motion."""
        told = [{"name": name.replace("_", "-"), "value": value} for name, value in features.items()]
        self.send("Emulation.setEmulatedMedia", media=kind, features=told)

    def key(self, name):
        """A key pressed."""
        for kind in ("rawKeyDown", "keyUp"):
            self.send("Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=_CODES[name])

    def pdf(self):
        """The page as PDF, as it asks to be printed."""
        import base64

        return base64.b64decode(self.send("Page.printToPDF", preferCSSPageSize=True, printBackground=True)["data"])

    def close(self):
        self._browser.send("Target.closeTarget", targetId=self._target)


_CODES = {"Tab": 9, "Escape": 27, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}
