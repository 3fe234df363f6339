#include "daemons/seriallogger/Arrival.h"

#include <chrono>

namespace hermes::seriallogger {

Arrival Arrival::now() {
    using std::chrono::nanoseconds;
    const auto count = [](auto time) {
        return std::int64_t(std::chrono::duration_cast<nanoseconds>(time.time_since_epoch()).count());
    };
    return {count(std::chrono::system_clock::now()), count(std::chrono::steady_clock::now())};
}

} // namespace hermes::seriallogger
