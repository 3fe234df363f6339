#include "protocol/mcap/File.h"

#include "protocol/mcap/Unpack.h"

#include <filesystem>
#include <system_error>
#include <zlib.h>

namespace hermes::mcap {

namespace {

constexpr std::uint64_t largestHead = 4096;     // of a chunk: all but what is packed
constexpr std::uint64_t largestRatio = 1 << 15; // zstd: a block of 128 KiB takes 4 bytes

std::string unpacked(const std::string_view packed, const Chunk &chunk, std::string &records) {
    if (chunk.compression != "zstd" && !chunk.compression.empty())
        return "found compression '" + chunk.compression.substr(0, 20) + "', expected zstd or none";
    if (chunk.unpackedBytes > largestChunk || chunk.unpackedBytes / largestRatio > packed.size())
        return "found " + std::to_string(packed.size()) + " bytes that were " +
               std::to_string(chunk.unpackedBytes) + ", expected at most " + std::to_string(largestChunk);
    if (chunk.compression.empty()) {
        records = packed;
    } else {
        records.resize(std::size_t(chunk.unpackedBytes));
        if (std::string problem = unpackZstd(packed, records); !problem.empty())
            return problem;
    }
    return records.size() == chunk.unpackedBytes ? "" : "its size is not what it tells";
}

} // namespace

Outcome<std::unique_ptr<File>> File::open(const std::string &path) {
    const auto name = std::filesystem::u8path(path);
    std::error_code error;
    if (!std::filesystem::is_regular_file(name, error))
        return path + ": " + (error ? error.message() : "is no regular file");
    auto file = std::make_unique<File>();
    file->path_ = path;
    file->size_ = std::filesystem::file_size(name, error);
    file->stream_.open(name, std::ios::binary);
    if (error || !file->stream_)
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

void Problems::add(std::uint64_t offset, const std::string &what) {
    const std::string text = "byte " + std::to_string(offset) + ": " + what;
    if (text != last_ && count_++ == 0)
        first_ = text;
    last_ = text;
}

std::string Problems::text() const {
    return count_ < 2 ? first_ : first_ + " (and " + std::to_string(count_ - 1) + " more)";
}

Outcome<void> loadChunk(File &file, Chunk &chunk, std::string &records) {
    std::string record;
    if (chunk.bytes > largestChunk + largestHead)
        return "found a chunk of " + std::to_string(chunk.bytes) + " bytes, expected at most " +
               std::to_string(largestChunk);
    if (!file.read(chunk.offset, chunk.bytes, record))
        return std::string("the chunk cannot be read");
    Fields whole(record);
    const auto found = takeRecord(whole);
    if (!found || found->op != Op::Chunk || !whole.left().empty())
        return std::string("there is no chunk of that size");
    Fields fields(found->content);
    chunk.start_ns = fields.number<std::uint64_t>();
    chunk.end_ns = fields.number<std::uint64_t>();
    chunk.unpackedBytes = fields.number<std::uint64_t>();
    const auto sum = fields.number<std::uint32_t>();
    chunk.compression = fields.text();
    chunk.packedBytes = fields.number<std::uint64_t>();
    const std::string_view packed = fields.bytes(chunk.packedBytes);
    if (!fields.ok())
        return std::string("the chunk is shorter than it tells");
    if (const std::string why = unpacked(packed, chunk, records); !why.empty())
        return "the chunk cannot be unpacked: " + why;
    const auto *const bytes = reinterpret_cast<const Bytef *>(records.data());
    if (sum != 0 && sum != crc32(0, bytes, uInt(records.size())))
        return std::string("the sum of the chunk is wrong");
    return {};
}

} // namespace hermes::mcap
