#pragma once

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"

#include <vectorlib/io/CarmenLog.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace bench {

/// The folder of the logs of real scanners, which are not part of the sources.
inline std::string logFolder() {
    const char *given = std::getenv("HERMES_DATA");
    return given ? given : BENCH_SOURCE "/../shared/data/public";
}
inline bool haveLogs() {
    return std::filesystem::exists(logFolder());
}
/// Throws hermes::vector::Failure where it cannot be read.
inline vectorlib::CarmenLog readLog(const std::string &name) {
    hermes::vector::Input input(logFolder() + "/" + name + "-corrected.log.gz");
    return hermes::vector::valueOrFail(vectorlib::readCarmenLog(input.stream(), input.name()));
}

} // namespace bench
