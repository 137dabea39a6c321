"""A headless Chromium that is told by pipe what to do (Chrome DevTools Protocol), without any other package."""
import base64, json, os, subprocess, time, zlib
import numpy as np

FLAGS = ["--headless=new", "--no-sandbox", "--disable-gpu-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader",
         "--hide-scrollbars", "--no-first-run", "--disable-extensions", "--remote-debugging-pipe", "about:blank"]


class Browser:
    def __init__(self, program, profile):
        child_reads, self.out = os.pipe()
        self.into, child_writes = os.pipe()

        def take():  # the browser reads 3 and writes 4; neither pipe may be in the way of the other
            a, b = os.dup(child_reads), os.dup(child_writes)
            os.dup2(a, 3), os.dup2(b, 4)

        self.process = subprocess.Popen([program, f"--user-data-dir={profile}", *FLAGS], preexec_fn=take, pass_fds=(3, 4),
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(child_reads), os.close(child_writes)
        self.count, self.rest, self.errors, self.session = 0, b"", [], None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def close(self):
        try:
            self.session = None
            self.call("Browser.close")
        except OSError:
            pass
        self.process.wait(10)

    def read(self):
        while b"\0" not in self.rest:
            more = os.read(self.into, 1 << 16)
            if not more:
                raise OSError("the browser has ended")
            self.rest += more
        one, self.rest = self.rest.split(b"\0", 1)
        return json.loads(one)

    def call(self, method, **params):
        """The answer; what the page complains of meanwhile is kept in errors."""
        self.count += 1
        message = {"id": self.count, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.out, json.dumps(message).encode() + b"\0")
        while True:
            got = self.read()
            if got.get("id") == self.count:
                if "error" in got:
                    raise RuntimeError(f"{method}: {got['error']}")
                return got["result"]
            self.note(got.get("method"), got.get("params", {}))

    def note(self, method, params):
        if method == "Runtime.exceptionThrown":
            self.errors.append(params["exceptionDetails"].get("exception", {}).get("description", "an exception"))
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"]["text"])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning"):
            self.errors.append(str(params["args"]))

    def evaluate(self, expression):
        got = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in got:
            raise RuntimeError(f"{expression}: {got['exceptionDetails']}")
        return got["result"].get("value")

    def open(self, url, width=900, height=700, ratio=1, mobile=False, **media):
        """A page of that size, and what its user prefers: color_scheme="dark", reduced_motion="reduce"."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio, mobile=mobile)
        self.call("Emulation.setTouchEmulationEnabled", enabled=mobile)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-" + k.replace("_", "-"), "value": v} for k, v in media.items()])
        self.call("Page.navigate", url="about:blank")  # another #.. alone would load nothing
        self.call("Page.navigate", url=url)
        end = time.time() + 60
        while not self.evaluate("document.documentElement?.dataset.ready"):
            if time.time() > end:
                raise RuntimeError(f"{url} is not ready: {self.evaluate('document.body.innerText')} {self.errors}")
            time.sleep(0.02)
        self.settle()

    def settle(self):
        """Until what was asked for is drawn."""
        self.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")

    def shot(self, path=None):
        """Pixels [height][width][3], 0..255, as whole numbers."""
        png = base64.b64decode(self.call("Page.captureScreenshot", optimizeForSpeed=True)["data"])
        if path:
            open(path, "wb").write(png)
        return read_png(png)

    def key(self, key, code=0):
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, windowsVirtualKeyCode=code, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, windowsVirtualKeyCode=code)
        self.settle()

    def drag(self, x, y, dx, dy):
        self.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button="left", buttons=1, clickCount=1)
        for part in (0.5, 1):
            self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x + part * dx, y=y + part * dy, button="left", buttons=1)
        self.call("Input.dispatchMouseEvent", type="mouseReleased", x=x + dx, y=y + dy, button="left")
        self.hover(1, 1)

    def hover(self, x, y):
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        self.settle()

    def touch(self, *moments):
        """Fingers [(x, y), ..] at one moment after the other."""
        for k, fingers in enumerate(moments):
            points = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(fingers)]
            self.call("Input.dispatchTouchEvent", type="touchMove" if k else "touchStart", touchPoints=points)
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        self.settle()


def read_png(data):
    """8 bits a channel, RGB or RGBA, not interlaced, rows as such or as differences: what Chromium writes in haste."""
    at, packed = 8, b""
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, channels = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big"), {2: 3, 6: 4}[body[9]]
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + channels * width)
    image = rows[:, 1:].reshape(height, width, channels).copy()
    for y, kind in enumerate(rows[:, 0]):
        if kind == 1:
            image[y] = np.cumsum(image[y], axis=0, dtype=np.uint8)
        elif kind == 2 and y:
            image[y] += image[y - 1]
        elif kind > 2:
            raise RuntimeError(f"a PNG with rows of kind {kind}")
    return image[..., :3].astype(int)
