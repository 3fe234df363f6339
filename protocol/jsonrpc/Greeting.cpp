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

// METHOD SP and a path or "*" is HTTP (RFC 9112, 3); which method does not matter, a page can invent one. So
// is whatever else the first line begins with, if it ends in the version of HTTP: no message does.
Greeting::Speaker Greeting::next(char byte) {
    if (place_ == Place::Start && isSpace(byte))
        return Speaker::Unknown;
    if (byte == '\n')
        return endsInVersion() ? Speaker::Http : Speaker::Ours;
    if (byte != '\r') {
        std::memmove(tail_, tail_ + 1, sizeof tail_ - 1);
        tail_[sizeof tail_ - 1] = byte;
    }
    switch (place_) {
    case Place::Start:
        place_ = byte == tlsHandshake ? Place::Record : isTokenCharacter(byte) ? Place::Method : Place::Rest;
        return static_cast<unsigned char>(byte) < '\t' ? Speaker::Ours
                                                       : Speaker::Unknown; // the length of a frame
    case Place::Record:
        place_ = Place::Rest;
        return byte == tlsMajorVersion ? Speaker::Tls : Speaker::Unknown;
    case Place::Method:
        place_ = byte == ' ' ? Place::Target : isTokenCharacter(byte) ? Place::Method : Place::Rest;
        return Speaker::Unknown;
    case Place::Target:
        place_ = Place::Rest;
        return byte == '/' || byte == '*' ? Speaker::Http : Speaker::Unknown;
    case Place::Rest:
        break;
    }
    return Speaker::Unknown;
}

bool Greeting::endsInVersion() const {
    const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    return std::memcmp(tail_, " HTTP/", 6) == 0 && isDigit(tail_[6]) && tail_[7] == '.' && isDigit(tail_[8]);
}

QString Greeting::reason() const {
    return speaker_ == Speaker::Tls
               ? QStringLiteral("this is TLS, and nothing else is taken from this connection; here commands "
                                "are accepted in plain text")
               : QStringLiteral("this is HTTP, and nothing else is taken from this connection; commands are "
                                "JSON-RPC messages, not web requests");
}

} // namespace hermes
