"""A node of another vendor beside the robot: tests/system/ros2_peer.cpp (Fast DDS, as rmw_fastrtps), driven by lines of JSON. Messages are
dictionaries, as tests/support/ros_cdr.py decodes them; topics have the names of ROS ("/scan"), or of DDS where they begin without "/"."""
import collections
import json
import os
import random
import socket
import subprocess
import sys
import threading

from support import BUILD, PATIENCE, SOURCE, wait_for

sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
import ros_cdr  # noqa: E402  pylint: disable=wrong-import-position
from processes import die_with, held  # noqa: E402  pylint: disable=wrong-import-position

PEER = os.path.join(BUILD, "tests", "system", "ros2_peer")
Sample = collections.namedtuple("Sample", "message received source guid size")  # times in seconds since the epoch


def wire_name(topic):
    return "rt" + topic if topic.startswith("/") else topic


def stamp_of(message):
    """Of what has a header, of a log record or of a clock: seconds since the epoch."""
    time = message["header"]["stamp"] if "header" in message else message.get("stamp", message.get("clock"))
    return time["sec"] + time["nanosec"] * 1e-9


def free_domain():
    """One that no other test has while this process lives; its ports lie below those of free_port."""
    for domain in random.sample(range(1, 50), 49):
        holder = socket.socket(socket.AF_UNIX)
        try:
            holder.bind(f"\0hermes test domain {domain}")
        except OSError:
            holder.close()
            continue
        held.append(holder)
        return domain
    raise OSError("no free domain")


class PeerError(Exception):
    """The peer refused a request."""


class Peer:
    """A running ros2_peer; to be used in a with statement. `within` are words before its own, which start it elsewhere."""

    def __init__(self, domain, *arguments, within=()):
        parent = os.getpid()
        self.process = subprocess.Popen([*within, PEER, "--domain", str(domain), *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, preexec_fn=lambda: die_with(parent))
        self.types, self.samples = {}, collections.defaultdict(list)
        self.matches, self.incompatible, self.errors = collections.Counter(), [], []
        self.answers, self.changed, self.guid = collections.deque(), threading.Condition(), None
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()
        self.until("the peer", lambda: self.guid)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def run(self):
        for text in self.process.stdout:
            line = json.loads(text)
            with self.changed:
                self.take(line)
                self.changed.notify_all()

    def take(self, line):
        if "ready" in line:
            self.guid = line["ready"]
        elif "hex" in line:
            data = bytes.fromhex(line["hex"])
            try:
                message = ros_cdr.decode(self.types[line["topic"]], data) if self.types.get(line["topic"]) else data
            except ros_cdr.CdrError as error:
                self.errors.append(f"{line['topic']}: {error}: {line['hex'][:400]}")
                return
            self.samples[line["topic"]].append(Sample(message, line["t"] * 1e-9, line["source"] * 1e-9, line["guid"], len(data)))
        elif "matched" in line:
            self.matches[line["matched"], line["side"]] = line["count"]
        elif "incompatible" in line:
            self.incompatible.append((line["incompatible"], line["side"], line["policy"]))
        else:
            self.answers.append(line)

    def until(self, what, condition, limit_s=20):
        """The first value of condition() that counts as true; it is asked when something came from the peer."""
        with self.changed:
            if not self.changed.wait_for(lambda: condition() or self.process.poll() is not None, limit_s * PATIENCE):
                raise AssertionError(f"{what} did not happen within {limit_s} s; errors: {self.errors}")
            assert (value := condition()), f"{what}: the peer has ended with status {self.process.poll()}"
            return value

    def ask(self, **request):
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        self.until(f"an answer to {request['op']}", lambda: self.answers)
        answer = self.answers.popleft()
        if "error" in answer:
            raise PeerError(answer["error"])
        return answer

    def read(self, topic, kind, reliable=True, transient_local=False, depth=5, quiet=False):
        """Reads a topic from now on; `kind` as "sensor_msgs/LaserScan". Its samples come to samples_of()."""
        self.open("read", topic, kind, reliable=reliable, transient_local=transient_local, depth=depth, quiet=quiet)

    def write(self, topic, kind, reliable=True, transient_local=False, depth=5):
        """Makes a writer; send() is for its messages."""
        self.open("write", topic, kind, reliable=reliable, transient_local=transient_local, depth=depth,
                  user_data=f"typehash={ros_cdr.type_hash(kind)};" if kind in ros_cdr.MESSAGES else "")

    def open(self, what, topic, kind, **options):
        """A reader or writer; an unknown kind is the name of a type of DDS, whose samples stay bytes."""
        known = kind in ros_cdr.MESSAGES
        self.types[wire_name(topic)] = kind if known else None
        self.ask(op=what, topic=wire_name(topic), type=ros_cdr.dds_name(kind) if known else kind, **options)

    def send(self, topic, message, count=1, hz=0):
        """Once, or so often at this rate; count 0: until stop() or the peer's end."""
        data = message if isinstance(message, bytes) else ros_cdr.encode(self.types[wire_name(topic)], message)
        self.ask(op="send", topic=wire_name(topic), hex=data.hex(), count=count, hz=hz)

    def stop(self, topic):
        self.ask(op="stop", topic=wire_name(topic))

    def forget(self, topic):
        """Ends reader and writer of a topic."""
        self.ask(op="close", topic=wire_name(topic))

    def samples_of(self, topic):
        """All so far."""
        with self.changed:
            return list(self.samples[wire_name(topic)])

    def messages(self, topic):
        return [sample.message for sample in self.samples_of(topic)]

    def wait(self, topic, condition=lambda message: True, limit_s=20):
        """The first message of a topic, of those before too, for which the condition holds."""
        return self.until(f"a message of {topic}",
                          lambda: next((one.message for one in self.samples[wire_name(topic)] if condition(one.message)), None), limit_s)

    def wait_for_count(self, topic, count, limit_s=20):
        self.until(f"{count} messages of {topic}", lambda: len(self.samples[wire_name(topic)]) >= count, limit_s)

    def wait_for_match(self, topic, side, count=1, limit_s=20):
        """Until the peer's reader or writer has so many counterparts."""
        self.until(f"a match of {topic}", lambda: self.matches[wire_name(topic), side] == count, limit_s)

    def listed(self):
        """participants, writers and readers that it has discovered, by their guid."""
        return self.ask(op="list")

    def writers_of(self, topic):
        return [writer for writer in self.listed()["writers"].values() if writer["topic"] == wire_name(topic)]

    def readers_of(self, topic):
        return [reader for reader in self.listed()["readers"].values() if reader["topic"] == wire_name(topic)]

    def wait_for_reader(self, topic, limit_s=20):
        return wait_for(f"a reader of {topic}", lambda: self.readers_of(topic), limit_s)

    def report(self):
        """Of each topic that is read: how many samples, bytes, and milliseconds on the way."""
        return self.ask(op="report")["topics"]

    def kill(self):
        """As a program that crashes: nobody is told."""
        self.process.kill()
        self.close()

    def close(self):
        """Ends it in order."""
        if not self.process.stdin.closed:
            self.process.stdin.close()
            self.process.wait(20 * PATIENCE)
            self.thread.join()
            self.process.stdout.close()
