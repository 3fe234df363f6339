#pragma once

#include "protocol/mcap/Contents.h"

#include <optional>
#include <string>
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
    SummaryOffset = 0x0E,
    DataEnd,
};

/// A file begins and ends with it.
constexpr std::string_view magic("\x89MCAP0\r\n", 8);
constexpr std::size_t headBytes = 9; ///< of a record: its first byte, and the length of what follows
constexpr std::size_t footerBytes = headBytes + 8 + 8 + 4;
constexpr std::size_t messageBytes = headBytes + 2 + 4 + 8 + 8; ///< of a message without data
constexpr std::size_t indexEntryBytes = 8 + 8;

template <typename T>
void putNumber(std::string &to, T value) {
    static_assert(std::is_unsigned_v<T>);
    for (unsigned i = 0; i < sizeof value; ++i)
        to += char(value >> 8 * i);
}
void putText(std::string &to, std::string_view text);

/// Puts the head of a record whose content is what is appended to the text while this lives.
class PutRecord {
public:
    PutRecord(std::string &to, Op op);
    ~PutRecord();
    PutRecord(const PutRecord &) = delete;
    PutRecord &operator=(const PutRecord &) = delete;

private:
    std::string &to_;
    std::size_t begin_;
};

void put(std::string &to, const Schema &schema);
void put(std::string &to, const Channel &channel);
void put(std::string &to, const Message &message);
/// Puts the index of each channel of a chunk, and tells the chunk where. entries: of each channel log times
/// and offsets. at: where in the file the first will stand.
void putIndexes(std::string &to, const std::map<std::uint16_t, std::string> &entries, std::uint64_t at,
                Chunk &chunk);
/// The end of a file with these contents: DataEnd, summary, footer. at: where in the file it will stand.
std::string ending(const Contents &contents, std::uint64_t at);

/// Takes fields off the front of bytes that somebody else keeps. Behind their end all is 0 or empty, and ok()
/// is false.
class Fields {
public:
    explicit Fields(std::string_view bytes)
        : left_(bytes) {}

    template <typename T>
    T number() {
        T value = 0;
        const std::string_view from = bytes(sizeof value);
        for (std::size_t i = 0; i < from.size(); ++i)
            value = T(value | T(static_cast<unsigned char>(from[i])) << 8 * i);
        return value;
    }
    std::string_view bytes(std::uint64_t count);
    std::string_view text() { return bytes(number<std::uint32_t>()); }

    std::string_view left() const { return left_; }
    bool ok() const { return ok_; }

private:
    std::string_view left_;
    bool ok_ = true;
};

struct Record {
    Op op = Op::Header;
    std::string_view content;
};

/// The next record; nothing at the end, or where one is cut: then not ok().
std::optional<Record> takeRecord(Fields &from);
/// Each gives nothing where fields are missing or forbidden.
std::optional<Schema> toSchema(std::string_view content);
std::optional<Channel> toChannel(std::string_view content);
std::optional<Message> toMessage(std::string_view content);
std::optional<Chunk> toChunk(std::string_view content); ///< of a ChunkIndex

} // namespace hermes::mcap
