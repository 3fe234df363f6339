#pragma once

#include <QString>
#include <array>
#include <atomic>
#include <cstdint>
#include <random>
#include <thread>

namespace hermes {

/// A serial line between two pseudo-terminals that programs open as ports: passes bytes both ways no faster
/// than the baud rate, and damages some. What is not yet passed waits in the buffer of the system, as it does
/// before a real port.
class NoisyLine {
public:
    explicit NoisyLine(double bytesPerSecond);
    ~NoisyLine();

    QString device(int end) const { return devices_[std::size_t(end)]; }
    /// From now on one byte in so many is another one; 0: none.
    void setDamage(int oneIn, unsigned int seed);
    quint64 passed() const { return passed_; }   ///< bytes, both ways
    quint64 damaged() const { return damaged_; } ///< of those

private:
    struct Way {
        int from = -1, to = -1;
        double passedUntil = 0; // when the last byte was through; monotonic
    };

    void openEnd(std::size_t end);
    void run();
    void pass(Way &way, double now);

    const double byte_s_;
    std::array<QString, 2> devices_;
    std::array<int, 2> far_{-1, -1}, near_{-1, -1}; // near is held open: without an opener far cannot be read
    std::array<Way, 2> ways_;
    std::mt19937 random_;
    std::atomic<unsigned int> seed_{1}, oneIn_{0};
    std::atomic<bool> reseed_{false}, stop_{false};
    std::atomic<quint64> passed_{0}, damaged_{0};
    std::thread thread_;
};

} // namespace hermes
