#pragma once

#include "protocol/roboclaw/Packet.h"

namespace hermes::roboclaw {

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
