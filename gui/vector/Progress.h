#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace hermes {

/// One line on stderr that says how far long work has come; silent when stderr is no terminal.
class Progress {
public:
    explicit Progress(std::string what);
    ~Progress();

    /// total: 0 when it is not known.
    void update(std::size_t done, std::size_t total);

private:
    std::string m_what;
    bool m_terminal;
    bool m_shown = false;
    std::chrono::steady_clock::time_point m_last;
};

} // namespace hermes
