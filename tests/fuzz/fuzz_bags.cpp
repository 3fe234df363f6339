#include "tests/fuzz/FuzzInput.h"

#include "gui/vector/BagDrive.h"
#include "gui/vector/Failure.h"
#include "protocol/bag/Metadata.h"

#include <fcntl.h>
#include <unistd.h>

namespace {

/// A file with a name, as SQLite wants one.
const std::string &fileOfBags() {
    static const std::string path = [] {
        std::string name = "/dev/shm/hermes-fuzz-XXXXXX";
        FUZZ_REQUIRE(mkstemp(name.data()) >= 0);
        std::atexit([] { unlink(fileOfBags().c_str()); });
        return name;
    }();
    return path;
}

/// All messages: of topics that there are, in order unless it is told otherwise.
void readAll(hermes::bag::Reader &reader) {
    std::uint64_t before = 0;
    volatile std::size_t bytes = 0;
    bool inOrder = true;
    while (const auto message = reader.next()) {
        FUZZ_REQUIRE(message->topic < reader.topics().size());
        inOrder = inOrder && message->time_ns >= before;
        before = message->time_ns;
        bytes = bytes + std::hash<std::string_view>()(message->data); // reads all of it
    }
    FUZZ_REQUIRE(inOrder || !reader.problem().empty());
}

/// The points of all scanners are finite, and each has its time or none.
void drive(const std::string &path) {
    hermes::vector::BagDrive bag(path);
    for (const auto &scanner : bag.scanners()) {
        hermes::vector::BagDrive again(path);
        try {
            again.choose({scanner.topic, {}});
        } catch (const hermes::vector::Failure &) {
            continue; // its first scan is none
        }
        again.readScans([](const vectorlib::TimedScan &scan) {
            for (const auto &point : scan.points)
                FUZZ_REQUIRE(std::isfinite(point.x) && std::isfinite(point.y));
            for (const float seconds : scan.seconds)
                FUZZ_REQUIRE(std::isfinite(seconds));
            FUZZ_REQUIRE(scan.seconds.empty() || scan.seconds.size() == scan.points.size());
        });
        FUZZ_REQUIRE(again.notices(false).size() < 1 << 20);
    }
}

} // namespace

/// Whatever a bag holds is read, or told.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const hermes::bag::Metadata metadata = hermes::bag::readMetadata(fuzzText(data, size));
    for (const std::string &name : metadata.files)
        FUZZ_REQUIRE(name.find('/') == std::string::npos && name != "..");
    const std::string &path = fileOfBags();
    const int file = open(path.c_str(), O_WRONLY | O_TRUNC);
    FUZZ_REQUIRE(file >= 0 && write(file, data, size) == ssize_t(size));
    close(file);
    if (auto reader = hermes::bag::open(path)) {
        readAll(**reader);
        (*reader)->select([](const hermes::bag::Topic &topic) { return topic.name.size() % 2 == 1; });
        readAll(**reader);
        reader->reset();
        drive(path);
    } else {
        FUZZ_REQUIRE(reader.error().rfind(path, 0) == 0);
    }
    return 0;
}
