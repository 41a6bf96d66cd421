"""Examines the page of `lobe view` with axe-core, wide and narrow, light and dark, and prints what it finds.

usage: accessibility.py LOBE

LOBE is the command. Needs chromedriver and chromium, and what script/check-accessibility installs from PyPI. The exit status
is 1 where a rule is violated.
"""

import importlib.resources
import json
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

RULES = importlib.resources.files("axe_playwright_python").joinpath("axe.min.js").read_text()


def free_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


class Browser:
    """A browser without a window, by WebDriver."""

    def __init__(self, profile):
        port = free_port()
        self.root = f"http://127.0.0.1:{port}"
        self.session = ""
        self.driver = subprocess.Popen(["chromedriver", f"--port={port}"], stdout=subprocess.DEVNULL)
        arguments = ["--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage",
                     f"--user-data-dir={profile}", "--window-size=1400,1000", "--no-first-run"]
        wanted = {"capabilities": {"alwaysMatch": {"goog:chromeOptions": {"args": arguments}}}}
        for attempt in range(50):
            try:
                self.session = "/session/" + self.post("/session", wanted)["sessionId"]
                self.post("/timeouts", {"script": 120_000})
                return
            except urllib.error.HTTPError as refusal:
                self.end()
                raise RuntimeError(f"no browser: {refusal.read().decode()[:500]}") from refusal
            except urllib.error.URLError:
                time.sleep(0.1)
        self.end()
        raise RuntimeError("chromedriver does not answer")

    def post(self, path, body):
        request = urllib.request.Request(self.root + self.session + path, json.dumps(body).encode(),
                                         {"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=180) as answer:
            return json.load(answer)["value"]

    def evaluate(self, script):
        return self.post("/execute/sync", {"script": script, "args": []})

    def emulate(self, command, parameters):
        self.post("/goog/cdp/execute", {"cmd": f"Emulation.{command}", "params": parameters})
        time.sleep(0.5)
        self.settle()

    def settle(self):
        for attempt in range(1200):
            if self.evaluate("return document.body.dataset.busy === '0' && document.body.dataset.drawing !== '1'"):
                return
            time.sleep(0.1)
        raise RuntimeError("the page does not settle")

    def examine(self):
        self.evaluate(RULES)
        return self.post("/execute/async", {"args": [], "script":
            "const done = arguments[0];"
            "axe.run(document).then((found) => done({violations: found.violations, passes: found.passes.length,"
            " version: found.testEngine.version}))"})

    def end(self):
        self.driver.kill()
        self.driver.wait()


def describe(place, found):
    count = sum(len(rule["nodes"]) for rule in found["violations"])
    print(f"{place}: {found['passes']} rules of axe-core {found['version']} hold, {count} elements violate one")
    for rule in found["violations"]:
        for node in rule["nodes"]:
            print(f"  {rule['id']} ({rule['impact']}): {rule['help']}: {node['html'][:200]}")
    return count


def main():
    with tempfile.TemporaryDirectory() as profile:
        browser = Browser(profile)
        view = subprocess.Popen([sys.argv[1], "view", "ggx:alpha=0.3", "ward:m=0.2"], stdout=subprocess.PIPE, text=True)
        try:
            browser.post("/url", {"url": view.stdout.readline().strip()})
            time.sleep(1)
            browser.settle()
            # Everything that the page may show.
            browser.evaluate("document.querySelector('#compose').click(); document.querySelector('#scene-draw').click();"
                             "document.querySelector('#find-nearest').click()")
            count = 0
            for width, height in ((1400, 1000), (380, 800)):
                browser.emulate("setDeviceMetricsOverride",
                                {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
                for scheme in ("light", "dark"):
                    browser.emulate("setEmulatedMedia",
                                    {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
                    count += describe(f"{width} pixels, {scheme}", browser.examine())
        finally:
            browser.end()
            view.send_signal(signal.SIGINT)
            view.wait()
    return 1 if count > 0 else 0


sys.exit(main())
