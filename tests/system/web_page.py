#!/usr/bin/python3
"""The page of hermes-web in a real browser shows pose, battery and health of a robot that drives, its STOP stops the robot, and what is
old is said to be old. Skipped where there is no chromium, hermes-web or python3-websockets."""
import asyncio
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.request

from support import wait_for
from web import WebCase  # skips where something is missing

from recorded_robot import Driver  # pylint: disable=wrong-import-order
import websockets  # pylint: disable=wrong-import-order

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Browser:
    """A page in a browser without a window, as large as a phone's, by the browser's own protocol for developers."""

    def __init__(self, url):
        self.folder = tempfile.mkdtemp()
        self.process = subprocess.Popen(  # pylint: disable=consider-using-with
            [BROWSER, "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--window-size=400,800", "--remote-debugging-port=0",
             "--user-data-dir=" + self.folder, url], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        port_file = os.path.join(self.folder, "DevToolsActivePort")
        wait_for("the browser", lambda: os.path.exists(port_file) and os.path.getsize(port_file) > 10, 60)
        with open(port_file, encoding="ascii") as file:
            port = int(file.readline())
        self.page = wait_for("the page", lambda: self.find(port, url), 60)
        self.loop, self.last = asyncio.new_event_loop(), 0
        self.socket = self.loop.run_until_complete(self._connect())

    async def _connect(self):
        return await websockets.connect(self.page, max_size=None, ping_interval=None)

    @staticmethod
    def find(port, url):
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=20) as answer:
            return next((page["webSocketDebuggerUrl"] for page in json.load(answer) if page["url"].startswith(url)), None)

    def command(self, method, **params):
        return self.loop.run_until_complete(asyncio.wait_for(self._command(method, params), 60))

    async def _command(self, method, params):
        self.last += 1
        await self.socket.send(json.dumps({"id": self.last, "method": method, "params": params}))
        while True:
            message = json.loads(await self.socket.recv())
            if message.get("id") == self.last:
                return message["result"]

    def value(self, script):
        result = self.command("Runtime.evaluate", expression=script, returnByValue=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def text(self):
        return self.value("document.body ? document.body.innerText : ''")

    def press(self, identity):
        """With the mouse, in the middle of the element."""
        box = self.value(f"(({{x, y, width, height}}) => [x + width / 2, y + height / 2])(document.getElementById('{identity}').getBoundingClientRect())")
        for kind in ("mousePressed", "mouseReleased"):
            self.command("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", clickCount=1)

    def close(self):
        self.loop.run_until_complete(self.socket.close())
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


@unittest.skipUnless(BROWSER, "there is no chromium here")
class Page(WebCase):
    def test_shows_and_stops(self):
        browser = Browser(f"http://127.0.0.1:{self.web['observer']}/")
        self.addCleanup(browser.close)
        driver = Driver(self.robot.ports["motorcontrol"], "anna", vx=0.1, omega=0.3)
        self.until_driving()
        wait_for("all that is shown", lambda: all(word in browser.text() for word in (
            "matched", "driven by anna", "motorcontrol", "scanmatcher", "battery", " V", "running")))
        wait_for("the speed", lambda: "0.10 m/s" in browser.text())
        first = browser.text().split("pose")[1].split("\n")[0]
        wait_for("another pose", lambda: browser.text().split("pose")[1].split("\n")[0] != first)
        wait_for("the map", lambda: browser.value("[...parts.values()].flat().length") > 20)
        colours = browser.value("""(() => { const canvas = document.getElementById("map"), context = canvas.getContext("2d");
            const data = context.getImageData(0, 0, canvas.width, canvas.height).data, found = new Set();
            for (let i = 0; i < data.length; i += 4) if (data[i + 3] === 255) found.add([data[i], data[i + 1], data[i + 2]].join());
            return [...found]; })()""")
        self.assertIn("255,221,0", colours)  # the robot of now
        self.assertIn("102,204,255", colours)  # the walls
        self.assertGreater(browser.value("document.getElementById('stop').getBoundingClientRect().height"), 100)
        self.assertFalse(browser.value("document.documentElement.scrollWidth > innerWidth"), "it is wider than a phone")
        browser.press("stop")
        wait_for("the word", lambda: "STOP: the robot stands" in browser.text())
        self.until_still()
        self.assertTrue(self.motors.call("motor.state")["estop"])
        driver.end()
        self.robot.kill("scanmatcher")
        wait_for("old values", lambda: "s old" in browser.text() and "does not answer" in browser.text())
        self.robot.processes["observer"].process.kill()
        wait_for("the end", lambda: "not connected" in browser.text())
        browser.press("stop")
        wait_for("the truth", lambda: "STOP WAS NOT SENT" in browser.text())


if __name__ == "__main__":
    unittest.main(verbosity=2)
