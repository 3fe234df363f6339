#include "protocol/jsonrpc/Greeting.h"

#include <cstring>

namespace hermes {
namespace {

constexpr char tlsHandshake = 0x16, tlsMajorVersion = 3; // RFC 8446, 5.1

bool isSpace(char byte) {
    return byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
}

/// Of a method, RFC 9110, 5.6.2.
bool isTokenCharacter(char byte) {
    const bool isWord =
        (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') || (byte >= 'a' && byte <= 'z');
    return isWord || (byte != 0 && std::strchr("!#$%&'*+-.^_`|~", byte));
}

} // namespace

Greeting::Speaker Greeting::look(const QByteArray &bytes) {
    for (auto byte = bytes.begin(); byte != bytes.end() && speaker_ == Speaker::Unknown; ++byte)
        speaker_ = next(*byte);
    return speaker_;
}

// METHOD SP, then the target: a path or "*" (RFC 9112, 3.2; browsers write nothing else but to proxies).
// Which method does not matter: a page can invent one.
Greeting::Speaker Greeting::next(char byte) {
    switch (place_) {
    case Place::Start:
        if (isSpace(byte))
            return Speaker::Unknown;
        place_ = byte == tlsHandshake ? Place::Record : Place::Method;
        return byte == tlsHandshake || isTokenCharacter(byte) ? Speaker::Unknown : Speaker::Ours;
    case Place::Record:
        return byte == tlsMajorVersion ? Speaker::Tls : Speaker::Ours;
    case Place::Method:
        if (byte == ' ')
            place_ = Place::Target;
        return byte == ' ' || isTokenCharacter(byte) ? Speaker::Unknown : Speaker::Ours;
    case Place::Target:
        return byte == '/' || byte == '*' ? Speaker::Http : Speaker::Ours;
    }
    return Speaker::Ours;
}

QString Greeting::reason() const {
    return speaker_ == Speaker::Tls
               ? QStringLiteral("this is TLS, and nothing else is taken from this connection; here commands "
                                "are accepted in plain text")
               : QStringLiteral("this is HTTP, and nothing else is taken from this connection; commands are "
                                "JSON-RPC messages, not web requests");
}

} // namespace hermes
