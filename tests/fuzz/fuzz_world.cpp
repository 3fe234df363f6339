#include "tests/fuzz/FuzzInput.h"

#include "common/world/World.h"

/// A world that is read has finite edges and poses; one that is not is answered with a message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const auto world = hermes::parseWorld(fuzzText(data, size), "world");
    if (!world) {
        FUZZ_REQUIRE(world.error().rfind("world:", 0) == 0);
        return 0;
    }
    FUZZ_REQUIRE(!world->edges.empty());
    for (const auto &e : world->edges)
        FUZZ_REQUIRE(std::isfinite(e.x1) && std::isfinite(e.y1) && std::isfinite(e.x2) &&
                     std::isfinite(e.y2));
    for (const auto &p : world->poses)
        FUZZ_REQUIRE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.theta));
    for (const auto &person : world->people) {
        FUZZ_REQUIRE(person.way.size() > 1 && person.speed > 0);
        for (const auto &p : person.way)
            FUZZ_REQUIRE(std::isfinite(p.x) && std::isfinite(p.y));
    }
    return 0;
}
