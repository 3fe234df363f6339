"""A client of the WebSocket protocol of Foxglove, written from its description alone, and what its messages must be."""
import asyncio
import base64
import collections
import itertools
import json
import math
import struct
import threading

import jsonschema
import websockets

from support import wait_for

SCALARS = ("boolean", "string", "number", "integer")


class WebClient:
    """Connected from the start; a thread takes what comes. `judge` gets each message: its channel and the value."""

    def __init__(self, port, judge=None, **options):
        self.port, self.options, self.judge = port, {"subprotocols": ["foxglove.websocket.v1"], "max_size": None, **options}, judge
        self.info, self.channels, self.services, self.statuses, self.failures = None, {}, {}, [], []
        self.parameters, self.answers, self.close_code, self.error = {}, {}, None, None
        self.messages, self.times, self.subscribed = collections.defaultdict(list), collections.defaultdict(list), {}
        self.ids, self.updates = itertools.count(), []
        self.loop, self.socket, self.is_over = asyncio.new_event_loop(), None, threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()
        wait_for("the WebSocket", lambda: self.is_over.is_set() or (self.info and self.channels), 20)
        if self.error:
            raise self.error

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _run(self):
        try:
            self.loop.run_until_complete(self._listen())
        except Exception as error:  # pylint: disable=broad-except
            self.error = error
        self.is_over.set()

    async def _listen(self):
        async with websockets.connect(f"ws://127.0.0.1:{self.port}", **self.options) as self.socket:
            try:
                async for frame in self.socket:
                    self._take(frame)
            except websockets.ConnectionClosed:
                pass
        self.close_code = self.socket.close_code

    def _take(self, frame):
        if isinstance(frame, str):
            return self._take_text(strict_json(frame))
        if frame[0] == 1:
            subscription, nanoseconds = struct.unpack_from("<IQ", frame, 1)
            channel, value = self.subscribed[subscription], strict_json(frame[13:])
            self.messages[channel["topic"]].append(value)
            self.times[channel["topic"]].append(nanoseconds)
            if self.judge:
                self.judge(channel, value, nanoseconds)
        elif frame[0] == 3:
            service, call, length = struct.unpack_from("<III", frame, 1)
            assert frame[13:13 + length] == b"json", frame[:50]
            self.answers[call] = service, strict_json(frame[13 + length:])
        else:
            raise ValueError(f"opcode {frame[0]}")

    def _take_text(self, message):
        operation = message["op"]
        if operation == "serverInfo":
            self.info = message
        elif operation == "advertise":
            known = {channel["topic"] for channel in self.channels.values()}
            for channel in message["channels"]:
                assert channel["id"] not in self.channels and channel["topic"] not in known, channel
                self.channels[channel["id"]] = channel
        elif operation == "unadvertise":
            for number in message["channelIds"]:
                del self.channels[number]
        elif operation == "advertiseServices":
            self.services.update({service["name"]: service for service in message["services"]})
        elif operation == "unadvertiseServices":
            self.services = {name: one for name, one in self.services.items() if one["id"] not in message["serviceIds"]}
        elif operation == "parameterValues":
            for parameter in message["parameters"]:
                assert parameter.get("value") is not None, parameter
            self.updates.append(message)
            self.parameters[message.get("id")] = {one["name"]: one["value"] for one in message["parameters"]}
        elif operation == "status":
            self.statuses.append(message)
        elif operation == "serviceCallFailure":
            self.failures.append(message)
        else:
            raise ValueError(message)

    def send(self, frame):
        """Bytes, a text, or an operation."""
        frame = json.dumps(frame) if isinstance(frame, dict) else frame
        asyncio.run_coroutine_threadsafe(self.socket.send(frame), self.loop).result(20)

    def close(self):
        if not self.is_over.is_set():
            asyncio.run_coroutine_threadsafe(self.socket.close(), self.loop).result(20)
        self.thread.join(20)

    def drop(self):
        """As a browser that has crashed: no farewell."""
        self.loop.call_soon_threadsafe(self.socket.transport.abort)
        self.thread.join(20)

    def topics(self):
        return {channel["topic"] for channel in self.channels.values()}

    def subscribe(self, *topics):
        for channel in list(self.channels.values()):
            if channel["topic"] in topics:
                number = next(self.ids)  # from 0
                self.subscribed[number] = channel
                self.send({"op": "subscribe", "subscriptions": [{"id": number, "channelId": channel["id"]}]})

    def wait(self, topic, count=1, limit_s=20):
        """Until so many more messages have come; the last."""
        before = len(self.messages[topic])
        wait_for(f"{count} messages of {topic}", lambda: len(self.messages[topic]) >= before + count, limit_s)
        return self.messages[topic][-1]

    def call(self, name, limit_s=10, **params):
        number = next(self.ids)
        service = self.services[name]["id"]
        self.send(struct.pack("<BIII", 2, service, number, 4) + b"json" + json.dumps(params).encode())
        wait_for(f"the answer of {name}", lambda: number in self.answers, limit_s)
        assert self.answers[number][0] == service
        return self.answers[number][1]

    def ask(self, operation, **members):
        """Parameters by name."""
        number = f"ask {next(self.ids)}"
        self.send({"op": operation, "id": number, **members})
        wait_for("parameters", lambda: number in self.parameters)
        return self.parameters[number]

    def told(self, words, limit_s=10):
        """The first status with these words."""
        return wait_for(f"the status {words}", lambda: next((one for one in self.statuses if words in one["message"]), None), limit_s)

    def twist(self, channel, x=0.0, turn=0.0):
        value = {"linear": {"x": x, "y": 0, "z": 0}, "angular": {"x": 0, "y": 0, "z": turn}}
        self.send(struct.pack("<BI", 1, channel) + json.dumps(value).encode())


def strict_json(text):
    def refuse(constant):
        raise ValueError(f"{constant} is no JSON")
    return json.loads(text, parse_constant=refuse)


def judge_schema(schema, is_root=True, is_item=False):
    """As the parser of Lichtblick takes schemas: an object; one type each, no null, references or lists of lists."""
    assert isinstance(schema.get("type"), str), schema
    assert not {"$ref", "anyOf", "oneOf", "allOf"} & schema.keys(), schema
    assert schema["type"] == "object" or not is_root, schema
    if schema["type"] == "object":
        for member in schema["properties"].values():
            judge_schema(member, False)
    elif schema["type"] == "array":
        assert not is_item, schema
        judge_schema(schema["items"], False, True)
    else:
        assert schema["type"] in SCALARS, schema


def seconds(time):
    assert set(time) == {"sec", "nsec"} and 0 <= time["nsec"] < 10**9 and isinstance(time["sec"], int), time
    return time["sec"] + time["nsec"] * 1e-9


def judge_rotation(rotation):
    assert abs(math.hypot(*(rotation[axis] for axis in "xyzw")) - 1) < 1e-9, rotation


def judge_cloud(value):
    stride, data = value["point_stride"], base64.b64decode(value["data"], validate=True)
    assert len(data) % stride == 0 and data, (stride, len(data))
    assert {"x", "y", "z"} <= {field["name"] for field in value["fields"]}, value["fields"]
    for field in value["fields"]:
        assert field["type"] == 7 and field["offset"] + 4 <= stride, field
    for point in struct.iter_unpack("<4f", data):
        assert all(map(math.isfinite, point)) and math.hypot(*point[:3]) < 200, point
    judge_rotation(value["pose"]["orientation"])


def judge_scene(value):
    for entity in value["entities"]:
        assert entity["frame_id"] == "map" and seconds(entity["lifetime"]) == 0, entity["id"]
        for lines in entity["lines"]:
            assert lines["type"] == 2 and len(lines["points"]) % 2 == 0 and not lines["colors"] and not lines["indices"]
    for deletion in value["deletions"]:
        assert deletion["type"] in (0, 1), deletion


def judge_transforms(value):
    parents = {one["child_frame_id"]: one["parent_frame_id"] for one in value["transforms"]}
    assert len(parents) == len(value["transforms"]), parents
    for frame in parents:
        for _ in parents:
            frame = parents.get(frame, frame)
        assert frame == "map", parents
    for one in value["transforms"]:
        judge_rotation(one["rotation"])


def judge_place(value):
    assert abs(value["latitude"]) <= 90 and abs(value["longitude"]) <= 180 and len(value["position_covariance"]) == 9, value


JUDGES = {"foxglove.PointCloud": judge_cloud, "foxglove.SceneUpdate": judge_scene, "foxglove.FrameTransforms": judge_transforms,
          "foxglove.PoseInFrame": lambda value: judge_rotation(value["pose"]["orientation"]),
          "foxglove.LocationFix": judge_place}


class Judge:
    """Judges each message by the schema that was advertised, and the well-known ones once more by their meaning."""

    def __init__(self):
        self.seen, self.faults, self.validators = collections.Counter(), [], {}

    def declare(self, channels):
        for channel in channels:
            assert (channel["encoding"], channel["schemaEncoding"]) == ("json", "jsonschema"), channel
            schema = strict_json(channel["schema"])
            judge_schema(schema)
            jsonschema.Draft202012Validator.check_schema(schema)
            self.validators[channel["topic"]] = jsonschema.Draft202012Validator(schema)

    def __call__(self, channel, value, _nanoseconds):
        self.seen[channel["topic"]] += 1
        error = jsonschema.exceptions.best_match(self.validators[channel["topic"]].iter_errors(value))
        try:
            assert not error, error.message
            JUDGES.get(channel["schemaName"], lambda _: None)(value)
        except (AssertionError, KeyError, ValueError, struct.error) as fault:
            self.faults.append(f"{channel['topic']}: {fault!r}"[:500])
