#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hermes::drive {

/// The bytes of one packet, without allocation.
class Bytes {
public:
    const std::uint8_t *data() const { return data_.data(); }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::uint8_t operator[](std::size_t i) const { return data_[i]; }
    /// Beyond the capacity it is ignored; no packet is so long.
    void push(std::uint8_t byte) {
        if (size_ < data_.size())
            data_[size_++] = byte;
    }
    void push(const Bytes &bytes) {
        for (std::size_t i = 0; i < bytes.size(); ++i)
            push(bytes[i]);
    }
    void push(std::string_view text) {
        for (const char letter : text)
            push(std::uint8_t(letter));
    }
    void push16(std::uint16_t value) {
        push(std::uint8_t(value >> 8));
        push(std::uint8_t(value));
    }
    void clear() { size_ = 0; }

private:
    std::array<std::uint8_t, 64> data_{};
    std::size_t size_ = 0;
};

/// Reads the answer to one request, byte for byte. Knows no time: the caller gives up when an answer is late,
/// and tells when the line has fallen silent.
class ReplyReader {
public:
    enum class Result {
        Incomplete,
        Done,      ///< the answer is whole
        BadCrc,    ///< the answer, or the request on its way, was damaged
        Unexpected ///< it is no answer to this
    };

    virtual ~ReplyReader() = default;
    /// Awaits the answer to this request and forgets what came before.
    virtual void begin(const Bytes &request) = 0;
    /// One byte more. What follows the end of an answer must not be fed.
    virtual Result feed(std::uint8_t byte) = 0;
    /// The line has been silent for 10 ms or more: what came is all.
    virtual Result silence() = 0;
    /// Bytes of the answer so far.
    virtual std::size_t received() const = 0;
};

} // namespace hermes::drive
