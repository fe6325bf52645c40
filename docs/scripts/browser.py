# SPDX-License-Identifier: Apache-2.0
"""A headless Chromium that opens pages and takes pictures of them, for scripts and tests.

It is spoken to by its DevTools protocol over two pipes, which needs nothing but Python: messages
are JSON, each ended by a zero byte. WebGL is drawn by its own software renderer, so pictures are
the same with and without a graphics card."""

import base64
import json
import os
import pathlib
import select
import shutil
import subprocess
import tempfile
import time


def find_chromium():
    for name in ("chromium", "chromium-browser", "google-chrome"):
        if path := shutil.which(name):
            return path
    return None


class Browser:
    def __init__(self, width=1280, height=800):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self.write_to = os.pipe()
        self.read_from, from_browser = os.pipe()
        words = [find_chromium(), "--headless=new", "--remote-debugging-pipe", "--no-first-run",
                 "--no-sandbox",  # which it does not have for root
                 "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars",
                 "--disable-dev-shm-usage", "--disable-extensions", "--disable-background-networking",
                 f"--user-data-dir={self.folder.name}", f"--window-size={width},{height}", "about:blank"]

        def take_pipes():
            # It wants them at 3 and 4; first out of the way, for either may be there already.
            a, b = os.dup(to_browser), os.dup(from_browser)
            high = [os.dup2(a, 20), os.dup2(b, 21)]
            os.dup2(high[0], 3)
            os.dup2(high[1], 4)

        self.process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL, preexec_fn=take_pipes, close_fds=False)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer, self.count, self.session = b"", 0, None
        self.console = []  # what a page has said, and what went wrong in it
        pages = self.call("Target.getTargets")["targetInfos"]
        page = next(page for page in pages if page["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=page["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")
        self.resize(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        try:
            self.session = None
            self.call("Browser.close", seconds=5)
        except (OSError, TimeoutError):
            pass
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.write_to)
        os.close(self.read_from)
        self.folder.cleanup()

    def receive(self, until):
        while b"\0" not in self.buffer:
            if not select.select([self.read_from], [], [], max(until - time.monotonic(), 0))[0]:
                raise TimeoutError("the browser does not answer")
            piece = os.read(self.read_from, 1 << 20)
            if not piece:
                raise OSError("the browser has ended")
            self.buffer += piece
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def note(self, message):
        name, values = message.get("method"), message.get("params", {})
        if name == "Runtime.consoleAPICalled":
            self.console.append(" ".join(str(a.get("value", a.get("description"))) for a in values["args"]))
        elif name == "Runtime.exceptionThrown":
            details = values["exceptionDetails"]
            self.console.append(details.get("exception", {}).get("description", details["text"]))
        elif name == "Log.entryAdded":
            self.console.append(values["entry"]["text"])
        elif name == "Network.requestWillBeSent" and values["request"]["url"].startswith(("http", "ws")):
            self.console.append("asked the network for " + values["request"]["url"])

    def call(self, method, seconds=60, **values):
        self.count += 1
        message = {"id": self.count, "method": method, "params": values}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write_to, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + seconds
        while True:
            answer = self.receive(until)
            self.note(answer)
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def evaluate(self, script, seconds=60):
        result = self.call("Runtime.evaluate", seconds, expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"].get("exception", {}).get("description", script))
        return result["result"].get("value")

    def wait_for(self, script, seconds=60):
        until = time.monotonic() + seconds
        while not (value := self.evaluate(script)):
            if time.monotonic() > until:
                said = self.evaluate("document.getElementById('message')?.textContent")
                raise TimeoutError(f"never true: {script}; the page says: {said!r}; console: {self.console}")
            time.sleep(0.02)
        return value

    def resize(self, width, height, phone=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)

    def set_scheme(self, scheme):
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def open(self, path, address="", seconds=120):
        """A page that vdb_shell wrote; milliseconds until its first picture."""
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", seconds=seconds, url=pathlib.Path(path).resolve().as_uri() + address)
        return float(self.wait_for("document.documentElement?.dataset.firstPicture", seconds))

    def settle(self):
        """Until what was changed has been drawn."""
        self.evaluate("new Promise(done => setTimeout(() => requestAnimationFrame(() => "
                      "requestAnimationFrame(() => setTimeout(done, 0))), 30))")

    def picture(self):
        """The bytes of a PNG."""
        self.settle()
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=int(kind[5] == "P"),
                      clickCount=1)
        self.settle()

    def drag(self, start, end, button="left"):
        held = {"left": 1, "right": 2}[button]
        self.call("Input.dispatchMouseEvent", type="mousePressed", x=start[0], y=start[1], button=button, buttons=held,
                  clickCount=1)
        for k in range(1, 5):
            x, y = (a + (b - a) * k / 4 for a, b in zip(start, end))
            self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, button=button, buttons=held)
        self.call("Input.dispatchMouseEvent", type="mouseReleased", x=end[0], y=end[1], button=button, buttons=0,
                  clickCount=1)
        self.settle()
