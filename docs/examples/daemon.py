#!/usr/bin/env python3
"""A daemon for Hermes in plain Python 3: a fan with settings, a command, a topic and health. hermes-gui, hermesctl and
hermes-supervisor treat it like any other; what it speaks is docs/protocol.md."""
import argparse, itertools, json, os, socket, socketserver, struct, threading, time

STARTED = time.time()
SETTINGS = {  # what is checked, and what the window shows
    "speed": {"type": "number", "minimum": 0, "maximum": 1, "default": 0.3, "description": "Share of the full speed"},
    "period_s": {"type": "number", "minimum": 0.02, "maximum": 10, "unit": "s", "default": 0.1, "description": "Between messages"},
    "alarm_c": {"type": "number", "minimum": -20, "maximum": 120, "unit": "°C", "default": 60, "description": "Warns above"}}
TOPICS = {"air": "Temperature and speed", "log": "Each record", "status": "State and health", "settings": "After a change"}
METHODS = {}  # name: (summary, {parameter: schema}, function)
settings = {name: schema["default"] for name, schema in SETTINGS.items()}
state = {"temperature_c": 40.0, "boost_until": 0.0}
records, subscriptions, numbers, lock = [], {}, itertools.count(1), threading.RLock()


def method(name, summary, **parameters):
    def add(function):
        METHODS[name] = (summary, parameters, function)
        return function
    return add


def check(schemas, values, code):
    """Refuses values that are unknown, of another type or beyond their limits."""
    types = {"number": (int, float), "integer": int, "string": str, "object": dict}
    errors = []
    for name, value in values.items():
        schema = schemas.get(name, {})
        right = isinstance(value, types.get(schema.get("type"), ())) and not isinstance(value, bool)
        if not right or "minimum" in schema and not schema["minimum"] <= value <= schema.get("maximum", value):
            limits = f"{schema.get('type', 'a known name')} {schema.get('minimum', '')} to {schema.get('maximum', '')}"
            errors.append({"path": name, "value": value, "expected": limits})
    if errors:
        raise RuntimeError(code, f"{errors[0]['path']}: expected {errors[0]['expected']}", {"errors": errors})


@method("fan.boost", "Full speed for a while",
        duration_s={"type": "number", "minimum": 0.1, "maximum": 60, "unit": "s", "description": "How long"})
def boost(client, duration_s):
    state["boost_until"] = time.time() + duration_s
    records.append({"stamp": time.time(), "level": "info", "source": "fan", "text": f"full speed for {duration_s:g} s"})
    publish("log", records[-1])
    return {"speed": 1}


@method("rpc.discover", "This description")
def discover(client):
    methods = [{"name": name, "summary": summary, "params": [{"name": n, "required": "default" not in s, "schema": s}
                for n, s in schemas.items()], "result": {"name": "result", "schema": {}}} for name, (summary, schemas, _) in METHODS.items()]
    topics = [{"name": name, "summary": summary, "schema": {}, "snapshot": False} for name, summary in TOPICS.items()]
    return {"openrpc": "1.2.6", "info": {"title": "Fan", "version": "1.0"}, "methods": methods, "x-topics": topics}


@method("daemon.status", "Its state and health")
def status(client=None):
    level, message = ("warn", "too hot") if state["temperature_c"] > settings["alarm_c"] else ("ok", "cool enough")
    return {"state": "running", "restart_for": [], "health": [{"name": "air", "level": level, "message": message, "values": {}}]}


@method("settings.set", "Changes all of these or none", values={"type": "object"})
def change(client, values):
    check(SETTINGS, values, -32003)
    changed = [name for name, value in values.items() if settings[name] != value]
    settings.update(values)
    publish("settings", settings)
    return {"changed": changed, "restart": []}


@method("topics.subscribe", "Sends a topic to this client", topic={"type": "string"}, queue={"type": "integer", "default": 1},
        max_rate_hz={"type": "number", "minimum": 0, "default": 0})
def subscribe(client, topic, queue, max_rate_hz):
    if topic not in TOPICS:
        raise RuntimeError(-32006, f"no topic {topic}")
    number = next(numbers)
    subscriptions[number] = {"client": client, "topic": topic, "pause": 0.9 / max_rate_hz if max_rate_hz else 0, "due": 0, "seq": 0}
    return {"subscription": number}


method("daemon.info", "Who this daemon is")(lambda client: {
    "name": "fan", "title": "Fan", "version": "1.0", "host": socket.gethostname(), "pid": os.getpid(), "started": STARTED,
    "uptime_s": time.time() - STARTED, "description_hash": str(STARTED)})
method("settings.schema", "The schema of the settings")(lambda client: {"type": "object", "properties": SETTINGS})
method("settings.get", "All settings")(lambda client: settings)
method("log.tail", "The last records", count={"type": "integer", "minimum": 1, "default": 100})(lambda client, count: records[-count:])
method("topics.unsubscribe", "Ends a subscription", subscription={"type": "integer"})(
    lambda client, subscription: subscriptions.pop(subscription, None) and None)


def publish(topic, data):
    now = time.time()
    for number, s in list(subscriptions.items()):
        s["seq"] += s["topic"] == topic
        if s["topic"] == topic and now >= s["due"]:
            s["due"] = now + s["pause"]
            s["client"].send({"method": "topic", "params": {"subscription": number, "topic": topic, "seq": s["seq"], "dropped": 0,
                                                            "stamp": now, "data": data}})


class Client(socketserver.StreamRequestHandler):
    def handle(self):
        # Who does not read what is sent is closed after a second, or others would wait.
        self.connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, struct.pack("ll", 1, 0))
        try:
            for line in iter(lambda: self.rfile.readline(1 << 20), b""):
                request = {}
                try:
                    request = json.loads(line)
                    _, schemas, function = METHODS.get(request["method"]) or self.refuse(request["method"])
                    values = {**{n: s["default"] for n, s in schemas.items() if "default" in s}, **request.get("params", {})}
                    with lock:
                        check(schemas, values, -32602)
                        reply = {"result": function(self, **values)}
                except RuntimeError as error:
                    reply = {"error": dict(zip(("code", "message", "data"), error.args))}
                except (ValueError, TypeError, KeyError, AttributeError) as error:
                    reply = {"error": {"code": -32600, "message": f"not a request: {error!r}"}}
                self.send({"id": request.get("id") if isinstance(request, dict) else None, **reply})
        except OSError:
            pass  # gone
        with lock:
            for number in [n for n, s in subscriptions.items() if s["client"] is self]:
                del subscriptions[number]

    @staticmethod
    def refuse(name):
        raise RuntimeError(-32601, f"no method {name}")

    def send(self, message):
        with lock:
            try:
                self.wfile.write(json.dumps({"jsonrpc": "2.0", **message}).encode() + b"\n")
            except OSError:
                self.connection.close()


class Server(socketserver.ThreadingTCPServer):
    allow_reuse_address = daemon_threads = True


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--port", type=int, default=7481)
port = parser.parse_args().port
threading.Thread(target=Server(("127.0.0.1", port), Client).serve_forever, daemon=True).start()
last = None
while True:  # the work
    with lock:
        speed = 1 if time.time() < state["boost_until"] else settings["speed"]
        state["temperature_c"] += (80 - 50 * speed - state["temperature_c"]) * min(1, settings["period_s"])
        publish("air", {"temperature_c": state["temperature_c"], "speed": speed})
        if (now := status()["health"][0]["level"]) != last:
            last = now
            publish("status", status())
    time.sleep(settings["period_s"])
