#!/usr/bin/env python3
"""A daemon for Hermes in plain Python 3: a fan with settings, a command, a topic and health. hermes-gui, hermesctl and
hermes-supervisor treat it like any other; what it speaks is docs/protocol.md.   daemon.py --port 7481 [--config fan.json]"""
import argparse, asyncio, hashlib, itertools, json, os, signal, socket, time

SETTINGS = {  # by name; the schema is what is checked, and what the window shows
    "speed": {"type": "number", "minimum": 0, "maximum": 1, "default": 0.3, "description": "Share of the full speed"},
    "period_s": {"type": "number", "minimum": 0.02, "maximum": 10, "unit": "s", "default": 0.1, "description": "Between two messages"},
    "alarm_c": {"type": "number", "minimum": -20, "maximum": 120, "unit": "°C", "default": 60, "description": "Warns above"}}
TOPICS = [{"name": name, "summary": summary, "schema": {}, "snapshot": False} for name, summary in (
    ("air", "Temperature and speed"), ("log", "Each record"), ("status", "State and health"), ("settings", "After a change"))]
METHODS = {}  # name: (summary, {parameter: schema}, function); a parameter without a default is required
TYPES = {"number": (int, float), "integer": int, "string": str, "object": dict, "array": list, "boolean": bool}
DISCARD_BYTES = 256 << 10  # so much may wait for a client that reads slowly; more is dropped and counted


class Refusal(Exception):
    """A request that cannot be fulfilled: code, message, data."""


def method(name, summary, **parameters):
    def add(function):
        METHODS[name] = (summary, parameters, function)
        return function
    return add


def check(schemas, values, code):
    """Refuses values that are unknown or not as their schemas say."""
    errors = []
    for name, value in values.items():
        schema = schemas.get(name, {})
        least, most = schema.get("minimum", float("-inf")), schema.get("maximum", float("inf"))
        right = isinstance(value, TYPES.get(schema.get("type"), ())) and (schema["type"] == "boolean") == isinstance(value, bool)
        if not right or isinstance(value, (int, float)) and not least <= value <= most:
            expected = f"{schema['type']} from {least} to {most} {schema.get('unit', '')}".strip() if schema else "a known name"
            errors.append({"path": name, "value": value, "expected": expected})
    if errors:
        raise Refusal(code, "; ".join(f"{e['path']}: expected {e['expected']}" for e in errors), {"errors": errors})


class Fan:
    def __init__(self, options):
        self.options, self.started, self.numbers, self.end = options, time.time(), itertools.count(1), asyncio.Event()
        self.settings = {name: schema["default"] for name, schema in SETTINGS.items()}
        self.temperature, self.boost_until, self.records, self.subscriptions = 40.0, 0.0, [], {}
        if options.config and os.path.exists(options.config):
            with open(options.config, encoding="utf-8") as file:
                self.set(json.load(file))

    @method("fan.boost", "Full speed for a while",
            duration_s={"type": "number", "minimum": 0.1, "maximum": 60, "unit": "s", "description": "How long"})
    def boost(self, duration_s):
        self.boost_until = time.time() + duration_s
        self.log("info", f"full speed for {duration_s:g} s")
        return {"speed": 1}

    @method("rpc.discover", "This description")
    def discover(self):
        methods = [{"name": name, "summary": summary, "result": {"name": "result", "schema": {}},
                    "params": [{"name": n, "required": "default" not in s, "schema": s} for n, s in parameters.items()]}
                   for name, (summary, parameters, _) in METHODS.items()]
        return {"openrpc": "1.2.6", "info": {"title": "Fan", "version": "1.0"}, "methods": methods, "x-topics": TOPICS}

    @method("daemon.info", "Who this daemon is")
    def info(self):
        return {"name": "fan", "title": "Fan", "version": "1.0", "protocol": 1, "host": socket.gethostname(), "pid": os.getpid(),
                "description_hash": hashlib.sha256(json.dumps(self.discover()).encode()).hexdigest(), "started": self.started,
                "uptime_s": time.time() - self.started, "listen": [f"tcp://127.0.0.1:{self.options.port}?protocol=json"]}

    @method("daemon.status", "Its state and health")
    def status(self):
        level, message = ("warn", "too hot") if self.temperature > self.settings["alarm_c"] else ("ok", "cool enough")
        health = {"name": "air", "level": level, "message": message, "values": {"temperature_c": self.temperature}, "age_s": 0}
        return {"state": "running", "restart_for": [], "health": [health]}

    @method("settings.schema", "The schema of the settings")
    def schema(self):
        return {"type": "object", "properties": SETTINGS}

    @method("settings.get", "All settings")
    def get(self):
        return self.settings

    @method("settings.set", "Changes all of these or none", values={"type": "object"})
    def set(self, values):
        check(SETTINGS, values, -32003)
        changed = [name for name, value in values.items() if self.settings[name] != value]
        self.settings.update(values)
        if changed:
            self.publish("settings", self.settings)
        return {"changed": changed, "restart": []}

    @method("settings.save", "Keeps the settings for the next start")
    def save(self):
        if not self.options.config:
            raise Refusal(-32008, "started without --config: nowhere to save")
        with open(self.options.config + ".new", "w", encoding="utf-8") as file:
            json.dump(self.settings, file, indent=4)
        os.replace(self.options.config + ".new", self.options.config)
        return {"path": self.options.config}

    @method("log.tail", "The last records", count={"type": "integer", "minimum": 1, "maximum": 200, "default": 100})
    def tail(self, count):
        return self.records[-count:]

    @method("topics.subscribe", "Sends a topic to this client", topic={"type": "string"}, queue={"type": "integer", "default": 1},
            max_rate_hz={"type": "number", "minimum": 0, "default": 0})
    def subscribe(self, topic, max_rate_hz, queue):
        if topic not in [known["name"] for known in TOPICS]:
            raise Refusal(-32006, f"no topic {topic}")
        number, pause = next(self.numbers), 0.9 / max_rate_hz if max_rate_hz else 0
        self.subscriptions[number] = {"client": self.client, "topic": topic, "pause": pause, "due": 0, "seq": 0, "dropped": 0}
        return {"subscription": number}

    @method("topics.unsubscribe", "Ends a subscription", subscription={"type": "integer"})
    def unsubscribe(self, subscription):
        self.subscriptions.pop(subscription, None)

    def log(self, level, text):
        self.records = self.records[-199:] + [{"stamp": time.time(), "level": level, "source": "fan", "text": text}]
        self.publish("log", self.records[-1])

    def publish(self, topic, data):
        now = time.time()
        for number, s in self.subscriptions.items():
            s["seq"] += s["topic"] == topic
            if s["topic"] != topic or now < s["due"]:
                continue
            s["due"] = now + s["pause"]
            if s["client"].transport.get_write_buffer_size() > DISCARD_BYTES:
                s["dropped"] += 1
                continue
            send(s["client"], {"method": "topic", "params": {"subscription": number, "topic": topic, "seq": s["seq"],
                                                             "dropped": s["dropped"], "stamp": now, "data": data}})

    def answer(self, request):
        """The result of a request."""
        if not isinstance(request, dict) or not isinstance(request.get("params", {}), dict):
            raise Refusal(-32600, "not a request with named parameters")
        if request.get("method") not in METHODS:
            raise Refusal(-32601, f"no method {request.get('method')}")
        _, schemas, function = METHODS[request["method"]]
        values = {**{name: schema.get("default") for name, schema in schemas.items()}, **request.get("params", {})}
        check(schemas, values, -32602)
        return function(self, **values)

    async def serve(self, reader, writer):
        try:
            while line := await reader.readline():
                request, self.client = None, writer
                try:
                    request = json.loads(line)
                    reply = {"result": self.answer(request)}
                except Refusal as refusal:
                    reply = {"error": dict(zip(("code", "message", "data"), refusal.args))}
                except ValueError as error:
                    reply = {"error": {"code": -32700, "message": str(error)}}
                if not isinstance(request, dict) or "id" in request:  # a notification gets no reply
                    send(writer, {"id": request["id"] if isinstance(request, dict) else None, **reply})
                await writer.drain()
        except (ConnectionError, ValueError):
            pass  # gone, or a line over the limit
        self.subscriptions = {n: s for n, s in self.subscriptions.items() if s["client"] is not writer}
        writer.close()

    async def work(self):
        health = None
        while True:
            speed = 1 if time.time() < self.boost_until else self.settings["speed"]
            self.temperature += (80 - 50 * speed - self.temperature) * min(1, self.settings["period_s"])
            self.publish("air", {"temperature_c": self.temperature, "speed": speed})
            if (now := self.status()["health"][0]["level"]) != health:
                health = now
                self.publish("status", self.status())
            await asyncio.sleep(self.settings["period_s"])


def send(writer, message):
    writer.write(json.dumps({"jsonrpc": "2.0", **message}).encode() + b"\n")


async def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--port", type=int, default=7481)
    parser.add_argument("--config", help="where the settings are kept")
    fan = Fan(parser.parse_args())
    server = await asyncio.start_server(fan.serve, "127.0.0.1", fan.options.port, limit=1 << 20)
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, fan.end.set)
    fan.log("info", "running")
    worker = asyncio.create_task(fan.work())
    await fan.end.wait()
    worker.cancel()
    server.close()


asyncio.run(main())
