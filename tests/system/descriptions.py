#!/usr/bin/env python3
"""What each daemon tells of its commands and settings is what it accepts: whatever the schemas forbid is refused, by its path,
and changes nothing; what they allow is not refused by them; examples run."""
import functools
import os
import socket
import sys
import tempfile

from support import BINARIES, DaemonError, Process, free_port

DAEMONS = ("motorcontrol", "velodynelogger", "seriallogger", "softwaretrigger", "scanmatcher", "scanner", "supervisor", "simulator")
COMMON = {"rpc.discover", "daemon.info", "daemon.status", "daemon.shutdown", "settings.schema", "settings.get",
          "settings.set", "settings.reset", "settings.save", "topics.list", "topics.subscribe", "topics.unsubscribe",
          "topics.replay", "log.tail"}
SAMPLES = (("number", 1.5), ("integer", 3), ("string", "zz"), ("boolean", True), ("array", [[[]]]), ("null", None),
           ("object", {"no such": 1}))


def types(schema):
    given = schema.get("type", [])
    return set(given if isinstance(given, list) else [given]) | ({"integer"} if "number" in given else set())


def forbidden(schema):
    """Values that the schema does not allow."""
    wrong = [value for name, value in SAMPLES if types(schema) and name not in types(schema)]
    if "minimum" in schema:
        wrong.append(schema["minimum"] - 1)
    if "maximum" in schema:
        wrong.append(schema["maximum"] * 2 + 1)
    if "enum" in schema:
        wrong.append("no such choice")
    if "minLength" in schema:
        wrong.append("")
    if "maxLength" in schema:
        wrong.append("a" * (schema["maxLength"] + 1))
    return wrong


def allowed(schema):
    """Values that it allows: at its ends, as far as it has any."""
    if "enum" in schema:
        return list(schema["enum"])
    return [schema[end] for end in ("minimum", "maximum") if end in schema]


def error_of(daemon, method, params):
    try:
        daemon.call(method, **params)
    except DaemonError as error:
        return error
    return None


def paths_of(error):
    """What it names as wrong."""
    return [e["path"] for e in ((error and error.data) or {}).get("errors", [])]


def refused(daemon, method, params, code, path):
    error = error_of(daemon, method, params)
    assert error, f"{method} accepted {str(params)[:200]}"
    assert error.code == code and any(p.startswith(path) for p in paths_of(error)), f"{method} {str(params)[:200]}: {error} {error.data}"


def leaves(schema, path=()):
    for name, part in schema["properties"].items():
        if "properties" in part:
            yield from leaves(part, path + (name,))
        else:
            yield path + (name,), part


def nested(path, value):
    for name in reversed(path):
        value = {name: value}
    return value


def check_settings(daemon):
    before = daemon.call("settings.get")
    for path, schema in leaves(daemon.call("settings.schema")):
        name = ".".join(path)
        assert {"default", "description", "x-applies"} <= set(schema), f"{name}: {schema}"
        for value in forbidden(schema):
            refused(daemon, "settings.set", {"values": nested(path, value)}, -32003, name)
        for value in allowed(schema):
            error = error_of(daemon, "settings.set", {"values": nested(path, value)})
            assert not error or error.data["errors"][0]["expected"].startswith(("at ", "another", "a motor", "differential", "from ", "numbers", "0 or", "false", "1: ")), f"{name}: {error}"
            daemon.call("settings.set", values=nested(path, functools.reduce(dict.get, path, before)))
        refused(daemon, "settings.set", {"values": {**nested(path, schema["default"]), "no such": 1}}, -32003, "no such")
        assert daemon.call("settings.get") == before, name


def check_commands(daemon):
    methods = daemon.call("rpc.discover")["methods"]
    assert COMMON <= {method["name"] for method in methods}
    for method in methods:
        if method["name"] == "daemon.shutdown":
            continue
        if method.get("x-urgent"):  # a stop is carried out whatever its form is
            for params in [{"no such": 1}] + [{p["name"]: v} for p in method["params"] for v in forbidden(p["schema"])]:
                error = error_of(daemon, method["name"], params)
                assert not paths_of(error) and (not error or error.code != -32602), f"{method['name']} {params}: {error}"
            continue
        refused(daemon, method["name"], {"no such": 1}, -32602, "no such")
        required = {p["name"] for p in method["params"] if p["required"]}
        for param in method["params"]:
            assert param["schema"].get("description"), f"{method['name']}: {param}"
            for value in forbidden(param["schema"]):
                refused(daemon, method["name"], {param["name"]: value}, -32602, param["name"])
            if param["required"]:
                refused(daemon, method["name"], {}, -32602, param["name"])
            for value in [] if required - {param["name"]} else allowed(param["schema"]):
                error = error_of(daemon, method["name"], {param["name"]: value})
                assert param["name"] not in paths_of(error), f"{method['name']} {param['name']}={value}: {error}"


def main():
    for name in sys.argv[1:] or DAEMONS:
        with tempfile.TemporaryDirectory() as folder:
            settings = {"velodynelogger": {"record.folder": folder, "source.port": free_port(0, socket.SOCK_DGRAM),
                                           "source.position_port": 0},
                        "seriallogger": {"record.folder": folder}, "scanmatcher": {"map.folder": folder},
                        "motorcontrol": {"controllers.1.url": "serial://" + folder + "/none",
                                         "controllers.2.url": "serial://" + folder + "/none"},
                        "supervisor": {"processes": "[]"}}.get(name, {})
            with Process(BINARIES, name, free_port(0), folder, settings) as process:
                with process.connect() as daemon:
                    check_settings(daemon)
                    check_commands(daemon)
                assert process.stop() == 0, process.last_words()
    print("each description is what its daemon accepts")


if __name__ == "__main__":
    main()
