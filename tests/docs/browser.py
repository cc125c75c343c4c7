"""Headless Chromium through the HTTP protocol of chromedriver."""
import json
import os
import shutil
import socket
import subprocess
import tempfile
import time
from http.client import HTTPConnection

WAIT_S = 60  # a busy machine takes long


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


class Browser:
    def __init__(self, dark=False):
        self.profile = tempfile.mkdtemp(prefix="tress-docs-")
        self.port = free_port()
        self.process = subprocess.Popen([os.environ.get("CHROMEDRIVER", "chromedriver"), f"--port={self.port}"],
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.session = ""
        if not settled(self.is_ready):
            self.stop()
            raise RuntimeError("chromedriver did not start")
        arguments = [
            "--headless=new", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage",
            "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run",
            "--disable-quic", "--force-device-scale-factor=1", "--hide-scrollbars",
            f"--blink-settings=preferredColorScheme={0 if dark else 1}", f"--user-data-dir={self.profile}",
            # Root has none of the namespaces that the sandbox is made of.
            *(["--no-sandbox"] if os.getuid() == 0 else []),
        ]
        options = {"binary": os.environ.get("CHROMIUM", "/usr/bin/chromium"), "args": arguments}
        wanted = {"browserName": "chrome", "goog:loggingPrefs": {"performance": "ALL"}, "goog:chromeOptions": options}
        made = self.call("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
        self.session = f"/session/{made['sessionId']}"
        # Scripts on a busy machine may take longer than the 30 s that are usual.
        self.command("/timeouts", script=120_000)
        # Chromium's own start page must not be counted among the page's requests.
        self.open("about:blank")
        self.requests()

    def is_ready(self):
        try:
            return self.call("GET", "/status")["ready"]
        except OSError:
            return False

    def call(self, method, path, body=None):
        connection = HTTPConnection("127.0.0.1", self.port, timeout=300)
        try:
            connection.request(method, path, None if body is None else json.dumps(body))
            response = connection.getresponse()
            value = json.load(response)["value"]
        finally:
            connection.close()
        if response.status != 200:
            raise RuntimeError(f"{path}: {value['error']}: {value['message']}")
        return value

    def command(self, path, **body):
        return self.call("POST", self.session + path, body)

    def run(self, script, *words):
        """Runs a function body in the page."""
        return self.command("/execute/sync", script=script, args=words)

    def devtools(self, name, **parameters):
        return self.command("/goog/cdp/execute", cmd=name, params=parameters)

    def open(self, url, width=1400, height=900):
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                      mobile=False)
        self.command("/url", url=url)

    def requests(self):
        """Returns the addresses requested since the last call."""
        entries = (json.loads(entry["message"])["message"] for entry in self.command("/se/log", type="performance"))
        return [entry["params"]["request"]["url"] for entry in entries
                if entry["method"] == "Network.requestWillBeSent"]

    def stop(self):
        try:
            if self.session:
                self.call("DELETE", self.session)
        finally:
            self.process.kill()
            self.process.wait()
            shutil.rmtree(self.profile, ignore_errors=True)


def settled(condition):
    """Returns whether the condition becomes true within WAIT_S."""
    end = time.monotonic() + WAIT_S
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
