#include "tests/fuzz/FuzzInput.h"

#include "protocol/mcap/Reader.h"

#include <sys/mman.h>
#include <unistd.h>

namespace {

/// All messages that a reader gives: each of a channel that it has, in order unless it tells otherwise.
std::string messagesOf(hermes::mcap::Reader &reader) {
    std::string found;
    std::uint64_t before = 0;
    bool inOrder = true;
    while (const auto message = reader.next()) {
        FUZZ_REQUIRE(reader.channels().count(message->channel) == 1);
        inOrder = inOrder && message->logTime_ns >= before;
        before = message->logTime_ns;
        found += std::to_string(before) + ' ' + std::to_string(message->channel) + ' ';
        found += std::to_string(std::hash<std::string_view>()(message->data)) + ' '; // reads all of it
    }
    FUZZ_REQUIRE(inOrder || !reader.problem().empty());
    return found;
}

} // namespace

/// Whatever a file holds is read or told; a file that was cut off is whole when it is mended, and has the
/// same messages.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const int file = memfd_create("mcap", 0);
    FUZZ_REQUIRE(file >= 0 && write(file, data, size) == ssize_t(size));
    const std::string path = "/proc/self/fd/" + std::to_string(file);
    if (auto reader = hermes::mcap::Reader::open(path)) {
        const std::string messages = messagesOf(*reader);
        reader->seek(reader->end_ns());
        messagesOf(*reader);
        const auto repaired = hermes::mcap::repair(path);
        FUZZ_REQUIRE(repaired && repaired->contents.channels.size() == reader->channels().size());
        FUZZ_REQUIRE(lseek(file, 0, SEEK_END) == off_t(repaired->bytes));
        auto again = hermes::mcap::Reader::open(path);
        FUZZ_REQUIRE(again && again->isWhole() && messagesOf(*again) == messages);
    }
    close(file);
    return 0;
}
