"""Both ends of a stop: what the controllers are told, and what the client that stops reads."""
import binascii
import json
import math
import os
import select
import socket
import threading
import time

from stop_traffic import line
from support import SerialPort

SET_SPEEDS, SET_SPEEDS_BYTES = 40, 16  # address, command, acceleration, two speeds, CRC


class Tap:
    """A serial server between the motor control and the simulated controllers, which notes what speeds they are told."""

    def __init__(self, link):
        self.port = SerialPort(link)
        self.server = socket.create_server(("127.0.0.1", 0))
        self.url = f"tcp://127.0.0.1:{self.server.getsockname()[1]}"
        self.rest, self.moves, self.zero_since = b"", {0x80: False, 0x81: False}, 0.0
        threading.Thread(target=self.run, daemon=True).start()

    def run(self):
        line_in, _ = self.server.accept()
        line_in.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        while True:
            readable, _, _ = select.select([line_in, self.port.port], [], [])
            try:
                if line_in in readable:
                    told = line_in.recv(4096)
                    if not told:
                        return
                    self.note(told, time.monotonic())
                    os.write(self.port.port, told)
                if self.port.port in readable:
                    line_in.sendall(os.read(self.port.port, 4096))
            except OSError:
                return

    def note(self, told, now):
        self.rest += told
        begin = 0
        while begin + SET_SPEEDS_BYTES <= len(self.rest):
            packet = self.rest[begin:begin + SET_SPEEDS_BYTES]
            if packet[0] in self.moves and packet[1] == SET_SPEEDS and binascii.crc_hqx(packet, 0) == 0:
                moved = any(self.moves.values())
                self.moves[packet[0]] = any(packet[6:14])
                if moved and not any(self.moves.values()):
                    self.zero_since = now
                begin += SET_SPEEDS_BYTES
            else:
                begin += 1
        self.rest = self.rest[begin:]


class Caller:
    """A connection that sees bytes as they come, at the pace that is asked for."""

    def __init__(self, connection):
        self.connection, self.buffer, self.number = connection, bytearray(), 0

    def close(self):
        self.connection.close()

    def send(self, *messages):
        self.connection.sendall(b"".join(line(message) for message in messages))

    def wait(self, limit_s=10):
        """Until bytes have come; they are left where they are."""
        pending = getattr(self.connection, "pending", lambda: 0)()
        assert pending or select.select([self.connection], [], [], limit_s)[0], "nothing has come"

    def read_until(self, mark, bytes_a_second=math.inf):
        """Reads until the mark and the end of its line have come; gives how many bytes came before that line."""
        read, begun, seen = 0, time.monotonic(), 0
        while True:
            at = self.buffer.find(mark, max(0, seen - len(mark)))
            if at >= 0 and b"\n" in self.buffer[at:]:
                before = self.buffer.rfind(b"\n", 0, at) + 1
                end = self.buffer.index(b"\n", at) + 1
                answer, self.buffer = self.buffer[before:end], self.buffer[:before] + self.buffer[end:]
                message = json.loads(answer)
                assert "result" in message, message
                return before
            seen = len(self.buffer) if at < 0 else at + len(mark)  # its line may not have ended yet
            part = self.connection.recv(1 << 16)
            assert part, "closed"
            self.buffer += part
            read += len(part)
            if (pause := read / bytes_a_second - (time.monotonic() - begun)) > 0:
                time.sleep(pause)

    def read_rest(self, replies):
        """Until so many whole lines have come; nothing is left then. Gives their bytes."""
        while self.buffer.count(b"\n") < replies:
            part = self.connection.recv(1 << 18)
            assert part, "closed"
            self.buffer += part
        assert self.buffer[-1:] in (b"", b"\n") and self.buffer.count(b"\n") == replies, self.buffer[-200:]
        read, self.buffer = len(self.buffer), bytearray()
        return read
