#pragma once

#include "protocol/drive/Crc16.h"
#include "protocol/drive/ReplyReader.h"
#include "protocol/roboclaw/Command.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace hermes::roboclaw {

using drive::Bytes;
using drive::crc16;

/// The numbers of a packet in the order of its fields.
class Values {
public:
    Values() = default;
    Values(std::initializer_list<std::int64_t> values) {
        for (const std::int64_t value : values)
            push(value);
    }
    /// Of those beyond the ninth only the count is kept; no command has so many.
    void push(std::int64_t value) {
        if (size_ < values_.size())
            values_[size_] = value;
        ++size_;
    }
    std::size_t size() const { return size_; }
    std::int64_t operator[](std::size_t i) const { return values_[i]; }

private:
    std::array<std::int64_t, 9> values_{};
    std::size_t size_ = 0;
};

/// A command to one controller.
struct Request {
    std::uint8_t address = firstAddress;
    Command command = Command::ReadStatus;
    Values values;
    Bytes bytes; ///< as they go over the wire

    /// Nothing when the address is not 0x80 to 0x87, the command is none, the number of values is not that of
    /// its fields, or a value does not fit its field.
    static std::optional<Request> make(std::uint8_t address, Command command, const Values &values = {});

    bool isRead() const { return layoutOf(std::uint8_t(command))->isRead; }
};

/// What a controller answered to a read; empty for a write that was acknowledged.
struct Reply {
    Values values;
    std::array<char, maxText> text{}; ///< ReadVersion, ended by NUL, without the line feed
    bool endsWithLineFeed = false;    ///< the text did, as the manual has it

    std::int64_t operator[](std::size_t i) const { return values[i]; }
};

enum class Dialect { Usual, Other }; ///< which fields of a Layout

/// The answer to a read, as a controller sends it. Nothing when the values do not fit the fields.
std::optional<Bytes> encodeReply(const Request &request, const Values &values,
                                 Dialect dialect = Dialect::Usual);
/// The answer to ReadVersion: text, LF, NUL and CRC. Longer text is cut to 46 characters. Some firmware
/// leaves the line feed out.
Bytes encodeText(const Request &request, std::string_view text, bool lineFeed = true);
constexpr std::uint8_t acknowledgement = 0xFF;

/// Puts the numbers behind the bytes. False when they are not as many as the fields, or one does not fit.
bool pack(std::string_view fields, const Values &values, Bytes &bytes);
/// Takes the numbers from sizeOf(fields) bytes.
Values unpack(std::string_view fields, const std::uint8_t *data);

/// The speed of commands 18, 19, 30 and 31, whether the firmware sends a signed number or a magnitude beside
/// the direction (fact sheet, section 5).
std::int32_t signedSpeed(const Reply &reply);

/// Reads the answers of a controller; after Done reply() holds the last one.
class ReplyParser : public drive::ReplyReader {
public:
    void begin(const Bytes &request) override;
    void begin(const Request &request) { begin(request.bytes); }
    Result feed(std::uint8_t byte) override;
    /// Done when it is a whole answer of the firmware whose answer is shorter (ReadStatus with 16 bits,
    /// ReadMainLimits).
    Result silence() override;
    std::size_t received() const override { return bytes_.size(); }

    const Reply &reply() const { return reply_; }
    /// Which of the layouts the answer has.
    Dialect dialect() const { return dialect_; }

private:
    Result feedText();
    Result finish(std::string_view fields, Dialect dialect);
    bool crcFits(std::size_t dataSize) const;

    const Layout *layout_ = nullptr;
    std::uint16_t requestCrc_ = 0;
    Bytes bytes_;
    Reply reply_;
    Dialect dialect_ = Dialect::Usual;
};

/// The device's side: finds the requests in what a host sends, byte for byte. The caller tells when the line
/// was silent for more than 10 ms.
class RequestParser {
public:
    enum class Result {
        Incomplete,
        Done,    ///< request() holds it
        BadCrc,  ///< dropped: a controller does not answer and does nothing
        Unknown, ///< no address of a controller, or no such command: dropped
    };

    /// dialect: of the writes that differ between firmware.
    explicit RequestParser(Dialect dialect = Dialect::Usual)
        : dialect_(dialect) {}

    Result feed(std::uint8_t byte);
    /// Drops what has not become whole.
    void silence() { bytes_.clear(); }

    const Request &request() const { return request_; }
    /// Bytes of a request that is not yet whole.
    std::size_t pending() const { return bytes_.size(); }

private:
    Result finish(const Layout &layout, std::string_view fields);

    Dialect dialect_;
    Bytes bytes_;
    Request request_;
};

} // namespace hermes::roboclaw
