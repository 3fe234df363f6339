#include "protocol/mcap/File.h"

#include "protocol/mcap/Records.h"
#include "protocol/mcap/Unpack.h"

#include <filesystem>
#include <system_error>

namespace hermes::mcap {

namespace {

constexpr std::uint64_t largestHead = 4096;     // of a chunk: all but what is packed
constexpr std::uint64_t largestRatio = 1 << 15; // zstd: a block of 128 KiB takes 4 bytes

/// Gives why that fails; empty: it is done.
std::string unpack(std::string_view packed, const Chunk &chunk, std::string &records) {
    if (chunk.compression != "zstd" && chunk.compression != "lz4" && !chunk.compression.empty())
        return "found compression '" + chunk.compression.substr(0, 20) + "', expected zstd, lz4 or none";
    if (chunk.unpackedBytes > largestChunk || chunk.unpackedBytes / largestRatio > packed.size())
        return "found " + std::to_string(packed.size()) + " bytes that were " +
               std::to_string(chunk.unpackedBytes) + ", expected at most " + std::to_string(largestChunk);
    if (chunk.compression.empty()) {
        records = packed;
    } else {
        records.resize(std::size_t(chunk.unpackedBytes));
        const auto unpackIt = chunk.compression == "lz4" ? unpackLz4 : unpackZstd;
        if (std::string problem = unpackIt(packed, records); !problem.empty())
            return problem;
    }
    return records.size() == chunk.unpackedBytes ? "" : "its size is not what it tells";
}

} // namespace

Outcome<File> File::open(const std::string &path) {
    const auto name = std::filesystem::u8path(path);
    std::error_code error;
    if (!std::filesystem::is_regular_file(name, error))
        return path + ": " + (error ? error.message() : "is no regular file");
    File file;
    file.path_ = path;
    file.size_ = std::filesystem::file_size(name, error);
    file.stream_.open(name, std::ios::binary);
    if (error || !file.stream_)
        return path + ": cannot be read";
    return file;
}

bool File::read(std::uint64_t offset, std::uint64_t size, std::string &to) {
    if (offset > size_ || size > size_ - offset)
        return false;
    to.resize(std::size_t(size));
    stream_.clear();
    stream_.seekg(std::streamoff(offset));
    return bool(stream_.read(to.data(), std::streamsize(size)));
}

bool File::load(Chunk &chunk, std::string &records) {
    std::string bytes;
    if (chunk.bytes > largestChunk + largestHead)
        return note(chunk.offset, "found a chunk of " + std::to_string(chunk.bytes) +
                                      " bytes, expected at most " + std::to_string(largestChunk));
    if (!read(chunk.offset, chunk.bytes, chunk.isLoose ? records : bytes))
        return note(chunk.offset, "the chunk cannot be read");
    if (chunk.isLoose)
        return true;
    RecordCursor record(bytes);
    if (!record.next() || record.op != Op::Chunk || record.isCut())
        return note(chunk.offset, "there is no chunk of that size");
    std::uint32_t sum = 0;
    std::string_view packed;
    if (!takeFields(record.content, chunk.start_ns, chunk.end_ns, chunk.unpackedBytes, sum, chunk.compression,
                    chunk.packedBytes, packed) ||
        chunk.packedBytes > packed.size())
        return note(chunk.offset, "the chunk is shorter than it tells");
    if (const auto why = unpack(packed.substr(0, std::size_t(chunk.packedBytes)), chunk, records);
        !why.empty())
        return note(chunk.offset, "the chunk cannot be unpacked: " + why);
    return sum == 0 || sum == sumOf(records) || note(chunk.offset, "the sum of the chunk is wrong");
}

bool File::note(std::uint64_t offset, const std::string &problem) {
    const std::string text = "byte " + std::to_string(offset) + ": " + problem;
    if (text != last_ && problems_++ == 0)
        first_ = text;
    last_ = text;
    return false;
}

std::string File::problem() const {
    return problems_ < 2 ? first_ : first_ + " (and " + std::to_string(problems_ - 1) + " more)";
}

} // namespace hermes::mcap
