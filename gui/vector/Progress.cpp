#include "gui/vector/Progress.h"

#include "common/platform/Console.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hermes::vector {

Progress::Progress(std::string what)
    : what_(std::move(what))
    , terminal_(isTerminal(StandardStream::Errors))
    , begin_(std::chrono::steady_clock::now())
    , next_(begin_ + std::chrono::seconds(1)) {}

Progress::~Progress() {
    if (shown_)
        std::fprintf(stderr, "\r\033[K");
}

void Progress::update(std::size_t done, std::size_t total) {
    using namespace std::chrono_literals;
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ || now < next_)
        return;
    next_ = now + 100ms;
    shown_ = true;
    if (total > 0 && done > 0) {
        const double spent = std::chrono::duration<double>(now - begin_).count();
        std::fprintf(stderr, "\r\033[K%s %zu of %zu (%zu %%), %.0f s left", what_.c_str(), done, total,
                     100 * done / total,
                     std::ceil(spent * double(total - std::min(done, total)) / double(done)));
    } else
        std::fprintf(stderr, "\r\033[K%s %zu", what_.c_str(), done);
    std::fflush(stderr);
}

void Progress::tell(const std::string &what) {
    if (!terminal_ || std::chrono::steady_clock::now() < next_)
        return;
    shown_ = true;
    std::fprintf(stderr, "\r\033[K%s: %s", what_.c_str(), what.c_str());
    std::fflush(stderr);
}

} // namespace hermes::vector
