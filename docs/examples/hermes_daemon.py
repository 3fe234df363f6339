"""What every Hermes daemon has, in plain Python 3: the commands, topics and rules of docs/protocol.md, without batches and
positional parameters. daemon.py is a daemon made of it."""
import argparse
import asyncio
import itertools
import json
import math
import os
import signal
import socket
import sys
import time

COMMON_TOPICS = {"log": "Each record", "status": "State and health", "settings": "After a change"}
TYPES = {"number": (int, float), "integer": int, "string": str, "boolean": bool, "array": list, "object": dict}


class Refusal(Exception):
    """An error that the client gets: code, message, data."""


class Daemon:
    """A daemon with a name, settings {name: JSON schema with a default}, topics {name: what it has} and commands. The setting "a.b" is
    b of the group a. A command is a function that `method` has decorated; what it returns is the result, and Refusal is an error. One
    that waits is an async function: others are served meanwhile."""

    def __init__(self, name, title, settings, topics, version="1.0"):
        self.name, self.title, self.version = name, title, version
        self.schemas, self.topics = settings, {**topics, **COMMON_TOPICS}
        self.settings = {name: schema["default"] for name, schema in settings.items()}
        self.health, self.records, self.methods = {}, [], {}
        self.subscriptions, self.numbers = {}, itertools.count(1)
        self.started, self.ending, self.client = time.time(), asyncio.Event(), None
        for function, summary, parameters in (
                (self.rpc_discover, "This description", {}),
                (self.daemon_info, "Who this daemon is", {}),
                (self.daemon_status, "Its state and health", {}),
                (self.daemon_shutdown, "Ends it in order", {}),
                (self.settings_schema, "The schema of the settings", {}),
                (self.settings_get, "All settings, or the one at a path", {"path": {"type": "string", "default": ""}}),
                (self.settings_set, "Changes all of these or none", {"values": {"type": "object"}}),
                (self.settings_reset, "Back to the defaults, these or all", {"paths": {"type": "array", "default": []}}),
                (self.settings_save, "Writes what differs from the defaults to the file of --config", {}),
                (self.topics_list, "What can be subscribed to", {}),
                (self.topics_subscribe, "Sends a topic to this client", {
                    "topic": {"type": "string"}, "queue": {"type": "integer", "default": 1},
                    "max_rate_hz": {"type": "number", "minimum": 0, "default": 0}}),
                (self.topics_unsubscribe, "Ends a subscription", {"subscription": {"type": "integer"}}),
                (self.log_tail, "The last records", {"count": {"type": "integer", "minimum": 1, "default": 100}})):
            self.methods[function.__name__.replace("_", ".", 1)] = (summary, parameters, function)

    def method(self, name, summary, **parameters):
        """Makes a function a command; its parameters are described by JSON schemas."""
        def add(function):
            self.methods[name] = (summary, parameters, function)
            return function
        return add

    def log(self, text, level="info"):
        """Keeps a record and sends it to who follows the log. The level is debug, info, warning or error."""
        self.records = self.records[-999:] + [{"stamp": time.time(), "level": level, "source": self.name, "text": text}]
        self.publish("log", self.records[-1])

    def set_health(self, item, level, message):
        """The state of a part of the daemon, with a message for people. The level is ok, warn or error."""
        state = {"name": item, "level": level, "message": message, "values": {}}
        if self.health.get(item) != state:
            self.health[item] = state
            self.publish("status", self.daemon_status())

    def publish(self, topic, data, stamp=None):
        """Sends data (what JSON can hold) to all who follow the topic, to each no more often than it asked for. The stamp is the time
        for which they hold, in seconds since the Unix epoch; without one it is now."""
        now = time.time()
        for number, s in self.subscriptions.items():
            s["seq"] += s["topic"] == topic
            if s["topic"] == topic and now >= s["due"]:
                s["due"] = now + s["pause"]
                s["dropped"] += not send(s["client"], {"method": "topic", "params": {
                    "subscription": number, "topic": topic, "seq": s["seq"], "dropped": s["dropped"],
                    "stamp": now if stamp is None else stamp, "data": data}})

    def run(self, work, port):
        """Serves until Ctrl-C, SIGTERM or daemon.shutdown; `work` is called every settings["period_s"] seconds."""
        parser = argparse.ArgumentParser(description=self.title)
        parser.add_argument("--port", type=port_number, default=port)
        parser.add_argument("--config", default="", help="file of settings, for settings.save")
        parser.add_argument("--set", type=setting, action="append", default=[], metavar="NAME=VALUE", help="wins over the file")
        self.options = parser.parse_args()
        try:
            if os.path.exists(self.options.config):
                with open(self.options.config, encoding="utf-8") as kept:
                    self.settings_set(from_json(kept.read()))
            self.settings_set(dict(self.options.set))
        except Refusal as error:
            sys.exit(f"{self.name}: settings: {error.args[1]}")
        except (OSError, ValueError, AttributeError) as error:
            sys.exit(f"{self.name}: {self.options.config}: expected an object of JSON: {error}")
        asyncio.run(self._run(work))

    async def _run(self, work):
        for number in (signal.SIGINT, signal.SIGTERM):
            asyncio.get_running_loop().add_signal_handler(number, self.ending.set)
        try:
            await asyncio.start_server(self._serve, "127.0.0.1", self.options.port, limit=1 << 20)
        except OSError as error:
            sys.exit(f"{self.name}: cannot listen on 127.0.0.1:{self.options.port}: {os.strerror(error.errno)}; "
                     "end the program that has this port, or choose another one with --port")
        print(f"{self.name}: running at 127.0.0.1:{self.options.port}", flush=True)
        while not self.ending.is_set():
            work()
            try:
                await asyncio.wait_for(self.ending.wait(), self.settings["period_s"])
            except asyncio.TimeoutError:
                pass

    async def _serve(self, reader, client):
        line = b"\n"
        try:
            while line and not client.transport.is_closing():
                line = await reader.readline()
                self.client = client
                reply = await self._answer(line) if line.strip() else None
                if reply and not send(client, reply):
                    client.transport.abort()  # does not read its replies
        except (OSError, ValueError, asyncio.CancelledError):  # gone, a line beyond the limit, the end
            pass
        finally:
            for number in [n for n, s in self.subscriptions.items() if s["client"] is client]:
                del self.subscriptions[number]
            client.close()
            self.gone(client)

    async def _answer(self, line):
        """The reply to a request; None: it is a notification."""
        request = None
        try:
            request = from_json(line)
            if request["method"] not in self.methods:
                raise Refusal(-32601, f"no method {request['method']}")
            _, schemas, function = self.methods[request["method"]]
            values = {**{n: s["default"] for n, s in schemas.items() if "default" in s}, **request.get("params", {})}
            check(schemas, values, -32602)
            if missing := [n for n in schemas if n not in values]:
                raise Refusal(-32602, f"missing: {', '.join(missing)}")
            result = function(**values)
            reply = {"result": await result if asyncio.iscoroutine(result) else result}
        except Refusal as error:
            reply = {"error": dict(zip(("code", "message", "data"), error.args))}
        except (json.JSONDecodeError, UnicodeDecodeError, RecursionError) as error:
            reply = {"error": {"code": -32700, "message": f"no JSON: {error}"}}
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            reply = {"error": {"code": -32600, "message": f"not a request: {error!r}"}}
        if isinstance(request, dict) and "id" not in request:
            return None
        return {"id": request["id"] if isinstance(request, dict) else None, **reply}

    def gone(self, client):
        """Is called when a client has gone, which was self.client in its commands."""

    def rpc_discover(self):
        methods = [{"name": name, "summary": summary, "result": {"name": "result", "schema": {}},
                    "params": [{"name": n, "required": "default" not in s, "schema": s} for n, s in schemas.items()]}
                   for name, (summary, schemas, _) in self.methods.items()]
        return {"openrpc": "1.2.6", "info": {"title": self.title, "version": self.version}, "methods": methods,
                "x-topics": self.topics_list()}

    def daemon_info(self):
        return {"name": self.name, "title": self.title, "version": self.version, "host": socket.gethostname(), "pid": os.getpid(),
                "started": self.started, "uptime_s": time.time() - self.started, "description_hash": str(self.started)}

    def daemon_status(self):
        return {"state": "running", "restart_for": [], "health": list(self.health.values())}

    def daemon_shutdown(self):
        self.ending.set()

    def settings_schema(self):
        return grouped({"type": "object", "properties": {}, **{
            "properties." + name.replace(".", ".properties."): schema for name, schema in self.schemas.items()}})

    def settings_get(self, path):
        value = grouped(self.settings)
        for name in path.split(".") if path else ():
            if not isinstance(value, dict) or name not in value:
                raise Refusal(-32602, f"path: {path} is unknown, there is {', '.join(self.settings)}")
            value = value[name]
        return value

    def settings_set(self, values):
        values = self.ungrouped(values)
        check(self.schemas, values, -32003)
        changed = [name for name, value in values.items() if self.settings[name] != value]
        self.settings.update(values)
        self.publish("settings", grouped(self.settings))
        return {"changed": changed, "restart": []}

    def ungrouped(self, values, before=""):
        """{"a": {"b": 1}} as {"a.b": 1}, for settings."""
        flat = {}
        for name, value in values.items():
            path = before + name
            flat.update(self.ungrouped(value, path + ".") if isinstance(value, dict) and path not in self.schemas else {path: value})
        return flat

    def settings_reset(self, paths):
        return self.settings_set({name: self.schemas[name]["default"] for name in paths or self.schemas})

    def settings_save(self):
        if not self.options.config:
            raise Refusal(-32008, "no file to save to: start the daemon with --config FILE")
        kept = {name: value for name, value in self.settings.items() if value != self.schemas[name]["default"]}
        try:
            with open(self.options.config + ".new", "w", encoding="utf-8") as file:
                json.dump(grouped(kept), file)
                file.flush()
                os.fsync(file.fileno())
            os.replace(file.name, self.options.config)  # a full disk leaves the old one
        except OSError as error:
            raise Refusal(-32008, str(error), {"path": self.options.config}) from error
        return {"path": self.options.config}

    def topics_list(self):
        return [{"name": name, "summary": summary, "schema": {}, "snapshot": False} for name, summary in self.topics.items()]

    def topics_subscribe(self, topic, queue, max_rate_hz):  # a queue of one: the newest
        if topic not in self.topics:
            raise Refusal(-32006, f"no topic {topic}")
        number, pause = next(self.numbers), 0.9 / max_rate_hz if max_rate_hz else 0
        self.subscriptions[number] = {"client": self.client, "topic": topic, "pause": pause, "due": 0, "seq": 0, "dropped": 0}
        return {"subscription": number}

    def topics_unsubscribe(self, subscription):
        if self.subscriptions.get(subscription, {}).get("client") is self.client:
            del self.subscriptions[subscription]

    def log_tail(self, count):
        return self.records[-count:]


def port_number(text):
    if not 0 < int(text) < 65536:
        raise ValueError
    return int(text)


def setting(text):
    """NAME=VALUE, of which the value is JSON or a text."""
    name, value = text.split("=", 1)
    try:
        return name, from_json(value)
    except ValueError:
        return name, value


def grouped(flat):
    """{"a.b": 1} as {"a": {"b": 1}}."""
    values = {}
    for path, value in flat.items():
        *groups, name = path.split(".")
        place = values
        for group in groups:
            place = place.setdefault(group, {})
        place[name] = value
    return values


def finite(text):
    if not math.isfinite(number := float(text)):
        raise json.JSONDecodeError("not a finite number", text, 0)
    return number


def from_json(text):
    """What Python also takes for JSON, NaN and Infinity, is none."""
    return json.loads(text, parse_float=finite, parse_constant=finite)


def check(schemas, values, code):
    """Refuses values that are unknown, of another type or beyond their limits."""
    for name, value in values.items():
        if name not in schemas:
            raise Refusal(code, f"{name} is unknown, there is {', '.join(schemas) or 'nothing'}", {"errors": [{"path": name, "value": value}]})
        schema = schemas[name]
        right = isinstance(value, TYPES.get(schema["type"], ())) and isinstance(value, bool) == (schema["type"] == "boolean")
        if not right or "minimum" in schema and not schema["minimum"] <= value <= schema.get("maximum", 1e9):
            expected = schema["type"] + (f" from {schema['minimum']} to {schema.get('maximum', 1e9)}" if "minimum" in schema else "")
            raise Refusal(code, f"{name} is {json.dumps(value)}, expected {expected}", {"errors": [{"path": name, "value": value, "expected": expected}]})


def send(client, message):
    """Not to a client that has gone, or leaves 256 KiB unread: nobody waits for it."""
    if client.transport.is_closing() or client.transport.get_write_buffer_size() > 1 << 18:
        return False
    client.write(json.dumps({"jsonrpc": "2.0", **message}, allow_nan=False).encode() + b"\n")
    return True
