#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace hermes::vector {

/// One line on stderr that says how far work has come which takes longer than a second, and how long the rest
/// takes at this pace; silent when stderr is no terminal.
class Progress {
public:
    explicit Progress(std::string what);
    ~Progress();

    /// total: 0 when it is not known.
    void update(std::size_t done, std::size_t total);
    /// Of work that cannot tell how much of it is done: what it does now.
    void tell(const std::string &what);

private:
    std::string what_;
    bool terminal_;
    bool shown_ = false;
    std::chrono::steady_clock::time_point begin_;
    std::chrono::steady_clock::time_point next_; ///< when it is told again
};

} // namespace hermes::vector
