#!/usr/bin/env python3
"""Reads MCAP files with nothing of the project's own: written from the format's specification alone, to compare with what Hermes
writes. Every sum, place and count of a file is checked; what does not hold raises ValueError.

As a program it prints the messages of a file: log time, publish time, sequence, topic, data."""
import collections
import ctypes
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F
Schema = collections.namedtuple("Schema", "id name encoding data")
Channel = collections.namedtuple("Channel", "id schema topic encoding metadata")
Message = collections.namedtuple("Message", "channel sequence log_time publish_time data")
ChunkRecord = collections.namedtuple("ChunkRecord", "start end size compression packed messages entries")


def require(holds, what):
    if not holds:
        raise ValueError(what)


class Fields:
    """Fields from the front of bytes."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def bytes(self, count):
        require(self.at + count <= len(self.data), "a record is shorter than it tells")
        self.at += count
        return self.data[self.at - count:self.at]

    def numbers(self, layout):
        return struct.unpack("<" + layout, self.bytes(struct.calcsize("<" + layout)))

    def number(self, letter):
        return self.numbers(letter)[0]

    def text(self):
        return self.bytes(self.number("I")).decode()

    def rest(self):
        return self.bytes(len(self.data) - self.at)

    def pairs(self, take):
        """The items of a map or an array of pairs."""
        items = Fields(self.bytes(self.number("I")))
        found = []
        while items.at < len(items.data):
            found.append(take(items))
        return found


def unzstd(data, size):
    try:
        import zstandard
        return zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
    except ImportError:
        library = ctypes.CDLL("libzstd.so.1")
        library.ZSTD_decompress.restype = ctypes.c_size_t
        library.ZSTD_decompress.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]
        out = ctypes.create_string_buffer(size)
        done = library.ZSTD_decompress(out, size, data, len(data))
        require(done == size, "a chunk cannot be unpacked")
        return out.raw


def records(data, at, end):
    """Place, end, kind and content of each record."""
    while at < end:
        require(at + 9 <= end, f"byte {at}: a record is cut")
        kind, length = struct.unpack_from("<BQ", data, at)
        require(kind != 0 and at + 9 + length <= end, f"byte {at}: a record is cut, or none")
        yield at, at + 9 + length, kind, data[at + 9:at + 9 + length]
        at += 9 + length


class Mcap:
    """A whole file: channels and schemas by id, chunks by place, messages in the order of the file."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.data = file.read()
        self.schemas, self.channels, self.chunks, self._sizes, self.messages = {}, {}, {}, {}, []
        self.library = ""
        require(self.data[:8] == MAGIC and self.data[-8:] == MAGIC, "the magic is missing")
        data_end = self._read_data()
        self._read_summary(data_end)

    def counts(self):
        """Messages of each topic."""
        return dict(collections.Counter(self.channels[m.channel].topic for m in self.messages))

    def _define(self, kind, content):
        fields = Fields(content)
        if kind == SCHEMA:
            one = Schema(fields.number("H"), fields.text(), fields.text(), fields.bytes(fields.number("I")))
            require(one.id != 0, "a schema has the id 0")
        else:
            one = Channel(*fields.numbers("HH"), fields.text(), fields.text(), dict(fields.pairs(lambda f: (f.text(), f.text()))))
            require(one.schema == 0 or one.schema in self.schemas, f"channel {one.id} comes before its schema")
        known = self.schemas if kind == SCHEMA else self.channels
        require(known.setdefault(one.id, one) == one, f"two things have the id {one.id}")
        return one

    def _read_data(self):
        chunk = None
        first = True
        for at, end, kind, content in records(self.data, 8, len(self.data) - 8):
            require(first == (kind == HEADER), f"byte {at}: the header is missing, or comes again")
            first = False
            if kind == HEADER:
                fields = Fields(content)
                self.profile = fields.text()
                self.library = fields.text()
            elif kind in (SCHEMA, CHANNEL):
                self._define(kind, content)
            elif kind == CHUNK:
                chunk = self.chunks[at] = self._read_chunk(content)._replace(entries={})
                self._sizes[at] = end - at
            elif kind == MESSAGE_INDEX:
                self._read_index(at, content, chunk)
            elif kind == DATA_END:
                require(struct.unpack("<I", content)[0] in (0, zlib.crc32(self.data[:at])), "the sum of the data is wrong")
                return end
            else:
                raise ValueError(f"byte {at}: a record of kind {kind} among the data")
        raise ValueError("the data do not end")

    def _read_chunk(self, content):
        fields = Fields(content)
        start, end, size, crc = fields.numbers("QQQI")
        compression = fields.text()
        packed = fields.bytes(fields.number("Q"))
        require(compression in ("", "zstd") and not fields.rest(), "a chunk of a compression that is not known here")
        unpacked = unzstd(packed, size) if compression else packed
        require(len(unpacked) == size and zlib.crc32(unpacked) == crc, "the size or sum of a chunk is wrong")
        found = {}
        for at, _, kind, inner in records(unpacked, 0, size):
            require(kind in (SCHEMA, CHANNEL, MESSAGE), f"a record of kind {kind} in a chunk")
            if kind != MESSAGE:
                self._define(kind, inner)
                continue
            message = Fields(inner)
            found[at] = Message(*message.numbers("HIQQ"), message.rest())
            require(found[at].channel in self.channels, "a message comes before its channel")
        self.messages += found.values()
        times = [m.log_time for m in found.values()]
        require((start, end) == (min(times), max(times)), "the times of a chunk are not those of its messages")
        return ChunkRecord(start, end, size, compression, len(packed), found, None)

    def _read_index(self, at, content, chunk):
        fields = Fields(content)
        channel = fields.number("H")
        pairs = fields.pairs(lambda f: f.numbers("QQ"))
        wanted = [(m.log_time, place) for place, m in chunk.messages.items() if m.channel == channel]
        require(sorted(pairs) == sorted(wanted), f"byte {at}: the index of channel {channel} is wrong")
        require(channel not in chunk.entries, f"byte {at}: channel {channel} has two indexes")
        chunk.entries[channel] = (at, 9 + len(content))

    def _read_summary(self, begin):
        footer_at = len(self.data) - 8 - 29
        kind, length, summary, offsets, crc = struct.unpack_from("<BQQQI", self.data, footer_at)
        require((kind, length) == (FOOTER, 20), "the footer is missing")
        require(crc == zlib.crc32(self.data[summary:footer_at + 25]), "the sum of the summary is wrong")
        require(summary == begin, "the summary does not follow the data")
        copies = {SCHEMA: {}, CHANNEL: {}}
        groups, told, indexed, statistics = {}, {}, set(), None
        for at, end, kind, content in records(self.data, summary, footer_at):
            require((kind == SUMMARY_OFFSET) == (offsets != 0 and at >= offsets), f"byte {at}: the summary is not in order")
            if kind == SUMMARY_OFFSET:
                group, start, size = struct.unpack("<BQQ", content)
                told[group] = (start, start + size)
                continue
            require(kind not in groups or groups[kind][1] == at, f"byte {at}: the summary is not grouped")
            groups[kind] = (groups.get(kind, (at,))[0], end)
            if kind in copies:
                copy = self._define(kind, content)
                copies[kind][copy.id] = copy
            elif kind == STATISTICS:
                statistics = Fields(content)
            elif kind == CHUNK_INDEX:
                indexed.add(self._check_chunk_index(content))
        require(told == (groups if offsets else {}), "the offsets of the summary are wrong")
        require(copies[SCHEMA] == self.schemas and copies[CHANNEL] == self.channels, "the summary has other schemas or channels")
        require(indexed == set(self.chunks), "the summary has other chunks")
        self._check_statistics(statistics)

    def _check_chunk_index(self, content):
        fields = Fields(content)
        start, end, at, size = fields.numbers("QQQQ")
        places = dict(fields.pairs(lambda f: f.numbers("HQ")))
        index_bytes = fields.number("Q")
        compression = fields.text()
        packed, unpacked = fields.numbers("QQ")
        chunk = self.chunks.get(at)
        require(chunk is not None and self._sizes[at] == size, f"there is no chunk of {size} bytes at {at}")
        require((start, end, compression, packed, unpacked) ==
                (chunk.start, chunk.end, chunk.compression, chunk.packed, chunk.size), f"byte {at}: the summary tells another chunk")
        require(places == {channel: place for channel, (place, _) in chunk.entries.items()} and
                set(places) == {m.channel for m in chunk.messages.values()} and
                index_bytes == sum(length for _, length in chunk.entries.values()), f"byte {at}: the indexes of the chunk are elsewhere")
        return at

    def _check_statistics(self, fields):
        require(fields is not None, "there are no statistics")
        times = [m.log_time for m in self.messages] or [0]
        require(fields.numbers("QHIIIIQQ") == (len(self.messages), len(self.schemas), len(self.channels), 0, 0, len(self.chunks),
                                               min(times), max(times)), "the statistics are wrong")
        counts = dict(fields.pairs(lambda f: f.numbers("HQ")))
        require(counts == collections.Counter(m.channel for m in self.messages), "the counts of the channels are wrong")


def main():
    file = Mcap(sys.argv[1])
    for message in file.messages:
        print(message.log_time, message.publish_time, message.sequence, file.channels[message.channel].topic,
              message.data.decode("utf-8", "backslashreplace"))


if __name__ == "__main__":
    main()
