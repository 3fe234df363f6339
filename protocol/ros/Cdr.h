#pragma once

#include "protocol/ros/Bytes.h"

namespace hermes::ros {

/// Puts the message's bytes into out, in place of what it had: those of a DDS sample, with four of
/// encapsulation in front. Source: OMG DDSI-RTPS 2.3, chapter 10.
template <typename M>
void toCdr(const M &message, std::string &out) {
    out.assign("\0\1\0\0", 4);
    Writer<Form::Cdr>(out).write(message);
}

template <typename M>
std::string toCdr(const M &message) {
    std::string out;
    toCdr(message, out);
    return out;
}

/// Of bytes with their encapsulation, of either byte order. More bytes than the message needs: up to 3 are
/// padding, others an error, as they are of another type.
template <typename M>
Outcome<M> fromCdr(std::string_view bytes) {
    const bool isCdr = bytes.size() >= 4 && bytes[0] == 0 && (bytes[1] == 0 || bytes[1] == 1);
    if (!isCdr)
        return std::string(typeOf<M>()) + ": expected the encapsulation CDR, found " +
               (bytes.size() < 4 ? std::to_string(bytes.size()) + " bytes" : std::string("another"));
    Reader<Form::Cdr> in(bytes.substr(4), bytes[1] == 0);
    M message;
    in.read(message);
    if (in.hasFailed())
        return std::string(typeOf<M>()) + ": " + in.problem();
    if (const std::size_t rest = bytes.size() - 4 - in.position(); rest > 3)
        return std::string(typeOf<M>()) + ": " + std::to_string(rest) + " bytes too many";
    return message;
}

} // namespace hermes::ros
