#include "protocol/bag/Zstd.h"

#include "protocol/mcap/Contents.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <unistd.h>
#include <zstd.h>

namespace hermes::bag {

namespace {

constexpr std::size_t blockBytes = 1 << 17;
// More than any recording shrinks: what has a higher ratio was made to fill disks.
constexpr std::uint64_t leastUnpacked = 64 << 20, highestRatio = 1000;

/// Feeds what `read` gives, until that is nothing, and hands `write` what comes out. Gives why that fails.
std::string unpackStream(const std::function<std::string_view()> &read,
                         const std::function<std::string(std::string_view)> &write) {
    const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx *)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
    std::string block(blockBytes, '\0');
    std::size_t rest = 0; // 0: a frame has ended
    for (std::string_view packed; !(packed = read()).empty();) {
        ZSTD_inBuffer in{packed.data(), packed.size(), 0};
        for (bool isFull = false; in.pos < in.size || isFull;) {
            ZSTD_outBuffer out{block.data(), block.size(), 0};
            rest = ZSTD_decompressStream(context.get(), &out, &in);
            if (ZSTD_isError(rest))
                return std::string("zstd: ") + ZSTD_getErrorName(rest);
            isFull = out.pos == out.size;
            if (std::string why = write(std::string_view(block).substr(0, out.pos)); !why.empty())
                return why;
        }
    }
    return rest == 0 ? "" : "zstd: it is cut off";
}

std::string tooLarge(std::uint64_t most) {
    return "found more than " + std::to_string(most) + " bytes when it was unpacked, expected at most that";
}

} // namespace

bool isZstd(std::string_view begin) {
    return begin.substr(0, 4) == "\x28\xB5\x2F\xFD";
}

std::string unpackMessage(std::string_view packed, std::string &to) {
    to.clear();
    return unpackStream([&] { return std::exchange(packed, std::string_view()); },
                        [&](std::string_view bytes) {
                            to += bytes;
                            return to.size() > mcap::largestChunk ? tooLarge(mcap::largestChunk)
                                                                  : std::string();
                        });
}

mcap::Outcome<UnpackedFile> UnpackedFile::of(const std::string &path) {
    auto file = mcap::File::open(path);
    if (!file)
        return file.error();
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "hermes-bag-XXXXXX").u8string();
    const int to = error ? -1 : mkstemp(name.data());
    if (to < 0)
        return path + ": cannot be unpacked to " + name + ": " + std::strerror(errno);
    UnpackedFile unpacked(std::move(name));
    std::uint64_t offset = 0, written = 0;
    const std::uint64_t most = leastUnpacked + highestRatio * file->size();
    std::string block;
    std::string why = unpackStream(
        [&]() -> std::string_view {
            const auto size = std::min<std::uint64_t>(blockBytes, file->size() - offset);
            if (!file->read(offset, size, block))
                return {}; // it is cut off then
            offset += size;
            return block;
        },
        [&](std::string_view bytes) -> std::string {
            written += bytes.size();
            if (written > most)
                return tooLarge(most);
            for (ssize_t count = 0; !bytes.empty(); bytes.remove_prefix(std::size_t(count)))
                if ((count = ::write(to, bytes.data(), bytes.size())) < 0)
                    return std::string("cannot be written to the folder for temporary files: ") +
                           std::strerror(errno);
            return {};
        });
    close(to);
    if (!why.empty())
        return path + ": byte " + std::to_string(offset) + ": " + why;
    return unpacked;
}

UnpackedFile::~UnpackedFile() {
    std::error_code ignored;
    if (!path_.empty())
        std::filesystem::remove(std::filesystem::u8path(path_), ignored);
}

} // namespace hermes::bag
