#pragma once

#include "protocol/mcap/Records.h"

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace hermes::bag {

/// What a record of a .bag 2.0 is, by its field "op".
enum class Ros1Op : std::uint8_t {
    Message = 2,
    FileHeader = 3,
    Index = 4,
    Chunk = 5,
    ChunkInfo = 6,
    Connection = 7,
};

/// The fields of a record's header, or those that stand as its data. Valid as long as the bytes are.
class Ros1Fields {
public:
    /// false: they are damaged.
    bool read(std::string_view bytes);

    /// Empty: there is none.
    std::string_view text(const char *name) const;
    /// false: there is none of that size.
    template <typename T>
    bool number(const char *name, T &value) const {
        std::string_view field = text(name);
        return field.size() == sizeof value && mcap::takeField(field, value);
    }
    /// Seconds and nanoseconds, as nanoseconds. false: there is no such field.
    bool time(const char *name, std::uint64_t &value_ns) const;

private:
    std::vector<std::pair<std::string_view, std::string_view>> fields_; // few
};

/// Goes through records that somebody else keeps: those of a chunk, or of the end of a bag.
class Ros1Cursor {
public:
    explicit Ros1Cursor(std::string_view records)
        : size_(records.size())
        , left_(records) {}

    /// To the next record, or the first. false: there is none, or it isCut(). Bytes of 0 between records are
    /// skipped.
    bool next();
    bool isCut() const { return !left_.empty(); }

    Ros1Op op = Ros1Op::FileHeader;
    Ros1Fields fields;
    std::string_view data;
    std::size_t at = 0; ///< where the record begins

private:
    std::size_t size_;
    std::string_view left_;
};

/// Seconds (the lower 32 bits) and nanoseconds.
std::uint64_t nanosecondsOf(std::uint64_t stamp);

} // namespace hermes::bag
