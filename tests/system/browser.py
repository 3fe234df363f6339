#!/usr/bin/env python3
"""A web page in a real browser on the operator's computer tries to command every daemon, in each way that pages have: nothing
changes, and each daemon has turned it away. Skipped where there is no chromium."""
import http.server
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading

from support import BINARIES, Process, free_port, wait_for

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
SKIPPED = 77
DAEMONS = ("supervisor", "motorcontrol", "velodynelogger", "seriallogger", "softwaretrigger", "scanmatcher", "scanner", "simulator")
WAYS = 6

PAGE = """<!DOCTYPE html><title>A harmless page</title><script>
const ports = PORTS, body = COMMANDS;
async function attack(port) {
    const url = "http://127.0.0.1:" + port + "/";
    const tries = [
        fetch(url, {method: "POST", mode: "no-cors", headers: {"Content-Type": "text/plain"}, body: body}),
        fetch(url, {method: "POST", mode: "no-cors", body: new Blob([body])}),
        fetch(url, {method: "PATCH", headers: {"Content-Type": "application/json"}, body: body}),
        fetch(url + "?" + encodeURIComponent(body), {mode: "no-cors"}),
        new Promise((done) => {
            const socket = new WebSocket("ws://127.0.0.1:" + port + "/");
            socket.onopen = () => socket.send(body);
            socket.onclose = done;
        }),
        new Promise((done) => {
            const form = document.createElement("form"), frame = document.createElement("iframe");
            const field = document.createElement("textarea");
            frame.name = "frame" + port;
            form.method = "POST", form.enctype = "text/plain", form.action = url, form.target = frame.name;
            field.name = "x", field.value = "\\n" + body;
            form.append(field);
            document.body.append(frame, form);
            frame.onload = done;
            form.submit();
            setTimeout(done, 2000);
        })];
    navigator.sendBeacon(url, body);
    await Promise.allSettled(tries);
}
window.onload = async () => {
    await Promise.all(ports.map(attack));
    await fetch("/done", {method: "POST"});
};
</script><body></body>
"""


def page_server(page, done):
    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(page)

        def do_POST(self):
            done.set()
            self.send_response(204)
            self.end_headers()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server


def turned_away(daemon):
    channel = next(item for item in daemon.call("daemon.status")["health"] if item["name"] == "channel")
    return channel["values"]["clients_turned_away"]


def attack(folder):
    mark = os.path.join(folder, "mark")
    settings = {"supervisor": {"processes": "[]"}, "velodynelogger": {"record.folder": folder},
                "seriallogger": {"record.folder": folder}}
    processes = [Process(BINARIES, name, free_port(0), folder, settings.get(name, {})) for name in DAEMONS]
    commands = "".join(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}) + "\n" for method, params in (
        ("settings.set", {"values": {"log": {"records": 777}}}),
        ("process.add", {"name": "mark", "program": "/usr/bin/touch", "arguments": [mark], "autostart": True}),
        ("motor.reset_estop", {}), ("daemon.shutdown", {})))
    page = PAGE.replace("PORTS", json.dumps([process.port for process in processes])).replace("COMMANDS", json.dumps(commands))
    done = threading.Event()
    daemons = [process.connect() for process in processes]
    server = page_server(page.encode(), done)
    browser = subprocess.Popen(
        [BROWSER, "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--user-data-dir=" + os.path.join(folder, "profile"),
         f"http://127.0.0.1:{server.server_address[1]}/"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        wait_for("the end of the page", done.is_set, 60)
        for process, daemon in zip(processes, daemons):
            assert process.process.poll() is None, f"{process.name} was ended by a web page"
            records = daemon.call("settings.get", path="log.records")
            assert records == 1000, f"{process.name}: a web page set log.records to {records}"
            times = turned_away(daemon)
            assert times >= WAYS, f"{process.name}: turned away {times} times, expected {WAYS} at least"
            print(f"{process.name}: turned away {times} times")
        assert not os.path.exists(mark), "a web page ran a program"
    finally:
        browser.kill()
        browser.wait()
        server.shutdown()
        for daemon in daemons:
            daemon.close()
        statuses = [process.stop() for process in processes]
    assert statuses == [0] * len(DAEMONS), statuses


if __name__ == "__main__":
    if not BROWSER:
        print("skipped: there is no chromium here")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as temporary:
        attack(temporary)
