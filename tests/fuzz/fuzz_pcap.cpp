#include "tests/fuzz/FuzzInput.h"

#include "common/capture/PcapReader.h"

#include <sys/mman.h>
#include <unistd.h>

/// Every record of a capture is counted once, every datagram lies within its record, and damage ends with a
/// message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const int file = memfd_create("capture", 0);
    FUZZ_REQUIRE(file >= 0 && write(file, data, size) == ssize_t(size));
    using Next = hermes::PcapReader::Next;
    hermes::PcapReader reader;
    const auto opened = reader.open("/proc/self/fd/" + std::to_string(file));
    hermes::Datagram datagram;
    Next next = Next::Datagram;
    unsigned sum = 0;
    while ((next = reader.next(datagram)) == Next::Datagram)
        for (std::size_t i = 0; i < datagram.size; ++i)
            sum += datagram.payload[i]; // the sanitizer sees what lies outside
    FUZZ_REQUIRE((next == Next::Failed) == !reader.error().empty() && (opened || next == Next::Failed));
    FUZZ_REQUIRE(sum <= 255 * size);
    const auto &c = reader.counts();
    FUZZ_REQUIRE(c.records == c.datagrams + c.notUdp + c.fragments + c.cut + c.unknownLinks);
    close(file);
    return 0;
}
