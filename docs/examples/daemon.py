#!/usr/bin/env python3
"""A daemon for Hermes in plain Python 3: a fan with settings, a command, a topic and health. hermes-gui, hermesctl and
hermes-supervisor treat it like any other; what it speaks is docs/protocol.md."""
import argparse, asyncio, contextlib, itertools, json, os, signal, socket, time

STARTED = time.time()
SETTINGS = {  # what is checked, and what the window shows
    "speed": {"type": "number", "minimum": 0, "maximum": 1, "default": 0.3, "description": "Share of the full speed"},
    "period_s": {"type": "number", "minimum": 0.02, "maximum": 10, "unit": "s", "default": 0.1, "description": "Of messages"},
    "alarm_c": {"type": "number", "minimum": -20, "maximum": 120, "unit": "°C", "default": 60, "description": "Warns above"}}
TOPICS = {"air": "Temperature and speed", "log": "Each record", "status": "State and health", "settings": "After a change"}
TYPES = {"number": (int, float), "integer": int, "string": str, "boolean": bool, "array": list, "object": dict}
METHODS = {}  # name: (summary, {parameter: schema}, function)
settings = {name: schema["default"] for name, schema in SETTINGS.items()}
state = {"temperature_c": 40.0, "boost_until": 0.0}
records, subscriptions, numbers, ending = [], {}, itertools.count(1), asyncio.Event()


class Refusal(Exception): pass  # (code, message, data) of the error that the client gets


def method(name, summary, **parameters):
    def add(function):
        METHODS[name] = (summary, parameters, function)
        return function
    return add


def check(schemas, values, code):
    """Refuses values that are unknown, of another type or beyond their limits."""
    for name, value in values.items():
        schema = schemas.get(name, {"type": "nothing of this name"})
        right = isinstance(value, TYPES.get(schema["type"], ())) and isinstance(value, bool) == (schema["type"] == "boolean")
        if not right or "minimum" in schema and not schema["minimum"] <= value <= schema.get("maximum", 1e9):
            expected = f"{schema['type']} {schema.get('minimum', '')} to {schema.get('maximum', '')}"
            raise Refusal(code, f"{name}: expected {expected}", {"errors": [{"path": name, "value": value, "expected": expected}]})


@method("fan.boost", "Full speed for a while",
        duration_s={"type": "number", "minimum": 0.1, "maximum": 60, "unit": "s", "description": "How long"})
def boost(client, duration_s):
    state["boost_until"] = time.time() + duration_s
    records.append({"stamp": time.time(), "level": "info", "source": "fan", "text": f"full speed for {duration_s:g} s"})
    publish("log", records[-1])
    return {"speed": 1}


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


@method("settings.save", "Writes what differs from the defaults to the file of --config")
def save(client):
    try:
        with open(options.config, "w", encoding="utf-8") as file:
            json.dump({name: value for name, value in settings.items() if value != SETTINGS[name]["default"]}, file)
    except OSError as error:
        raise Refusal(-32008, str(error), {"path": options.config}) from error
    return {"path": options.config}


@method("topics.subscribe", "Sends a topic to this client", topic={"type": "string"}, queue={"type": "integer", "default": 1},
        max_rate_hz={"type": "number", "minimum": 0, "default": 0})
def subscribe(client, topic, queue, max_rate_hz):
    if topic not in TOPICS:
        raise Refusal(-32006, f"no topic {topic}")
    number, pause = next(numbers), 0.9 / max_rate_hz if max_rate_hz else 0
    subscriptions[number] = {"client": client, "topic": topic, "pause": pause, "due": 0, "seq": 0, "dropped": 0}
    return {"subscription": number}


@method("rpc.discover", "This description")
def discover(client):
    methods = [{"name": name, "summary": summary, "params": [{"name": n, "required": "default" not in s, "schema": s}
                for n, s in schemas.items()], "result": {"name": "result", "schema": {}}} for name, (summary, schemas, _) in METHODS.items()]
    return {"openrpc": "1.2.6", "info": {"title": "Fan", "version": "1.0"}, "methods": methods, "x-topics": topics()}


@method("topics.list", "What can be subscribed to")
def topics(client=None):
    return [{"name": name, "summary": summary, "schema": {}, "snapshot": False} for name, summary in TOPICS.items()]


method("topics.unsubscribe", "Ends a subscription", subscription={"type": "integer"})(
    lambda client, subscription: subscriptions.pop(subscription, None) and None)
method("daemon.info", "Who this daemon is")(lambda client: {
    "name": "fan", "title": "Fan", "version": "1.0", "host": socket.gethostname(), "pid": os.getpid(), "started": STARTED,
    "uptime_s": time.time() - STARTED, "description_hash": str(STARTED)})
method("daemon.shutdown", "Ends it in order")(lambda client: ending.set())
method("settings.schema", "The schema of the settings")(lambda client: {"type": "object", "properties": SETTINGS})
method("settings.get", "All settings, or the one at a path", path={"type": "string", "default": ""})(
    lambda client, path: settings[path] if path else settings)
method("settings.reset", "Back to the defaults, these or all", paths={"type": "array", "default": []})(
    lambda client, paths: change(client, {name: SETTINGS[name]["default"] for name in paths or SETTINGS}))
method("log.tail", "The last records", count={"type": "integer", "minimum": 1, "default": 100})(
    lambda client, count: records[-count:])


def publish(topic, data):
    now = time.time()
    for number, s in subscriptions.items():
        s["seq"] += s["topic"] == topic
        if s["topic"] == topic and now >= s["due"]:
            s["due"] = now + s["pause"]
            s["dropped"] += not send(s["client"], {"method": "topic", "params": {
                "subscription": number, "topic": topic, "seq": s["seq"], "dropped": s["dropped"], "stamp": now, "data": data}})


def send(client, message):
    """Not to a client that leaves 256 KiB unread: nobody waits for it."""
    if client.transport.get_write_buffer_size() > 1 << 18:
        return False
    client.write(json.dumps({"jsonrpc": "2.0", **message}).encode() + b"\n")
    return True


def answer(client, line):
    """The reply to a request; None: it is a notification."""
    request = {"id": None}
    try:
        request = json.loads(line)
        if request["method"] not in METHODS:
            raise Refusal(-32601, f"no method {request['method']}")
        _, schemas, function = METHODS[request["method"]]
        values = {**{n: s["default"] for n, s in schemas.items() if "default" in s}, **request.get("params", {})}
        check(schemas, values, -32602)
        reply = {"result": function(client, **values)}
    except Refusal as error:
        reply = {"error": dict(zip(("code", "message", "data"), error.args))}
    except (json.JSONDecodeError, UnicodeDecodeError, RecursionError) as error:
        reply = {"error": {"code": -32700, "message": f"no JSON: {error}"}}
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        reply = {"error": {"code": -32600, "message": f"not a request: {error!r}"}}
    if isinstance(request, dict) and "id" not in request:
        return None
    return {"id": request["id"] if isinstance(request, dict) else None, **reply}


async def serve(reader, client):
    line = b"\n"
    while line and not client.transport.is_closing():
        try:
            line = await reader.readline()
        except (OSError, ValueError, asyncio.CancelledError):  # gone, a line beyond the limit, the end
            break
        reply = answer(client, line) if line.strip() else None
        if reply and not send(client, reply):
            client.transport.abort()  # does not read its replies
    for number in [n for n, s in subscriptions.items() if s["client"] is client]:
        del subscriptions[number]
    client.close()


async def work():
    asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, ending.set)
    await asyncio.start_server(serve, "127.0.0.1", options.port, limit=1 << 20)
    level = None
    while not ending.is_set():
        speed = 1 if time.time() < state["boost_until"] else settings["speed"]
        state["temperature_c"] += (80 - 50 * speed - state["temperature_c"]) * min(1, settings["period_s"])
        publish("air", {"temperature_c": state["temperature_c"], "speed": speed})
        if status()["health"][0]["level"] != level:
            level = status()["health"][0]["level"]
            publish("status", status())
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(ending.wait(), settings["period_s"])


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--port", type=int, default=7481)
parser.add_argument("--config", default="", help="file of settings, for settings.save")
options = parser.parse_args()
if os.path.exists(options.config):
    with open(options.config, encoding="utf-8") as kept:
        change(None, json.load(kept))
asyncio.run(work())
