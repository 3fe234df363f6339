#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>

/// Stops the program where something does not hold that must hold for every input; libFuzzer then keeps the
/// input.
#define FUZZ_REQUIRE(condition)                                                                              \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            std::fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition);              \
            std::abort();                                                                                    \
        }                                                                                                    \
    } while (false)

/// The bytes of a fuzzer read as settings and numbers. Behind their end everything is 0.
class FuzzInput {
public:
    FuzzInput(const std::uint8_t *data, std::size_t size)
        : data_(data)
        , size_(size) {}

    std::size_t left() const { return size_; }

    template <typename T>
    T take() {
        T value{};
        const std::size_t count = std::min(sizeof value, size_);
        if (count > 0)
            std::memcpy(&value, data_, count);
        skip(count);
        return value;
    }
    bool flag() { return take<std::uint8_t>() & 1; }

    /// A setting: one of the numbers at which code is apt to break, near `usual`, or any number at all.
    double setting(double usual) {
        using Limits = std::numeric_limits<double>;
        constexpr double special[] = {0,
                                      -0.0,
                                      1,
                                      -1,
                                      1e-9,
                                      1e9,
                                      1e30,
                                      -1e30,
                                      Limits::max(),
                                      Limits::denorm_min(),
                                      1e-30,
                                      1e160,
                                      1e-160,
                                      Limits::infinity(),
                                      -Limits::infinity(),
                                      Limits::quiet_NaN()};
        const auto kind = take<std::uint8_t>();
        if (kind < std::size(special))
            return special[kind];
        return kind < 32 ? take<double>() : usual * std::exp2((kind - 128) / 16.0);
    }

    /// The next bytes, at most `most`.
    std::string bytes(std::size_t most) {
        const std::size_t count = std::min(most, size_);
        const std::string text(reinterpret_cast<const char *>(data_), count);
        skip(count);
        return text;
    }

private:
    void skip(std::size_t count) {
        data_ += count;
        size_ -= count;
    }

    const std::uint8_t *data_;
    std::size_t size_;
};

inline std::string fuzzText(const std::uint8_t *data, std::size_t size) {
    return std::string(reinterpret_cast<const char *>(data), size);
}
