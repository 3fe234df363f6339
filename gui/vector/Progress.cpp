#include "gui/vector/Progress.h"

#include <cstdio>

#include <unistd.h>

namespace hermes {

Progress::Progress(std::string what)
    : m_what(std::move(what))
    , m_terminal(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
    if (m_shown)
        std::fprintf(stderr, "\r\033[K");
}

void Progress::update(std::size_t done, std::size_t total) {
    using namespace std::chrono_literals;
    const auto now = std::chrono::steady_clock::now();
    if (!m_terminal || (m_shown && now - m_last < 100ms))
        return;
    m_last = now;
    m_shown = true;
    if (total > 0)
        std::fprintf(stderr, "\r\033[K%s %zu of %zu (%zu %%)", m_what.c_str(), done, total,
                     100 * done / total);
    else
        std::fprintf(stderr, "\r\033[K%s %zu", m_what.c_str(), done);
    std::fflush(stderr);
}

} // namespace hermes
