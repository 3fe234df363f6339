#pragma once

#include "protocol/mcap/Contents.h"

#include <tuple>
#include <type_traits>

namespace hermes::mcap {

/// The first byte of a record.
enum class Op : std::uint8_t {
    Header = 1,
    Footer,
    Schema,
    Channel,
    Message,
    Chunk,
    MessageIndex,
    ChunkIndex,
    Statistics = 0x0B,
    DataEnd = 0x0F,
};

/// A file begins and ends with it.
constexpr std::string_view magic("\x89MCAP0\r\n", 8);
constexpr std::size_t headBytes = 9; ///< of a record: its first byte, and the length of what follows
constexpr std::size_t footerBytes = headBytes + 8 + 8 + 4;
constexpr std::size_t messageBytes = headBytes + 2 + 4 + 8 + 8; ///< of a message without data

// The fields of records that are written and read. A field is a number; a text or a map, with their length
// before them; or a std::string_view: all the rest of the record.
inline auto fieldsOf(Schema &s) {
    return std::tie(s.id, s.name, s.encoding, s.data);
}
inline auto fieldsOf(Channel &c) {
    return std::tie(c.id, c.schema, c.topic, c.encoding, c.metadata);
}
inline auto fieldsOf(Message &m) {
    return std::tie(m.channel, m.sequence, m.logTime_ns, m.publishTime_ns, m.data);
}
inline auto fieldsOf(Chunk &c) { // of a ChunkIndex
    return std::tie(c.start_ns, c.end_ns, c.offset, c.bytes, c.indexes, c.indexBytes, c.compression,
                    c.packedBytes, c.unpackedBytes);
}

template <typename T>
std::enable_if_t<std::is_unsigned_v<T>> putField(std::string &to, T value) {
    for (unsigned i = 0; i < sizeof value; ++i)
        to += char(value >> 8 * i);
}
inline void putField(std::string &to, const std::string &text) {
    putField(to, std::uint32_t(text.size()));
    to += text;
}
inline void putField(std::string &to, std::string_view rest) {
    to += rest;
}
template <typename Key, typename Value>
void putField(std::string &to, const std::map<Key, Value> &map) {
    std::string items;
    for (const auto &[key, value] : map) {
        putField(items, key);
        putField(items, value);
    }
    putField(to, items);
}

template <typename... Fields>
void putRecord(std::string &to, Op op, const Fields &...fields) {
    putField(to, std::uint8_t(op));
    const std::size_t lengthAt = to.size();
    putField(to, std::uint64_t(0));
    (putField(to, fields), ...);
    std::string length;
    putField(length, std::uint64_t(to.size() - lengthAt - 8));
    to.replace(lengthAt, 8, length);
}
template <typename T>
void put(std::string &to, Op op, T record) {
    std::apply([&](const auto &...fields) { putRecord(to, op, fields...); }, fieldsOf(record));
}

// Each takes a field off the front of bytes; false: it is not all there.
template <typename T>
std::enable_if_t<std::is_unsigned_v<T>, bool> takeField(std::string_view &from, T &value) {
    if (from.size() < sizeof value)
        return false;
    value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i)
        value = T(value | T(static_cast<unsigned char>(from[i])) << 8 * i);
    from.remove_prefix(sizeof value);
    return true;
}
inline bool takeField(std::string_view &from, std::string &text) {
    std::uint32_t size = 0;
    if (!takeField(from, size) || size > from.size())
        return false;
    text = from.substr(0, size);
    from.remove_prefix(size);
    return true;
}
inline bool takeField(std::string_view &from, std::string_view &rest) {
    rest = from;
    from = {};
    return true;
}
template <typename Key, typename Value>
bool takeField(std::string_view &from, std::map<Key, Value> &map) {
    std::string items;
    bool isWhole = takeField(from, items);
    for (std::string_view left = items; isWhole && !left.empty();) {
        Key key{};
        isWhole = takeField(left, key) && takeField(left, map[key]);
    }
    return isWhole;
}

/// false: the content of the record is shorter. What it has behind these fields is left alone.
template <typename... Fields>
bool takeFields(std::string_view content, Fields &...fields) {
    return (takeField(content, fields) && ...);
}
template <typename T>
bool take(std::string_view content, T &record) {
    return std::apply([&](auto &...fields) { return takeFields(content, fields...); }, fieldsOf(record));
}

/// Goes through records that somebody else keeps.
class RecordCursor {
public:
    explicit RecordCursor(std::string_view records)
        : size_(records.size())
        , left_(records) {}

    /// To the next record, or the first. false: there is none, or it isCut().
    bool next();
    bool isCut() const { return !left_.empty(); }

    Op op = Op::Header;
    std::string_view content;
    std::size_t at = 0; ///< where the record begins

private:
    std::size_t size_;
    std::string_view left_;
};

/// Adds the schema or channel of a record; the first of an id counts. false: fields are missing or forbidden,
/// or there are more than mostDefinitions. Other records are left alone.
bool define(Contents &contents, Op op, std::string_view content);

/// Gives take(message, at) the messages of known channels among the records of a chunk. false: some are
/// damaged, or of no known channel.
template <typename Take>
bool eachMessage(const Contents &contents, std::string_view records, const Take &take) {
    RecordCursor record(records);
    bool isSound = true;
    while (record.next()) {
        Message message;
        if (record.op != Op::Message)
            continue;
        if (mcap::take(record.content, message) && contents.channels.count(message.channel) > 0)
            take(message, record.at);
        else
            isSound = false;
    }
    return isSound && !record.isCut();
}

/// The beginning of a file that this library writes.
std::string beginning(const std::string &library, const std::string &profile = {});
/// The end of a file with these contents: DataEnd, summary, footer. at: where in the file it will stand.
std::string ending(const Contents &contents, std::uint64_t at);

/// The CRC-32 of bytes, or of what was before and them.
std::uint32_t sumOf(std::string_view bytes, std::uint32_t before = 0);

} // namespace hermes::mcap
